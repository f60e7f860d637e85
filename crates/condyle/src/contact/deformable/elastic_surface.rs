//! The compliance of an insert's surface by finite elements.

use std::{
    fmt,
    sync::{Arc, Mutex, PoisonError},
};

use condyle_fem::{Elastic, ElasticSolid, HexMesh, SolidError};

use super::compliance::{Column, SurfaceCompliance};
use crate::{Vec3, geometry::Insert};

/// So many nodes at most are solved for together: forces on nodes that are near load the same part of the factor.
const TILE_NODES: usize = 48;

/// The articulating surface of an elastic insert, bonded to its tray.
///
/// The stiffness is factored once; a column is solved for when it is first asked for, together with those of the
/// nodes around, and kept.
pub(super) struct ElasticSurface {
    solid: ElasticSolid,
    /// Mesh nodes of the surface.
    nodes: Vec<u32>,
    /// Inward normals.
    directions: Vec<Vec3>,
    /// Surface nodes that lie together, and of every node its tile.
    tiles: Vec<Vec<u32>>,
    tile_of: Vec<usize>,
    columns: Mutex<Vec<Option<Column>>>,
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
        let mut tile_of = vec![0; surface.positions.len()];
        for (number, tile) in tiles.iter().enumerate() {
            tile.iter()
                .for_each(|&node| tile_of[node as usize] = number);
        }
        let held = insert.backside_nodes().iter().copied();
        Ok(Self {
            solid: ElasticSolid::new(&mesh, elastic, held)?,
            nodes: insert.surface_nodes().to_vec(),
            columns: Mutex::new(vec![None; tile_of.len()]),
            directions: surface.normals.iter().map(|normal| -normal).collect(),
            tiles,
            tile_of,
        })
    }

    /// Bytes of the factor, and of so many columns.
    pub fn bytes(&self, columns: f64) -> f64 {
        let surface_nodes = self.nodes.len() as f64;
        8.0 * (self.solid.factor_len() as f64 + surface_nodes * columns.min(surface_nodes))
    }

    /// Whether it is that of an insert with its mesh nodes there.
    pub fn is_of(&self, insert: &Insert, mesh_nodes: &[Vec3]) -> bool {
        let mesh = self.solid.mesh();
        mesh.hexes == insert.mesh().hexes
            && mesh.nodes == mesh_nodes
            && self.nodes == insert.surface_nodes()
    }
}

impl ElasticSurface {
    /// Columns of surface nodes.
    fn solved(&self, nodes: &[u32]) -> Vec<Column> {
        let force = |&node: &u32| (self.nodes[node as usize], self.directions[node as usize]);
        let forces: Vec<(u32, Vec3)> = nodes.iter().map(force).collect();
        let moved = self.solid.influence(&self.nodes, &forces);
        let column = |force: usize| {
            let directions = self.directions.iter().enumerate();
            let deflection =
                |(node, direction): (usize, &Vec3)| direction.dot(&moved.displacement(node, force));
            Column::from_iter(directions.map(deflection))
        };
        (0..nodes.len()).map(column).collect()
    }
}

impl SurfaceCompliance for ElasticSurface {
    fn columns(&self, nodes: &[u32]) -> Vec<(u32, Column)> {
        let mut tiles: Vec<usize> = nodes
            .iter()
            .map(|&node| self.tile_of[node as usize])
            .collect();
        tiles.sort_unstable();
        tiles.dedup();
        let wanted = || tiles.iter().flat_map(|&tile| &self.tiles[tile]).copied();
        let mut columns = self.columns.lock().unwrap_or_else(PoisonError::into_inner);
        let new: Vec<u32> = wanted()
            .filter(|&node| columns[node as usize].is_none())
            .collect();
        for (node, column) in new.iter().zip(self.solved(&new)) {
            columns[*node as usize] = Some(column);
        }
        let known = |node| Some((node, Arc::clone(columns[node as usize].as_ref()?)));
        wanted().filter_map(known).collect()
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
            let low = nodes
                .iter()
                .map(at)
                .fold(Vec3::repeat(f64::INFINITY), |a, b| a.inf(&b));
            let high = nodes
                .iter()
                .map(at)
                .fold(Vec3::repeat(f64::NEG_INFINITY), |a, b| a.sup(&b));
            let axis = (high - low).imax();
            nodes.sort_by(|a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
            let second = nodes.split_off(nodes.len() / 2);
            open.extend([second, nodes]);
        }
    }
    tiles
}
