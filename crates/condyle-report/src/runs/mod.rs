//! Several runs side by side: in which settings, numbers, curves and maps they differ.

mod curves;
mod differences;
mod maps;
mod numbers;
mod page;
mod pictures;
mod run;
mod settings;

pub use curves::CurveDifference;
pub use differences::Differences;
pub use maps::MapDifference;
pub use numbers::NumberDifference;
pub use page::{runs_html, write_runs};
pub use run::Run;
pub use settings::SettingDifference;
