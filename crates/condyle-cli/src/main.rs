//! The condyle command: words to calls, nothing else.

mod arguments;
mod calibrate;
mod check;
mod compare;
mod machine;
mod manual;
mod new;
mod output;
mod progress;
mod report;
mod run;
mod run_tables;
mod study;

use std::process::ExitCode;

use clap::Parser;
use condyle_case::case::Case;

use arguments::{Arguments, Command};
use output::{Done, Failure};

fn main() -> ExitCode {
    if !condyle_lab::is_processor_supported() {
        return Failure::bad_input(
            "this build of condyle needs AVX2 and FMA, which this processor lacks; build it with RUSTFLAGS=\"-C \
             target-cpu=x86-64\" cargo build --release, which runs at about half the speed",
        )
        .exit();
    }
    match run_command() {
        Ok(code) => code,
        Err(failure) => failure.exit(),
    }
}

// A function of its own, so that no vector instruction moves before the check of the processor.
#[inline(never)]
fn run_command() -> Done {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(words) => return output::print_from_parser(&words),
    };
    match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::New(arguments) => new::new(&arguments),
        Command::Schema(arguments) if arguments.results => {
            output::print(&condyle_results::results_schema())
        }
        Command::Schema(_) => output::print(&Case::json_schema()),
        Command::Machine(arguments) => machine::machine(&arguments),
        Command::Export(arguments) => new::export(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Plot(arguments) => report::plot(&arguments),
        Command::Diff(arguments) => report::diff(&arguments),
        Command::Converge(arguments) => study::converge(&arguments),
        Command::Sensitivity(arguments) => study::sensitivity(&arguments),
        Command::Uncertainty(arguments) => study::uncertainty(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Command::CalibrateWear(arguments) => calibrate::calibrate_wear(&arguments),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { folder, force } => manual::man(&folder, force),
    }
}
