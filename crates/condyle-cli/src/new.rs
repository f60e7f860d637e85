//! `condyle new`.

use std::{
    fs::{self, File},
    io::{ErrorKind, Write},
    path::{Path, PathBuf},
    process::ExitCode,
    thread,
};

use condyle_case::case::{Case, Draft, DraftError, template};
use condyle_lab::Preview;

use crate::{arguments::New, exit, output, standard_error::tell};

/// The schema file next to a case, which the case names in its first line.
const SCHEMA: &str = "condyle.schema.json";

pub fn new(arguments: &New) -> ExitCode {
    let text = match text(arguments) {
        Ok(text) => text,
        Err(DraftError::Case(problems)) => return exit::fail_case(&problems),
        Err(error) => return exit::fail(error, exit::BAD_INPUT),
    };
    let path = &arguments.case;
    let text = format!("#:schema {SCHEMA}\n{text}");
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    if let Err(error) = written {
        let said = format!("{}: {error}; choose another name", path.display());
        return exit::fail(said, exit::BAD_INPUT);
    }
    write_schema(&path.with_file_name(SCHEMA));
    let picture = arguments.femur.as_ref().and_then(|_| drawn(path));
    let seen = picture.map_or(String::new(), |picture| {
        format!("look at {}; ", picture.display())
    });
    output::print(&format!(
        "wrote {}; {seen}run it with: condyle run {}\n",
        path.display(),
        path.display()
    ))
}

/// Writes the schema for editors, unless it exists; a case runs without it.
fn write_schema(path: &Path) {
    let written =
        File::create_new(path).and_then(|mut file| file.write_all(Case::json_schema().as_bytes()));
    match written {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            tell(format_args!("warning: {}: {error}", path.display()));
        }
        _ => {}
    }
}

/// Draws the bodies in place into a file next to the case, or warns why it cannot.
fn drawn(case: &Path) -> Option<PathBuf> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let picture = case.with_extension("svg");
    let drawn = Preview::of(case, &[], threads)
        .map_err(|error| format!("the case does not start yet: {error}"))
        .and_then(|preview| {
            fs::write(&picture, preview.picture_svg())
                .map_err(|error| format!("{}: {error}", picture.display()))
        });
    if let Err(why) = &drawn {
        tell(format_args!("warning: no picture: {why}"));
    }
    drawn.is_ok().then_some(picture)
}

/// Returns the case to write: of two meshes if they are given, else of the generic implant.
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
