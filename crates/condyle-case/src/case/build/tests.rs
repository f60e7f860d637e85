//! Cases that are built, and cases that cannot be.

use std::fs::{self, File};
use std::path::Path;

use condyle::Vec3;
use condyle::evolve::Schedule;
use condyle::geometry::{Counterface, GenericFemur, GenericFemurShape, SmoothField, TriangleMesh};
use condyle::machine::Drive;
use tempfile::TempDir;

use super::assemble::Built;
use super::error::{Body, BuildError};
use super::placing::{Placing, checks_of, shell};
use crate::cache::Cache;
use crate::case::tests::{cases, has_dm_data};
use crate::case::{Case, FemurShape, InsertShape, SharedBodies, Side};
use condyle_mesh::formats::write_stl;

fn built(text: &str, folder: &Path) -> Result<Built, BuildError> {
    let case = Case::parse(text, "case.toml", folder).unwrap_or_else(|error| panic!("{error}"));
    case.build(1)
}

fn refusal(text: &str, folder: &Path) -> String {
    match built(text, folder) {
        Ok(_) => panic!("this builds:\n{text}"),
        Err(error) => error.to_string(),
    }
}

fn with_stl(name: &str, mesh: &TriangleMesh) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_stl(File::create(folder.path().join(name)).unwrap(), mesh).unwrap();
    folder
}

#[test]
fn a_load_cell_that_reads_a_little_below_zero_does_not_lift_the_femur() {
    let knots = "[machine.axial_force]\nknots_n = [[0, 2000], [40, -4], [60, -4]]\n";
    let test = built(knots, Path::new("")).unwrap().test;
    let machine = test.machine();
    let drive = &machine.joint(machine.pressing_joint().unwrap()).drive;
    let Drive::Loaded(load) = drive else {
        panic!("{drive:?}")
    };
    assert_eq!(load.range(), [-2000.0, 0.0]);
}

#[test]
fn the_generic_femur_ends_behind() {
    let flexed = |deg: u32| {
        format!(
            "[machine]\nflexion_offset_deg = 0.0\n[machine.flexion]\nknots_deg = [[0, 0], [50, {deg}]]\n"
        )
    };
    assert!(built(&flexed(134), Path::new("")).is_ok());
    let why = "beyond 135 degrees of flexion, and flexion reaches 148 degrees";
    let refusal = refusal(&flexed(148), Path::new(""));
    assert!(refusal.contains(why), "{refusal}");
}

/// A closed block of 20 by 8 by 30 mm on y = 0.
fn block() -> TriangleMesh {
    let corner = |i: usize| {
        let at = |axis: usize, low: f64, high: f64| if i >> axis & 1 == 0 { low } else { high };
        Vec3::new(at(0, -10.0, 10.0), at(1, 0.0, 8.0), at(2, -15.0, 15.0))
    };
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    TriangleMesh::of_quads((0..8).map(corner).collect(), quads)
}

const MESH_INSERT: &str = "[insert]\nshape = \"mesh\"\nfile = \"a.stl\"\nedge_mm = 1.0\n";

