//! A bar on a terminal, plain lines in a log.

use std::io::{IsTerminal, stderr};

use condyle_lab::{Reached, RunEvent};
use indicatif::{ProgressBar, ProgressStyle};

use crate::standard_error::tell;

const TICKS: f64 = 1000.0;

/// Shows how far a run has come, on standard error.
pub struct Progress {
    bar: Option<ProgressBar>,
    of_cycles: f64,
}

impl Progress {
    pub fn new() -> Self {
        Self {
            bar: None,
            of_cycles: 0.0,
        }
    }

    pub fn show(&mut self, on_event: &RunEvent<'_>) {
        match on_event {
            RunEvent::Warning(warning) => tell(format_args!("warning: {warning}")),
            RunEvent::Started(reached) => self.start(*reached),
            RunEvent::Solved(progress) => {
                if let Some(bar) = &self.bar {
                    bar.set_position(self.ticks(progress.cycles));
                    bar.set_message(format!("update {}", progress.update));
                }
            }
            RunEvent::Estimating => {
                if let Some(bar) = &self.bar {
                    bar.set_message("estimating the error");
                }
            }
            RunEvent::Updated(update) => {
                if self.bar.is_none() {
                    tell(format_args!(
                        "{:.0} cycles: {:.3} mg worn, {:.4} mm deep",
                        update.cycles, update.mass_loss_mg, update.max_depth_mm
                    ));
                }
            }
        }
    }

    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    fn ticks(&self, cycles: f64) -> u64 {
        (cycles / self.of_cycles * TICKS) as u64
    }

    fn start(&mut self, reached: Reached) {
        self.of_cycles = reached.of_cycles;
        // A log gets plain lines: a bar would fill it with control characters.
        if stderr().is_terminal() {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {elapsed}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(TICKS as u64).with_style(style);
            bar.set_position(self.ticks(reached.cycles));
            self.bar = Some(bar);
        } else if reached.updates > 0 {
            tell(format_args!("going on: {}", in_words(&reached)));
        }
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
