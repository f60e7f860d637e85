//! The femur as triangles, for pictures and other programs.

use condyle::Vec3;
use condyle::evolve::WearTest;
use condyle::geometry::{FemoralSurface, GenericFemur, TriangleMesh};

use super::super::contents::Case;
use super::super::femur::Femur;
use super::error::BuildError;

/// Triangles for a femur that is no mesh already, as many as Knight 2007 has: they come within a hundredth of a
/// millimetre of its surface.
pub const FEMUR_TRIANGLES: f64 = 25_000.0;
/// Faces of an icosahedron.
const ICOSAHEDRON: f64 = 20.0;

impl Case {
    /// The surface of the femur of `test`, which this case built, in the femoral frame of a right knee, mm;
    /// triangles anticlockwise seen from outside. A mesh has its own; other shapes get about so many.
    ///
    /// # Errors
    /// A mesh that cannot be read again.
    pub fn femur_triangles(&self, test: &WearTest, about: f64) -> Result<TriangleMesh, BuildError> {
        match (&self.femur, test.femur.as_ref()) {
            (Femur::Mesh(femur), _) => femur.triangles(&self.femur_placement, self.heading.side),
            (_, FemoralSurface::Generic(femur)) => Ok(generic(femur, about)),
            (_, FemoralSurface::Placed(placed)) => {
                Ok(generic(placed.femur(), about).mapped(|point| placed.to_frame(point)))
            }
            (Femur::Sphere(ball), _) => Ok(sphere(ball.radius_mm, about)),
            (Femur::Cylinder(cylinder), _) => Ok(tube(cylinder.radius_mm)),
            (Femur::Generic(_), _) => {
                unreachable!("a generic femur is built as one")
            }
        }
    }
}

fn generic(femur: &GenericFemur, about: f64) -> TriangleMesh {
    const COARSE_MM: f64 = 1.0;
    let coarse = femur.surface_mesh(COARSE_MM).triangles.len() as f64;
    femur.surface_mesh(COARSE_MM * (coarse / about).sqrt())
}

/// A tube about the z axis, longer than any insert is wide.
fn tube(radius_mm: f64) -> TriangleMesh {
    const HALF_LENGTH_MM: f64 = 60.0;
    const EDGE_MM: f64 = 1.5;
    let around = (std::f64::consts::TAU * radius_mm / EDGE_MM).ceil() as u32;
    let along = (2.0 * HALF_LENGTH_MM / EDGE_MM).ceil() as u32;
    let mut mesh = TriangleMesh::default();
    for ring in 0..=along {
        let z = HALF_LENGTH_MM * (2.0 * f64::from(ring) / f64::from(along) - 1.0);
        for i in 0..around {
            let (sine, cosine) =
                (std::f64::consts::TAU * f64::from(i) / f64::from(around)).sin_cos();
            let place = Vec3::new(radius_mm * cosine, radius_mm * sine, z);
            mesh.vertices.push(place);
        }
    }
    for ring in 0..along {
        for i in 0..around {
            let (a, b) = (ring * around + i, ring * around + (i + 1) % around);
            let (c, d) = (b + around, a + around);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A ball about the origin: an icosahedron, its triangles cut in four again and again.
fn sphere(radius_mm: f64, about: f64) -> TriangleMesh {
    let halvings = (about / ICOSAHEDRON).log(4.0).round() as usize;
    let mut ball = icosahedron();
    for _ in 0..halvings {
        ball = in_four(&ball, |a, b| (a + b).normalize());
    }
    ball.mapped(|vertex| vertex.normalize() * radius_mm)
}

fn icosahedron() -> TriangleMesh {
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    let mut vertices = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        vertices.extend([
            Vec3::new(0.0, a, b),
            Vec3::new(a, b, 0.0),
            Vec3::new(b, 0.0, a),
        ]);
    }
    let mut triangles = Vec::new();
    for i in 0..12u32 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let corners = [i, j, k].map(|n| vertices[n as usize]);
                if is_face(&corners) {
                    let [a, b, c] = corners;
                    let outward = (b - a).cross(&(c - a)).dot(&a) > 0.0;
                    triangles.push(if outward { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    TriangleMesh {
        vertices,
        triangles,
    }
}

/// Whether three corners of the icosahedron, whose edges are 2 long, are all neighbours.
fn is_face([a, b, c]: &[Vec3; 3]) -> bool {
    [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(one, other)| ((*one - *other).norm() - 2.0).abs() < 1e-9)
}

/// Every triangle cut in four at its middles, which `middle_of` puts between two corners.
pub(crate) fn in_four(
    mesh: &TriangleMesh,
    middle_of: impl Fn(&Vec3, &Vec3) -> Vec3,
) -> TriangleMesh {
    let mut vertices = mesh.vertices.clone();
    let mut middles = std::collections::HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push(middle_of(&vertices[a as usize], &vertices[b as usize]));
            vertices.len() as u32 - 1
        })
    };
    let mut triangles = Vec::with_capacity(4 * mesh.triangles.len());
    for &[a, b, c] in &mesh.triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    TriangleMesh {
        vertices,
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn verify_the_ball_is_closed_faces_out_and_has_its_volume() {
        let ball = sphere(24.0, 25_000.0);
        assert_eq!(
            (ball.triangles.len(), ball.vertices.len()),
            (20_480, 10_242)
        );
        let exact = 4.0 / 3.0 * PI * 24f64.powi(3);
        let volume = ball.signed_volume();
        assert!((volume / exact - 1.0).abs() < 1e-3, "{volume} {exact}");
    }

    #[test]
    fn verify_the_tube_faces_out_and_has_the_radius() {
        let tube = tube(20.0);
        for triangle in 0..tube.triangles.len() {
            let [a, b, c] = tube.corners(triangle);
            let outward = Vec3::new(a.x, a.y, 0.0);
            assert!((outward.norm() - 20.0).abs() < 1e-9);
            assert!((b - a).cross(&(c - a)).dot(&outward) > 0.0);
        }
    }
}
