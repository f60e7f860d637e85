//! The differences between two runs: settings, numbers, curves and maps.

use std::cmp::Ordering;
use std::path::Path;

use condyle_results::{
    SettingDifference, Summary,
    catalogue::{self, CYCLES, MASS_LOSS_MG, Scalar, WEAR_OVER_CONVENTIONAL},
    setting_differences,
};
use serde::Serialize;

use crate::charts::{Channel, first_and_last};
use crate::error::ReportError;
use crate::maps::{MAPS, MappedField};
use crate::number::significant;
use crate::page::{label_of, unit_of};
use crate::results::{CaseFacts, Region, Results, SurfaceFields, Table, unworn_surface};

use crate::scene::Scene;

/// A results folder that is compared with others.
#[derive(Clone, Debug)]
pub struct Run {
    /// The name of the run: the folder as it was given; on the page of several runs, the title of its case if no other
    /// run has the same.
    pub name: String,
    /// The bodies in 3-D.
    pub(super) scene: Scene,
    /// The readable part of the folder.
    pub results: Results,
    /// The surface before the first cycle, by which meshes are compared.
    unworn: Option<SurfaceFields>,
}

/// Distance up to which nodes of two meshes are the same, mm: far less than the length of any edge.
const SAME_PLACE_MM: f64 = 1e-6;

impl Run {
    /// Reads the readable part of a folder; `results.left_out` lists the rest.
    ///
    /// # Errors
    /// The folder is missing, or nothing in it can be read.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let results = Results::read_readable(folder)?;
        Ok(Self {
            name: folder.display().to_string(),
            scene: Scene::read(folder, &results),
            results,
            // With a damaged one, maps are not subtracted.
            unworn: unworn_surface(folder).unwrap_or(None),
        })
    }

    pub(super) fn title(&self) -> Option<String> {
        let facts = CaseFacts::of(self.results.case.as_deref()?);
        // A case without a title has this one.
        facts.title.filter(|title| title != "Untitled")
    }

    /// Returns the last surfaces of two runs, if their maps can be subtracted.
    pub(super) fn comparable_surfaces<'a>(
        &'a self,
        other: &'a Self,
    ) -> Option<(&'a SurfaceFields, &'a SurfaceFields)> {
        let surfaces = self
            .results
            .surface
            .as_ref()
            .zip(other.results.surface.as_ref());
        surfaces.filter(|_| self.maps_obstacle(other).is_none())
    }

    /// Returns the reason why the maps of two runs cannot be subtracted; none if they can.
    pub(super) fn maps_obstacle(&self, other: &Self) -> Option<String> {
        if self.results.directions() != other.results.directions() {
            return Some("they are of different joints or sides".to_owned());
        }
        if self.results.surface.is_none() || other.results.surface.is_none() {
            return Some("one of the runs has no last mesh".to_owned());
        }
        let (Some(one), Some(two)) = (&self.unworn, &other.unworn) else {
            let file = "insert_0000.vtu, by which meshes are compared, is missing or damaged";
            return Some(file.to_owned());
        };
        if one.quads != two.quads {
            let [here, there] = [one, two].map(|surface| surface.nodes.len());
            return Some(format!(
                "the inserts have different meshes ({here} and {there} nodes)"
            ));
        }
        let mut pairs = one.nodes.iter().zip(&two.nodes);
        let is_elsewhere = pairs.any(|(here, there)| (here - there).norm() > SAME_PLACE_MM);
        is_elsewhere.then(|| "the inserts have different shapes".to_owned())
    }
}

/// All differences between two runs: second minus first.
#[derive(Clone, Debug, Serialize)]
pub struct Differences {
    /// Names of the runs.
    pub runs: [String; 2],
    /// Settings in which the cases differ.
    pub settings: Vec<SettingDifference>,
    /// Numbers, ranked by difference over error.
    pub numbers: Vec<NumberDifference>,
    /// Motions and loads, ranked by difference over range.
    pub curves: Vec<CurveDifference>,
    /// Maps of the last update, ranked by difference over the first's largest value.
    pub maps: Vec<MapDifference>,
    /// Parts that could not be compared, with reasons.
    pub notes: Vec<String>,
}

