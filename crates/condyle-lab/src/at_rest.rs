//! The settled femur on the insert: its position and its contact.

use condyle::{
    Vec3,
    contact::{ContactMemory, TouchedNode},
    evolve::March,
    geometry::Dishes,
    machine::{
        Chain, JointIndex,
        knee::{FLEXION, KNEE, MEDIAL, VV},
    },
    spatial::{Pose, RelativeMotion},
};
use serde::Serialize;

/// The settled femur on the insert, in the insert frame of a right knee.
#[derive(Debug, Serialize)]
pub struct AtRest {
    /// The middle of the flexion axis: anterior, superior and lateral of the insert's origin, mm.
    pub flexion_axis_mm: [f64; 3],
    /// Flexion at the start of the cycle, degrees; only of a knee.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flexion_deg: Option<f64>,
    /// Varus of the insert, degrees; only of a knee.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vv_deg: Option<f64>,
    /// Load that the contact carries, N.
    pub axial_force_n: f64,
    /// Part of it on the medial side; only of a knee.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub medial_load_share: Option<f64>,
    /// Area in contact, mm2.
    pub contact_area_mm2: f64,
    /// Highest pressure, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest distance between the triangles of the femur and its smooth surface in contact, mm.
    pub femur_deviation_mm: f64,
    #[serde(skip)]
    pub(crate) pose: Pose,
    #[serde(skip)]
    pub(crate) touched: Vec<TouchedNode>,
    /// Nodes within [`NEAR_MM`] of the femur.
    #[serde(skip)]
    pub(crate) nodes_near: usize,
}

/// Share of the load on the eminence beyond which a femur stands there; sound knees have none.
const MAX_ON_EMINENCE: f64 = 0.05;

/// Distance at rest below which nodes approximately touch under the loads of a cycle, mm.
const NEAR_MM: f64 = 0.25;

impl AtRest {
    /// Returns a warning if the femur of a knee stands on the eminence between the dishes.
    pub(crate) fn beside_dishes(&self, march: &March) -> Option<String> {
        let test = march.test();
        if *test.machine().mechanism != KNEE {
            return None;
        }
        let places = test.insert.surface().positions;
        let dishes = Dishes::find(&places)?;
        let is_between = |node: &&TouchedNode| dishes.is_on_eminence(&places[node.node as usize]);
        let load = |node: &TouchedNode| -node.force_n.y;
        let between: f64 = self.touched.iter().filter(is_between).map(load).sum();
        let share = between / self.axial_force_n;
        (share > MAX_ON_EMINENCE).then(|| {
            format!(
                "at rest {:.0} % of the load is on the eminence between the dishes: the femur does not lie in them; check that \
                 both bodies are of one implant, their length_unit, axes and start_mm",
                100.0 * share
            )
        })
    }

    /// Evaluates the settled bodies of a march that has not begun.
    pub(crate) fn of(march: &March) -> Self {
        let test = march.test();
        // The positions after settling, before any cycle.
        let mut positions = march.state().activities[0].machine.now.positions;
        for (position, joint) in positions.iter_mut().zip(&test.machine().joints) {
            if joint.description.settles_at_zero() {
                *position = 0.0;
            }
        }
        let chain = Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm);
        let motion = RelativeMotion::at_rest(chain.at(&positions).pose);
        let surface = march.surface();
        let bodies = march.bodies(&surface);
        let mut contact = test.contact.contact(bodies, ContactMemory::default());
        // The response settles the contact; the evaluation after it reads its pressures.
        contact.respond(&motion);
        let result = contact.evaluate(&motion);
        let sum = |value: fn(&TouchedNode) -> f64| result.touched.iter().map(value).sum::<f64>();
        let axial_force_n = sum(|node| -node.force_n.y);
        let medial_n = sum(|node| match usize::from(node.region) {
            MEDIAL => -node.force_n.y,
            _ => 0.0,
        });
        let femur = march.counterface();
        let is_near = |place: &&Vec3| femur.gap_mm(&motion.pose.to_counterface(place)) < NEAR_MM;
        let (x, y) = test.flexion_axis_mm;
        let is_knee = *test.machine().mechanism == KNEE;
        let in_files = |joint: JointIndex| {
            is_knee.then(|| KNEE.joint(joint).kind().in_files(joint.of(&positions)))
        };
        Self {
            flexion_axis_mm: motion.pose.to_insert(&Vec3::new(x, y, 0.0)).into(),
            flexion_deg: in_files(FLEXION),
            vv_deg: in_files(VV),
            axial_force_n,
            medial_load_share: is_knee.then(|| medial_n / axial_force_n),
            contact_area_mm2: sum(|node| node.covered_mm2),
            peak_pressure_mpa: result.peak_pressure_mpa,
            femur_deviation_mm: result.touched.iter().fold(0.0, |largest, node| {
                let place = motion
                    .pose
                    .to_counterface(&surface.positions[node.node as usize]);
                femur.deviation_mm(&place).max(largest)
            }),
            pose: motion.pose,
            nodes_near: surface.positions.iter().filter(is_near).count(),
            touched: result.touched,
        }
    }
}
