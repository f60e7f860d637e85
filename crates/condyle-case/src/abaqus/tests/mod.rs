//! Exported files, read back by a strict reader and compared with condyle's own model.

mod reader;

use std::{fs, io, path::Path};

use condyle::{
    Mat3, Vec3,
    contact::Bodies,
    geometry::{Counterface, Meshing, TriangleMesh, flat_insert},
    spatial::Pose,
};
use condyle_fem::{Elastic, HexMesh};

use super::{ExportError, Pressed, PressedCase, Slide};
use crate::case::Case;
use condyle_mesh::{files::Disk, formats::read_hexahedra};
use reader::Deck;

/// A case that is quick to build.
const COARSE: &str = "[insert]\nshape = \"generic\"\nedge_mm = 3.0\n";

const PERCENT: f64 = 14.0;

fn deformable(more: &str) -> Case {
    parsed(&format!(
        "{COARSE}[time]\nincrements = 60\n[contact]\nmodel = \"deformable\"\n{more}"
    ))
}

fn parsed(text: &str) -> Case {
    read(text, Path::new(""))
}

fn read(text: &str, folder: &Path) -> Case {
    Case::parse(text, "case.toml", folder).unwrap_or_else(|error| panic!("{error}"))
}

fn hexahedra(deck: &Deck) -> HexMesh {
    let labels = &deck.node_sets["INSERT-NODES"];
    let hex = |label: &u32| {
        let nodes: [u32; 8] = deck.elements[label].1.clone().try_into().unwrap();
        nodes.map(|node| node - 1)
    };
    HexMesh {
        nodes: labels.iter().map(|label| deck.nodes[label]).collect(),
        hexes: deck.element_sets["INSERT"].iter().map(hex).collect(),
    }
}

fn written(pressed: &PressedCase<'_>) -> String {
    let mut text = Vec::new();
    pressed.write(PERCENT, &mut text).unwrap();
    String::from_utf8(text).unwrap()
}

fn pressed(case: &Case) -> (PressedCase<'_>, Deck) {
    let pressed = PressedCase::new(case, 2).unwrap_or_else(|error| panic!("{error}"));
    let deck = Deck::read(&written(&pressed));
    (pressed, deck)
}

fn refusal(case: &Case) -> ExportError {
    match PressedCase::new(case, 1) {
        Ok(_) => panic!("this is written"),
        Err(error) => error,
    }
}

/// Displacements of the prescribed nodes in each step, mm.
fn ways_mm(deck: &Deck) -> impl Iterator<Item = Vec3> {
    let led = deck.named("BOUNDARY");
    let led = led.filter(|led| led.rows.iter().all(|row| row[0] == "FEMUR-NODES"));
    led.map(|led| {
        let to: Vec<f64> = led.rows.iter().map(|row| row[3].parse().unwrap()).collect();
        Vec3::from_row_slice(&to)
    })
}

/// Displacement in the only step, mm.
fn way_mm(deck: &Deck) -> Vec3 {
    let ways: Vec<Vec3> = ways_mm(deck).collect();
    assert_eq!(ways.len(), 1);
    ways[0]
}

#[test]
fn cross_the_prescribed_facets_lie_on_the_femur_and_face_outwards() {
    let case = deformable("");
    let (pressed, deck) = pressed(&case);
    let (row, pose) = pressed.at(PERCENT).unwrap();
    assert!((row.percent - PERCENT).abs() < 1.0);
    let (femur, insert) = (pressed.unworn().counterface(), pressed.unworn().insert());
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
            let gap_mm = femur.gap_mm(&pose.to_counterface(&(corner + way)));
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
    let nearest = insert.surface_nodes().iter().map(|&node| {
        femur.gap_mm(&pose.to_counterface(&(insert.mesh().nodes[node as usize] + way)))
    });
    // Before it comes down nothing touches: the insert seen from the femur where that begins.
    assert!(nearest.fold(f64::INFINITY, f64::min) > 0.0);
}

#[test]
fn nodes_in_contact_have_facets_over_them() {
    let case = deformable("");
    let (pressed, deck) = pressed(&case);
    let (_, pose) = pressed.at(PERCENT).unwrap();
    let (femur, insert) = (pressed.unworn().counterface(), pressed.unworn().insert());
    let way = way_mm(&deck);
    let facets = deck.corners("FEMUR");
    let nodes = insert.surface_nodes().iter();
    let nodes = nodes.map(|&node| insert.mesh().nodes[node as usize]);
    let touching = nodes.filter(|node| femur.gap_mm(&pose.to_counterface(node)) < 0.0);
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
    let yielding = deformable(
        "[contact.deformable]\nplasticity = \"j2\"\nhardening = [[0.0, 14.0], [0.1, 20.0]]\n",
    );
    let (_, deck) = pressed(&yielding);
    let curve = deck.named("PLASTIC").next().unwrap().numbers();
    assert_eq!(curve, [[14.0, 0.0], [20.0, 0.1]]);
    assert_eq!(deck.named("EL PRINT").count(), 1);
}

