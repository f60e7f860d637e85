//! `condyle new`.

use std::{fs::File, io::Write, process::ExitCode};

use condyle_io::case::template;

use crate::{arguments::New, exit, output};

pub fn new(arguments: &New) -> ExitCode {
    let path = &arguments.case;
    let written = File::create_new(path)
        .and_then(|mut file| file.write_all(template(arguments.preset).as_bytes()));
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
