//! What loads on the surface and plastic strains below it move inside an insert.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, OnceLock, PoisonError},
};

use condyle_fem::{ElasticSolid, ElementMean, HalfSolved, YieldingElement};

use crate::{Vec3, contact::deformable::compliance::tiles};

/// So many mesh nodes at most are solved for together.
const TILE_NODES: usize = 8;

/// What loads on the surface and plastic strains below it move inside an insert: computed when it is first asked
/// for, and kept. It depends on nothing that was asked before.
pub(crate) struct Influence {
    /// Of every tile of the surface what unit loads on its nodes move all mesh nodes by, mm/N: a row for every axis of
    /// every mesh node. Seven digits are enough where yield is looked for.
    by_surface: Vec<OnceLock<Box<[f32]>>>,
    /// Mesh nodes that lie together, and of every node its tile and its place there.
    node_tiles: Vec<Vec<u32>>,
    place_of: Vec<(u32, u32)>,
    half_solved: Vec<OnceLock<HalfSolved>>,
    blocks: Mutex<Blocks>,
    elements: Vec<OnceLock<Box<YieldingElement>>>,
    /// What makes the mean stress of every element.
    pub means: Vec<ElementMean>,
    /// Of every node of the surface the elements that it is nearest to.
    pub stacks: Vec<Vec<u32>>,
}

/// What unit forces on the nodes of a tile move those of another by, by both tiles.
type Blocks = BTreeMap<(u32, u32), Arc<[f64]>>;

/// Forces on mesh nodes, or displacements of these, by the tiles of the nodes.
pub(crate) type ByTile = BTreeMap<u32, Vec<f64>>;

impl Influence {
    /// Nothing is known of a solid whose surface has nodes there, in so many tiles.
    pub fn new(solid: &ElasticSolid, surface: &[Vec3], surface_tiles: usize) -> Self {
        let mesh = solid.mesh();
        let node_tiles = tiles(&mesh.nodes, TILE_NODES);
        let mut place_of = vec![(0, 0); mesh.nodes.len()];
        for (number, tile) in node_tiles.iter().enumerate() {
            for (place, &node) in tile.iter().enumerate() {
                place_of[node as usize] = (number as u32, place as u32);
            }
        }
        let elements = mesh.hexes.len();
        Self {
            by_surface: empty(surface_tiles),
            half_solved: empty(node_tiles.len()),
            blocks: Mutex::default(),
            elements: empty(elements),
            means: (0..elements).map(|e| solid.element_mean(e)).collect(),
            stacks: stacks(solid, surface),
            node_tiles,
            place_of,
        }
    }

    /// Element number `element` by itself.
    pub fn element(&self, solid: &ElasticSolid, element: u32) -> &YieldingElement {
        let element = element as usize;
        self.elements[element].get_or_init(|| Box::new(solid.yielding_element(element)))
    }

    /// What unit loads on a tile of the surface move all mesh nodes by, a row for every axis of every node.
    pub fn by_surface(&self, solid: &ElasticSolid, tile: usize, loads: &[(u32, Vec3)]) -> &[f32] {
        self.by_surface[tile].get_or_init(|| {
            let nodes: Vec<u32> = (0..solid.mesh().nodes.len() as u32).collect();
            let moved = solid.influence(&nodes, loads);
            moved.values().iter().map(|&by| by as f32).collect()
        })
    }

    /// Adds a force on a mesh node.
    pub fn add_force(&self, forces: &mut ByTile, node: u32, force: &Vec3) {
        let (tile, place) = self.place_of[node as usize];
        let forces = forces
            .entry(tile)
            .or_insert_with(|| vec![0.0; 3 * self.node_tiles[tile as usize].len()]);
        for (axis, force) in force.iter().enumerate() {
            forces[3 * place as usize + axis] += force;
        }
    }

    /// What forces on mesh nodes move the nodes of some tiles by.
    pub fn moved(&self, solid: &ElasticSolid, forces: &ByTile, tiles: &[u32]) -> ByTile {
        let moved = tiles.iter().map(|&tile| {
            let mut moved = vec![0.0; 3 * self.node_tiles[tile as usize].len()];
            for (&other, forces) in forces {
                let block = self.block(solid, tile, other);
                let rows = moved.iter_mut().zip(block.chunks_exact(forces.len()));
                for (moved, row) in rows {
                    *moved += product(row, forces);
                }
            }
            (tile, moved)
        });
        moved.collect()
    }

    /// What is said of a mesh node.
    pub fn of_node(&self, values: &ByTile, node: u32) -> Vec3 {
        let (tile, place) = self.place_of[node as usize];
        let values = values.get(&tile);
        values.map_or_else(Vec3::zeros, |values| {
            Vec3::from_column_slice(&values[3 * place as usize..][..3])
        })
    }

    /// The mesh nodes of a tile.
    pub fn nodes(&self, tile: u32) -> &[u32] {
        &self.node_tiles[tile as usize]
    }

    /// The tile of a mesh node.
    pub fn tile_of(&self, node: u32) -> u32 {
        self.place_of[node as usize].0
    }

    /// What unit forces on the nodes of a tile move those of another by, a row for every axis of the former.
    fn block(&self, solid: &ElasticSolid, tile: u32, other: u32) -> Arc<[f64]> {
        let lock = || self.blocks.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(block) = lock().get(&(tile, other)) {
            return Arc::clone(block);
        }
        let [own, others] = [tile, other].map(|tile| self.half_solved(solid, tile));
        let block: Arc<[f64]> = own.moved_along(others).into();
        lock().insert((tile, other), Arc::clone(&block));
        block
    }

    fn half_solved(&self, solid: &ElasticSolid, tile: u32) -> &HalfSolved {
        self.half_solved[tile as usize].get_or_init(|| {
            let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
            let nodes = self.node_tiles[tile as usize].iter();
            let forces = nodes.flat_map(|&node| axes.map(|axis| (node, axis)));
            solid.half_solved(&forces.collect::<Vec<_>>())
        })
    }
}

/// Product of a row with loads: four sums, so that no addition waits for the one before.
pub(crate) fn product<T: Copy + Into<f64>>(row: &[T], loads: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, four_loads) = (row.chunks_exact(4), loads.chunks_exact(4));
    let (rest, rest_of_loads) = (fours.remainder(), four_loads.remainder());
    for (row, loads) in fours.zip(four_loads) {
        for lane in 0..4 {
            sums[lane] += row[lane].into() * loads[lane];
        }
    }
    let rest = rest.iter().zip(rest_of_loads);
    let rest: f64 = rest.map(|(&by, load)| by.into() * load).sum();
    sums.iter().sum::<f64>() + rest
}

fn empty<T>(count: usize) -> Vec<OnceLock<T>> {
    (0..count).map(|_| OnceLock::new()).collect()
}

/// Of every node of a surface the elements that it is nearest to.
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
