//! How a surface gives way under loads on its nodes.

use std::{
    fmt::Debug,
    sync::{PoisonError, RwLock, RwLockReadGuard},
};

use super::near_matrix::NearMatrix;
use crate::contact::known_compliance::KnownCompliance;

/// The normal compliance of a surface: how far its nodes give way to loads on them, both along the inward normals.
///
/// It is symmetric and positive definite, and given for two tiles of nodes at a time, as they are asked for: of most
/// nodes nobody ever asks. What it says depends on nothing that was asked before.
pub(super) trait SurfaceCompliance: Debug + Send + Sync {
    /// All nodes of the surface, in tiles that lie together.
    fn tiles(&self) -> &[Vec<u32>];

    /// How far unit loads on the nodes of one tile move those of another, mm/N: row-major, a row for each of `one`.
    fn between(&self, one: usize, other: usize) -> Vec<f64>;
}

/// The compliance of a surface, and of the nodes that any contact has come near what was asked so far.
#[derive(Debug)]
pub(super) struct Compliance<S: ?Sized = dyn SurfaceCompliance> {
    tile_of: Vec<u32>,
    near: RwLock<NearMatrix>,
    pub source: S,
}

impl<S: SurfaceCompliance> Compliance<S> {
    /// That of a surface, of which nothing was asked.
    pub fn new(source: S) -> Self {
        let nodes = source.tiles().iter().map(Vec::len).sum();
        let mut tile_of = vec![0; nodes];
        for (number, tile) in source.tiles().iter().enumerate() {
            for &node in tile {
                tile_of[node as usize] = number as u32;
            }
        }
        Self {
            near: RwLock::new(NearMatrix::of_nothing(source.tiles())),
            tile_of,
            source,
        }
    }
}

impl<S: SurfaceCompliance + ?Sized> Compliance<S> {
    /// How many nodes the surface has.
    pub fn node_count(&self) -> usize {
        self.tile_of.len()
    }

    /// How many nodes something was asked of.
    pub fn known_count(&self) -> usize {
        self.read().row_count()
    }

    /// Of how many pairs of tiles something was asked.
    pub fn asked_pairs(&self) -> usize {
        self.read().pairs().count()
    }

    /// Adds what was asked so far to what is `known` of other tiles.
    pub fn known_with(&self, mut known: KnownCompliance) -> KnownCompliance {
        let near = self.read();
        for [one, other] in near.pairs() {
            let tiles = [one, other].map(|tile| &self.source.tiles()[tile][..]);
            known.add(one, other, near.between(tiles));
        }
        known
    }

    /// The tile of a node.
    pub fn tile_of(&self, node: u32) -> u32 {
        self.tile_of[node as usize]
    }

    /// The compliance of some nodes, and of others.
    pub fn near(&self, nodes: impl Iterator<Item = u32>) -> RwLockReadGuard<'_, NearMatrix> {
        let near = self.read();
        let unknown = nodes.filter(|&node| !near.knows(node));
        let mut tiles: Vec<u32> = unknown.map(|node| self.tile_of[node as usize]).collect();
        if tiles.is_empty() {
            return near;
        }
        drop(near);
        tiles.sort_unstable();
        tiles.dedup();
        self.add(&tiles);
        self.read()
    }

    fn read(&self) -> RwLockReadGuard<'_, NearMatrix> {
        self.near.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, tiles: &[u32]) {
        let mut near = self.near.write().unwrap_or_else(PoisonError::into_inner);
        let all = self.source.tiles();
        // Another thread may have added some.
        let new = tiles.iter().map(|&tile| tile as usize);
        let new: Vec<usize> = new.filter(|&tile| !near.knows(all[tile][0])).collect();
        near.make_room(new.iter().map(|&tile| all[tile].len()));
        for tile in new {
            near.add(tile, all, |one, other| self.source.between(one, other));
        }
    }
}