#[test]
fn the_axes_of_a_disc_pass_through_its_ball_or_socket_wherever_that_is() {
    // A cap of 14 mm below a plate, and a socket of 14 mm in the underside of a block.
    let arc = (0..=10).map(|n| (4.5 * f64::from(n)).to_radians());
    let cap = arc.map(|angle| (14.0 * angle.sin(), -14.0 * angle.cos()));
    let below = -14.0 * 45f64.to_radians().cos();
    let ball: Vec<(f64, f64)> = cap
        .clone()
        .chain([(16.0, below), (16.0, below + 4.0), (1e-6, below + 4.0)])
        .collect();
    let up = cap.map(|(x, y)| (x, -y)).collect::<Vec<_>>();
    let socket: Vec<(f64, f64)> = [(1e-6, 20.0), (16.0, 20.0), (16.0, -below)]
        .into_iter()
        .chain(up.into_iter().rev())
        .collect();
    let case = "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\n[insert]\nshape = \"flat\"\nedge_mm = 4.0\nlayers = 1\n\
                [machine]\npreset = \"iso-18192-1-lumbar-like\"\n";
    for profile in [ball, socket] {
        let body = TriangleMesh::revolved(&profile, 48);
        let place = Vec3::new(7.0, 9.0, 3.0);
        let folder = with_stl("a.stl", &body.mapped(|vertex| vertex + place));
        let off = built(case, folder.path()).unwrap();
        let (x, y) = off.test.flexion_axis_mm;
        assert!((x - 7.0).abs() < 1e-3 && (y - 9.0).abs() < 1e-3, "{x} {y}");
        let said: Vec<String> = off.warnings.iter().map(ToString::to_string).collect();
        let said = said.join("\n");
        assert!(said.contains("is 3.00 mm off the plane z = 0"), "{said}");
        let line = said.split("write ").nth(1).unwrap().lines().next().unwrap();
        assert_eq!(line, "origin_mm = [7.000, 9.000, 3.000]");
        let moved = built(
            &case.replace("[insert]", &format!("{line}\n[insert]")),
            folder.path(),
        )
        .unwrap();
        let (x, y) = moved.test.flexion_axis_mm;
        assert!(x.abs() < 1e-3 && y.abs() < 1e-3, "{x} {y}");
        let said: Vec<String> = moved.warnings.iter().map(ToString::to_string).collect();
        assert!(!said.join("").contains("off the plane"), "{said:?}");
    }
}

#[test]
fn shipped_generic_cases_build() {
    for name in ["stanmore-force.toml", "stanmore-displacement.toml"] {
        let built = Case::read(&cases().join(name)).unwrap().build(1).unwrap();
        assert!(built.warnings.is_empty());
        assert!((11_900..12_400).contains(&built.test.insert.mesh().hexes.len()));
        assert_eq!(built.test.schedule, Schedule::fixed(5e6, 10));
    }
}

#[test]
fn dm_cases_build_and_lie_the_right_way_round() {
    if !has_dm_data("dm_cases_build_and_lie_the_right_way_round") {
        return;
    }
    let case = Case::read(&cases().join("dm-knee-displacement.toml")).unwrap();
    let test = case.build(2).unwrap().test;
    assert_eq!(
        (test.flexion_axis_mm, test.start_mm),
        ((0.0, 0.0), (7.4, 1.0))
    );
    let thickness = test.insert.thickness_mm().iter().copied();
    let thinnest = thickness.fold(f64::INFINITY, f64::min);
    // The rim rests on the tray by a ledge at 3.94 mm, and is 5.8 mm high.
    assert!((1.8..2.0).contains(&thinnest), "{thinnest}");
    let FemurShape::Mesh(femur) = &case.femur.shape else {
        panic!("it is a mesh");
    };
    let placing = Placing::new(&femur.frame, femur.origin_mm, Side::Right).unwrap();
    let shell = shell(
        &femur.file,
        &placing,
        checks_of(Body::Femur, None),
        &mut Vec::new(),
    )
    .unwrap();
    let (low, high) = shell.mesh.bounds();
    let (x, y) = condyle::geometry::FittedArc::posterior(&shell.mesh).centre_mm;
    // The posterior condyles lie behind, and the flexion axis inside them.
    assert!(
        low.x < x && x < 0.0 && low.y < y && y < high.y,
        "{x} {y} {low} {high}"
    );
}

#[test]
fn the_hexahedra_of_real_inserts_are_sound_whatever_their_edge() {
    if !has_dm_data("the_hexahedra_of_real_inserts_are_sound_whatever_their_edge") {
        return;
    }
    let (dm, cams) = ([2.1, 1.4, 1.05, 0.7, 0.5], [1.4, 1.05, 0.7]);
    for (name, edges_mm) in [("dm-knee.toml", &dm[..]), ("cams-knee.toml", &cams)] {
        for &edge_mm in edges_mm {
            let mut case = Case::read(&cases().join(name)).unwrap();
            let InsertShape::Mesh(insert) = &mut case.insert.shape else {
                panic!("it is a mesh");
            };
            insert.edge_mm = edge_mm;
            let built = case.built_insert(&case.insert, &mut Vec::new()).unwrap();
            let quality = built.mesh().worst_quality();
            assert!(quality >= 0.2, "{name} at {edge_mm} mm: {quality}");
        }
    }
}

