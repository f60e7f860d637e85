//! `condyle export`.

use std::{fs::File, io::Write, process::ExitCode};

use condyle_io::{
    abaqus::{AbaqusOptions, ExportError, write_abaqus},
    case::Case,
};
use condyle_lab::RunError;

use crate::{arguments::Export, exit, output, standard_error::tell};

pub fn export(arguments: &Export) -> ExitCode {
    let case = match Case::read(&arguments.case) {
        Ok(case) => case,
        Err(error) => return exit::fail_run(&error.into()),
    };
    let options = AbaqusOptions {
        deformable: arguments.deformable,
        explicit: arguments.explicit,
    };
    let mut text = Vec::new();
    match write_abaqus(&case, options, usize::from(arguments.threads), &mut text) {
        Ok(warnings) => {
            warnings
                .iter()
                .for_each(|warning| tell(format_args!("warning: {warning}")));
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
        ExportError::Write { .. } | ExportError::Deformable => {
            return exit::fail(error, exit::BAD_INPUT);
        }
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
