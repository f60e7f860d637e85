//! Studies: a case run many times with changed values, the plan of its tests, their results and the answers.

mod answers;
mod chance;
mod converge;
mod design;
mod distribution;
mod engine;
mod error;
mod observed_order;
mod page;
mod plan;
mod search;
pub mod sensitivity;
mod store;
pub mod uncertainty;

pub use crate::{
    answers::{
        Answers, FailedTests,
        effects::{Effect, Elementary},
        indices::Indices,
        ranking::{Best, Designed, Front, Ranking},
        spread::{Beyond, Spread},
    },
    converge::{
        ConvergeError, ConvergeHappening, ConvergeOptions, ConvergePlan, Converged, Convergence,
        Listener, Planned, Point, QUANTITIES, Quantity, converge,
    },
    engine::{Done, HeldFolder, Progress, StudyEnd, StudyOptions, TestBench, merge, run_study},
    error::StudyError,
    observed_order::{Extrapolation, extrapolate},
    page::{answer, write_answers},
    plan::{Plan, Shard, Test, TestResult},
    store::{DATABASE, Store},
};