#[test]
fn a_speck_near_the_insert_is_left_out_with_its_place() {
    let mut mesh = block();
    let first = mesh.vertices.len() as u32;
    let speck = block().mapped(|v| Vec3::new(12.0, 3.0, 0.0) + v * 0.1);
    mesh.vertices.extend(&speck.vertices);
    let shifted = speck
        .triangles
        .iter()
        .map(|t| t.map(|vertex| vertex + first));
    mesh.triangles.extend(shifted);
    let folder = with_stl("a.stl", &mesh);
    let built = built(MESH_INSERT, folder.path()).unwrap();
    let said = built.warnings.iter().map(ToString::to_string);
    let said: Vec<String> = said
        .filter(|said| said.contains("removed, since they are not part"))
        .collect();
    assert_eq!(said.len(), 1, "{:?}", built.warnings);
    assert!(
        said[0].contains("12 triangles next to it around (12.0, 3.4, 0.0) mm"),
        "{}",
        said[0]
    );
    let nodes = &built.test.insert.mesh().nodes;
    assert!(nodes.iter().all(|node| node.x < 10.5));
}

/// A case with a femur of triangles that came inside-out.
fn with_mesh_femur(folder: &TempDir, side: &str) -> Case {
    let mut mesh = GenericFemur::new(GenericFemurShape::default()).surface_mesh(3.0);
    mesh.triangles
        .iter_mut()
        .for_each(|corners| corners.swap(0, 1));
    write_stl(File::create(folder.path().join("f.stl")).unwrap(), &mesh).unwrap();
    let femur = "[femur]\nshape = \"mesh\"\nfile = \"f.stl\"\n";
    let text = format!("side = \"{side}\"\n{femur}");
    Case::parse(&text, "case.toml", folder.path()).unwrap_or_else(|error| panic!("{error}"))
}

