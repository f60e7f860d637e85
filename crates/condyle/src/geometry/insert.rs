//! The tibial insert: a hexahedral mesh, its articulating surface, and how it wears away.

use condyle_fem::{HexMesh, InteriorFollower, volume_below};
use thiserror::Error;

use super::{
    ArticulatingSurface, FacesAround, NodeBlock, node_blocks::node_blocks,
    thickness::thickness_at_nodes,
};
use crate::Vec3;

/// Why a mesh makes no insert.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum InsertError {
    /// No element or no articulating face.
    #[error("the insert has no {what}; name or give some")]
    Empty {
        /// What is missing.
        what: &'static str,
    },
    /// A hexahedron that is inverted or flat.
    #[error(
        "hexahedron {hex} of the insert is inverted or flat (scaled Jacobian {quality:.3}); mend the mesh or use a larger edge"
    )]
    BadElement {
        /// Which one, from 0.
        hex: usize,
        /// Its scaled Jacobian.
        quality: f64,
    },
    /// A node with no insert below it.
    #[error(
        "the backside lies zero_vector below the articulating surface at ({x:.2}, {y:.2}, {z:.2}) mm; check which surface is the backside"
    )]
    NoThickness {
        /// Place of the node, mm.
        x: f64,
        /// Place of the node, mm.
        y: f64,
        /// Place of the node, mm.
        z: f64,
    },
}

/// A tibial insert, unworn or worn.
pub struct Insert {
    mesh: HexMesh,
    unworn_nodes: Vec<Vec3>,
    /// Quads around the mesh, facing out.
    boundary: Vec<[u32; 4]>,
    /// Mesh nodes of the articulating surface, ascending; "surface node i" is `nodes[i]`.
    nodes: Vec<u32>,
    /// Faces of the articulating surface, in numbers of surface nodes.
    faces: Vec<[u32; 4]>,
    faces_around: FacesAround,
    node_blocks: Vec<NodeBlock>,
    unworn_thickness_mm: Vec<f64>,
    /// Depth worn so far: the thickness is computed from it anew, so that an insert worn step by
    /// step and one restored have the same to the last bit.
    worn_mm: Vec<f64>,
    thickness_mm: Vec<f64>,
    follower: InteriorFollower,
}

impl Insert {
    /// An insert from its mesh, the quads of its articulating surface facing out, and those of
    /// its backside.
    ///
    /// # Errors
    /// An empty mesh or surface, an inverted element, or a node without thickness below it.
    pub fn new(
        mesh: HexMesh,
        articulating: &[[u32; 4]],
        backside: &[[u32; 4]],
    ) -> Result<Self, InsertError> {
        for (count, what) in [
            (mesh.hexes.len(), "hexahedra"),
            (articulating.len(), "articulating surface"),
            (backside.len(), "backside"),
        ] {
            if count == 0 {
                return Err(InsertError::Empty { what });
            }
        }
        check_elements(&mesh)?;
        let (nodes, faces) = numbered(articulating);
        // Sides and backside stay where they are: wear takes away the articulating surface alone.
        let boundary = mesh.boundary_quads();
        let follower = InteriorFollower::new(&mesh, boundary.iter().flatten().copied());
        let positions: Vec<Vec3> = nodes
            .iter()
            .map(|&node| mesh.nodes[node as usize])
            .collect();
        let faces_around = FacesAround::new(nodes.len(), &faces);
        let surface = ArticulatingSurface::new(positions, &faces_around);
        let thickness_mm = thickness_at_nodes(&surface, &mesh, backside)?;
        Ok(Self {
            unworn_nodes: mesh.nodes.clone(),
            boundary,
            mesh,
            nodes,
            node_blocks: node_blocks(&faces, &faces_around),
            faces,
            faces_around,
            unworn_thickness_mm: thickness_mm.clone(),
            worn_mm: vec![0.0; thickness_mm.len()],
            thickness_mm,
            follower,
        })
    }

    /// The hexahedra.
    pub fn mesh(&self) -> &HexMesh {
        &self.mesh
    }

    /// Volume of the mesh as it is now, mm3: what its boundary encloses.
    pub fn volume_mm3(&self) -> f64 {
        // Near the mesh, so that the cones are small and few digits are lost.
        let origin = self.mesh.nodes[self.boundary[0][0] as usize];
        let corners = |quad: &[u32; 4]| quad.map(|node| self.mesh.nodes[node as usize] - origin);
        let quads = self.boundary.iter();
        quads.map(|quad| volume_below(&corners(quad))).sum()
    }

    /// Mesh nodes of the articulating surface, ascending; the order of every array a surface node.
    pub fn surface_nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Faces of the articulating surface, in numbers of surface nodes, facing out.
    pub fn surface_faces(&self) -> &[[u32; 4]] {
        &self.faces
    }

