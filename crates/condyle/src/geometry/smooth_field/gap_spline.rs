//! The spline through the gaps at a grid's nodes, and what it says at a point.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{
    node_grid::{BAND_MM, NodeGrid, SPACING_MM},
    spline::{Bases, Derivatives},
};
use crate::{
    Vector,
    geometry::surface_sample::{Curvature, SurfaceSample},
    number::{F64x4, LANES, Number},
};

/// Gap of points outside the grid, mm: a lower bound, since the grid reaches further than that
/// beyond the surface.
const OUTSIDE_MM: f64 = BAND_MM + SPACING_MM;

/// A quadratic B-spline over a grid: a gap with its derivatives anywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GapSpline {
    grid: NodeGrid,
    /// One a node, mm, and one number more: a row is read as four, of which three are used.
    coefficients: Arc<[f64]>,
}

/// The 27 coefficients that reach a point, lane by lane.
struct Neighbourhood<T> {
    /// Number of the first of them in every lane.
    corner: [u32; LANES],
    bases: Bases<T>,
    /// Below zero outside the grid.
    inside: T,
}

impl GapSpline {
    /// The spline of these coefficients, one a node.
    pub fn new(grid: NodeGrid, mut coefficients: Vec<f64>) -> Self {
        coefficients.push(0.0);
        Self {
            grid,
            coefficients: coefficients.into(),
        }
    }

    /// The grid that the spline runs over.
    pub fn grid(&self) -> &NodeGrid {
        &self.grid
    }

    /// The same spline with its coefficients changed by `change`, which gets the new and the old.
    pub fn changed(&self, change: impl FnOnce(&mut [f64], &[f64])) -> Self {
        let mut changed = self.clone();
        change(Arc::make_mut(&mut changed.coefficients), &self.coefficients);
        changed
    }

    /// Number of the node around which each lane's point lies.
    #[inline(always)]
    pub fn nodes_at<T: Number>(&self, points: &Vector<T>) -> impl Iterator<Item = usize> {
        let corners = self.locate(points).corner.into_iter().take(T::COUNT);
        let [sx, sy, sz] = self.grid.strides();
        corners.map(move |corner| corner as usize + sx + sy + sz)
    }

    /// Gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        self.derivatives(point).value
    }

    /// Gap, normal and curvature at a point.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>) -> SurfaceSample<T> {
        sample_from(&self.derivatives(point))
    }

    /// The spline and its derivatives at a point; outside the grid its value is a bound.
    #[inline(always)]
    fn derivatives<T: Number>(&self, point: &Vector<T>) -> Derivatives<T> {
        let here = self.locate(point);
        let spline = here.bases.spline(|lane| self.rows(here.corner[lane]));
        Derivatives {
            value: here.inside.below_zero(T::splat(OUTSIDE_MM), spline.value),
            ..spline
        }
    }

    /// The coefficients that reach a point, and the bases there.
    #[inline(always)]
    fn locate<T: Number>(&self, point: &Vector<T>) -> Neighbourhood<T> {
        let (one, half) = (T::one(), T::splat(0.5));
        let NodeGrid { origin, counts } = &self.grid;
        let strides = self.grid.strides();
        let (mut corner, mut inside) = (T::zero(), one);
        let mut away = |axis: usize| {
            let place = (point[axis] - T::splat(origin[axis])) * T::splat(1.0 / SPACING_MM);
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

    /// The coefficients from a corner on: row `j` of layer `k`, and one number more.
    #[inline(always)]
    fn rows(&self, corner: u32) -> impl Fn(usize, usize) -> F64x4 {
        // One check of the last says that all are there: strides of 32 bits cannot overflow their
        // sum, so that the compiler leaves out a check at each of nine rows.
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

/// Gap, unit normal and curvature from the spline.
#[inline(always)]
fn sample_from<T: Number>(spline: &Derivatives<T>) -> SurfaceSample<T> {
    let per_spacing = T::splat(1.0 / SPACING_MM);
    let [x, y, z] = spline.gradient;
    let gap_gradient = Vector::new(x * per_spacing, y * per_spacing, z * per_spacing);
    // Far from the surface the gap is constant and the normal none, rather than not a number.
    let length = Number::max(
        gap_gradient.dot(&gap_gradient).sqrt(),
        T::splat(f64::MIN_POSITIVE),
    );
    let per_length = T::one() / length;
    let scale = per_length * T::splat(1.0 / (SPACING_MM * SPACING_MM));
    // Written out: a map over an array is a call for each of them.
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