fn field(built: &Built) -> &SmoothField {
    match built.test.counterface.as_ref() {
        Counterface::Mesh(field) => field,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_femur_kept_is_the_one_computed_with_its_warnings() {
    let (folder, kept) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (case, cache) = (
        with_mesh_femur(&folder, "right"),
        Cache::in_folder(kept.path()),
    );
    let build = |case: &Case| {
        let built = case.build_sharing(1, &cache, &SharedBodies::default());
        built.unwrap()
    };
    let computed = case.build(1).unwrap();
    assert_eq!(computed.warnings.len(), 1, "{:?}", computed.warnings);
    for _ in 0..2 {
        let built = build(&case);
        assert!(field(&built) == field(&computed));
        assert_eq!(built.warnings, computed.warnings);
        assert_eq!(built.test.start_mm, computed.test.start_mm);
        assert_eq!(built.test.flexion_axis_mm, computed.test.flexion_axis_mm);
    }
    let count = || fs::read_dir(kept.path()).unwrap().count();
    assert_eq!(count(), 1);
    // The same file on the other side is another femur.
    let left = build(&with_mesh_femur(&folder, "left"));
    assert!(field(&left) != field(&computed) && count() == 2);
}

#[test]
fn closed_mesh_in_another_unit_becomes_an_insert() {
    let small = block().mapped(|vertex| vertex / 1000.0);
    let folder = with_stl("a.stl", &small);
    let text = format!("{MESH_INSERT}length_unit = \"m\"\n");
    let insert = built(&text, folder.path()).unwrap().test.insert;
    // Rounding to single precision may cost the outermost row of columns.
    assert!((4200.0..4801.0).contains(&insert.mesh().volume()));
}

#[test]
fn inside_out_mesh_is_reversed_with_a_warning() {
    let mut inside_out = block();
    inside_out
        .triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(0, 1));
    let folder = with_stl("a.stl", &inside_out);
    let built = built(MESH_INSERT, folder.path()).unwrap();
    let warning = built.warnings[0].to_string();
    assert!(warning.ends_with("a.stl: the triangles faced inwards and were reversed"));
    assert!((built.test.insert.mesh().volume() - 4800.0).abs() < 1.0);
}

#[test]
fn one_reversed_triangle_is_corrected_with_a_warning() {
    let mut odd = block();
    odd.triangles[3].swap(0, 1);
    let folder = with_stl("a.stl", &odd);
    let built = built(MESH_INSERT, folder.path()).unwrap();
    let warning = built.warnings[0].to_string();
    assert!(warning.ends_with("1 triangles were reversed to match their neighbours"));
}

#[test]
fn open_insert_needs_a_thickness_and_a_closed_one_has_its_own() {
    let mut top = block();
    top.triangles
        .retain(|triangle| triangle.iter().all(|&vertex| vertex & 2 != 0));
    let folder = with_stl("a.stl", &top);
    let shown = refusal(MESH_INSERT, folder.path());
    assert!(
        shown.contains("a.stl: ") && shown.contains("give thickness_mm"),
        "{shown}"
    );
    let given = format!("{MESH_INSERT}thickness_mm = 9.0\n");
    let insert = built(&given, folder.path()).unwrap().test.insert;
    assert!((insert.mesh().volume() - 20.0 * 30.0 * 9.0).abs() < 1.0);
    let shown = refusal(&given, with_stl("a.stl", &block()).path());
    assert!(shown.contains("remove [insert] `thickness_mm`"), "{shown}");
}

#[test]
fn mesh_that_is_no_shell_or_no_mesh_names_its_file() {
    let mut doubled = block();
    doubled.triangles.push([0, 1, 7]);
    let shown = refusal(MESH_INSERT, with_stl("a.stl", &doubled).path());
    assert!(
        shown.contains("a.stl: the surface is not sound where bodies can touch: 1 edge of three"),
        "{shown}"
    );
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.stl"), "no mesh").unwrap();
    assert!(refusal(MESH_INSERT, folder.path()).contains("a.stl"));
}

/// One hexahedron of 10 mm with its top surface named.
const HEX: &str = "*NODE\n1, 0, 0, 0\n2, 10, 0, 0\n3, 10, 0, -10\n4, 0, 0, -10\n5, 0, 10, 0\n\
    6, 10, 10, 0\n7, 10, 10, -10\n8, 0, 10, -10\n*ELEMENT, TYPE=C3D8, ELSET=ALL\n\
    1, 1, 2, 3, 4, 5, 6, 7, 8\n*SURFACE, NAME=TOP, TYPE=ELEMENT\nALL, S2\n";

#[test]
fn hexahedra_give_the_named_surface_or_the_one_above() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.inp"), HEX).unwrap();
    let text = |rest: &str| format!("{rest}\n[insert]\nshape = \"hexahedra\"\nfile = \"a.inp\"\n");
    let named = |name: &str| format!("{}articulating_surface = \"{name}\"\n", text(""));
    let found = built(&text(""), folder.path()).unwrap().test.insert;
    let given = built(&named("top"), folder.path()).unwrap().test.insert;
    assert_eq!(found.surface_nodes(), given.surface_nodes());
    assert_eq!(found.thickness_mm(), [10.0; 4]);
    let shown = refusal(&named("SIDE"), folder.path());
    assert!(
        shown.contains("no surface \"SIDE\"; its surfaces are TOP"),
        "{shown}"
    );
    let left = built(&text("side = \"left\""), folder.path())
        .unwrap()
        .test
        .insert;
    assert!((left.mesh().volume() - 1000.0).abs() < 1e-9);
    assert!(left.mesh().nodes.iter().all(|node| node.z >= 0.0));
}

/// Where a build that fails points to, as line and column.
fn place(text: &str, folder: &Path) -> Option<(usize, usize)> {
    let case = Case::parse(text, "case.toml", folder).unwrap_or_else(|error| panic!("{error}"));
    let error = case.build(1).err()?;
    case.at_its_key(&error).problems()[0].line_and_column()
}

