//! The quadratic B-spline through the gaps at a grid's nodes, evaluated from the 27 coefficients that reach a point.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::grid::{BAND_MM, NodeGrid};
use crate::{
    Vector,
    geometry::surface_sample::{Curvature, SurfaceSample},
    number::{F64x4, LANES, Number},
};

/// A quadratic B-spline over a grid: a gap with its derivatives anywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct GapSpline {
    pub grid: NodeGrid,
    /// One per node, mm, and one more number: a row is read as four, of which three are used.
    coefficients: Arc<[f64]>,
    /// Inverse of the spacing and of its square, 1/mm and 1/mm2: a division in every evaluation would be slow.
    per_spacing: [f64; 2],
}

/// The 27 coefficients that reach a point, lane by lane.
struct Neighbourhood<T> {
    /// Number of the first of them.
    corner: [u32; LANES],
    bases: Bases<T>,
    /// Negative outside the grid.
    inside: T,
}

impl GapSpline {
    /// Creates the spline of these coefficients, one per node.
    pub fn new(grid: NodeGrid, mut coefficients: Vec<f64>) -> Self {
        // The last row is read as four numbers, too.
        coefficients.push(0.0);
        let spacing_mm = grid.spacing_mm;
        Self {
            per_spacing: [1.0 / spacing_mm, 1.0 / (spacing_mm * spacing_mm)],
            grid,
            coefficients: coefficients.into(),
        }
    }

    /// Returns the spline with its coefficients changed by `change`, which receives the new and the old ones.
    pub fn changed(&self, change: impl FnOnce(&mut [f64], &[f64])) -> Self {
        let mut changed = self.clone();
        change(Arc::make_mut(&mut changed.coefficients), &self.coefficients);
        changed
    }

    /// Returns the number of the grid node next to each lane's point.
    #[inline(always)]
    pub fn nodes_at<T: Number>(&self, points: &Vector<T>) -> impl Iterator<Item = usize> {
        let corners = self.locate(points).corner.into_iter().take(T::COUNT);
        let [sx, sy, sz] = self.grid.strides();
        corners.map(move |corner| corner as usize + sx + sy + sz)
    }

    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        self.derivatives(point).value
    }

    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>) -> SurfaceSample<T> {
        let spline = self.derivatives(point);
        let [per_spacing, per_spacing2] = self.per_spacing.map(T::splat);
        let [x, y, z] = spline.gradient;
        let gap_gradient = Vector::new(x * per_spacing, y * per_spacing, z * per_spacing);
        // Far from the surface the gap is constant; the normal is then zero and not NaN.
        let length = Number::max(
            gap_gradient.dot(&gap_gradient).sqrt(),
            T::splat(f64::MIN_POSITIVE),
        );
        let per_length = T::one() / length;
        let scale = per_length * per_spacing2;
        // Written out: the compiler does not inline a map over an array here.
        let [xx, yy, zz, xy, xz, yz] = spline.hessian;
        SurfaceSample {
            gap_mm: spline.value,
            gap_gradient,
            normal: gap_gradient * per_length,
            curvature: Curvature {
                xx: xx * scale,
                yy: yy * scale,
                zz: zz * scale,
                xy: xy * scale,
                xz: xz * scale,
                yz: yz * scale,
            },
        }
    }

    /// Returns the spline and its derivatives at a point; outside the grid its value is a bound.
    #[inline(always)]
    fn derivatives<T: Number>(&self, point: &Vector<T>) -> Derivatives<T> {
        let here = self.locate(point);
        let spline = here.bases.spline(|lane| self.rows(here.corner[lane]));
        // A lower bound: the grid extends farther beyond the surface.
        let outside_mm = BAND_MM + self.grid.spacing_mm;
        Derivatives {
            value: here.inside.below_zero(T::splat(outside_mm), spline.value),
            ..spline
        }
    }

    /// Returns the coefficients that reach a point, and the bases there.
    #[inline(always)]
    fn locate<T: Number>(&self, point: &Vector<T>) -> Neighbourhood<T> {
        let (one, half) = (T::one(), T::splat(0.5));
        let NodeGrid { origin, counts, .. } = &self.grid;
        let strides = self.grid.strides();
        let (mut corner, mut inside) = (T::zero(), one);
        let mut away = |axis: usize| {
            let place = (point[axis] - T::splat(origin[axis])) * T::splat(self.per_spacing[0]);
            let last = T::splat((counts[axis] - 2) as f64);
            let node = Number::max(Number::min((place + half).floor(), last), one);
            inside = Number::min(inside, Number::min(place - half, last + half - place));
            corner += (node - one) * T::splat(strides[axis] as f64);
            place - node
        };
        let bases = Bases::at([away(0), away(1), away(2)]);
        let mut corners = [0; LANES];
        for (lane, first) in corners.iter_mut().enumerate().take(T::COUNT) {
            *first = corner.lane(lane) as u32;
        }
        Neighbourhood {
            corner: corners,
            bases,
            inside,
        }
    }

    /// Returns the coefficients from a corner on: row `j` of layer `k`, and one number more.
    #[inline(always)]
    fn rows(&self, corner: u32) -> impl Fn(usize, usize) -> F64x4 {
        // One check of the last index covers all: strides of 32 bits cannot overflow their
        // sum, so that the compiler omits a check at each of nine rows.
        let [_, sy, sz] = self.grid.strides().map(|stride| stride as u32 as usize);
        let (corner, all) = (corner as usize, &self.coefficients[..]);
        assert!(
            corner + 2 * sy + 2 * sz + LANES <= all.len(),
            "locate keeps one node of margin on every side"
        );
        move |j, k| {
            let from = corner + j * sy + k * sz;
            F64x4::new([all[from], all[from + 1], all[from + 2], all[from + 3]])
        }
    }
}

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
struct Bases<T> {
    x: Basis<T>,
    y: Basis<[f64; LANES]>,
    z: Basis<[f64; LANES]>,
}

