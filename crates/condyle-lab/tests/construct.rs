//! An insert in one with its tray and stem wears as it does alone.

use std::{collections::BTreeMap, fmt::Write, fs, ops::ControlFlow, path::Path};

use condyle::{
    Vec3,
    evolve::March,
    geometry::{GenericInsertShape, Meshing, TriangleMesh},
};
use condyle_case::case::{BuildError, BuildWarning, Built, Case};
use condyle_mesh::files::Disk;
use condyle_mesh::formats::read_surface;
use condyle_mesh::repair::{Checks, Parts, Touching};
use tempfile::TempDir;

const SHORT: &str = "[march]\ncycles = 500_000\nupdates = 1\n[time]\nincrements = 40\n";
const GENERIC: &str = "[insert]\nshape = \"mesh\"\nfile = \"insert.obj\"\nedge_mm = 2.0\n";

/// A plate that is larger than the underside by so much, as a share of it, and its thickness, mm.
const PLATE: (f64, f64) = (1.06, 4.0);
const STEM_MM: f64 = 40.0;

fn generic() -> TriangleMesh {
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: 1,
    };
    let insert = GenericInsertShape::default().insert(meshing).unwrap();
    let mesh = insert.mesh();
    TriangleMesh::of_quads(mesh.nodes.clone(), mesh.boundary_quads())
}

/// The tray and stem of an insert as shells of their own, which reach a little into it.
fn with_shells_below(insert: &TriangleMesh) -> TriangleMesh {
    let (low, high) = insert.bounds();
    let tray = TriangleMesh::block(
        Vec3::new(low.x - 2.0, low.y - 4.0, low.z - 2.0),
        Vec3::new(high.x + 2.0, low.y + 0.3, high.z + 2.0),
    );
    let stem = TriangleMesh::block(
        Vec3::new(-6.0, low.y - STEM_MM, -6.0),
        Vec3::new(6.0, low.y - 3.5, 6.0),
    );
    tray.joined(insert).joined(&stem)
}

/// One closed surface around an insert, cut at a height, and a plate and stem that have grown together with it there.
fn grown_together(insert: TriangleMesh, height_mm: f64, scale: f64) -> TriangleMesh {
    let checks = Checks {
        touching: Touching::FromAbove,
        parts: Parts::All,
        clip_below_mm: Some(height_mm),
    };
    let mut body = checks.check(insert).unwrap().mesh;
    let mut loops = opened(&mut body, height_mm);
    loops.sort_by(|a, b| span(&body, a).total_cmp(&span(&body, b)));
    let outline = loops.pop().unwrap();
    // The plate closes the recesses in the underside.
    for around in &loops {
        close(&mut body, around, height_mm);
    }
    let places: Vec<Vec3> = outline.iter().map(|&n| body.vertices[n as usize]).collect();
    let middle = places.iter().sum::<Vec3>() / places.len() as f64;
    let below_mm = height_mm - PLATE.1;
    let rings = [
        (scale, height_mm),
        (scale, below_mm),
        (0.2, below_mm),
        (0.2, below_mm - STEM_MM),
    ];
    let mut above = outline;
    for (scale, y) in rings.into_iter().filter(|ring| *ring != (1.0, height_mm)) {
        let first = body.vertices.len() as u32;
        body.vertices.extend(places.iter().map(|at| {
            let at = middle + (at - middle) * scale;
            Vec3::new(at.x, y, at.z)
        }));
        let below: Vec<u32> = (first..body.vertices.len() as u32).collect();
        for n in 0..above.len() {
            let after = (n + 1) % above.len();
            let [a, b, c, d] = [above[n], below[n], below[after], above[after]];
            body.triangles.extend([[a, b, c], [a, c, d]]);
        }
        above = below;
    }
    close(&mut body, &above, below_mm - STEM_MM);
    body
}

/// Takes away the triangles at a height; gives the lines around them.
fn opened(body: &mut TriangleMesh, height_mm: f64) -> Vec<Vec<u32>> {
    let heights: Vec<f64> = body.vertices.iter().map(|vertex| vertex.y).collect();
    let is_there = |n: &u32| (heights[*n as usize] - height_mm).abs() < 1e-9;
    body.triangles
        .retain(|triangle| !triangle.iter().all(is_there));
    let sides = |&[a, b, c]: &[u32; 3]| [(a, b), (b, c), (c, a)];
    let on_cut = body.triangles.iter().flat_map(sides);
    let mut next: BTreeMap<u32, u32> = on_cut.filter(|(a, b)| is_there(a) && is_there(b)).collect();
    let mut loops = Vec::new();
    while let Some((start, mut at)) = next.pop_first() {
        let mut around = vec![start];
        while at != start {
            around.push(at);
            at = next.remove(&at).expect("the line closes");
        }
        loops.push(around);
    }
    loops
}

fn span(body: &TriangleMesh, around: &[u32]) -> f64 {
    let along = around.iter().map(|&n| body.vertices[n as usize].z);
    let (low, high) = along.fold((f64::MAX, f64::MIN), |(low, high), z| {
        (low.min(z), high.max(z))
    });
    high - low
}

/// A fan of triangles over a line.
fn close(body: &mut TriangleMesh, around: &[u32], y: f64) {
    let sum: Vec3 = around.iter().map(|&n| body.vertices[n as usize]).sum();
    let middle = sum / around.len() as f64;
    let tip = body.vertices.len() as u32;
    body.vertices.push(Vec3::new(middle.x, y, middle.z));
    let next = around.iter().cycle().skip(1);
    body.triangles
        .extend(around.iter().zip(next).map(|(&a, &b)| [a, tip, b]));
}

