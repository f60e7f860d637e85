//! Several runs side by side: the differences of their settings, numbers, curves and maps.

mod differences;
mod page;
mod run;

pub use differences::{
    CurveDifference, Differences, MapDifference, NumberDifference, SettingDifference,
};
pub use page::{runs_html, write_runs};
pub use run::Run;
