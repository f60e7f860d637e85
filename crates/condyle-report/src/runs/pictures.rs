//! Curves and maps of several runs on the same axes and in the same colours.

use super::{maps::apart, run::Run};
use crate::figure::{ColourRange, Curve, Map, Panel, Shades, alone, escape, sheet};
use crate::page::{MAPS, MapOf, kinematics_panels, most_cycles, wear_panels_up_to};
use crate::results::surface::SurfaceFields;

/// A line of a run each; the seventh looks like the first again.
const LINES: [&str; 6] = ["run-1", "run-2", "run-3", "run-4", "run-5", "run-6"];
/// Class of curves that are of no run.
const MEASURED: &str = "specimen";
/// Scale of the maps, px per mm.
const PX_PER_MM: f64 = 4.6;
/// Space between maps, and for the name above one, px.
const GAP: f64 = 18.0;
const NAME: f64 = 24.0;

/// Which of a panel's curves is the one of a run.
type Pick = fn(Vec<Curve>) -> Option<Curve>;

fn line(run: usize) -> &'static str {
    LINES[run % LINES.len()]
}

fn key(runs: &[Run]) -> Vec<(&'static str, &str)> {
    let names = runs.iter().map(|run| run.name.as_str());
    (0..).map(line).zip(names).collect()
}

/// Wear over cycles, all runs on each axis; `None` where no run has any.
pub(super) fn wear(runs: &[Run]) -> Option<String> {
    let most = runs.iter().map(|run| most_cycles(&run.results));
    let most = most.fold(0.0, f64::max);
    let panels = runs.iter().map(|run| wear_panels_up_to(&run.results, most));
    let panels = together(panels, |mut curves| curves.pop());
    let desc = "What wears against cycles, a line a run.";
    (!panels.is_empty()).then(|| sheet("Wear over the test", desc, &panels, 2, &key(runs)))
}

/// Motion and load of the first or last cycle, all runs on each axis.
pub(super) fn motion(runs: &[Run], title: &str, is_first: bool) -> Option<String> {
    let pick: Pick = match is_first {
        true => |curves| curves.into_iter().next(),
        false => |mut curves| curves.pop(),
    };
    let panels = runs.iter().map(|run| kinematics_panels(&run.results));
    let panels = together(panels, pick);
    let desc = "Motions and loads against percent of the gait cycle, a line a run.";
    (!panels.is_empty()).then(|| sheet(title, desc, &panels, 3, &key(runs)))
}

/// Panels of the same quantity as one, with a curve a run.
fn together(of_runs: impl Iterator<Item = Vec<Panel>>, pick: Pick) -> Vec<Panel> {
    let mut all: Vec<Panel> = Vec::new();
    for (run, panels) in of_runs.enumerate() {
        for mut panel in panels {
            let mut own = std::mem::take(&mut panel.curves);
            own.retain(|curve| curve.class != MEASURED);
            let curve = pick(own).map(|curve| Curve {
                class: line(run),
                dots: false,
                end: None,
                ..curve
            });
            match all.iter_mut().find(|known| known.id == panel.id) {
                Some(known) => known.curves.extend(curve),
                None => {
                    panel.curves.extend(curve);
                    all.push(panel);
                }
            }
        }
    }
    all
}

/// Every field that a run has a map of: its name, and a picture of all runs in the same colours, with what the others
/// differ by from the first below where that can be told.
pub(super) fn maps(runs: &[Run]) -> Vec<(&'static str, &'static str, String)> {
    let drawn = MAPS.iter().zip(FILES).filter_map(|(map, file)| {
        let svg = rows(runs, map)?;
        Some((file, map.title, svg))
    });
    drawn.collect()
}

/// Names of the maps' pictures, in the order of [`MAPS`].
const FILES: [&str; 6] = [
    "runs_wear_map.svg",
    "runs_pressure_map.svg",
    "runs_sliding_map.svg",
    "runs_cross_shear_map.svg",
    "runs_creep_map.svg",
    "runs_set_map.svg",
];