/// A mesh as an OBJ file, to the last digit.
fn save(folder: &TempDir, mesh: &TriangleMesh) {
    let mut text = String::new();
    for v in &mesh.vertices {
        writeln!(text, "v {:?} {:?} {:?}", v.x, v.y, v.z).unwrap();
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|vertex| vertex + 1)) {
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    fs::write(folder.path().join("insert.obj"), text).unwrap();
}

fn built(text: &str, insert: &TriangleMesh) -> Result<Built, BuildError> {
    let folder = tempfile::tempdir().unwrap();
    save(&folder, insert);
    let text = format!("{text}{SHORT}");
    let case = Case::parse(&text, "case.toml", folder.path());
    case.unwrap_or_else(|error| panic!("{error}")).build(2)
}

/// Mass worn and deepest wear of a short march.
fn worn(built: Built) -> [f64; 2] {
    let mut march = March::start(built.test).unwrap();
    assert!(
        march
            .update(&mut |_| ControlFlow::Continue(()))
            .unwrap()
            .is_continue()
    );
    let last = march.state().updates.last().unwrap();
    [last.volume_loss_mm3, last.max_depth_mm]
}

fn unwrapped(built: Result<Built, BuildError>) -> Built {
    built.unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn assert_equal(fused: [f64; 2], alone: [f64; 2]) {
    for (fused, alone) in fused.into_iter().zip(alone) {
        assert!((fused / alone - 1.0).abs() < 0.01, "{fused} {alone}");
    }
}

/// As one closed surface with a tray that begins at a height, in a case with `text` before its march.
fn assert_wears_as_alone_in_one_surface(text: &str, insert: &TriangleMesh, height_mm: f64) {
    let alone = worn(unwrapped(built(text, insert)));
    let construct = grown_together(insert.clone(), height_mm, PLATE.0);
    let fused = unwrapped(built(text, &construct));
    let is_told = |warning: &BuildWarning| {
        let text = warning.to_string();
        let cut = text.split_once("cut at the ledge at y = ");
        let cut = cut.and_then(|(_, after)| after.split(' ').next()?.parse::<f64>().ok());
        cut.is_some_and(|cut| (cut - height_mm).abs() < 0.011)
    };
    assert!(fused.warnings.iter().any(is_told), "{:?}", fused.warnings);
    assert_equal(worn(fused), alone);
}

/// As one of three shells in a file.
fn assert_wears_as_alone_among_shells(text: &str, insert: &TriangleMesh) {
    let alone = worn(unwrapped(built(text, insert)));
    let shells = unwrapped(built(text, &with_shells_below(insert)));
    let is_told = |warning: &BuildWarning| {
        let text = warning.to_string();
        text.contains("removed, since they are not part")
            && text.matches(" triangles ").count() == 2
    };
    assert!(shells.warnings.iter().any(is_told), "{:?}", shells.warnings);
    assert_equal(worn(shells), alone);
}

#[test]
fn the_generic_insert_on_its_tray() {
    assert_wears_as_alone_in_one_surface(GENERIC, &generic(), -9.0);
    assert_wears_as_alone_among_shells(GENERIC, &generic());
}

#[test]
fn a_tray_that_shows_no_ledge_is_an_error_with_the_heights_to_write() {
    let fused = grown_together(generic(), -9.0, 1.0);
    let error = built(GENERIC, &fused).err().unwrap();
    let said = error.to_string();
    assert!(
        said.contains("does not show for certain where the polyethylene ends"),
        "{said}"
    );
    assert!(
        said.contains("clip_below_mm = -9.00 where it stands on a plate"),
        "{said}"
    );
    assert!(said.contains("or clip_below_mm = -13.00,"), "{said}");
    let given = format!("{GENERIC}clip_below_mm = -9.0\n");
    let alone = worn(unwrapped(built(GENERIC, &generic())));
    assert_equal(worn(unwrapped(built(&given, &fused))), alone);
}

/// A shipped case whose insert stands in a file of its own, x anterior, y superior, z right, mm.
fn shipped(
    name: &str,
    file: &str,
    place: impl Fn(&Vec3) -> Vec3,
) -> Option<(String, TriangleMesh)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let path = root.join("../shared/data").join(file);
    if !path.is_file() {
        eprintln!("skipped: shared/data/{file} is not there");
        return None;
    }
    let data = path.parent()?.parent()?.canonicalize().unwrap();
    let text = fs::read_to_string(root.join("cases").join(name)).unwrap();
    let text = text.replace("../../shared/data", &data.to_string_lossy());
    let (head, rest) = text.split_once("[insert]").unwrap();
    let (_, rest) = rest.split_once("[contact]").unwrap();
    let (rest, _) = rest.split_once("[march]").unwrap();
    let text = format!("{head}{GENERIC}[contact]{rest}");
    Some((text, read_surface(&Disk, path).unwrap().mapped(place)))
}

#[test]
fn the_implant_of_subject_dm_on_a_tray() {
    let place = |at: &Vec3| Vec3::new(-at.x, at.y, -at.z) * 1000.0;
    if let Some((text, insert)) = shipped("dm-knee.toml", "dm-knee/tibial-insert.stl", place) {
        assert_wears_as_alone_among_shells(&text, &insert);
    }
}

#[test]
fn a_conforming_implant_on_a_tray() {
    let place = |at: &Vec3| Vec3::new(at.y, at.z, at.x) * 1000.0;
    let file = "cams-knee/tibia_inlay_JWI_meters.stl";
    if let Some((text, insert)) = shipped("cams-knee.toml", file, place) {
        assert_wears_as_alone_among_shells(&text, &insert);
    }
}