impl Differences {
    /// Compares the second run with the first.
    pub fn of(first: &Run, second: &Run) -> Self {
        let [one, two] = [first, second].map(|run| &run.results);
        let cases = one.case.as_deref().zip(two.case.as_deref());
        let summaries = one.summary.as_ref().zip(two.summary.as_ref());
        Self {
            runs: [first.name.clone(), second.name.clone()],
            settings: cases.map_or_else(Vec::new, |(one, two)| setting_differences(one, two)),
            numbers: summaries.map_or_else(Vec::new, |(one, two)| numbers(one, two)),
            curves: curves(one, two),
            maps: maps(first, second),
            notes: notes(first, second),
        }
    }

    /// Returns the difference of the mass in one sentence; `None` if a mass is not known.
    pub(super) fn verdict(&self) -> Option<String> {
        let [first, second] = &self.runs;
        let mut numbers = self.numbers.iter();
        let Some(mass) = numbers.find(|number| number.key == MASS_LOSS_MG.key) else {
            let is_known = !self.notes.iter().any(|note| note.contains("summary.json"));
            return is_known.then(|| format!("{second} wears as much as {first}."));
        };
        let (size, more) = (significant(mass.difference.abs(), 3), mass.difference > 0.0);
        let (more, sign) = if more {
            ("more", '+')
        } else {
            ("less", '\u{2212}')
        };
        let percent = mass.difference_percent.map_or_else(String::new, |percent| {
            format!(" ({sign}{} %)", significant(percent.abs(), 3))
        });
        let beside = match mass.times_errors {
            None => "; the discretisation error is not known",
            Some(times) if times < 1.0 => {
                ", less than the discretisation errors of both: it may have no other cause"
            }
            Some(times) => &format!(
                ", {} times the discretisation errors of both",
                significant(times, 2)
            ),
        };
        Some(format!(
            "{second} wears {size} mg {more} than {first}{percent}{beside}."
        ))
    }

    /// Returns whether nothing differs among the parts that could be compared.
    pub fn is_none(&self) -> bool {
        self.numbers.is_empty() && self.curves.is_empty() && self.maps.is_empty()
    }
}

/// Returns the fraction of laboratories in which the second run wears less, by the calibrated law, or why it cannot be stated;
/// none unless the calibrated law is that of both runs.
fn ranking(first: &Run, second: &Run) -> Option<String> {
    let (one, two) = (&first.name, &second.name);
    let own = first.results.summary.as_ref()?;
    let other = second.results.summary.as_ref()?;
    if own.joint == other.joint && own[&CYCLES] != other[&CYCLES] {
        return Some(format!(
            "{one} and {two} have different numbers of cycles: compare their wear per cycle."
        ));
    }
    let (by, of) = (other.prediction.as_ref()?, own.prediction.as_ref()?);
    if own.joint != other.joint || !(by.is_of_run && of.is_of_run) {
        return None;
    }
    let is_same_polyethylene =
        own.get(&WEAR_OVER_CONVENTIONAL) == other.get(&WEAR_OVER_CONVENTIONAL);
    let percent = 100.0 * by.part_below(of, is_same_polyethylene)?;
    let without = if by.has_discretisation() && of.has_discretisation() {
        ""
    } else {
        ", without the discretisation errors, which are not estimated"
    };
    Some(format!(
        "{two} wears less than {one} in {percent:.0} % of laboratories, by the calibrated law{without}."
    ))
}

