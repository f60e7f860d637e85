//! One trilinear hexahedron: its edges, its faces and its volume.

use crate::vector::Vec3;

/// Edges of a hexahedron in VTK's numbering.
pub(crate) const HEX_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The six faces of a hexahedron as corners in VTK order, each anticlockwise seen from outside.
pub const HEX_FACES: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// Exact volume enclosed by a hexahedron with bilinear faces.
///
/// `corners` are in VTK order (bottom quad anticlockwise seen from the top, then the top quad).
/// The volume integral becomes one over the six faces, $V = \tfrac{1}{3} \sum \int x \cdot n dA$, and on a
/// bilinear face with corners $a, b, c, d$ and vector area $A$ that integral is
/// $\tfrac{1}{4} (a + b + c + d) \cdot A$ plus a twist term; summing the four tetrahedral splits of a face,
/// weighted one half, gives it exactly.
///
/// ```
/// use condyle_fem::{Vec3, trilinear_volume};
///
/// let bottom = [[0., 0.], [2., 0.], [2., 3.], [0., 3.]];
/// let corner = |i: usize| Vec3::new(bottom[i % 4][0], bottom[i % 4][1], if i < 4 { 0.0 } else { 0.5 });
/// assert_eq!(trilinear_volume(&std::array::from_fn(corner)), 3.0);
/// ```
pub fn trilinear_volume(corners: &[Vec3; 8]) -> f64 {
    let origin = corners[0];
    HEX_FACES
        .iter()
        .map(|face| volume_below(&face.map(|i| corners[i] - origin)))
        .sum()
}

/// Volume of the cone from the origin to a bilinear quad; positive if it is anticlockwise seen
/// from outside. Over a closed surface these add up to the volume inside.
pub fn volume_below([a, b, c, d]: &[Vec3; 4]) -> f64 {
    // Mean of the two ways to cut the quad into triangles.
    let triple = |p: &Vec3, q: &Vec3, r: &Vec3| p.dot(&q.cross(r));
    (triple(a, b, c) + triple(a, c, d) + triple(a, b, d) + triple(b, c, d)) / 12.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brick(size: [f64; 3]) -> [Vec3; 8] {
        [
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [0., 0., 1.],
            [1., 0., 1.],
            [1., 1., 1.],
            [0., 1., 1.],
        ]
        .map(|c| Vec3::new(c[0] * size[0], c[1] * size[1], c[2] * size[2]))
    }

    #[test]
    fn verify_brick_volume() {
        let corners = brick([2.0, 3.0, 0.5]);
        assert!((trilinear_volume(&corners) - 3.0).abs() < 1e-14);
    }

    #[test]
    fn verify_twisted_volume_against_gauss_quadrature() {
        let mut corners = brick([1.0, 1.0, 1.0]);
        corners[6] += Vec3::new(0.3, 0.2, 0.4);
        corners[1] += Vec3::new(-0.1, 0.15, 0.2);
        let volume = trilinear_volume(&corners);
        // det J of a trilinear map is at most quadratic in each coordinate: 2-point Gauss is exact.
        let g = 0.5 / 3f64.sqrt();
        let signs = brick([1.0, 1.0, 1.0]).map(|c| c.map(|v| 2.0 * v - 1.0));
        let mut exact = 0.0;
        for p in signs {
            let at = p * g + Vec3::repeat(0.5);
            let mut jacobian = nalgebra::Matrix3::zeros();
            for (corner, s) in corners.iter().zip(&signs) {
                let n = |i: usize| if s[i] > 0.0 { at[i] } else { 1.0 - at[i] };
                let gradient =
                    Vec3::new(s[0] * n(1) * n(2), s[1] * n(0) * n(2), s[2] * n(0) * n(1));
                jacobian += corner * gradient.transpose();
            }
            exact += jacobian.determinant() / 8.0;
        }
        assert!((volume - exact).abs() < 1e-13, "{volume} {exact}");
    }
}
