//! `condyle check`.

use std::process::ExitCode;

use condyle_io::case::Case;

use crate::{arguments::Check, exit};

pub fn check(arguments: &Check) -> ExitCode {
    let case = match Case::read(&arguments.case) {
        Ok(case) => case,
        Err(error) => return exit::fail_case(&error),
    };
    match case.build(1) {
        Ok(built) => built
            .warnings
            .iter()
            .for_each(|warning| eprintln!("warning: {warning}")),
        Err(error) => return exit::fail(error, exit::BAD_INPUT),
    }
    if arguments.print {
        print!("{}", case.to_toml());
    } else {
        println!("{}: the case is good", arguments.case.display());
    }
    ExitCode::SUCCESS
}
