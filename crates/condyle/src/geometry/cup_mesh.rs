//! A cup from triangles, in hexahedra along the radii of its socket.

use condyle_mesh::{
    FittedSphere, TriangleMesh,
    columns::{ColumnError, Meshing, column_mesh},
};
use nalgebra::Rotation3;

use super::insert::{Insert, InsertError};
use crate::{Mat3, Vec3};

/// Distance to the sphere, as a share of its radius, within which a vertex is one of the socket: a tenth of
/// the clearance of a hip.
const ON_SOCKET: f64 = 1e-3;

/// A cup of triangles, unrolled around the centre of its socket so that columns along y are radii.
///
/// With the radius $R$ of the socket, the angle $\theta$ to its pole and the azimuth $\phi$, a point at the distance
/// $\rho$ from the centre goes to $x = R \theta \cos \phi$, $y = -\rho$, $z = R \theta \sin \phi$. A flat triangle there has
/// the mean radius of its corners everywhere: coarse facets of a sphere are a sphere.
pub struct UnrolledCup {
    /// The triangles, unrolled.
    pub mesh: TriangleMesh,
    radius_mm: f64,
    centre_mm: Vec3,
    up: Rotation3<f64>,
}

impl UnrolledCup {
    /// Unrolls a cup in mm around its socket, which opens along `opens_along`; sides of triangles are divided down to
    /// `max_side_mm`, because a flat part outside the socket has no constant radius.
    pub fn new(
        mesh: TriangleMesh,
        socket: &FittedSphere,
        opens_along: Vec3,
        max_side_mm: f64,
    ) -> Self {
        let radius_mm = socket.radius_mm;
        let up = Rotation3::rotation_between(&opens_along, &Vec3::y());
        // Opposite directions have no shortest rotation between them.
        let up = up.unwrap_or(Rotation3::from_axis_angle(
            &Vec3::x_axis(),
            std::f64::consts::PI,
        ));
        let is_of_socket = |point: &Vec3| (point.norm() - radius_mm).abs() < ON_SOCKET * radius_mm;
        let cup = mesh.mapped(|vertex| up * (vertex - socket.centre_mm));
        let cup = cup.with_sides_up_to(max_side_mm, |a, b| {
            let middle = (a + b) / 2.0;
            if is_of_socket(a) && is_of_socket(b) {
                middle.normalize() * radius_mm
            } else {
                middle
            }
        });
        let mesh = cup.mapped(|point| {
            let across = point.x.hypot(point.z);
            let angle = across.atan2(-point.y);
            // At the pole the azimuth does not matter.
            let stretch = if across > 0.0 {
                radius_mm * angle / across
            } else {
                0.0
            };
            Vec3::new(point.x * stretch, -point.norm(), point.z * stretch)
        });
        Self {
            mesh,
            radius_mm,
            centre_mm: socket.centre_mm,
            up,
        }
    }

    /// Returns the place of the cup that was unrolled to `point`.
    pub fn rolled(&self, point: &Vec3) -> Vec3 {
        self.centre_mm + self.up.inverse() * self.around_centre(point)
    }

    /// Returns the place that was unrolled to `point`, from the centre of the socket, whose pole is down.
    fn around_centre(&self, point: &Vec3) -> Vec3 {
        let along = point.x.hypot(point.z);
        let (sine, cosine) = (along / self.radius_mm).sin_cos();
        let around = if along > 0.0 { sine / along } else { 0.0 };
        Vec3::new(point.x * around, -cosine, point.z * around) * -point.y
    }

    /// Returns the cup in hexahedra, its centre at the origin, mounted as by
    /// [`cup_mounting`](super::cup_mounting); `shell` is the unrolled mesh, checked and repaired.
    ///
    /// # Errors
    /// The errors of [`column_mesh`] and [`Insert::new`], and a hole in the socket.
    pub fn insert(
        &self,
        shell: &TriangleMesh,
        meshing: Meshing,
        mounting: &Mat3,
    ) -> Result<Insert, InsertError> {
        let (mut columns, holes) = column_mesh(shell, true, None, meshing)?;
        if !holes.is_empty() {
            return Err(ColumnError::Holes { holes }.into());
        }
        for node in &mut columns.mesh.nodes {
            *node = mounting * self.around_centre(node);
        }
        let insert = Insert::new(columns.mesh, &columns.articulating, &columns.backside)?;
        let insert = insert.compared_with_mesh(columns.mesh_error_mm, columns.void_mm);
        let thickness_mm = insert.surface_nodes().iter().map(|&top| {
            // The nodes of a column follow each other from the backside up.
            let [bottom, top] =
                [top as usize - meshing.layers, top as usize].map(|n| insert.mesh().nodes[n]);
            (top - bottom).norm()
        });
        let thickness_mm = thickness_mm.collect();
        Ok(insert.with_thickness_mm(thickness_mm))
    }
}
