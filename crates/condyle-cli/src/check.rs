//! `condyle check`.

use std::process::ExitCode;

use crate::{arguments::Check, exit, output, standard_error::tell};

pub fn check(arguments: &Check) -> ExitCode {
    let (case, warnings) =
        match condyle_lab::check_changed(&arguments.case, &arguments.changes.set, 1) {
            Ok(checked) => checked,
            Err(error) => return exit::fail_run(&error),
        };
    warnings
        .iter()
        .for_each(|warning| tell(format_args!("warning: {warning}")));
    if arguments.print {
        output::print(&case.to_toml())
    } else {
        let case = arguments.case.display();
        output::print(&format!("{case}: the case is good\n"))
    }
}
