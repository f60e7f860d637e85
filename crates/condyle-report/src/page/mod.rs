//! The report of one run as an HTML page.

mod numbers;
mod sentences;
mod tables;

pub(crate) use numbers::{label_of, shown, unit_of};

use condyle_results::catalogue::WEAR_OVER_CONVENTIONAL;
use serde_json::{Value, json};

use crate::charts;
use crate::figure::{Map, Panel, STYLE, colour_variables};
use crate::maps::{self, DrawnMap};
use crate::number::significant;
use crate::program::{moving, policy};
use crate::results::{CaseFacts, Results};
use crate::scene::Scene;
use crate::sheets::{PAGE_STYLE, render};

const PAGE: &str = include_str!("page.html");

/// Scale of the maps, px per mm: the large one at the top, and those below it.
const LARGE: f64 = 8.0;
const SMALL: f64 = 5.4;

/// Renders the report of a results folder as one HTML page without scripts.
///
/// The page requests nothing outside itself; parts that `results` lacks are omitted.
pub fn report_html(results: &Results) -> String {
    page_of(results, None)
}

/// Renders the same page with bodies in 3-D and interactive charts; without scripts, and in print, it equals
/// [`report_html`].
///
/// The page requests nothing outside itself.
pub fn moving_report_html(results: &Results, scene: &Scene) -> String {
    page_of(results, Some(scene))
}

fn page_of(results: &Results, scene: Option<&Scene>) -> String {
    let (light, dark) = colour_variables();
    let summary = results.summary.as_ref();
    let facts = results.case.as_deref().map(CaseFacts::of);
    let facts = facts.unwrap_or_default();
    let on_page = |map: &Map<'_>, desc: &str, over: &str| map.svg(desc, over);
    let captioned = |map: DrawnMap| json!({ "svg": map.svg, "caption": map.caption });
    let other_maps = maps::drawn(&maps::MAPS[1..], results, SMALL, on_page).into_iter();
    let other_maps: Vec<Value> = other_maps.map(captioned).collect();
    let activities: Vec<_> = results.activities.iter().map(|(one, _)| one).collect();
    let surface = results.surface.as_ref();
    let wear_map =
        surface.and_then(|surface| maps::MAPS[0].of(surface, results.directions(), LARGE));
    let kinematics = results.kinematics.as_ref();
    let times = summary.and_then(|summary| summary.get(&WEAR_OVER_CONVENTIONAL));
    render(
        PAGE,
        &json!({
            "policy": policy(scene.is_some()),
            "style": [PAGE_STYLE, STYLE],
            "colours": [light, dark],
            "lede": sentences::lede(results, &facts),
            "unfinished": sentences::unfinished(results),
            "doubts": sentences::doubts(results),
            "notes": sentences::notes(results),
            "interval": sentences::interval(results),
            "warnings": sentences::warnings(results),
            "rate": sentences::rate(results),
            "tiles": numbers::tiles(results),
            "missing": sentences::missing(results),
            "left_out": sentences::left_out(results, scene),
            "disagreements": sentences::disagreements(results),
            "wear_map": wear_map.map(|map| map.svg(&map.desc(), "")),
            "regions": tables::regions(results),
            "joint": results.directions().joint.name(),
            "bodies": results.directions().joint.bodies(),
            "wear_laws": summary.map_or(&[][..], |summary| &summary.wear_laws),
            "wear_over_conventional": times.map(|times| significant(times, 3)),
            "activities": activities,
            "activity_charts": activity_charts(results),
            "wear_charts": svgs(&charts::wear(results)),
            "cycle_charts": svgs(&charts::cycle(results)),
            "cycles": kinematics.and_then(charts::cycle_captions),
            "has_measured_motion": results.measured_kinematics.is_some(),
            "has_weighed": results.measured_wear.is_some(),
            "ranges": tables::ranges(results),
            "other_maps": other_maps,
            "numbers": numbers::groups(results),
            "volume_check": sentences::volume_check(results),
            "accuracy": tables::accuracy(results),
            "provenance": sentences::provenance(results),
            "title": facts.title,
            "is_deformable": facts.is_deformable,
            "yields": facts.yields,
            "creeps": facts.creeps,
            "case": results.case,
            "moving": scene.and_then(|scene| moving(&[scene])),
        }),
    )
}

/// Returns the map of wear depth; `None` without a mesh that has it.
fn activity_charts(results: &Results) -> Vec<Value> {
    // The charts of the first activity are those of the whole page.
    let others = results.activities.iter().skip(1);
    let charts = others.filter_map(|(activity, table)| {
        let charts = svgs(&charts::cycle_of(
            table.as_ref()?,
            &activity.name,
            results.motions(),
        ));
        Some(json!({ "name": activity.name, "charts": charts }))
    });
    charts.collect()
}

fn svgs(panels: &[Panel]) -> Vec<String> {
    panels.iter().map(Panel::svg).collect()
}
