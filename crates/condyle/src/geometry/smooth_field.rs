//! The smooth distance field of a triangle mesh, without its facets.
//!
//! A mesh is a sample of a smooth surface, and its facets are not part of the implant. The field
//! is built in two steps. First the gap is computed at the nodes of a regular grid near the surface,
//! not to the flat facets but to the curved surface that the vertex normals imply (exact for any
//! quadratic surface). Then a quadratic B-spline through those gaps gives a value, a gradient and
//! a Hessian anywhere between the nodes, the first two continuous, from 27 numbers.

mod curvature_grid;
mod grid;
mod spline;
mod visibility;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use self::{
    curvature_grid::CurvatureGrid,
    grid::{NodeGrid, add_laplacian, bound_far_gaps, gaps_at_nodes, spline_coefficients},
    spline::GapSpline,
    visibility::{Visibility, places_on},
};
use condyle_mesh::{DividedMesh, TriangleMesh, repair::edge_report};

use super::surface_sample::{CurvatureBounds, SurfaceSample};
use crate::{Vec3, Vector, number::Number};

/// A smooth signed distance to a triangle mesh.
///
/// Clones share the large arrays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SmoothField {
    gap: GapSpline,
    /// Nodes beyond the band, whose gap is a bound.
    is_far: Arc<[bool]>,
    curvature: CurvatureGrid,
    /// Largest distance between the field's surface and the triangles next to each node, mm; 0 away from them.
    deviation_mm: Arc<[f32]>,
    /// Spread of the shares over which it is averaged, mm2; a stored field is averaged over none.
    #[serde(skip)]
    pub(super) spread_mm2: f64,
}

impl SmoothField {
    /// Returns the number of grid nodes of the field of `mesh`; its construction takes about 40 bytes per node.
    pub fn node_count(mesh: &TriangleMesh) -> usize {
        NodeGrid::around(mesh.bounds()).node_count()
    }

    /// Returns the number of grid nodes.
    pub fn nodes(&self) -> usize {
        self.is_far.len()
    }

    /// Creates the field of a surface whose triangles face outwards, computed on `threads` threads.
    ///
    /// The bytes of the result do not depend on `threads`; 1 starts no thread.
    pub fn new(mesh: &TriangleMesh, threads: usize) -> Self {
        let grid = NodeGrid::around(mesh.bounds());
        let seen = Visibility::from_mesh(mesh);
        let [mut gaps, across] = gaps_at_nodes(&grid, &DividedMesh::new(mesh), &seen, threads);
        // Only a closed surface has an inside far from its triangles.
        let is_far = bound_far_gaps(&grid, &mut gaps, edge_report(mesh).is_closed());
        // Not before: the space behind a wall is no inside.
        for (gap, across_mm) in gaps.iter_mut().zip(across) {
            if across_mm < 0.0 {
                *gap = across_mm;
            }
        }
        let gap = GapSpline::new(grid, spline_coefficients(&grid, &is_far, gaps));
        Self {
            curvature: CurvatureGrid::new(&gap),
            deviation_mm: deviations(mesh, &seen, &gap).into(),
            is_far: is_far.into(),
            gap,
            spread_mm2: 0.0,
        }
    }

    /// Returns the field averaged over flat shares of surface: g + `spread_mm2` div n.
    ///
    /// The bounds of the curvature remain valid: a mean is no sharper.
    pub(super) fn averaged_over(&self, spread_mm2: f64) -> Self {
        let grid = &self.gap.grid;
        let averaged = |to: &mut [f64], from: &[f64]| {
            add_laplacian(grid, &self.is_far, to, from, spread_mm2);
        };
        Self {
            gap: self.gap.changed(averaged),
            spread_mm2: self.spread_mm2 + spread_mm2,
            ..self.clone()
        }
    }

