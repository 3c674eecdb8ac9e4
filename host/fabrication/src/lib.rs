//! From a **plan** to what a workshop needs: plan in, bytes out.
//!
//! ```text
//! plan + Panel ----> Stack --> stl        bodies to print, none touching another
//!              \---> sheets -> svg, dxf   panels to cut, with numbers and hinges
//! plan + rig ------> Bill                 what to buy
//!              \---> assembly             the coded sequence as pages with pictures
//! ```
//!
//! Pure: no clock, no file. Words and signs are those of `docs/src/geometry.md`; lengths are millimetres. `zygote export` calls it.

mod body;
mod bore;
mod drill;
mod panel;
mod soup;
mod stack;
mod stl;

pub use panel::{Holes, LEAST_WALL_MM, Magnet, Panel, PanelError, Rim, Screws};
pub use soup::{Point, Soup};
pub use stack::{Gaps, Stack};
pub use stl::{StlError, stl};