fn notes(first: &Run, second: &Run) -> Vec<String> {
    let mut notes: Vec<String> = ranking(first, second).into_iter().collect();
    for Run { name, results, .. } in [first, second] {
        let doubts = results
            .summary
            .iter()
            .flat_map(|summary| &summary.plausibility);
        notes.extend(doubts.map(|doubt| format!("{name}: doubtful: {}.", doubt.message)));
        let left_out = results.left_out.iter();
        notes.extend(left_out.map(|why| format!("{name}: left out: {why}")));
        let files = [
            (
                "summary.json (the run is not finished)",
                results.summary.is_none(),
            ),
            ("kinematics.csv", results.kinematics.is_none()),
            ("case.toml", results.case.is_none()),
        ];
        let missing = files.into_iter().filter(|(_, is_missing)| *is_missing);
        let missing: Vec<&str> = missing.map(|(file, _)| file).collect();
        if !missing.is_empty() {
            notes.push(format!("{name}: missing: {}.", missing.join(", ")));
        }
    }
    if let Some(why) = first.maps_obstacle(second) {
        let (one, two) = (&first.name, &second.name);
        notes.push(format!(
            "Maps of {one} and {two} cannot be subtracted: {why}."
        ));
    }
    notes.extend(notes_on_both(first, second));
    notes
}

/// Returns remarks on cycles, meshes, activities, sides and versions in which two runs differ.
fn notes_on_both(first: &Run, second: &Run) -> Vec<String> {
    let mut notes = Vec::new();
    let last_cycle = |run: &Run| run.results.wear.as_ref()?.column("cycles")?.last().copied();
    if let (Some(one), Some(two)) = (last_cycle(first), last_cycle(second))
        && one != two
    {
        notes.push(format!(
            "Last cycles and maps are compared after {one} and {two} cycles."
        ));
    }
    let [one, two] = [&first.results, &second.results];
    let both = one.summary.as_ref().zip(two.summary.as_ref());
    let have_other_inputs = both.is_some_and(|(one, two)| one.inputs_blake3 != two.inputs_blake3);
    if have_other_inputs && one.case.is_some() && one.case == two.case {
        notes.push("The cases are equal, but their meshes differ.".to_owned());
    }
    if one.activities.is_empty() != two.activities.is_empty() {
        let only = "One run has several activities, the other has one or is not finished: the first is compared.";
        notes.push(only.to_owned());
    }
    let [one, two] = [first, second].map(|run| run.results.directions());
    if one.joint == two.joint && one.side != two.side {
        let sides = "One is a right joint and the other a left one: medial is on opposite sides.";
        notes.push(sides.to_owned());
    }
    if let Some((one, two)) = both
        && one.version != two.version
    {
        let (one, two) = (&one.version, &two.version);
        notes.push(format!("The runs are from condyle {one} and {two}."));
    }
    notes
}

/// A number in which two runs differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NumberDifference {
    /// The number, as the catalogue describes it.
    #[serde(skip)]
    pub scalar: &'static Scalar,
    /// Its key in `summary.json`, which ends in its unit.
    pub key: &'static str,
    /// Its name in words.
    pub label: String,
    /// Its unit as the report shows it.
    pub unit: String,
    /// The value of the first run.
    pub first: f64,
    /// The value of the second run.
    pub second: f64,
    /// Second minus first.
    pub difference: f64,
    /// The difference in percent of the first; none if that is 0.
    pub difference_percent: Option<f64>,
    /// Estimated discretisation error of the first.
    pub first_error: Option<f64>,
    /// Estimated discretisation error of the second.
    pub second_error: Option<f64>,
    /// The absolute difference over the sum of both errors: below 1 it may be due to discretisation alone. None if not
    /// both errors are stated.
    pub times_errors: Option<f64>,
}

impl NumberDifference {
    /// Returns the size of the difference relative to the errors, in words.
    pub fn verdict(&self) -> String {
        match self.times_errors {
            None => "no error stated".to_owned(),
            Some(times) if times < 1.0 => "smaller than the errors".to_owned(),
            Some(times) if times < 10.0 => format!("{times:.1} times the errors"),
            Some(times) => format!("{times:.0} times the errors"),
        }
    }

    /// Returns the sum of both errors.
    pub fn errors(&self) -> Option<f64> {
        Some(self.first_error? + self.second_error?)
    }
}

