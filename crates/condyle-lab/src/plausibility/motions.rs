//! Checks of how the knee moved.

use condyle::machine::{
    JointIndex,
    knee::{AP, IE, IS, KNEE, ML, VV},
};
use condyle_io::results::{PlausibilityWarning, joint_range};

use super::finished::{Finished, SolvedCycle};

/// A freedom, and more than knees move along it in walking and stairs, in the unit of files.
type MostMotion = (JointIndex, f64);

/// Generous choices of ours.
const MOST: [MostMotion; 5] = [(AP, 25.0), (IE, 35.0), (ML, 10.0), (VV, 8.0), (IS, 10.0)];
/// A side that carries less of the load is lifted off, as a part.
const LIFTED: f64 = 0.01;
/// Below this part of the largest load a lift says little.
const LITTLE_LOAD: f64 = 0.1;
/// Part of a cycle that one side may be lifted off, %: a choice of ours.
const MAX_LIFTED_PERCENT: f64 = 5.0;

/// The range of a freedom in the first or the last cycle, whichever is larger.
pub(super) fn ranges(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    let beyond = MOST.iter().filter_map(|&limit| range(finished, limit));
    beyond.collect()
}

fn range(finished: &Finished<'_>, (joint, most): MostMotion) -> Option<PlausibilityWarning> {
    let moved = |cycle: SolvedCycle<'_>| (joint_range(cycle.rows, joint), cycle.name);
    let moved = finished.cycles().map(moved);
    let (range, cycle) = moved.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let description = KNEE.joint(joint);
    let unit = match description.kind().unit() {
        "deg" => "degrees",
        unit => unit,
    };
    (range > most).then(|| PlausibilityWarning {
        check: format!("{}_range", description.name),
        value: range,
        limit: most,
        unit: unit.to_owned(),
        message: format!(
            "{} moves by {range:.1} {unit} in the {cycle} cycle; knees stay below {most:.0}",
            description.symbol
        ),
        advice: "See the loads, the springs and their free play, and whether the femur is held by the dishes at all."
            .to_owned(),
    })
}

/// One side carries nothing while the joint is loaded.
pub(super) fn lift_off(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let lifted = finished
        .cycles()
        .map(|cycle| (lifted_percent(&cycle), cycle.name));
    let most = lifted.max_by(|a, b| a.0.total_cmp(&b.0));
    let beyond = most.filter(|(percent, _)| *percent > MAX_LIFTED_PERCENT);
    beyond.map(|(percent, cycle)| PlausibilityWarning {
        check: "lift_off".to_owned(),
        value: percent,
        limit: MAX_LIFTED_PERCENT,
        unit: "%".to_owned(),
        message: format!(
            "for {percent:.0} % of the {cycle} cycle one side carries nothing while the joint is loaded; up to \
             {MAX_LIFTED_PERCENT:.0} % would be sound"
        ),
        advice: "See vv_axis_medial_mm, which splits the load between the sides, start_mm, and whether both bodies are of \
                 the same side."
            .to_owned(),
    })
}

fn lifted_percent(cycle: &SolvedCycle<'_>) -> f64 {
    let largest = cycle.rows.iter().map(|row| row.axial_force_n);
    let largest = largest.fold(0.0, f64::max);
    cycle.percent_of_rows(|row| {
        let sides = &row.region_force_n[..KNEE.regions.len()];
        let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
        row.axial_force_n > LITTLE_LOAD * largest && least < LIFTED * row.axial_force_n
    })
}

#[cfg(test)]
mod tests {
    use condyle::machine::CycleRow;

    use super::*;

    fn row(medial_n: f64, lateral_n: f64) -> CycleRow {
        let region_force_n = [medial_n, lateral_n];
        CycleRow {
            percent: 0.0,
            positions: [0.0; 6],
            axial_force_n: medial_n + lateral_n,
            contact_area_mm2: 0.0,
            peak_pressure_mpa: 0.0,
            region_force_n,
        }
    }

    #[test]
    fn a_side_is_lifted_where_it_carries_nothing_under_load() {
        // Both carry; one does not; one does not, and the joint is hardly loaded.
        let rows = [
            row(600.0, 400.0),
            row(1000.0, 0.0),
            row(0.0, 50.0),
            row(1.0, 999.0),
        ];
        let cycle = SolvedCycle {
            name: "first",
            activity: 0,
            rows: &rows,
        };
        assert_eq!(lifted_percent(&cycle), 50.0);
    }
}
