//! Bodies can be cloned, changed and sent to other threads, and clones share what is large.

use condyle::{
    Vec3,
    geometry::{
        Counterface, GenericFemur, GenericFemurShape, GenericInsertShape, Insert, Meshing,
        SmoothField,
    },
};

fn is_send_sync_and_clone<T: Send + Sync + Clone>() {}

fn meshed_counterface() -> Counterface {
    let mesh = GenericFemur::new(GenericFemurShape::default()).surface_mesh(3.0);
    Counterface::Mesh(SmoothField::new(&mesh, 1))
}

#[test]
fn bodies_can_be_cloned_and_sent() {
    is_send_sync_and_clone::<Insert>();
    is_send_sync_and_clone::<SmoothField>();
    is_send_sync_and_clone::<Counterface>();
}

#[test]
fn a_counterface_prepared_for_shares_leaves_the_one_it_came_from_alone() {
    let counterface = meshed_counterface();
    let point = Vec3::new(2.0, -22.0, 22.0);
    let before_mm = counterface.gap_mm(&point);
    let prepared = counterface.prepared_for(0.05);
    assert!(prepared.gap_mm(&point) > before_mm);
    assert_eq!(counterface.gap_mm(&point), before_mm);
}

#[test]
fn worn_clones_on_threads_are_as_if_each_were_alone() {
    let meshing = Meshing {
        edge_mm: 3.0,
        layers: 2,
    };
    let insert = GenericInsertShape::default().insert(meshing).unwrap();
    let worn = |depth_mm: f64| {
        let mut insert = insert.clone();
        let surface = insert.surface();
        insert.wear_down(&surface, &vec![depth_mm; surface.positions.len()]);
        insert.mesh().nodes.clone()
    };
    let depths_mm = [0.1, 0.2, 0.3];
    let together = std::thread::scope(|scope| {
        depths_mm
            .map(|depth_mm| scope.spawn(move || worn(depth_mm)))
            .map(|thread| thread.join().unwrap())
    });
    assert_eq!(together, depths_mm.map(worn));
}