#[test]
fn a_sliding_femur_arrives_with_friction_only_while_it_slides() {
    let by_mm = Vec3::new(2.0, 0.0, -1.0);
    let deck = slid(by_mm);
    let steps: Vec<_> = deck
        .named("STEP")
        .map(|step| step.get("NAME").unwrap())
        .collect();
    assert_eq!(steps, ["PRESSED", "SLIDING", "SLID"]);
    let ways: Vec<Vec3> = ways_mm(&deck).collect();
    let [down, nearly, arrived] = ways[..] else {
        panic!("{ways:?}");
    };
    assert!(down.y < -0.2 && down.x == 0.0 && down.z == 0.0, "{down}");
    assert!((arrived - down - by_mm).norm() < 1e-12, "{arrived}");
    let left = arrived - nearly;
    assert!(left.cross(&by_mm).norm() < 1e-12 && (left.norm() - 0.02).abs() < 1e-12);
    let friction: Vec<f64> = deck
        .named("FRICTION")
        .map(|law| law.numbers()[0][0])
        .collect();
    assert!(friction[0] < 1e-6, "{friction:?}");
    assert_eq!(friction[1..], [0.07]);
}

/// A ball pressed on a block and slid on.
fn slid(by_mm: Vec3) -> Deck {
    let meshing = Meshing {
        edge_mm: 2.0,
        layers: 2,
    };
    let insert = flat_insert((8.0, 8.0), 4.0, meshing).unwrap();
    let femur = Counterface::sphere(24.0);
    let surface = insert.surface();
    let pressed = Pressed {
        title: "Ball on a block",
        note: "",
        bodies: Bodies {
            counterface: &femur,
            insert: &insert,
            surface: &surface,
        },
        triangles: &TriangleMesh {
            vertices: vec![
                Vec3::new(-3.0, -23.8, -3.0),
                Vec3::new(3.0, -23.8, -3.0),
                Vec3::new(0.0, -23.8, 3.0),
            ],
            triangles: vec![[0, 1, 2]],
        },
        elastic: Elastic::new(463.0, 0.46).unwrap(),
        hardening: None,
        pose: Pose::new(Mat3::identity(), Vec3::new(0.0, 23.75, 0.0)),
        slide: Some(Slide {
            by_mm,
            friction: 0.07,
        }),
    };
    let mut text = Vec::new();
    pressed.write(&mut text).unwrap();
    Deck::read(&String::from_utf8(text).unwrap())
}

#[test]
fn cases_that_cannot_be_pressed_give_the_reason() {
    let foundation = refusal(&parsed(COARSE));
    assert!(
        foundation
            .to_string()
            .contains("has an elastic foundation; write [contact] model = \"deformable\""),
        "{foundation}"
    );
    let kinematic =
        deformable("[contact.deformable]\nplasticity = \"j2\"\nkinematic_modulus_mpa = 10.0\n");
    let kinematic = refusal(&kinematic);
    assert!(
        kinematic.to_string().contains("kinematic_modulus_mpa = 10"),
        "{kinematic}"
    );
}

#[test]
fn the_insert_part_goes_through_the_reader_of_hexahedra() {
    let case = deformable("");
    let pressed = PressedCase::new(&case, 2).unwrap();
    let text = written(&pressed);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("insert.inp");
    fs::write(&path, &text[..text.find("** FEMUR").unwrap()]).unwrap();
    let file = read_hexahedra(&Disk, &path).unwrap();
    assert_eq!(file.mesh, hexahedra(&Deck::read(&text)));
    let insert = pressed.unworn().insert();
    let mut quads = insert.surface_faces().to_vec();
    for quad in &mut quads {
        *quad = quad.map(|i| insert.surface_nodes()[i as usize]);
    }
    let sorted = |mut quads: Vec<[u32; 4]>| {
        quads.iter_mut().for_each(|quad| quad.sort_unstable());
        quads.sort_unstable();
        quads
    };
    let read = file.surface("ARTICULATING").unwrap().quads.clone();
    assert_eq!(sorted(read), sorted(quads));
}

#[test]
fn cases_that_do_not_build_give_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.stl"),
        "solid nothing\nendsolid nothing\n",
    )
    .unwrap();
    let model = "[contact]\nmodel = \"deformable\"\n";
    let file = format!("{model}[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\n");
    let broken = refusal(&read(&file, folder.path()));
    assert!(broken.to_string().contains("a.stl"), "{broken}");
    assert!(matches!(broken, ExportError::Build(_)));
    let aside = "[femur]\nshape = \"sphere\"\nstart_mm = [90.0, 0.0]\n";
    let apart = refusal(&deformable(aside));
    assert!(apart.to_string().contains("are apart"), "{apart}");
    assert!(matches!(apart, ExportError::Placement(_)));
}

/// A disk that is full.
struct Full;

impl io::Write for Full {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::Error::other("no space left"))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_reported() {
    let case = deformable("");
    let pressed = PressedCase::new(&case, 1).unwrap();
    let error = pressed.write(PERCENT, &mut Full).unwrap_err();
    let expected =
        "the exported file cannot be written: no space left; check the disk and the folder";
    assert_eq!(error.to_string(), expected);
}
