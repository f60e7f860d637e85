//! The program that the web page of condyle calls, built for `wasm32-wasip1`.
//!
//! The page keeps a few files in memory and calls this program once for every task; the program answers on standard
//! output, with one [`Message`] as JSON per line.
//!
//! | arguments | effect |
//! | --- | --- |
//! | `preview CASE OUT` | runs it into the results folder OUT with few increments and updates, and estimates no errors |
//! | `run CASE OUT SCENE` | runs it into the results folder OUT, without its report; SCENE receives what the page shows |
//! | `report OUT` | writes the report of the results folder OUT |
//! | `draft CASE FEMUR INSERT` | writes a case of two meshes, as `condyle new` does |
//!
//! It ends with 0, with 2 on bad input and with 3 where the physics could not be solved, as the command does.

mod draft;
mod failure;
mod message;
mod runs;

use std::{env, path::Path, process::ExitCode};

use failure::Failure;
use message::{Message, send};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match done(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let code = failure.exit_code();
            send(&Message::Failed(failure));
            ExitCode::from(code)
        }
    }
}

fn done(words: &[&str]) -> Result<(), Failure> {
    match words {
        ["preview", case, out] => {
            runs::run(&runs::coarse(runs::read(Path::new(case))?), Path::new(out))
        }
        ["run", case, out, scene] => {
            runs::run(&runs::read(Path::new(case))?, Path::new(out))?;
            runs::draw(Path::new(out), Path::new(scene))
        }
        ["report", out] => runs::report(Path::new(out)),
        ["draft", case, femur, insert] => {
            draft::draft(Path::new(case), Path::new(femur), Path::new(insert))
        }
        _ => Err(Failure::of_words(format!(
            "{words:?} is not a call of this program, which serves the web page; its source lists the calls"
        ))),
    }
}
