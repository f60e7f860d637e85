//! The finite element: an 8-node hexahedron that neither locks nor is too stiff in bending.
//!
//! Two remedies make it good with few elements over a thickness:
//!
//! - *Incompatible modes*: displacements $1 - \xi^2$, $1 - \eta^2$, $1 - \zeta^2$ inside the element, condensed out
//!   again, let it bend without parasitic shear (Wilson; Taylor, Beresford and Wilson 1976, whose
//!   gradients by the Jacobian of the centre pass the patch test on distorted meshes).
//! - *Projected dilatation*: the divergence of every displacement is replaced by its best fit among
//!   $1, \xi, \eta, \zeta$. The bilinear rest, which no incompatible mode can undo, would lock near a Poisson's
//!   ratio of one half; the linear part cannot, and is kept since bending needs it.

use nalgebra::{Cholesky, Matrix3, Matrix4, SMatrix, Vector4};

use crate::{
    elastic::{Elastic, Strain, stiffness_block},
    stress::Stress,
    vector::Vec3,
};

/// Gauss points of an element.
pub(crate) const POINTS: usize = 8;
/// Incompatible functions beside the eight of the nodes.
const MODES: usize = 3;
const FUNCTIONS: usize = 8 + MODES;

/// Signs of the natural coordinates of the corners, in VTK order.
const SIGNS: [[f64; 3]; 8] = [
    [-1., -1., -1.],
    [1., -1., -1.],
    [1., 1., -1.],
    [-1., 1., -1.],
    [-1., -1., 1.],
    [1., -1., 1.],
    [1., 1., 1.],
    [-1., 1., 1.],
];

/// Stiffness between the 24 displacements of an element.
pub(crate) type NodalStiffness = SMatrix<f64, 24, 24>;
/// Amplitudes of the incompatible modes.
pub(crate) type Modes = SMatrix<f64, 9, 1>;

/// Strains of an element by its displacements.
pub(crate) struct Element {
    points: [Point; POINTS],
}

/// Those at one Gauss point.
struct Point {
    /// Gradient of every function.
    gradients: [Vec3; FUNCTIONS],
    /// The projected divergence by a displacement of every function.
    dilatations: [Vec3; FUNCTIONS],
    /// Its share of the volume.
    volume: f64,
}

/// Where the map from natural coordinates folds over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inverted;

impl Element {
    /// The element with these corners.
    pub(crate) fn new(corners: &[Vec3; 8]) -> Result<Self, Inverted> {
        let centre = jacobian(corners, [0.0; 3]);
        let centre_inverse = centre.try_inverse().ok_or(Inverted)?;
        let centre_volume = centre.determinant();
        let mut points = Vec::with_capacity(POINTS);
        for at in gauss_points() {
            let jacobian = jacobian(corners, at);
            let volume = jacobian.determinant();
            if !(volume > 0.0 && centre_volume > 0.0) {
                return Err(Inverted);
            }
            let inverse = jacobian.try_inverse().ok_or(Inverted)?;
            let mode_scale = centre_volume / volume;
            points.push(Point {
                gradients: std::array::from_fn(|function| {
                    if function < 8 {
                        inverse.tr_mul(&corner_slope(function, at))
                    } else {
                        centre_inverse.row(function - 8).transpose()
                            * (-2.0 * at[function - 8] * mode_scale)
                    }
                }),
                dilatations: [Vec3::zeros(); FUNCTIONS],
                volume,
            });
        }
        let points = points.try_into().map_err(|_| Inverted)?;
        let mut element = Self { points };
        element.project_dilatations();
        Ok(element)
    }

    /// Replaces the divergences by their best fits, the shares of the volume as weights.
    fn project_dilatations(&mut self) {
        let base = gauss_points().map(|[x, y, z]| Vector4::new(1.0, x, y, z));
        let mut gram = Matrix4::zeros();
        for (point, base) in self.points.iter().zip(&base) {
            gram += base * base.transpose() * point.volume;
        }
        let inverse = gram.try_inverse().unwrap_or_default();
        for function in 0..FUNCTIONS {
            let mut moments = SMatrix::<f64, 4, 3>::zeros();
            for (point, base) in self.points.iter().zip(&base) {
                moments += base * (point.gradients[function] * point.volume).transpose();
            }
            let fit = inverse * moments;
            for (point, base) in self.points.iter_mut().zip(&base) {
                point.dilatations[function] = fit.tr_mul(base);
            }
        }
    }

