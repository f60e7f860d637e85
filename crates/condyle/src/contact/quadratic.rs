//! A quadratic through means over shares.

use nalgebra::{SMatrix, SVector};

use crate::geometry::Share;

/// What is added to the least squares for every coefficient but the constant, where a length is a
/// share's edge: a patch that does not tell a coefficient then takes it to be small, and one that
/// tells it does not feel it.
const LEAST_SQUARES_FLOOR: f64 = 1e-10;

/// q(u) = constant + slope . u + u . bend u / 2 along the plane of a share, u from its centre in
/// units of `length_mm`.
#[derive(Clone, Debug)]
pub(super) struct Quadratic {
    constant: f64,
    slope: [f64; 2],
    /// xx, xy, yy.
    bend: [f64; 3],
    /// Edges of the share.
    edges: [[f64; 2]; 2],
}

/// Directions along a share, and its length.
struct Plane {
    along: [crate::Vec3; 2],
    length_mm: f64,
}

impl Plane {
    fn of(share: &Share) -> Self {
        let first = share.edge_a.normalize();
        let normal = share.edge_a.cross(&share.edge_b).normalize();
        Self {
            along: [first, normal.cross(&first)],
            length_mm: share.area_mm2.sqrt(),
        }
    }

    fn flat(&self, vector: &crate::Vec3) -> [f64; 2] {
        self.along.map(|along| along.dot(vector) / self.length_mm)
    }
}

impl Quadratic {
    /// The least-squares fit to means over shares, in the plane of `around`; none without a mean.
    ///
    /// With a share's centre u and its second moment M = (a a' + b b')/12 over its edges, the mean
    /// of the quadratic is constant + slope . u + bend : (u u' + M)/2, exactly. Where the means do
    /// not determine all six coefficients, those that they do not speak of are 0.
    pub fn fit<'a>(
        around: &Share,
        means: impl Iterator<Item = (&'a Share, f64)> + Clone,
    ) -> Option<Self> {
        let plane = Plane::of(around);
        let (_, base) = means.clone().next()?;
        let mut matrix = SMatrix::<f64, 6, 6>::identity() * LEAST_SQUARES_FLOOR;
        let mut right = SVector::<f64, 6>::zeros();
        matrix[(0, 0)] = 0.0;
        for (share, mean) in means {
            let row = row(&plane, share, around);
            matrix += row * row.transpose();
            right += row * (mean - base);
        }
        let [constant, x, y, xx, xy, yy] = matrix.cholesky()?.solve(&right).into();
        Some(Self {
            constant: constant + base,
            slope: [x, y],
            bend: [xx, xy, yy],
            edges: [&around.edge_a, &around.edge_b].map(|edge| plane.flat(edge)),
        })
    }

    /// The largest value within the share.
    ///
    /// Along either axis of the bend it is at the stationary point, or at the end of the share
    /// where there is none before it.
    pub fn highest(&self) -> f64 {
        let [xx, xy, yy] = self.bend;
        let mean = (xx + yy) / 2.0;
        let apart = ((xx - yy) / 2.0).hypot(xy);
        let (sine, cosine) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
        let first = self.highest_along([cosine, sine], mean + apart);
        self.constant + first + self.highest_along([-sine, cosine], mean - apart)
    }

    /// How far it rises along one axis, with the second derivative `bend`.
    fn highest_along(&self, axis: [f64; 2], bend: f64) -> f64 {
        let along = |vector: &[f64; 2]| (vector[0] * axis[0] + vector[1] * axis[1]).abs();
        let slope = along(&self.slope);
        let end = self.edges.iter().map(along).sum::<f64>() / 2.0;
        let at = if -bend * end > slope {
            -slope / bend
        } else {
            end
        };
        (slope + bend * at / 2.0) * at
    }
}

/// How the mean over a share depends on the six coefficients.
fn row(plane: &Plane, share: &Share, around: &Share) -> SVector<f64, 6> {
    let [x, y] = plane.flat(&(share.centre - around.centre));
    let [[ax, ay], [bx, by]] = [&share.edge_a, &share.edge_b].map(|edge| plane.flat(edge));
    let xx = x * x + (ax * ax + bx * bx) / 12.0;
    let xy = x * y + (ax * ay + bx * by) / 12.0;
    let yy = y * y + (ay * ay + by * by) / 12.0;
    SVector::from([1.0, x, y, xx / 2.0, xy, yy / 2.0])
}
