//! From a **plan** to what a workshop needs: plan in, bytes out.
//!
//! ```text
//! plan + Panel ----> Stack --> stl        bodies to print, none touching another
//!              \---> sheets -> svg, dxf   panels to cut, with numbers and hinges
//! plan ------------> crease_pattern       what origami programs fold
//! plan + rig ------> Bill                 what to buy
//!              \---> assembly             the coded sequence as pages with pictures
//! ```
//!
//! Pure: no clock, no file. Words and signs are those of `docs/src/geometry.md`; lengths are millimetres. `zygote export` calls it.

mod assembly;
mod bill;
mod body;
mod bore;
mod crease;
mod drawing;
mod drill;
mod dxf;
mod letters;
mod mounts;
mod panel;
mod sheet;
mod soup;
mod stack;
mod stl;
mod svg;

pub use assembly::{Assembly, assembly};
pub use bill::{Bill, Drives, DrivesError, Item};
pub use crease::crease_pattern;
pub use drawing::{Cut, Drawing, Engraved};
pub use dxf::dxf;
pub use mounts::{Fold, Mount, Mounts, Towards, mounts};
pub use panel::{Holes, LEAST_WALL_MM, Magnet, Panel, PanelError, Rim, Screws};
pub use sheet::{Sheet, SheetError, sheets};
pub use soup::{Point, Soup};
pub use stack::{Gaps, Stack};
pub use stl::{StlError, stl};
pub use svg::svg;
