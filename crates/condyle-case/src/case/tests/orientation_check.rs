//! Orientation of bodies: warnings and errors, and the conclusions for a new case.

use std::fs::File;
use std::path::{Path, PathBuf};

use condyle::anatomy::{Orientation, Sureness};
use condyle::geometry::{
    Dishes, GenericFemur, GenericFemurShape, GenericInsertShape, Meshing, TriangleMesh,
};
use condyle::{Mat3, Vec3};
use tempfile::TempDir;

use crate::case::{Body, BuildWarning, Built, Case, Drafted, Preset, Side};
use condyle_mesh::files::Disk;
use condyle_mesh::formats::{read_surface, write_stl};

/// A femur and an insert in mm, x anterior, y superior, z right.
struct Pair {
    femur: TriangleMesh,
    insert: TriangleMesh,
}

fn generic() -> Pair {
    let (edge_mm, layers) = (1.5, 1);
    let insert = GenericInsertShape::default().insert(Meshing { edge_mm, layers });
    let insert = insert.unwrap();
    let mesh = insert.mesh();
    Pair {
        femur: GenericFemur::new(GenericFemurShape::default()).surface_mesh(1.5),
        insert: TriangleMesh::of_quads(mesh.nodes.clone(), mesh.boundary_quads()),
    }
}

/// The implant of the repository, and two that are not part of it; those that are not there are omitted by name.
fn real(test: &str) -> Vec<Pair> {
    let own = pair(test, "cases/cad-knee", "femur.stl", "insert.stl", |v| {
        Vec3::new(v.y, v.z, v.x)
    });
    assert!(own.is_some(), "the implant of the repository is there");
    own.into_iter().chain(third_party(test)).collect()
}

/// The pair in the files of a folder, turned to the axes of the insert; none, and its name, where the files are absent.
fn pair(
    test: &str,
    folder: &str,
    femur: &str,
    insert: &str,
    turn: fn(&Vec3) -> Vec3,
) -> Option<Pair> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(folder);
    let [femur, insert] = [femur, insert].map(|file| folder.join(file));
    if !(femur.is_file() && insert.is_file()) {
        eprintln!("skipped: {test}: {} is not there", femur.display());
        return None;
    }
    let [femur, insert] =
        [femur, insert].map(|file| read_surface(&Disk, file).unwrap().mapped(turn));
    Some(Pair { femur, insert })
}

/// The implants that are not part of the repository.
fn third_party(test: &str) -> Vec<Pair> {
    let dm = pair(
        test,
        "../shared/data/dm-knee",
        "femoral-component.stl",
        "tibial-insert.stl",
        |v| 1000.0 * Vec3::new(-v.x, v.y, -v.z),
    );
    let cams = pair(
        test,
        "../shared/data/cams-knee",
        "femur_implant_Mplus_JWI_meters_reduce.stl",
        "tibia_inlay_JWI_meters.stl",
        |v| 1000.0 * Vec3::new(v.y, v.z, v.x),
    );
    [dm, cams].into_iter().flatten().collect()
}

fn turned(mesh: &TriangleMesh, orientation: &Orientation) -> TriangleMesh {
    let back = orientation.rotation().transpose();
    mesh.clone().mapped(|vertex| back * vertex)
}

#[test]
fn every_wrong_orientation_of_real_bodies_is_recognised() {
    for pair in real("every_wrong_orientation") {
        for (body, mesh) in [(Body::Femur, &pair.femur), (Body::Insert, &pair.insert)] {
            for orientation in Orientation::all() {
                let recognition = body.recognise(&turned(mesh, &orientation)).unwrap();
                let is_wrong = recognition.against(&Orientation::ISB).is_some();
                assert_eq!(
                    is_wrong,
                    orientation != Orientation::ISB,
                    "{body} {orientation:?}"
                );
                assert_eq!(recognition.nearest(), orientation, "{body}");
            }
        }
    }
}