/// A spline and its derivatives, per spacing of the grid.
struct Derivatives<T> {
    value: T,
    gradient: [T; 3],
    /// xx, yy, zz, xy, xz, yz.
    hessian: [T; 6],
}

impl<T: Number> Bases<T> {
    /// Each of x, y and z in \[-1/2, 1/2\]: distance from the middle node, in spacings.
    #[inline(always)]
    fn at([x, y, z]: [T; 3]) -> Self {
        let (y, z) = (Basis::at(y), Basis::at(z));
        Self {
            x: Basis::at(x),
            y: laid_out(&y),
            z: laid_out(&z),
        }
    }

    /// Returns the spline. `rows(lane)(j, k)` returns coefficients around the point of a lane: row j of layer k, three
    /// along x and one more number.
    #[inline(always)]
    fn spline<R: Fn(usize, usize) -> F64x4>(&self, rows: impl Fn(usize) -> R) -> Derivatives<T> {
        // The spline is the sum of b_i(x) b_j(y) b_k(z) c_ijk over 27 coefficients, and a derivative
        // is the same sum with slopes in place of values. It is contracted an axis at a time, y and
        // z of one lane first: 165 multiplications for all ten sums, instead of 810. The remaining
        // three numbers of each lane along x are contracted for all lanes at once.
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

    /// Returns the 27 coefficients around one lane's point contracted along y and z, side by side along x: their
    /// values, and derivatives by z, zz, y, yz and yy.
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

/// Returns a basis in memory, from which the number of any lane is broadcast to four.
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

/// Returns the first three columns of a matrix with a row of four numbers for every lane.
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

/// Returns the second difference: second derivatives of the three B-splines are 1, -2, 1 everywhere.
#[inline(always)]
fn second_difference<T: Number>(of: &[T; 3]) -> T {
    of[0] - (of[1] + of[1]) + of[2]
}
