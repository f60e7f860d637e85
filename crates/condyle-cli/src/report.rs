//! `condyle report`.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use condyle_report::runs::{Run, write_runs};

use crate::{
    arguments::Report,
    exit,
    output::{self, Lines},
    standard_error::tell,
};

pub fn report(arguments: &Report) -> ExitCode {
    match arguments.results.as_slice() {
        [folder] if arguments.out.is_none() => of_one(folder, arguments.pictures),
        [_] => exit::fail(
            "--out is for the page of several runs; the report of one stands in its folder",
            exit::BAD_INPUT,
        ),
        folders => side_by_side(folders, arguments),
    }
}

fn side_by_side(folders: &[PathBuf], arguments: &Report) -> ExitCode {
    if arguments.pictures {
        let said = "--pictures is for one results folder; condyle plot writes the pictures of each";
        return exit::fail(said, exit::BAD_INPUT);
    }
    let runs: Result<Vec<Run>, _> = folders.iter().map(|folder| Run::read(folder)).collect();
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| PathBuf::from("runs.html"));
    match runs.and_then(|runs| Ok((write_runs(&out, &runs)?, runs))) {
        Ok((page, runs)) => {
            for run in &runs {
                let left_out = run.results.left_out.iter();
                left_out
                    .for_each(|why| tell(format_args!("warning: left out of {}: {why}", run.name)));
            }
            folders.iter().for_each(|folder| note_unfinished(folder));
            output::print(&format!("wrote {}\n", page.display()))
        }
        Err(error) => exit::fail(error, exit::BAD_INPUT),
    }
}

fn of_one(folder: &Path, has_pictures: bool) -> ExitCode {
    let (page, left_out) = match condyle_report::write_readable_report(folder) {
        Ok(written) => written,
        Err(error) => return exit::fail(error, exit::BAD_INPUT),
    };
    for why in left_out {
        tell(format_args!("warning: left out of the page: {why}"));
    }
    note_unfinished(folder);
    let mut written = vec![page];
    if has_pictures {
        match condyle_report::write_pictures(folder) {
            Ok(pictures) => written.extend(pictures),
            Err(error) => return exit::fail(error, exit::BAD_INPUT),
        }
    }
    let mut lines = Lines::default();
    for path in written {
        lines.line(format_args!("wrote {}", path.display()));
    }
    output::print(lines.text())
}

/// Notes that the run of a results folder is not done, so that its page is not taken for the
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
