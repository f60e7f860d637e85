//! Progress on standard error: a bar on a terminal, plain lines in a log; and the signal that stops a run.

use std::{
    collections::BTreeSet,
    io::{IsTerminal, stderr},
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use condyle_lab::{Reached, RunEvent};
use condyle_study::{Progress, StudyEvent};
use indicatif::{ProgressBar, ProgressStyle};

use crate::output::{self, note};

/// Returns a flag that the first Ctrl-C (or SIGTERM) raises; a second, and one while `is_placing`, ends the program at
/// once.
fn stop_on_interrupt(is_placing: Arc<AtomicBool>) -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let set = ctrlc::set_handler(move || {
        let is_first = !flag.swap(true, Ordering::Relaxed);
        // Nothing of the run is on the disk yet, and no increment ends soon.
        if is_first && is_placing.load(Ordering::Relaxed) {
            note(
                "interrupted before the first cycle: nothing was computed; run the same command again",
            );
        } else if is_first {
            // Waits for the end of an increment, which may take long: a second signal does not.
            return;
        }
        std::process::exit(i32::from(output::INTERRUPTED));
    });
    if let Err(error) = set {
        note(format_args!(
            "warning: Ctrl-C will end the run at once: {error}"
        ));
    }
    stop
}

fn flow(stop: &AtomicBool) -> ControlFlow<()> {
    if stop.load(Ordering::Relaxed) {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

fn bar(length: u64, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template);
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style)
}

const TICKS: f64 = 1000.0;

/// The progress of a run, which Ctrl-C stops.
pub struct RunProgress {
    bar: Option<ProgressBar>,
    of_cycles: f64,
    /// True while the bodies are built and placed.
    is_placing: Arc<AtomicBool>,
    stop: Arc<AtomicBool>,
}

impl RunProgress {
    pub fn new() -> Self {
        let is_placing = Arc::new(AtomicBool::new(true));
        Self {
            bar: None,
            of_cycles: 0.0,
            stop: stop_on_interrupt(Arc::clone(&is_placing)),
            is_placing,
        }
    }

    /// Shows an event; breaks if the user asks to stop.
    pub fn show(&mut self, event: &RunEvent<'_>) -> ControlFlow<()> {
        match (event, &self.bar) {
            (RunEvent::Warning(warning), _) => output::warn([warning]),
            (RunEvent::Placed, _) => self.is_placing.store(false, Ordering::Relaxed),
            (RunEvent::Started(reached), _) => self.start(reached),
            (RunEvent::Solved(progress), Some(bar)) => {
                bar.set_position(self.ticks(progress.cycles));
                bar.set_message(format!("update {}", progress.update));
            }
            (RunEvent::Estimating, Some(bar)) => bar.set_message("estimating the error"),
            (RunEvent::Updated(update), None) => note(format_args!(
                "{:.0} cycles: {:.3} mg worn, {:.4} mm deep",
                update.cycles, update.mass_loss_mg, update.max_depth_mm
            )),
            _ => {}
        }
        flow(&self.stop)
    }

    fn ticks(&self, cycles: f64) -> u64 {
        (cycles / self.of_cycles * TICKS) as u64
    }

    fn start(&mut self, reached: &Reached) {
        self.of_cycles = reached.of_cycles;
        // A log gets plain lines: a bar would fill it with control characters.
        if stderr().is_terminal() {
            let bar = bar(TICKS as u64, "{bar:40} {percent:>3} %  {msg}  {elapsed}");
            bar.set_position(self.ticks(reached.cycles));
            self.bar = Some(bar);
        } else if reached.updates > 0 {
            note(format_args!("resumed: {}", in_words(reached)));
        }
    }
}

impl Drop for RunProgress {
    fn drop(&mut self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }
}

/// Returns the progress of a run, such as `3 updates are done, 1500000 of 5000000 cycles`.
pub fn in_words(reached: &Reached) -> String {
    let Reached {
        updates,
        cycles,
        of_cycles,
    } = reached;
    format!("{updates} updates are done, {cycles:.0} of {of_cycles:.0} cycles")
}

/// Lines of progress of a study without a terminal.
const MAX_LINES: u64 = 20;

/// The progress of a study, with every message once.
pub struct StudyProgress {
    bar: Option<ProgressBar>,
    started: Instant,
    lines: u64,
    messages: BTreeSet<String>,
    stop: Option<Arc<AtomicBool>>,
}

impl StudyProgress {
    /// Creates the progress of a study; one that keeps nothing is not stoppable: Ctrl-C ends the program at once.
    pub fn new(is_stoppable: bool) -> Self {
        Self {
            bar: None,
            started: Instant::now(),
            lines: 0,
            messages: BTreeSet::new(),
            stop: is_stoppable.then(|| stop_on_interrupt(Arc::default())),
        }
    }

    /// Shows an event; breaks if the user asks to stop.
    pub fn show(&mut self, event: &StudyEvent) -> ControlFlow<()> {
        match event {
            StudyEvent::Progress(progress) if stderr().is_terminal() => self.draw(*progress),
            StudyEvent::Progress(progress) => self.print(*progress),
            StudyEvent::Message(message) if self.messages.insert(message.clone()) => {
                match &self.bar {
                    Some(bar) => bar.suspend(|| note(message)),
                    None => note(message),
                }
            }
            _ => {}
        }
        let stop = self.stop.as_ref();
        stop.map_or(ControlFlow::Continue(()), |stop| flow(stop))
    }

    fn draw(&mut self, progress: Progress) {
        let bar = self.bar.get_or_insert_with(|| {
            let template = "{bar:40} {pos} of {len} tests  {elapsed} elapsed, {eta} left";
            let bar = bar(progress.tests, template);
            bar.set_position(progress.kept);
            // Tests of an earlier run took no time in this one.
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
            note(format_args!("resumed: {before} of {tests} tests are kept"));
        }
        let line = kept * MAX_LINES / tests.max(1);
        if kept == before || line == self.lines {
            return;
        }
        self.lines = line;
        let spent_s = self.started.elapsed().as_secs_f64();
        let left_s = spent_s / (kept - before) as f64 * tests.saturating_sub(kept) as f64;
        note(format_args!("{kept} of {tests} tests, {left_s:.0} s left"));
    }
}

impl Drop for StudyProgress {
    fn drop(&mut self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }
}
