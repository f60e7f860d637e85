//! The finite element: an 8-node hexahedron without volumetric or shear locking.
//!
//! Two methods make it accurate with few elements through the thickness:
//!
//! - *Incompatible modes*: displacements $1 - \xi^2$, $1 - \eta^2$, $1 - \zeta^2$ inside the element, condensed out
//!   again, let it bend without parasitic shear (Wilson; Taylor, Beresford and Wilson 1976, whose
//!   gradients by the Jacobian of the centre pass the patch test on distorted meshes).
//! - *Projected dilatation*: the divergence of every displacement is replaced by its best fit among
//!   $1, \xi, \eta, \zeta$. The bilinear remainder, which no incompatible mode can cancel, would lock near a Poisson's
//!   ratio of one half; the linear part cannot, and is kept since bending needs it.

use nalgebra::{Cholesky, Matrix3, Matrix4, SMatrix, Vector4};
use wide::f64x4;

use crate::{
    Vec3,
    elastic::{Elastic, Strain, Stress},
};

pub(crate) const POINTS: usize = 8;
/// Number of incompatible functions, in addition to the eight of the nodes.
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

/// Returns the components of eight vectors, one node after the other.
pub(crate) fn flat(nodes: &[Vec3; 8]) -> SMatrix<f64, 24, 1> {
    SMatrix::from_fn(|i, _| nodes[i / 3][i % 3])
}

/// Strains of an element by its displacements.
pub(crate) struct Element {
    points: [Point; POINTS],
}

/// Strains at one Gauss point by displacements.
struct Point {
    gradients: [Vec3; FUNCTIONS],
    /// The projected divergence by a displacement of every function.
    dilatations: [Vec3; FUNCTIONS],
    /// The point's share of the volume.
    volume: f64,
}

/// Stiffness of an element: of its nodes, of its modes by the nodes, and of its modes.
pub(crate) struct Stiffness {
    nodal: NodalStiffness,
    coupling: SMatrix<f64, 9, 24>,
    modal: Cholesky<f64, nalgebra::Const<9>>,
}

impl Stiffness {
    /// Returns the nodal stiffness with the incompatible modes condensed out.
    pub(crate) fn condensed(&self) -> NodalStiffness {
        // With z = L^-1 coupling, coupling^T modal^-1 coupling is z^T z.
        let lower = self.modal.l_dirty();
        let z = lower.solve_lower_triangular_unchecked(&self.coupling);
        let mut nodal = self.nodal;
        nodal.gemm(-1.0, &z.transpose(), &z, 1.0);
        nodal
    }

    /// Modes in balance with displacements of the nodes and with forces on the modes.
    pub(crate) fn modes(&self, nodes: &[Vec3; 8], forces: &Modes) -> Modes {
        self.modal.solve(&(forces - self.coupling * flat(nodes)))
    }

    /// Returns the forces at the nodes that are equivalent to forces on the modes.
    pub(crate) fn passed_on(&self, forces: &Modes) -> [Vec3; 8] {
        let passed = self.coupling.tr_mul(&self.modal.solve(forces));
        std::array::from_fn(|node| passed.fixed_rows::<3>(3 * node).into_owned())
    }
}

/// A number of every Gauss point, side by side.
#[derive(Clone, Copy)]
struct Side([f64x4; 2]);

impl Side {
    fn from_fn(number: impl Fn(usize) -> f64) -> Self {
        let four = |first: usize| f64x4::new(std::array::from_fn(|p| number(first + p)));
        Self([four(0), four(4)])
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self([self.0[0] * other.0[0], self.0[1] * other.0[1]])
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self([self.0[0] + other.0[0], self.0[1] + other.0[1]])
    }

    #[inline(always)]
    fn sum(self) -> f64 {
        (self.0[0] + self.0[1]).reduce_add()
    }
}

impl Element {
    /// Returns the element with these corners, or none if its map from natural coordinates folds over.
    pub(crate) fn new(corners: &[Vec3; 8]) -> Option<Self> {
        let (centre_volume, centre_inverse) = inverted(&jacobian(corners, [0.0; 3]))?;
        let mut points = Vec::with_capacity(POINTS);
        for at in gauss_points() {
            let (volume, inverse) = inverted(&jacobian(corners, at))?;
            // With the Jacobian of the centre, and over the volume here, the gradients of the modes have no mean: they
            // do no work on uniform stress, and the element passes the patch test however distorted it is.
            let mode = |k: usize| {
                centre_inverse.row(k).transpose() * (-2.0 * at[k] * centre_volume / volume)
            };
            let nodal = |corner: usize| inverse.tr_mul(&corner_slope(corner, at));
            points.push(Point {
                gradients: std::array::from_fn(|f| if f < 8 { nodal(f) } else { mode(f - 8) }),
                dilatations: [Vec3::zeros(); FUNCTIONS],
                volume,
            });
        }
        let mut points: [Point; POINTS] = points.try_into().ok()?;
        // The divergences become their best fits, with the shares of the volume as weights.
        let base = gauss_points().map(|[x, y, z]| Vector4::new(1.0, x, y, z));
        let mut gram = Matrix4::zeros();
        for (point, base) in points.iter().zip(&base) {
            gram += base * base.transpose() * point.volume;
        }
        // Four independent functions at eight points of positive volume: the inverse always exists.
        let inverse = gram.try_inverse().unwrap_or_default();
        for function in 0..FUNCTIONS {
            let mut moments = SMatrix::<f64, 4, 3>::zeros();
            for (point, base) in points.iter().zip(&base) {
                moments += base * (point.gradients[function] * point.volume).transpose();
            }
            let fit = inverse * moments;
            for (point, base) in points.iter_mut().zip(&base) {
                point.dilatations[function] = fit.tr_mul(base);
            }
        }
        Some(Self { points })
    }

