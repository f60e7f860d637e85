//! Several runs side by side: the differences of their settings, numbers, curves and maps.

mod differences;
mod page;

pub use differences::{CurveDifference, Differences, MapDifference, NumberDifference, Run};
pub use page::runs_html;
