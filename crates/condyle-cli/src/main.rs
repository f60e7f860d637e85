//! The condyle command: words to calls, nothing else.

mod arguments;
mod calibrate;
mod check;
mod compare;
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
    match check_processor().and_then(|()| run_command()) {
        Ok(code) => code,
        Err(failure) => failure.exit(),
    }
}

/// Fails if the processor lacks instructions that the build requires.
///
/// Without this check the program would end at the first vector with "illegal instruction". The check of the standard
/// library answers from the build, not from the processor.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
fn check_processor() -> Result<(), Failure> {
    let processor = raw_cpuid::CpuId::new();
    let extended = processor.get_extended_feature_info();
    let features = processor.get_feature_info();
    if extended.is_some_and(|one| one.has_avx2()) && features.is_some_and(|one| one.has_fma()) {
        return Ok(());
    }
    Err(Failure::bad_input(
        "this condyle was built for x86 processors with AVX2 and FMA, and this one lacks them; build it with \
         RUSTFLAGS=\"-C target-cpu=x86-64\" cargo build --release, and it runs at about half the speed",
    ))
}

#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
fn check_processor() -> Result<(), Failure> {
    Ok(())
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
    }
}
