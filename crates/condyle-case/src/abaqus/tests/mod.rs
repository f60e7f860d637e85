//! Files read back by a strict reader, and held against condyle's own model.

mod balance;
mod motion;
mod pressed;
mod reader;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use condyle_fem::HexMesh;

use super::{AbaqusOptions, ExportError, write_abaqus};
use crate::case::Case;
use condyle_mesh::files::Disk;
use condyle_mesh::formats::read_hexahedra;
use reader::Deck;

/// A case that is quick to build.
const COARSE: &str = "[insert]\nshape = \"generic\"\nedge_mm = 3.0\n";

fn cases() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases")).to_owned()
}

fn parsed(text: &str) -> Case {
    Case::parse(text, "case.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

fn written(case: &Case, options: AbaqusOptions) -> String {
    let mut text = Vec::new();
    write_abaqus(case, options, 2, &mut text).unwrap_or_else(|error| panic!("{error}"));
    String::from_utf8(text).unwrap()
}

fn refusal(text: &str, folder: &Path) -> ExportError {
    let case = Case::parse(text, "case.toml", folder).unwrap_or_else(|error| panic!("{error}"));
    match write_abaqus(&case, AbaqusOptions::default(), 1, &mut Vec::new()) {
        Ok(_) => panic!("this is written:\n{text}"),
        Err(error) => error,
    }
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

fn step_names(deck: &Deck) -> Vec<&str> {
    deck.named("STEP")
        .map(|step| step.get("NAME").unwrap())
        .collect()
}

#[test]
fn the_shipped_force_case_reads_back_whole() {
    let case = Case::read(&cases().join("stanmore-force.toml")).unwrap();
    let text = written(&case, AbaqusOptions::default());
    let deck = Deck::read(&text);
    let insert = case.build(1).unwrap().test.insert;
    let mesh = hexahedra(&deck);
    assert_eq!(mesh.hexes, insert.mesh().hexes);
    assert!((mesh.volume() / insert.mesh().volume() - 1.0).abs() < 1e-9);
    let triangles = deck.element_sets["FEMUR"].len();
    assert!((24_000..=26_000).contains(&triangles), "{triangles}");
    assert_eq!(step_names(&deck), ["SETTLE", "GAIT"]);
    for name in ["FLEXION", "AXIAL-FORCE", "AP-FORCE", "IE-TORQUE"] {
        let table = &deck.amplitudes[name];
        assert!(table.len() > 200, "{name}");
        assert!((table.last().unwrap().0 - 1.0 / 1.1).abs() < 1e-12);
    }
    let deepest = deck.amplitudes["AXIAL-FORCE"].iter().map(|row| row.1);
    assert!((deepest.fold(0.0, f64::min) + 3200.0).abs() < 1.0);
    let surface = deck
        .named("SURFACE")
        .find(|s| s.get("NAME") == Some("ARTICULATING"));
    assert_eq!(surface.unwrap().rows.len(), insert.surface_faces().len());
}

#[test]
fn the_insert_part_goes_through_the_reader_of_hexahedra() {
    let text = written(&parsed(COARSE), AbaqusOptions::default());
    let deck = Deck::read(&text);
    let end = text.find("*MATERIAL").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("insert.inp");
    fs::write(&path, &text[..end]).unwrap();
    let file = read_hexahedra(&Disk, &path).unwrap();
    assert_eq!(file.mesh, hexahedra(&deck));
    let insert = parsed(COARSE).build(1).unwrap().test.insert;
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
fn every_way_to_write_it_reads_back() {
    let case = parsed(COARSE);
    for (deformable, explicit) in [(false, true), (true, false), (true, true)] {
        let text = written(
            &case,
            AbaqusOptions {
                deformable,
                explicit,
            },
        );
        let deck = Deck::read(&text);
        let kinds = |kind: &str| deck.elements.values().any(|(k, _)| k == kind);
        assert_eq!((kinds("C3D8"), kinds("C3D8R")), (deformable, !deformable));
        assert_eq!(deck.node_sets.contains_key("BACKSIDE"), deformable);
        let behavior = deck.named("SURFACE BEHAVIOR").next().unwrap();
        let hard = behavior.get("PRESSURE-OVERCLOSURE") == Some("HARD");
        assert_eq!(hard, deformable);
        let dynamic = deck
            .named("DYNAMIC")
            .all(|step| step.get("EXPLICIT").is_some());
        assert_eq!(dynamic, explicit);
        assert_eq!(text.contains("FSLIPR"), explicit);
        assert_eq!(text.contains("CDISP"), !explicit);
    }
}

#[test]
fn the_backside_of_an_elastic_insert_is_held_from_below() {
    let options = AbaqusOptions {
        deformable: true,
        explicit: false,
    };
    let deck = Deck::read(&written(&parsed(COARSE), options));
    let lowest = deck.node_sets["INSERT-NODES"]
        .iter()
        .map(|n| deck.nodes[n].y);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    let held = &deck.node_sets["BACKSIDE"];
    assert!(held.len() > 100);
    assert!(held.iter().all(|node| deck.nodes[node].y < lowest + 1.0));
}

#[test]
fn displacement_control_leads_ap_and_ie_from_where_it_settled() {
    let text = format!("{COARSE}[machine]\npreset = \"stanmore-displacement\"\n");
    let deck = Deck::read(&written(&parsed(&text), AbaqusOptions::default()));
    assert_eq!(step_names(&deck), ["SETTLE", "START", "GAIT"]);
    let first = deck.amplitudes["IE-MOTION"][0].1;
    assert!((first + 1.57f64.to_radians()).abs() < 1e-9, "{first}");
    assert!(deck.amplitudes.contains_key("AP-MOTION"));
    assert!(!deck.amplitudes.contains_key("AP-FORCE"));
    // Flexion counts from where the file begins.
    assert_eq!(deck.amplitudes["FLEXION"][0].1, 0.0);
}

#[test]
fn a_locked_freedom_is_led_to_its_place_and_held() {
    let text = format!(
        "{COARSE}[machine.freedoms.ml]\ndrive = \"locked\"\nlocked_at_mm = 1.5\n\
         [machine.freedoms.vv]\ndrive = \"locked\"\nlocked_at_deg = 0.5\n"
    );
    let text = written(&parsed(&text), AbaqusOptions::default());
    let deck = Deck::read(&text);
    assert!(text.contains("AMPLITUDE=RAMP, TYPE=DISPLACEMENT\nCARRIAGE, 3, 3, 1.5\n"));
    assert!(text.contains("AMPLITUDE=HOLD, TYPE=DISPLACEMENT\nCARRIAGE, 3, 3, 1.5\n"));
    // The file begins with VV where it is locked.
    assert!(text.contains("VV 0.500000 deg"));
    let hinge = deck.named("CONNECTOR MOTION").last().unwrap();
    assert_eq!(hinge.rows[0], ["VV-HINGE", "4", "0.0"]);
}

#[test]
fn bad_cases_say_why() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.stl"),
        "solid nothing\nendsolid nothing\n",
    )
    .unwrap();
    let broken = refusal(
        "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\n",
        folder.path(),
    );
    assert!(broken.to_string().contains("a.stl"), "{broken}");
    assert!(matches!(broken, ExportError::Build(_)));
    let aside = format!("{COARSE}[femur]\nshape = \"sphere\"\nstart_mm = [90.0, 0.0]\n");
    let apart = refusal(&aside, folder.path());
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
fn a_full_disk_says_so() {
    let error = write_abaqus(&parsed(COARSE), AbaqusOptions::default(), 1, &mut Full).unwrap_err();
    let expected =
        "the Abaqus file cannot be written: no space left; check the disk and the folder";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn a_mesh_femur_is_written_welded_in_mm() {
    let path = cases().join("dm-knee.toml");
    let data = cases().join("../../shared/data/dm-knee/femoral-component.stl");
    if !data.is_file() {
        eprintln!(
            "skipped: a_mesh_femur_is_written_welded_in_mm: the data of subject DM are not there"
        );
        return;
    }
    let deck = Deck::read(&written(
        &Case::read(&path).unwrap(),
        AbaqusOptions::default(),
    ));
    let (nodes, triangles) = (&deck.node_sets["FEMUR-NODES"], &deck.element_sets["FEMUR"]);
    assert!(
        (24_000..=24_442).contains(&triangles.len()),
        "{}",
        triangles.len()
    );
    // A closed surface has half as many vertices as triangles, and two more a handle less.
    assert!(nodes.len() < triangles.len() / 2 + 100, "{}", nodes.len());
    let heights = nodes.iter().map(|node| deck.nodes[node].y);
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), y| (l.min(y), h.max(y)));
    assert!((30.0..90.0).contains(&(high - low)), "{}", high - low);
}
