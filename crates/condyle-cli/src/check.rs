//! `condyle check`.

use std::process::ExitCode;

use crate::{arguments::Check, exit};

pub fn check(arguments: &Check) -> ExitCode {
    let (case, warnings) = match condyle_lab::check(&arguments.case, 1) {
        Ok(checked) => checked,
        Err(error) => return exit::fail_run(&error),
    };
    warnings
        .iter()
        .for_each(|warning| eprintln!("warning: {warning}"));
    if arguments.print {
        print!("{}", case.to_toml());
    } else {
        println!("{}: the case is good", arguments.case.display());
    }
    ExitCode::SUCCESS
}
