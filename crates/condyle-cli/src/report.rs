//! `condyle report`.

use std::{path::Path, process::ExitCode};

use crate::{
    arguments::Report,
    exit,
    output::{self, Lines},
    standard_error::tell,
};

pub fn report(arguments: &Report) -> ExitCode {
    let folder = &arguments.results;
    let (page, left_out) = match condyle_report::write_report_of_what_can_be_read(folder) {
        Ok(written) => written,
        Err(error) => return exit::fail(error, exit::BAD_INPUT),
    };
    for why in left_out {
        tell(format_args!("warning: left out of the page: {why}"));
    }
    note_unfinished(folder);
    let mut written = vec![Ok(page)];
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

/// Says of a folder of results that its run is not done, so that what is made from it is not taken for the
/// whole.
pub fn note_unfinished(folder: &Path) {
    let is_begun = folder.join("checkpoint").exists() && !folder.join("summary.json").exists();
    if is_begun {
        tell(format_args!(
            "note: the run in {} is not finished (there is no summary.json); shown is how far it is",
            folder.display()
        ));
    }
}
