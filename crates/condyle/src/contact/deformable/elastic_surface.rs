//! The articulating surface of an elastic insert: its compliance and the influence of loads, by finite elements.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
    sync::{
        Arc, Mutex, OnceLock, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use condyle_fem::{Elastic, ElasticSolid, HalfSolved, HexMesh, SolidError, Strain};
use nalgebra::DVector;

use super::{
    backside::{Floor, Tray},
    cholesky::product,
    compliance::{Compliance, SurfaceCompliance, UnitLoads, along_surface, tiles},
    history::NodeLoad,
    plastic::Influence,
};
use crate::{
    Vec3,
    contact::law::KnownCompliance,
    geometry::{Insert, bounds},
};

/// Largest number of nodes in a tile: neighbouring loads use the same part of the factor and are solved together.
const TILE_NODES: usize = 48;

/// The number of freedoms in the half-solution of a load, over the root of the number of all: those on the cuts around the
/// load, through a plate of three layers of nodes. Used for estimates of memory only.
const FELT_PER_ROOT: f64 = 6.0;

/// The articulating surface of an elastic insert, held at its backside or at the flat part of its backside.
///
/// The stiffness is factored once. Everything else is computed when it is first needed, and kept.
pub(crate) struct ElasticSurface {
    pub solid: Arc<ElasticSolid>,
    nodes: Vec<u32>,
    /// The surface's own directions at its nodes, anterior and lateral.
    tangents: Vec<[Vec3; 2]>,
    /// Unit loads along the inward normals, and the compliance between them.
    pub loads: Arc<UnitLoads>,
    pub normal: Arc<Compliance>,
    known_at_first: AtomicUsize,
    /// The compliance along the surface, if nodes stick and slip.
    tangential: OnceLock<Arc<Compliance>>,
    /// The influence of loads inside the insert, if it yields.
    influence: OnceLock<Influence>,
    /// The flat part of the backside, and whether the insert rests on it; otherwise the whole backside is bonded.
    floor: Floor,
    rests: bool,
    /// The nodes of the whole backside.
    backside: Vec<u32>,
    /// The tray, if the insert rests on it, and the spacing of its points, mm.
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
    /// Factors the stiffness of an insert with its mesh nodes at `mesh_nodes`, mm. An insert that `rests` is held at the flat
    /// part of its backside; walls and recesses are free.
    ///
    /// # Errors
    /// The material or the mesh does not define an elastic solid.
    pub fn new(
        insert: &Insert,
        mesh_nodes: &[Vec3],
        elastic: Elastic,
        rests: bool,
    ) -> Result<Self, SolidError> {
        let mesh = HexMesh {
            nodes: mesh_nodes.to_vec(),
            hexes: insert.mesh().hexes.clone(),
        };
        let surface = insert.surface_at(mesh_nodes);
        let tiles = tiles(&surface.positions, TILE_NODES);
        let floor = Floor::from_backside(&mesh, insert.backside_nodes());
        let held = if rests {
            &floor.nodes
        } else {
            insert.backside_nodes()
        };
        let held = held.iter().copied();
        let solid = Arc::new(ElasticSolid::new(&mesh, elastic, held)?);
        let nodes = insert.surface_nodes();
        let inward = surface.normals.iter().map(|normal| -normal);
        let forces = nodes.iter().copied().zip(inward).collect();
        let loads = Arc::new(UnitLoads::new(Arc::clone(&solid), forces, tiles));
        let source: Arc<dyn SurfaceCompliance> = Arc::clone(&loads) as _;
        Ok(Self {
            normal: Arc::new(Compliance::new(source)),
            loads,
            known_at_first: AtomicUsize::new(0),
            solid,
            tangents: (0..nodes.len())
                .map(|node| surface.directions(node))
                .collect(),
            nodes: nodes.to_vec(),
            tangential: OnceLock::new(),
            influence: OnceLock::new(),
            floor,
            rests,
            backside: insert.backside_nodes().to_vec(),
            tray: Mutex::default(),
        })
    }

    pub fn know(&self, known: KnownCompliance) {
        self.known_at_first.store(known.pairs(), Ordering::Relaxed);
        *self.loads.known() = known;
    }

    pub fn knows(&self) -> bool {
        self.normal.known_count() > 0 || self.known_at_first.load(Ordering::Relaxed) > 0
    }

    /// Returns the known normal compliance, for another run; none if it has no more pairs of tiles than at first, or than
    /// `more_than_pairs`.
    pub fn known(&self, more_than_pairs: usize) -> Option<KnownCompliance> {
        let unused_pairs = self.loads.known().pairs();
        let at_first = self.known_at_first.load(Ordering::Relaxed);
        if unused_pairs + self.normal.known_pairs() <= more_than_pairs.max(at_first) {
            return None;
        }
        let unused = self.loads.known().clone();
        Some(self.normal.add_to(unused))
    }

    /// Returns the tray with points at the given spacing; it is kept until the spacing changes.
    pub fn tray(&self, spacing_mm: f64) -> Arc<Tray> {
        let mut tray = self.tray.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known_mm, known)) = &*tray
            && *known_mm == spacing_mm
        {
            return Arc::clone(known);
        }
        let tiles = self.loads.tiles().len();
        let made = Arc::new(Tray::new(&self.solid, &self.floor, spacing_mm, tiles));
        *tray = Some((spacing_mm, Arc::clone(&made)));
        made
    }

    /// Returns the forces at the points of the backside by loads along the inward normals of nodes, N.
    pub fn forces_on_tray(&self, tray: &Tray, loads: &[NodeLoad]) -> DVector<f64> {
        let mut forces_n = DVector::zeros(tray.freedoms());
        for (tile, loads) in self.by_tile(loads) {
            let rows = tray.of_tile(&self.loads, tile);
            let rows = rows.chunks_exact(loads.len());
            for (force_n, row) in forces_n.iter_mut().zip(rows) {
                *force_n += product(row, &loads);
            }
        }
        forces_n
    }

    /// Returns the compliance along the surface: load 2 i + k is on node i along its direction k, anterior and lateral.
    pub fn tangential(&self) -> &Arc<Compliance> {
        self.tangential.get_or_init(|| {
            let nodes = self.nodes.iter().zip(&self.tangents);
            let forces = nodes.flat_map(|(&node, along)| along.map(|along| (node, along)));
            let tiles = self.loads.tiles().iter();
            let tiles =
                tiles.map(|tile| tile.iter().flat_map(|&node| along_surface(node)).collect());
            let solid = Arc::clone(&self.solid);
            let loads = UnitLoads::new(solid, forces.collect(), tiles.collect());
            Arc::new(Compliance::new(Arc::new(loads)))
        })
    }

    /// Estimates the memory of the solid, and of `loads_a_node` loads on each of `nodes` nodes with the compliance
    /// between them, bytes.
    pub fn bytes(&self, nodes: f64, loads_a_node: [f64; 2]) -> f64 {
        let nodes = nodes.min(self.nodes.len() as f64);
        let of_loads = loads_a_node.map(|each| each * nodes * (each * nodes + self.felt()));
        self.solid.bytes() as f64 + size_of::<f64>() as f64 * (of_loads[0] + of_loads[1])
    }

    /// Estimates the memory of a tray with points at some spacing, and of its influence on some nodes, bytes.
    pub fn bytes_of_tray(&self, spacing_mm: f64, nodes: f64) -> f64 {
        let mesh = self.solid.mesh();
        let places: Vec<Vec3> = mesh.positions(&self.floor.nodes).collect();
        let (low, high) = bounds(&places);
        // Points of a full grid over the floor: an upper bound, since points outside are omitted.
        let points = [0, 2].map(|axis| (high[axis] - low[axis]) / spacing_mm + 1.0);
        Tray::bytes(3.0 * points[0] * points[1], nodes, self.felt())
    }

    /// Estimates the number of freedoms that feel a load.
    fn felt(&self) -> f64 {
        FELT_PER_ROOT * (3.0 * self.solid.mesh().nodes.len() as f64).sqrt()
    }

    /// Estimates the memory of the influence of loads on some nodes inside an insert that yields, bytes.
    pub fn bytes_below(&self, nodes: f64) -> f64 {
        let rows = 3.0 * self.solid.mesh().nodes.len() as f64;
        size_of::<f32>() as f64 * rows * nodes.min(self.nodes.len() as f64)
    }

    /// Returns true if it belongs to an insert with the given mesh nodes.
    pub fn is_of(&self, insert: &Insert, mesh_nodes: &[Vec3], rests: bool) -> bool {
        let mesh = self.solid.mesh();
        self.rests == rests
            && mesh.hexes == insert.mesh().hexes
            && mesh.nodes == mesh_nodes
            && self.nodes == insert.surface_nodes()
            && self.backside == insert.backside_nodes()
    }

    pub fn influence(&self) -> &Influence {
        self.influence.get_or_init(|| {
            let places = self.solid.mesh().positions(&self.nodes).collect::<Vec<_>>();
            Influence::new(&self.solid, &places, self.loads.tiles())
        })
    }

    pub fn nodes_of_tile(&self, tile: usize) -> &[u32] {
        &self.loads.tiles()[tile]
    }

    /// Returns the displacements of all mesh nodes by a unit load on each of some nodes of the surface, mm/N: three numbers a
    /// mesh node, in the order of the nodes of the influence.
    pub fn moved_below(&self, nodes: impl Iterator<Item = u32> + Clone) -> Vec<&[f32]> {
        let (by_surface, all) = (&self.influence().by_surface, &self.influence().nodes);
        let unknown = nodes.clone();
        let unknown = unknown.filter(|&node| by_surface[node as usize].get().is_none());
        let tiles: BTreeSet<u32> = unknown.map(|node| self.normal.tile_of(node)).collect();
        // Tiles that are needed together are solved together.
        let tiles = tiles.iter().map(|&tile| tile as usize);
        let solved: Vec<_> = tiles.clone().map(|tile| self.loads.solved(tile)).collect();
        let halves: Vec<&HalfSolved> = solved.iter().map(Arc::as_ref).collect();
        let of_tiles = tiles.flat_map(|tile| self.nodes_of_tile(tile));
        for (&node, moved) in of_tiles.zip(self.solid.displacements_by_each(&halves, all)) {
            by_surface[node as usize].get_or_init(|| moved);
        }
        let known = nodes.filter_map(|node| by_surface[node as usize].get());
        known.map(Vec::as_slice).collect()
    }

    /// Groups loads on nodes by tiles, ascending, in the order of the nodes of each.
    pub fn by_tile(&self, loads: &[NodeLoad]) -> Vec<(usize, Vec<f64>)> {
        let mut load_of = vec![0.0; self.nodes.len()];
        for &(node, load_n) in loads {
            load_of[node as usize] = load_n;
        }
        let tiles = loads.iter().map(|&(node, _)| self.normal.tile_of(node));
        let mut tiles: Vec<u32> = tiles.collect();
        tiles.sort_unstable();
        tiles.dedup();
        let of_tile = |tile| {
            let nodes = self.nodes_of_tile(tile).iter();
            (tile, nodes.map(|&node| load_of[node as usize]).collect())
        };
        tiles
            .into_iter()
            .map(|tile| of_tile(tile as usize))
            .collect()
    }

    /// Returns the displacements of all mesh nodes by loads along the inward normals and eigenstrains of elements, mm.
    pub fn moved_by(
        &self,
        loads: &[NodeLoad],
        eigenstrains: &BTreeMap<usize, [Strain; 8]>,
    ) -> Vec<Vec3> {
        let mut forces = self.forces(loads);
        for (&element, strains) in eigenstrains {
            let own = self.influence().element(&self.solid, element as u32);
            let own = own.forces(strains);
            let nodes = self.solid.mesh().hexes[element];
            forces.extend(nodes.into_iter().zip(own));
        }
        self.solid.displacements(&forces)
    }

    /// Returns the displacements of all mesh nodes by loads along the inward normals and a motion of the backside, mm.
    pub fn moved_with_tray(&self, loads: &[NodeLoad], tray: &Tray, moved_mm: &[f64]) -> Vec<Vec3> {
        let moved = tray.moved_nodes(moved_mm);
        self.solid
            .displacements_with_supports(&self.forces(loads), &moved)
    }

    /// Returns the components of displacements of mesh nodes along the inward normals of the surface, mm.
    pub fn along_normals(&self, moved_mm: &[Vec3]) -> Vec<f64> {
        (0..self.nodes.len() as u32)
            .map(|node| self.loads.force(node))
            .map(|(node, along)| moved_mm[node as usize].dot(&along))
            .collect()
    }

    fn forces(&self, loads: &[NodeLoad]) -> Vec<(u32, Vec3)> {
        let force = |&(node, load_n): &NodeLoad| {
            let (node, along) = self.loads.force(node);
            (node, along * load_n)
        };
        loads.iter().map(force).collect()
    }
}
