//! The influence of surface loads and plastic strains inside an insert.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, OnceLock, PoisonError},
};

use condyle_fem::{ElasticSolid, HexMesh, YieldingElement};

use crate::{
    Vec3,
    contact::deformable::{
        cholesky::product,
        compliance::{SurfaceCompliance, UnitLoads, tiles},
    },
};

/// Largest number of mesh nodes in a tile. Plastic strains spread over few elements, so tiles are small.
const TILE_NODES: usize = 8;

/// The influence of loads on the surface and plastic strains below it inside an insert.
///
/// Everything is computed when it is first needed, and kept; it does not depend on what was computed before.
pub(crate) struct Influence {
    /// The displacements of all mesh nodes, in the order of `nodes`, by a unit load on each node of the surface, mm/N. Single
    /// precision is enough to look for yield.
    pub by_surface: Vec<OnceLock<Vec<f32>>>,
    /// The mesh nodes below one tile of the surface after the other, so that those below a contact are side by side in memory.
    pub nodes: Vec<u32>,
    /// Tiles of mesh nodes, and for every node its tile and its place in the tile.
    node_tiles: Vec<Vec<u32>>,
    place_of: Vec<(u32, u32)>,
    /// Unit forces on the mesh nodes, three for each, in the same tiles.
    forces: UnitLoads,
    blocks: Mutex<Blocks>,
    elements: Vec<OnceLock<Box<YieldingElement>>>,
    /// For every node of the surface, the elements to which it is nearest.
    pub stacks: Vec<Vec<u32>>,
}

/// The displacements of one tile of nodes by unit forces on another, by both tiles.
type Blocks = BTreeMap<(u32, u32), Arc<[f64]>>;

/// Forces on mesh nodes, or displacements of these, by the tiles of the nodes.
pub(crate) type ByTile = BTreeMap<u32, Vec<f64>>;

impl Influence {
    /// Prepares the influence in a solid whose surface has nodes at `surface`, in tiles.
    pub fn new(solid: &Arc<ElasticSolid>, surface: &[Vec3], surface_tiles: &[Vec<u32>]) -> Self {
        let (mesh, stacks) = (solid.mesh(), stacks(solid, surface));
        let below = nodes_below(surface_tiles, &stacks, mesh);
        let node_tiles = tiles(&mesh.nodes, TILE_NODES);
        let mut place_of = vec![(0, 0); mesh.nodes.len()];
        for (number, tile) in node_tiles.iter().enumerate() {
            for (place, &node) in tile.iter().enumerate() {
                place_of[node as usize] = (number as u32, place as u32);
            }
        }
        let nodes = 0..mesh.nodes.len() as u32;
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let forces = nodes.flat_map(|node| axes.map(|axis| (node, axis)));
        let numbers = |tile: &Vec<u32>| {
            let nodes = tile.iter();
            nodes
                .flat_map(|node| [3 * node, 3 * node + 1, 3 * node + 2])
                .collect()
        };
        let tiles = node_tiles.iter().map(numbers).collect();
        Self {
            by_surface: empty(surface.len()),
            forces: UnitLoads::new(Arc::clone(solid), forces.collect(), tiles),
            blocks: Mutex::default(),
            elements: empty(mesh.hexes.len()),
            stacks,
            nodes: below,
            node_tiles,
            place_of,
        }
    }

    /// Returns an element with its own stiffness.
    pub fn element(&self, solid: &ElasticSolid, element: u32) -> &YieldingElement {
        let element = element as usize;
        self.elements[element].get_or_init(|| Box::new(solid.yielding_element(element)))
    }

    pub fn add_force(&self, forces: &mut ByTile, node: u32, force: &Vec3) {
        let (tile, place) = self.place_of[node as usize];
        let forces = forces
            .entry(tile)
            .or_insert_with(|| vec![0.0; 3 * self.node_tiles[tile as usize].len()]);
        for (axis, force) in force.iter().enumerate() {
            forces[3 * place as usize + axis] += force;
        }
    }

    /// Returns the displacements of the nodes of some tiles by forces on mesh nodes.
    pub fn moved(&self, forces: &ByTile, tiles: &[u32]) -> ByTile {
        let moved = tiles.iter().map(|&tile| {
            let mut moved = vec![0.0; 3 * self.node_tiles[tile as usize].len()];
            for (&other, forces) in forces {
                let block = self.block(tile, other);
                let rows = moved.iter_mut().zip(block.chunks_exact(forces.len()));
                for (moved, row) in rows {
                    *moved += product(row, forces);
                }
            }
            (tile, moved)
        });
        moved.collect()
    }

    /// Returns the force or the displacement of a mesh node; zero if its tile has none.
    pub fn of_node(&self, values: &ByTile, node: u32) -> Vec3 {
        let (tile, place) = self.place_of[node as usize];
        let values = values.get(&tile);
        values.map_or_else(Vec3::zeros, |values| {
            Vec3::from_column_slice(&values[3 * place as usize..][..3])
        })
    }

    pub fn tile_of(&self, node: u32) -> u32 {
        self.place_of[node as usize].0
    }

    /// Returns the displacements of the nodes of a tile by unit forces on another: a row for every axis of every node.
    fn block(&self, tile: u32, other: u32) -> Arc<[f64]> {
        let lock = || self.blocks.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(block) = lock().get(&(tile, other)) {
            return Arc::clone(block);
        }
        // Computed without the lock: another thread may compute the same block, to the same bytes.
        let block: Arc<[f64]> = self.forces.between(tile as usize, other as usize).into();
        lock().insert((tile, other), Arc::clone(&block));
        block
    }
}

fn empty<T>(count: usize) -> Vec<OnceLock<T>> {
    (0..count).map(|_| OnceLock::new()).collect()
}

/// Returns all mesh nodes, those of the elements below one tile of the surface after the other.
fn nodes_below(surface_tiles: &[Vec<u32>], stacks: &[Vec<u32>], mesh: &HexMesh) -> Vec<u32> {
    let elements = surface_tiles.iter().flatten();
    let elements = elements.flat_map(|&node| &stacks[node as usize]);
    let below = elements.flat_map(|&element| mesh.hexes[element as usize]);
    // Nodes of no element come last.
    let all = below.chain(0..mesh.nodes.len() as u32);
    let mut is_listed = vec![false; mesh.nodes.len()];
    all.filter(|&node| !std::mem::replace(&mut is_listed[node as usize], true))
        .collect()
}

/// Returns for every node of a surface the elements to which it is nearest.
fn stacks(solid: &ElasticSolid, surface: &[Vec3]) -> Vec<Vec<u32>> {
    let mut stacks = vec![Vec::new(); surface.len()];
    let mesh = solid.mesh();
    for element in 0..mesh.hexes.len() {
        let centre = mesh.corners(element).iter().sum::<Vec3>() / 8.0;
        let apart = |node: &usize| (surface[*node] - centre).norm_squared();
        let nearest = (0..surface.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        if let Some(nearest) = nearest {
            stacks[nearest].push(element as u32);
        }
    }
    stacks
}