#[test]
fn a_failed_build_points_to_the_key_at_fault() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.inp"), HEX).unwrap();
    let text = "[insert]\nshape = \"hexahedra\"\nfile = \"a.inp\"\n";
    for key in ["articulating_surface", "backside"] {
        let wrong = format!("{text}{key} = \"SIDE\"\n");
        assert_eq!(place(&wrong, folder.path()), Some((4, key.len() + 4)));
    }
    let upside_down = format!("{text}backside = \"TOP\"\n");
    assert_eq!(place(&upside_down, folder.path()), Some((4, 12)));
    fs::write(folder.path().join("b.stl"), "no mesh").unwrap();
    let femur = format!("{text}[femur]\nshape = \"mesh\"\nfile = \"b.stl\"\n");
    assert_eq!(place(&femur, folder.path()), Some((6, 8)));
}

#[test]
fn hexahedra_upside_down_make_no_insert() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.inp"), HEX).unwrap();
    let text = "[insert]\nshape = \"hexahedra\"\nfile = \"a.inp\"\nbackside = \"TOP\"\n";
    assert!(refusal(text, folder.path()).contains("the insert cannot be used: "));
}

#[test]
fn an_articulating_surface_that_faces_down_is_refused_with_its_key() {
    let folder = tempfile::tempdir().unwrap();
    let both = format!("{HEX}*SURFACE, NAME=BOTTOM, TYPE=ELEMENT\nALL, S1\n");
    fs::write(folder.path().join("a.inp"), both).unwrap();
    let text = "[insert]\nshape = \"hexahedra\"\nfile = \"a.inp\"\n";
    let exchanged = format!("{text}articulating_surface = \"BOTTOM\"\nbackside = \"TOP\"\n");
    assert!(refusal(&exchanged, folder.path()).contains("\"BOTTOM\" faces down"));
    assert_eq!(place(&exchanged, folder.path()), Some((4, 24)));
    let upside_down = format!(
        "{text}articulating_surface = \"TOP\"\naxes = [\"anterior\", \"inferior\", \"left\"]\n"
    );
    assert!(refusal(&upside_down, folder.path()).contains("\"TOP\" faces down"));
}

#[test]
fn open_femur_that_faces_up_is_turned_to_face_down() {
    let mut condyles = GenericFemur::new(GenericFemurShape::default()).surface_mesh(3.0);
    condyles
        .triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(0, 1));
    let folder = with_stl("a.stl", &condyles);
    let built = built(
        "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\n",
        folder.path(),
    )
    .unwrap();
    assert_eq!(built.warnings.len(), 1);
    assert!(built.test.counterface.gap_mm(&Vec3::new(5.4, -23.5, 23.0)) > 0.0);
    let (x, y) = built.test.flexion_axis_mm;
    assert!(x.abs() < 0.5 && y.abs() < 0.5, "{x} {y}");
}

/// A block and another one, `away_mm` further along z.
fn two_blocks(away_mm: f64) -> TriangleMesh {
    let mut mesh = block();
    let other = block().mapped(|vertex| vertex / 3.0 + Vec3::new(0.0, 0.0, away_mm));
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(other.vertices);
    let triangles = other.triangles.iter();
    let moved = triangles.map(|corners| corners.map(|corner| first + corner));
    mesh.triangles.extend(moved.collect::<Vec<_>>());
    mesh
}

#[test]
fn a_body_of_the_wrong_size_is_refused_with_the_unit_to_write() {
    let folder = with_stl("a.stl", &block());
    let said = |unit: &str| {
        let unit = format!("{MESH_INSERT}length_unit = \"{unit}\"\n");
        let said = refusal(&unit, folder.path());
        said.split_once("a.stl: ").unwrap().1.to_owned()
    };
    assert_eq!(
        said("m"),
        "the body is 30000.0 mm long, and an implant's is 5 mm to 500 mm; \
         write length_unit = \"mm\", with which it is 30.0 mm long"
    );
    assert!(said("in").contains("the body is 762.0 mm long"));
    let in_metres = with_stl("a.stl", &block().mapped(|vertex| vertex / 1000.0));
    let small = refusal(MESH_INSERT, in_metres.path());
    assert!(
        small.contains("the body is 3.00e-2 mm long") && small.contains("length_unit = \"m\""),
        "{small}"
    );
    let shell_of_femur = "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\nlength_unit = \"m\"\n";
    assert!(refusal(shell_of_femur, folder.path()).contains("the body is 30000.0 mm"));
    let odd = with_stl("a.stl", &block().mapped(|vertex| vertex * 1e6));
    let said = refusal(MESH_INSERT, odd.path());
    assert!(
        said.ends_with("5 mm to 500 mm; check length_unit and the mesh"),
        "{said}"
    );
}

