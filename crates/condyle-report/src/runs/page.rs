//! Several runs side by side on one page: tables, and curves and maps with common axes and colours.

use askama::Template;
use condyle_results::{
    SettingDifference,
    catalogue::{self, Scalar},
};

use super::differences::{
    CurveDifference, Differences, MapDifference, NumberDifference, Run, subtracted,
};
use crate::charts;
use crate::figure::{
    ColourRange, Curve, MEASURED, Map, MapStyle, Panel, escape, largest_size, run_class, sheet,
    svg_file,
};
use crate::maps::{MAPS, MappedField};
use crate::number::significant;
use crate::page::{label_of, shown, unit_of};
use crate::program::moving;
use crate::scene::Scene;
use crate::sheets::{Sheet, Sheets, filled, with_own_ids};

/// Names every run by the title of its case, unless another run has the same.
fn name_by_titles(runs: &mut [Run]) {
    let titles: Vec<Option<String>> = runs.iter().map(Run::title).collect();
    for (run, title) in runs.iter_mut().zip(&titles) {
        let same = titles.iter().filter(|other| *other == title);
        if let Some(title) = title
            && same.count() == 1
        {
            run.name.clone_from(title);
        }
    }
}

/// Renders several runs side by side as one HTML page: the difference of the mass in a sentence, different settings, bodies
/// in 3-D with one view, numbers with their errors, ranked differences from the first run, curves with common axes and maps
/// with common colours. It requests nothing outside itself.
pub fn runs_html(mut runs: Vec<Run>) -> String {
    name_by_titles(&mut runs);
    let runs = runs.as_slice();
    let Some((first, others)) = runs.split_first() else {
        return String::new();
    };
    let differences = others.iter().map(|run| Differences::of(first, run));
    let differences: Vec<Differences> = differences.collect();
    let mut notes: Vec<String> = Vec::new();
    for note in differences.iter().flat_map(|difference| &difference.notes) {
        // A note on the first run occurs in every comparison.
        if !notes.contains(note) {
            notes.push(note.clone());
        }
    }
    let verdicts: Vec<String> = differences
        .iter()
        .filter_map(Differences::verdict)
        .collect();
    let scenes: Vec<&Scene> = runs.iter().map(|run| &run.scene).collect();
    let (program, mut pictures) = (moving(&scenes), sheets(runs));
    // The maps of wear depth stand next to the bodies.
    let wear = pictures
        .iter()
        .position(|picture| picture.0 == MAPS[0].style.id);
    let wear = wear.map(|place| pictures.remove(place));
    let sheets = Sheets {
        kicker: "condyle \u{b7} virtual wear tests",
        title: &format!("{} runs side by side", runs.len()),
        lede: &verdicts.join(" "),
        notes: &notes,
        body: &tables(runs, &differences, program.is_some(), wear.as_ref()),
        tables: &[],
        pictures: &pictures,
        program: program.as_deref(),
    };
    filled(&sheets)
}

/// The cells of a row of a table.
type Row = Vec<Option<String>>;

/// Tables as HTML; their template asks for these parts by name.
#[derive(Template)]
#[template(path = "differences.html")]
struct Tables<'a> {
    names: Vec<&'a str>,
    head: Vec<&'a str>,
    numbers: Vec<Row>,
    differences: Vec<Compared<'a>>,
    has_bodies: bool,
    wear: Option<(String, String)>,
}

/// A difference as rows of text, with the digits and the words of the report.
struct Compared<'a> {
    first: &'a str,
    second: &'a str,
    /// The pair in words, before the heading of a table.
    pair: String,
    settings: Vec<Row>,
    numbers: Vec<Row>,
    curves: Vec<Row>,
    maps: Vec<Row>,
}

