//! The compliance of an insert's surface by finite elements.

use std::{
    collections::BTreeMap,
    fmt,
    sync::{
        Arc, Mutex, MutexGuard, OnceLock, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use condyle_fem::{Elastic, ElasticSolid, HexMesh, SolidError, Strain};
use nalgebra::DVector;

use super::{
    backside::{Floor, Tray},
    compliance::{Compliance, SurfaceCompliance, UnitLoads, along_surface, tiles},
    plastic::Influence,
};
use crate::{
    Vec3,
    contact::law::KnownCompliance,
    geometry::{Insert, bounds},
};

/// So many nodes at most are solved for together: forces on nodes that are near load the same part of the factor.
const TILE_NODES: usize = 48;

/// The freedoms that feel a load, over the root of all: those on the cuts around it, which go through a plate of three
/// layers of nodes.
const FELT_PER_ROOT: f64 = 6.0;

/// Nodes that hold an insert while its loads are half-solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HeldBy {
    /// The nodes of its backside: it is bonded.
    Backside,
    /// The nodes of the flat part of it, which rests; walls and recesses hang free.
    Floor,
}

/// The articulating surface of an elastic insert, held by its backside or by the floor of that.
///
/// The stiffness is factored once; unit loads on a tile of nodes are solved half way when they are first asked for,
/// and kept.
pub(crate) struct ElasticSurface {
    solid: Arc<ElasticSolid>,
    /// Mesh nodes of the surface.
    nodes: Vec<u32>,
    /// The surface's own directions at its nodes, anterior and lateral.
    tangents: Vec<[Vec3; 2]>,
    /// Unit loads along the inward normals.
    normal: UnitLoads,
    known_at_first: AtomicUsize,
    /// Those along the surface, of an insert that sticks and slips.
    tangential: OnceLock<Arc<Compliance<UnitLoads>>>,
    /// The influence of loads inside an insert that yields.
    influence: OnceLock<Influence>,
    /// The nodes that hold it.
    held_by: HeldBy,
    /// The flat part of the backside, of an insert that rests on it.
    floor: OnceLock<Floor>,
    backside: Vec<u32>,
    /// The tray, of an insert that rests on it, and the spacing of its points, mm.
    tray: Mutex<Option<(f64, Arc<Tray>)>>,
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
    pub fn new(
        insert: &Insert,
        mesh_nodes: &[Vec3],
        elastic: Elastic,
        held_by: HeldBy,
    ) -> Result<Self, SolidError> {
        let mesh = HexMesh {
            nodes: mesh_nodes.to_vec(),
            hexes: insert.mesh().hexes.clone(),
        };
        let surface = insert.surface_at(mesh_nodes);
        let tiles = tiles(&surface.positions, TILE_NODES);
        let backside = insert.backside_nodes();
        let held = match held_by {
            HeldBy::Backside => backside.to_vec(),
            HeldBy::Floor => Floor::from_backside(&mesh, backside).nodes,
        };
        let solid = Arc::new(ElasticSolid::new(&mesh, elastic, held)?);
        let nodes = insert.surface_nodes();
        let inward = surface.normals.iter().map(|normal| -normal);
        let forces = nodes.iter().copied().zip(inward).collect();
        Ok(Self {
            normal: UnitLoads::on(Arc::clone(&solid), forces, tiles),
            known_at_first: AtomicUsize::new(0),
            solid,
            tangents: (0..nodes.len())
                .map(|node| surface.directions(node))
                .collect(),
            nodes: nodes.to_vec(),
            tangential: OnceLock::new(),
            influence: OnceLock::new(),
            backside: backside.to_vec(),
            floor: OnceLock::new(),
            held_by,
            tray: Mutex::default(),
        })
    }

    /// Takes what another run has found of its normal compliance.
    pub fn know(&self, known: KnownCompliance) {
        self.known_at_first.store(known.pairs(), Ordering::Relaxed);
        *self.normal.known() = known;
    }

    /// Returns the results of another run that no caller has asked for yet.
    pub fn known(&self) -> MutexGuard<'_, KnownCompliance> {
        self.normal.known()
    }

    /// Returns the number of pairs of tiles known from another run.
    pub fn known_at_first(&self) -> usize {
        self.known_at_first.load(Ordering::Relaxed)
    }

    fn floor(&self) -> &Floor {
        let mesh = self.solid.mesh();
        self.floor
            .get_or_init(|| Floor::from_backside(mesh, &self.backside))
    }

    /// The tray, with points at some spacing: that asked for last, or recomputed.
    pub fn tray(&self, spacing_mm: f64) -> Arc<Tray> {
        let mut tray = self.tray.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known_mm, known)) = &*tray
            && *known_mm == spacing_mm
        {
            return Arc::clone(known);
        }
        let made = Tray::new(&self.solid, self.floor(), spacing_mm, self.tiles().len());
        let made = Arc::new(made);
        *tray = Some((spacing_mm, Arc::clone(&made)));
        made
    }

    /// Returns how far the motion of the backside moves the nodes of a tile along their inward normals: a row a node.
    pub fn by_tray<'a>(&self, tray: &'a Tray, tile: usize) -> &'a [f64] {
        tray.of_tile(&self.normal, tile)
    }

    /// Returns the forces at the points of the backside by loads along the inward normals of nodes, N.
    pub fn forces_on_tray(&self, tray: &Tray, loads: &[(u32, f64)]) -> DVector<f64> {
        let mut forces_n = DVector::zeros(tray.freedoms());
        for (tile, loads) in self.by_tile(loads) {
            let rows = self
                .by_tray(tray, tile as usize)
                .chunks_exact(tray.freedoms());
            for (row, load_n) in rows.zip(loads).filter(|(_, load_n)| *load_n != 0.0) {
                for (force_n, by) in forces_n.iter_mut().zip(row) {
                    *force_n += load_n * by;
                }
            }
        }
        forces_n
    }

    /// The compliance along the surface: load 2 i + k is on node i along its direction k, anterior and lateral.
    pub fn tangential(&self) -> &Arc<Compliance<UnitLoads>> {
        self.tangential.get_or_init(|| {
            let nodes = self.nodes.iter().zip(&self.tangents);
            let forces = nodes.flat_map(|(&node, along)| along.map(|along| (node, along)));
            let tiles = self.tiles().iter();
            let tiles =
                tiles.map(|tile| tile.iter().flat_map(|&node| along_surface(node)).collect());
            let loads = UnitLoads::on(Arc::clone(&self.solid), forces.collect(), tiles.collect());
            Arc::new(Compliance::new(loads))
        })
    }

    /// Bytes of the solid, and of so many loads on each of some nodes and the compliance between them.
    pub fn bytes(&self, nodes: f64, loads_a_node: [f64; 2]) -> f64 {
        let nodes = nodes.min(self.nodes.len() as f64);
        let of_loads = loads_a_node.map(|each| each * nodes * (each * nodes + self.felt()));
        self.solid.bytes() as f64 + size_of::<f64>() as f64 * (of_loads[0] + of_loads[1])
    }

    /// Bytes of a tray with points at some spacing, and of its influence on some nodes.
    pub fn bytes_of_tray(&self, spacing_mm: f64, nodes: f64) -> f64 {
        let mesh = self.solid.mesh();
        let places: Vec<Vec3> = mesh.positions(&self.floor().nodes).collect();
        let (low, high) = bounds(&places);
        let points = [0, 2].map(|axis| (high[axis] - low[axis]) / spacing_mm + 1.0);
        Tray::bytes(3.0 * points[0] * points[1], nodes, self.felt())
    }

    /// Estimates the number of freedoms that feel a load.
    fn felt(&self) -> f64 {
        FELT_PER_ROOT * (3.0 * self.solid.mesh().nodes.len() as f64).sqrt()
    }

    /// Bytes of what loads on some nodes move inside an insert that yields.
    pub fn bytes_below(&self, nodes: f64) -> f64 {
        let rows = 3.0 * self.solid.mesh().nodes.len() as f64;
        size_of::<f32>() as f64 * rows * nodes.min(self.nodes.len() as f64)
    }

    /// Returns whether it belongs to an insert with the given mesh nodes.
    pub fn is_of(&self, insert: &Insert, mesh_nodes: &[Vec3], held_by: HeldBy) -> bool {
        let mesh = self.solid.mesh();
        self.held_by == held_by
            && mesh.hexes == insert.mesh().hexes
            && mesh.nodes == mesh_nodes
            && self.nodes == insert.surface_nodes()
    }

    /// The insert as a solid.
    pub fn solid(&self) -> &ElasticSolid {
        &self.solid
    }

    /// Returns the influence of loads inside the insert.
    pub fn influence(&self) -> &Influence {
        self.influence.get_or_init(|| {
            let nodes = self.nodes.iter();
            let places: Vec<Vec3> = nodes
                .map(|&node| self.solid.mesh().nodes[node as usize])
                .collect();
            Influence::new(&self.solid, &places, self.tiles().len())
        })
    }

    /// Nodes of the surface that lie together.
    pub fn nodes_of_tile(&self, tile: usize) -> &[u32] {
        &self.tiles()[tile]
    }

    /// Returns the displacements of all mesh nodes by unit loads on a tile, mm/N: a row for every axis of every mesh node.
    pub fn moved_below(&self, tile: usize) -> &[f32] {
        let loads: Vec<(u32, Vec3)> = self.tiles()[tile]
            .iter()
            .map(|&node| self.unit(node))
            .collect();
        self.influence().by_surface(&self.solid, tile, &loads)
    }

    /// Loads on nodes of the surface by their tiles.
    pub fn by_tile(&self, loads: &[(u32, f64)]) -> BTreeMap<u32, Vec<f64>> {
        let load_of: BTreeMap<u32, f64> = loads.iter().copied().collect();
        let mut by_tile = BTreeMap::new();
        for (number, tile) in self.tiles().iter().enumerate() {
            let of = |node: &u32| load_of.get(node).copied();
            if tile.iter().any(|node| of(node).is_some()) {
                let loads = tile.iter().map(|node| of(node).unwrap_or(0.0));
                by_tile.insert(number as u32, loads.collect());
            }
        }
        by_tile
    }

    /// Returns the displacements of all mesh nodes by loads along the inward normals and eigenstrains of elements, mm.
    pub fn moved_by(
        &self,
        loads: &[(u32, f64)],
        eigenstrains: &BTreeMap<usize, [Strain; 8]>,
    ) -> Vec<Vec3> {
        let mut forces: Vec<(u32, Vec3)> = Vec::new();
        for &(node, load_n) in loads {
            let (node, along) = self.unit(node);
            forces.push((node, along * load_n));
        }
        for (&element, strains) in eigenstrains {
            let own = self.influence().element(&self.solid, element as u32);
            let own = own.forces(&self.solid, strains);
            let nodes = self.solid.mesh().hexes[element];
            forces.extend(nodes.into_iter().zip(own));
        }
        self.solid.displacements(&forces)
    }

    /// Returns the displacements of all mesh nodes by loads along the inward normals and a motion of the backside, mm.
    pub fn moved_with_tray(
        &self,
        loads: &[(u32, f64)],
        tray: &Tray,
        moved_mm: &[f64],
    ) -> Vec<Vec3> {
        let forces = loads.iter().map(|&(node, load_n)| {
            let (node, along) = self.unit(node);
            (node, along * load_n)
        });
        let forces: Vec<(u32, Vec3)> = forces.collect();
        self.solid
            .displacements_with_supports(&forces, &tray.moved_nodes(moved_mm))
    }

    /// Returns the displacements of the surface's mesh nodes along the inward normals, mm.
    pub fn along_normals(&self, moved_mm: &[Vec3]) -> Vec<f64> {
        (0..self.nodes.len() as u32)
            .map(|node| self.unit(node))
            .map(|(node, along)| moved_mm[node as usize].dot(&along))
            .collect()
    }

    /// The mesh node of a node of the surface, and the inward normal there.
    fn unit(&self, node: u32) -> (u32, Vec3) {
        self.normal.force(node)
    }
}

impl SurfaceCompliance for ElasticSurface {
    fn tiles(&self) -> &[Vec<u32>] {
        self.normal.tiles()
    }

    fn between(&self, one: usize, other: usize) -> Vec<f64> {
        self.normal.between(one, other)
    }
}
