//! The generic femoral component: two condyles, each of two pieces of torus.

use condyle_mesh::TriangleMesh;

use super::{
    surface_sample::{Curvature, CurvatureBounds, SurfaceSample},
    torus::Torus,
};
use crate::{
    Mat3, Vec3, Vector,
    number::{Number, dot},
};

/// Dimensions of the generic femoral component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenericFemurShape {
    /// Sagittal radius of the distal arc.
    pub distal_radius_mm: f64,
    /// Sagittal radius of the posterior arc.
    pub posterior_radius_mm: f64,
    /// Angle behind straight down at which the distal arc passes into the posterior one.
    pub transition_deg: f64,
    /// Radius of the condyles across, in the frontal plane.
    pub coronal_radius_mm: f64,
    /// Distance between the two condyles' lowest points.
    pub spacing_mm: f64,
}

impl Default for GenericFemurShape {
    fn default() -> Self {
        Self {
            distal_radius_mm: 38.0,
            posterior_radius_mm: 22.0,
            transition_deg: 20.0,
            coronal_radius_mm: 24.0,
            spacing_mm: 46.0,
        }
    }
}

/// The generic femoral component in its own frame: origin on the axis of the posterior arc,
/// half-way between the condyles, about which it flexes.
///
/// In the sagittal plane the distal arc and the posterior arc share a tangent where they meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenericFemur {
    shape: GenericFemurShape,
    /// The lateral condyle's pieces, with the condyle's middle plane at z = 0.
    distal: Torus,
    posterior: Torus,
    /// Direction from either arc's centre to their common point.
    transition: Vec3,
    half_spacing_mm: f64,
}

impl GenericFemur {
    /// Creates the component of the given dimensions, all > 0.
    pub fn new(shape: GenericFemurShape) -> Self {
        let (sine, cosine) = shape.transition_deg.to_radians().sin_cos();
        let transition = Vec3::new(-sine, -cosine, 0.0);
        let torus = |centre, sagittal_radius_mm: f64| Torus {
            centre,
            ring_radius_mm: sagittal_radius_mm - shape.coronal_radius_mm,
            tube_radius_mm: shape.coronal_radius_mm,
        };
        let distal_centre = -transition * (shape.distal_radius_mm - shape.posterior_radius_mm);
        Self {
            shape,
            distal: torus(distal_centre, shape.distal_radius_mm),
            posterior: torus(Vec3::zeros(), shape.posterior_radius_mm),
            transition,
            half_spacing_mm: shape.spacing_mm / 2.0,
        }
    }

    /// Returns the dimensions.
    pub fn shape(&self) -> &GenericFemurShape {
        &self.shape
    }

    /// Returns the bounds around points: each condyle is convex, so they hold up to the plane half-way to the other
    /// one.
    #[inline(always)]
    pub(super) fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        // Across that plane the gap to the nearer condyle has a crease.
        let radius_mm = points.z.abs().least().min(CurvatureBounds::FARTHEST_MM);
        let shape = &self.shape;
        let sharpest_mm = shape.coronal_radius_mm.min(shape.posterior_radius_mm);
        CurvatureBounds::convex(1.0 / sharpest_mm.min(shape.distal_radius_mm), radius_mm)
    }

    /// Returns the largest distance of the component from the origin, mm.
    pub fn reach_mm(&self) -> f64 {
        self.distal.centre.norm() + self.shape.distal_radius_mm + self.half_spacing_mm
    }

    /// Returns the gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        let (folded, _) = self.folded(point);
        self.piece(&folded).gap_mm(&folded)
    }

    /// Returns gap, normal and curvature at a point, the gap averaged as in
    /// [`Counterface::sample`](super::Counterface::sample).
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        let (folded, side) = self.folded(point);
        let mut sample = self.piece(&folded).sample(&folded, spread_mm2);
        sample.gap_gradient.z *= side;
        sample.normal.z *= side;
        sample.curvature.xz *= side;
        sample.curvature.yz *= side;
        sample
    }

    /// Returns the point moved to the lateral condyle's middle plane, and the side it came from.
    #[inline(always)]
    fn folded<T: Number>(&self, point: &Vector<T>) -> (Vector<T>, T) {
        let side = point.z.below_zero(-T::one(), T::one());
        let across = point.z.abs() - T::splat(self.half_spacing_mm);
        (Vector::new(point.x, point.y, across), side)
    }

    /// Returns the piece on whose side of the line through both centres a point lies.
    #[inline(always)]
    fn piece<T: Number>(&self, point: &Vector<T>) -> Torus<T> {
        let in_front =
            T::splat(self.transition.x) * point.y - T::splat(self.transition.y) * point.x;
        let pick = |posterior: f64, distal: f64| {
            in_front.below_zero(T::splat(posterior), T::splat(distal))
        };
        let (posterior, distal) = (&self.posterior, &self.distal);
        Torus {
            centre: Vector::new(
                pick(posterior.centre.x, distal.centre.x),
                pick(posterior.centre.y, distal.centre.y),
                T::zero(),
            ),
            ring_radius_mm: pick(posterior.ring_radius_mm, distal.ring_radius_mm),
            tube_radius_mm: T::splat(distal.tube_radius_mm),
        }
    }
}

