//! `condyle new`.

use std::{fs::File, io::Write, path::Path, process::ExitCode};

use condyle_io::case::{Draft, DraftError, template};

use crate::{arguments::New, exit, output, standard_error::tell};

pub fn new(arguments: &New) -> ExitCode {
    let text = match text(arguments) {
        Ok(text) => text,
        Err(DraftError::Case(problems)) => return exit::fail_case(&problems),
        Err(error) => return exit::fail(error, exit::BAD_INPUT),
    };
    let path = &arguments.case;
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    match written {
        Ok(()) => output::print(&format!(
            "wrote {}; run it with: condyle run {}\n",
            path.display(),
            path.display()
        )),
        Err(error) => exit::fail(
            format!("{}: {error}; choose another name", path.display()),
            exit::BAD_INPUT,
        ),
    }
}

/// The case to write: of two meshes if they are given, and else of the generic implant.
fn text(arguments: &New) -> Result<String, DraftError> {
    let (Some(femur), Some(insert)) = (&arguments.femur, &arguments.insert) else {
        return Ok(template(arguments.preset));
    };
    let draft = Draft {
        preset: arguments.preset,
        side: arguments.side,
        femur,
        insert,
    };
    let folder = arguments
        .case
        .parent()
        .filter(|folder| *folder != Path::new(""));
    let drafted = draft.drafted(folder.unwrap_or(Path::new(".")))?;
    drafted.remarks.iter().for_each(tell);
    Ok(drafted.text)
}
