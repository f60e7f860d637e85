//! A bar on a terminal, plain lines in a log.

use std::io::{IsTerminal, stderr};

use condyle_lab::Happening;
use indicatif::{ProgressBar, ProgressStyle};

/// Ticks of the bar for each update.
const TICKS: u64 = 100;

/// Shows how far a run has come, on standard error.
pub struct Progress {
    bar: Option<ProgressBar>,
    of: usize,
}

impl Progress {
    pub fn new() -> Self {
        Self { bar: None, of: 0 }
    }

    pub fn show(&mut self, happening: &Happening<'_>) {
        match happening {
            Happening::Warning(warning) => eprintln!("warning: {warning}"),
            Happening::Started { done, of } => self.start(*done, *of),
            Happening::Solved(progress) => {
                if let Some(bar) = &self.bar {
                    let part = progress.cycles_solved.min(1.0);
                    bar.set_position((((progress.update - 1) as f64 + part) * TICKS as f64) as u64);
                    bar.set_message(format!("update {} of {}", progress.update, self.of));
                }
            }
            Happening::Updated(update) => {
                if self.bar.is_none() {
                    eprintln!(
                        "{:.0} cycles: {:.3} mg worn, {:.4} mm deep",
                        update.cycles, update.mass_loss_mg, update.max_depth_mm
                    );
                }
            }
        }
    }

    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    fn start(&mut self, done: usize, of: usize) {
        self.of = of;
        if stderr().is_terminal() {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {elapsed}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let bar = ProgressBar::new(of as u64 * TICKS).with_style(style);
            bar.set_position(done as u64 * TICKS);
            self.bar = Some(bar);
        } else if done > 0 {
            eprintln!("going on: {done} of {of} updates are done");
        }
    }
}
