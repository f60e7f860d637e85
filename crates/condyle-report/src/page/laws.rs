//! What every law of wear says of the same histories.

use serde::Serialize;

use condyle_results::catalogue::WEAR_OVER_CONVENTIONAL;

use crate::number::{fixed, significant};
use crate::results::contents::Results;

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
    let laws = summary.map_or(&[][..], |summary| &summary.wear_laws);
    if laws.len() < 2 {
        return Vec::new();
    }
    let rows = laws.iter().map(|law| Law {
        name: law.law.clone(),
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
    let laws = &results.summary.as_ref()?.wear_laws;
    let own = laws.iter().find(|law| law.moved_the_surface)?;
    Some(own.law.clone())
}

/// What cross-linked polyethylene is taken to wear over conventional one, if the insert is of it.
pub(super) fn wear_over_conventional(results: &Results) -> Option<String> {
    let times = results.summary.as_ref()?.get(&WEAR_OVER_CONVENTIONAL)?;
    Some(significant(times, 3))
}

fn percent(of_volume: Option<f64>) -> String {
    of_volume.map_or_else(|| String::from("not known"), |percent| fixed(percent, 0))
}
