//! The program that the web page of condyle calls, built for `wasm32-wasip1`.
//!
//! The page keeps a few files in memory and calls this program once for every task; the program answers on standard
//! output, with one [`Message`] as JSON per line.
//!
//! | arguments | effect |
//! | --- | --- |
//! | `check CASE` | reports the problems of the text and files of a case |
//! | `run CASE OUT` | runs it in memory; OUT receives `scene` and `summary.json` |
//! | `keep CASE OUT` | runs it into the results folder OUT, report and all |
//! | `draft CASE FEMUR INSERT` | writes a case of two meshes, as `condyle new` does |
//!
//! It ends with 0, with 2 on bad input and with 3 where the physics could not be solved, as the command does.

mod draft;
mod failure;
mod message;
mod recorder;
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
        ["check", case] => runs::check(Path::new(case)),
        ["run", case, out] => runs::run(Path::new(case), Path::new(out)),
        ["keep", case, out] => runs::keep(Path::new(case), Path::new(out)),
        ["draft", case, femur, insert] => {
            draft::draft(Path::new(case), Path::new(femur), Path::new(insert))
        }
        _ => Err(Failure::of_words(format!(
            "{words:?} is not a call of this program, which serves the web page; its source lists the calls"
        ))),
    }
}
