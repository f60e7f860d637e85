//! Hips from the files of head and cup.

use condyle_mesh::{TriangleMesh, Vec3, formats::write_stl};
use condyle_results::catalogue;

use crate::bench::Bench;

/// Coarse facets around a body.
const AROUND: u32 = 36;

/// Returns points of a circle about the origin, by the angle from straight down, in steps of six degrees.
fn arc(radius: f64, from_deg: f64, to_deg: f64) -> impl Iterator<Item = (f64, f64)> {
    let steps = ((to_deg - from_deg).abs() / 6.0).round();
    (0..=steps as u32).map(move |n| {
        let angle = (from_deg + (to_deg - from_deg) * f64::from(n) / steps).to_radians();
        (radius * angle.sin(), -radius * angle.cos())
    })
}

fn cup() -> TriangleMesh {
    let profile: Vec<(f64, f64)> = arc(22.1, 1e-6, 90.0).chain(arc(14.1, 90.0, 1e-6)).collect();
    TriangleMesh::revolved(&profile, AROUND)
}

/// Returns a liner with a cylinder and a flat bottom outside, and a chamfer along its rim.
fn liner() -> TriangleMesh {
    let outside = [
        (1e-6, -21.5),
        (12.0, -21.5),
        (22.1, -14.0),
        (22.1, 0.0),
        (15.0, 0.0),
    ];
    let profile: Vec<(f64, f64)> = outside.into_iter().chain(arc(14.1, 88.0, 1e-6)).collect();
    TriangleMesh::revolved(&profile, AROUND)
}

/// Returns a ball with a bore for its neck.
fn head() -> TriangleMesh {
    let bore = [(6.0, 11.9), (5.0, 2.0), (1e-6, 2.0)];
    let profile: Vec<(f64, f64)> = arc(14.0, 1e-6, 150.0).chain(bore).collect();
    TriangleMesh::revolved(&profile, AROUND)
}

/// Writes a body in metres, turned and far from its origin.
fn write(bench: &Bench, name: &str, body: TriangleMesh) {
    let turn = condyle::Mat3::from_columns(&[
        Vec3::new(0.36, 0.48, -0.8),
        Vec3::new(-0.8, 0.6, 0.0),
        Vec3::new(0.48, 0.64, 0.6),
    ]);
    let shift = Vec3::new(120.0, -40.0, 900.0);
    let body = body.mapped(|vertex| (turn * vertex + shift) / 1000.0);
    let mut stl = Vec::new();
    write_stl(&mut stl, &body).unwrap();
    std::fs::write(bench.path(name), stl).unwrap();
}

