//! Scans made from the predicted surface, moved by a known motion, with noise of a known size.

use condyle_results::catalogue;
use std::fmt::Write;
use std::path::Path;

use condyle_report::{Results, SurfaceFields};
use serde_json::Value;

use crate::bench::{Bench, SMALL};
use crate::measured::{assert_refused, compared, measured_bench, noise};
use crate::shapes::stl;

type Point = [f64; 3];

/// A scan as coarse as the mesh of 2.5 mm is smoothed at the rims of the scars by this much.
const ALIKE_MM: f64 = 3e-3;

/// Turns of 2, -3 and 1.5 degrees about x, y and z, then a shift of some millimetres.
fn moved([x, y, z]: Point) -> Point {
    let (s, c) = 2f64.to_radians().sin_cos();
    let [x, y, z] = [x, c * y - s * z, s * y + c * z];
    let (s, c) = (-3f64).to_radians().sin_cos();
    let [x, y, z] = [c * x + s * z, y, c * z - s * x];
    let (s, c) = 1.5f64.to_radians().sin_cos();
    [c * x - s * y + 2.0, s * x + c * y - 3.0, z + 1.5]
}

fn worn(bench: &Bench) -> SurfaceFields {
    let results = Results::read(&bench.path("out")).unwrap();
    results.surface.expect("the run wrote meshes")
}

/// Nodes of the worn surface, each off along y by noise of this size, and lower by a part of the
/// wear.
fn nodes(surface: &SurfaceFields, noise_mm: f64, deeper: f64) -> Vec<Point> {
    let depth = surface.field("wear_depth_mm").unwrap();
    let noise = noise(surface.nodes.len());
    let node = |index: usize| {
        let place = surface.nodes[index];
        [
            place.x,
            place.y + noise_mm * noise[index] - deeper * depth[index],
            place.z,
        ]
    };
    (0..surface.nodes.len()).map(node).collect()
}

fn csv(points: impl Iterator<Item = Point>) -> String {
    let mut text = String::from("x_mm,y_mm,z_mm\n");
    for [x, y, z] in points {
        writeln!(text, "{x},{y},{z}").unwrap();
    }
    text
}

fn as_stl(surface: &SurfaceFields, points: &[Point]) -> String {
    let corner = |node: u32| points[node as usize];
    let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c].map(corner), [a, c, d].map(corner)];
    stl(&surface.quads.iter().flat_map(halves).collect::<Vec<_>>())
}

fn as_ply(surface: &SurfaceFields, points: &[Point]) -> String {
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        points.len(),
        surface.quads.len()
    );
    for [x, y, z] in points {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    for [a, b, c, d] in &surface.quads {
        writeln!(text, "4 {a} {b} {c} {d}").unwrap();
    }
    text
}

