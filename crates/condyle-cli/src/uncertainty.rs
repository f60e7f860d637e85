//! `condyle uncertainty`.

use std::{
    process::ExitCode,
    sync::atomic::{AtomicUsize, Ordering},
};

use condyle_study::uncertainty::{UncertaintyOptions, uncertainty as study};

use crate::{arguments::Uncertainty, converge::threads, exit, output, standard_error::tell};

/// A line is told after every so many runs.
const TOLD_EVERY: usize = 50;

pub fn uncertainty(arguments: &Uncertainty) -> ExitCode {
    let runs = arguments.runs as usize;
    let done = AtomicUsize::new(0);
    let tell_of = || {
        let count = 1 + done.fetch_add(1, Ordering::Relaxed);
        if count.is_multiple_of(TOLD_EVERY) || count == runs {
            tell(format_args!("{count} of {runs} runs"));
        }
    };
    let options = UncertaintyOptions {
        runs,
        seed: arguments.seed,
        threads: threads(arguments.threads),
    };
    match study(&arguments.case, options, &tell_of) {
        Ok(found) if arguments.json => output::print(&output::json(&found)),
        Ok(found) => output::print(&found.markdown()),
        Err(error) => exit::fail_run(&error),
    }
}
