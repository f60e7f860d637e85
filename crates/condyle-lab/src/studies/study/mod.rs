//! A case run again and again with what varies of it: the tests, where they are kept, and what they tell.

mod answers;
mod design;
mod error;
mod held;
mod pictures;
mod plan;
mod quantile;
mod runner;
mod search;
mod shard;
mod store;
mod test_run;
mod written;

pub use answers::{
    Answers, Best, Beyond, Designed, Effect, Elementary, FailedTests, Front, Indices, Ranking,
    Spread,
};
pub use error::StudyError;
pub use held::HeldFolder;
pub use plan::{Plan, Test};
pub use runner::{Done, Progress, StudyEnd, StudyOptions, merge, run_study};
pub use shard::Shard;
pub use store::{DATABASE, Store};
pub use test_run::{TestBench, TestResult};
pub use written::{answer, write_answers};
