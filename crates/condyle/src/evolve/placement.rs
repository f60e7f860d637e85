//! The placement of the counterface: it is lowered onto the insert, and settles.

use super::{Activity, PlacementError, WearTest};
use crate::{
    Vec3,
    contact::{Bodies, ContactMemory, ContactModel},
    geometry::{ArticulatingSurface, Counterface},
    machine::{
        Chain, Drive, JointKind, MachineState, Settling, SolverCounters, settle, settle_from,
    },
    spatial::{Pose, RelativeMotion},
};

/// Overclosure of the first touch, mm.
const FIRST_OVERCLOSURE_MM: f64 = 0.01;
/// Longest step down, mm: less than the reach of a mesh's distance field, beyond which the gap is a bound.
const LONGEST_STEP_MM: f64 = 1.5;
/// Largest overclosure of a settled counterface, as a share of the thickness there.
const DEEPEST_SHARE: f64 = 0.5;

/// Largest strain of a ligament: specimens tear at about this strain; our choice.
const MAX_STRAIN: f64 = 0.3;

/// Returns the machine's chain, zeroed where the counterface settles, and the settled positions.
pub(super) fn place(
    test: &WearTest,
    bodies: Bodies<'_>,
    counters: &mut SolverCounters,
) -> Result<(Chain, [f64; 6]), PlacementError> {
    let machine = test.machine();
    let (axis_x, axis_y) = test.flexion_axis_mm;
    let start = Vec3::new(test.start_mm.0 - axis_x, -axis_y, test.start_mm.1);
    let flexed = Chain::new(machine, start, test.flexion_axis_mm)
        .at(&driven(test))
        .pose;
    let start_mm = test.start_mm;
    let above_mm = |height_mm: f64| height_mm + flexed.translation.y;
    let height_mm = test.start_height_mm.map(above_mm);
    let lowered = lowered(bodies.counterface, bodies.surface, flexed, height_mm);
    let lowered = lowered.ok_or(PlacementError::Apart { start_mm })?;
    // A slight overclosure, so that the first evaluation has a stiffness.
    let down = lowered.translation.y - flexed.translation.y - FIRST_OVERCLOSURE_MM;
    let chain = Chain::new(machine, start + Vec3::y() * down, test.flexion_axis_mm);
    let mut contact = test.contact.contact(bodies, ContactMemory::default());
    let positions = settle(
        machine,
        &chain,
        contact.as_mut(),
        test.time.force_tolerance_n,
        counters,
    )
    .map_err(|failed| PlacementError::not_settled(machine, &failed))?;
    check_depth(bodies, contact.as_mut(), &chain.at(&positions).pose)?;
    let (chain, positions) = chain.zeroed_at(machine, &positions);
    check_ligaments(test, &chain, &positions)?;
    Ok((chain, positions))
}

/// Returns the machine of an activity at rest where its cycle starts, from the settled positions of the first activity.
///
/// An activity that does not come to rest there starts at those positions, and its cycle shows the reason.
pub(super) fn start_of(
    activity: &Activity,
    test: &WearTest,
    bodies: Bodies<'_>,
    zero_mm: Vec3,
    settled: [f64; 6],
    counters: &mut SolverCounters,
) -> MachineState {
    let machine = &activity.machine;
    let start = MachineState::at_rest(machine, settled);
    if start.now.positions == settled {
        return start;
    }
    let chain = Chain::new(machine, zero_mm, test.flexion_axis_mm);
    let mut contact = test.contact.contact(bodies, ContactMemory::default());
    let tolerance_n = test.time.force_tolerance_n;
    let found = settle_from(
        settled,
        machine,
        &chain,
        contact.as_mut(),
        tolerance_n,
        counters,
    );
    found.map_or(start, |positions| MachineState::at_rest(machine, positions))
}

/// Refuses ligaments that would have torn where the counterface settles.
fn check_ligaments(
    test: &WearTest,
    chain: &Chain,
    positions: &[f64; 6],
) -> Result<(), PlacementError> {
    let pose = chain.at(positions).pose;
    for ligament in test
        .activities
        .iter()
        .flat_map(|activity| &activity.machine.ligaments)
    {
        let strain = ligament.strain(&chain.zero_mm(), &pose);
        // Attachments that coincide at zero give no length and no finite strain.
        if !strain.is_finite() || strain > MAX_STRAIN {
            return Err(PlacementError::TightLigament {
                name: ligament.name.clone(),
                percent: 100.0 * strain,
                most_percent: 100.0 * MAX_STRAIN,
            });
        }
    }
    Ok(())
}

/// Returns the positions with the rotations at the start of the cycle and all other joints at zero.
fn driven(test: &WearTest) -> [f64; 6] {
    std::array::from_fn(|j| {
        let joint = &test.machine().joints[j];
        let description = joint.description;
        let is_driven = description.settling == Settling::Driven;
        match &joint.drive {
            Drive::Prescribed(angle) if is_driven && description.kind() == JointKind::Rotation => {
                angle.at(0.0).0
            }
            _ => 0.0,
        }
    })
}

/// Returns the pose lowered from a height, or from far above, until the first node touches; none if the counterface passes the
/// insert.
///
/// The gap is a lower bound of the distance, so a step by the smallest gap cannot skip a touch.
fn lowered(
    counterface: &Counterface,
    surface: &ArticulatingSurface,
    pose: Pose,
    height_mm: Option<f64>,
) -> Option<Pose> {
    const TOUCH_MM: f64 = 1e-4;
    let (low, high) = surface.height_range_mm();
    let reach = counterface.reach_mm();
    let mut pose = pose;
    // Far above, no part of the counterface can reach the insert.
    pose.translation.y = height_mm.unwrap_or(high + reach);
    while pose.translation.y > low - reach {
        let gap = |position: &Vec3| counterface.gap_mm(&pose.to_counterface(position));
        let nearest = surface
            .positions
            .iter()
            .map(gap)
            .fold(f64::INFINITY, f64::min);
        if nearest <= TOUCH_MM {
            return Some(pose);
        }
        // Beyond its band a mesh's gap is a bound along grid lines, which is not used for longer steps.
        pose.translation.y -= nearest.min(LONGEST_STEP_MM);
    }
    None
}

fn check_depth(
    bodies: Bodies<'_>,
    contact: &mut dyn ContactModel,
    pose: &Pose,
) -> Result<(), PlacementError> {
    let motion = RelativeMotion::at_rest(*pose);
    contact.respond(&motion);
    for touched in contact.evaluate(&motion).touched {
        let node = touched.node as usize;
        let overclosure_mm = -bodies
            .counterface
            .gap_mm(&pose.to_counterface(&bodies.surface.positions[node]));
        let thickness_mm = bodies.insert.thickness_mm()[node];
        if overclosure_mm > DEEPEST_SHARE * thickness_mm {
            return Err(PlacementError::DeepOverlap {
                overclosure_mm,
                thickness_mm,
            });
        }
    }
    Ok(())
}
