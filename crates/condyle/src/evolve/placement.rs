//! The femur is lowered onto the insert, and settles.

use super::{PlacementError, WearTest};
use crate::{
    Vec3,
    contact::{Bodies, ContactMemory, ContactModel},
    geometry::{ArticulatingSurface, FemoralSurface},
    machine::{Chain, Drive, JointKind, Settling, SolverCounters, settle},
    spatial::{Pose, RelativeMotion},
};

/// How deep the first touch is, mm.
const FIRST_OVERCLOSURE_MM: f64 = 0.01;
/// Longest step down where the gap is not known better, mm: less than a mesh's field reaches.
const LONGEST_STEP_MM: f64 = 1.5;
/// A settled femur may be this deep in the insert, as a share of the thickness there.
const DEEPEST_SHARE: f64 = 0.5;

/// The machine's chain, zeroed where the femur settles, and the settled positions.
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
    let lowered = lowered(bodies.femur, bodies.surface, flexed).ok_or(PlacementError::Apart {
        x_mm: test.start_mm.0,
        z_mm: test.start_mm.1,
    })?;
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
    Ok(chain.zeroed_at(machine, &positions))
}

/// Positions with the femur turned as at the start of the cycle and all else at zero.
fn driven(test: &WearTest) -> [f64; 6] {
    std::array::from_fn(|j| {
        let joint = &test.machine().joints[j];
        let description = joint.description;
        let turns = description.kind() == JointKind::Rotation;
        match &joint.drive {
            Drive::Prescribed(turn) if turns && description.settling == Settling::Driven => {
                turn.at(0.0).0
            }
            _ => 0.0,
        }
    })
}

/// The pose lowered from high above until the first node touches; none if it passes the insert.
///
/// No point of the femur comes down faster than the femur, so a step by the smallest gap cannot
/// jump over a touch.
fn lowered(femur: &FemoralSurface, surface: &ArticulatingSurface, pose: Pose) -> Option<Pose> {
    const TOUCH_MM: f64 = 1e-4;
    let (low, high) = surface.height_range_mm();
    let reach = femur.reach_mm();
    let mut pose = pose;
    pose.translation.y = high + reach;
    while pose.translation.y > low - reach {
        let gap = |position: &Vec3| femur.gap_mm(&pose.to_femur(position));
        let nearest = surface
            .positions
            .iter()
            .map(gap)
            .fold(f64::INFINITY, f64::min);
        if nearest <= TOUCH_MM {
            return Some(pose);
        }
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
            .femur
            .gap_mm(&pose.to_femur(&bodies.surface.positions[node]));
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