/// Vertices as a coarse scan may have them, on a grid of 2 mm, and the other side's implant.
#[test]
fn rough_and_mirrored_real_bodies_are_not_accused() {
    let snap = |v: &Vec3| v.map(|x| (x / 2.0).round() * 2.0);
    let mirror = |v: &Vec3| Vec3::new(v.x, v.y, -v.z);
    // The insert of the repository has a nearly flat underside and shallow dishes: snapped to the grid, its sides are only likely.
    for pair in third_party("rough_and_mirrored") {
        for (body, mesh) in [(Body::Femur, &pair.femur), (Body::Insert, &pair.insert)] {
            for change in [&snap as &dyn Fn(&Vec3) -> Vec3, &mirror] {
                let recognition = body.recognise(&mesh.clone().mapped(change)).unwrap();
                assert_eq!(recognition.against(&Orientation::ISB), None, "{body}");
                let upside_down = Orientation::all().filter(|one| one.rotation()[(1, 1)] < -0.5);
                for other in upside_down {
                    assert_eq!(
                        recognition.against(&other),
                        Some(Sureness::Certain),
                        "{body}"
                    );
                }
            }
        }
    }
}

/// The pair in files with axes along `orientation` and a unit of `unit_mm` mm.
fn written(pair: &Pair, orientation: &Orientation, unit_mm: f64) -> (TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, mesh: &TriangleMesh| {
        let path = folder.path().join(name);
        let mesh = turned(mesh, orientation).mapped(|vertex| vertex / unit_mm);
        write_stl(File::create(&path).unwrap(), &mesh).unwrap();
        path
    };
    let (femur, insert) = (write("f.stl", &pair.femur), write("i.stl", &pair.insert));
    (folder, femur, insert)
}

#[test]
fn a_drafted_case_builds_without_warnings_of_axes_from_any_unit_and_orientation() {
    let mut pairs = real("a_drafted_case");
    pairs.push(generic());
    let orientations: Vec<Orientation> = Orientation::all().collect();
    let units = [(1.0, "mm"), (10.0, "cm"), (1000.0, "m"), (25.4, "in")];
    for pair in &pairs {
        for (i, (unit_mm, word)) in units.into_iter().enumerate() {
            let (folder, femur, insert) = written(pair, &orientations[7 * i + 1], unit_mm);
            let meshes = [femur.as_path(), insert.as_path()];
            let drafted = Drafted::new(Preset::StanmoreForce, None, meshes, folder.path());
            let drafted = drafted.unwrap();
            let unit = format!("length_unit = \"{word}\"");
            assert_eq!(drafted.text.matches(&unit).count(), 2, "{}", drafted.text);
            assert!(
                drafted.text.contains("file = \"f.stl\""),
                "{}",
                drafted.text
            );
            let case = Case::parse(&drafted.text, "case.toml", folder.path()).unwrap();
            let built = case.build(1).unwrap();
            let of_lie = |warning: &BuildWarning| {
                let signs = [
                    " is probably oriented ",
                    "; check length_unit",
                    " knee; write side =",
                ];
                signs.iter().any(|sign| warning.to_string().contains(sign))
            };
            assert!(!built.warnings.iter().any(of_lie), "{:?}", built.warnings);
        }
    }
}

fn refused(pair: &Pair, axes: &str, unit: &str) -> String {
    let (folder, ..) = written(pair, &Orientation::ISB, 1.0);
    let keys = |file| format!("shape = \"mesh\"\nfile = \"{file}\"\nlength_unit = \"{unit}\"\n");
    let (femur, insert) = (keys("f.stl"), keys("i.stl"));
    let text = format!("[femur]\n{femur}[insert]\n{insert}axes = {axes}\nedge_mm = 3\n");
    let case = Case::parse(&text, "case.toml", folder.path()).unwrap();
    match case.build(1) {
        Ok(built) => format!("{:?}", built.warnings),
        Err(error) => case.at_its_key(&error).to_string().replace("\n  | ", " "),
    }
}

