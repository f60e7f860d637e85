//! Interpolation between the nodes, and the search for the highest pressure there.

use nalgebra::{SMatrix, SVector};

use crate::{
    Vec3,
    contact::model::{MAX_REGIONS, TouchedNode},
    geometry::Share,
};

/// Relative difference up to which pressures count as equal. Otherwise round-off would decide the order of their
/// nodes, and a mirrored surface would have a different peak.
const EQUAL: f64 = 1e-9;

/// Smallest number of nodes to which a quadratic is fitted. A node inside a surface and those around it suffice; at
/// the rim farther nodes are added.
pub(crate) const MIN_NODES: usize = 7;

/// Returns the highest pressure at or around the nodes in contact, MPa; any region may have it.
///
/// `highest_around` returns the highest pressure within a node's share. It is called for the nodes with the highest
/// mean of their region, with the highest pressure so far; a result that is not above it need not be exact. The
/// highest mean over a share is a lower bound.
pub(crate) fn highest_mpa(
    touched: &[TouchedNode],
    highest_around: impl Fn(u32, f64) -> f64,
) -> f64 {
    let mut highest = [0.0; MAX_REGIONS];
    for node in touched {
        let highest = &mut highest[usize::from(node.region)];
        // A branch that is seldom taken is faster than a maximum that waits for the one before.
        if node.pressure_mpa > *highest {
            *highest = node.pressure_mpa;
        }
    }
    let leads = highest.map(|highest| highest * (1.0 - EQUAL));
    let leads = |node: &&TouchedNode| node.pressure_mpa >= leads[usize::from(node.region)];
    let mut tops = touched.iter().filter(leads).collect::<Vec<_>>();
    // From the highest mean down, so that most of the others need not be fitted exactly.
    tops.sort_by(|a, b| b.pressure_mpa.total_cmp(&a.pressure_mpa));
    let of_means = highest.into_iter().fold(0.0, f64::max);
    tops.iter().fold(of_means, |so_far, top| {
        highest_around(top.node, so_far).max(so_far)
    })
}

/// Regularisation of the least squares for every coefficient but the constant, with lengths in units of a share's edge. A
/// coefficient that the patch does not determine then becomes small; one that it determines is not affected.
const LEAST_SQUARES_FLOOR: f64 = 1e-10;

/// A quadratic q(u) = constant + slope . u + u . bend u / 2 in the plane of a share, u from its centre in units of
/// `length_mm`.
#[derive(Clone, Debug)]
pub(crate) struct Quadratic {
    constant: f64,
    slope: [f64; 2],
    /// xx, xy, yy.
    bend: [f64; 3],
    edges: [[f64; 2]; 2],
    /// Mean square of the place along the share, for the mean over it.
    moment: f64,
}

/// Directions along a share, and its length.
struct Plane {
    along: [Vec3; 2],
    length_mm: f64,
}

impl Plane {
    fn new(share: &Share) -> Self {
        let first = share.edge_a.normalize();
        let normal = share.edge_a.cross(&share.edge_b).normalize();
        Self {
            along: [first, normal.cross(&first)],
            // With lengths near 1 the coefficients have one scale, and the regularisation weighs them alike.
            length_mm: share.area_mm2.sqrt(),
        }
    }

    fn flat(&self, vector: &Vec3) -> [f64; 2] {
        self.along.map(|along| along.dot(vector) / self.length_mm)
    }

    fn moment(&self, share: &Share) -> f64 {
        2.0 * share.spread_mm2 / (self.length_mm * self.length_mm)
    }
}

impl Quadratic {
    /// Fits a quadratic to means over shares, in the plane of `around`, by least squares; none without a mean.
    ///
    /// With a share's centre u and its spread s, the mean of the quadratic is
    /// constant + slope . u + bend : (u u'/2 + s I), in the sense of
    /// [`Counterface::sample`](crate::geometry::Counterface::sample). If the means do not determine all six
    /// coefficients, these are the smallest that fit.
    pub fn fit<'a>(
        around: &Share,
        means: impl Iterator<Item = (&'a Share, f64)> + Clone,
    ) -> Option<Self> {
        let plane = Plane::new(around);
        let (_, base) = means.clone().next()?;
        // Means are fitted relative to the first, so that the regularisation does not depend on their level.
        let mut matrix = SMatrix::<f64, 6, 6>::identity() * LEAST_SQUARES_FLOOR;
        let mut right = SVector::<f64, 6>::zeros();
        // Any mean determines the constant.
        matrix[(0, 0)] = 0.0;
        for (share, mean) in means {
            let row = row(&plane, share, around);
            matrix.syger(1.0, &row, &row, 1.0);
            right += row * (mean - base);
        }
        let [constant, x, y, xx, xy, yy] = matrix.cholesky()?.solve(&right).into();
        Some(Self {
            constant: constant + base,
            slope: [x, y],
            bend: [xx, xy, yy],
            edges: [&around.edge_a, &around.edge_b].map(|edge| plane.flat(edge)),
            moment: plane.moment(around),
        })
    }

    pub fn mean(&self) -> f64 {
        let [xx, _, yy] = self.bend;
        self.constant + self.moment * (xx + yy) / 2.0
    }

    /// Returns the largest difference from the given means, in the plane of `around`.
    pub fn worst_miss<'a>(
        &self,
        around: &Share,
        means: impl Iterator<Item = (&'a Share, f64)>,
    ) -> f64 {
        let plane = Plane::new(around);
        let [xx, xy, yy] = self.bend;
        let [x, y] = self.slope;
        let coefficients = SVector::from([self.constant, x, y, xx, xy, yy]);
        let miss = |(share, mean): (&Share, f64)| {
            (row(&plane, share, around).dot(&coefficients) - mean).abs()
        };
        means.map(miss).fold(0.0, f64::max)
    }

