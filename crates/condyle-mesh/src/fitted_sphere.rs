//! The ball or socket that is part of a body of triangles, found without knowing where it is.

use std::cmp::Reverse;

use nalgebra::{Matrix4, Vector4};

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// The side of a sphere on which the material is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roundness {
    /// Inside: a ball.
    Convex,
    /// Outside: a socket.
    Concave,
}

/// A sphere through the vertices of a part of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedSphere {
    /// Centre, mm.
    pub centre_mm: Vec3,
    /// Radius, mm.
    pub radius_mm: f64,
    /// Root mean square distance of the vertices of its part to the sphere, mm.
    pub rms_mm: f64,
    /// Mean direction from its part to the centre, a unit vector: that in which a socket opens.
    pub opens_along: Vec3,
}

/// Pairs of facets that propose spheres. With 5 % of the area on the sphere, ten pairs have both facets on it.
const PROPOSALS: usize = 4000;
/// Facets that judge a proposal.
const JUDGES: usize = 2000;
/// Smallest number of judges on a proposal that is examined, 5 %: the rounded corners of a block are no balls.
const MIN_JUDGES: usize = JUDGES / 20;
/// Distances to the sphere, as shares of its radius, within which a vertex is part of it, from the proposal to the last
/// of three fits. The last is 0.07 mm of a hip: above the noise of a scan, and below a chamfer.
const TOLERANCES: [f64; 4] = [0.03, 0.03, 0.01, 0.005];
/// Cosine of the largest angle between the normal of a facet of a sphere and its radius.
const MIN_COSINE: f64 = 0.9;
/// Smallest area of the part, in squares of the radius times pi: a cap of 30 degrees has 0.27.
const MIN_AREA: f64 = 0.25;
/// Sum of the area vectors of a mesh, as a share of its area, up to which it is closed.
const CLOSED: f64 = 1e-3;

/// A triangle by its corners, its unit normal and its area.
#[derive(Clone, Copy)]
struct Facet {
    corners: [Vec3; 3],
    normal: Vec3,
    area_mm2: f64,
}

impl Facet {
    fn middle(&self) -> Vec3 {
        self.corners.iter().sum::<Vec3>() / 3.0
    }
}

/// Centre and radius, mm.
type Sphere = (Vec3, f64);

impl FittedSphere {
    /// Returns the sphere with the largest part of the surface of a mesh on it, by its area, of those with a cap of about 30
    /// degrees or more; `None` without one.
    ///
    /// Facets propose spheres in pairs: their normals meet in the centre. The proposals are the same in every run. The best
    /// is fitted by least squares to the vertices of the facets on it. A closed mesh must face outwards or inwards
    /// throughout; the facets of an open one have no inside, and any sphere is found.
    pub fn new(mesh: &TriangleMesh, roundness: Roundness) -> Option<Self> {
        let facets = facets(mesh, roundness);
        let (part, area_mm2, (centre, radius)) = cap(&facets, best_proposal(&facets)?)?;
        let squares = part.iter().map(|facet| {
            let apart = facet
                .corners
                .map(|corner| ((corner - centre).norm() - radius).powi(2));
            facet.area_mm2 * apart.iter().sum::<f64>() / 3.0
        });
        let towards: Vec3 = part
            .iter()
            .map(|facet| (centre - facet.middle()) * facet.area_mm2)
            .sum();
        Some(Self {
            centre_mm: centre,
            radius_mm: radius,
            rms_mm: (squares.sum::<f64>() / area_mm2).sqrt(),
            opens_along: towards.try_normalize(0.0)?,
        })
    }
}

/// Returns the facets on the sphere that is fitted to those near a proposed one, their area, and the fitted sphere; `None` if
/// they are less than the smallest cap.
fn cap(facets: &[Facet], (mut centre, mut radius): Sphere) -> Option<(Vec<&Facet>, f64, Sphere)> {
    let mut part: Vec<&Facet> = Vec::new();
    for tolerance in &TOLERANCES[1..] {
        let on = facets.iter();
        part = on
            .filter(|facet| is_on(facet, &centre, radius, *tolerance))
            .collect();
        (centre, radius) = fitted(&part)?;
    }
    let area_mm2 = part.iter().map(|facet| facet.area_mm2).sum();
    let is_cap = area_mm2 >= MIN_AREA * std::f64::consts::PI * radius * radius;
    is_cap.then_some((part, area_mm2, (centre, radius)))
}

