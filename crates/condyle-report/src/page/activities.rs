//! What each of several activities did.

use condyle_results::ActivitySummary;
use serde::Serialize;

use super::channels::panels_of;
use crate::figure::Panel;
use crate::number::{fixed, significant};
use crate::results::contents::Results;

/// An activity in the table.
#[derive(Serialize)]
pub(super) struct Row {
    name: String,
    cycles: String,
    wear: String,
    mass: String,
    pressure: String,
    area: String,
    force: String,
    ap: String,
    ie: String,
    medial: String,
}

/// The curves of an activity.
#[derive(Serialize)]
pub(super) struct Curves {
    name: String,
    panels: Vec<String>,
}

/// The activities of the summary; none where there is only one.
pub(super) fn rows(results: &Results) -> Vec<Row> {
    let all_mg: f64 = activities(results).map(|one| one.mass_loss_mg).sum();
    let row = |one: &ActivitySummary| Row {
        name: one.name.clone(),
        cycles: significant(100.0 * one.share_of_cycles, 3),
        wear: significant(100.0 * one.mass_loss_mg / all_mg, 3),
        mass: significant(one.mass_loss_mg, 3),
        pressure: significant(one.peak_pressure_mpa, 3),
        area: fixed(one.peak_contact_area_mm2, 0),
        force: fixed(one.peak_axial_force_n, 0),
        ap: significant(one.ap_range_mm, 3),
        ie: significant(one.ie_range_deg, 3),
        medial: fixed(100.0 * one.medial_load_share, 1),
    };
    activities(results).map(row).collect()
}

/// The name of the first of several activities, whose motions stand first.
pub(super) fn first(results: &Results) -> Option<String> {
    let first = activities(results).next()?;
    Some(first.name.clone())
}

/// Motions and loads of all activities but the first.
pub(super) fn curves(results: &Results) -> Vec<Curves> {
    let others = results.activities.iter().skip(1);
    let curves = others.filter_map(|(activity, table)| {
        let panels = panels_of(table.as_ref()?, &activity.name);
        Some(Curves {
            name: activity.name.clone(),
            panels: panels.iter().map(Panel::svg).collect(),
        })
    });
    curves.collect()
}

fn activities(results: &Results) -> impl Iterator<Item = &ActivitySummary> {
    results.activities.iter().map(|(activity, _)| activity)
}