    /// Stiffness of the nodes after the modes have found their balance, and the modes by the nodes.
    pub(crate) fn stiffness(&self, elastic: &Elastic) -> NodalStiffness {
        let (mut nodal, coupling, modal) = self.stiffnesses(elastic);
        // z = L^-1 coupling, so that coupling^T modal^-1 coupling = z^T z.
        let z = modal.l().solve_lower_triangular_unchecked(&coupling);
        nodal -= z.tr_mul(&z);
        nodal
    }

    /// Amplitudes of the modes under displacements of the nodes, and none but elastic strain.
    pub(crate) fn modes(&self, elastic: &Elastic, nodes: &[Vec3; 8]) -> Modes {
        let (_, coupling, modal) = self.stiffnesses(elastic);
        let flat = SMatrix::<f64, 24, 1>::from_fn(|i, _| nodes[i / 3][i % 3]);
        -modal.solve(&(coupling * flat))
    }

    /// Stiffness of nodes, of modes by nodes, and of modes.
    fn stiffnesses(
        &self,
        elastic: &Elastic,
    ) -> (
        NodalStiffness,
        SMatrix<f64, 9, 24>,
        Cholesky<f64, nalgebra::Const<9>>,
    ) {
        let mut all = SMatrix::<f64, 33, 33>::zeros();
        let (shear, bulk) = (elastic.shear_modulus(), elastic.bulk_modulus());
        for point in &self.points {
            let (shear, bulk) = (shear * point.volume, bulk * point.volume);
            let of = |f: usize| [&point.gradients[f], &point.dilatations[f]];
            for b in 0..FUNCTIONS {
                for a in b..FUNCTIONS {
                    let block = stiffness_block(shear, bulk, of(a), of(b));
                    let mut place = all.fixed_view_mut::<3, 3>(3 * a, 3 * b);
                    place += block;
                }
            }
        }
        all.fill_upper_triangle_with_lower_triangle();
        let nodal = all.fixed_view::<24, 24>(0, 0).into_owned();
        let coupling = all.fixed_view::<9, 24>(24, 0).into_owned();
        let modal = all.fixed_view::<9, 9>(24, 24).into_owned();
        (nodal, coupling, Cholesky::new_unchecked(modal))
    }

    /// Strain at every Gauss point.
    pub(crate) fn strains(&self, nodes: &[Vec3; 8], modes: &Modes) -> [Strain; POINTS] {
        let amplitude = |f: usize| {
            if f < 8 {
                nodes[f]
            } else {
                Vec3::new(
                    modes[3 * (f - 8)],
                    modes[3 * (f - 8) + 1],
                    modes[3 * (f - 8) + 2],
                )
            }
        };
        std::array::from_fn(|p| {
            let point = &self.points[p];
            let (mut gradient, mut dilatation) = (Matrix3::zeros(), 0.0);
            for f in 0..FUNCTIONS {
                let u = amplitude(f);
                gradient += u * point.gradients[f].transpose();
                dilatation += u.dot(&point.dilatations[f]);
            }
            Strain::of_gradient(&gradient).with_trace(dilatation)
        })
    }

    /// Stress at every Gauss point of an elastic element.
    pub(crate) fn stresses(&self, elastic: &Elastic, nodes: &[Vec3; 8]) -> [Stress; POINTS] {
        let modes = self.modes(elastic, nodes);
        self.strains(nodes, &modes)
            .map(|strain| elastic.stress(&strain))
    }

    /// Share of every Gauss point of the volume.
    pub(crate) fn volumes(&self) -> [f64; POINTS] {
        std::array::from_fn(|p| self.points[p].volume)
    }
}

