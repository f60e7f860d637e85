//! `condyle study`, and the studies with ready-made plans: `converge`, `sensitivity` and `uncertainty`.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, IsTerminal, Write, stderr},
    ops::ControlFlow,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Instant,
};

use condyle_case::cache::Cache;
use condyle_lab::{Outcome, RunOptions, run_case};
use condyle_study::{
    ConvergeOptions, Listener, Plan, Progress, Shard, Store, StudyError, StudyEvent, StudyOptions,
    UncertaintyOptions, merge, run_study, write_answers,
};
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    arguments::{
        Converge, RunRow, Sensitivity, Study, StudyCommand, StudyExport, StudyMerge, Uncertainty,
    },
    exit, output,
    run::stop_on_interrupt,
    standard_error::tell,
};

/// Lines of progress without a terminal.
const MAX_LINES: u64 = 20;

pub fn study(arguments: &Study) -> ExitCode {
    let done = match &arguments.command {
        Some(StudyCommand::Export(export)) => self::export(export),
        Some(StudyCommand::RunRow(row)) => run_row(row),
        Some(StudyCommand::Merge(merge)) => merged(merge),
        None => run(arguments),
    };
    let resume = "interrupted: what was found is kept; the same command goes on";
    done.unwrap_or_else(|error| fail(&error, resume))
}

pub fn converge(arguments: &Converge) -> ExitCode {
    let options = ConvergeOptions {
        out: arguments.out.clone(),
        threads: threads(arguments.threads),
        resume: arguments.resume,
        cache: Cache::of_user(),
    };
    let mut bar = Bar::new(Some(stop_on_interrupt()));
    let found = condyle_study::converge(
        &arguments.case,
        &arguments.over,
        &options,
        &mut |event: &StudyEvent| bar.show(event),
    );
    bar.finish();
    let out = &arguments.out;
    match found {
        Ok(_) if arguments.json => {
            let path = out.join("converge.json");
            match fs::read_to_string(&path) {
                Ok(text) => output::print_beside(&text, out),
                Err(error) => exit::fail(format!("{}: {error}", path.display()), exit::BAD_INPUT),
            }
        }
        Ok(convergence) => {
            let (table, picture) = (convergence.markdown(), out.join("converge.svg"));
            let (out_shown, picture) = (out.display(), picture.display());
            let text = format!("{table}\nresults in {out_shown}; open {picture}\n");
            output::print_beside(&text, out)
        }
        Err(error) => fail(
            &error,
            "interrupted: what was computed is kept; go on with the same command and --resume",
        ),
    }
}

pub fn sensitivity(arguments: &Sensitivity) -> ExitCode {
    let threads = threads(arguments.threads);
    answer_in_memory(
        arguments.json,
        condyle_study::Sensitivity::markdown,
        |listener| condyle_study::sensitivity(&arguments.case, threads, listener),
    )
}

pub fn uncertainty(arguments: &Uncertainty) -> ExitCode {
    let options = UncertaintyOptions {
        runs: arguments.runs.into(),
        seed: arguments.seed,
        threads: threads(arguments.threads),
    };
    answer_in_memory(
        arguments.json,
        condyle_study::Uncertainty::markdown,
        |listener| condyle_study::uncertainty(&arguments.case, options, listener),
    )
}

