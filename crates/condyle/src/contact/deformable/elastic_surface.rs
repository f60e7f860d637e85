//! The compliance of an insert's surface by finite elements.

use std::{
    fmt,
    sync::{Arc, Mutex, PoisonError},
};

use condyle_fem::{Elastic, ElasticSolid, HalfSolved, HexMesh, SolidError};

use super::compliance::SurfaceCompliance;
use crate::{
    Vec3,
    geometry::{Insert, bounds},
};

/// So many nodes at most are solved for together: forces on nodes that are near load the same part of the factor.
const TILE_NODES: usize = 48;

/// The freedoms that feel a load, over the root of all: those on the cuts around it, which go through a plate of three
/// layers of nodes.
const FELT_PER_ROOT: f64 = 6.0;

/// The articulating surface of an elastic insert, bonded to its tray.
///
/// The stiffness is factored once; unit loads on a tile of nodes are solved half way when they are first asked for,
/// and kept.
pub(super) struct ElasticSurface {
    solid: ElasticSolid,
    /// Mesh nodes of the surface.
    nodes: Vec<u32>,
    /// Inward normals.
    directions: Vec<Vec3>,
    /// Surface nodes that lie together, and of every tile its loads.
    tiles: Vec<Vec<u32>>,
    loads: Mutex<Vec<Option<Arc<HalfSolved>>>>,
}

impl fmt::Debug for ElasticSurface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ElasticSurface")
            .field("surface_nodes", &self.nodes.len())
            .finish_non_exhaustive()
    }
}

impl ElasticSurface {
    /// The surface of an insert with its mesh nodes at `mesh_nodes`, mm.
    ///
    /// # Errors
    /// A material or a mesh that is no elastic solid.
    pub fn new(insert: &Insert, mesh_nodes: &[Vec3], elastic: Elastic) -> Result<Self, SolidError> {
        let mesh = HexMesh {
            nodes: mesh_nodes.to_vec(),
            hexes: insert.mesh().hexes.clone(),
        };
        let surface = insert.surface_at(mesh_nodes);
        let tiles = tiles(&surface.positions);
        let held = insert.backside_nodes().iter().copied();
        Ok(Self {
            solid: ElasticSolid::new(&mesh, elastic, held)?,
            nodes: insert.surface_nodes().to_vec(),
            loads: Mutex::new(vec![None; tiles.len()]),
            directions: surface.normals.iter().map(|normal| -normal).collect(),
            tiles,
        })
    }

    /// Bytes of the factor, and of the loads on so many nodes and the compliance between them.
    pub fn bytes(&self, nodes: f64) -> f64 {
        let factor = self.solid.factor_len() as f64;
        let felt = FELT_PER_ROOT * (3.0 * self.solid.mesh().nodes.len() as f64).sqrt();
        let nodes = nodes.min(self.nodes.len() as f64);
        8.0 * (factor + nodes * (nodes + felt))
    }

    /// Whether it is that of an insert with its mesh nodes there.
    pub fn is_of(&self, insert: &Insert, mesh_nodes: &[Vec3]) -> bool {
        let mesh = self.solid.mesh();
        mesh.hexes == insert.mesh().hexes
            && mesh.nodes == mesh_nodes
            && self.nodes == insert.surface_nodes()
    }

    /// Unit loads on a tile of nodes.
    fn loads(&self, tile: usize) -> Arc<HalfSolved> {
        let mut loads = self.loads.lock().unwrap_or_else(PoisonError::into_inner);
        let solved = loads[tile].get_or_insert_with(|| {
            let nodes = self.tiles[tile].iter().map(|&node| node as usize);
            let forces = nodes.map(|node| (self.nodes[node], self.directions[node]));
            Arc::new(self.solid.half_solved(&forces.collect::<Vec<_>>()))
        });
        Arc::clone(solved)
    }
}

impl SurfaceCompliance for ElasticSurface {
    fn tiles(&self) -> &[Vec<u32>] {
        &self.tiles
    }

    fn between(&self, one: usize, other: usize) -> Vec<f64> {
        self.loads(one).moved_along(&self.loads(other))
    }
}

/// Nodes shared out into tiles that lie together: the larger extent halved until few are left.
fn tiles(positions: &[Vec3]) -> Vec<Vec<u32>> {
    let mut open = vec![(0..positions.len() as u32).collect::<Vec<u32>>()];
    let mut tiles = Vec::new();
    while let Some(mut nodes) = open.pop() {
        if nodes.len() <= TILE_NODES {
            tiles.push(nodes);
        } else {
            let at = |node: &u32| positions[*node as usize];
            let (low, high) = bounds(nodes.iter().map(|node| &positions[*node as usize]));
            let axis = (high - low).imax();
            nodes.sort_by(|a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
            let second = nodes.split_off(nodes.len() / 2);
            open.extend([second, nodes]);
        }
    }
    tiles
}