#[test]
fn hexahedra_of_the_wrong_size_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let node = |i: usize| {
        let at = |axis: usize| if i >> axis & 1 == 0 { 0 } else { 10_000_000 };
        format!("{}, {}, {}, {}\n", i + 1, at(0), at(1), at(2))
    };
    let nodes: String = (0..8).map(node).collect();
    let deck = format!("*NODE\n{nodes}*ELEMENT, TYPE=C3D8\n1, 1, 2, 4, 3, 5, 6, 8, 7\n");
    fs::write(folder.path().join("a.inp"), deck).unwrap();
    let text = "[insert]\nshape = \"hexahedra\"\nfile = \"a.inp\"\n";
    let said = refusal(text, folder.path());
    assert!(said.contains("the body is 1.00e7 mm long"), "{said}");
}

#[test]
fn a_piece_far_from_the_body_is_warned_of_and_one_too_far_refused() {
    let near = with_stl("a.stl", &two_blocks(100.0));
    let warnings = built(MESH_INSERT, near.path()).unwrap().warnings;
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}");
    };
    let warning = warning.to_string();
    assert!(
        warning.ends_with(
            "a.stl: a piece of 12 triangles at (0, 1, 100) mm lies 80 mm from the body; \
             delete it unless it belongs to the body"
        ),
        "{warning}"
    );
    let far = with_stl("a.stl", &two_blocks(1e5));
    let said = refusal(MESH_INSERT, far.path());
    assert!(
        said.ends_with(
            "(0, 1, 100000) mm lies 99980 mm from the body, too far to be part of a knee; delete it"
        ),
        "{said}"
    );
    let near = with_stl("a.stl", &two_blocks(25.0));
    let centred = format!("{MESH_INSERT}origin = \"centre\"\n");
    assert_eq!(built(&centred, near.path()).unwrap().warnings, []);
}

#[test]
fn more_nodes_than_memory_should_hold_are_refused() {
    let large = block().mapped(|vertex| Vec3::new(vertex.x * 16.0, vertex.y, vertex.z * 16.0));
    let folder = with_stl("a.stl", &large);
    let fine = MESH_INSERT.replace("edge_mm = 1.0", "edge_mm = 0.1\nlayers = 40");
    let said = refusal(&fine, folder.path());
    assert!(
        said.contains("the insert would have 630088041 nodes") && said.contains("a larger edge_mm"),
        "{said}"
    );
    let cube =
        block().mapped(|vertex| Vec3::new(vertex.x * 24.0, vertex.y * 60.0, vertex.z * 16.0));
    let folder = with_stl("a.stl", &cube);
    let femur = "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\n";
    let said = refusal(femur, folder.path());
    assert!(
        said.contains("the distance field would have 61629875 nodes, and more than 38461538"),
        "{said}"
    );
}

#[test]
fn an_origin_off_the_dishes_is_reported_and_centred() {
    let off = block().mapped(|vertex| vertex + Vec3::new(0.0, 3.0, 5.0));
    let folder = with_stl("a.stl", &off);
    let warnings = built(MESH_INSERT, folder.path()).unwrap().warnings;
    let warning = warnings[0].to_string();
    for words in [
        "a.stl: the middle of the dishes is",
        "and 5.0 mm lateral of the origin",
        "2.5 mm to a side",
        "write origin = \"centre\" in [insert]",
    ] {
        assert!(warning.contains(words), "{warning}");
    }
    let centred = format!("{MESH_INSERT}origin = \"centre\"\n");
    let built = built(&centred, folder.path()).unwrap();
    assert_eq!(built.warnings, []);
    let (low, high) = (-15.0, 15.0);
    for node in &built.test.insert.mesh().nodes {
        assert!(
            (low - 1e-6..high + 1e-6).contains(&node.z) && node.y < 1e-6,
            "{node}"
        );
    }
}