    #[inline(always)]
    pub(super) fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        let mut around = self
            .gap
            .nodes_at(points)
            .map(|node| self.curvature.around(node));
        let Some(mut bounds) = around.next() else {
            return CurvatureBounds::UNKNOWN;
        };
        for other in around {
            bounds = bounds.joined(other);
        }
        bounds
    }

    /// Returns the largest distance of the grid from the counterface frame's origin, mm.
    pub fn reach_mm(&self) -> f64 {
        self.gap.grid.reach_mm()
    }

    /// Returns the largest distance between the field's surface and the triangles of the mesh next to a point, mm.
    ///
    /// It is the chord error of the triangles, with the noise of a scan and the sharp edges that the field rounds.
    pub fn deviation_mm(&self, point: &Vec3) -> f64 {
        let nodes = self.gap.nodes_at(point);
        let deviations = nodes.map(|node| f64::from(self.deviation_mm[node]));
        deviations.fold(0.0, f64::max)
    }

    /// Returns the gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        self.gap.gap_mm(point)
    }

    /// Returns gap, normal and curvature at a point.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>) -> SurfaceSample<T> {
        self.gap.sample(point)
    }
}

/// Returns the largest distance between a spline's surface and the triangles next to each node that are seen, mm.
fn deviations(mesh: &TriangleMesh, seen: &Visibility, gap: &GapSpline) -> Vec<f32> {
    let mut deviations = vec![0.0; gap.grid.node_count()];
    for triangle in 0..mesh.triangles.len() {
        let corners = mesh.corners(triangle);
        if !seen.sees(&corners) {
            continue;
        }
        for place in places_on(&corners) {
            let distance = gap.gap_mm(&place).abs() as f32;
            for node in gap.nodes_at(&place) {
                deviations[node] = distance.max(deviations[node]);
            }
        }
    }
    deviations
}

#[cfg(test)]
mod tests {
    use super::{grid::BAND_MM, *};
    use crate::{Vec3, geometry::tests::check_derivatives};

    /// Returns a ball of radius 24 mm with edges of about `edge_mm`, by latitude and longitude, turned so that its
    /// poles lie where no test samples it.
    fn ball(edge_mm: f64) -> TriangleMesh {
        let rows = (std::f64::consts::PI * 24.0 / edge_mm) as u32;
        let columns = 2 * rows;
        let mut mesh = TriangleMesh::default();
        for row in 0..=rows {
            for column in 0..columns {
                let (theta, phi) = (
                    std::f64::consts::PI * f64::from(row) / f64::from(rows),
                    std::f64::consts::TAU * f64::from(column) / f64::from(columns),
                );
                let around = Vec3::new(
                    theta.cos(),
                    theta.sin() * phi.cos(),
                    theta.sin() * phi.sin(),
                );
                mesh.vertices.push(around * 24.0);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let (a, b) = (
                    row * columns + column,
                    row * columns + (column + 1) % columns,
                );
                mesh.triangles
                    .extend([[a, a + columns, b + columns], [a, b + columns, b]]);
            }
        }
        mesh
    }

    #[test]
    fn verify_ball_of_one_millimetre_edges_is_smooth_to_a_tenth_of_a_micrometre() {
        let field = SmoothField::new(&ball(1.0), 1);
        for i in 0..400 {
            let (along, across) = (0.01 * f64::from(i % 20), 0.013 * f64::from(i / 20));
            let direction = Vec3::new(along, -1.0, across).normalize();
            let sample = field.sample(&(direction * 23.8));
            assert!((sample.gap_mm + 0.2).abs() < 1e-4, "{}", sample.gap_mm);
            assert!((sample.normal - direction).norm() < 5e-4);
            let across = direction.cross(&Vec3::x()).normalize();
            let error = sample.curvature.times(&across) - across / 23.8;
            let along_surface = error - direction * direction.dot(&error);
            assert!(along_surface.norm() < 4e-3, "{along_surface}");
        }
    }

    #[test]
    fn verify_a_small_ball_is_as_smooth_as_a_large_one() {
        let mut small = ball(1.0);
        for vertex in &mut small.vertices {
            *vertex *= 3.6 / 24.0;
        }
        let field = SmoothField::new(&small, 1);
        for i in 0..400 {
            let (along, across) = (0.01 * f64::from(i % 20), 0.013 * f64::from(i / 20));
            let direction = Vec3::new(along, -1.0, across).normalize();
            let gap_mm = field.gap_mm(&(direction * 3.55));
            assert!((gap_mm + 0.05).abs() < 2e-4, "{gap_mm}");
        }
    }

