//! Forces on nodes by traction on a surface.

use crate::{mesh::HexMesh, vector::Vec3};

/// Signs of the natural coordinates of the corners of a quad.
const SIGNS: [[f64; 2]; 4] = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];

impl HexMesh {
    /// Forces on nodes that do the work of a traction on some quads; a node comes once for every quad.
    ///
    /// `traction`: force an area by place and by unit normal, which for [`Self::boundary_quads`] is outward, so that a
    /// pressure p is `-n * p`. Two by two points of Gauss on each bilinear quad.
    ///
    /// # Panics
    /// If a quad names a node that there is not.
    pub fn traction_forces(
        &self,
        quads: &[[u32; 4]],
        traction: impl Fn(Vec3, Vec3) -> Vec3,
    ) -> Vec<(u32, Vec3)> {
        let mut forces = Vec::with_capacity(4 * quads.len());
        for quad in quads {
            let corners = quad.map(|node| self.nodes[node as usize]);
            forces.extend(quad.iter().copied().zip(quad_forces(&corners, &traction)));
        }
        forces
    }
}

fn quad_forces(corners: &[Vec3; 4], traction: impl Fn(Vec3, Vec3) -> Vec3) -> [Vec3; 4] {
    let mut forces = [Vec3::zeros(); 4];
    for at in SIGNS.map(|sign| sign.map(|s| s / 3f64.sqrt())) {
        let shape = SIGNS.map(|[a, b]| (1.0 + a * at[0]) * (1.0 + b * at[1]) / 4.0);
        let along = |[a, b]: [f64; 2]| a * (1.0 + b * at[1]) / 4.0;
        let across = |[a, b]: [f64; 2]| b * (1.0 + a * at[0]) / 4.0;
        let sum = |weights: [f64; 4]| -> Vec3 {
            std::iter::zip(corners, weights)
                .map(|(corner, weight)| corner * weight)
                .sum()
        };
        let area = sum(SIGNS.map(along)).cross(&sum(SIGNS.map(across)));
        let force = traction(sum(shape), area.normalize()) * area.norm();
        for (sum, shape) in forces.iter_mut().zip(shape) {
            *sum += force * shape;
        }
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::tests::distorted;

    #[test]
    fn verify_pressure_all_around_is_in_balance_and_a_fluid_bears_the_volume() {
        let mesh = distorted([3, 3, 2]);
        let quads = mesh.boundary_quads();
        let sum = |forces: Vec<(u32, Vec3)>| forces.iter().map(|(_, force)| force).sum::<Vec3>();
        let pressed = mesh.traction_forces(&quads, |_, normal| -normal);
        assert!(sum(pressed).norm() < 1e-13);
        let buoyed = mesh.traction_forces(&quads, |place, normal| normal * place.z);
        assert!((sum(buoyed) - Vec3::new(0.0, 0.0, 18.0)).norm() < 1e-12);
    }
}
