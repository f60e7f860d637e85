//! `condyle report`.

use std::process::ExitCode;

use crate::{arguments::Report, exit};

pub fn report(arguments: &Report) -> ExitCode {
    let folder = &arguments.results;
    let mut written = vec![condyle_report::write_report(folder)];
    if arguments.pictures {
        written.push(condyle_report::write_wear_map(folder));
        written.push(condyle_report::write_wear_curve(folder));
        written.push(condyle_report::write_kinematics(folder));
    }
    for file in written {
        match file {
            Ok(path) => println!("wrote {}", path.display()),
            Err(error) => return exit::fail(error, exit::BAD_INPUT),
        }
    }
    ExitCode::SUCCESS
}