/// Returns the tables as HTML: numbers of all runs with their errors, and differences from the first; with places for the
/// bodies, and the maps of wear depth.
fn tables(
    runs: &[Run],
    differences: &[Differences],
    has_bodies: bool,
    wear: Option<&Sheet>,
) -> String {
    let with_error = |run: &Run, scalar: &Scalar| {
        let summary = run.results.summary.as_ref()?;
        let value = shown(scalar, summary.get(scalar)?, 4);
        Some(match summary.total_error(scalar) {
            Some(error) => format!("{value} \u{b1} {}", significant(error, 2)),
            None => value,
        })
    };
    let row = |scalar: &'static Scalar| {
        let cells: Vec<Option<String>> = runs.iter().map(|run| with_error(run, scalar)).collect();
        let is_known = cells.iter().any(Option::is_some);
        let named = [Some(label_of(scalar)), Some(unit_of(scalar))].into_iter();
        is_known.then(|| named.chain(cells).collect())
    };
    let numbers: Vec<Row> = catalogue::results().filter_map(row).collect();
    let names: Vec<&str> = runs.iter().map(|run| run.name.as_str()).collect();
    filled(&Tables {
        head: ["Quantity", "Unit"]
            .into_iter()
            .chain(names.iter().copied())
            .collect(),
        names,
        numbers,
        differences: differences.iter().map(Compared::new).collect(),
        has_bodies,
        wear: wear.map(with_own_ids),
    })
}

impl<'a> Compared<'a> {
    fn new(difference: &'a Differences) -> Self {
        let [first, second] = &difference.runs;
        // The titles are the names of the runs.
        let settings = difference.settings.iter().filter(|one| one.key != "title");
        let setting = |one: &SettingDifference| {
            let [first, second] = one.shown();
            vec![Some(one.key.clone()), first, second]
        };
        Self {
            first,
            second,
            pair: format!("{second} compared with {first}: "),
            settings: settings.map(setting).collect(),
            numbers: difference.numbers.iter().map(number_cells).collect(),
            curves: difference.curves.iter().map(curve_cells).collect(),
            maps: difference.maps.iter().map(map_cells).collect(),
        }
    }
}

fn number_cells(one: &NumberDifference) -> Row {
    let [first, second] = [one.first, one.second].map(|value| shown(one.scalar, value, 4));
    let magnitude = shown(one.scalar, one.difference.abs(), 3);
    vec![
        Some(one.label.clone()),
        Some(one.unit.clone()),
        Some(first),
        Some(second),
        Some(format!("{}{magnitude}", sign(one.difference))),
        one.difference_percent.map(signed),
        one.errors().map(|errors| significant(errors, 2)),
        Some(one.verdict()),
    ]
}

fn curve_cells(one: &CurveDifference) -> Row {
    let percent = one.rms_percent_of_range;
    vec![
        Some(one.title.clone()),
        Some(one.cycle.clone()),
        Some(one.unit.to_owned()),
        Some(significant(one.rms, 3)),
        percent.map(|percent| significant(percent, 3)),
        Some(signed(one.largest)),
        Some(significant(one.largest_at_percent, 3)),
    ]
}

fn map_cells(one: &MapDifference) -> Row {
    let [x, z, mean] = [one.x_mm, one.z_mm, one.mean_absolute].map(|value| significant(value, 3));
    vec![
        Some(one.title.to_owned()),
        Some(one.unit.to_owned()),
        Some(signed(one.largest)),
        one.largest_percent.map(|percent| significant(percent, 3)),
        Some(format!("{x}, {z}")),
        Some(mean),
    ]
}

fn sign(value: f64) -> char {
    if value < 0.0 { '\u{2212}' } else { '+' }
}

fn signed(value: f64) -> String {
    format!("{}{}", sign(value), significant(value.abs(), 3))
}

fn sheets(runs: &[Run]) -> Vec<Sheet> {
    // Curves of all runs end at the same number of cycles.
    let cycles = runs.iter().map(|run| charts::cycles_of(&run.results));
    let cycles = cycles.fold(0.0, f64::max);
    let wear = runs
        .iter()
        .map(|run| charts::wear_up_to(&run.results, cycles));
    let wear = together(wear, |curves| curves.next_back());
    let motion = || runs.iter().map(|run| charts::cycle(&run.results));
    let names = runs.iter().map(|run| run.name.as_str());
    let key: Vec<_> = (0..).map(run_class).zip(names).collect();
    let mut sheets: Vec<Sheet> = Vec::new();
    for (name, caption, title, panels, columns) in [
        (
            "runs_wear.svg",
            "Wear over the test, one line for each run.",
            "Wear over the test",
            wear,
            2,
        ),
        (
            "runs_first_cycle.svg",
            "The first cycle, on unworn inserts.",
            "Motion and load in the first cycle",
            together(motion(), |curves| curves.next()),
            3,
        ),
        (
            "runs_last_cycle.svg",
            "The last cycle that each run solved.",
            "Motion and load in the last cycle",
            together(motion(), |curves| curves.next_back()),
            3,
        ),
    ] {
        if !panels.is_empty() {
            let svg = sheet(title, caption, &panels, columns, &key);
            sheets.push((name.to_owned(), caption.to_owned(), svg));
        }
    }
    sheets.extend(MAPS.iter().filter_map(|field| {
        let caption = format!(
            "{} after the last update, all runs in the same colours; below, where the meshes are the same, the difference of \
             each from the first, in colours of its own.",
            field.style.title
        );
        Some((field.style.id.to_owned(), caption, map_rows(runs, field)?))
    }));
    sheets
}

