//! Pictures of studies over many tests, and the page that shows them.

mod bars;
mod distribution;
mod page;
mod scatter;

pub use bars::{Bar, Bars, bars_svg};
pub use distribution::{Distribution, distributions_svg};
pub use page::{StudyPage, write_study_page};
pub use scatter::{Cloud, clouds_svg};
