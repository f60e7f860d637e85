//! `condyle report`.

use std::process::ExitCode;

use crate::{
    arguments::Report,
    exit,
    output::{self, Lines},
};

pub fn report(arguments: &Report) -> ExitCode {
    let folder = &arguments.results;
    let mut written = vec![condyle_report::write_report(folder)];
    if arguments.pictures {
        written.push(condyle_report::write_wear_map(folder));
        written.push(condyle_report::write_wear_curve(folder));
        written.push(condyle_report::write_kinematics(folder));
    }
    let mut lines = Lines::default();
    for file in written {
        match file {
            Ok(path) => lines.line(format_args!("wrote {}", path.display())),
            Err(error) => return exit::fail(error, exit::BAD_INPUT),
        }
    }
    output::print(lines.text())
}
