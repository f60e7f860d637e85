//! The smooth distance field of a triangle mesh: facets are not felt.
//!
//! A mesh is a sample of a smooth surface, and its facets are not part of the implant. The field
//! is built in two steps. First the gap is found at the nodes of a regular grid near the surface,
//! not to the flat facets but to the curved surface that the vertex normals imply (exact for any
//! quadratic surface). Then a quadratic B-spline through those gaps gives a value, a gradient and
//! a Hessian anywhere between the nodes, the first two continuous, from 27 numbers.

use serde::{Deserialize, Serialize};

use super::{
    Curvature, CurvatureBounds, SurfaceSample, TriangleMesh,
    curvature_grid::CurvatureGrid,
    curved_mesh::CurvedMesh,
    shell_report,
    spline::{Bases, Derivatives},
};
use crate::{
    Vec3, Vector,
    number::{F64x4, LANES, Number},
};

/// Distance between grid nodes, mm: the spline's error on a ball of radius 20 mm is then below
/// 0.1 micrometre.
const SPACING_MM: f64 = 1.25;

/// Grid nodes this close to the surface get a true gap, mm: the deepest overclosure that a run
/// may reach, and the spline's footprint around it.
const BAND_MM: f64 = 3.5;

/// Gap of the grid nodes beyond the band until a bound is found, mm.
const FAR_MM: f64 = 1e3;

/// Gap of points outside the grid, mm: a lower bound, since the grid reaches further than that
/// beyond the surface.
const OUTSIDE_MM: f64 = BAND_MM + SPACING_MM;

/// A smooth signed distance to a triangle mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SmoothField {
    /// Position of grid node (0, 0, 0).
    origin: Vec3,
    /// Grid nodes along x, y, z; x runs fastest.
    dims: [usize; 3],
    /// Coefficients of the spline, mm.
    coefficients: Vec<f64>,
    /// Nodes beyond the band: their gap is a bound.
    is_far: Vec<bool>,
    /// How the field bends around any point.
    bends: CurvatureGrid,
}

#[inline(always)]
fn least<T: Number>(a: T, b: T) -> T {
    -(-a).max(-b)
}

/// The 27 coefficients that reach a point, lane by lane.
struct Neighbourhood<T> {
    /// Number of the first of them in every lane.
    corner: [u32; LANES],
    bases: Bases<T>,
    /// Below zero outside the grid.
    inside: T,
}

impl SmoothField {
    /// The field of a surface whose triangles face outwards, made on `threads` threads.
    ///
    /// The bytes of the result do not depend on `threads`.
    pub fn new(mesh: &TriangleMesh, threads: usize) -> Self {
        let margin = Vec3::repeat(BAND_MM + 2.0 * SPACING_MM);
        let (low, high) = mesh.bounds();
        let origin = low - margin;
        let dims =
            [0, 1, 2].map(|axis| ((high + margin - origin)[axis] / SPACING_MM).ceil() as usize + 1);
        let mut field = Self {
            origin,
            dims,
            coefficients: Vec::new(),
            is_far: Vec::new(),
            bends: CurvatureGrid::default(),
        };
        field.coefficients = field.gaps_at_nodes(&CurvedMesh::new(mesh), threads.max(1));
        field.bound_far_gaps(shell_report(mesh).is_closed());
        for stride in field.strides() {
            let before = field.coefficients.clone();
            field.add_second_differences(&before, stride, -1.0 / 8.0);
        }
        // A row is read as four coefficients, of which it uses three.
        field.coefficients.push(0.0);
        field.bends = CurvatureGrid::new(&field);
        field
    }

    /// The field averaged over flat shares of surface: g + `spread_mm2` div n.
    ///
    /// What bounds its curvature still does: a mean bends no more.
    pub fn averaged_over(mut self, spread_mm2: f64) -> Self {
        let factor = spread_mm2 / (SPACING_MM * SPACING_MM);
        let unaveraged = self.coefficients.clone();
        for stride in self.strides() {
            self.add_second_differences(&unaveraged, stride, factor);
        }
        self
    }

