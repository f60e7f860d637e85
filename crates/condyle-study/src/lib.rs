//! Studies: a case run many times with changed values.
//!
//! One engine runs the tests of a [`Plan`], which defines each test by its number, on several threads. [`run_study`]
//! stores their results in a [`Store`], from which [`write_answers`] computes tables, pictures and a page.
//! [`sensitivity`], [`uncertainty`] and [`converge`] are ready-made plans with their own answers.

mod adaptive;
mod answers;
mod converge;
mod descent;
mod design;
mod distribution;
mod emulator;
mod engine;
mod error;
mod observed_order;
mod page;
mod plan;
mod population;
mod random;
mod search;
mod sensitivity;
mod store;
mod uncertainty;

use condyle_results::statistics;

pub use crate::{
    answers::Answers,
    converge::{ConvergeOptions, Convergence, Point, converge},
    engine::{Listener, Progress, StudyEvent, StudyOptions, TestBench, merge, run_study},
    error::StudyError,
    page::write_answers,
    plan::{Plan, Shard, Test, TestOutputs, TestResult},
    sensitivity::{Sensitivity, sensitivity},
    store::Store,
    uncertainty::{Uncertainty, uncertainty},
};
