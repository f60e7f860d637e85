//! The table of Knight et al. 2007, run by `validation/knight-2007/run`.

use condyle_results::catalogue;
use std::{env, ops::ControlFlow, path::PathBuf, process::ExitCode};

use condyle_knight_2007::{Stamp, StudyFiles, study};
use condyle_study::ConvergeHappening;

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
    match study(&files, &Stamp { commit, date }, &report) {
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

fn report(on_event: &ConvergeHappening<'_>) -> ControlFlow<()> {
    if let ConvergeHappening::Ran(run, summary) = on_event {
        let (path, text) = (run.number.key(), run.number.text());
        eprintln!(
            "{path} = {text}: {:.3} mg worn",
            summary[&catalogue::MASS_LOSS_MG]
        );
    }
    ControlFlow::Continue(())
}
