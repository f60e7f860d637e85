//! The page: what stands on it, and in which order.

mod accuracy;
mod activities;
mod agreement;
mod captions;
mod channels;
mod compartments;
mod curves;
mod doubts;
mod key_words;
mod laws;
mod maps;
mod moving;
mod numbers;
mod ranges;
mod rate;
mod slip;
mod story;

pub(crate) use channels::{PlottedColumn, channel, panels as kinematics_panels};
pub(crate) use curves::{most_cycles, panels as wear_panels, panels_up_to as wear_panels_up_to};
pub(crate) use maps::{MAPS, MapOf, wear_map};
pub(crate) use numbers::{label_of, shown, unit_of};
pub(crate) use slip::slip_map;

use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use serde::Serialize;

use crate::figure::{Panel, css, variables};
use crate::results::{
    case::{creeps, is_deformable, title, yields},
    contents::Results,
};
use crate::scene::Scene;

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");

/// Scale of the large map, px per mm.
const LARGE: f64 = 8.0;
/// Scale of the small maps, px per mm.
const SMALL: f64 = 5.4;

/// What the template is filled with.
#[derive(Serialize)]
struct Page<'a> {
    style: &'static str,
    figure_style: &'static str,
    light: String,
    dark: String,
    title: Option<String>,
    lede: Option<String>,
    unfinished: Option<&'static str>,
    doubts: Vec<doubts::Doubt>,
    warnings: Vec<String>,
    rate: Option<String>,
    tiles: Vec<numbers::Tile>,
    missing: Vec<&'static str>,
    left_out: Vec<String>,
    disagreements: Vec<String>,
    is_deformable: bool,
    yields: bool,
    wear_map: Option<String>,
    compartments: Vec<compartments::Comparison>,
    laws: Vec<laws::Law>,
    law_of_run: Option<String>,
    wear_over_conventional: Option<String>,
    activities: Vec<activities::Row>,
    first_activity: Option<String>,
    activity_curves: Vec<activities::Curves>,
    creeps: bool,
    wear_curves: Vec<String>,
    channels: Vec<String>,
    cycles: Option<(String, String)>,
    /// Whether motions are measured, and wear.
    measured: [bool; 2],
    ranges: Vec<ranges::ChannelRange>,
    small_maps: Vec<maps::Small>,
    numbers: Vec<numbers::Group>,
    checks: Option<String>,
    accuracy: Option<accuracy::Accuracy>,
    provenance: Vec<story::Fact>,
    case: Option<&'a str>,
    moving: Option<moving::Moving>,
}

impl<'a> Page<'a> {
    fn of(results: &'a Results, scene: Option<&Scene>) -> Self {
        let (light, dark) = variables();
        Self {
            style: STYLE,
            figure_style: css(),
            light,
            dark,
            title: results.case.as_deref().and_then(title),
            lede: story::lede(results),
            unfinished: story::unfinished(results),
            doubts: doubts::doubts(results),
            warnings: doubts::warnings(results),
            rate: rate::rate(results),
            tiles: numbers::tiles(results),
            missing: story::missing(results),
            left_out: story::left_out(results, scene),
            disagreements: agreement::disagreements(results),
            is_deformable: results.case.as_deref().is_some_and(is_deformable),
            yields: results.case.as_deref().is_some_and(yields),
            wear_map: wear_map(results, LARGE).map(|map| map.svg()),
            compartments: compartments::comparisons(results),
            laws: laws::laws(results),
            law_of_run: laws::of_run(results),
            wear_over_conventional: laws::wear_over_conventional(results),
            activities: activities::rows(results),
            first_activity: activities::first(results),
            activity_curves: activities::curves(results),
            creeps: results.case.as_deref().is_some_and(creeps),
            wear_curves: svgs(&wear_panels(results)),
            channels: svgs(&kinematics_panels(results)),
            cycles: channels::cycle_names(results),
            measured: [&results.measured_kinematics, &results.measured_wear].map(Option::is_some),
            ranges: ranges::ranges(results),
            small_maps: maps::small(results, SMALL),
            numbers: numbers::groups(results),
            checks: story::volume_check(results),
            accuracy: accuracy::accuracy(results),
            provenance: story::provenance(results),
            case: results.case.as_deref(),
            moving: scene.and_then(moving::Moving::of),
        }
    }
}

/// The report of a results folder as one HTML page.
///
/// It asks for nothing outside itself and needs no JavaScript; what `results` lacks is left out.
pub fn report_html(results: &Results) -> String {
    page_of(results, None)
}

/// The same page with bodies that move and curves that can be asked, where there are scripts; without
/// them, and printed, it is the still one.
///
/// It asks for nothing outside itself.
pub fn moving_report_html(results: &Results, scene: &Scene) -> String {
    page_of(results, Some(scene))
}

fn page_of(results: &Results, scene: Option<&Scene>) -> String {
    render(Page::of(results, scene))
        .expect("the template is part of the program, and its tests render it")
}

fn svgs(panels: &[Panel]) -> Vec<String> {
    panels.iter().map(Panel::svg).collect()
}

fn render(page: Page) -> Result<String, minijinja::Error> {
    let mut syntax = SyntaxConfig::builder();
    let mut environment = Environment::new();
    environment.set_syntax(syntax.trim_blocks(true).lstrip_blocks(true).build()?);
    environment.render_named_str("report.html", PAGE, Serde(page))
}