#[test]
fn a_certain_mistake_is_an_error_at_its_key_with_the_line_to_write() {
    let said = refused(&generic(), r#"["anterior", "inferior", "left"]"#, "mm");
    assert!(said.contains("lies upside down; write axes ="), "{said}");
    assert!(said.contains("case.toml:9"), "{said}");
    let said = refused(&generic(), r#"["superior", "anterior", "left"]"#, "mm");
    assert!(said.contains("lies on its side; write axes ="), "{said}");
    let said = refused(&generic(), r#"["anterior", "superior", "right"]"#, "in");
    assert!(said.contains("write length_unit = \"mm\""), "{said}");
    let said = refused(&generic(), r#"["posterior", "superior", "left"]"#, "mm");
    assert_eq!(said, "[]");
}

/// The warnings about the side of a case of a pair with `side`.
fn warned_of_side(pair: &Pair, side: &str) -> Vec<BuildWarning> {
    let (folder, ..) = written(pair, &Orientation::ISB, 1.0);
    let keys = |file| format!("shape = \"mesh\"\nfile = \"{file}\"\nlength_unit = \"mm\"\n");
    let (femur, insert) = (keys("f.stl"), keys("i.stl"));
    let text = format!("side = \"{side}\"\n[femur]\n{femur}[insert]\n{insert}edge_mm = 3\n");
    let case = Case::parse(&text, "case.toml", folder.path()).unwrap();
    let warnings = case.build(1).unwrap().warnings.into_iter();
    let of_side = |warning: &BuildWarning| warning.to_string().contains(" knee; write side =");
    warnings.filter(of_side).collect()
}

#[test]
fn a_knee_of_the_other_side_is_reported_if_the_trochlea_shows_it() {
    for pair in real("other_side") {
        assert!(warned_of_side(&pair, "right").is_empty());
        let warnings = warned_of_side(&pair, "left");
        let said = warnings.iter().map(ToString::to_string).collect::<String>();
        assert!(
            said.contains("as in a right knee; write side = \"right\""),
            "{said}"
        );
    }
    for side in ["right", "left"] {
        assert!(warned_of_side(&generic(), side).is_empty());
    }
}

#[test]
fn a_draft_takes_the_side_that_the_trochlea_shows_unless_it_is_given() {
    let mirror = |v: &Vec3| Vec3::new(v.x, v.y, -v.z);
    for pair in real("draft_takes_the_side") {
        let mirrored = Pair {
            femur: pair.femur.clone().mapped(mirror),
            insert: pair.insert.clone().mapped(mirror),
        };
        let cases = [
            (&pair, None, "right", "check it"),
            (&mirrored, None, "left", "check it"),
            (&mirrored, Some(Side::Right), "right", "as given"),
        ];
        for (pair, side, word, why) in cases {
            let (folder, femur, insert) = written(pair, &Orientation::ISB, 1.0);
            let meshes = [femur.as_path(), insert.as_path()];
            let drafted = Drafted::new(Preset::StanmoreForce, side, meshes, folder.path());
            let text = drafted.unwrap().text;
            assert!(text.contains(&format!("\nside = \"{word}\"")), "{text}");
            assert!(text.contains(&format!("side \"{word}\", {why};")), "{text}");
        }
    }
}

#[test]
fn a_draft_puts_the_origin_between_dishes_that_lie_off_that_of_their_file() {
    let pair = generic();
    let away = Pair {
        femur: pair
            .femur
            .clone()
            .mapped(|v| v + Vec3::new(-40.0, 10.0, 0.0)),
        insert: pair
            .insert
            .clone()
            .mapped(|v| v + Vec3::new(30.0, 500.0, -12.0)),
    };
    let mut starts = Vec::new();
    for (pair, is_centred) in [(&pair, false), (&away, true)] {
        let (folder, femur, insert) = written(pair, &Orientation::ISB, 1.0);
        let meshes = [femur.as_path(), insert.as_path()];
        let drafted = Drafted::new(Preset::StanmoreForce, None, meshes, folder.path());
        let text = drafted.unwrap().text;
        assert_eq!(text.contains("origin = \"centre\""), is_centred, "{text}");
        let case = Case::parse(&text, "case.toml", folder.path()).unwrap();
        let built = case.build(1).unwrap();
        let off =
            |warning: &BuildWarning| warning.to_string().contains("the middle of the dishes is");
        assert!(!built.warnings.iter().any(off), "{:?}", built.warnings);
        starts.push(built.test.start_mm);
    }
    let [at_home, away] = [starts[0], starts[1]];
    // Of the file that lies at home the dishes' middle is within a millimetre of the origin.
    assert!(
        (at_home.0 - away.0).abs() < 1.0 && (at_home.1 - away.1).abs() < 1.0,
        "{starts:?}"
    );
}

/// The case drafted of a pair that lies turned and far away, and what is built of it.
fn drafted(pair: &Pair, place: impl Fn(&Vec3) -> Vec3) -> (String, Built) {
    let placed = Pair {
        femur: pair.femur.clone().mapped(&place),
        insert: pair.insert.clone().mapped(&place),
    };
    let (folder, femur, insert) = written(&placed, &Orientation::ISB, 1.0);
    let meshes = [femur.as_path(), insert.as_path()];
    let drafted = Drafted::new(Preset::StanmoreForce, None, meshes, folder.path());
    let text = drafted.unwrap().text;
    let case = Case::parse(&text, "case.toml", folder.path()).unwrap();
    assert_eq!(case.misfit_remarks(), [""; 0], "{text}");
    (text, case.build(1).unwrap())
}

/// Lowest places of the dishes, and the start of the flexion axis, both mm.
fn landmarks(built: &Built) -> [Vec3; 3] {
    let test = &built.test;
    let dishes = Dishes::find(&test.insert.surface().positions).unwrap();
    let start = Vec3::new(test.start_mm.0, 0.0, test.start_mm.1);
    // The draft takes the middle of the dishes or the origin of the file: only differences are the same.
    let middle = dishes.middle_mm();
    [
        dishes.medial_mm - middle,
        dishes.lateral_mm - middle,
        start - Vec3::new(middle.x, 0.0, middle.z),
    ]
}

#[test]
fn a_pair_that_lies_turned_and_far_away_comes_together_as_the_square_one() {
    let mut pairs = real("lies_turned");
    pairs.push(generic());
    for pair in &pairs {
        let (square, built) = drafted(pair, |v| *v);
        assert!(
            square.contains("# rotation_deg =") && square.contains("# origin_mm ="),
            "{square}"
        );
        let at_home = landmarks(&built);
        for (axis, degrees) in [
            (Vec3::x(), 10.0),
            (Vec3::y(), 20.0),
            (Vec3::new(1.0, 2.0, -1.0), 27.0),
        ] {
            let cross = axis.normalize().cross_matrix();
            let (sine, cosine) = f64::to_radians(degrees).sin_cos();
            let turn = Mat3::identity() + cross * sine + cross * cross * (1.0 - cosine);
            let shift = Vec3::new(1000.0, -700.0, 300.0);
            let (text, built) = drafted(pair, |v| turn * v + shift);
            assert_eq!(text.matches("\nrotation_deg = [").count(), 2, "{text}");
            assert!(text.contains("\norigin_mm = ["), "{text}");
            // A degree at the dishes, 23 mm off the middle; flat ones have their lowest places anywhere within a few millimetres.
            for (here, there) in at_home.iter().zip(landmarks(&built)) {
                assert!(
                    (here - there).norm() < 3.0,
                    "{degrees} {here} {there}\n{text}"
                );
            }
        }
    }
}

#[test]
fn an_insert_that_slopes_on_the_bone_keeps_its_slope_and_its_femur_is_not_turned() {
    let mut pairs = real("insert_that_slopes");
    pairs.push(generic());
    for pair in pairs {
        for slope_deg in [5.0, 8.0] {
            let (sine, cosine) = f64::to_radians(slope_deg).sin_cos();
            let slope =
                |v: &Vec3| Vec3::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z);
            let sloped = Pair {
                femur: pair.femur.clone(),
                insert: pair.insert.clone().mapped(slope),
            };
            let (folder, femur, insert) = written(&sloped, &Orientation::ISB, 1.0);
            let meshes = [femur.as_path(), insert.as_path()];
            let drafted = Drafted::new(Preset::StanmoreForce, None, meshes, folder.path());
            let text = drafted.unwrap().text;
            assert!(!text.contains("\nrotation_deg = ["), "{text}");
            assert!(
                text.contains("degrees of posterior slope, which are kept"),
                "{text}"
            );
            let case = Case::parse(&text, "case.toml", folder.path()).unwrap();
            assert_eq!(case.misfit_remarks(), [""; 0], "{text}");
        }
    }
}

/// A peg of a rotating platform hides the shape of its insert.
#[test]
fn a_femur_keeps_its_axes_where_its_insert_is_not_recognised_and_the_insert_takes_them() {
    let pair = generic();
    let low = pair.insert.bounds().0.y;
    let peg = TriangleMesh::block(
        Vec3::new(-6.0, low - 20.0, -6.0),
        Vec3::new(6.0, low + 1.0, 6.0),
    );
    let with_peg = Pair {
        femur: pair.femur,
        insert: pair.insert.joined(&peg),
    };
    let right_anterior_superior =
        Orientation::nearest_to(&Mat3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0));
    let (folder, femur, insert) = written(&with_peg, &right_anterior_superior, 1.0);
    let meshes = [femur.as_path(), insert.as_path()];
    let drafted = Drafted::new(Preset::StanmoreForce, None, meshes, folder.path());
    let text = drafted.unwrap().text;
    let axes = r#"axes = ["right", "anterior", "superior"]"#;
    assert_eq!(text.matches(axes).count(), 2, "{text}");
}

#[test]
fn bodies_that_are_others_are_refused_by_a_draft() {
    let pair = generic();
    let refused = |femur: &TriangleMesh, insert: &TriangleMesh| {
        let pair = Pair {
            femur: femur.clone(),
            insert: insert.clone(),
        };
        let (folder, femur, insert) = written(&pair, &Orientation::ISB, 1.0);
        let meshes = [femur.as_path(), insert.as_path()];
        let drafted = Drafted::new(Preset::StanmoreForce, None, meshes, folder.path());
        drafted.unwrap_err().to_string()
    };
    let said = refused(&pair.insert, &pair.femur);
    assert!(
        said.contains("f.stl is an insert and") && said.contains("exchange them"),
        "{said}"
    );
    let narrow = pair
        .insert
        .clone()
        .mapped(|v| Vec3::new(v.x, v.y, 0.4 * v.z));
    let said = refused(&pair.femur, &narrow);
    assert!(
        said.contains("an insert of one compartment; condyle tests whole knees"),
        "{said}"
    );
    let tray = TriangleMesh::block(Vec3::new(-23.0, 0.0, -36.0), Vec3::new(23.0, 5.0, 36.0));
    let said = refused(&pair.femur, &tray);
    assert!(
        said.contains("a tray, flat above and below; give the polyethylene"),
        "{said}"
    );
}

#[test]
fn bodies_of_other_joints_are_not_judged_as_those_of_a_knee() {
    let (folder, femur, insert) = written(&generic(), &Orientation::all().nth(5).unwrap(), 1.0);
    let meshes = [femur.as_path(), insert.as_path()];
    let refused = Drafted::new(Preset::Iso22622Like, None, meshes, folder.path());
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("derived for knees only"), "{said}");
    let built = |preset: Preset| {
        let text = format!(
            "[femur]\nshape = \"mesh\"\nfile = \"f.stl\"\n[insert]\nshape = \"mesh\"\nfile = \"i.stl\"\n\
             [machine]\npreset = \"{}\"\n",
            preset.word()
        );
        let case = Case::parse(&text, "case.toml", folder.path()).unwrap();
        let said = case.build(1).err().map(|error| error.to_string());
        [case.misfit_remarks().join("\n"), said.unwrap_or_default()].join("\n")
    };
    let of_knee = built(Preset::StanmoreForce);
    assert!(of_knee.contains("as its shape indicates"), "{of_knee}");
    let of_ankle = built(Preset::Iso22622Like);
    assert!(!of_ankle.contains("its shape indicates"), "{of_ankle}");
}

#[test]
fn bodies_of_different_sizes_are_reported() {
    let pair = generic();
    let small = Pair {
        femur: pair.femur.mapped(|v| 0.7 * v),
        insert: pair.insert,
    };
    let (folder, ..) = written(&small, &Orientation::ISB, 1.0);
    let text = "[femur]\nshape = \"mesh\"\nfile = \"f.stl\"\n[insert]\nshape = \"mesh\"\nfile = \"i.stl\"\n";
    let case = Case::parse(text, "case.toml", folder.path()).unwrap();
    let said = case.misfit_remarks().join("\n");
    assert!(said.contains("unlike those of one implant"), "{said}");
}

#[test]
fn oblique_hexahedra_are_reported_as_an_oblique_mesh_is() {
    let meshing = Meshing {
        edge_mm: 2.5,
        layers: 1,
    };
    let insert = GenericInsertShape::default().insert(meshing).unwrap();
    let (sine, cosine) = 15f64.to_radians().sin_cos();
    let turn = Mat3::new(cosine, 0.0, sine, 0.0, 1.0, 0.0, -sine, 0.0, cosine);
    let mut text = "*NODE\n".to_owned();
    for (number, node) in (1..).zip(&insert.mesh().nodes) {
        let [x, y, z] = <[f64; 3]>::from(turn * node);
        text += &format!("{number}, {x}, {y}, {z}\n");
    }
    text += "*ELEMENT, TYPE=C3D8\n";
    for (number, hex) in (1..).zip(insert.mesh().hexes.iter()) {
        let nodes = hex.map(|node| (node + 1).to_string()).join(", ");
        text += &format!("{number}, {nodes}\n");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("insert.inp"), text).unwrap();
    let text = "[insert]\nshape = \"hexahedra\"\nfile = \"insert.inp\"\n";
    let case = Case::parse(text, "case.toml", folder.path()).unwrap();
    let said = case.misfit_remarks().join("\n");
    assert!(
        said.contains("this insert lies 15 degrees off its axes"),
        "{said}"
    );
}

/// A part of a tenth of a millimetre that differs from vertex to vertex, as the noise of a scan.
fn scanned(mesh: &TriangleMesh, noise_mm: f64) -> TriangleMesh {
    mesh.clone().mapped(|v| {
        let part = |along: f64| ((v.x + 3.0 * v.y + 7.0 * v.z) * along).sin();
        v + Vec3::new(part(911.0), part(1777.0), part(2903.0)) * (noise_mm * 2f64.sqrt())
    })
}

#[test]
fn the_noise_of_a_scan_is_named_with_its_size() {
    let mut pairs = real("noise_of_a_scan");
    pairs.push(generic());
    for pair in &pairs {
        for (noise_mm, is_told) in [(0.0, false), (0.03, true)] {
            let noisy = Pair {
                femur: scanned(&pair.femur, noise_mm),
                insert: scanned(&pair.insert, noise_mm),
            };
            let said = refused(&noisy, r#"["anterior", "superior", "right"]"#, "mm");
            let is_named = said.contains("as after a scan");
            assert_eq!(is_named, is_told, "{noise_mm} {said}");
        }
    }
}