/// How far the registration puts moved points from where they came, mm, at most.
fn left_over(surface: &Value, points: &[Point], of: impl Fn(Point) -> Point) -> f64 {
    let number = |value: &Value| value.as_f64().unwrap();
    let registration = &surface["registration"];
    let back = |p: Point| {
        let row = |i: usize| {
            let turned: f64 = (0..3)
                .map(|j| number(&registration["rotation"][i][j]) * p[j])
                .sum();
            turned + number(&registration["translation_mm"][i])
        };
        [row(0), row(1), row(2)]
    };
    let apart = |p: &Point| {
        let found = back(of(*p));
        (0..3)
            .map(|i| (found[i] - p[i]).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    points.iter().map(apart).fold(0.0, f64::max)
}

fn number(json: &Value, keys: [&str; 2]) -> f64 {
    json[keys[0]][keys[1]].as_f64().unwrap()
}

#[test]
fn verify_points_without_noise_find_their_place_and_the_same_depths() {
    let bench = measured_bench();
    let points = nodes(&worn(&bench), 0.0, 0.0);
    bench.write("scan.csv", &csv(points.iter().copied().map(moved)));
    let json = &compared(&bench, "[surface]\nfile = \"scan.csv\"\n")["surface"];
    assert!(left_over(json, &points, moved) < 1e-4);
    assert!(
        number(json, ["everywhere", "rms_mm"]) < ALIKE_MM,
        "{}",
        json["everywhere"]
    );
    assert!(
        number(json, ["worst", "difference_mm"]).abs() < 0.02,
        "{}",
        json["worst"]
    );
    assert!(json["covered_area_share"].as_f64().unwrap() > 0.85);
}

#[test]
fn verify_noise_of_ten_micrometres_moves_the_scan_by_less() {
    let bench = measured_bench();
    let points = nodes(&worn(&bench), 0.01, 0.0);
    let exact = nodes(&worn(&bench), 0.0, 0.0);
    bench.write("scan.csv", &csv(points.iter().copied().map(moved)));
    let json = &compared(&bench, "[surface]\nfile = \"scan.csv\"\n")["surface"];
    // What noise along y moves the exact points by, through the same motion.
    assert!(
        left_over(json, &exact, moved) < 0.02,
        "{}",
        left_over(json, &exact, moved)
    );
    let residual = number(json, ["registration", "residual_rms_mm"]);
    assert!((0.006..0.012).contains(&residual), "{residual}");
    let rms = number(json, ["everywhere", "rms_mm"]);
    assert!((0.004..0.012).contains(&rms), "{rms}");
    assert!(number(json, ["everywhere", "mean_mm"]).abs() < 0.001);
}

#[test]
fn verify_deeper_scars_are_measured_as_much_deeper() {
    // Archard's scar is deeper than that of the default law, by more than what the fit of the scan takes out.
    let bench = Bench::with_case(&format!("{SMALL}[wear]\nlaw = \"archard\"\n"));
    bench.run_into("out");
    let surface = worn(&bench);
    let points = nodes(&surface, 0.0, 0.25);
    bench.write("scan.csv", &csv(points.iter().copied().map(moved)));
    let json = &compared(&bench, "[surface]\nfile = \"scan.csv\"\n")["surface"];
    let ratio = json["scanned_volume_mm3"].as_f64().unwrap()
        / json["predicted_volume_mm3"].as_f64().unwrap();
    assert!((ratio - 1.25).abs() < 0.02, "{ratio}");
    let deepest = &json["deepest_scanned"];
    let ratio = deepest["scanned_mm"].as_f64().unwrap() / deepest["predicted_mm"].as_f64().unwrap();
    assert!((ratio - 1.25).abs() < 0.03, "{ratio}");
    let predicted = number(json, ["deepest_predicted", "predicted_mm"]);
    assert!((predicted / bench.summary("out")[&catalogue::MAX_DEPTH_MM] - 1.0).abs() < 0.01);
    assert!(
        json["notes"][0]
            .as_str()
            .unwrap()
            .contains("half of the creep")
    );
}

#[test]
fn verify_a_scan_in_the_frame_of_the_results_is_compared_as_it_is() {
    let bench = measured_bench();
    bench.write(
        "scan.csv",
        &csv(nodes(&worn(&bench), 0.0, 0.25).into_iter()),
    );
    let json = &compared(
        &bench,
        "[surface]\nfile = \"scan.csv\"\nfit = \"nothing\"\n",
    )["surface"];
    assert_eq!(json["registration"]["steps"], 0);
    assert_eq!(json["registration"]["shift_mm"], 0.0);
    let [scanned, predicted] =
        ["scanned_volume_mm3", "predicted_volume_mm3"].map(|key| json[key].as_f64().unwrap());
    assert!(
        (scanned / predicted - 1.25).abs() < 0.02,
        "{scanned} {predicted}"
    );
}

#[test]
fn an_stl_in_metres_with_other_axes_is_the_same_scan() {
    let bench = measured_bench();
    let surface = worn(&bench);
    let points = nodes(&surface, 0.0, 0.0);
    let place = |p: &Point| {
        let [x, y, z] = moved(*p);
        [-x / 1000.0, y / 1000.0, -z / 1000.0]
    };
    bench.write(
        "scan.stl",
        &as_stl(&surface, &points.iter().map(place).collect::<Vec<_>>()),
    );
    let measured = "[surface]\nfile = \"scan.stl\"\nlength_unit = \"m\"\n\
                    axes = [\"posterior\", \"superior\", \"left\"]\n";
    let json = &compared(&bench, measured)["surface"];
    assert!(left_over(json, &points, moved) < 1e-3);
    assert!(
        number(json, ["everywhere", "rms_mm"]) < ALIKE_MM,
        "{}",
        json["everywhere"]
    );
}

#[test]
fn a_ply_far_away_is_brought_near_by_start_mm() {
    let bench = measured_bench();
    let surface = worn(&bench);
    let points = nodes(&surface, 0.0, 0.0);
    let far = |p: Point| {
        let [x, y, z] = moved(p);
        [x + 300.0, y, z - 80.0]
    };
    bench.write(
        "scan.ply",
        &as_ply(
            &surface,
            &points.iter().copied().map(far).collect::<Vec<_>>(),
        ),
    );
    let table = "[surface]\nfile = \"scan.ply\"\nfit = \"all\"\n";
    assert_refused(
        &bench,
        table,
        &[
            "only 0 of",
            "points of the scan are near the fitted part of the insert",
            "start_mm",
        ],
    );
    let json = &compared(&bench, &format!("{table}start_mm = [-300, 0, 80]\n"))["surface"];
    assert!(left_over(json, &points, moved) < 1e-4);
    assert!(bench.path("out/compare/compare_surface.csv").is_file());
}

#[test]
fn a_region_to_fit_may_be_given_and_the_rest_is_still_compared() {
    let bench = measured_bench();
    let points = nodes(&worn(&bench), 0.0, 0.5);
    bench.write("scan.csv", &csv(points.iter().copied().map(moved)));
    let table = "[surface]\nfile = \"scan.csv\"\nfit = \"region\"\nfit_z_mm = [-8, 8]\n";
    let json = &compared(&bench, table)["surface"];
    let unworn = nodes(&worn(&bench), 0.0, 0.0);
    assert!(
        left_over(json, &unworn, moved) < 0.02,
        "{}",
        left_over(json, &unworn, moved)
    );
    let said = bench.say(&["compare", "out", "measured.toml"]);
    for words in [
        "registered by a rotation of",
        "in the scars",
        "deepest scanned",
        "half of the creep",
    ] {
        assert!(said.out.contains(words), "{words}: {}", said.out);
    }
}

#[test]
fn a_part_of_the_insert_is_compared_where_it_was_scanned() {
    let bench = measured_bench();
    let points = nodes(&worn(&bench), 0.0, 0.0);
    let medial = points.iter().filter(|point| point[2] < 2.0).copied();
    bench.write("scan.csv", &csv(medial.map(moved)));
    let json = &compared(&bench, "[surface]\nfile = \"scan.csv\"\n")["surface"];
    let covered = json["covered_area_share"].as_f64().unwrap();
    assert!((0.4..0.6).contains(&covered), "{covered}");
    assert!(
        json["notes"][1]
            .as_str()
            .unwrap()
            .contains("the scan covers")
    );
    assert!(number(json, ["everywhere", "rms_mm"]) < ALIKE_MM);
    let svg = read(&bench.path("out/compare/compare_surface.svg"));
    let first = json["notes"].to_string();
    let lateral = points.iter().filter(|point| point[2] > -2.0).copied();
    bench.write("scan.csv", &csv(lateral));
    let json = &compared(&bench, "[surface]\nfile = \"scan.csv\"\n")["surface"];
    // The deepest place is in one of the two scans only.
    let said = [first, json["notes"].to_string()];
    let outside = said.map(|notes| notes.contains("lies on the rim or outside the scan"));
    assert_ne!(outside[0], outside[1]);
    assert!(svg.contains("Scanned") && !svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn a_scan_of_another_insert_or_scale_is_doubtful() {
    let bench = measured_bench();
    let points = nodes(&worn(&bench), 0.0, 0.0);
    let scaled = |by: f64, up: f64| {
        let larger = move |[x, y, z]: &Point| [by * x, by * y + up, by * z];
        csv(points.iter().map(larger))
    };
    let notes = |keys: &str| {
        let table = format!("[surface]\nfile = \"scan.csv\"\n{keys}");
        let json = compared(&bench, &table);
        json["surface"]["notes"].to_string()
    };
    let doubt = "doubtful: where no wear is predicted";
    bench.write("scan.csv", &scaled(1.02, 0.0));
    assert!(notes("").contains(doubt), "{}", notes(""));
    bench.write("scan.csv", &scaled(1.0, 0.0));
    assert!(!notes("").contains(doubt), "{}", notes(""));
    bench.write("scan.csv", &scaled(1.0, 0.2));
    let negative = "the scanned volume is negative";
    assert!(!notes("").contains(negative));
    assert!(notes("fit = \"nothing\"\n").contains(negative));
}

#[test]
fn a_scan_of_another_unit_or_inside_out_is_refused_with_this_reason() {
    let bench = measured_bench();
    let surface = worn(&bench);
    let points = nodes(&surface, 0.0, 0.0);
    let in_m: Vec<Point> = points.iter().map(|p| p.map(|one| one / 1000.0)).collect();
    bench.write("scan.stl", &as_stl(&surface, &in_m));
    let table = "[surface]\nfile = \"scan.stl\"\n";
    assert_refused(
        &bench,
        table,
        &["the scan is 0.0", "mm large", "check length_unit"],
    );
    let mut reversed = surface.clone();
    reversed.quads.iter_mut().for_each(|quad| quad.reverse());
    bench.write("scan.stl", &as_stl(&reversed, &points));
    assert_refused(
        &bench,
        table,
        &["only 0 of", "reverse the triangles of the scan"],
    );
}

#[test]
fn spikes_of_a_scan_are_left_out_and_counted() {
    let bench = measured_bench();
    let mut points = nodes(&worn(&bench), 0.0, 0.0);
    points
        .iter_mut()
        .skip(7)
        .step_by(50)
        .for_each(|point| point[1] -= 1.0);
    bench.write("scan.csv", &csv(points.iter().copied()));
    let table = "[surface]\nfile = \"scan.csv\"\n";
    let json = &compared(&bench, table)["surface"];
    let [scanned, predicted] =
        ["scanned_volume_mm3", "predicted_volume_mm3"].map(|key| json[key].as_f64().unwrap());
    assert!(
        (scanned / predicted - 1.0).abs() < 0.05,
        "{scanned} {predicted}"
    );
    assert!(json["outliers"].as_u64().unwrap() > 0);
    let said = bench.say(&["compare", "out", "measured.toml"]);
    assert!(
        said.out.contains("are left out") && said.out.contains("+/-"),
        "{}",
        said.out
    );
}

#[test]
fn a_scan_of_scars_deeper_than_is_looked_covers_nothing() {
    let bench = measured_bench();
    let surface = worn(&bench);
    let depth = surface.field("wear_depth_mm").unwrap();
    let points = nodes(&surface, 0.0, 0.0);
    let deep = (0..points.len()).filter(|&node| depth[node] > 0.02);
    bench.write("scan.csv", &csv(deep.map(|node| points[node])));
    let table = "[surface]\nfile = \"scan.csv\"\nfit = \"all\"\nfarthest_mm = 0.01\n";
    let expected = [
        "covers no node of the insert within 0.01 mm",
        "raise farthest_mm in [surface]",
    ];
    assert_refused(&bench, table, &expected);
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn bad_scans_are_refused_with_their_place() {
    let bench = measured_bench();
    let points = nodes(&worn(&bench), 0.0, 0.0);
    bench.write("scan.csv", &csv(points.iter().copied().map(moved)));
    bench.write("few.csv", &csv(points.iter().copied().take(5)));
    bench.write("names.csv", "x,y,z\n1,2,3\n");
    bench.write("bad.csv", "x_mm,y_mm,z_mm\n1,2,3\n1,two,3\n");
    bench.write("bad.stl", "solid a\nfacet normal 0 0 1\ninner loop\n");
    bench.write("scan.step", "ISO-10303-21;\n");
    let refuses = |rest: &str, expected: &[&str]| {
        assert_refused(&bench, &format!("[surface]\n{rest}\n"), expected);
    };
    refuses(
        "file = \"few.csv\"",
        &["`x_mm` has 5 numbers where 12 are needed", "few.csv:1:1"],
    );
    refuses(
        "file = \"names.csv\"",
        &["no column `x_mm` in names.csv", "it has x, y, z"],
    );
    refuses(
        "file = \"bad.csv\"",
        &["`two` in column `y_mm`", "bad.csv:3:3"],
    );
    refuses(
        "file = \"bad.stl\"",
        &[
            "bad.stl:3: \"inner\" is not a keyword of STL",
            "export the scan again",
        ],
    );
    refuses(
        "file = \"scan.step\"",
        &[
            "the extension \"step\" is not a known format",
            "measured.toml:2:8",
        ],
    );
    refuses(
        "file = \"scan.csv\"\nfit = \"region\"",
        &["needs `fit_x_mm`, `fit_z_mm` or both"],
    );
    refuses(
        "file = \"scan.csv\"\nfit = \"region\"\nfit_x_mm = [5, -5]",
        &["`fit_x_mm` is [5, -5]", "the smaller one first"],
    );
    refuses(
        "file = \"scan.csv\"\nfit_x_mm = [-5, 5]",
        &["`fit_x_mm` has no effect here", "fit = \"region\""],
    );
    refuses(
        "file = \"scan.csv\"\naxes = [\"anterior\", \"superior\", \"left\"]",
        &["`axes`", "left-handed"],
    );
    refuses(
        "file = \"scan.csv\"\nstart_mm = [1, 2]",
        &["`start_mm` must be a list of three numbers"],
    );
    refuses(
        "file = \"scan.csv\"\nfit = \"unwrn\"",
        &["`fit` cannot be \"unwrn\"", "did you mean \"unworn\""],
    );
    bench.write(
        "case.toml",
        "[insert]\nedge_mm = 3.5\nlayers = 1\n[march]\nupdates = 1\n",
    );
    bench.run_into("other");
    std::fs::copy(
        bench.path("other/insert_0001.vtu"),
        bench.path("out/insert_0003.vtu"),
    )
    .unwrap();
    let damaged = "insert_0003.vtu: the file is damaged";
    refuses("file = \"scan.csv\"", &[damaged, "--force"]);
    // A folder without hashes is read unchecked.
    std::fs::remove_file(bench.path("out/checksums")).unwrap();
    refuses(
        "file = \"scan.csv\"",
        &[
            "the first and the last mesh of the results have",
            "run the case again",
        ],
    );
    std::fs::remove_file(bench.path("out/insert_0000.vtu")).unwrap();
    refuses(
        "file = \"scan.csv\"",
        &["insert_0000.vtu: there is no such file", "[surface]"],
    );
}