    /// Bounds on the surface around points, in every lane.
    #[inline(always)]
    pub fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        let corners = self.locate(points).corner;
        let [sx, sy, sz] = self.strides();
        let around = |&corner: &u32| self.bends.around(corner as usize + sx + sy + sz);
        let lanes = corners[..T::COUNT].iter().map(around);
        lanes
            .reduce(CurvatureBounds::joined)
            .unwrap_or(CurvatureBounds::UNKNOWN)
    }

    /// Distance between the nodes of the grid, mm.
    pub(super) fn spacing_mm(&self) -> f64 {
        SPACING_MM
    }

    /// How many nodes the grid has.
    pub(super) fn node_count(&self) -> usize {
        self.is_far.len()
    }

    /// Numbers and places of the nodes within the grid.
    pub(super) fn inner_nodes(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let [nx, ny, nz] = self.dims;
        let [sx, sy, sz] = self.strides();
        let layers = (1..nz - 1).flat_map(move |k| (1..ny - 1).map(move |j| (j, k)));
        layers.flat_map(move |(j, k)| {
            (1..nx - 1).map(move |i| (i * sx + j * sy + k * sz, self.node_position(i, j, k)))
        })
    }

    /// How far from the femoral frame's origin the grid reaches, mm.
    pub fn reach_mm(&self) -> f64 {
        let size = Vec3::from(self.dims.map(|count| count as f64)) * SPACING_MM;
        self.origin.abs().sup(&(self.origin + size).abs()).norm()
    }

    /// Gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        self.spline(point).value
    }

    /// Gap, normal and curvature at a point.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>) -> SurfaceSample<T> {
        sample_from(&self.spline(point))
    }

    /// The spline and its derivatives at a point; outside the grid its value is a bound.
    #[inline(always)]
    fn spline<T: Number>(&self, point: &Vector<T>) -> Derivatives<T> {
        let here = self.locate(point);
        let spline = here.bases.spline(|lane| self.rows(here.corner[lane]));
        Derivatives {
            value: here.inside.below_zero(T::splat(OUTSIDE_MM), spline.value),
            ..spline
        }
    }

    /// The coefficients that reach a point, and the bases there.
    #[inline(always)]
    fn locate<T: Number>(&self, point: &Vector<T>) -> Neighbourhood<T> {
        let (one, half) = (T::one(), T::splat(0.5));
        let strides = self.strides();
        let (mut corner, mut inside) = (T::zero(), one);
        let mut away = |axis: usize| {
            let place = (point[axis] - T::splat(self.origin[axis])) * T::splat(1.0 / SPACING_MM);
            let last = T::splat((self.dims[axis] - 2) as f64);
            let node = least((place + half).floor(), last).max(one);
            inside = least(inside, least(place - half, last + half - place));
            corner += (node - one) * T::splat(strides[axis] as f64);
            place - node
        };
        let bases = Bases::at([away(0), away(1), away(2)]);
        let mut corners = [0; LANES];
        for (lane, first) in corners.iter_mut().enumerate().take(T::COUNT) {
            *first = corner.lane(lane) as u32;
        }
        Neighbourhood {
            corner: corners,
            bases,
            inside,
        }
    }

    /// The coefficients from a corner on: row `j` of layer `k`, and one number more.
    ///
    /// One look at the last says that all are there: strides of 32 bits cannot overflow their sum, so
    /// that the compiler leaves out the nine looks at each row.
    #[inline(always)]
    fn rows(&self, corner: u32) -> impl Fn(usize, usize) -> F64x4 {
        let [_, sy, sz] = self.strides().map(|stride| stride as u32 as usize);
        let (corner, all) = (corner as usize, &self.coefficients[..]);
        assert!(
            corner + 2 * sy + 2 * sz + LANES <= all.len(),
            "locate keeps one node of margin on every side"
        );
        move |j, k| {
            let from = corner + j * sy + k * sz;
            F64x4::new([all[from], all[from + 1], all[from + 2], all[from + 3]])
        }
    }

    #[inline]
    pub(super) fn strides(&self) -> [usize; 3] {
        [1, self.dims[0], self.dims[0] * self.dims[1]]
    }

    /// The gap at every grid node, each thread filling its own slab of nodes.
    fn gaps_at_nodes(&self, mesh: &CurvedMesh<'_>, threads: usize) -> Vec<f64> {
        let slab = self.dims[0] * self.dims[1];
        let mut gaps = vec![FAR_MM; slab * self.dims[2]];
        let layers = self.dims[2].div_ceil(threads);
        std::thread::scope(|scope| {
            for (index, part) in gaps.chunks_mut(slab * layers).enumerate() {
                scope.spawn(move || self.fill_layers(mesh, index * layers, part));
            }
        });
        gaps
    }

    /// Fills the layers of nodes from `first_layer` with their gaps to the nearest triangle.
    fn fill_layers(&self, mesh: &CurvedMesh<'_>, first_layer: usize, gaps: &mut [f64]) {
        let slab = self.dims[0] * self.dims[1];
        let last_layer = first_layer + gaps.len() / slab;
        let mut nearest2 = vec![BAND_MM * BAND_MM; gaps.len()];
        let mut owner = vec![u32::MAX; gaps.len()];
        for triangle in 0..mesh.triangle_count() {
            let [low, high] = self.nodes_around(mesh.corners(triangle));
            for k in low[2].max(first_layer)..high[2].min(last_layer) {
                for j in low[1]..high[1] {
                    for i in low[0]..high[0] {
                        let here = i + self.dims[0] * (j + self.dims[1] * (k - first_layer));
                        let node = self.node_position(i, j, k);
                        if mesh.plane_distance2(triangle, &node) >= nearest2[here] {
                            continue;
                        }
                        let distance2 = mesh.distance2(triangle, &node);
                        if distance2 < nearest2[here] {
                            (nearest2[here], owner[here]) = (distance2, triangle as u32);
                        }
                    }
                }
            }
        }
        for (here, (gap, owner)) in gaps.iter_mut().zip(owner).enumerate() {
            if owner != u32::MAX {
                let (i, j, k) = (
                    here % self.dims[0],
                    here / self.dims[0] % self.dims[1],
                    here / slab,
                );
                *gap =
                    mesh.curved_gap_mm(owner as usize, &self.node_position(i, j, k + first_layer));
            }
        }
    }

    /// Gives the nodes beyond the band a lower bound of their distance: along the grid lines a path
    /// is at most sqrt 3 times as long as the straight way.
    ///
    /// Far inside a closed surface it is negative. An open one has no inside: past its rim, a sign
    /// carried round from its back would make the insert overlap it.
    fn bound_far_gaps(&mut self, is_closed: bool) {
        const STRAIGHT_PER_PATH: f64 = 0.577;
        let step = SPACING_MM * STRAIGHT_PER_PATH;
        let strides = self.strides();
        let count = self.coefficients.len();
        self.is_far = self.coefficients.iter().map(|&gap| gap == FAR_MM).collect();
        let mut near = |here: usize, there: usize| {
            let (own, gap) = (self.coefficients[here], self.coefficients[there]);
            if self.is_far[here] && gap.abs() + step < own.abs() {
                let sign = if is_closed { gap.signum() } else { 1.0 };
                self.coefficients[here] = sign * (gap.abs() + step);
            }
        };
        for here in 0..count {
            strides
                .iter()
                .filter(|&&stride| here >= stride)
                .for_each(|stride| near(here, here - stride));
        }
        for here in (0..count).rev() {
            strides
                .iter()
                .filter(|&&stride| here + stride < count)
                .for_each(|stride| near(here, here + stride));
        }
    }

    fn node_position(&self, i: usize, j: usize, k: usize) -> Vec3 {
        self.origin + Vec3::new(i as f64, j as f64, k as f64) * SPACING_MM
    }

    /// First and one past the last grid node along each axis within the band of a triangle.
    fn nodes_around(&self, corners: [Vec3; 3]) -> [[usize; 3]; 2] {
        let [a, b, c] = corners.map(|corner| (corner - self.origin) / SPACING_MM);
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let band = BAND_MM / SPACING_MM;
        let first = [0, 1, 2].map(|axis| (low[axis] - band).ceil().max(0.0) as usize);
        let end =
            [0, 1, 2].map(|axis| ((high[axis] + band).floor() as usize + 1).min(self.dims[axis]));
        [first, end]
    }

    /// Adds `factor` times the second difference along one axis of `from`, where no node of it is
    /// beyond the band.
    fn add_second_differences(&mut self, from: &[f64], stride: usize, factor: f64) {
        for i in stride..self.is_far.len() - stride {
            let (before, after) = (i - stride, i + stride);
            if !(self.is_far[before] || self.is_far[i] || self.is_far[after]) {
                self.coefficients[i] += factor * (from[before] - 2.0 * from[i] + from[after]);
            }
        }
    }
}