#[test]
fn placement_of_a_shape_that_has_none_is_idle() {
    let said = |text: &str| match Case::parse(text, "case.toml", Path::new("")) {
        Ok(_) => panic!("this is a good case:\n{text}"),
        Err(error) => error.to_string(),
    };
    let ball = said("[femur]\nshape = \"sphere\"\nvarus_deg = 1.0\n");
    assert!(ball.contains("`varus_deg` has no effect here"), "{ball}");
    let flat = said("[insert]\nshape = \"flat\"\nposterior_slope_deg = 1.0\n");
    assert!(
        flat.contains("`posterior_slope_deg` has no effect here"),
        "{flat}"
    );
}
/// The block with a peg through its underside, which crosses it.
fn block_on_a_peg() -> TriangleMesh {
    let mut mesh = block();
    let peg = block().mapped(|at| Vec3::new(at.x / 5.0, at.y * 1.5 - 8.0, at.z / 5.0));
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(peg.vertices);
    let triangles = peg.triangles.iter();
    let moved: Vec<_> = triangles
        .map(|corners| corners.map(|corner| first + corner))
        .collect();
    mesh.triangles.extend(moved);
    mesh
}

#[test]
fn defects_of_a_left_knee_are_at_their_places_in_the_file() {
    let off_middle = block_on_a_peg().mapped(|at| Vec3::new(at.x, at.y, at.z + 4.0));
    let folder = with_stl("a.stl", &off_middle);
    for side in ["right", "left"] {
        let axes = "axes = [\"anterior\", \"superior\", \"right\"]\n";
        let built = built(
            &format!("side = \"{side}\"\n{MESH_INSERT}{axes}"),
            folder.path(),
        );
        let warning = built.unwrap().warnings[0].to_string();
        assert!(
            warning.contains(" that cross (left) at (2.00, 0.00, "),
            "{warning}"
        );
        assert!(
            warning.contains(", (2.00, 0.00, 7.00), "),
            "{side}: {warning}"
        );
    }
}

#[test]
fn defects_without_effect_on_contact_are_one_warning() {
    let folder = with_stl("a.stl", &block_on_a_peg());
    let built = built(MESH_INSERT, folder.path()).unwrap();
    let [warning] = &built.warnings[..] else {
        panic!("{:?}", built.warnings);
    };
    let warning = warning.to_string();
    assert!(
        warning.starts_with("a.stl: defects that do not affect the contact: ")
            && warning.contains(" pairs of triangles that cross (left) at (")
            && warning.contains(" more"),
        "{warning}"
    );
}

#[test]
fn an_insert_fused_with_a_peg_is_cut_at_a_height() {
    let folder = with_stl("a.stl", &block_on_a_peg());
    let cut = format!("{MESH_INSERT}clip_below_mm = 6.0\n");
    let built = built(&cut, folder.path()).unwrap();
    assert_eq!(built.warnings, []);
    let volume = built.test.insert.mesh().volume();
    assert!((volume - 20.0 * 30.0 * 2.0).abs() < 1.0, "{volume}");
}

#[test]
fn a_cut_that_misses_the_body_points_to_its_key() {
    let folder = with_stl("a.stl", &block());
    let misses = format!("{MESH_INSERT}clip_below_mm = -1.0\n");
    let said = refusal(&misses, folder.path());
    assert!(
        said.ends_with(
            "a.stl: `clip_below_mm` = -1 removes nothing or everything: with its axes turned, \
             the body reaches from y = 0.00 mm to 8.00 mm"
        ),
        "{said}"
    );
    assert_eq!(place(&misses, folder.path()), Some((5, 17)));
}