    #[test]
    fn derivatives_hold_and_gap_agrees_with_sample() {
        let field = SmoothField::new(&ball(1.5), 1).averaged_over(0.05);
        for point in [Vec3::new(3.1, -23.9, 2.2), Vec3::new(-7.3, -22.6, 1.4)] {
            check_derivatives(|p| field.sample(p), point, 1e-7);
            assert!((field.gap_mm(&point) - field.sample(&point).gap_mm).abs() < 1e-12);
        }
    }

    #[test]
    fn averaging_adds_the_spread_times_the_divergence() {
        let plain = SmoothField::new(&ball(1.0), 1);
        let point = Vec3::new(1.0, -23.9, 0.5);
        let raised = plain.averaged_over(0.05).gap_mm(&point) - plain.gap_mm(&point);
        assert!((raised - 0.05 * 2.0 / 24.0).abs() < 1e-4, "{raised}");
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bytes() {
        let mesh = ball(2.0);
        let [one, two, three] = [1, 2, 3].map(|threads| SmoothField::new(&mesh, threads));
        assert!(one == two && two == three);
    }

    #[test]
    fn verify_the_surface_of_a_shell_does_not_depend_on_its_wall() {
        let outer = ball(1.5);
        let below = |triangle: &&[u32; 3]| {
            triangle
                .iter()
                .all(|&v| outer.vertices[v as usize].y < -8.0)
        };
        let cap: Vec<[u32; 3]> = outer.triangles.iter().filter(below).copied().collect();
        let count = outer.vertices.len() as u32;
        for wall_mm in [1.5, 3.0, 4.0, 6.0] {
            let mut shell = outer.clone();
            let inner = outer
                .vertices
                .iter()
                .map(|vertex| vertex * (1.0 - wall_mm / 24.0));
            shell.vertices.extend(inner);
            let inner = cap
                .iter()
                .map(|[a, b, c]| [a + count, c + count, b + count]);
            shell.triangles = cap.iter().copied().chain(inner).collect();
            let field = SmoothField::new(&shell, 1);
            for i in 0..100 {
                let (along, across) = (0.05 * f64::from(i % 10), 0.04 * f64::from(i / 10));
                let direction = Vec3::new(along, -1.0, across).normalize();
                for depth_mm in [0.0, 0.3] {
                    let gap_mm = field.gap_mm(&(direction * (24.0 - depth_mm)));
                    assert!((gap_mm + depth_mm).abs() < 3e-4, "{wall_mm}: {gap_mm}");
                }
                // The chord error of edges of 1.5 mm, whose diagonal is 2.1 mm, is 0.023 mm.
                let deviation_mm = field.deviation_mm(&(direction * 24.0));
                assert!(deviation_mm < 0.025, "{wall_mm}: {deviation_mm}");
            }
        }
    }

    #[test]
    fn far_points_are_apart() {
        let field = SmoothField::new(&ball(2.0), 1);
        // Outside the grid the gap is a bound below the distance.
        let outside = field.gap_mm(&Vec3::new(0.0, -200.0, 0.0));
        assert!(outside > BAND_MM && outside < 176.0, "{outside}");
        assert!(field.sample(&Vec3::new(0.0, -29.0, 0.0)).gap_mm > 2.0);
    }

    #[test]
    fn an_open_surface_has_no_inside_beyond_its_band() {
        let mut cap = ball(1.5);
        let is_low = |triangle: &[u32; 3]| {
            let below = |&vertex: &u32| cap.vertices[vertex as usize].y < -15.0;
            triangle.iter().all(below)
        };
        cap.triangles = cap.triangles.iter().copied().filter(is_low).collect();
        let used = |i: usize| cap.triangles.iter().flatten().any(|&v| v as usize == i);
        let low = cap.vertices[cap.triangles[0][0] as usize];
        for i in 0..cap.vertices.len() {
            if !used(i) {
                cap.vertices[i] = low;
            }
        }
        let field = SmoothField::new(&cap, 1);
        for x in -5..=5 {
            let x = 4.5 * f64::from(x);
            for y in [-12.0, -13.5] {
                let gap_mm = field.gap_mm(&Vec3::new(x, y, 0.0));
                let behind_mm = 24.0 - x.hypot(y);
                assert!(behind_mm < 4.5 || gap_mm > 0.0, "{x} {y}: {gap_mm}");
            }
        }
        assert!((field.gap_mm(&Vec3::new(0.0, -23.0, 0.0)) + 1.0).abs() < 1e-3);
    }
}
