//! The part of a counterface that a bearing below it can touch.

use std::f64::consts::TAU;

use condyle_mesh::{TriangleMesh, bounds};

use crate::{Mat3, Vec3};

/// Angles from straight down of the directions of view, degrees, and the number of directions at each: those in which the bearing lies
/// as the counterface flexes.
const RINGS: [(f64, u32); 3] = [(0.0, 1), (35.0, 6), (70.0, 10)];
/// Smallest cosine of the angle between a normal and a direction from which it is seen: a more oblique surface spreads over too many
/// cells of depth, and another direction sees it.
const MIN_COSINE: f64 = 0.4;
/// Width of a cell of a view, mm: above the distance between the places of a triangle that are seen.
const CELL_MM: f64 = 1.25;
/// Depth behind the frontmost surface up to which a place belongs to it, mm: more than a cell's chord, and less than the width of the
/// hollow between the wall that is seen and the one behind.
const SLACK_MM: f64 = 2.0;

/// A mesh seen from below, in several directions: the inside of a hollow shell and the side that is fixed to bone are hidden.
pub struct Visibility(Vec<View>);

/// The frontmost surface in cells across a direction.
struct View {
    /// Rows: two directions across, and the direction from the body to the viewer.
    frame: Mat3,
    low: Vec3,
    columns: usize,
    front_mm: Vec<f64>,
}

impl Visibility {
    /// Looks at a mesh of a counterface, which lies above its bearing.
    pub fn from_mesh(mesh: &TriangleMesh) -> Self {
        let ring = |(tilt_deg, count): (f64, u32)| {
            let (sine, cosine) = f64::to_radians(tilt_deg).sin_cos();
            (0..count).map(move |i| {
                let (across, along) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
                Vec3::new(sine * along, -cosine, sine * across)
            })
        };
        let directions = RINGS.into_iter().flat_map(ring);
        Self(directions.map(|to| View::new(mesh, to)).collect())
    }

    /// Returns whether a triangle of the surface is seen, by its middle.
    pub fn sees(&self, [a, b, c]: &[Vec3; 3]) -> bool {
        let middle = (a + b + c) / 3.0;
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
        normal.is_some_and(|normal| self.0.iter().any(|view| view.sees(&middle, &normal)))
    }
}

impl View {
    fn new(mesh: &TriangleMesh, to_viewer: Vec3) -> Self {
        let across = to_viewer.cross(&Vec3::z()).normalize();
        let frame = [across, to_viewer.cross(&across), to_viewer].map(|axis| axis.transpose());
        let frame = Mat3::from_rows(&frame);
        let vertices: Vec<Vec3> = mesh.vertices.iter().map(|vertex| frame * vertex).collect();
        let (low, high) = bounds(&vertices);
        let [columns, rows] = [0, 1].map(|axis| ((high - low)[axis] / CELL_MM) as usize + 1);
        let mut view = Self {
            frame,
            low,
            columns,
            front_mm: vec![f64::NEG_INFINITY; columns * rows],
        };
        for triangle in 0..mesh.triangles.len() {
            for place in places_on(&mesh.corners(triangle)) {
                let place = frame * place;
                let cell = view.cell(&place);
                view.front_mm[cell] = view.front_mm[cell].max(place.z);
            }
        }
        view
    }

    /// Returns the cell of a place in the frame of the view.
    fn cell(&self, place: &Vec3) -> usize {
        let [x, y] = [0, 1].map(|axis| ((place - self.low)[axis] / CELL_MM) as usize);
        (x + self.columns * y).min(self.front_mm.len() - 1)
    }

    fn sees(&self, place: &Vec3, normal: &Vec3) -> bool {
        let (place, cosine) = (self.frame * place, (self.frame * normal).z);
        if cosine < MIN_COSINE {
            return false;
        }
        // Within a cell, an oblique surface is nearer at one side than at the other.
        let within_cell_mm = CELL_MM * (1.0 / (cosine * cosine) - 1.0).max(0.0).sqrt();
        place.z > self.front_mm[self.cell(&place)] - within_cell_mm - SLACK_MM
    }
}

/// Returns places all over a triangle, at most half a cell apart; the middles of its sides at least, which are farthest from a curved
/// surface.
pub fn places_on([a, b, c]: &[Vec3; 3]) -> impl Iterator<Item = Vec3> + use<> {
    let (a, along, aside) = (*a, b - a, c - a);
    let longest = along.norm().max(aside.norm()).max((c - b).norm());
    let steps = ((longest / CELL_MM).ceil() as usize).max(1) * 2;
    (0..=steps).flat_map(move |i| {
        (0..=steps - i).map(move |j| {
            let [u, v] = [i, j].map(|part| part as f64 / steps as f64);
            a + along * u + aside * v
        })
    })
}