/// Gap, unit normal and curvature from the spline.
#[inline(always)]
fn sample_from<T: Number>(spline: &Derivatives<T>) -> SurfaceSample<T> {
    let Derivatives {
        value: gap_mm,
        gradient,
        bend,
    } = *spline;
    let gap_gradient = Vector::from(gradient.map(|slope| slope * T::splat(1.0 / SPACING_MM)));
    // Far from the surface the gap is constant and the normal none, rather than not a number.
    let length = Number::max(
        gap_gradient.dot(&gap_gradient).sqrt(),
        T::splat(f64::MIN_POSITIVE),
    );
    let per_length = T::one() / length;
    let scale = per_length * T::splat(1.0 / (SPACING_MM * SPACING_MM));
    let [xx, yy, zz, xy, xz, yz] = bend.map(|entry| entry * scale);
    SurfaceSample {
        gap_mm,
        gap_gradient,
        normal: gap_gradient * per_length,
        curvature: Curvature {
            xx,
            yy,
            zz,
            xy,
            xz,
            yz,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::torus::tests::check_derivatives;

    /// A ball of radius 24 mm with edges of about `edge_mm`, by latitude and longitude, turned so
    /// that its poles lie where nobody looks.
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
        let raised = plain.clone().averaged_over(0.05).gap_mm(&point) - plain.gap_mm(&point);
        assert!((raised - 0.05 * 2.0 / 24.0).abs() < 1e-4, "{raised}");
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bytes() {
        let mesh = ball(2.0);
        let [one, two, three] = [1, 2, 3].map(|threads| SmoothField::new(&mesh, threads));
        assert!(one == two && two == three);
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
