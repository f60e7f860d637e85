//! A worn insert put back from what a checkpoint holds.

use condyle::geometry::{GenericInsertShape, Insert, Meshing};

fn insert() -> Insert {
    let meshing = Meshing {
        edge_mm: 4.0,
        layers: 2,
    };
    GenericInsertShape::default().insert(meshing).unwrap()
}

#[test]
fn a_restored_insert_is_the_worn_one_to_the_last_bit() {
    let (mut worn, mut restored) = (insert(), insert());
    let mut worn_mm = vec![0.0; worn.surface_nodes().len()];
    for step in 1..=7 {
        let surface = worn.surface();
        let depth = |node: usize| 0.1 / f64::from(step) / (3.0 + node as f64);
        let depth_mm: Vec<f64> = (0..worn_mm.len()).map(depth).collect();
        worn.wear_down(&surface, &depth_mm);
        worn_mm.iter_mut().zip(&depth_mm).for_each(|(w, d)| *w += d);
    }
    restored.restore(worn.mesh().nodes.clone(), &worn_mm);
    assert_eq!(restored.thickness_mm(), worn.thickness_mm());
    assert_eq!(restored.mesh(), worn.mesh());
}