/// Returns the numbers that differ: ranked by difference over errors, then those without errors by their percent.
fn numbers(first: &Summary, second: &Summary) -> Vec<NumberDifference> {
    let difference = |scalar: &'static Scalar| {
        let (one, two) = (first.get(scalar)?, second.get(scalar)?);
        let difference = two - one;
        let number = NumberDifference {
            scalar,
            key: scalar.key,
            label: label_of(scalar),
            unit: unit_of(scalar),
            first: one,
            second: two,
            difference,
            difference_percent: (one != 0.0).then(|| 100.0 * difference / one.abs()),
            first_error: first.total_error(scalar),
            second_error: second.total_error(scalar),
            times_errors: None,
        };
        let errors = number.errors().filter(|errors| *errors > 0.0);
        (difference != 0.0).then(|| NumberDifference {
            times_errors: errors.map(|errors| difference.abs() / errors),
            ..number
        })
    };
    let mut numbers: Vec<_> = catalogue::results().filter_map(difference).collect();
    let rank = |number: &NumberDifference| {
        let percent = number.difference_percent.map_or(f64::INFINITY, f64::abs);
        (number.times_errors.unwrap_or(-1.0), percent)
    };
    numbers.sort_by(|one, two| rank(two).partial_cmp(&rank(one)).unwrap_or(Ordering::Equal));
    numbers
}

/// The difference of two curves, in the unit of their column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurveDifference {
    /// Name of the column of `kinematics.csv`.
    pub column: String,
    /// Its name in words.
    pub title: String,
    /// Its unit.
    pub unit: &'static str,
    /// The cycle, "first" or "last", after the name of the activity where a run has several.
    pub cycle: String,
    /// Root mean square of second minus first, at the instants of the first.
    pub rms: f64,
    /// The difference with the largest absolute value.
    pub largest: f64,
    /// Percent of the cycle of the largest difference.
    pub largest_at_percent: f64,
    /// The root mean square in percent of the first curve's range; none if that is flat.
    pub rms_percent_of_range: Option<f64>,
}

type Points = Vec<(f64, f64)>;

/// Motions and loads of the first and last cycle that both runs have and that differ, ranked by difference over range.
fn curves(first: &Results, second: &Results) -> Vec<CurveDifference> {
    let have_activities = !first.activities.is_empty() && !second.activities.is_empty();
    let mut curves = Vec::new();
    for (activity, one) in tables(first, have_activities) {
        let Some((_, two)) = tables(second, have_activities)
            .into_iter()
            .find(|(own, _)| *own == activity)
        else {
            continue;
        };
        let cycles = ["first", "last"].into_iter();
        let channels = cycles.flat_map(|cycle| one.names().iter().map(move |name| (cycle, name)));
        curves.extend(channels.filter_map(|(cycle, name)| {
            let channel = Channel::find(name, first.motions())?;
            curve([one, two], cycle, activity, channel)
        }));
    }
    let rank = |curve: &CurveDifference| curve.rms_percent_of_range.unwrap_or(0.0);
    curves.sort_by(|one, two| rank(two).total_cmp(&rank(one)));
    curves
}

/// Returns the motions and loads of each activity with its name, or of the first one without a name.
fn tables(results: &Results, have_activities: bool) -> Vec<(&str, &Table)> {
    if !have_activities {
        return results.kinematics.iter().map(|table| ("", table)).collect();
    }
    let all = results.activities.iter();
    all.filter_map(|(activity, table)| Some((activity.name.as_str(), table.as_ref()?)))
        .collect()
}

fn curve(
    tables: [&Table; 2],
    cycle: &str,
    activity: &str,
    channel: Channel,
) -> Option<CurveDifference> {
    let [here, there] = tables.map(|table| points(table, cycle, &channel.column));
    let (here, there) = (here?, there?);
    let apart = |&(percent, value): &(f64, f64)| Some((percent, at(&there, percent)? - value));
    let apart: Points = here.iter().filter_map(apart).collect();
    let largest = apart
        .iter()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let rms = (apart.iter().map(|(_, off)| off * off).sum::<f64>() / apart.len() as f64).sqrt();
    let values = || here.iter().map(|point| point.1);
    let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
    (rms > 0.0).then(|| CurveDifference {
        column: channel.column.into_owned(),
        title: channel.title.into_owned(),
        unit: channel.unit,
        cycle: format!("{activity} {cycle}").trim_start().to_owned(),
        rms,
        largest: largest.1,
        largest_at_percent: largest.0,
        rms_percent_of_range: (range > 0.0).then(|| 100.0 * rms / range),
    })
}

