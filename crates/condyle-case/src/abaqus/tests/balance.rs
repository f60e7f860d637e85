//! The bodies, the pose and the law of the file are in balance, whoever computes it.

use condyle::Vec3;

use super::super::AbaqusOptions;
use super::reader::Deck;
use super::{cases, written};
use crate::case::Case;

/// Height of a faceted surface over (x, z), if a facet that looks down covers it.
fn height(facets: &[Vec<Vec3>], x: f64, z: f64) -> Option<f64> {
    let twice =
        |p: (f64, f64), q: &Vec3, r: &Vec3| (q.x - p.0) * (r.z - p.1) - (q.z - p.1) * (r.x - p.0);
    facets.iter().find_map(|corners| {
        let [a, b, c]: [Vec3; 3] = corners.clone().try_into().unwrap();
        let all = twice((a.x, a.z), &b, &c);
        let weights = [
            twice((x, z), &b, &c),
            twice((x, z), &c, &a),
            twice((x, z), &a, &b),
        ];
        let weights = weights.map(|part| part / all);
        let inside = all != 0.0 && weights.iter().all(|&weight| weight >= -1e-9);
        let looks_down = (b - a).cross(&(c - a)).y < 0.0;
        (inside && looks_down).then(|| weights[0] * a.y + weights[1] * b.y + weights[2] * c.y)
    })
}

/// The dishes are lowest at y = 0; higher than this nothing touches under the light load of the
/// cycle's start, mm.
const TOUCHING_BELOW_MM: f64 = 0.4;

/// Axial force of the faceted bodies under the law of the file, from its text alone, N.
fn axial_force_n(deck: &Deck) -> f64 {
    let law = deck.named("SURFACE BEHAVIOR").next().unwrap().numbers();
    let stiffness = law[1][0] / law[1][1];
    let near = |corners: &Vec<Vec3>| corners.iter().any(|corner| corner.y < TOUCHING_BELOW_MM);
    let facets: Vec<Vec<Vec3>> = deck.corners("FEMUR").into_iter().filter(near).collect();
    let surface = deck
        .named("SURFACE")
        .find(|s| s.get("NAME") == Some("ARTICULATING"))
        .unwrap();
    // Corners of S1 to S6, after the Abaqus manual.
    const FACES: [[usize; 4]; 6] = [
        [0, 1, 2, 3],
        [4, 7, 6, 5],
        [0, 4, 5, 1],
        [1, 5, 6, 2],
        [2, 6, 7, 3],
        [3, 7, 4, 0],
    ];
    let mut force = 0.0;
    for row in &surface.rows {
        let nodes = &deck.elements[&row[0].parse().unwrap()].1;
        let face = FACES[row[1][1..].parse::<usize>().unwrap() - 1];
        let corners = face.map(|corner| deck.nodes[&nodes[corner]]);
        let normal = (corners[2] - corners[0]).cross(&(corners[3] - corners[1])) / 2.0;
        const SPLIT: usize = 4;
        for cell in 0..SPLIT * SPLIT {
            let at = |i: usize| (i as f64 + 0.5) / SPLIT as f64;
            let (u, v) = (at(cell % SPLIT), at(cell / SPLIT));
            let point = (corners[0] * (1.0 - u) + corners[1] * u) * (1.0 - v)
                + (corners[3] * (1.0 - u) + corners[2] * u) * v;
            if point.y > TOUCHING_BELOW_MM {
                continue;
            }
            let Some(femur) = height(&facets, point.x, point.z) else {
                continue;
            };
            let overlap = (point.y - femur) * normal.y.abs() / normal.norm();
            force += stiffness * overlap.max(0.0) * normal.y.abs() / (SPLIT * SPLIT) as f64;
        }
    }
    force
}

/// Overlap is 0.04 mm at most, so a hundredth of a millimetre in shape or pose would be a quarter of
/// the force; flat faces and one thickness cost some per cent.
#[test]
fn cross_the_faceted_bodies_carry_the_axial_force_where_they_stand() {
    let case = Case::read(&cases().join("stanmore-force.toml")).unwrap();
    let deck = Deck::read(&written(&case, AbaqusOptions::default()));
    let force = axial_force_n(&deck);
    let load = -deck.amplitudes["AXIAL-FORCE"][0].1;
    assert!((force / load - 1.0).abs() < 0.05, "{force} {load}");
}
