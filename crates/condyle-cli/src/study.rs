//! `condyle study`, and the studies with ready-made plans: `converge`, `sensitivity` and `uncertainty`.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    process::ExitCode,
    thread,
};

use condyle_case::cache::Cache;
use condyle_lab::{Outcome, RunOptions, run_case};
use condyle_study::{
    ConvergeOptions, Listener, Plan, Shard, Store, StudyError, StudyOptions, merge, run_study,
    write_answers,
};

use crate::{
    arguments::{
        Converge, RunRow, Sensitivity, Study, StudyCommand, StudyExport, StudyMerge, Uncertainty,
    },
    output::{self, Done, Failure, Unwritten, note},
    progress::{self, RunProgress, StudyProgress},
};

pub fn study(arguments: &Study) -> Done {
    match &arguments.command {
        Some(StudyCommand::Export(arguments)) => export(arguments),
        Some(StudyCommand::RunRow(arguments)) => run_row(arguments),
        Some(StudyCommand::Merge(arguments)) => merged(arguments),
        None => run(arguments),
    }
}

pub fn converge(arguments: &Converge) -> Done {
    let case = &arguments.case;
    let name = case.file_stem().unwrap_or_default().to_string_lossy();
    let default = || Path::new("results").join(format!("{name}-converge"));
    let out = &arguments.out.clone().unwrap_or_else(default);
    let options = ConvergeOptions {
        out: out.clone(),
        threads: threads(arguments.threads),
        resume: arguments.resume,
        cache: Cache::of_user(),
    };
    // The progress bar ends with this block, before anything is printed.
    let convergence = {
        let mut progress = StudyProgress::new(true);
        let mut listener = |event: &_| progress.show(event);
        condyle_study::converge(case, &arguments.over, &options, &mut listener)
    };
    let convergence = convergence.map_err(|error| match error {
        StudyError::Interrupted => Failure::interrupted(
            "interrupted: the results so far are kept; resume with the same command and --resume",
        ),
        other => other.into(),
    })?;
    if arguments.json {
        let path = out.join("converge.json");
        let text = fs::read_to_string(&path)
            .map_err(|error| Failure::bad_input(format_args!("{}: {error}", path.display())))?;
        return output::print_with_folder(&text, out);
    }
    print_with_picture(&convergence.markdown(), out, "converge.svg")
}

pub fn sensitivity(arguments: &Sensitivity) -> Done {
    let (case, threads) = (&arguments.case, threads(arguments.threads));
    let found = in_memory(|listener| condyle_study::sensitivity(case, threads, listener))?;
    if arguments.json {
        return output::print(&output::json(&found));
    }
    output::print(&found.markdown())
}

pub fn uncertainty(arguments: &Uncertainty) -> Done {
    let (case, threads) = (&arguments.case, threads(arguments.threads));
    let (runs, seed) = (arguments.runs.into(), arguments.seed);
    let found =
        in_memory(|listener| condyle_study::uncertainty(case, runs, seed, threads, listener))?;
    if arguments.json {
        return output::print(&output::json(&found));
    }
    output::print(&found.markdown())
}

/// Runs a study that stores nothing.
fn in_memory<T>(
    run: impl FnOnce(&mut Listener<'_>) -> Result<T, StudyError>,
) -> Result<T, StudyError> {
    let mut progress = StudyProgress::new(false);
    run(&mut |event| progress.show(event))
}

/// Returns the requested number of threads, or the number of cores.
fn threads(requested: Option<u16>) -> usize {
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    requested.map_or_else(cores, usize::from)
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Study(problems) => Self::from(&problems),
            StudyError::Run(error) => error.into(),
            StudyError::RunWith { number, source } => {
                note(format_args!("in the run with {number}:"));
                Self::from(*source)
            }
            StudyError::Interrupted => Self::interrupted(
                "interrupted: the results so far are kept; the same command resumes",
            ),
            other => Self::bad_input(other),
        }
    }
}