/// Returns the points of a cycle; the only cycle of a table is its first and its last.
fn points(table: &Table, cycle: &str, name: &str) -> Option<Points> {
    let (percents, values) = (table.column("percent")?, table.column(name)?);
    table.column("cycles")?;
    let ends = first_and_last(table);
    let chosen = if cycle == "first" {
        ends.first()
    } else {
        ends.last()
    };
    let rows = chosen?.rows.iter().copied();
    let known = rows.filter(|&row| values[row].is_finite());
    let points: Points = known.map(|row| (percents[row], values[row])).collect();
    (!points.is_empty()).then_some(points)
}

/// Returns the value of a curve at an instant, by linear interpolation; none after its last point.
fn at(points: &Points, percent: f64) -> Option<f64> {
    let after = points.partition_point(|point| point.0 < percent);
    let &(x, y) = points.get(after)?;
    if x == percent {
        return Some(y);
    }
    // Cycles repeat: before the first instant lies the last one of the cycle before.
    let before = after.checked_sub(1).map(|before| points[before]);
    let (x0, y0) = before.or_else(|| points.last().map(|&(x, y)| (x - 100.0, y)))?;
    Some(y0 + (percent - x0) / (x - x0) * (y - y0))
}

/// The difference of two maps, in the unit of the field.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapDifference {
    /// Name of the point data.
    pub field: &'static str,
    /// Its name in words.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The difference, second minus first, with the largest absolute value.
    pub largest: f64,
    /// x of the largest difference, mm.
    pub x_mm: f64,
    /// z of the largest difference, mm.
    pub z_mm: f64,
    /// Mean absolute difference over the surface.
    pub mean_absolute: f64,
    /// The largest difference in percent of the first map's largest value; none if that is 0.
    pub largest_percent: Option<f64>,
}

/// Maps that differ, ranked by difference over the largest value; none if maps cannot be subtracted.
fn maps(first: &Run, second: &Run) -> Vec<MapDifference> {
    let Some((one, two)) = first.comparable_surfaces(second) else {
        return Vec::new();
    };
    let area = one.integral(&vec![1.0; one.nodes.len()], Region::Whole);
    let map = |map: &MappedField| {
        let apart = subtracted(one, two, map.field)?;
        let largest = one.largest_by(&apart, Region::Whole, f64::abs)?;
        let sizes: Vec<f64> = apart.iter().map(|value| value.abs()).collect();
        let of = one.largest(one.field(map.field)?, Region::Whole)?.value;
        (largest.value != 0.0).then(|| MapDifference {
            field: map.field,
            title: map.style.title,
            unit: map.style.unit,
            largest: largest.value,
            x_mm: largest.position.x,
            z_mm: largest.position.z,
            mean_absolute: one.integral(&sizes, Region::Whole) / area,
            largest_percent: (of != 0.0).then(|| 100.0 * largest.value / of),
        })
    };
    let mut maps: Vec<_> = MAPS.iter().filter_map(map).collect();
    let rank = |map: &MapDifference| map.largest_percent.map_or(f64::INFINITY, f64::abs);
    maps.sort_by(|one, two| rank(two).total_cmp(&rank(one)));
    maps
}

