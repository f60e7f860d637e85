//! `condyle export`.

use std::{fs::File, io::Write, process::ExitCode};

use condyle_case::{
    abaqus::{ExportError, PressedCase},
    case::Case,
};
use condyle_lab::RunError;

use crate::{arguments::Export, exit, output, standard_error::tell};

pub fn export(arguments: &Export) -> ExitCode {
    let case = match Case::read(&arguments.case) {
        Ok(case) => case,
        Err(error) => return exit::fail_run(&error.into()),
    };
    let mut text = Vec::new();
    let written = PressedCase::new(&case, usize::from(arguments.threads)).and_then(|pressed| {
        pressed.write(arguments.pressed_at, &mut text)?;
        Ok(pressed.warnings)
    });
    match written {
        Ok(warnings) => {
            for warning in &warnings {
                tell(format_args!("warning: {warning}"));
            }
            save(arguments, &text)
        }
        Err(error) => fail(&case, error),
    }
}

/// Fails as a run of the same case would.
fn fail(case: &Case, error: ExportError) -> ExitCode {
    exit::fail_run(&match error {
        ExportError::Build(source) => RunError::Build {
            shown: case.at_its_key(&source),
            source: Box::new(source),
        },
        ExportError::Placement(source) => RunError::Placement {
            shown: case.placement_at_its_key(&source, &[]),
            source,
        },
        ExportError::Cycle(source) => RunError::March {
            source: *source,
            out: None,
        },
        ExportError::Write { .. } | ExportError::Unsupported { .. } | ExportError::Apart { .. } => {
            return exit::fail(error, exit::BAD_INPUT);
        }
    })
}

/// Writes a new file; an existing one is kept, because a user may have edited it.
fn save(arguments: &Export, text: &[u8]) -> ExitCode {
    let path = &arguments.out;
    let written = File::create_new(path).and_then(|mut file| file.write_all(text));
    match written {
        Ok(()) => output::print(&format!("wrote {}\n", path.display())),
        Err(error) => exit::fail(
            format!("{}: {error}; choose another name or folder", path.display()),
            exit::BAD_INPUT,
        ),
    }
}
