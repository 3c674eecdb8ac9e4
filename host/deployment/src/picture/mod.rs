//! Pictures of a plan as SVG: zygote, target, and the way between them. `zygote picture` calls this.

mod animation;
mod camera;
pub(crate) mod colour;
mod document;
mod film;
mod gantt;
mod net;
mod painter;
mod scene;
mod stage;
mod still;
mod tolerance;

pub use animation::animation;
pub use film::film;
pub use gantt::gantt;
pub use net::net;
pub use stage::{Timeline, TimelineError};
pub use still::{both, target, zygote};
pub use tolerance::tolerance;
