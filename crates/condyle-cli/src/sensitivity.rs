//! `condyle sensitivity`.

use std::{
    process::ExitCode,
    sync::atomic::{AtomicUsize, Ordering},
};

use condyle_study::sensitivity::{Change, sensitivity as study};

use crate::{arguments::Sensitivity, converge::threads, exit, output, standard_error::tell};

pub fn sensitivity(arguments: &Sensitivity) -> ExitCode {
    let run = AtomicUsize::new(0);
    let tell_of = |change: &Change| {
        let count = 1 + run.fetch_add(1, Ordering::Relaxed);
        let (assumption, change) = (change.assumption, &change.change);
        tell(format_args!("{count} run: {assumption}: {change}"));
    };
    match study(&arguments.case, threads(arguments.threads), &tell_of) {
        Ok(found) if arguments.json => output::print(&output::json(&found)),
        Ok(found) => output::print(&found.markdown()),
        Err(error) => exit::fail_run(&error),
    }
}
