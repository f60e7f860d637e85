//! What each body is: its size, its mesh, and what is wrong with it.

use condyle::{
    Vec3,
    evolve::March,
    geometry::{Dishes, TriangleMesh, bounds},
};
use condyle_io::{
    case::Case,
    config::{DataFile, Variants},
};
use serde::Serialize;

/// So far around the lowest place of a dish it is thinnest under the femur, mm.
const AROUND_DISH_MM: f64 = 10.0;

/// The femoral component.
#[derive(Debug, Serialize)]
pub struct FemurFacts {
    /// What it is made from.
    pub shape: &'static str,
    /// Its file without the folder, if it has one.
    pub file: Option<String>,
    /// Size antero-posterior, supero-inferior and medio-lateral, mm.
    pub size_mm: [f64; 3],
    /// Triangles of its mesh; none of a shape by measures.
    pub triangles: Option<usize>,
    /// What was found wrong in its file.
    pub defects: Vec<String>,
}

impl FemurFacts {
    pub(super) fn of(case: &Case, mesh: &TriangleMesh, warnings: &[String]) -> Self {
        let file = case.femur.file().map(DataFile::name);
        let (low, high) = mesh.bounds();
        Self {
            shape: case.femur.word(),
            size_mm: (high - low).into(),
            triangles: file.as_ref().map(|_| mesh.triangles.len()),
            defects: defects(file.as_deref(), warnings),
            file,
        }
    }
}

/// The insert as it is meshed.
#[derive(Debug, Serialize)]
pub struct InsertFacts {
    /// What it is made from.
    pub shape: &'static str,
    /// Its file without the folder, if it has one.
    pub file: Option<String>,
    /// Size antero-posterior, supero-inferior and medio-lateral, mm.
    pub size_mm: [f64; 3],
    /// Triangles of its file; none of hexahedra and of a shape by measures.
    pub triangles: Option<usize>,
    /// What was found wrong in its file.
    pub defects: Vec<String>,
    /// Hexahedra.
    pub hexahedra: usize,
    /// Nodes of the articulating surface.
    pub surface_nodes: usize,
    /// Smallest scaled Jacobian of a hexahedron.
    pub worst_quality: f64,
    /// Least thickness within 10 mm of the lowest place of the medial and of the lateral dish, mm.
    pub dish_thickness_mm: Option<[f64; 2]>,
    /// Middle between the dishes: anterior, superior and lateral of the origin, where the machine's axes are, mm.
    pub dishes_middle_mm: Option<[f64; 3]>,
}

impl InsertFacts {
    pub(super) fn of(case: &Case, march: &March, warnings: &[String]) -> Self {
        let insert = march.test().insert.as_ref();
        let file = case.insert.file().map(DataFile::name);
        let (mesh, places) = (insert.mesh(), insert.surface().positions);
        let dishes = Dishes::of(&places);
        let thickness = |dish: Vec3| least_around(&dish, &places, insert.thickness_mm());
        Self {
            shape: case.insert.word(),
            size_mm: size_of(&mesh.nodes),
            triangles: case.insert_triangle_count(),
            defects: defects(file.as_deref(), warnings),
            hexahedra: mesh.hexes.len(),
            surface_nodes: places.len(),
            worst_quality: mesh.worst_quality(),
            dish_thickness_mm: dishes.map(|d| [d.medial_mm, d.lateral_mm].map(thickness)),
            dishes_middle_mm: dishes.map(|dishes| dishes.middle_mm().into()),
            file,
        }
    }
}

fn defects(file: Option<&str>, warnings: &[String]) -> Vec<String> {
    file.map_or(Vec::new(), |file| found_in(file, warnings))
}

fn size_of(points: &[Vec3]) -> [f64; 3] {
    let (low, high) = bounds(points);
    (high - low).into()
}

/// Least value at the nodes around a dish.
fn least_around(dish: &Vec3, places: &[Vec3], values: &[f64]) -> f64 {
    let is_near = |place: &Vec3| (place - dish).norm() < AROUND_DISH_MM;
    let near = places
        .iter()
        .zip(values)
        .filter(|(place, _)| is_near(place));
    near.map(|(_, value)| *value).fold(f64::INFINITY, f64::min)
}

/// What a file's name begins a warning of it with is left out: what was found in that file.
fn found_in(file: &str, warnings: &[String]) -> Vec<String> {
    let start = format!("{file}: ");
    let of_file = warnings.iter().filter_map(|said| said.strip_prefix(&start));
    of_file.map(str::to_owned).collect()
}
