//! Whether the femur stays over the articulating surface.

use condyle::{machine::Chain, machine::knee::KNEE, spatial::Pose};
use condyle_io::results::PlausibilityWarning;

use super::finished::{Finished, SolvedCycle};

/// Part of a cycle that a condyle may be beyond the rim, %: a choice of ours.
const MAX_BEYOND_PERCENT: f64 = 1.0;
/// Nearer than this a condyle is at the surface, mm, pressed or not; how far a mesh's field is sure of gaps.
const NEAR_MM: f64 = 1.5;
/// Instants of a cycle that are looked at, at most.
const INSTANTS: usize = 50;

/// Where a condyle is beyond the rim.
struct Beyond {
    percent: f64,
    side: &'static str,
    cycle: &'static str,
}

/// A condyle that comes nearest to the insert at the rim of the articulating surface, pressed there or not: its
/// middle is on the rim or beyond.
pub(super) fn femur_beyond_rim(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let beyond = finished.cycles().flat_map(|cycle| beyond(finished, &cycle));
    let most = beyond.max_by(|a, b| a.percent.total_cmp(&b.percent));
    let too_much = most.filter(|beyond| beyond.percent > MAX_BEYOND_PERCENT);
    too_much.map(|Beyond { percent, side, cycle }| PlausibilityWarning {
        check: "femur_beyond_rim".to_owned(),
        value: percent,
        limit: MAX_BEYOND_PERCENT,
        unit: "%".to_owned(),
        message: format!(
            "for {percent:.0} % of the {cycle} cycle the {side} condyle is on or beyond the rim of the articulating surface"
        ),
        advice: "The femur rides off the insert: look at the placement of the bodies (start_mm, axes, sides), the sizes of \
                 both, loads and springs, and at where the outline of the insert was cut."
            .to_owned(),
    })
}

/// Of every side, in which part of a cycle its condyle is nearest to the rim.
fn beyond(finished: &Finished<'_>, cycle: &SolvedCycle<'_>) -> Vec<Beyond> {
    let test = finished.march.test();
    let machine = finished.machine(cycle);
    let chain = Chain::new(
        machine,
        finished.march.state().zero_mm,
        test.flexion_axis_mm,
    );
    let every = cycle.rows.len().div_ceil(INSTANTS).max(1);
    let looked_at: Vec<Pose> = cycle
        .rows
        .iter()
        .step_by(every)
        .map(|row| chain.at(&row.positions).pose)
        .collect();
    let sides = KNEE.regions.iter().enumerate();
    let of_side = |(side, region): (usize, &condyle::machine::Region)| {
        let at_rim = looked_at
            .iter()
            .filter(|pose| is_at_rim(finished, pose, side));
        Beyond {
            percent: 100.0 * at_rim.count() as f64 / looked_at.len().max(1) as f64,
            side: region.name,
            cycle: cycle.name,
        }
    };
    sides.map(of_side).collect()
}

/// Whether the node of a side that the femur is nearest to is one of the rim.
fn is_at_rim(finished: &Finished<'_>, pose: &Pose, side: usize) -> bool {
    let regions = finished.march.insert().regions();
    let nodes = finished.surface.positions.iter().enumerate();
    let of_side = nodes.filter(|(node, _)| regions.of_node(*node) == side);
    let gaps =
        of_side.map(|(node, place)| (finished.march.femur().gap_mm(&pose.to_femur(place)), node));
    let nearest = gaps.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.is_some_and(|(gap_mm, node)| gap_mm < NEAR_MM && finished.is_on_rim(node))
}
