//! The generic femoral component cut into triangles, for pictures and other programs.

use super::GenericFemur;
use condyle_mesh::TriangleMesh;

use crate::Vec3;

/// The condyles reach from here, degrees behind straight down ...
const FRONT_DEG: f64 = -50.0;
/// ... to here,
const BACK_DEG: f64 = 120.0;
/// and so far to each side of their middle planes, mm.
const HALF_WIDTH_MM: f64 = 16.0;

impl GenericFemur {
    /// The articulating surface as triangles of about `edge_mm`, for pictures and other codes.
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

    /// The point of the surface `behind_deg` behind straight down, `across` rad round the tube.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::GenericFemurShape;

    #[test]
    fn surface_mesh_lies_on_the_surface_and_faces_outwards() {
        let femur = GenericFemur::new(GenericFemurShape::default());
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
    fn a_clustered_mesh_is_smaller_and_stays_near_the_surface() {
        let femur = GenericFemur::new(GenericFemurShape::default());
        let fine = femur.surface_mesh(0.5);
        let coarse = fine.clustered(2.0);
        assert!(coarse.triangles.len() * 4 < fine.triangles.len());
        for vertex in &coarse.vertices {
            assert!(femur.gap_mm(vertex).abs() < 0.1, "{vertex}");
        }
    }
}
