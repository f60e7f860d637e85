//! What the moving picture of a run shows: bodies, updates, and the cycles on the way.
//!
//! A [`Scene`] is made of a results folder, or of a march in memory; [`Scene::to_bytes`] is what the page's
//! programs read, the same from both.

mod arrays;
mod coarse;
mod encode;
mod read;

use condyle_fem::{HexMesh, Vec3};
use condyle_results::NeutralPose;

use crate::results::{surface_of_mesh::Articulating, table::Table};

/// What the moving picture of a run shows; what is not there is left out and told in `missing`.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    insert: Option<SceneInsert>,
    updates: Vec<SceneUpdate>,
    /// The femur in the insert frame at neutral.
    pub femur: Option<SceneBody>,
    /// Where the femur is at neutral.
    pub neutral_pose: Option<NeutralPose>,
    /// The cycles whose motion is kept.
    pub cycles: Vec<SceneCycle>,
    /// Tables by name, for the plots.
    pub tables: Vec<(&'static str, Table)>,
    /// What could not be read, and why.
    pub missing: Vec<String>,
}

/// Triangles of a body.
#[derive(Clone, Debug, Default)]
pub struct SceneBody {
    /// Where its nodes are, mm.
    pub nodes: Vec<Vec3>,
    /// Nodes of each triangle, from 0.
    pub triangles: Vec<[u32; 3]>,
}

/// The insert: which nodes of its mesh articulate, and the rest of its skin.
#[derive(Clone, Debug)]
struct SceneInsert {
    articulating: Articulating,
    nodes_of_mesh: usize,
    skin: SceneBody,
}

/// The articulating surface after an update.
#[derive(Clone, Debug)]
struct SceneUpdate {
    cycles: f64,
    nodes: Vec<Vec3>,
    fields: Vec<(String, Vec<f64>)>,
}

/// The motion of a cycle, and where it presses.
#[derive(Clone, Debug, Default)]
pub struct SceneCycle {
    /// "first" or "last".
    pub name: &'static str,
    /// Gait cycles before it.
    pub cycles: f64,
    /// Percent of the cycle at each increment.
    pub percents: Vec<f64>,
    /// The origin of the femoral frame in the insert frame, mm, then the rotation row by row, at each increment.
    pub poses: Vec<[f64; 12]>,
    /// Nodes of the insert's mesh under pressure, and the pressure, MPa, at each increment.
    pub pressures: Vec<Vec<(u32, f64)>>,
}

impl Scene {
    /// A scene of an unworn insert; none where no face of it has nodes that are all marked 1.
    pub fn of_insert(mesh: &HexMesh, articulating: &[f64]) -> Option<Self> {
        let articulating = Articulating::of(mesh, articulating)?;
        let insert = SceneInsert {
            skin: skin(mesh, &articulating),
            nodes_of_mesh: mesh.nodes.len(),
            articulating,
        };
        Some(Self {
            insert: Some(insert),
            ..Self::default()
        })
    }

    /// Adds the insert after an update, with its fields at the nodes of its mesh. Says whether the mesh is one of
    /// the same nodes; of another nothing is added.
    pub fn add_update<'a>(
        &mut self,
        cycles: f64,
        nodes: &[Vec3],
        fields: impl IntoIterator<Item = (&'a str, &'a [f64])>,
    ) -> bool {
        let Some(insert) = &self.insert else {
            return false;
        };
        let kept = &insert.articulating.nodes;
        let fields: Vec<_> = fields.into_iter().collect();
        let fits = |values: &&[f64]| values.len() == insert.nodes_of_mesh;
        if nodes.len() != insert.nodes_of_mesh || !fields.iter().all(|(_, values)| fits(values)) {
            return false;
        }
        let pick = |values: &[f64]| kept.iter().map(|&node| values[node as usize]).collect();
        self.updates.push(SceneUpdate {
            cycles,
            nodes: kept.iter().map(|&node| nodes[node as usize]).collect(),
            fields: fields
                .into_iter()
                .map(|(name, values)| (name.to_owned(), pick(values)))
                .collect(),
        });
        true
    }

    /// Whether there is something to show in three dimensions.
    pub fn has_surface(&self) -> bool {
        !self.updates.is_empty()
    }
}

/// The skin of a mesh but its articulating surface, as triangles.
fn skin(mesh: &HexMesh, articulating: &Articulating) -> SceneBody {
    let mut is_articulating = vec![false; mesh.nodes.len()];
    for &node in &articulating.nodes {
        is_articulating[node as usize] = true;
    }
    let rest = mesh.boundary_quads().into_iter();
    let rest = rest.filter(|quad| !quad.iter().all(|&node| is_articulating[node as usize]));
    let mut place = vec![None; mesh.nodes.len()];
    let mut skin = SceneBody::default();
    for quad in rest {
        let [a, b, c, d] = quad.map(|node| {
            *place[node as usize].get_or_insert_with(|| {
                skin.nodes.push(mesh.nodes[node as usize]);
                skin.nodes.len() as u32 - 1
            })
        });
        skin.triangles.extend([[a, b, c], [a, c, d]]);
    }
    skin
}
