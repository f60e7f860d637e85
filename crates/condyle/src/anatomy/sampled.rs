//! Points spread evenly over a surface: the directions that it faces, and the plane that mirrors it.

use std::f64::consts::PI;

use crate::{Mat3, Vec3, geometry::TriangleMesh};

/// Number of points: the mirror plane of real bodies is then known to about a degree.
const POINTS: usize = 500;
/// Every so many points serve for the coarse search.
const FEW: usize = 3;
/// Cosine of 6 degrees, within which normals count as parallel: most facets of a plane scanned with a noise of 0.05 mm lie
/// within it.
const PARALLEL: f64 = 0.994_52;
/// Angle within which flat parts count as square, degrees: the cuts of femora lean by up to 2 degrees.
const SQUARE_DEG: f64 = 3.0;
/// Share of the area that must be square for a turn to be known: 11 to 47 % of five femora are, and 1 to 2 % at other turns; up
/// to 8 % of femora without cuts.
const MIN_SQUARE: f64 = 0.1;
/// Distance beyond which a mirrored point has no partner, as a share of the longest extent.
const FAR: f64 = 0.06;

/// Points of a surface from the middle of its box, with their normals, each for the same share of the area.
pub(super) struct Sampled {
    points: Vec<(Vec3, Vec3)>,
    /// The longest extent.
    size: f64,
}

/// A plane that mirrors a body onto itself, more or less.
#[derive(Clone, Copy)]
pub(super) struct Mirror {
    pub normal: Vec3,
    /// Distance from the middle along the normal.
    offset: f64,
    /// Root mean square of the distance of mirrored points from the surface, as a share of the longest extent.
    error: f64,
}

/// The direction that a surface faces most.
#[derive(Clone, Copy)]
pub(super) struct Flat {
    pub normal: Vec3,
    /// Share of the area that is parallel to it.
    pub share: f64,
}

impl Sampled {
    /// Spreads points over a mesh; none over one without area.
    pub(super) fn new(mesh: &TriangleMesh) -> Option<Self> {
        let double = |triangle: usize| double_area(mesh, triangle);
        let triangles = 0..mesh.triangles.len();
        let step = triangles.clone().map(|t| double(t).norm()).sum::<f64>() / POINTS as f64;
        if !(step > 0.0 && step.is_finite()) {
            return None;
        }
        let (low, high) = mesh.bounds();
        // From the middle, so that a turned plane stays near the body.
        let middle = (low + high) / 2.0;
        let (mut points, mut passed, mut next) = (Vec::new(), 0.0, step / 2.0);
        for triangle in triangles {
            let (area, [a, b, c]) = (double(triangle), mesh.corners(triangle));
            passed += area.norm();
            while next < passed {
                // Multiples of these numbers cover a square evenly; its half beyond the diagonal is folded back.
                let part = |turns: f64| (points.len() as f64 * turns).fract();
                let (u, v) = (part(0.754_877_666_246_692_7), part(0.569_840_290_998_053_2));
                let (u, v) = if u + v > 1.0 {
                    (1.0 - u, 1.0 - v)
                } else {
                    (u, v)
                };
                points.push((a - middle + (b - a) * u + (c - a) * v, area.normalize()));
                next += step;
            }
        }
        let size = (high - low).max();
        Some(Self { points, size })
    }

    /// Returns the direction that most of the surface faces.
    pub(super) fn flattest(&self) -> Flat {
        let normals = || self.points.iter().map(|(_, normal)| *normal);
        let facing = |direction: Vec3| {
            let near = normals().filter(move |normal| normal.dot(&direction) > PARALLEL);
            near.fold((0usize, Vec3::zeros()), |(count, sum), normal| {
                (count + 1, sum + normal)
            })
        };
        let most = normals().map(facing).max_by_key(|(count, _)| *count);
        let (count, sum) = most.unwrap_or((0, Vec3::y()));
        Flat {
            normal: sum.normalize(),
            share: count as f64 / self.points.len() as f64,
        }
    }

