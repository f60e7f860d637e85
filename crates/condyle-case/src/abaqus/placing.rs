//! Where both bodies stand in the simulator's frame when the file begins.

use condyle::Vec3;
use condyle::evolve::{March, WearTest};
use condyle::machine::{Chain, MovedBody, knee};
use condyle::spatial::Pose;

use super::lift::lift;

/// Smallest gap at the start of an explicit analysis, mm.
const CLEARANCE_MM: f64 = 0.005;

/// The machine where the file begins.
pub(super) struct Placing {
    /// Positions of the six freedoms, mm and rad.
    pub positions: [f64; 6],
    /// The femur in the simulator's frame.
    pub femur: Pose,
    /// The femur in the insert's frame.
    femur_in_insert: Pose,
}

impl Placing {
    /// Where condyle finds the femur settled; with `apart`, lifted until nothing touches.
    pub fn new(march: &March, apart: bool) -> Self {
        let test = march.test();
        let chain = Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm);
        let mut positions = settled(march);
        if apart && test.machine().joint(knee::IS).is_loaded() {
            lift(CLEARANCE_MM, |way_mm| {
                positions[knee::IS.place()] += way_mm;
                let gaps = gaps_mm(test, &chain.at(&positions).pose);
                gaps.into_iter().fold(f64::INFINITY, f64::min)
            });
        }
        let mut of_femur = positions;
        for (position, joint) in of_femur.iter_mut().zip(&test.machine().joints) {
            if joint.description.moves == MovedBody::Insert {
                *position = 0.0;
            }
        }
        Self {
            positions,
            femur: chain.at(&of_femur).pose,
            femur_in_insert: chain.at(&positions).pose,
        }
    }

    /// A point of the insert's frame in the simulator's.
    ///
    /// Both know where the femur is, so the femur leads from one to the other.
    pub fn insert_point(&self, point: &Vec3) -> Vec3 {
        self.femur.to_insert(&self.femur_in_insert.to_femur(point))
    }

    /// Gap under the femur at every node of the articulating surface, mm.
    pub fn gaps_mm(&self, test: &WearTest) -> Vec<f64> {
        gaps_mm(test, &self.femur_in_insert)
    }
}

/// Positions after settling, and not yet where a cycle leads them.
fn settled(march: &March) -> [f64; 6] {
    let mut positions = march.state().activities[0].machine.now.positions;
    for (position, joint) in positions.iter_mut().zip(&march.test().machine().joints) {
        if joint.description.settles_at_zero() {
            *position = 0.0;
        }
    }
    positions
}

fn gaps_mm(test: &WearTest, femur: &Pose) -> Vec<f64> {
    let nodes = &test.insert.mesh().nodes;
    let gap = |&node: &u32| test.femur.gap_mm(&femur.to_femur(&nodes[node as usize]));
    test.insert.surface_nodes().iter().map(gap).collect()
}