/// Start of the condyles' triangles, degrees behind straight down, ...
const FRONT_DEG: f64 = -50.0;
/// ... their end, ...
const BACK_DEG: f64 = 120.0;
/// ... and their extent on each side of the condyles' middle planes, mm.
const HALF_WIDTH_MM: f64 = 16.0;

impl GenericFemur {
    /// Returns the articulating surface as triangles of about `edge_mm`, for pictures and other programs.
    ///
    /// Both condyles from 50 degrees in front of straight down to 120 behind, 16 mm to each side.
    pub fn surface_mesh(&self, edge_mm: f64) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for side in [-1.0, 1.0] {
            self.add_condyle(&mut mesh, side, edge_mm);
        }
        mesh
    }

    fn add_condyle(&self, mesh: &mut TriangleMesh, side: f64, edge_mm: f64) {
        let tube = self.shape.coronal_radius_mm;
        let half_angle = (HALF_WIDTH_MM / tube).min(1.0).asin();
        let longest = (BACK_DEG - FRONT_DEG).to_radians() * self.shape.distal_radius_mm;
        let rows = (longest / edge_mm).ceil() as u32;
        let columns = (2.0 * half_angle * tube / edge_mm).ceil() as u32;
        let first = mesh.vertices.len() as u32;
        for row in 0..=rows {
            let angle = FRONT_DEG + (BACK_DEG - FRONT_DEG) * f64::from(row) / f64::from(rows);
            for column in 0..=columns {
                let across = half_angle * (2.0 * f64::from(column) / f64::from(columns) - 1.0);
                mesh.vertices.push(self.surface_point(angle, across, side));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let corner = first + row * (columns + 1) + column;
                let (a, b) = (corner, corner + 1);
                let (c, d) = (b + columns + 1, a + columns + 1);
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    /// Returns the point of the surface `behind_deg` behind straight down, `across` rad around the tube.
    fn surface_point(&self, behind_deg: f64, across: f64, side: f64) -> Vec3 {
        let torus = if behind_deg > self.shape.transition_deg {
            &self.posterior
        } else {
            &self.distal
        };
        let (sine, cosine) = behind_deg.to_radians().sin_cos();
        let reach = torus.ring_radius_mm + torus.tube_radius_mm * across.cos();
        let z = torus.tube_radius_mm * across.sin() + side * self.half_spacing_mm;
        torus.centre + Vec3::new(-sine * reach, -cosine * reach, z)
    }
}

/// A generic femoral component rotated and shifted in the femoral frame: its point p is at R p + t there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedFemur {
    femur: GenericFemur,
    /// R.
    rotation: Mat3,
    /// t.
    shift_mm: Vec3,
}

impl PlacedFemur {
    /// Rotates `femur` by `rotation`, and then shifts it by `shift_mm`.
    pub fn new(femur: GenericFemur, rotation: Mat3, shift_mm: Vec3) -> Self {
        Self {
            femur,
            rotation,
            shift_mm,
        }
    }

    /// Returns the component in its own frame.
    pub fn femur(&self) -> &GenericFemur {
        &self.femur
    }

    /// Converts a point of the component's own frame to the femoral frame.
    pub fn to_frame(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.shift_mm
    }

    /// Returns the largest distance of the component from the origin, mm.
    pub fn reach_mm(&self) -> f64 {
        self.femur.reach_mm() + self.shift_mm.norm()
    }

    /// Returns the gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        self.femur.gap_mm(&self.in_component(point))
    }

    /// Returns gap, normal and curvature at a point: R G, R n and R K R' of the component's own.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        let own = self.femur.sample(&self.in_component(point), spread_mm2);
        let rows = self.rows();
        let turned =
            |v: &Vector<T>| Vector::new(dot(&rows[0], v), dot(&rows[1], v), dot(&rows[2], v));
        let [along_x, along_y, along_z] = rows.map(|row| own.curvature.times(&row));
        SurfaceSample {
            gap_mm: own.gap_mm,
            gap_gradient: turned(&own.gap_gradient),
            normal: turned(&own.normal),
            curvature: Curvature {
                xx: dot(&rows[0], &along_x),
                yy: dot(&rows[1], &along_y),
                zz: dot(&rows[2], &along_z),
                xy: dot(&rows[0], &along_y),
                xz: dot(&rows[0], &along_z),
                yz: dot(&rows[1], &along_z),
            },
        }
    }

    #[inline(always)]
    pub(super) fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        self.femur.curvature_bounds(&self.in_component(points))
    }

    /// Returns the rows of R, in every lane.
    #[inline(always)]
    fn rows<T: Number>(&self) -> [Vector<T>; 3] {
        [0, 1, 2].map(|i| Vector::from_fn(|j, _| T::splat(self.rotation[(i, j)])))
    }

    /// R' (p - t)
    #[inline(always)]
    fn in_component<T: Number>(&self, point: &Vector<T>) -> Vector<T> {
        let from = |axis: usize| point[axis] - T::splat(self.shift_mm[axis]);
        let moved = Vector::new(from(0), from(1), from(2));
        let column = |j: usize| Vector::from_fn(|i, _| T::splat(self.rotation[(i, j)]));
        Vector::new(
            dot(&column(0), &moved),
            dot(&column(1), &moved),
            dot(&column(2), &moved),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    use crate::geometry::tests::check_derivatives;

    fn femur() -> GenericFemur {
        GenericFemur::new(GenericFemurShape::default())
    }

    #[test]
    fn verify_lowest_points_of_both_arcs() {
        // The distal centre lies 16 mm from the origin, opposite to the transition.
        let (sine, cosine) = 20f64.to_radians().sin_cos();
        let distal = Vec3::new(16.0 * sine, 16.0 * cosine - 38.0, 23.0);
        assert!(femur().gap_mm(&distal).abs() < 1e-12);
        let posterior = Vec3::new(-22.0, 0.0, -23.0);
        assert!(femur().gap_mm(&posterior).abs() < 1e-12);
    }

    #[test]
    fn arcs_meet_with_one_tangent() {
        let along = Vec3::new(-0.342_020_143_325_668_7, -0.939_692_620_785_908_4, 0.0);
        let across = Vec3::new(along.y, -along.x, 0.0) * 1e-9;
        for z in [20.0, 23.0, 30.0] {
            let at = |shift: Vec3| femur().sample(&(along * 22.0 + shift + Vec3::z() * z), 0.0);
            let (one, other) = (at(across), at(-across));
            assert!((one.gap_mm - other.gap_mm).abs() < 1e-8);
            assert!((one.normal - other.normal).norm() < 1e-8);
        }
    }

    #[test]
    fn derivatives_hold_on_both_condyles_and_arcs() {
        let points = [
            [9.0, -22.0, 25.0],
            [9.0, -22.0, -21.0],
            [-15.0, -16.0, -26.0],
            [-15.0, -16.0, 20.0],
        ];
        for point in points.map(Vec3::from) {
            check_derivatives(|p| femur().sample(p, 0.04), point, 1e-8);
        }
    }

    #[test]
    fn surface_mesh_lies_on_the_surface_and_faces_outwards() {
        let femur = femur();
        let mesh = femur.surface_mesh(2.0);
        for vertex in &mesh.vertices {
            assert!(femur.gap_mm(vertex).abs() < 1e-9, "{vertex}");
        }
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle);
            let normal = femur.sample(&((a + b + c) / 3.0), 0.0).normal;
            assert!((b - a).cross(&(c - a)).dot(&normal) > 0.0);
        }
    }

    #[test]
    fn a_coarser_mesh_stays_on_the_surface() {
        let femur = femur();
        let fine = femur.surface_mesh(0.5);
        let coarse = condyle_mesh::coarser(&fine, 0.1);
        assert!(coarse.triangles.len() * 4 < fine.triangles.len());
        for vertex in &coarse.vertices {
            assert!(femur.gap_mm(vertex).abs() < 1e-9, "{vertex}");
        }
    }

    fn placed() -> PlacedFemur {
        let femur = GenericFemur::new(GenericFemurShape::default());
        let rotation = Rotation3::from_euler_angles(0.05, -0.08, 0.1).into_inner();
        PlacedFemur::new(femur, rotation, Vec3::new(1.0, -2.0, 0.5))
    }

    #[test]
    fn derivatives_of_a_placed_femur_hold_on_both_condyles() {
        for point in [[9.0, -22.0, 25.0], [-15.0, -16.0, -26.0]] {
            check_derivatives(|p| placed().sample(p, 0.04), Vec3::from(point), 1e-8);
        }
    }

    #[test]
    fn a_point_carried_along_keeps_its_gap() {
        let (placed, point) = (placed(), Vec3::new(9.0, -22.0, 25.0));
        let there = placed.to_frame(&point);
        let gap = placed.femur().gap_mm(&point);
        assert!((placed.gap_mm(&there) - gap).abs() < 1e-12);
        assert!(there.norm() < placed.reach_mm());
    }
}
