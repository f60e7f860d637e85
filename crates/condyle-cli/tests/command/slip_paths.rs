//! The slip at a few places, compared with the fields of the whole surface.

use std::collections::BTreeMap;

use condyle_mesh::formats::{VtuFile, read_vtu_points};

use crate::bench::{Bench, SMALL};

/// A place of `slip_paths.csv`.
#[derive(Default)]
struct Place {
    x_mm: f64,
    z_mm: f64,
    /// Sums of p |ds| t t^T: anterior, mixed, to the right.
    work: [f64; 3],
    rows: usize,
}

fn places(bench: &Bench) -> Vec<Place> {
    let table = bench.table("out", "slip_paths.csv");
    let mut places: BTreeMap<u64, Place> = BTreeMap::new();
    for (row, path) in table["path"].iter().enumerate() {
        let at = |column: &str| table[column][row];
        let place = places.entry(*path as u64).or_default();
        let [x, z] = [at("slip_x_mm"), at("slip_z_mm")];
        let per_mm = at("pressure_mpa") / x.hypot(z).max(f64::MIN_POSITIVE);
        let parts = [x * x, x * z, z * z];
        for (sum, part) in place.work.iter_mut().zip(parts) {
            *sum += per_mm * part;
        }
        (place.x_mm, place.z_mm) = (at("x_mm"), at("z_mm"));
        place.rows += 1;
    }
    places.into_values().collect()
}

fn cross_shear([anterior, mixed, right]: [f64; 3]) -> f64 {
    let half = f64::midpoint(anterior, right);
    let apart = (0.5 * (anterior - right)).hypot(mixed);
    (half - apart) / (2.0 * half)
}

/// The node of the articulating surface nearest to a place.
fn node(mesh: &VtuFile, place: &Place) -> usize {
    let on_surface = mesh.values("articulating").unwrap();
    let distance = |node: usize| {
        let at = mesh.mesh.nodes[node];
        (at.x - place.x_mm).hypot(at.z - place.z_mm)
    };
    let nodes = (0..mesh.mesh.nodes.len()).filter(|&node| on_surface[node] == 1.0);
    nodes
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .unwrap()
}

#[test]
fn verify_paths_have_the_cross_shear_of_their_places_on_either_side() {
    for side in ["right", "left"] {
        let bench = Bench::with_case(&format!("side = \"{side}\"\n{SMALL}"));
        bench.run_into("out");
        let mesh = read_vtu_points(bench.path("out/insert_0003.vtu")).unwrap();
        let depth_mm = mesh.values("wear_depth_mm").unwrap();
        let shear = mesh.values("cross_shear").unwrap();
        let places = places(&bench);
        assert!(places.len() >= 6 && places.len() <= 10, "{}", places.len());
        for place in &places {
            let (found, exact) = (cross_shear(place.work), shear[node(&mesh, place)]);
            assert!((found - exact).abs() < 1e-9, "{side}: {found} {exact}");
            assert!(place.rows <= 50);
        }
        let deepest = depth_mm.iter().copied().fold(0.0, f64::max);
        let at_places = places.iter().map(|place| depth_mm[node(&mesh, place)]);
        assert_eq!(at_places.fold(0.0, f64::max), deepest);
    }
}
