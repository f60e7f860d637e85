//! Unit loads on the surface of an elastic solid, solved half way tile by tile.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use condyle_fem::{ElasticSolid, HalfSolved};

use super::compliance::SurfaceCompliance;
use crate::{Vec3, contact::known_compliance::KnownCompliance};

/// Unit loads on places of a solid, each along a direction of its own: the compliance between them.
///
/// Those of a tile are solved half way when they are first asked for, and kept.
pub(super) struct UnitLoads {
    solid: Arc<ElasticSolid>,
    /// The mesh node of every load, and its direction.
    forces: Vec<(u32, Vec3)>,
    /// Loads that lie together, and of every tile what they do.
    tiles: Vec<Vec<u32>>,
    solved: Mutex<Vec<Option<Arc<HalfSolved>>>>,
    /// What another run has found between them, and nobody has asked for yet.
    known: Mutex<KnownCompliance>,
}

impl std::fmt::Debug for UnitLoads {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("UnitLoads")
            .field("loads", &self.forces.len())
            .finish_non_exhaustive()
    }
}

impl UnitLoads {
    /// Loads on a solid, of which the numbers of those that lie together are in `tiles`.
    pub fn on(solid: Arc<ElasticSolid>, forces: Vec<(u32, Vec3)>, tiles: Vec<Vec<u32>>) -> Self {
        Self {
            solid,
            forces,
            solved: Mutex::new(vec![None; tiles.len()]),
            tiles,
            known: Mutex::default(),
        }
    }

    /// What another run has found, and nobody has asked for yet.
    pub fn known(&self) -> MutexGuard<'_, KnownCompliance> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The mesh node of a load, and its direction.
    pub fn force(&self, load: u32) -> (u32, Vec3) {
        self.forces[load as usize]
    }

    /// Unit loads of a tile, solved half way.
    pub fn solved(&self, tile: usize) -> Arc<HalfSolved> {
        let mut solved = self.solved.lock().unwrap_or_else(PoisonError::into_inner);
        let own = solved[tile].get_or_insert_with(|| {
            let forces = self.tiles[tile].iter().map(|&load| self.force(load));
            Arc::new(self.solid.half_solved(&forces.collect::<Vec<_>>()))
        });
        Arc::clone(own)
    }
}

/// The numbers of a node's loads along the surface: along its own directions there, anterior and lateral.
pub(super) fn along_surface(node: u32) -> [u32; 2] {
    [2 * node, 2 * node + 1]
}

impl SurfaceCompliance for UnitLoads {
    fn tiles(&self) -> &[Vec<u32>] {
        &self.tiles
    }

    fn between(&self, one: usize, other: usize) -> Vec<f64> {
        let nodes = [one, other].map(|tile| self.tiles[tile].len());
        let known = self.known().take(one, other, nodes);
        known.unwrap_or_else(|| self.solved(one).moved_along(&self.solved(other)))
    }
}