/// Prints the answers of a study that stores nothing.
fn answer_in_memory<T: serde::Serialize>(
    json: bool,
    markdown: impl FnOnce(&T) -> String,
    run: impl FnOnce(&mut Listener<'_>) -> Result<T, StudyError>,
) -> ExitCode {
    // Without a handler, Ctrl-C ends the program at once: there is nothing to keep.
    let mut bar = Bar::new(None);
    let found = run(&mut |event: &StudyEvent| bar.show(event));
    bar.finish();
    match found {
        Ok(found) if json => output::print(&output::json(&found)),
        Ok(found) => output::print(&markdown(&found)),
        Err(error) => fail(&error, "interrupted"),
    }
}

/// Returns the requested number of threads, or the number of cores.
pub fn threads(asked_for: Option<u16>) -> usize {
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    asked_for.map_or_else(cores, usize::from)
}

fn fail(error: &StudyError, interrupted: &str) -> ExitCode {
    match error {
        StudyError::Study(problems) => exit::fail_case(problems),
        StudyError::Run(error) => exit::fail_run(error),
        StudyError::RunWith { number, source } => {
            tell(format_args!("in the run with {number}:"));
            exit::fail_run(source)
        }
        StudyError::Interrupted => {
            tell(interrupted);
            ExitCode::from(exit::INTERRUPTED)
        }
        other => exit::fail(other, exit::BAD_INPUT),
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

fn run(arguments: &Study) -> Result<ExitCode, StudyError> {
    let Some(path) = &arguments.study else {
        return Ok(exit::fail("a study file is needed", exit::BAD_INPUT));
    };
    let plan = Plan::read(path)?;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| default_folder(path, shard));
    let options = StudyOptions {
        threads: threads(arguments.threads),
        shard,
        out: out.clone(),
    };
    let mut bar = Bar::new(Some(stop_on_interrupt()));
    let ended = run_study(&plan, &options, &mut |event| bar.show(event));
    bar.finish();
    ended?;
    if shard.is_whole() {
        return answered(&plan, &out, arguments.json);
    }
    tell(format_args!(
        "shard {shard} is done, in {}; put all together with: condyle study merge {} FOLDERS",
        out.display(),
        path.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// Writes the answers of a study, and prints them.
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
    if let Some(path) = &arguments.csv {
        store.export_csv(path)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut out = io::stdout().lock();
    let written = store.write_csv(&mut out)?.and_then(|()| out.flush());
    Ok(match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            exit::fail(error, exit::BAD_INPUT)
        }
        Ok(()) | Err(_) => ExitCode::SUCCESS,
    })
}

fn run_row(arguments: &RunRow) -> Result<ExitCode, StudyError> {
    let plan = Plan::read(&arguments.study)?;
    let row = arguments.row;
    let folder = || default_folder(&arguments.study, Shard::WHOLE);
    let test = plan.row(row, Some(&folder()))?;
    let out = arguments.out.clone();
    let options = RunOptions {
        out: out.unwrap_or_else(|| folder().join(format!("row-{row}"))),
        resume: false,
        force: false,
        threads: 1,
        cache: Cache::of_user(),
    };
    for set in plan.assignments(&test) {
        tell(format_args!("{set}"));
    }
    let stop = stop_on_interrupt();
    let mut progress = crate::progress::Progress::new();
    let outcome = run_case(&plan.case_of(&test)?, &options, &mut |event| {
        progress.show(&event);
        unless(stop.load(Ordering::Relaxed))
    });
    progress.finish();
    let out = &options.out;
    Ok(match outcome? {
        Outcome::Interrupted(_) => ExitCode::from(exit::INTERRUPTED),
        Outcome::Done(_) | Outcome::DoneBefore(_) => {
            let page = out.join("report.html");
            output::print_beside(
                &format!("results in {}; open {}\n", out.display(), page.display()),
                out,
            )
        }
    })
}

fn merged(arguments: &StudyMerge) -> Result<ExitCode, StudyError> {
    let plan = Plan::read(&arguments.study)?;
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| default_folder(&arguments.study, Shard::WHOLE));
    let (kept, tests) = (merge(&plan, &arguments.shards, &out)?, plan.tests());
    if kept < tests {
        tell(format_args!(
            "{kept} of {tests} tests are there; finish the shards and merge again, or go on here with: condyle study {} --out {}",
            arguments.study.display(),
            out.display()
        ));
    }
    answered(&plan, &out, arguments.json)
}

fn unless(stop: bool) -> ControlFlow<()> {
    if stop {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

/// The events of a study on standard error: a bar on a terminal, some lines otherwise, and every message once.
struct Bar {
    bar: Option<ProgressBar>,
    started: Instant,
    lines: u64,
    messages: BTreeSet<String>,
    stop: Option<Arc<AtomicBool>>,
}

impl Bar {
    fn new(stop: Option<Arc<AtomicBool>>) -> Self {
        Self {
            bar: None,
            started: Instant::now(),
            lines: 0,
            messages: BTreeSet::new(),
            stop,
        }
    }

    fn show(&mut self, event: &StudyEvent) -> ControlFlow<()> {
        match event {
            StudyEvent::Progress(progress) if stderr().is_terminal() => self.draw(*progress),
            StudyEvent::Progress(progress) => self.print(*progress),
            StudyEvent::Message(message) if self.messages.insert(message.clone()) => {
                match &self.bar {
                    Some(bar) => bar.suspend(|| tell(message)),
                    None => tell(message),
                }
            }
            _ => {}
        }
        unless(
            self.stop
                .as_ref()
                .is_some_and(|stop| stop.load(Ordering::Relaxed)),
        )
    }

    fn draw(&mut self, progress: Progress) {
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

    fn print(&mut self, progress: Progress) {
        let Progress {
            before,
            kept,
            tests,
        } = progress;
        if kept == before && before > 0 && self.lines == 0 {
            tell(format_args!("going on: {before} of {tests} tests are kept"));
        }
        let line = kept * MAX_LINES / tests.max(1);
        if kept == before || line == self.lines {
            return;
        }
        self.lines = line;
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
