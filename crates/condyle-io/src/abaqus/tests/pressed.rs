//! The femur pressed on a deformable insert, read back.

use condyle::Vec3;

use super::super::{ExportError, PressedCase};
use super::reader::Deck;
use super::{COARSE, hexahedra, parsed};
use crate::case::Case;

const PERCENT: f64 = 14.0;

fn deformable(more: &str) -> Case {
    parsed(&format!(
        "{COARSE}[time]\nincrements = 60\n[contact]\nmodel = \"deformable\"\n{more}"
    ))
}

fn pressed(case: &Case) -> (PressedCase<'_>, Deck) {
    let pressed = PressedCase::new(case, 2).unwrap_or_else(|error| panic!("{error}"));
    let mut text = Vec::new();
    pressed.write(PERCENT, &mut text).unwrap();
    let deck = Deck::read(&String::from_utf8(text).unwrap());
    (pressed, deck)
}

fn refusal(case: &Case) -> ExportError {
    match PressedCase::new(case, 1) {
        Ok(_) => panic!("this is written"),
        Err(error) => error,
    }
}

/// Where the led nodes go in the only step, mm.
fn way_mm(deck: &Deck) -> Vec3 {
    let led = deck.named("BOUNDARY").last().unwrap();
    assert!(led.rows.iter().all(|row| row[0] == "FEMUR-NODES"));
    let to: Vec<f64> = led.rows.iter().map(|row| row[3].parse().unwrap()).collect();
    Vec3::from_row_slice(&to)
}

#[test]
fn cross_the_led_facets_lie_on_the_femur_and_look_out_of_it() {
    let case = deformable("");
    let (pressed, deck) = pressed(&case);
    let (row, pose) = pressed.at(PERCENT).unwrap();
    assert!((row.percent - PERCENT).abs() < 1.0);
    let (femur, insert) = (pressed.unworn().femur(), pressed.unworn().insert());
    let (written, mesh) = (hexahedra(&deck), insert.mesh());
    assert!(written.hexes == mesh.hexes && written.nodes.len() == mesh.nodes.len());
    // A field has room for thirteen digits at least.
    let off = |(one, other): (&Vec3, &Vec3)| (one - other).norm();
    let off_mm = written
        .nodes
        .iter()
        .zip(&mesh.nodes)
        .map(off)
        .fold(0.0, f64::max);
    assert!(off_mm < 1e-11, "{off_mm}");
    let way = way_mm(&deck);
    assert!(way.y < 0.0 && way.x == 0.0 && way.z == 0.0, "{way}");
    for corners in deck.corners("FEMUR") {
        // The outer face, S2 of a wedge, is 4-6-5.
        let outer = [corners[3], corners[5], corners[4]];
        for corner in outer {
            let gap_mm = femur.gap_mm(&pose.to_femur(&(corner + way)));
            assert!(gap_mm.abs() < 1e-5, "{gap_mm}");
        }
        let inward = (outer[1] - outer[0]).cross(&(outer[2] - outer[0]));
        assert!(inward.dot(&(corners[0] - corners[3])) > 0.0);
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        assert!(
            (b - a).cross(&(c - a)).dot(&(corners[3] - a)) > 0.0,
            "inside out"
        );
    }
    let nearest = insert
        .surface_nodes()
        .iter()
        .map(|&node| femur.gap_mm(&pose.to_femur(&(insert.mesh().nodes[node as usize] + way))));
    // Before it comes down nothing touches: the insert seen from the femur where that begins.
    assert!(nearest.fold(f64::INFINITY, f64::min) > 0.0);
}

#[test]
fn what_touches_has_facets_over_it() {
    let case = deformable("");
    let (pressed, deck) = pressed(&case);
    let (_, pose) = pressed.at(PERCENT).unwrap();
    let (femur, insert) = (pressed.unworn().femur(), pressed.unworn().insert());
    let way = way_mm(&deck);
    let facets = deck.corners("FEMUR");
    let nodes = insert.surface_nodes().iter();
    let nodes = nodes.map(|&node| insert.mesh().nodes[node as usize]);
    let touching = nodes.filter(|node| femur.gap_mm(&pose.to_femur(node)) < 0.0);
    let mut count = 0;
    for node in touching {
        let near = |corners: &Vec<Vec3>| (corners[3] + way - node).norm() < 0.5;
        assert!(facets.iter().any(near), "{node}");
        count += 1;
    }
    assert!(count > 5, "{count}");
}

#[test]
fn the_backside_is_held_and_the_curve_of_yield_is_written() {
    let elastic = deformable("");
    let (elastic_case, deck) = pressed(&elastic);
    let held = elastic_case.unworn().insert().backside_nodes();
    assert_eq!(deck.node_sets["BACKSIDE"].len(), held.len());
    assert_eq!(deck.named("PLASTIC").count(), 0);
    assert!(deck.named("STEP").all(|step| step.get("NLGEOM").is_none()));
    let yielding = deformable("plasticity = \"j2\"\nhardening = [[0.0, 14.0], [0.1, 20.0]]\n");
    let (_, deck) = pressed(&yielding);
    let curve = deck.named("PLASTIC").next().unwrap().numbers();
    assert_eq!(curve, [[14.0, 0.0], [20.0, 0.1]]);
}

#[test]
fn cases_that_cannot_be_pressed_say_why() {
    let foundation = refusal(&parsed(COARSE));
    assert!(
        foundation.to_string().contains("has a foundation"),
        "{foundation}"
    );
    let kinematic = deformable("plasticity = \"j2\"\nkinematic_modulus_mpa = 10.0\n");
    let kinematic = refusal(&kinematic);
    assert!(
        kinematic.to_string().contains("kinematic_modulus_mpa = 10"),
        "{kinematic}"
    );
}