    /// Returns the turn from `ahead` towards `up`, -45 to 45 degrees, after which most of the parts perpendicular to the
    /// plane of both are square to these two directions: a femoral component is cut square to fit the bone. None without
    /// enough of them, or if the chamfers between them are at least half as large.
    pub(super) fn square_turn_deg(&self, ahead: &Vec3, up: &Vec3) -> Option<f64> {
        /// Component of a normal out of the plane of both, up to which it counts.
        const IN_PLANE: f64 = 0.1;
        let angle_deg = |normal: &Vec3| {
            let (x, y) = (normal.dot(ahead), normal.dot(up));
            (x.hypot(y) > 1.0 - IN_PLANE * IN_PLANE).then(|| y.atan2(x).to_degrees())
        };
        let normals = self.points.iter().map(|(_, normal)| normal);
        let angles_deg: Vec<f64> = normals.filter_map(angle_deg).collect();
        let square = |turn_deg: f64| {
            let off = angles_deg
                .iter()
                .map(|angle| within_quarter_deg(angle - turn_deg));
            let near = off.filter(|off| off.abs() < SQUARE_DEG);
            near.fold((0usize, 0.0), |(count, sum), off| (count + 1, sum + off))
        };
        let best = angles_deg.iter().map(|&turn| (turn, square(turn)));
        let (turn_deg, (count, sum)) = best.max_by_key(|(_, (count, _))| *count)?;
        let (chamfered, _) = square(turn_deg + 45.0);
        let share = count as f64 / self.points.len() as f64;
        let is_known = share > MIN_SQUARE && 2 * chamfered < count;
        is_known.then(|| within_quarter_deg(turn_deg + sum / count as f64))
    }

    /// Returns the largest share of the area that faces a half space and lies in one plane parallel to its own.
    pub(super) fn plane_share(&self, direction: &Vec3) -> f64 {
        /// Distance within which points lie in one plane, as a share of the longest extent: that of a scanned one, or of the
        /// pockets in a tray.
        const WITHIN: f64 = 0.02;
        let cosine = |normal: &Vec3| normal.dot(direction);
        let cosines = self.points.iter().map(|(_, normal)| cosine(normal));
        let facing: f64 = cosines.filter(|cosine| *cosine > 0.0).sum();
        let parallel = || {
            self.points
                .iter()
                .filter(|(_, normal)| cosine(normal) > PARALLEL)
        };
        let heights: Vec<f64> = parallel().map(|(at, _)| at.dot(direction)).collect();
        let in_plane = |low: &f64| {
            let plane = *low..=low + WITHIN * self.size;
            heights
                .iter()
                .filter(|height| plane.contains(height))
                .count()
        };
        let most = heights.iter().map(in_plane).max().unwrap_or(0);
        most as f64 / facing.max(f64::MIN_POSITIVE)
    }

    /// Returns the plane that mirrors the surface best; one along `along` if that is given.
    pub(super) fn mirror(&self, along: Option<Vec3>) -> Mirror {
        const DIRECTIONS: usize = 200;
        const KEPT: usize = 6;
        let few = Self {
            points: self.points.iter().step_by(FEW).copied().collect(),
            size: self.size,
        };
        let sum: Vec3 = self.points.iter().map(|(point, _)| point).sum();
        let middle = sum / self.points.len() as f64;
        let part = |i: usize| (i as f64 + 0.5) / DIRECTIONS as f64;
        let direction = |i: usize| match along {
            Some(along) => around(&along, part(i) * PI),
            None => on_half_sphere(i, part(i)),
        };
        let start = |normal: Vec3| few.mirrored(normal, normal.dot(&middle));
        let mut starts: Vec<Mirror> = (0..DIRECTIONS).map(direction).map(start).collect();
        starts.sort_by(|a, b| a.error.total_cmp(&b.error));
        let refined = starts[..KEPT].iter().map(|start| {
            let near = few.refined(*start, along, &[4.0, 2.0]);
            self.mirrored(near.normal, near.offset)
        });
        let best = refined.min_by(|a, b| a.error.total_cmp(&b.error));
        self.refined(best.unwrap_or(starts[0]), along, &[1.0, 0.5, 0.25])
    }

    /// Improves a plane by turns of a few degrees and shifts of a few hundredths of the extent.
    fn refined(&self, start: Mirror, along: Option<Vec3>, steps_deg: &[f64]) -> Mirror {
        // More steps of one length are not needed from a start near the best.
        const REPEATS: usize = 6;
        let mut best = start;
        for step in steps_deg {
            for _ in 0..REPEATS {
                let turned = |by: Vec3| {
                    let normal = (best.normal + by * step.to_radians()).normalize();
                    self.mirrored(normal, best.offset)
                };
                let shift = 0.01 * step * self.size;
                let shifted = |by: f64| self.mirrored(best.normal, best.offset + by);
                let mut tried = vec![shifted(shift), shifted(-shift)];
                let (across, other) = across(&best.normal);
                match along {
                    Some(along) => {
                        let around = along.cross(&best.normal);
                        tried.extend([turned(around), turned(-around)]);
                    }
                    None => tried.extend([across, -across, other, -other].map(turned)),
                }
                let next = tried.into_iter().min_by(|a, b| a.error.total_cmp(&b.error));
                let Some(next) = next.filter(|next| next.error < best.error) else {
                    break;
                };
                best = next;
            }
        }
        best
    }