/// `results/` and the study's name.
fn default_folder(study: &Path, shard: Shard) -> PathBuf {
    let name = study.file_stem().unwrap_or_default().to_string_lossy();
    let results = PathBuf::from("results");
    if shard.is_whole() {
        return results.join(name.as_ref());
    }
    results.join(format!("{name}-{}", shard.to_string().replace('/', "-of-")))
}

fn run(arguments: &Study) -> Done {
    let Some(path) = &arguments.study else {
        return Err(Failure::bad_input("a study file is needed"));
    };
    let plan = Plan::read(path)?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let out = arguments.out.clone();
    let options = StudyOptions {
        threads: threads(arguments.threads),
        shard,
        out: out.unwrap_or_else(|| default_folder(path, shard)),
    };
    {
        let mut progress = StudyProgress::new(true);
        run_study(&plan, &options, &mut |event| progress.show(event))?;
    }
    if shard.is_whole() {
        return answered(&plan, &options.out, arguments.json);
    }
    note(format_args!(
        "shard {shard} is done, in {}; join all shards with: condyle study merge {} FOLDERS",
        options.out.display(),
        path.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// Writes the answers of a study, and prints them.
fn answered(plan: &Plan, out: &Path, json: bool) -> Done {
    let answers = write_answers(plan, out)?;
    if json {
        return output::print_with_folder(&output::json(&answers), out);
    }
    print_with_picture(&answers.markdown(), out, "study.html")
}

/// Prints results whose folder holds the picture or page `name`.
fn print_with_picture(text: &str, out: &Path, name: &str) -> Done {
    let (folder, picture) = (out.display(), out.join(name));
    let text = format!("{text}\nresults in {folder}; open {}\n", picture.display());
    output::print_with_folder(&text, out)
}

fn export(arguments: &StudyExport) -> Done {
    let store = Store::read(&arguments.folder)?;
    if let Some(path) = &arguments.csv {
        let mut table = Vec::new();
        let written = store.write_csv(&mut table)?;
        written.map_err(|error| Unwritten::new(path, &error))?;
        output::write_file(path, &table, arguments.force)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut out = io::stdout().lock();
    output::ended(store.write_csv(&mut out)?.and_then(|()| out.flush()), "")
}

fn run_row(arguments: &RunRow) -> Done {
    let plan = Plan::read(&arguments.study)?;
    let row = arguments.row;
    let folder = default_folder(&arguments.study, Shard::WHOLE);
    let test = plan.row(row, Some(&folder))?;
    let out = arguments.out.clone();
    let options = RunOptions {
        out: out.unwrap_or_else(|| folder.join(format!("row-{row}"))),
        resume: false,
        force: false,
        threads: 1,
        cache: Cache::of_user(),
        report: true,
    };
    plan.assignments(&test).iter().for_each(note);
    let case = plan.case_of(&test)?;
    let outcome = {
        let mut progress = RunProgress::new();
        run_case(&case, &options, &mut |event| progress.show(&event))?
    };
    if let Outcome::Interrupted(reached) = outcome {
        return Err(Failure::interrupted(format_args!(
            "interrupted: {}; run the row again into another folder, with --out",
            progress::in_words(&reached)
        )));
    }
    let (folder, page) = (options.out.display(), options.out.join("report.html"));
    let text = format!("results in {folder}; open {}\n", page.display());
    output::print_with_folder(&text, &options.out)
}

fn merged(arguments: &StudyMerge) -> Done {
    let plan = Plan::read(&arguments.study)?;
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| default_folder(&arguments.study, Shard::WHOLE));
    let (kept, tests) = (merge(&plan, &arguments.shards, &out)?, plan.tests());
    if kept < tests {
        note(format_args!(
            "{kept} of {tests} tests are stored; finish the shards and merge again, or continue here with: condyle study {} \
             --out {}",
            arguments.study.display(),
            out.display()
        ));
    }
    answered(&plan, &out, arguments.json)
}
