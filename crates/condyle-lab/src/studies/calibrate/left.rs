//! What is left between a run with a pressure table and the same run on the deformable insert.

use condyle::{
    evolve::March,
    machine::{
        CycleRow, JointIndex,
        knee::{AP, IE, KNEE},
    },
};
use condyle_io::results::Summary;
use serde::Serialize;

/// An increment with at least this part of the cycle's highest axial force is one of stance.
const STANCE: f64 = 0.2;

/// What a number is off by over the increments of stance, %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OffInStance {
    /// Root of the mean square.
    pub mean_percent: f64,
    /// The largest, without its sign.
    pub most_percent: f64,
    /// Of the highest value of the cycle, with its sign.
    pub of_highest_percent: f64,
}

/// What a cycle of the rigid model is off by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CycleLeft {
    /// Peak pressure.
    pub peak_pressure: OffInStance,
    /// Contact area.
    pub contact_area: OffInStance,
    /// Root of the mean square over the whole cycle, mm.
    pub ap_mm: f64,
    /// The same, degrees.
    pub ie_deg: f64,
}

/// What a run of the rigid model is off by.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Left {
    /// The first cycle.
    pub first_cycle: CycleLeft,
    /// The last cycle solved.
    pub last_cycle: CycleLeft,
    /// Mass lost on the deformable insert, mg.
    pub deformable_mass_loss_mg: f64,
    /// Mass lost with the foundation, mg.
    pub mass_loss_mg: f64,
    /// What that is off by, %.
    pub mass_loss_percent: f64,
    /// Deepest wear on the deformable insert, mm.
    pub deformable_max_depth_mm: f64,
    /// Deepest wear with the foundation, mm.
    pub max_depth_mm: f64,
    /// What that is off by, %.
    pub max_depth_percent: f64,
    /// Seconds of the solver on the deformable insert.
    pub deformable_wall_s: f64,
    /// Seconds of the solver with the foundation.
    pub wall_s: f64,
}

/// A march that is done, and what it came to.
pub(super) struct Ran {
    pub march: March,
    pub summary: Summary,
}

impl Left {
    /// What is left between two runs that are done.
    pub(super) fn between(foundation: &Ran, deformable: &Ran) -> Self {
        let (found, wanted) = (&foundation.summary, &deformable.summary);
        let cycles = first_and_last(&foundation.march)
            .into_iter()
            .zip(first_and_last(&deformable.march));
        let [first_cycle, last_cycle] = <[CycleLeft; 2]>::try_from(
            cycles
                .map(|(found, wanted)| CycleLeft::between(found, wanted))
                .collect::<Vec<_>>(),
        )
        .expect("a first and a last cycle");
        Self {
            first_cycle,
            last_cycle,
            deformable_mass_loss_mg: wanted.mass_loss_mg,
            mass_loss_mg: found.mass_loss_mg,
            mass_loss_percent: off_percent(found.mass_loss_mg, wanted.mass_loss_mg),
            deformable_max_depth_mm: wanted.max_depth_mm,
            max_depth_mm: found.max_depth_mm,
            max_depth_percent: off_percent(found.max_depth_mm, wanted.max_depth_mm),
            deformable_wall_s: wanted.wall_s,
            wall_s: found.wall_s,
        }
    }
}

impl CycleLeft {
    fn between(found: &[CycleRow], wanted: &[CycleRow]) -> Self {
        let distance = |joint: JointIndex| {
            let pairs = found.iter().zip(wanted);
            let squares = pairs
                .map(|(one, other)| joint.of(&one.positions) - joint.of(&other.positions))
                .map(|off| KNEE.joint(joint).kind().in_files(off).powi(2));
            (squares.sum::<f64>() / wanted.len() as f64).sqrt()
        };
        Self {
            peak_pressure: off_in_stance(found, wanted, |row| row.peak_pressure_mpa),
            contact_area: off_in_stance(found, wanted, |row| row.contact_area_mm2),
            ap_mm: distance(AP),
            ie_deg: distance(IE),
        }
    }
}

/// Rows of the first activity's first and last cycle.
fn first_and_last(march: &March) -> [&[CycleRow]; 2] {
    let cycles = march.state().activities[0].first_and_last.as_ref();
    let (first, last) = cycles.expect("a march that is done has solved cycles");
    [&first.rows, &last.rows]
}

/// Which rows of a cycle are of stance.
pub(super) fn is_stance(force_n: f64, highest_n: f64) -> bool {
    force_n >= STANCE * highest_n
}

fn off_in_stance(
    found: &[CycleRow],
    wanted: &[CycleRow],
    value: fn(&CycleRow) -> f64,
) -> OffInStance {
    let highest =
        |rows: &[CycleRow], value: fn(&CycleRow) -> f64| rows.iter().map(value).fold(0.0, f64::max);
    let highest_n = highest(wanted, |row| row.axial_force_n);
    let pairs = found.iter().zip(wanted);
    let stance = pairs.filter(|(_, wanted)| is_stance(wanted.axial_force_n, highest_n));
    let off: Vec<f64> = stance
        .map(|(found, wanted)| off_percent(value(found), value(wanted)))
        .collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    OffInStance {
        mean_percent: (squares / off.len() as f64).sqrt(),
        most_percent: off.iter().fold(0.0, |most, off| off.abs().max(most)),
        of_highest_percent: off_percent(highest(found, value), highest(wanted, value)),
    }
}

fn off_percent(found: f64, wanted: f64) -> f64 {
    100.0 * (found / wanted - 1.0)
}