    /// Returns how well a plane mirrors the surface.
    fn mirrored(&self, normal: Vec3, offset: f64) -> Mirror {
        let mut sum = 0.0;
        for (point, _) in &self.points {
            let image = point - normal * (2.0 * (point.dot(&normal) - offset));
            let squared = |(at, _): &(Vec3, Vec3)| (at - image).norm_squared();
            let (mut least, mut away) = (f64::INFINITY, f64::INFINITY);
            for one in &self.points {
                let distance = squared(one);
                if distance < least {
                    // The distance from the plane of the nearest point does not depend on how far points are apart.
                    (least, away) = (distance, (image - one.0).dot(&one.1).abs());
                }
            }
            sum += (away / self.size).min(FAR).powi(2);
        }
        let error = (sum / self.points.len() as f64).sqrt();
        Mirror {
            normal,
            offset,
            error,
        }
    }

    /// Returns the sphere that contains most of the surface, as its radius, which is negative for a hollow surface, and
    /// the covered share of the sphere; `area` is that of the whole surface.
    pub(super) fn sphere(&self, area: f64) -> Option<(f64, f64)> {
        /// Smallest radius, as a share of the extent: smaller spheres cannot make up a body.
        const SMALLEST: f64 = 0.1;
        let count = self.points.len();
        let corner = |at: usize| self.points[at % count].0;
        let corners = |i: usize| [0, 1, 2, 3].map(|quarter| corner(i + quarter * count / 4));
        let spheres = (0..count).filter_map(|i| sphere_through(&corners(i)));
        let covered = spheres.filter_map(|(centre, radius)| {
            let (on, out) = self.on_sphere(&centre, radius);
            let covered = area * on / count as f64 / (4.0 * PI * radius * radius);
            (radius > SMALLEST * self.size).then_some((radius * f64::signum(out), covered))
        });
        covered.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the number of points on a sphere, and the sum of the cosines between their normals and its own.
    fn on_sphere(&self, centre: &Vec3, radius: f64) -> (f64, f64) {
        /// Largest distance from the sphere, relative to its radius: that of facets of 20 degrees.
        const WITHIN: f64 = 0.015;
        /// Cosine between the normals of such facets and those of the sphere.
        const ALONG: f64 = 0.98;
        let cosine = |(at, normal): &(Vec3, Vec3)| {
            let out = at - centre;
            let is_near = (out.norm() / radius - 1.0).abs() < WITHIN;
            is_near.then(|| out.normalize().dot(normal))
        };
        let cosines = self.points.iter().filter_map(cosine);
        let along = cosines.filter(|cosine| cosine.abs() > ALONG);
        along.fold((0.0, 0.0), |(on, out), cosine| (on + 1.0, out + cosine))
    }
}

/// Returns the turn from -45 to 45 degrees that differs from another by quarter turns.
pub(super) fn within_quarter_deg(turn_deg: f64) -> f64 {
    (turn_deg + 45.0).rem_euclid(90.0) - 45.0
}

/// Returns the normal of a triangle, as long as twice its area.
fn double_area(mesh: &TriangleMesh, triangle: usize) -> Vec3 {
    let [a, b, c] = mesh.corners(triangle);
    (b - a).cross(&(c - a))
}

/// Returns the area of all triangles.
pub(super) fn area(mesh: &TriangleMesh) -> f64 {
    let triangles = 0..mesh.triangles.len();
    triangles
        .map(|triangle| double_area(mesh, triangle).norm() / 2.0)
        .sum()
}

/// Returns the middle and the radius of the sphere through four points; none if they lie in a plane.
fn sphere_through([first, others @ ..]: &[Vec3; 4]) -> Option<(Vec3, f64)> {
    let edges = others.map(|other| other - first);
    let matrix = Mat3::from_rows(&edges.map(|edge| edge.transpose()));
    let halves = Vec3::from(edges.map(|edge| edge.norm_squared() / 2.0));
    let to_centre = matrix.lu().solve(&halves)?;
    let radius = to_centre.norm();
    radius.is_finite().then(|| (first + to_centre, radius))
}

/// Returns a direction across `along`, turned about it by an angle.
fn around(along: &Vec3, angle_rad: f64) -> Vec3 {
    let (first, second) = across(along);
    first * angle_rad.cos() + second * angle_rad.sin()
}

/// Returns point `i` of a spiral over the half sphere at a height: all are about as far from their neighbours.
fn on_half_sphere(i: usize, height: f64) -> Vec3 {
    let (sine, cosine) = (i as f64 * PI * (3.0 - 5f64.sqrt())).sin_cos();
    let radius = (1.0 - height * height).sqrt();
    Vec3::new(radius * cosine, height, radius * sine)
}

/// Returns two directions across one, and across each other.
fn across(direction: &Vec3) -> (Vec3, Vec3) {
    let first = direction.cross(&Vec3::ith(direction.iamin(), 1.0));
    let first = first.normalize();
    (first, direction.cross(&first))
}