    /// Returns the stiffness of an elastic material.
    ///
    /// $2 G \operatorname{dev}:\operatorname{dev}$ between displacements along i and j of functions with gradients
    /// $a$ and $b$ is $G (a \cdot b\thinspace \delta_{ij} + b_i a_j - \tfrac{2}{3} a_i b_j)$, and $K$ multiplies the
    /// projected divergences.
    pub(crate) fn stiffness(&self, elastic: &Elastic) -> Stiffness {
        // The lower triangle is computed, and mirrored.
        let mut all = SMatrix::<f64, 33, 33>::zeros();
        let shear = Side::from_fn(|p| elastic.shear_modulus() * self.points[p].volume);
        let bulk = Side::from_fn(|p| elastic.bulk_modulus() * self.points[p].volume);
        let less_two_thirds = Side::from_fn(|_| -2.0 / 3.0);
        // This loop takes most of the time of an assembly: all eight points go side by side through the lanes.
        let gradients = self.sides(|point, f, k| point.gradients[f][k]);
        let dilatations = self.sides(|point, f, k| point.dilatations[f][k]);
        for b in 0..FUNCTIONS {
            let stiff_gradient = gradients[b].map(|side| side.times(shear));
            let stiff_dilatation = dilatations[b].map(|side| side.times(bulk));
            for a in b..FUNCTIONS {
                let product = |i: usize, j: usize| gradients[a][i].times(stiff_gradient[j]);
                let dot = product(0, 0).plus(product(1, 1)).plus(product(2, 2));
                for j in 0..3 {
                    for i in 0..3 {
                        let volumetric = dilatations[a][i].times(stiff_dilatation[j]);
                        let shear = product(j, i).plus(product(i, j).times(less_two_thirds));
                        let block = shear.plus(volumetric);
                        let block = if i == j { block.plus(dot) } else { block };
                        all[(3 * a + i, 3 * b + j)] = block.sum();
                    }
                }
            }
        }
        all.fill_upper_triangle_with_lower_triangle();
        // The stiffness of the modes is positive definite for any element with a volume: no check is needed.
        Stiffness {
            nodal: all.fixed_view::<24, 24>(0, 0).into_owned(),
            coupling: all.fixed_view::<9, 24>(24, 0).into_owned(),
            modal: Cholesky::new_unchecked(all.fixed_view::<9, 9>(24, 24).into_owned()),
        }
    }

    /// Returns the numbers of every function and axis, all Gauss points side by side.
    fn sides(&self, of: impl Fn(&Point, usize, usize) -> f64) -> [[Side; 3]; FUNCTIONS] {
        std::array::from_fn(|f| {
            std::array::from_fn(|k| Side::from_fn(|p| of(&self.points[p], f, k)))
        })
    }

    /// Forces of stresses at the Gauss points on the nodes, and on the modes.
    pub(crate) fn forces(&self, stresses: &[Stress; POINTS]) -> ([Vec3; 8], Modes) {
        let mut forces = [Vec3::zeros(); FUNCTIONS];
        for (point, stress) in self.points.iter().zip(stresses) {
            // The mean stress works on the projected divergence, as in the stiffness.
            let (mean, deviator) = (stress.mean(), stress.deviator());
            for (f, force) in forces.iter_mut().enumerate() {
                let work = deviator.times(&point.gradients[f]) + point.dilatations[f] * mean;
                *force += work * point.volume;
            }
        }
        let [a, b, c, d, e, f, g, h, modes @ ..] = forces;
        (
            [a, b, c, d, e, f, g, h],
            Modes::from_fn(|i, _| modes[i / 3][i % 3]),
        )
    }

    pub(crate) fn strains(&self, nodes: &[Vec3; 8], modes: &Modes) -> [Strain; POINTS] {
        let amplitude = |f: usize| match f.checked_sub(8) {
            None => nodes[f],
            Some(mode) => modes.fixed_rows::<3>(3 * mode).into_owned(),
        };
        std::array::from_fn(|p| {
            let point = &self.points[p];
            let (mut gradient, mut dilatation) = (Matrix3::zeros(), 0.0);
            for f in 0..FUNCTIONS {
                let u = amplitude(f);
                gradient += u * point.gradients[f].transpose();
                dilatation += u.dot(&point.dilatations[f]);
            }
            Strain::from_gradient(&gradient).with_trace(dilatation)
        })
    }

