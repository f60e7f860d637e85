//! The condyle command: words to calls, nothing else.

mod arguments;
mod calibrate;
mod calibrate_wear;
mod check;
mod compare;
mod diff;
mod exit;
mod export;
mod new;
mod output;
mod plot;
mod processor;
mod progress;
mod report;
mod run;
mod run_tables;
mod schema;
mod standard_error;
mod study;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    match processor::check() {
        Ok(()) => run_command(),
        Err(code) => code,
    }
}

/// Apart, so that no vector is used before the processor is looked at.
#[inline(never)]
fn run_command() -> ExitCode {
    match Arguments::try_parse() {
        Ok(arguments) => obey(arguments.command),
        Err(words) => output::print_from_parser(&words),
    }
}

fn obey(command: Command) -> ExitCode {
    match command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::New(arguments) => new::new(&arguments),
        Command::Schema(arguments) => schema::schema(&arguments),
        Command::Export(arguments) => export::export(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Diff(arguments) => diff::diff(&arguments),
        Command::Converge(arguments) => study::converge(&arguments),
        Command::Sensitivity(arguments) => study::sensitivity(&arguments),
        Command::Uncertainty(arguments) => study::uncertainty(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Command::CalibrateWear(arguments) => calibrate_wear::calibrate_wear(&arguments),
    }
}