/// Returns the facets of a mesh with normals that point to the centre of the sphere wanted; of an open mesh both ways.
fn facets(mesh: &TriangleMesh, roundness: Roundness) -> Vec<Facet> {
    let facet = |triangle: usize| {
        let corners @ [a, b, c] = mesh.corners(triangle);
        let twice = (b - a).cross(&(c - a));
        let normal = twice.try_normalize(0.0)?;
        Some(Facet {
            corners,
            normal,
            area_mm2: twice.norm() / 2.0,
        })
    };
    let mut facets: Vec<Facet> = (0..mesh.triangles.len()).filter_map(facet).collect();
    let area_mm2: f64 = facets.iter().map(|facet| facet.area_mm2).sum();
    let sum: Vec3 = facets
        .iter()
        .map(|facet| facet.normal * facet.area_mm2)
        .sum();
    let turned = |facet: &Facet| Facet {
        normal: -facet.normal,
        ..*facet
    };
    if sum.norm() > CLOSED * area_mm2 {
        let both: Vec<Facet> = facets.iter().map(turned).collect();
        facets.extend(both);
    } else if (mesh.signed_volume() < 0.0) != (roundness == Roundness::Convex) {
        facets = facets.iter().map(turned).collect();
    }
    facets
}

/// Returns the proposed sphere with the largest part of the surface on it of those that have a cap: the cone of a lip touches
/// more of larger spheres, but has none.
fn best_proposal(facets: &[Facet]) -> Option<Sphere> {
    let area_mm2: f64 = facets.iter().map(|facet| facet.area_mm2).sum();
    let mut until_mm2 = 0.0;
    let until = facets.iter().map(|facet| {
        until_mm2 += facet.area_mm2;
        until_mm2
    });
    let until: Vec<f64> = until.collect();
    let at = |share: f64| {
        let index = until.partition_point(|&until_mm2| until_mm2 < share * area_mm2);
        facets.get(index).copied()
    };
    let judge = |n: usize| at((n as f64 + 0.5) / JUDGES as f64);
    let judges = (0..JUDGES).filter_map(judge).map(|facet| Facet {
        area_mm2: area_mm2 / JUDGES as f64,
        ..facet
    });
    let judges: Vec<Facet> = judges.collect();
    let proposals = (1..=PROPOSALS).filter_map(|n| {
        // The additive sequence of the plastic number fills the square of pairs evenly.
        let share = |step: f64| (n as f64 * step).fract();
        let (one, other) = (at(share(0.754_877_666_2))?, at(share(0.569_840_291_0))?);
        let (centre, radius) = proposal(&one, &other)?;
        let agree = judges.iter();
        let agree = agree.filter(|judge| is_on(judge, &centre, radius, TOLERANCES[0]));
        Some((agree.count(), (centre, radius)))
    });
    let mut proposals: Vec<(usize, Sphere)> = proposals.collect();
    proposals.sort_by_key(|(count, _)| Reverse(*count));
    let large = proposals.iter().filter(|(count, _)| *count >= MIN_JUDGES);
    let mut large = large.map(|(_, sphere)| *sphere);
    let with_cap = large.find(|sphere| cap(&judges, *sphere).is_some());
    // A cap that is close to the smallest may have it in the whole surface only.
    with_cap.or(proposals.first().map(|(_, sphere)| *sphere))
}

/// Returns centre and radius of the sphere that two facets touch, if their normals lead to its centre.
fn proposal(one: &Facet, other: &Facet) -> Option<Sphere> {
    let (between, turn) = (one.middle() - other.middle(), one.normal - other.normal);
    // Both are a radius from the centre along their normals; parallel normals give no centre.
    let radius = -between.dot(&turn) / turn.norm_squared();
    let is_sphere = radius.is_finite() && radius > 0.0;
    is_sphere.then(|| {
        (
            (one.middle() + other.middle() + (one.normal + other.normal) * radius) / 2.0,
            radius,
        )
    })
}

fn is_on(facet: &Facet, centre: &Vec3, radius: f64, tolerance: f64) -> bool {
    let is_near = |corner: &Vec3| ((corner - centre).norm() - radius).abs() < tolerance * radius;
    let inward = (centre - facet.middle()).dot(&facet.normal);
    facet.corners.iter().all(is_near) && inward > MIN_COSINE * (centre - facet.middle()).norm()
}