    /// Returns the mean over the volume of the gradient of every nodal function; that of the incompatible modes is
    /// zero.
    pub(crate) fn mean_gradients(&self) -> [Vec3; 8] {
        let volume: f64 = self.points.iter().map(|point| point.volume).sum();
        std::array::from_fn(|node| {
            let parts = self.points.iter();
            let sum: Vec3 = parts
                .map(|point| point.gradients[node] * point.volume)
                .sum();
            sum / volume
        })
    }

    pub(crate) fn volumes(&self) -> [f64; POINTS] {
        std::array::from_fn(|p| self.points[p].volume)
    }
}

/// The operator from the displacements of an element's nodes to its mean stress.
#[derive(Clone, Debug)]
pub struct ElementMean {
    pub(crate) gradients: [Vec3; 8],
    pub(crate) elastic: Elastic,
}

impl ElementMean {
    /// Returns the mean stress under displacements of the nodes, and a mean eigenstrain.
    pub fn stress(&self, nodes: &[Vec3; 8], eigenstrain: &Strain) -> Stress {
        // The incompatible modes add nothing to the mean.
        let mut gradient = Matrix3::zeros();
        for (node, by) in nodes.iter().zip(&self.gradients) {
            gradient += node * by.transpose();
        }
        let strain = Strain::from_gradient(&gradient);
        self.elastic.stress(&strain.less(eigenstrain))
    }
}

/// Natural coordinates of the Gauss points, in the order of the corners.
fn gauss_points() -> [[f64; 3]; POINTS] {
    SIGNS.map(|sign| sign.map(|s| s / 3f64.sqrt()))
}

/// Determinant and inverse of a Jacobian, if it does not fold over.
fn inverted(jacobian: &Matrix3<f64>) -> Option<(f64, Matrix3<f64>)> {
    // The determinant is the volume per natural volume; negative means folded over.
    let volume = jacobian.determinant();
    let inverse = jacobian.try_inverse().filter(|_| volume > 0.0);
    Some((volume, inverse?))
}

/// Returns the gradient of a corner's shape function in natural coordinates.
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

    /// Eigenvalues of the condensed stiffness, rising.
    fn eigenvalues(corners: &[Vec3; 8], elastic: &Elastic) -> Vec<f64> {
        let stiffness = Element::new(corners).unwrap().stiffness(elastic);
        let values = SymmetricEigen::new(stiffness.condensed()).eigenvalues;
        let mut values: Vec<f64> = values.iter().copied().collect();
        values.sort_by(f64::total_cmp);
        values
    }

    #[test]
    fn only_rigid_motions_need_no_force() {
        for v in [0.0, 0.3, 0.49] {
            let elastic = Elastic::new(1.0, v).unwrap();
            let values = eigenvalues(&bent(), &elastic);
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
                eigenvalues(&corners, &elastic)
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
        let exact = elastic.stress(&Strain::from_gradient(&slope));
        let none = [Strain::default(); POINTS];
        for stress in element.stresses(&elastic, &nodes, &none) {
            assert!(std::iter::zip(stress.0, exact.0).all(|(a, b)| (a - b).abs() < 1e-11));
        }
        let stiffness = element.stiffness(&elastic);
        assert!(stiffness.modes(&nodes, &Modes::zeros()).norm() < 1e-14);
    }

    #[test]
    fn the_stiffness_is_the_derivative_of_the_forces() {
        let elastic = Elastic::new(571.6, 0.45).unwrap();
        let element = Element::new(&bent()).unwrap();
        let nodes: [Vec3; 8] =
            std::array::from_fn(|i| Vec3::from_fn(|k, _| 0.1 * ((5 * i + 3 * k) as f64).sin()));
        let modes = Modes::from_fn(|i, _| 0.02 * (i as f64).cos());
        let forces = |nodes: &[Vec3; 8]| {
            let strains = element.strains(nodes, &modes);
            element.forces(&strains.map(|strain| elastic.stress(&strain)))
        };
        let stiffness = element.stiffness(&elastic);
        let h = 1e-6;
        for i in 0..24 {
            let moved = |by: f64| {
                let mut nodes = nodes;
                nodes[i / 3][i % 3] += by;
                forces(&nodes)
            };
            let ((up, modal_up), (down, modal_down)) = (moved(h), moved(-h));
            for j in 0..24 {
                let slope = (up[j / 3][j % 3] - down[j / 3][j % 3]) / (2.0 * h);
                assert!((slope - stiffness.nodal[(j, i)]).abs() < 1e-4);
            }
            let slope = (modal_up - modal_down) / (2.0 * h);
            assert!((slope - stiffness.coupling.column(i)).norm() < 1e-4);
        }
    }

    #[test]
    fn a_folded_element_is_none() {
        let mut corners = bent();
        corners.swap(0, 1);
        corners.swap(3, 2);
        corners.swap(4, 5);
        corners.swap(7, 6);
        assert!(Element::new(&corners).is_none());
    }
}
