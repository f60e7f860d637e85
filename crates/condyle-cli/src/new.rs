//! `condyle new`.

use std::{fs::File, io::Write, process::ExitCode};

use condyle_io::case;

use crate::{
    arguments::{New, Preset},
    exit,
};

pub fn new(arguments: &New) -> ExitCode {
    let preset = match arguments.preset {
        Preset::StanmoreForce => case::Preset::StanmoreForce,
        Preset::StanmoreDisplacement => case::Preset::StanmoreDisplacement,
    };
    let path = &arguments.case;
    let written = File::create_new(path)
        .and_then(|mut file| file.write_all(case::template(preset).as_bytes()));
    match written {
        Ok(()) => {
            println!(
                "wrote {}; run it with: condyle run {}",
                path.display(),
                path.display()
            );
            ExitCode::SUCCESS
        }
        Err(error) => exit::fail(
            format!("{}: {error}; choose another name", path.display()),
            exit::BAD_INPUT,
        ),
    }
}
