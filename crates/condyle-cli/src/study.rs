//! `condyle study` and what is done with one.

use std::{
    io::{self, IsTerminal, Write, stderr},
    ops::ControlFlow,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::atomic::Ordering,
    time::Instant,
};

use condyle_lab::Outcome;
use condyle_study::{
    Plan, Progress, Shard, Store, StudyEnd, StudyError, StudyOptions, merge, run_study,
    write_answers,
};
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    arguments::{RunRow, Study, StudyCommand, StudyExport, StudyMerge},
    converge::threads,
    exit, output,
    run::stop_on_interrupt,
    standard_error::tell,
};

/// Without a terminal, a line is told after every so many parts of a study.
const TOLD_PARTS: u64 = 20;

pub fn study(arguments: &Study) -> ExitCode {
    let done = match &arguments.command {
        Some(StudyCommand::Export(export)) => self::export(export),
        Some(StudyCommand::RunRow(row)) => run_row(row),
        Some(StudyCommand::Merge(merge)) => merged(merge),
        None => run(arguments),
    };
    done.unwrap_or_else(|error| fail(&error))
}

fn fail(error: &StudyError) -> ExitCode {
    match error {
        StudyError::Study(problems) => exit::fail_case(problems),
        StudyError::Run(error) => exit::fail_run(error),
        other => exit::fail(other, exit::BAD_INPUT),
    }
}

/// `results/` and the study's name.
fn default_folder(study: &Path, shard: Shard) -> PathBuf {
    let name = study
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    if shard.is_whole() {
        return PathBuf::from("results").join(name);
    }
    let shard = shard.to_string().replace('/', "-of-");
    PathBuf::from("results").join(format!("{name}-{shard}"))
}

fn run(arguments: &Study) -> Result<ExitCode, StudyError> {
    let Some(path) = &arguments.study else {
        return Ok(exit::fail("a study file is needed", exit::BAD_INPUT));
    };
    let plan = Plan::read(path)?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| default_folder(path, shard));
    let options = StudyOptions {
        threads: threads(arguments.threads),
        shard,
        out: out.clone(),
    };
    let stop = stop_on_interrupt();
    let mut bar = Bar::new();
    let ended = run_study(&plan, &options, &mut |progress| {
        bar.show(progress);
        if stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    bar.finish();
    match ended? {
        StudyEnd::Interrupted => {
            tell("interrupted: what was found is kept; the same command goes on");
            Ok(ExitCode::from(exit::INTERRUPTED))
        }
        StudyEnd::Done if !shard.is_whole() => {
            tell(format_args!(
                "shard {shard} is done, in {}; put all together with: condyle study merge {} FOLDERS",
                out.display(),
                path.display()
            ));
            Ok(ExitCode::SUCCESS)
        }
        StudyEnd::Done => answered(&plan, &out, arguments.json),
    }
}

/// Writes what a study tells, and prints it.
fn answered(plan: &Plan, out: &Path, json: bool) -> Result<ExitCode, StudyError> {
    let answers = write_answers(plan, out)?;
    if json {
        return Ok(output::print_beside(&output::json(&answers), out));
    }
    let text = format!(
        "{}\nresults in {}; open {}\n",
        answers.markdown(),
        out.display(),
        out.join("study.html").display()
    );
    Ok(output::print_beside(&text, out))
}

fn export(arguments: &StudyExport) -> Result<ExitCode, StudyError> {
    let store = Store::read(&arguments.folder)?;
    let Some(path) = &arguments.csv else {
        let mut out = io::stdout().lock();
        let written = store.write_csv(&mut out)?.and_then(|()| out.flush());
        return Ok(match written {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                exit::fail(error, exit::BAD_INPUT)
            }
            Ok(()) | Err(_) => ExitCode::SUCCESS,
        });
    };
    store.export_csv(path)?;
    Ok(ExitCode::SUCCESS)
}

fn run_row(arguments: &RunRow) -> Result<ExitCode, StudyError> {
    let plan = Plan::read(&arguments.study)?;
    let tests = plan.tests();
    let row = arguments.row;
    if row >= tests {
        return Err(StudyError::NoRow { row, tests });
    }
    let folder = || default_folder(&arguments.study, Shard::WHOLE);
    let test = match plan.test(row) {
        Some(test) => test,
        None => Store::existing(&folder(), &plan)?.test(row, &plan)?,
    };
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| folder().join(format!("row-{row}")));
    for set in plan.assignments(&test) {
        tell(format_args!("{set}"));
    }
    let stop = stop_on_interrupt();
    let mut progress = crate::progress::Progress::new();
    let outcome = plan.run_into_folder(&test, &out, &mut |event| {
        progress.show(&event);
        if stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    progress.finish();
    Ok(match outcome? {
        Outcome::Interrupted(_) => ExitCode::from(exit::INTERRUPTED),
        Outcome::Done(_) | Outcome::DoneBefore(_) => {
            let page = out.join("report.html");
            output::print_beside(
                &format!("results in {}; open {}\n", out.display(), page.display()),
                &out,
            )
        }
    })
}

fn merged(arguments: &StudyMerge) -> Result<ExitCode, StudyError> {
    let plan = Plan::read(&arguments.study)?;
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| default_folder(&arguments.study, Shard::WHOLE));
    let done = merge(&plan, &arguments.shards, &out)?;
    if done.kept < done.tests {
        tell(format_args!(
            "{} of {} tests are there; finish the shards and merge again, or go on here with: condyle study {} --out {}",
            done.kept,
            done.tests,
            arguments.study.display(),
            out.display()
        ));
    }
    answered(&plan, &out, arguments.json)
}

/// How far a study is, on standard error.
struct Bar {
    bar: Option<ProgressBar>,
    started: Instant,
    told: u64,
}

impl Bar {
    fn new() -> Self {
        Self {
            bar: None,
            started: Instant::now(),
            told: 0,
        }
    }

    fn show(&mut self, progress: Progress) {
        if !stderr().is_terminal() {
            return self.tell(progress);
        }
        let bar = self.bar.get_or_insert_with(|| {
            let style = ProgressStyle::with_template(
                "{bar:40} {pos} of {len} tests  {elapsed} gone, {eta} to go",
            );
            let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(progress.tests).with_style(style);
            bar.set_position(progress.kept);
            bar.reset_eta();
            bar
        });
        bar.set_position(progress.kept);
    }

    /// A line after every part, with the time that is left.
    fn tell(&mut self, progress: Progress) {
        let Progress {
            before,
            kept,
            tests,
        } = progress;
        if kept == before && before > 0 && self.told == 0 {
            tell(format_args!("going on: {before} of {tests} tests are kept"));
        }
        let part = kept * TOLD_PARTS / tests.max(1);
        if kept == before || part == self.told {
            return;
        }
        self.told = part;
        let spent_s = self.started.elapsed().as_secs_f64();
        let left_s = spent_s / (kept - before) as f64 * tests.saturating_sub(kept) as f64;
        tell(format_args!("{kept} of {tests} tests, {left_s:.0} s to go"));
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
