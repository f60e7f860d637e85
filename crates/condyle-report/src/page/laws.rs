//! What every law of wear says of the same histories.

use serde::Serialize;

use crate::number::{fixed, significant};
use crate::results::{contents::Results, summary::Summary};

/// A law in the table.
#[derive(Serialize)]
pub(super) struct Law {
    name: String,
    approximate: bool,
    moved_the_surface: bool,
    mass_per_million: String,
    mass: String,
    volume: String,
    depth: String,
    outside: String,
}

/// The laws of the summary; none where there is only one.
pub(super) fn laws(results: &Results) -> Vec<Law> {
    let summary = results.summary.as_ref();
    let laws = summary.map_or_else(Vec::new, Summary::wear_laws);
    if laws.len() < 2 {
        return Vec::new();
    }
    let rows = laws.into_iter().map(|law| Law {
        name: law.law,
        approximate: law.approximate,
        moved_the_surface: law.moved_the_surface,
        mass_per_million: significant(law.mass_loss_mg_per_million_cycles, 3),
        mass: significant(law.mass_loss_mg, 3),
        volume: significant(law.volume_loss_mm3, 3),
        depth: significant(law.max_depth_mm, 3),
        outside: percent(law.outside_of_fit_percent),
    });
    rows.collect()
}

/// The law that moved the surface, if the summary says which.
pub(super) fn of_run(results: &Results) -> Option<String> {
    let laws = results.summary.as_ref()?.wear_laws();
    let own = laws.into_iter().find(|law| law.moved_the_surface)?;
    Some(own.law)
}

/// What cross-linked polyethylene is taken to wear over conventional one, if the insert is of it.
pub(super) fn wear_over_conventional(results: &Results) -> Option<String> {
    let times = results.summary.as_ref()?.wear_over_conventional()?;
    Some(significant(times, 3))
}

fn percent(of_volume: Option<f64>) -> String {
    of_volume.map_or_else(|| String::from("not known"), |percent| fixed(percent, 0))
}