/// Natural coordinates of the Gauss points, in the order of the corners.
fn gauss_points() -> [[f64; 3]; POINTS] {
    SIGNS.map(|sign| sign.map(|s| s / 3f64.sqrt()))
}

/// How the function of a corner rises along the natural coordinates.
fn corner_slope(corner: usize, at: [f64; 3]) -> Vec3 {
    let sign = SIGNS[corner];
    let n = |axis: usize| 1.0 + sign[axis] * at[axis];
    Vec3::new(
        sign[0] * n(1) * n(2),
        sign[1] * n(0) * n(2),
        sign[2] * n(0) * n(1),
    ) / 8.0
}

/// Derivatives of the place: a row for every axis, a column for every natural coordinate.
fn jacobian(corners: &[Vec3; 8], at: [f64; 3]) -> Matrix3<f64> {
    let mut jacobian = Matrix3::zeros();
    for (corner, place) in corners.iter().enumerate() {
        jacobian += place * corner_slope(corner, at).transpose();
    }
    jacobian
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SymmetricEigen;

    fn bent() -> [Vec3; 8] {
        let mut corners = SIGNS.map(|s| Vec3::from_row_slice(&s));
        for (i, corner) in corners.iter_mut().enumerate() {
            let turn = i as f64;
            *corner += Vec3::new(turn.sin(), (2.0 * turn).cos(), (3.0 * turn).sin()) * 0.3;
        }
        corners
    }

    #[test]
    fn only_rigid_motions_need_no_force() {
        for v in [0.0, 0.3, 0.49] {
            let elastic = Elastic::new(1.0, v).unwrap();
            let stiffness = Element::new(&bent()).unwrap().stiffness(&elastic);
            let mut values: Vec<f64> = SymmetricEigen::new(stiffness)
                .eigenvalues
                .iter()
                .copied()
                .collect();
            values.sort_by(f64::total_cmp);
            assert!(values[..6].iter().all(|value| value.abs() < 1e-13));
            assert!(values[6] > 0.02, "{}", values[6]);
        }
    }

    #[test]
    fn no_mode_but_the_dilatation_stiffens_as_the_volume_is_kept() {
        // Of 24 freedoms one is the change of volume: only its stiffness grows with the bulk modulus.
        for corners in [SIGNS.map(|s| Vec3::from_row_slice(&s)), bent()] {
            let stiff = |v: f64| {
                let elastic = Elastic::new(2.0 * (1.0 + v), v).unwrap();
                let stiffness = Element::new(&corners).unwrap().stiffness(&elastic);
                let mut values: Vec<f64> = SymmetricEigen::new(stiffness)
                    .eigenvalues
                    .iter()
                    .copied()
                    .collect();
                values.sort_by(f64::total_cmp);
                values
            };
            let (soft, hard) = (stiff(0.499), stiff(0.4999));
            assert!(hard[23] > 5.0 * soft[23]);
            assert!(hard[22] < 1.1 * soft[22], "{} {}", hard[22], soft[22]);
        }
    }

    #[test]
    fn verify_patch_of_linear_displacements() {
        // The work of uniform stress on any displacement of the nodes is that of exact integration.
        let elastic = Elastic::new(463.0, 0.46).unwrap();
        let element = Element::new(&bent()).unwrap();
        let slope = Matrix3::new(0.1, 0.2, -0.3, 0.05, -0.15, 0.07, 0.02, -0.11, 0.21);
        let nodes = bent().map(|corner| slope * corner);
        let exact = elastic.stress(&Strain::of_gradient(&slope));
        for stress in element.stresses(&elastic, &nodes) {
            assert!(std::iter::zip(stress.0, exact.0).all(|(a, b)| (a - b).abs() < 1e-11));
        }
        assert!(element.modes(&elastic, &nodes).norm() < 1e-14);
    }

    #[test]
    fn a_folded_element_is_none() {
        let mut corners = bent();
        corners.swap(0, 1);
        corners.swap(3, 2);
        corners.swap(4, 5);
        corners.swap(7, 6);
        assert!(Element::new(&corners).is_err());
    }
}