pub(super) fn subtracted(
    one: &SurfaceFields,
    two: &SurfaceFields,
    field: &str,
) -> Option<Vec<f64>> {
    let pairs = two.field(field)?.iter().zip(one.field(field)?);
    Some(pairs.map(|(two, one)| two - one).collect())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn keys_that_differ_are_listed_by_their_path() {
        let first = "[contact]\nfriction = 0.04\nlaw = \"linear\"\n[[activity]]\nname = \"gait\"\n";
        let second = "[contact]\nfriction = 0.06\nlaw = \"linear\"\n[[activity]]\nname = \"stairs\"\nshare = 1\n";
        let found = setting_differences(first, second);
        let keys: Vec<&str> = found.iter().map(|found| found.key.as_str()).collect();
        assert_eq!(
            keys,
            ["activity[0].name", "activity[0].share", "contact.friction"]
        );
        assert_eq!(found[1].first, None);
        assert_eq!(found[2].second.as_deref(), Some("0.06"));
    }

    fn summary(mass: f64, depth: f64, ap: f64) -> Summary {
        let text = format!(
            r#"{{"mass_loss_mg": {mass}, "max_depth_mm": {depth}, "ap_range_mm": {ap}, "ie_range_deg": 5,
                "error": {{"mass_loss_mg": {{"total": 0.5}}, "mass_loss_percent": {{"total": 0.6}},
                    "max_depth_mm": {{"total": 0.01}}, "max_depth_percent": {{"total": 2.5}}}}}}"#
        );
        serde_json::from_str(&text).expect("is JSON")
    }

    #[test]
    fn differences_rank_by_size_over_errors_and_equal_numbers_are_left_out() {
        let found = numbers(&summary(80.0, 0.4, 4.0), &summary(80.5, 0.5, 5.0));
        let keys: Vec<&str> = found.iter().map(|found| found.key).collect();
        assert_eq!(keys, ["max_depth_mm", "mass_loss_mg", "ap_range_mm"]);
        assert!((found[0].times_errors.expect("has errors") - 5.0).abs() < 1e-9);
        assert_eq!(found[0].verdict(), "5.0 times the errors");
        assert_eq!(found[1].verdict(), "smaller than the errors");
        assert_eq!(found[2].verdict(), "no error stated");
        assert_eq!(found[2].difference_percent, Some(25.0));
    }

    fn results(rows: &str) -> Results {
        let text = format!("cycles,percent,ap_mm\n{rows}");
        Results {
            kinematics: Some(Table::parse(&text, Path::new("k.csv")).expect("is a table")),
            ..Results::default()
        }
    }

    #[test]
    fn curves_of_every_activity_are_compared() {
        let of = |walks: &str, climbs: &str| {
            let activity = |name: &str, rows: &str| {
                let summary = serde_json::json!({
                    "name": name, "share_of_cycles": 0.5, "kinematics_file": "k.csv", "mass_loss_mg": 1.0,
                    "volume_loss_mm3": 1.0, "volume_loss_alone_mm3": 1.0, "peak_pressure_mpa": 1.0,
                    "peak_contact_area_mm2": 1.0, "peak_axial_force_n": 1.0
                });
                let summary = serde_json::from_value(summary).unwrap();
                (summary, results(rows).kinematics)
            };
            Results {
                activities: vec![activity("walking", walks), activity("stairs", climbs)],
                ..results(walks)
            }
        };
        let same = "0,50,1\n0,100,3\n";
        let found = curves(&of(same, same), &of(same, "0,50,1\n0,100,4\n"));
        let cycles: Vec<&str> = found.iter().map(|curve| curve.cycle.as_str()).collect();
        assert_eq!(cycles, ["stairs first", "stairs last"]);
    }

    #[test]
    fn curves_of_other_instants_are_interpolated() {
        let coarse = results("0,50,1\n0,100,3\n");
        let fine = results("0,50,1\n0,75,2\n0,100,5\n");
        let found = curves(&coarse, &fine);
        // The one cycle is the first and the last.
        assert_eq!(found.len(), 2);
        assert_eq!(
            (found[0].largest, found[0].largest_at_percent),
            (2.0, 100.0)
        );
        assert!((found[0].rms - 2.0_f64.sqrt()).abs() < 1e-12);
        let back = curves(&fine, &coarse);
        assert_eq!(back[0].largest, -2.0);
        assert!(curves(&coarse, &coarse).is_empty());
    }
}