    /// Returns the largest value within the share.
    ///
    /// Along either axis of the bend it is at the stationary point, or at the end of the share if that comes first.
    pub fn highest(&self) -> f64 {
        let [xx, xy, yy] = self.bend;
        let mean = (xx + yy) / 2.0;
        let apart = ((xx - yy) / 2.0).hypot(xy);
        let (sine, cosine) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
        let first = self.highest_along([cosine, sine], mean + apart);
        self.constant + first + self.highest_along([-sine, cosine], mean - apart)
    }

    /// Returns the rise along one axis, with the second derivative `bend`.
    fn highest_along(&self, axis: [f64; 2], bend: f64) -> f64 {
        let along = |vector: &[f64; 2]| (vector[0] * axis[0] + vector[1] * axis[1]).abs();
        let slope = along(&self.slope);
        let end = self.edges.iter().map(along).sum::<f64>() / 2.0;
        // Downward bends have a stationary point at -slope/bend, which counts if it lies within the share.
        let at = if -bend * end > slope {
            -slope / bend
        } else {
            end
        };
        (slope + bend * at / 2.0) * at
    }
}

/// Returns the derivatives of the mean over a share by the six coefficients.
fn row(plane: &Plane, share: &Share, around: &Share) -> SVector<f64, 6> {
    let [x, y] = plane.flat(&(share.centre - around.centre));
    let moment = plane.moment(share);
    SVector::from([
        1.0,
        x,
        y,
        (x * x + moment) / 2.0,
        x * y,
        (y * y + moment) / 2.0,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{ArticulatingSurface, FacesAround};

    /// Returns a skewed grid of 5 by 5 nodes in a plane that lies askew.
    fn skewed() -> ArticulatingSurface {
        let (a, b) = (Vec3::new(0.9, 0.2, 0.1), Vec3::new(0.3, -0.1, 0.7));
        let nodes = (0..5).flat_map(|i| (0..5).map(move |k| a * f64::from(i) + b * f64::from(k)));
        let cells = (0..4).flat_map(|i| (0..4).map(move |k| 5 * i + k));
        let faces: Vec<[u32; 4]> = cells.map(|n| [n, n + 1, n + 6, n + 5]).collect();
        ArticulatingSurface::new(nodes.collect(), &FacesAround::new(25, &faces))
    }

    /// A quadratic of the place, its second derivatives along `steep` and `flat`.
    struct Hill {
        top: Vec3,
        steep: Vec3,
        flat: Vec3,
    }

    impl Hill {
        fn on(surface: &ArticulatingSurface, away: [f64; 2]) -> Self {
            let share = &surface.shares[12];
            let normal = share.edge_a.cross(&share.edge_b).normalize();
            let steep = normal.cross(&Vec3::new(0.3, 0.1, 1.0)).normalize();
            Self {
                top: share.centre + share.edge_a * away[0] + share.edge_b * away[1],
                flat: normal.cross(&steep),
                steep,
            }
        }

        /// Its mean over a share: 7 at the top, falling by 0.4 x^2/2 and 0.1 y^2/2.
        fn mean(&self, share: &Share) -> f64 {
            let [x, y] =
                [&self.steep, &self.flat].map(|along| along.dot(&(share.centre - self.top)));
            7.0 - 0.2 * x * x - 0.05 * y * y - 0.5 * share.spread_mm2
        }

        fn fit(&self, surface: &ArticulatingSurface, nodes: &[usize]) -> Quadratic {
            let shares = nodes.iter().map(|&node| &surface.shares[node]);
            let means = shares.map(|share| (share, self.mean(share)));
            Quadratic::fit(&surface.shares[12], means).unwrap()
        }

        fn highest(&self, surface: &ArticulatingSurface, nodes: &[usize]) -> f64 {
            self.fit(surface, nodes).highest()
        }
    }

    #[test]
    fn verify_top_of_a_quadratic_on_a_skewed_grid() {
        let surface = skewed();
        let nine = [12, 6, 7, 8, 11, 13, 16, 17, 18];
        for away in [[0.0, 0.0], [0.3, -0.2], [0.5, 0.5], [-0.5, 0.1]] {
            let hill = Hill::on(&surface, away);
            for nodes in [&nine[..], &[12, 6, 7, 11, 13, 17]] {
                let fit = hill.fit(&surface, nodes);
                let highest = fit.highest();
                assert!((highest - 7.0).abs() < 1e-7, "{away:?} {highest}");
                assert!((fit.mean() - hill.mean(&surface.shares[12])).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn beyond_the_share_its_end_is_the_highest() {
        let surface = skewed();
        let hill = Hill::on(&surface, [3.0, 0.0]);
        let highest = hill.highest(&surface, &[12, 6, 7, 8, 11, 13, 16, 17, 18]);
        let share = &surface.shares[12];
        assert!(highest > hill.mean(share) && highest < 7.0, "{highest}");
    }

    #[test]
    fn what_few_shares_do_not_tell_is_small() {
        let surface = skewed();
        let hill = Hill::on(&surface, [0.0, 0.0]);
        let share = &surface.shares[12];
        assert_eq!(hill.highest(&surface, &[12]), hill.mean(share));
        assert!(Quadratic::fit(share, std::iter::empty()).is_none());
        for nodes in [&[12, 11][..], &[12, 11, 13], &[12, 11, 13, 7]] {
            let highest = hill.highest(&surface, nodes);
            assert!((highest - 7.0).abs() < 0.1, "{nodes:?} {highest}");
        }
    }
}
