//! The flow of an insert under given loads against the same by the method of initial stress on all of its elements.

mod initial_stress;

use std::sync::Arc;

use condyle_fem::{Elastic, ElasticPlastic, ElasticSolid, Hardening, PlasticPoint};

use super::*;
use crate::{
    Vec3,
    geometry::{Insert, Meshing, flat_insert},
};
use initial_stress::InitialStress;

fn hardening() -> Hardening {
    let points = vec![(0.0, 14.0), (0.01, 20.0), (0.03, 25.0), (0.1, 28.0)];
    Hardening::new(points, 30.0).unwrap()
}

fn material(hardening: Hardening) -> ElasticPlastic {
    let elastic = Elastic::new(463.0, 0.46).unwrap();
    ElasticPlastic { elastic, hardening }
}

fn nothing_stored() -> StoredPlasticity<PlasticPoint> {
    StoredPlasticity::from_stored(&ContactState::default())
}

struct Block {
    insert: Insert,
    surface: Arc<ElasticSurface>,
    whole: InitialStress,
}

impl Block {
    fn new() -> Self {
        let meshing = Meshing {
            edge_mm: 1.0,
            layers: 7,
        };
        let insert = flat_insert((14.0, 14.0), 7.0, meshing).unwrap();
        let elastic = Elastic::new(463.0, 0.46).unwrap();
        let surface = ElasticSurface::new(&insert, insert.unworn_nodes(), elastic, false).unwrap();
        let held = insert.backside_nodes().iter().copied();
        let solid = ElasticSolid::new(insert.mesh(), elastic, held).unwrap();
        Self {
            surface: Arc::new(surface),
            whole: InitialStress::new(solid, hardening()),
            insert,
        }
    }

    fn plastic(&self, stored: StoredPlasticity<PlasticPoint>) -> PlasticInsert<ElasticPlastic> {
        PlasticInsert::new(stored, Arc::clone(&self.surface), material(hardening()))
    }

    /// Loads of a pressure of Hertz about a place.
    fn loads(&self, peak_mpa: f64, x: f64) -> Vec<NodeLoad> {
        let surface = self.insert.surface();
        let nodes = surface.positions.iter().zip(&surface.shares).enumerate();
        let load = |(node, (place, share)): (usize, (&Vec3, &crate::geometry::Share))| {
            let ratio2 = ((place.x - x).powi(2) + place.z.powi(2)) / 9.0;
            let pressure = peak_mpa * (1.0 - ratio2).max(0.0).sqrt();
            (node as u32, pressure * share.area_mm2)
        };
        nodes.map(load).filter(|load| load.1 > 0.0).collect()
    }

    fn forces(&self, loads: &[NodeLoad]) -> Vec<(u32, Vec3)> {
        let surface = self.insert.surface();
        let force = |&(node, load_n): &NodeLoad| {
            let mesh_node = self.insert.surface_nodes()[node as usize];
            (mesh_node, -surface.normals[node as usize] * load_n)
        };
        loads.iter().map(force).collect()
    }
}

#[test]
fn verify_flow_and_permanent_set_against_initial_stress_on_all_elements() {
    let block = Block::new();
    let mut insert = block.plastic(nothing_stored());
    let mut state = block.whole.unloaded();
    // Pressed, released, and pressed next to that place.
    for (peak_mpa, x) in [(38.0, 0.0), (0.1, 0.0), (42.0, 1.5), (0.1, 1.5)] {
        let loads = block.loads(peak_mpa, x);
        let all = 0..block.surface.normal.node_count() as u32;
        insert
            .flow(&loads, f64::INFINITY, all, block.insert.faces_around())
            .unwrap();
        let tried_mm: Vec<f64> = (0..block.surface.normal.node_count() as u32)
            .map(|node| insert.set_mm[node as usize])
            .collect();
        insert.commit();
        (_, state) = block.whole.solve(&block.forces(&loads), &state).unwrap();
        let strains = state.iter().map(|points| points.map(|point| point.strain));
        let unloaded = block.surface.moved_by(&[], &(0..).zip(strains).collect());
        let exact_mm = block.surface.along_normals(&unloaded);
        let deepest = exact_mm.iter().copied().fold(0.0, f64::max);
        let set_mm: Vec<f64> = (0..exact_mm.len())
            .map(|node| insert.set_mm[node])
            .collect();
        println!("{peak_mpa} MPa at {x}: {deepest:.5} mm");
        assert!(deepest > 0.003, "{deepest}");
        let apart = set_mm.iter().zip(&exact_mm).map(|(a, b)| (a - b).abs());
        println!("{:.1e} of that apart", apart.fold(0.0, f64::max) / deepest);
        for ((set, tried), exact) in set_mm.iter().zip(&tried_mm).zip(&exact_mm) {
            assert!((set - exact).abs() < 2e-3 * deepest, "{set} {exact}");
            assert!((set - tried).abs() < 1e-6, "{set} {tried}");
        }
    }
    let stored = insert.into_stored();
    let most = stored.points.values().flatten();
    let most = most.map(|point| point.accumulated).fold(0.0, f64::max);
    let exact = state.iter().flatten();
    let exact = exact.map(|point| point.accumulated).fold(0.0, f64::max);
    assert!((most / exact - 1.0).abs() < 5e-3, "{most} {exact}");
}

#[test]
fn what_is_remembered_goes_through_the_state_to_the_same_bytes() {
    let block = Block::new();
    let mut insert = block.plastic(nothing_stored());
    let loads = block.loads(38.0, 0.0);
    let around = block.insert.faces_around();
    insert.begin_increment(0);
    insert.flow(&loads, f64::INFINITY, 0..1, around).unwrap();
    insert.commit();
    let stored = insert.into_stored();
    assert!(stored.flow_in_cycle.values().any(|flow| *flow > 1e-4));
    let state = ContactState {
        fields: stored.field().into_iter().collect(),
    };
    assert_eq!(StoredPlasticity::from_stored(&state), stored);
    // The same load again is elastic: it is what is already there.
    let mut insert = block.plastic(stored.clone());
    insert.flow(&loads, f64::INFINITY, 0..1, around).unwrap();
    insert.commit();
    let again = insert.into_stored();
    let flow = again.flow_in_cycle.values().copied().fold(0.0, f64::max);
    assert!(flow < 1e-4, "{flow}");
}

#[test]
fn a_load_that_presses_the_insert_flat_is_an_error() {
    let block = Block::new();
    let hardening = Hardening::perfectly_plastic(14.0).unwrap();
    let surface = Arc::clone(&block.surface);
    let mut insert = PlasticInsert::new(nothing_stored(), surface, material(hardening));
    let around = block.insert.faces_around();
    let loads = block.loads(200.0, 0.0);
    assert!(insert.flow(&loads, f64::INFINITY, 0..1, around).is_err());
    insert.reject();
    assert_eq!(insert.set_mm[0], 0.0);
}
