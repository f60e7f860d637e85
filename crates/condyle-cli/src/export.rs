//! `condyle export`.

use std::{fs::File, io::Write, process::ExitCode};

use condyle_case::{
    abaqus::{AbaqusOptions, ExportError, PressedCase, write_abaqus},
    case::{BuildWarning, Case},
};
use condyle_lab::RunError;

use crate::{arguments::Export, exit, output, standard_error::tell};

pub fn export(arguments: &Export) -> ExitCode {
    let case = match Case::read(&arguments.case) {
        Ok(case) => case,
        Err(error) => return exit::fail_run(&error.into()),
    };
    let mut text = Vec::new();
    match write(arguments, &case, &mut text) {
        Ok(warnings) => {
            warnings
                .iter()
                .for_each(|warning| tell(format_args!("warning: {warning}")));
            save(arguments, &text)
        }
        Err(error) => fail(&case, error),
    }
}

fn write(
    arguments: &Export,
    case: &Case,
    text: &mut Vec<u8>,
) -> Result<Vec<BuildWarning>, ExportError> {
    let threads = usize::from(arguments.threads);
    if let Some(percent) = arguments.pressed_at {
        let pressed = PressedCase::new(case, threads)?;
        pressed.write(percent, text)?;
        return Ok(pressed.warnings);
    }
    let options = AbaqusOptions {
        deformable: arguments.deformable,
        explicit: arguments.explicit,
    };
    write_abaqus(case, options, threads, text)
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
        ExportError::Write { .. }
        | ExportError::Deformable
        | ExportError::Foundation
        | ExportError::Resting
        | ExportError::KinematicHardening { .. }
        | ExportError::Apart { .. } => return exit::fail(error, exit::BAD_INPUT),
    })
}

/// Writes a new file; one that is there already may hold somebody's changes.
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
