//! The scene of a run, which the page shows in 3-D: bodies, updates, cycles and charts.
//!
//! [`Scene::read`] makes it from a results folder; [`Scene::to_bytes`] encodes it for the page's programs.

mod encode;
mod read;

use condyle_fem::HexMesh;
use condyle_mesh::{TriangleMesh, Vec3, formats::VtuFile};
use condyle_results::{Directions, NeutralPose};

use crate::figure::Panel;
use crate::results::Articulating;

/// The scene of a run; parts that are not there are omitted and listed in `missing`.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    insert: Option<SceneInsert>,
    updates: Vec<SceneUpdate>,
    charts: Vec<Panel>,
    /// The names of its directions.
    directions: Directions,
    /// The title of the case.
    title: String,
    /// The femur in the insert frame at neutral.
    femur: Option<TriangleMesh>,
    /// The pose of the femur at neutral.
    neutral_pose: Option<NeutralPose>,
    /// The cycles with stored motion.
    pub cycles: Vec<SceneCycle>,
    /// The files that could not be read, with reasons.
    pub missing: Vec<String>,
}

/// The insert: its articulating surface and the rest of its skin.
#[derive(Clone, Debug)]
struct SceneInsert {
    articulating: Articulating,
    nodes_of_mesh: usize,
    skin: TriangleMesh,
}

#[derive(Clone, Debug)]
struct SceneUpdate {
    cycles: f64,
    nodes: Vec<Vec3>,
    fields: Vec<(String, Vec<f64>)>,
}

/// The motion and the pressures of a cycle.
#[derive(Clone, Debug, Default)]
pub struct SceneCycle {
    /// "first" or "last".
    pub name: &'static str,
    /// Cycles before it.
    pub cycles: f64,
    /// Percent of the cycle at each increment.
    pub percents: Vec<f64>,
    /// The origin of the femoral frame in the insert frame, mm, then the rotation row by row, at each increment.
    pub poses: Vec<[f64; 12]>,
    /// Nodes of the insert's mesh under pressure, and the pressure, MPa, at each increment.
    pub pressures: Vec<Vec<(u32, f64)>>,
}

impl SceneInsert {
    /// Makes the insert from its unworn mesh; none if no face has nodes that are all marked 1.
    fn new(mesh: &HexMesh, articulating: &[f64]) -> Option<Self> {
        let articulating = Articulating::of(mesh, articulating)?;
        Some(Self {
            skin: skin(mesh, &articulating),
            nodes_of_mesh: mesh.nodes.len(),
            articulating,
        })
    }

    /// Returns the surface after an update, with fields at the nodes of its mesh; none if the mesh has other nodes than
    /// the insert.
    fn update(&self, cycles: f64, file: &VtuFile) -> Option<SceneUpdate> {
        let (count, surface) = (self.nodes_of_mesh, &self.articulating);
        let fields = &file.point_data;
        let fits = fields.iter().all(|(_, values)| values.len() == count);
        (file.mesh.nodes.len() == count && fits).then(|| SceneUpdate {
            cycles,
            nodes: surface.pick(&file.mesh.nodes),
            fields: fields
                .iter()
                .map(|field| surface.pick_field(field))
                .collect(),
        })
    }
}

impl Scene {
    /// Returns whether there is a surface to show in 3-D.
    pub fn has_surface(&self) -> bool {
        !self.updates.is_empty()
    }

    pub(crate) fn is_empty(&self) -> bool {
        !self.has_surface() && self.charts.is_empty()
    }
}

/// Returns the skin of a mesh without its articulating surface, as triangles.
fn skin(mesh: &HexMesh, articulating: &Articulating) -> TriangleMesh {
    let mut is_articulating = vec![false; mesh.nodes.len()];
    for &node in &articulating.nodes {
        is_articulating[node as usize] = true;
    }
    let rest = mesh.boundary_quads().into_iter();
    let rest = rest.filter(|quad| !quad.iter().all(|&node| is_articulating[node as usize]));
    let mut place = vec![None; mesh.nodes.len()];
    let mut skin = TriangleMesh::default();
    for quad in rest {
        let [a, b, c, d] = quad.map(|node| {
            *place[node as usize].get_or_insert_with(|| {
                skin.vertices.push(mesh.nodes[node as usize]);
                skin.vertices.len() as u32 - 1
            })
        });
        skin.triangles.extend([[a, b, c], [a, c, d]]);
    }
    skin
}
