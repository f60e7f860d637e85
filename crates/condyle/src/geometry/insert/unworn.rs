//! What of an insert stays as it was made, however it wears.

use condyle_fem::{HexMesh, InteriorFollower};

use super::{error::InsertError, thickness::thickness_at_nodes};
use crate::{
    Vec3,
    geometry::{
        articulating_surface::ArticulatingSurface,
        faces_around::FacesAround,
        node_blocks::{NodeBlock, node_blocks},
    },
};

/// An insert as it was made: how its nodes hang together, where they were and how thick it was.
pub struct UnwornInsert {
    /// Positions of all mesh nodes, mm.
    pub nodes: Vec<Vec3>,
    /// Quads around the mesh, facing out.
    pub boundary: Vec<[u32; 4]>,
    /// Mesh nodes of the articulating surface, ascending; "surface node i" is `surface_nodes[i]`.
    pub surface_nodes: Vec<u32>,
    /// Mesh nodes of the backside, ascending.
    pub backside_nodes: Vec<u32>,
    /// Faces of the articulating surface, in numbers of surface nodes.
    pub faces: Vec<[u32; 4]>,
    pub faces_around: FacesAround,
    pub node_blocks: Vec<NodeBlock>,
    /// Area of each surface node's share, mm2.
    pub share_mm2: Vec<f64>,
    /// Thickness below each surface node, mm.
    pub thickness_mm: Vec<f64>,
    /// Of each surface node on the rim the unit direction, upwards, in which the side wall below ends there.
    pub walls: Vec<Option<Vec3>>,
    pub follower: InteriorFollower,
}

impl UnwornInsert {
    /// See [`Insert::new`](super::Insert::new).
    pub fn new(
        mesh: &HexMesh,
        articulating: &[[u32; 4]],
        backside: &[[u32; 4]],
    ) -> Result<Self, InsertError> {
        check_parts(mesh, articulating, backside)?;
        check_elements(mesh)?;
        let (surface_nodes, faces) = numbered(articulating);
        // Sides and backside stay where they are: wear takes away the articulating surface alone.
        let boundary = mesh.boundary_quads();
        let follower = InteriorFollower::new(mesh, boundary.iter().flatten().copied());
        let faces_around = FacesAround::new(surface_nodes.len(), &faces);
        let positions = mesh.positions(&surface_nodes).collect();
        let surface = ArticulatingSurface::new(positions, &faces_around);
        Ok(Self {
            share_mm2: surface.shares.iter().map(|share| share.area_mm2).collect(),
            thickness_mm: thickness_at_nodes(&surface, mesh, backside)?,
            walls: walls(mesh, &boundary, &surface_nodes),
            node_blocks: node_blocks(&faces, &faces_around),
            nodes: mesh.nodes.clone(),
            boundary,
            surface_nodes,
            backside_nodes: numbered(backside).0,
            faces,
            faces_around,
            follower,
        })
    }

    /// Positions of the surface's nodes, mm.
    pub fn surface_positions(&self) -> impl Iterator<Item = Vec3> {
        let nodes = self.surface_nodes.iter();
        nodes.map(|&node| self.nodes[node as usize])
    }
}

/// Where the edge of the boundary that leads away from the articulating surface comes from, if a node has one alone.
fn walls(mesh: &HexMesh, boundary: &[[u32; 4]], surface_nodes: &[u32]) -> Vec<Option<Vec3>> {
    let number = |node: u32| surface_nodes.binary_search(&node).ok();
    let mut below: Vec<Vec<u32>> = vec![Vec::new(); surface_nodes.len()];
    for quad in boundary {
        for side in 0..4 {
            let ends = [quad[side], quad[(side + 1) % 4]];
            for [here, there] in [ends, [ends[1], ends[0]]] {
                if let (Some(here), None) = (number(here), number(there)) {
                    below[here].push(there);
                }
            }
        }
    }
    let direction = |(here, mut below): (usize, Vec<u32>)| {
        below.sort_unstable();
        below.dedup();
        let place = |node: u32| mesh.nodes[node as usize];
        match below[..] {
            [only] => (place(surface_nodes[here]) - place(only)).try_normalize(0.0),
            _ => None,
        }
    };
    below.into_iter().enumerate().map(direction).collect()
}

fn check_parts(
    mesh: &HexMesh,
    articulating: &[[u32; 4]],
    backside: &[[u32; 4]],
) -> Result<(), InsertError> {
    let parts = [
        (mesh.hexes.len(), "hexahedra"),
        (articulating.len(), "articulating surface"),
        (backside.len(), "backside"),
    ];
    match parts.into_iter().find(|(count, _)| *count == 0) {
        Some((_, what)) => Err(InsertError::Empty { what }),
        None => Ok(()),
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