/// A picture in its place: the name above it, and what it shows.
struct Placed {
    column: usize,
    row: usize,
    name: String,
    size: (f64, f64),
    body: String,
    desc: String,
}

fn rows(runs: &[Run], of: &MapOf) -> Option<String> {
    let mut placed = values(runs, of);
    placed.extend(differences(runs, of));
    let first = placed.first()?;
    let [width, height] = placed
        .iter()
        .fold([first.size.0, first.size.1], |[w, h], one| {
            [w.max(one.size.0), h.max(one.size.1)]
        });
    let (columns, rows) = placed.iter().fold((0, 0), |(columns, rows), one| {
        (columns.max(one.column + 1), rows.max(one.row + 1))
    });
    let body: String = placed
        .iter()
        .map(|one| {
            let x = one.column as f64 * (width + GAP);
            let y = one.row as f64 * (height + NAME + GAP);
            let (name, body) = (escape(&one.name), &one.body);
            format!(
                r#"<g transform="translate({x:.1} {y:.1})"><text class="title" x="30" y="12">{name}</text><g transform="translate(0 {NAME})">{body}</g></g>"#
            )
        })
        .collect();
    let desc: Vec<&str> = placed.iter().map(|one| one.desc.as_str()).collect();
    let size = (
        columns as f64 * (width + GAP) - GAP,
        rows as f64 * (height + NAME + GAP) - GAP,
    );
    Some(alone(of.title, &desc.join(" "), size, &body))
}

/// The map of every run that has the field, all up to the largest value of any.
fn values(runs: &[Run], of: &MapOf) -> Vec<Placed> {
    let maps = runs.iter().filter_map(|run| map(run, of));
    let most = maps.map(|map| largest(map.values)).fold(0.0, f64::max);
    let place = |(column, run): (usize, &Run)| {
        let map = Map {
            range: ColourRange::UpTo(most),
            ..map(run, of)?
        };
        Some(placed(&map, (column, 0), run.name.clone()))
    };
    runs.iter().enumerate().filter_map(place).collect()
}

fn map<'a>(run: &'a Run, of: &MapOf) -> Option<Map<'a>> {
    let surface: &SurfaceFields = run.results.surface.as_ref()?;
    of.drawn(surface, run.results.side, PX_PER_MM)
}

/// What the others differ by from the first, all in the same colours.
fn differences(runs: &[Run], of: &MapOf) -> Vec<Placed> {
    let Some((first, others)) = runs.split_first() else {
        return Vec::new();
    };
    let off = |run: &Run| {
        let surfaces = first
            .results
            .surface
            .as_ref()
            .zip(run.results.surface.as_ref());
        let (one, two) = surfaces.filter(|_| first.maps_apart(run).is_none())?;
        apart(one, two, of.field)
    };
    let off: Vec<Option<Vec<f64>>> = others.iter().map(off).collect();
    let sizes = off.iter().flatten().map(|values| largest(values));
    let most = sizes.fold(0.0, f64::max);
    let place = |(index, off): (usize, &Option<Vec<f64>>)| {
        let map = Map {
            values: off.as_deref()?,
            range: ColourRange::BothWays(most),
            shades: Shades::RedBlue,
            largest: "Largest",
            ..map(&others[index], of)?
        };
        let name = format!("{} \u{2212} {}", others[index].name, first.name);
        Some(placed(&map, (index + 1, 1), name))
    };
    off.iter().enumerate().filter_map(place).collect()
}

fn placed(map: &Map<'_>, (column, row): (usize, usize), name: String) -> Placed {
    Placed {
        column,
        row,
        size: map.size(),
        body: map.body(),
        desc: format!("{name}: {}", map.desc()),
        name,
    }
}

/// The largest finite size of a value.
fn largest(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold(0.0, |most, value| value.abs().max(most))
}