    /// The faces of the articulating surface around each of its nodes.
    pub fn faces_around(&self) -> &FacesAround {
        &self.faces_around
    }

    /// The surface nodes, four by four: each once, those of a four near one another.
    pub fn node_blocks(&self) -> &[NodeBlock] {
        &self.node_blocks
    }

    /// Thickness of the insert below each surface node along its normal, mm.
    pub fn thickness_mm(&self) -> &[f64] {
        &self.thickness_mm
    }

    /// The articulating surface as it is now.
    pub fn surface(&self) -> ArticulatingSurface {
        let positions: Vec<Vec3> = self
            .nodes
            .iter()
            .map(|&node| self.mesh.nodes[node as usize])
            .collect();
        ArticulatingSurface::new(positions, &self.faces_around)
    }

    /// Moves every surface node inwards along its normal, and the mesh below after it.
    ///
    /// `depth_mm`: one a surface node, 0 or more. The thickness shrinks by as much.
    pub fn wear_down(&mut self, surface: &ArticulatingSurface, depth_mm: &[f64]) {
        let mut displacement = self.as_before(surface, depth_mm);
        for (i, &node) in self.nodes.iter().enumerate() {
            displacement[node as usize] = -surface.normals[i] * depth_mm[i];
            self.worn_mm[i] += depth_mm[i];
            self.thickness_mm[i] = self.unworn_thickness_mm[i] - self.worn_mm[i];
        }
        self.follower.follow(&mut displacement);
        for (node, step) in self.mesh.nodes.iter_mut().zip(&displacement) {
            *node += step;
        }
    }

    /// How every mesh node moves if the mesh goes on as it has come so far, in proportion to the
    /// depth: nearly how it will, so that the inside is found in few iterations.
    fn as_before(&self, surface: &ArticulatingSurface, depth_mm: &[f64]) -> Vec<Vec3> {
        let moved = |node: usize| self.mesh.nodes[node] - self.unworn_nodes[node];
        let (mut along, mut whole) = (0.0, 0.0);
        for (i, &node) in self.nodes.iter().enumerate() {
            let so_far = moved(node as usize);
            along -= so_far.dot(&surface.normals[i]) * depth_mm[i];
            whole += so_far.norm_squared();
        }
        let share = if whole > 0.0 { along / whole } else { 0.0 };
        let nodes = 0..self.mesh.nodes.len();
        nodes.map(|node| moved(node) * share).collect()
    }

    /// Puts a worn insert back to a stored state: all mesh nodes, and the depth worn so far at
    /// each surface node.
    pub fn restore(&mut self, mesh_nodes: Vec<Vec3>, worn_mm: &[f64]) {
        self.mesh.nodes = mesh_nodes;
        self.worn_mm.copy_from_slice(worn_mm);
        for (i, worn) in worn_mm.iter().enumerate() {
            self.thickness_mm[i] = self.unworn_thickness_mm[i] - worn;
        }
    }

    /// The lowest point of the dishes, mm: the lowest surface node that none of its neighbours
    /// lies below, the rim left out.
    pub fn dish_low_point_mm(&self) -> Vec3 {
        let position = |i: usize| self.mesh.nodes[self.nodes[i] as usize];
        let mut is_low = vec![true; self.nodes.len()];
        let mut face_count = vec![0; self.nodes.len()];
        for face in &self.faces {
            let lowest = face
                .map(|i| position(i as usize).y)
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            for &i in face {
                face_count[i as usize] += 1;
                is_low[i as usize] &= position(i as usize).y <= lowest;
            }
        }
        let lower = |a: Vec3, b: Vec3| if b.y < a.y { b } else { a };
        let dishes = (0..self.nodes.len()).filter(|&i| is_low[i] && face_count[i] == 4);
        let anywhere = (0..self.nodes.len()).map(position).reduce(lower);
        dishes
            .map(position)
            .reduce(lower)
            .or(anywhere)
            .unwrap_or_default()
    }
}

fn check_elements(mesh: &HexMesh) -> Result<(), InsertError> {
    let mut qualities = mesh.qualities().enumerate();
    match qualities.find(|(_, quality)| *quality <= 0.0) {
        Some((hex, quality)) => Err(InsertError::BadElement { hex, quality }),
        None => Ok(()),
    }
}

/// The nodes of some quads, ascending, and the quads in their numbers.
fn numbered(quads: &[[u32; 4]]) -> (Vec<u32>, Vec<[u32; 4]>) {
    let mut nodes: Vec<u32> = quads.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let number = |node: u32| nodes.partition_point(|&other| other < node) as u32;
    let faces = quads.iter().map(|quad| quad.map(number)).collect();
    (nodes, faces)
}
