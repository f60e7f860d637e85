//! The report of one run as an HTML page.

mod numbers;
mod sentences;
mod tables;

pub(crate) use numbers::{label_of, shown, unit_of};

use askama::Template;
use condyle_results::{LawWear, TestedJoint, catalogue::WEAR_OVER_CONVENTIONAL};

use crate::charts;
use crate::figure::{Map, Panel, STYLE};
use crate::maps::{self, DrawnMap};
use crate::number::significant;
use crate::program::moving;
use crate::results::{CaseFacts, Results};
use crate::scene::Scene;
use crate::sheets::{PAGE_STYLE, filled};
use numbers::{Group, Tile};
use sentences::Finding;
use tables::{Accuracy, Range, Regions};

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

/// The page; its template asks for these parts by name.
#[derive(Template)]
#[template(path = "page.html")]
struct Page<'a> {
    results: &'a Results,
    facts: CaseFacts,
    joint: TestedJoint,
    bodies: [&'static str; 2],
    lede: Option<String>,
    unfinished: Option<&'static str>,
    doubts: Vec<Finding>,
    notes: Vec<Finding>,
    interval: Option<String>,
    warnings: Vec<String>,
    rate: Option<String>,
    tiles: Vec<Tile>,
    missing: Vec<&'static str>,
    left_out: Vec<String>,
    disagreements: Vec<String>,
    wear_map: Option<String>,
    other_maps: Vec<DrawnMap>,
    regions: Option<Regions>,
    wear_laws: Vec<(&'a LawWear, [String; 5])>,
    own_law: Option<&'a LawWear>,
    wear_over_conventional: Option<String>,
    activities: Vec<(&'a str, Vec<String>)>,
    /// Names and charts of the activities after the first, whose charts are those of the whole page.
    activity_charts: Vec<(&'a str, Vec<String>)>,
    wear_charts: Vec<String>,
    cycle_charts: Vec<String>,
    cycles: Option<[String; 2]>,
    ranges: Vec<Range>,
    numbers: Vec<Group>,
    volume_check: Option<String>,
    accuracy: Option<Accuracy>,
    provenance: Vec<(String, String)>,
    moving: Option<String>,
}

fn page_of(results: &Results, scene: Option<&Scene>) -> String {
    let summary = results.summary.as_ref();
    let facts = results.case.as_deref().map(CaseFacts::of);
    let facts = facts.unwrap_or_default();
    let on_page = |map: &Map<'_>, desc: &str, over: &str| map.svg(desc, over);
    let surface = results.surface.as_ref();
    let wear_map =
        surface.and_then(|surface| maps::MAPS[0].of(surface, results.directions(), LARGE));
    let times = summary.and_then(|summary| summary.get(&WEAR_OVER_CONVENTIONAL));
    let wear_laws = tables::wear_laws(results);
    let mut laws = wear_laws.iter().map(|(law, _)| *law);
    let kinematics = results.kinematics.as_ref();
    let joint = results.directions().joint;
    let page = Page {
        results,
        joint,
        bodies: joint.bodies(),
        lede: sentences::lede(results, &facts),
        unfinished: sentences::unfinished(results),
        doubts: sentences::doubts(results),
        notes: sentences::notes(results),
        interval: sentences::interval(results),
        warnings: sentences::warnings(results),
        rate: sentences::rate(results),
        tiles: numbers::tiles(results),
        missing: sentences::missing(results),
        left_out: sentences::left_out(results, scene),
        disagreements: sentences::disagreements(results),
        wear_map: wear_map.map(|map| map.svg(&map.desc(), "")),
        other_maps: maps::drawn(&maps::MAPS[1..], results, SMALL, on_page),
        regions: tables::regions(results),
        own_law: laws.find(|law| law.moved_the_surface),
        wear_laws,
        wear_over_conventional: times.map(|times| significant(times, 3)),
        activities: tables::activities(results),
        activity_charts: activity_charts(results),
        wear_charts: svgs(&charts::wear(results)),
        cycle_charts: svgs(&charts::cycle(results)),
        cycles: kinematics.and_then(charts::cycle_captions),
        ranges: tables::ranges(results).unwrap_or_default(),
        numbers: numbers::groups(results),
        volume_check: sentences::volume_check(results),
        accuracy: tables::accuracy(results),
        provenance: sentences::provenance(results),
        facts,
        moving: scene.and_then(|scene| moving(&[scene])),
    };
    filled(&page)
}

fn activity_charts(results: &Results) -> Vec<(&str, Vec<String>)> {
    let others = results.activities.iter().skip(1);
    let charts = others.filter_map(|(activity, table)| {
        let panels = charts::cycle_of(table.as_ref()?, &activity.name, results.motions());
        Some((activity.name.as_str(), svgs(&panels)))
    });
    charts.collect()
}

fn svgs(panels: &[Panel]) -> Vec<String> {
    panels.iter().map(Panel::svg).collect()
}
