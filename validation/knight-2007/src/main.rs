//! The table of Knight et al. 2007, run by `validation/knight-2007/run`.

use std::{env, ops::ControlFlow, path::PathBuf, process::ExitCode};

use condyle_knight_2007::{Stamp, StudyFiles, study};
use condyle_study::StudyEvent;

const USAGE: &str =
    "usage: knight_2007 FORCE.toml DISPLACEMENT.toml EMPTY_FOLDER_FOR_RUNS OUT_FOLDER COMMIT DATE";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let Ok([force, displacement, runs, out, commit, date]) = <[String; 6]>::try_from(arguments)
    else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    let files = StudyFiles {
        force_case: PathBuf::from(force),
        displacement_case: PathBuf::from(displacement),
        runs: PathBuf::from(runs),
        out: PathBuf::from(out),
    };
    match study(&files, &Stamp { commit, date }, &mut report) {
        Ok(table) => {
            print!("{table}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn report(event: &StudyEvent) -> ControlFlow<()> {
    if let StudyEvent::Message(message) = event {
        eprintln!("{message}");
    }
    ControlFlow::Continue(())
}