/// Panels of the same quantity as one, with the curve that `pick` takes of each run.
fn together(
    of_runs: impl Iterator<Item = Vec<Panel>>,
    pick: fn(&mut dyn DoubleEndedIterator<Item = Curve>) -> Option<Curve>,
) -> Vec<Panel> {
    let mut all: Vec<Panel> = Vec::new();
    for (run, panels) in of_runs.enumerate() {
        for mut panel in panels {
            let curves = std::mem::take(&mut panel.curves).into_iter();
            let mut own = curves.filter(|curve| curve.class != MEASURED);
            let curve = pick(&mut own).map(|curve| Curve::new(run_class(run), curve.points));
            let place = all.iter().position(|known| known.id == panel.id);
            let place = place.unwrap_or_else(|| {
                all.push(panel);
                all.len() - 1
            });
            all[place].curves.extend(curve);
        }
    }
    all
}

/// Returns the maps of all runs in one row, in the same colours, and their differences from the first below, in others.
fn map_rows(runs: &[Run], field: &MappedField) -> Option<String> {
    // Space between maps, and for the name above one, px.
    const GAP: f64 = 18.0;
    const NAME: f64 = 24.0;
    let results = runs.iter().map(|run| &run.results);
    let maps = results.map(|own| field.of(own.surface.as_ref()?, own.directions(), 4.6));
    let maps: Vec<Option<Map<'_>>> = maps.collect();
    let sizes = maps.iter().flatten().map(Map::size);
    let (width, height) = sizes.reduce(|one, two| (one.0.max(two.0), one.1.max(two.1)))?;
    let (widest, tallest) = (width + GAP, height + NAME + GAP);
    let largest = maps.iter().flatten().map(|map| largest_size(map.values));
    let range = ColourRange::UpTo(largest.fold(0.0, f64::max));
    // The first has no difference from itself: its place below stays empty.
    let others = runs[1..].iter().map(|run| {
        let (one, two) = runs[0].comparable_surfaces(run)?;
        subtracted(one, two, field.field)
    });
    let apart: Vec<Option<Vec<f64>>> = [None].into_iter().chain(others).collect();
    let largest = apart.iter().flatten().map(|values| largest_size(values));
    let both_ways = ColourRange::BothWays(largest.fold(0.0, f64::max));
    let style = MapStyle {
        shades: colorous::RED_BLUE,
        largest: "Largest",
        ..field.style
    };
    let (mut body, mut descs, mut rows) = (String::new(), Vec::new(), 1);
    for (column, (run, map)) in runs.iter().zip(maps).enumerate() {
        let Some(map) = map else {
            continue;
        };
        let difference = apart[column].as_deref().map(|values| {
            let name = format!("{} \u{2212} {}", run.name, runs[0].name);
            let (style, range) = (style, both_ways);
            let map = Map {
                style,
                values,
                range,
                ..map
            };
            (1, name, map)
        });
        let own = (0, run.name.clone(), Map { range, ..map });
        for (row, name, map) in [own].into_iter().chain(difference) {
            let (x, y) = (column as f64 * widest, f64::from(row) * tallest);
            let (title, drawn) = (escape(&name), map.body());
            body += &format!(
                r#"<g transform="translate({x:.1} {y:.1})"><text class="title" x="30" y="12">{title}</text><g transform="translate(0 {NAME})">{drawn}</g></g>"#
            );
            descs.push(format!("{name}: {}", map.desc()));
            rows = rows.max(row + 1);
        }
    }
    let size = (
        runs.len() as f64 * widest - GAP,
        f64::from(rows) * tallest - GAP,
    );
    Some(svg_file(field.style.title, &descs.join(" "), size, &body))
}