/// Returns the sphere of least squares, |v|2 = 2 c v + (r2 - |c|2), through the corners of facets, weighed by area.
fn fitted(part: &[&Facet]) -> Option<Sphere> {
    // An origin on the part, so that a body far from the origin of its file loses no digits.
    let origin = part.first()?.corners[0];
    let (mut matrix, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for facet in part {
        for corner in facet.corners {
            let place = corner - origin;
            let row = (2.0 * place).push(1.0);
            matrix += row * row.transpose() * facet.area_mm2;
            right += row * place.norm_squared() * facet.area_mm2;
        }
    }
    let solution = matrix.cholesky()?.solve(&right);
    let centre = solution.xyz();
    let radius = (solution.w + centre.norm_squared()).sqrt();
    radius.is_finite().then_some((centre + origin, radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a liner of 16 and 24 mm that opens upwards, with a flat bottom outside, in coarse facets.
    fn liner() -> TriangleMesh {
        let arc = |radius: f64, from: f64, to: f64| {
            (0..=12).map(move |n| {
                let angle = (from + (to - from) * f64::from(n) / 12.0).to_radians();
                (radius * angle.sin(), -radius * angle.cos())
            })
        };
        let profile: Vec<(f64, f64)> = arc(24.0, 1e-6, 85.0).chain(arc(16.0, 85.0, 1e-6)).collect();
        TriangleMesh::revolved(&profile, 24)
    }

    #[test]
    fn a_liner_has_its_socket_and_its_ball_wherever_it_lies() {
        let turn = nalgebra::Rotation3::new(Vec3::new(0.4, 1.1, -0.7));
        let shift = Vec3::new(900.0, -300.0, 40.0);
        let mut mesh = liner().mapped(|vertex| turn * vertex + shift);
        for _ in 0..2 {
            let socket = FittedSphere::new(&mesh, Roundness::Concave).unwrap();
            assert!((socket.radius_mm - 16.0).abs() < 1e-6, "{socket:?}");
            assert!((socket.centre_mm - shift).norm() < 1e-6);
            assert!((turn.inverse() * socket.opens_along - Vec3::y()).norm() < 1e-3);
            assert!(socket.rms_mm < 1e-6);
            let ball = FittedSphere::new(&mesh, Roundness::Convex).unwrap();
            assert!((ball.radius_mm - 24.0).abs() < 1e-6);
            // The same body inside out.
            mesh.triangles
                .iter_mut()
                .for_each(|triangle| triangle.swap(1, 2));
        }
    }

    #[test]
    fn noise_is_reported_and_a_block_has_no_ball() {
        let mut state = 1u64;
        let mut noise = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let mut mesh = liner();
        for vertex in &mut mesh.vertices {
            *vertex += 0.06 * Vec3::new(noise(), noise(), noise());
        }
        let socket = FittedSphere::new(&mesh, Roundness::Concave).unwrap();
        assert!((socket.radius_mm - 16.0).abs() < 0.005, "{socket:?}");
        assert!((0.01..0.025).contains(&socket.rms_mm), "{socket:?}");
        let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        assert_eq!(FittedSphere::new(&block, Roundness::Convex), None);
    }

    #[test]
    fn a_socket_is_found_inside_a_larger_conical_lip() {
        // The lip slopes by 20 degrees, from the end of a socket of 20.3 mm to 30 mm from the axis.
        let slope = 20_f64.to_radians();
        let arc = (0..=16).map(|n| (2.5 * f64::from(n)).to_radians());
        let socket = arc.map(|angle| (20.3 * angle.sin().max(1e-6), -20.3 * angle.cos()));
        let mut profile: Vec<(f64, f64)> = socket.collect();
        let (edge, height) = profile[profile.len() - 1];
        let lip = (1..=20).map(|n| f64::from(n) * (30.0 - edge) / 20.0);
        profile.extend(lip.map(|out| (edge + out, height + out * slope.tan())));
        let body = TriangleMesh::revolved(&profile, 48);
        let socket = FittedSphere::new(&body, Roundness::Concave).expect("40 degrees are a cap");
        assert!((socket.radius_mm - 20.3).abs() < 1e-3, "{socket:?}");
    }

    #[test]
    fn a_socket_is_found_in_an_open_surface() {
        let half: Vec<(f64, f64)> = (0..=10)
            .map(|n| (9.0 * f64::from(n)).to_radians())
            .map(|angle| (14.0 * angle.sin(), -14.0 * angle.cos()))
            .collect();
        let socket =
            FittedSphere::new(&TriangleMesh::revolved(&half, 20), Roundness::Concave).unwrap();
        assert!((socket.radius_mm - 14.0).abs() < 1e-9 && socket.opens_along.y > 0.99);
    }
}
