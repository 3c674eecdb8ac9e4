//! Pictures of a plan as SVG: zygote, target, and the way between them. `zygote picture` calls this.

mod animation;
mod camera;
mod colour;
mod document;
mod film;
mod painter;
mod scene;
mod stage;
mod still;

pub use animation::animation;
pub use film::film;
pub use stage::{Timeline, TimelineError};
pub use still::{both, target, zygote};
