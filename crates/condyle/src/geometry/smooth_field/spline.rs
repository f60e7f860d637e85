//! A quadratic B-spline of three variables at a point, from the 27 coefficients that reach it.

use crate::number::{F64x4, LANES, Number};

/// Values and first derivatives of the three B-splines that reach a point along one axis.
#[derive(Clone, Copy)]
struct Basis<T> {
    value: [T; 3],
    slope: [T; 3],
}

impl<T: Number> Basis<T> {
    #[inline(always)]
    fn at(t: T) -> Self {
        let half = T::splat(0.5);
        let (left, right) = (half - t, half + t);
        Self {
            value: [
                half * left * left,
                T::splat(0.75) - t * t,
                half * right * right,
            ],
            slope: [-left, -(t + t), right],
        }
    }
}

/// The B-splines that reach a point in every lane.
pub struct Bases<T> {
    x: Basis<T>,
    y: Basis<[f64; LANES]>,
    z: Basis<[f64; LANES]>,
}

/// A spline and its derivatives by the grid's places.
pub struct Derivatives<T> {
    pub value: T,
    pub gradient: [T; 3],
    /// Second ones: xx, yy, zz, xy, xz, yz.
    pub hessian: [T; 6],
}

impl<T: Number> Bases<T> {
    /// Each of x, y and z in \[-1/2, 1/2\]: distance from the middle node, in spacings.
    #[inline(always)]
    pub fn at([x, y, z]: [T; 3]) -> Self {
        let (y, z) = (Basis::at(y), Basis::at(z));
        Self {
            x: Basis::at(x),
            y: laid_out(&y),
            z: laid_out(&z),
        }
    }

    /// The spline where `rows` gives the coefficients around every lane's point: of layer k the row
    /// j along x, and one number more.
    #[inline(always)]
    pub fn spline<R: Fn(usize, usize) -> F64x4>(
        &self,
        rows: impl Fn(usize) -> R,
    ) -> Derivatives<T> {
        // The spline is the sum of b_i(x) b_j(y) b_k(z) c_ijk over 27 coefficients, and a derivative
        // is the same sum with slopes in place of values. It is contracted an axis at a time, y and
        // z of one lane first: 165 multiplications for all ten sums, instead of 810. What is left
        // of each lane are three numbers along x, which go side by side for all lanes at once.
        let none = [F64x4::splat(0.0); LANES];
        let (mut f, mut fz, mut fzz) = (none, none, none);
        let (mut fy, mut fyz, mut fyy) = (none, none, none);
        for lane in 0..T::COUNT {
            let across = self.across_x(lane, rows(lane));
            f[lane] = across[0];
            fz[lane] = across[1];
            fzz[lane] = across[2];
            fy[lane] = across[3];
            fyz[lane] = across[4];
            fyy[lane] = across[5];
        }
        let (f, fz, fzz) = (columns::<T>(&f), columns::<T>(&fz), columns::<T>(&fzz));
        let (fy, fyz, fyy) = (columns::<T>(&fy), columns::<T>(&fyz), columns::<T>(&fyy));
        let Basis { value, slope } = &self.x;
        Derivatives {
            value: sum(value, &f),
            gradient: [sum(slope, &f), sum(value, &fy), sum(value, &fz)],
            hessian: [
                second_difference(&f),
                sum(value, &fyy),
                sum(value, &fzz),
                sum(slope, &fy),
                sum(slope, &fz),
                sum(value, &fyz),
            ],
        }
    }

    /// The 27 coefficients around one lane's point contracted along y and z, side by side along x:
    /// their values, and derivatives by z, zz, y, yz and yy.
    #[inline(always)]
    fn across_x(&self, lane: usize, row: impl Fn(usize, usize) -> F64x4) -> [F64x4; 6] {
        let weights = |of: &[[f64; LANES]; 3]| {
            let weight = |i: usize| F64x4::splat(of[i][lane]);
            [weight(0), weight(1), weight(2)]
        };
        let (y, y_slope) = (weights(&self.y.value), weights(&self.y.slope));
        let (z, z_slope) = (weights(&self.z.value), weights(&self.z.slope));
        let layer = |k: usize| {
            let rows = [row(0, k), row(1, k), row(2, k)];
            (
                sum(&y, &rows),
                sum(&y_slope, &rows),
                second_difference(&rows),
            )
        };
        let (low, middle, high) = (layer(0), layer(1), layer(2));
        let f = [low.0, middle.0, high.0];
        let fy = [low.1, middle.1, high.1];
        let fyy = [low.2, middle.2, high.2];
        [
            sum(&z, &f),
            sum(&z_slope, &f),
            second_difference(&f),
            sum(&z, &fy),
            sum(&z_slope, &fy),
            sum(&z, &fyy),
        ]
    }
}

/// A basis as it lies in memory, from where the number of any lane is read four times at once.
#[inline(always)]
fn laid_out<T: Number>(basis: &Basis<T>) -> Basis<[f64; LANES]> {
    let lanes = |number: T| {
        let mut lanes = [0.0; LANES];
        for (lane, value) in lanes.iter_mut().enumerate().take(T::COUNT) {
            *value = number.lane(lane);
        }
        lanes
    };
    Basis {
        value: basis.value.map(lanes),
        slope: basis.slope.map(lanes),
    }
}

/// The first three columns of a matrix that has a row of four numbers for every lane.
#[inline(always)]
fn columns<T: Number>(rows: &[F64x4; LANES]) -> [T; 3] {
    let [a, b, c, _] = F64x4::transposed(*rows);
    let lanes = |column: F64x4| T::from_lanes(|lane| column.lane(lane));
    [lanes(a), lanes(b), lanes(c)]
}

#[inline(always)]
fn sum<T: Number>(weights: &[T; 3], of: &[T; 3]) -> T {
    let [a, b, c] = weights;
    a.mul_add(of[0], b.mul_add(of[1], *c * of[2]))
}

/// The second difference: second derivatives of the three B-splines are 1, -2, 1 everywhere.
#[inline(always)]
fn second_difference<T: Number>(of: &[T; 3]) -> T {
    of[0] - (of[1] + of[1]) + of[2]
}
