//! How problems are shown: the place, a caret under it, and what to do.

use std::fmt;

use miette::{GraphicalReportHandler, GraphicalTheme};

use super::problems::Problems;
use super::shown::Shown;

/// How problems are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderStyle {
    /// ASCII without colour, the same everywhere: for logs, pipes and tests.
    Plain,
    /// Colour and line art, for a terminal this many columns wide.
    Terminal {
        /// Columns.
        width: usize,
    },
}

/// Width of text that goes to no terminal, columns.
const PLAIN_WIDTH: usize = 100;

/// Problems shown at most. Each is looked for from the start of its file, and nobody reads on for longer.
const MAX_SHOWN: usize = 20;

impl Problems {
    /// The first problems, each with its place, a caret under the spot, and what to do; of more than
    /// twenty, how many more there are.
    pub fn render(&self, style: RenderStyle) -> String {
        let (theme, width) = match style {
            RenderStyle::Plain => (GraphicalTheme::none(), PLAIN_WIDTH),
            RenderStyle::Terminal { width } => (GraphicalTheme::unicode(), width),
        };
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_width(width)
            .with_links(false);
        let mut text = String::new();
        for problem in self.problems().iter().take(MAX_SHOWN) {
            let shown = handler.render_report(&mut text, &Shown::new(problem));
            debug_assert!(shown.is_ok(), "writing to a String does not fail");
        }
        text + &of_the_rest(self.problems().len())
    }
}

/// What is said of the problems that are not shown, where there are `all`.
fn of_the_rest(all: usize) -> String {
    match all.saturating_sub(MAX_SHOWN) {
        0 => String::new(),
        1 => "and 1 more problem; correct these first\n".to_owned(),
        more => format!("and {more} more problems; correct these first\n"),
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(RenderStyle::Plain))
    }
}

impl std::error::Error for Problems {}
