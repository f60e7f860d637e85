//! All that the file tells of, in the simulator's frame: x anterior, y superior, z lateral.

use condyle::Vec3;
use condyle::evolve::{March, WearTest};
use condyle::geometry::{Insert, TriangleMesh};
use condyle::machine::{JointIndex, knee};
use condyle_fem::HexMesh;

use super::error::ExportError;
use super::options::AbaqusOptions;
use super::placing::Placing;
use crate::case::{Case, FEMUR_TRIANGLES};

/// The model that is written.
pub(super) struct Model<'a> {
    pub case: &'a Case,
    pub test: &'a WearTest,
    pub options: AbaqusOptions,
    pub placing: Placing,
    /// Positions of the freedoms where a cycle begins, mm and rad.
    pub cycle_start: [f64; 6],
    pub insert: HexMesh,
    pub femur: TriangleMesh,
    pub labels: Labels,
}

/// The first label of every block, and the machine's nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Labels {
    pub insert_node: u32,
    pub femur_node: u32,
    pub femur_ref: u32,
    pub carriage: u32,
    /// On the VV axis, on the carriage.
    pub hinge: u32,
    /// On the VV axis, on the insert.
    pub insert_ref: u32,
    /// The first of the nodes that springs hold.
    pub spring: u32,
    pub hexahedron: u32,
    pub triangle: u32,
    /// The first of the machine's elements.
    pub machine: u32,
}

impl<'a> Model<'a> {
    pub fn new(
        case: &'a Case,
        march: &'a March,
        options: AbaqusOptions,
    ) -> Result<Self, ExportError> {
        let test = march.test();
        let placing = Placing::new(march, options.explicit);
        let mut insert = test.insert.mesh().clone();
        insert
            .nodes
            .iter_mut()
            .for_each(|node| *node = placing.insert_point(node));
        let femur = case
            .femur_triangles(test, FEMUR_TRIANGLES)?
            .mapped(|vertex| placing.femur.to_insert(vertex));
        let labels = Labels::new(&insert, &femur);
        Ok(Self {
            case,
            test,
            options,
            placing,
            cycle_start: march.state().activities[0].machine.now.positions,
            insert,
            femur,
            labels,
        })
    }

    /// Where the flexion axis passes z = 0 of the femoral frame.
    pub fn flexion_centre(&self) -> Vec3 {
        let (x, y) = self.test.flexion_axis_mm;
        self.placing.femur.to_insert(&Vec3::new(x, y, 0.0))
    }

    /// A point of the IE axis, at the height of the VV axis.
    pub fn ie_centre(&self) -> Vec3 {
        let (ie, vv) = (self.axis_point(knee::IE), self.axis_point(knee::VV));
        Vec3::new(ie.x, vv.y, ie.z)
    }

    /// A point of the VV axis, beside the IE axis.
    pub fn vv_centre(&self) -> Vec3 {
        let (ie, vv) = (self.axis_point(knee::IE), self.axis_point(knee::VV));
        Vec3::new(ie.x, vv.y, vv.z)
    }

    fn axis_point(&self, joint: JointIndex) -> Vec3 {
        self.test.machine().joint(joint).axis_point_mm
    }

    /// Length of a cycle, s.
    pub fn cycle_s(&self) -> f64 {
        1.0 / self.test.machine().frequency_hz
    }

    /// Length of one of condyle's increments, s.
    pub fn increment_s(&self) -> f64 {
        self.cycle_s() / self.test.time.increments as f64
    }
}

impl Labels {
    fn new(insert: &HexMesh, femur: &TriangleMesh) -> Self {
        let femur_node = after(1, insert.nodes.len());
        let machine_node = after(femur_node, femur.vertices.len());
        let triangle = after(1, insert.hexes.len());
        Self {
            insert_node: 1,
            femur_node,
            femur_ref: machine_node,
            carriage: machine_node + 1,
            hinge: machine_node + 2,
            insert_ref: machine_node + 3,
            spring: machine_node + 4,
            hexahedron: 1,
            triangle,
            machine: after(triangle, femur.triangles.len()),
        }
    }
}

/// A round label behind `count` labels from `first`.
pub(super) fn after(first: u32, count: usize) -> u32 {
    const ROUND: u32 = 100_000;
    (first + count as u32).div_ceil(ROUND) * ROUND + 1
}

/// Quads of the articulating surface in numbers of mesh nodes.
pub(super) fn in_mesh(insert: &Insert) -> Vec<[u32; 4]> {
    let in_mesh = |face: &[u32; 4]| face.map(|i| insert.surface_nodes()[i as usize]);
    insert.surface_faces().iter().map(in_mesh).collect()
}
