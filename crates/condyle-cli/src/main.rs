//! The condyle command: words to calls, nothing else.

mod arguments;
mod check;
mod converge;
mod exit;
mod export;
mod new;
mod progress;
mod report;
mod run;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::New(arguments) => new::new(&arguments),
        Command::Export(arguments) => export::export(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Converge(arguments) => converge::converge(&arguments),
    }
}
