//! What the tests of a study tell.

mod all;
mod best;
mod effects;
mod elementary;
mod front;
mod indices;
mod interval;
mod moments;
mod named;
mod ranking;
mod sample;
mod spread;
mod table;

pub use all::{Answers, FailedTests};
pub use best::Best;
pub use effects::Effect;
pub use elementary::Elementary;
pub use front::Front;
pub use indices::Indices;
pub use ranking::{Designed, Ranking};
pub use spread::{Beyond, Spread};
pub(super) use table::shown;