fn mass_mg(bench: &Bench, case: &str, out: &str) -> f64 {
    let said = bench.say(&["run", case, "--out", out]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    bench.summary(out)[&catalogue::MASS_LOSS_MG]
}

#[test]
fn a_coarse_turned_pair_in_metres_wears_as_the_hip_by_dimensions() {
    let bench = Bench::new();
    for (name, body) in [
        ("head.stl", head()),
        ("cup.stl", cup()),
        ("liner.stl", liner()),
    ] {
        write(&bench, name, body);
    }
    bench.say(&["new", "plain.toml", "--joint", "hip"]);
    let plain = std::fs::read_to_string(bench.path("plain.toml")).unwrap();
    assert!(plain.contains("shape = \"cup\""));
    let exact_mg = mass_mg(&bench, "plain.toml", "plain");
    for (case, cup, tolerance) in [
        ("cup.toml", "cup.stl", 1e-3),
        ("liner.toml", "liner.stl", 0.015),
    ] {
        let said = bench.say(&["new", case, "--head", "head.stl", "--cup", cup]);
        assert!(
            said.err
                .contains("a socket of 14.100 mm radius with length_unit \"m\""),
            "{}",
            said.err
        );
        assert!(
            said.err.contains("radial clearance is 0.100 mm"),
            "{}",
            said.err
        );
        let mg = mass_mg(&bench, case, case.trim_end_matches(".toml"));
        assert!(
            (mg / exact_mg - 1.0).abs() < tolerance,
            "{cup}: {mg} {exact_mg}"
        );
    }
}

#[test]
fn bodies_that_are_no_hip_are_refused_with_the_reason() {
    let bench = Bench::new();
    let large = head().mapped(|vertex| vertex * 1.01);
    let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
    let bodies = [
        ("head.stl", head()),
        ("cup.stl", cup()),
        ("large.stl", large),
        ("block.stl", block),
    ];
    for (name, body) in bodies {
        write(&bench, name, body);
    }
    for (head, cup, why) in [
        ("cup.stl", "head.stl", "exchange --head and --cup"),
        ("large.stl", "cup.stl", "is not larger than the head"),
        ("block.stl", "cup.stl", "no spherical ball"),
        ("head.stl", "block.stl", "no spherical socket"),
    ] {
        let said = bench.say(&["new", "hip.toml", "--head", head, "--cup", cup]);
        said.assert_refused(2, &[why]);
        assert!(!bench.path("hip.toml").exists());
    }
    let pair = ["--head", "head.stl", "--cup", "cup.stl"];
    let of_joint = |joint| bench.say(&[&["new", "hip.toml", "--joint", joint], &pair[..]].concat());
    of_joint("ankle").assert_refused(2, &["of a hip or a disc"]);
    of_joint("disc");
    let drafted = std::fs::read_to_string(bench.path("hip.toml")).expect("a case is written");
    assert!(drafted.contains("inclination_deg = 0.0"), "{drafted}");
    std::fs::remove_file(bench.path("hip.toml")).expect("it exists");
    bench.say(&[&["new", "hip.toml"], &pair[..]].concat());
    let said = bench.say(&[
        "run",
        "hip.toml",
        "--set",
        "femur.radius_mm=14.2",
        "--out",
        "out",
    ]);
    said.assert_refused(2, &["not larger than its head"]);
}

/// Inches and centimetres both fit some radii: the unit is that of a head with a whole diameter, and the other is named.
#[test]
fn a_unit_that_is_uncertain_is_named_with_the_other() {
    let bench = Bench::new();
    let write = |name: &str, body: TriangleMesh, scale: f64| {
        let mut stl = Vec::new();
        write_stl(&mut stl, &body.mapped(|vertex| vertex * scale)).unwrap();
        std::fs::write(bench.path(name), stl).unwrap();
    };
    for (joint, radius_mm, unit_mm, unit, other) in [
        ("hip", 27.0, 25.4, "in", "10.630 mm with length_unit \"cm\""),
        ("hip", 11.0, 10.0, "cm", "27.940 mm with length_unit \"in\""),
        ("disc", 6.0, 10.0, "cm", "15.240 mm with length_unit \"in\""),
        ("disc", 6.0, 1.0, "mm", ""),
    ] {
        let scale = radius_mm / 14.0 / unit_mm;
        write("head.stl", head(), scale);
        write("cup.stl", cup(), scale);
        let pair = ["--head", "head.stl", "--cup", "cup.stl", "--force"];
        let said = bench.say(&[&["new", "a.toml", "--joint", joint], &pair[..]].concat());
        let ball = format!("a ball of {radius_mm:.3} mm radius with length_unit \"{unit}\"");
        assert!(said.err.contains(&ball), "{}", said.err);
        let drafted = std::fs::read_to_string(bench.path("a.toml")).expect("a case is written");
        for text in [&said.err, &drafted] {
            assert_eq!(text.contains("The unit is uncertain"), !other.is_empty());
            assert!(text.contains(other), "{text}");
        }
        assert!(
            drafted.contains(&format!("length_unit = \"{unit}\"")),
            "{drafted}"
        );
    }
}

/// Scatters the vertices off the axis, where slivers meet, by a standard deviation.
fn scattered(mut body: TriangleMesh, by_mm: f64) -> TriangleMesh {
    let vertices = body.vertices.iter_mut().enumerate();
    for (at, vertex) in vertices.filter(|(_, vertex)| vertex.x.hypot(vertex.z) > 1.0) {
        // Multiples of the golden section are spread evenly over 0 to 1: their deviation is 1 / sqrt(12).
        let part = |times: f64| (at as f64 * times * 0.618_033_988_75).fract() - 0.5;
        *vertex += Vec3::new(part(1.0), part(3.0), part(7.0)) * (by_mm * 12f64.sqrt());
    }
    body
}

#[test]
fn the_noise_of_a_scanned_cup_is_doubtful_and_its_coarse_export_is_not() {
    let bench = Bench::new();
    write(&bench, "head.stl", head());
    for (name, by_mm) in [("exact", 0.0), ("scan", 0.01)] {
        write(&bench, "cup.stl", scattered(cup(), by_mm));
        bench.say(&[
            "new", "hip.toml", "--force", "--head", "head.stl", "--cup", "cup.stl",
        ]);
        let small = [
            "insert.edge_mm=2.5",
            "insert.layers=1",
            "march.updates=1",
            "accuracy.estimate=false",
        ];
        let mut run = vec!["run", "hip.toml", "--out", name];
        run.extend(small.iter().flat_map(|set| ["--set", set]));
        let said = bench.say(&run);
        assert_eq!(said.code, Some(0), "{}", said.err);
        let doubts = bench.summary(name).plausibility;
        let doubt = doubts.iter().find(|doubt| doubt.check == "noisy_mesh");
        assert_eq!(doubt.is_some(), by_mm > 0.0, "{doubts:?}");
        let found_mm = doubt.map_or(by_mm, |doubt| doubt.value);
        assert!((found_mm - by_mm).abs() <= 0.3 * by_mm, "{found_mm}");
    }
}

#[test]
fn an_opening_against_the_socket_is_refused_with_that_of_the_socket() {
    let bench = Bench::new();
    write(&bench, "head.stl", head());
    write(&bench, "cup.stl", cup());
    bench.say(&["new", "hip.toml", "--head", "head.stl", "--cup", "cup.stl"]);
    // The cup opens along y before it is turned.
    for (along, is_right) in [("[-0.8,0.6,0.0]", true), ("[0.8,-0.6,0.0]", false)] {
        let set = format!("insert.opens_along={along}");
        let said = bench.say(&["check", "hip.toml", "--set", &set]);
        if is_right {
            assert_eq!(said.code, Some(0), "{}", said.err);
        } else {
            said.assert_refused(2, &["points away from the opening", "(-0.800, 0.600, "]);
        }
    }
}

#[test]
fn a_cup_and_its_mirror_image_wear_alike_on_both_sides() {
    let bench = Bench::new();
    // Thicker laterally on a left hip, by up to 4 mm.
    let thick = cup().mapped(|vertex| match vertex.norm() > 20.0 {
        true => vertex * (1.09 + 0.09 * vertex.z / vertex.norm()),
        false => *vertex,
    });
    let mut mirrored = thick
        .clone()
        .mapped(|vertex| Vec3::new(vertex.x, vertex.y, -vertex.z));
    mirrored
        .triangles
        .iter_mut()
        .for_each(|corners| corners.swap(0, 1));
    let mass_mg = |side: &str, cup: &TriangleMesh, out: &str| {
        let mut stl = Vec::new();
        write_stl(&mut stl, cup).unwrap();
        std::fs::write(bench.path("cup.stl"), stl).unwrap();
        let case = format!(
            "side = \"{side}\"\n[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup-mesh\"\nfile = \
             \"cup.stl\"\nedge_mm = 2.5\nlayers = 1\n[machine]\npreset = \"iso-14242-1-like\"\n[march]\nupdates = 1\n\
             [accuracy]\nestimate = false\n"
        );
        std::fs::write(bench.path("hip.toml"), case).unwrap();
        mass_mg(&bench, "hip.toml", out)
    };
    let (left, right) = (
        mass_mg("left", &thick, "left"),
        mass_mg("right", &mirrored, "right"),
    );
    assert!((right / left - 1.0).abs() < 1e-6, "{left} {right}");
    let other = mass_mg("right", &thick, "other");
    assert!((other / left - 1.0).abs() > 1e-4, "{left} {other}");
}

#[test]
fn a_head_on_the_edge_of_a_chamfered_socket_is_doubtful() {
    let bench = Bench::new();
    let outside = arc(22.1, 1e-6, 90.0).chain([(16.5, 0.0)]);
    let profile: Vec<(f64, f64)> = outside.chain(arc(14.1, 78.0, 1e-6)).collect();
    let mut stl = Vec::new();
    write_stl(&mut stl, &TriangleMesh::revolved(&profile, 72)).unwrap();
    std::fs::write(bench.path("cup.stl"), stl).unwrap();
    for (preset, inclination_deg, rides) in [
        ("iso-14242-4-like", 45, true),
        ("iso-14242-1-like", 30, false),
    ] {
        let case = format!(
            "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup-mesh\"\nfile = \"cup.stl\"\n\
             inclination_deg = {inclination_deg}\nedge_mm = 1.5\nlayers = 1\n[machine]\npreset = \"{preset}\"\n[march]\n\
             updates = 1\n[accuracy]\nestimate = false\n"
        );
        std::fs::write(bench.path("hip.toml"), case).unwrap();
        let said = bench.say(&["run", "hip.toml", "--out", preset]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        let doubts = bench.summary(preset).plausibility;
        let at_rim = doubts.iter().any(|doubt| doubt.check == "pressure_at_rim");
        assert_eq!(at_rim, rides, "{doubts:?}");
    }
}

#[test]
fn the_largest_usual_clearance_is_usual_after_rounding() {
    let bench = Bench::new();
    write(&bench, "head.stl", head());
    // 14.400000 mm in single precision, far from the origin of the file, are a little more.
    let mut wide = cup();
    for vertex in &mut wide.vertices {
        if vertex.norm() < 15.0 {
            *vertex *= 14.400_05 / 14.1;
        }
    }
    write(&bench, "cup.stl", wide);
    let said = bench.say(&["new", "hip.toml", "--head", "head.stl", "--cup", "cup.stl"]);
    assert!(said.err.contains("clearance is 0.400 mm."), "{}", said.err);
}

#[test]
fn a_head_of_triangles_wears_its_cup_as_a_ball_does_wherever_its_file_has_it() {
    let bench = Bench::new();
    let meridian = (0..=90).map(|n| (f64::from(n) * 2.0).to_radians());
    let profile: Vec<(f64, f64)> = meridian
        .map(|angle| (14.0 * angle.sin().max(1e-7), -14.0 * angle.cos()))
        .collect();
    let head = TriangleMesh::revolved(&profile, 180);
    let head = head.mapped(|vertex| vertex + Vec3::new(150.0, 300.0, 0.0));
    let mut stl = Vec::new();
    write_stl(&mut stl, &head).unwrap();
    std::fs::write(bench.path("head.stl"), stl).unwrap();
    let case = |femur: &str, cup_mm: f64| {
        format!(
            "[femur]\n{femur}\n[insert]\nshape = \"cup\"\nradius_mm = {cup_mm}\nedge_mm = 2.0\nlayers = 2\n\
             [machine]\npreset = \"iso-14242-1-like\"\n[march]\nupdates = 2\n[time]\nincrements = 40\n\
             [accuracy]\nestimate = false\n"
        )
    };
    let mesh =
        "shape = \"mesh\"\nfile = \"head.stl\"\naxes = [\"anterior\", \"superior\", \"right\"]";
    bench.write(
        "ball.toml",
        &case("shape = \"sphere\"\nradius_mm = 14.0", 14.1),
    );
    bench.write("mesh.toml", &case(mesh, 14.1));
    bench.write("tight.toml", &case(mesh, 13.9));
    let (ball_mg, mesh_mg) = (
        mass_mg(&bench, "ball.toml", "ball"),
        mass_mg(&bench, "mesh.toml", "mesh"),
    );
    assert!(
        (mesh_mg / ball_mg - 1.0).abs() < 2e-3,
        "{mesh_mg} {ball_mg}"
    );
    let [ball_mpa, mesh_mpa] =
        ["ball", "mesh"].map(|out| bench.summary(out)[&catalogue::PEAK_PRESSURE_MPA]);
    assert!(
        (mesh_mpa / ball_mpa - 1.0).abs() < 0.02,
        "{mesh_mpa} {ball_mpa}"
    );
    let said = bench.say(&["run", "tight.toml", "--out", "tight"]);
    said.assert_refused(
        2,
        &["the cup of radius 13.900 mm is not larger than its head of 14.000 mm"],
    );
}

#[test]
fn a_load_in_kilonewtons_is_doubtful() {
    let bench = Bench::new();
    let shown = bench.say(&["machine", "show", "iso-14242-1-like"]).out;
    for (file, scale) in [("newtons.toml", 1.0), ("kilonewtons.toml", 0.001)] {
        let loaded = shown.replace("[joints.load]", &format!("[joints.load]\nscale = {scale}"));
        assert_ne!(loaded, shown);
        bench.write(file, &loaded);
        bench.write(
            "case.toml",
            &format!(
                "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\nradius_mm = 14.1\nedge_mm = 2.5\n\
                 layers = 1\n[machine]\nfile = \"{file}\"\n[march]\nupdates = 1\n[time]\nincrements = 40\n\
                 [accuracy]\nestimate = false\n"
            ),
        );
        let said = bench.say(&["run", "case.toml", "--out", file.trim_end_matches(".toml")]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        let doubt = "the largest axial load is 3.0 N";
        assert_eq!(said.out.contains(doubt), scale < 1.0, "{}", said.out);
        // The joints of a hip have other places than those of a knee.
        assert!(!said.out.contains("prescribed motion"), "{}", said.out);
    }
}

#[test]
fn notes_and_doubts_of_a_hip_say_nothing_of_knees() {
    let bench = Bench::with_case(
        "[femur]\nshape = \"sphere\"\nradius_mm = 16.0\n[insert]\nshape = \"cup\"\nradius_mm = 16.15\nthickness_mm = 5.5\n\
         inclination_deg = 65.0\nedge_mm = 2.0\nlayers = 2\n[machine]\npreset = \"iso-14242-4-like\"\n\
         [march]\nupdates = 1\n[accuracy]\nestimate = false\n",
    );
    bench.run_into("hip");
    let summary = bench.summary("hip");
    let (doubts, notes) = (summary.plausibility.iter(), summary.notes.iter());
    let all: Vec<_> = doubts.chain(notes).collect();
    for check in [
        "pressure_beyond_flow",
        "pressure_beyond_yield",
        "thin_polyethylene",
    ] {
        assert!(
            all.iter().any(|found| found.check == check),
            "{check}: {all:?}"
        );
    }
    for found in all {
        let text = format!("{} {}", found.message, found.advice);
        let words = ["knee", "femur", "tray"];
        assert!(!words.iter().any(|word| text.contains(word)), "{text}");
    }
}

pub const TWO_ACTIVITIES: &str = "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\nedge_mm = 2.5\nlayers = 2\n\
    [machine]\npreset = \"iso-14242-1-like\"\n[march]\nupdates = 1\n[accuracy]\nestimate = false\n\
    [[activity]]\nname = \"walking\"\ncycles_in_sequence = 9\n\
    [[activity]]\nname = \"strolling\"\ncycles_in_sequence = 1\nfrequency_hz = 0.5\n";

#[test]
fn verify_activities_include_the_final_cycle() {
    let bench = Bench::with_case(TWO_ACTIVITIES);
    bench.run_into("hip");
    for activity in bench.summary("hip").activities {
        let areas = bench.table("hip", &activity.kinematics_file);
        let areas_mm2 = areas["contact_area_mm2"].iter().copied();
        // Tables are written with fewer digits.
        let largest = areas_mm2.fold(0.0, f64::max);
        assert!((activity.peak_contact_area_mm2 / largest - 1.0).abs() < 1e-5);
    }
}

#[test]
fn check_and_run_state_where_the_axes_pass() {
    let mesh = "shape = \"mesh\"\nfile = \"head.stl\"";
    let case = TWO_ACTIVITIES.replace("shape = \"sphere\"\nradius_mm = 14.0", mesh);
    let bench = Bench::with_case(&case);
    let flat = "no ball or socket was found: axes pass through the file's origin";
    for (cap_deg, words) in [
        (
            36.0,
            "axes pass through the centre of a ball of radius 14.00 mm",
        ),
        (24.0, flat),
    ] {
        // A cap on a cylinder, with its centre at the origin.
        let cap = arc(14.0, 1e-6, cap_deg);
        let edge = 14.0 * f64::to_radians(cap_deg).sin();
        let profile: Vec<(f64, f64)> = cap.chain([(edge, 9.0), (1e-6, 9.0)]).collect();
        let mut stl = Vec::new();
        write_stl(&mut stl, &TriangleMesh::revolved(&profile, AROUND)).unwrap();
        std::fs::write(bench.path("head.stl"), stl).unwrap();
        let said = bench.say(&["check", "case.toml"]);
        assert!(said.out.contains(words), "{}{}", said.out, said.err);
    }
    let ran = bench.run_into("out").out;
    assert!(ran.contains(flat), "{ran}");
    assert_eq!(bench.summary("out").axes.as_deref(), Some(flat));
}

#[test]
fn a_hip_is_described_in_its_own_words() {
    let bench = Bench::with_case(TWO_ACTIVITIES);
    let said = bench.say(&["check", "case.toml"]).out;
    let words = ["head ", "cup "].map(|word| said.lines().any(|line| line.starts_with(word)));
    assert!(words == [true; 2] && !said.contains("dish"), "{said}");
    let ran = bench.run_into("hip").out;
    assert!(ran.contains("measured on hip simulators"), "{ran}");
    bench.write(
        "motion.csv",
        "percent,abduction_deg,penetration_mm\n0,-3,0\n50,4,0\n",
    );
    bench.write(
        "measured.toml",
        "[kinematics]\nfile = \"motion.csv\"\nlargest_gap_percent = 50\n",
    );
    let compared = bench
        .say(&["compare", "hip", "measured.toml", "--out", "."])
        .out;
    assert!(compared.contains("abduction_deg"), "{compared}");
    let picture = std::fs::read_to_string(bench.path("compare_kinematics.svg"));
    assert!(picture.expect("it is drawn").contains("+ abduction"));
    let summary = bench.summary("hip");
    assert_eq!(summary.joint.name(), "hip");
    assert_eq!(summary.motions[0].title, "Lateral motion");
    let page = std::fs::read_to_string(bench.path("hip/report.html")).expect("a report is written");
    assert!(page.contains("cycles the cup has lost") && page.contains("+ head lateral"));
    assert!(page.contains("Deepest: <tspan") && !page.contains("Deepest medial"));
    assert!(page.contains("Wear by activity") && !page.contains("AP range"));
}

#[test]
fn verify_lateral_is_at_plus_z_in_a_left_hip_and_at_minus_z_in_a_right_one() {
    // The frame is right-handed with x anterior and y inferior: z points to the left of the body. The head bears on the lateral
    // rim of a steep cup.
    let place = |side: &str| {
        let bench = Bench::with_case(&format!(
            "side = \"{side}\"\n[femur]\nshape = \"sphere\"\nradius_mm = 18.0\n[insert]\nshape = \"cup\"\nradius_mm = 18.1\n\
             inclination_deg = 45.0\nedge_mm = 3.0\n[machine]\npreset = \"iso-14242-4-like\"\n[march]\nupdates = 2\n\
             [accuracy]\nestimate = false\n"
        ));
        bench.run_into("hip");
        let summary = bench.summary("hip");
        let at_rim = summary
            .plausibility
            .iter()
            .find(|one| one.check == "pressure_at_rim");
        let message = &at_rim.expect("the rim is pressed").message;
        let z_mm = message.rsplit("z ").next().unwrap().trim_end_matches(" mm");
        let picture = std::fs::read_to_string(bench.path("hip/report.html")).unwrap();
        let [medial, lateral] =
            ["Medial", "Lateral"].map(|word| picture.find(&format!(">{word}<")));
        (z_mm.parse::<f64>().unwrap(), medial < lateral)
    };
    let (left, right) = (place("left"), place("right"));
    assert!(left.0 > 10.0 && right.0 == -left.0, "{left:?} {right:?}");
    // Maps have -z on the left, whose label comes first.
    assert_eq!((left.1, right.1), (true, false));
}
