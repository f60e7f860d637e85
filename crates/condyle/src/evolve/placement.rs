//! The femur is lowered onto the insert, and settles.

use thiserror::Error;

use super::WearTest;
use crate::{
    Vec3,
    contact::{ContactModel, Foundation},
    geometry::{ArticulatingSurface, FemoralSurface},
    machine::{Chain, Drive, JointKind, Machine, NotSettled, Settling, SolverCounters, settle},
    spatial::{Pose, RelativeMotion},
};

/// How deep the first touch is, mm.
const FIRST_OVERCLOSURE_MM: f64 = 0.01;
/// Longest step down where the gap is not known better, mm: less than a mesh's field reaches.
const LONGEST_STEP_MM: f64 = 1.5;
/// A settled femur may be this deep in the insert, as a share of the thickness there.
const DEEPEST_SHARE: f64 = 0.5;

/// Why two bodies make no knee.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlacementError {
    /// Nothing of the insert lies below the femur.
    #[error(
        "femur and insert are apart: lowered at x {x_mm:.1}, z {z_mm:.1} mm the femur passes the insert without \
         touching it; check length_unit, axes and start_mm"
    )]
    Apart {
        /// Where the femur was lowered.
        x_mm: f64,
        /// Where the femur was lowered.
        z_mm: f64,
    },
    /// The settled femur lies too deep in the insert.
    #[error(
        "femur and insert overlap by {overclosure_mm:.2} mm at the start, more than half the insert's thickness \
         of {thickness_mm:.2} mm there; check length_unit, axes, start_mm and the material"
    )]
    DeepOverlap {
        /// Deepest overclosure.
        overclosure_mm: f64,
        /// Thickness there.
        thickness_mm: f64,
    },
    /// The femur slides off or tips over.
    #[error(
        "the femur does not settle on the insert under the axial load: {residual_n:.3e} N are left over at \
         {}; check axes and start_mm",
        listed(shifts_mm)
    )]
    NotSettled {
        /// Force left out of balance.
        residual_n: f64,
        /// Where it got to: the shifts that settling zeroes, by the names that messages give them.
        shifts_mm: Vec<(&'static str, f64)>,
    },
}

/// Shifts as a message tells them, such as `AP 1.00, ML 0.00, IS -0.20 mm`.
fn listed(shifts_mm: &[(&'static str, f64)]) -> String {
    let shift = |(symbol, at_mm): &(&str, f64)| format!("{symbol} {at_mm:.2}");
    let shifts: Vec<String> = shifts_mm.iter().map(shift).collect();
    format!("{} mm", shifts.join(", "))
}

impl PlacementError {
    fn not_settled(machine: &Machine, failed: &NotSettled) -> Self {
        let mechanism = machine.mechanism;
        let in_files = mechanism.in_files.into_iter();
        let zeroed = in_files.filter(|&index| mechanism.joint(index).is_zeroed);
        let shift = |index| (mechanism.joint(index).symbol, index.of(&failed.positions));
        Self::NotSettled {
            residual_n: failed.residual_n,
            shifts_mm: zeroed.map(shift).collect(),
        }
    }
}

/// The machine's chain, zeroed where the femur settles, and the settled positions.
pub(super) fn place(
    test: &WearTest,
    counters: &mut SolverCounters,
) -> Result<(Chain, [f64; 6]), PlacementError> {
    let surface = test.insert.surface();
    let (axis_x, axis_y) = test.flexion_axis_mm;
    let start = Vec3::new(test.start_mm.0 - axis_x, -axis_y, test.start_mm.1);
    let flexed = Chain::new(&test.machine, start, test.flexion_axis_mm)
        .at(&driven(test))
        .pose;
    let lowered = lowered(&test.femur, &surface, flexed).ok_or(PlacementError::Apart {
        x_mm: test.start_mm.0,
        z_mm: test.start_mm.1,
    })?;
    let down = lowered.translation.y - flexed.translation.y - FIRST_OVERCLOSURE_MM;
    let chain = Chain::new(
        &test.machine,
        start + Vec3::y() * down,
        test.flexion_axis_mm,
    );
    let mut contact = Foundation::new(&test.contact, &test.femur, &test.insert);
    let positions = settle(
        &test.machine,
        &chain,
        &mut contact,
        test.time.force_tolerance_n,
        counters,
    )
    .map_err(|failed| PlacementError::not_settled(&test.machine, &failed))?;
    check_depth(test, &surface, &mut contact, &chain.at(&positions).pose)?;
    Ok(chain.zeroed_at(&test.machine, &positions))
}

/// Positions with the femur turned as at the start of the cycle and all else at zero.
fn driven(test: &WearTest) -> [f64; 6] {
    std::array::from_fn(|j| {
        let joint = &test.machine.joints[j];
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
    test: &WearTest,
    surface: &ArticulatingSurface,
    contact: &mut Foundation<'_>,
    pose: &Pose,
) -> Result<(), PlacementError> {
    let motion = RelativeMotion::at_rest(*pose);
    contact.respond(&motion);
    for touched in contact.land(&motion).touched {
        let node = touched.node as usize;
        let overclosure_mm = -test.femur.gap_mm(&pose.to_femur(&surface.positions[node]));
        let thickness_mm = test.insert.thickness_mm()[node];
        if overclosure_mm > DEEPEST_SHARE * thickness_mm {
            return Err(PlacementError::DeepOverlap {
                overclosure_mm,
                thickness_mm,
            });
        }
    }
    Ok(())
}
