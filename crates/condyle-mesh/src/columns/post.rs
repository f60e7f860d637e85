//! The post of an insert, whose walls have no width seen from above.

use std::{collections::BTreeMap, f64::consts::TAU};

use super::{
    grid::{ColumnGrid, ColumnMesh, Place},
    holes::Hole,
    vertical_lines::VerticalLines,
};
use crate::{Vec3, divided_mesh::DividedMesh, triangle_mesh::TriangleMesh};

/// Distance between the vertical lines that look for a post, mm: a fraction of the width of any post, and independent of the edges
/// of the hexahedra, so that all meshes of an insert have the same post.
const LINES_EVERY_MM: f64 = 0.5;
/// Smallest height of a post above the median of the surface, mm: the lips and the eminence of usual inserts are lower.
const MIN_HEIGHT_MM: f64 = 4.0;
/// Largest share of the insert seen from above that is a post; a larger one is its body, above a rim.
const MAX_AREA: f64 = 0.25;
/// Directions in which its sides are looked for.
const AZIMUTHS: usize = 360;
/// Halvings of the distance between two lines that find its side to a hundredth of a millimetre.
const HALVINGS: usize = 6;
/// Distance either side of the side of a post between which its height is compared, mm: a fillet is as wide.
const ASIDE_MM: f64 = 1.0;
/// Rise over run from which a side is a wall, as for the outline of an insert.
const MIN_RISE: f64 = 1.5;
/// Smallest share of its sides that are walls. The front of a post often slopes.
const MIN_WALLS: f64 = 0.6;
/// Run over rise of a spread vertical wall of the post, radially: 40 degrees, and 50 where it is oblique to the radius by half a right
/// angle, as at the corners of a square post. Neither is a wall.
const RUN: f64 = 1.2;
/// Share of its radius by which the columns at the foot of a post lean inwards at the backside: a vertical column would continue the
/// wall above.
const LEAN: f64 = 0.5;
/// Distance over which the lean vanishes around the foot, relative to the lean at the backside.
const FADE_OF_LEAN: f64 = 3.0;
/// Largest share of its radius by which the top of a post shrinks. The more it shrinks, the less the rest grows, but the steeper are
/// the chamfers of the top.
const MAX_SHRINKAGE: f64 = 0.25;
/// Smallest radius of a post, mm.
const MIN_RADIUS_MM: f64 = 2.0;
/// Distance of a node from the curved surface up to which it is moved onto it, mm: above the chord error of any useful mesh.
const MAX_CHORD_MM: f64 = 0.2;

/// A part of an insert that rises above the rest with steep sides, such as the post of a stabilised knee.
///
/// To mesh it in vertical columns, the space around it is spread: points move away from the axis of the post, the farther the
/// lower they are, so that a vertical wall becomes a slope. The columns of the spread insert, moved back, lead from the walls of the
/// post inwards and down.
pub(super) struct Post {
    middle: Place,
    /// Distance of the side at every azimuth, from x towards z, mm.
    radii_mm: [f64; AZIMUTHS],
    min_radius_mm: f64,
    bottom_mm: f64,
    base_mm: f64,
    top_mm: f64,
}

impl Post {
    /// Finds the post of a closed insert; most have none.
    ///
    /// It is the part around the highest point above the mean of this and the median height, if it is small and most of its sides
    /// are walls.
    pub(super) fn find(shell: &TriangleMesh, lines: &VerticalLines<'_>) -> Option<Self> {
        let (low, high) = shell.bounds();
        let samples =
            ColumnGrid::filling([low.x, low.z], [high.x, high.z], LINES_EVERY_MM, 1).ok()?;
        let top = |place: Place| lines.at(place).map(|through| through.top);
        let numbers = 0..samples.point_count();
        let tops: Vec<Option<f64>> = numbers.map(|n| top(samples.place_of_mm(n))).collect();
        let mut heights: Vec<f64> = tops.iter().flatten().copied().collect();
        heights.sort_unstable_by(f64::total_cmp);
        let (median_mm, top_mm) = (*heights.get(heights.len() / 2)?, *heights.last()?);
        if top_mm - median_mm < MIN_HEIGHT_MM {
            return None;
        }
        let level_mm = (median_mm + top_mm) / 2.0;
        let highest = tops.iter().rposition(|top| *top == Some(top_mm))?;
        let is_above = |n: usize| tops[n].is_some_and(|top| top > level_mm);
        let region = samples.connected(vec![highest], is_above);
        if region.len() as f64 > MAX_AREA * heights.len() as f64 {
            return None;
        }
        let places = region.iter().map(|&sample| samples.place_of_mm(sample));
        let middle = places.sum::<Place>() / region.len() as f64;
        let along = |n: usize| {
            let (sine, cosine) = (TAU * n as f64 / AZIMUTHS as f64).sin_cos();
            Place::new(cosine, sine)
        };
        let radii_mm: [f64; AZIMUTHS] = std::array::from_fn(|n| {
            let above = |radius| top(middle + along(n) * radius).is_some_and(|top| top > level_mm);
            way_out_mm(above)
        });
        // The height at the foot of every wall: from the side outwards, where the surface falls no longer as a wall does.
        let feet = (0..AZIMUTHS).filter_map(|n| {
            let at = |radius: f64| top(middle + along(n) * radius);
            let falls = |radius: f64| Some(at(radius - ASIDE_MM)? - at(radius + ASIDE_MM)?);
            let is_wall =
                |radius: &f64| falls(*radius).is_some_and(|mm| mm > MIN_RISE * 2.0 * ASIDE_MM);
            let wall = (0..)
                .map(|step| radii_mm[n] + f64::from(step) * ASIDE_MM)
                .take_while(is_wall);
            at(wall.last()? + ASIDE_MM)
        });
        let feet: Vec<f64> = feet.collect();
        if (feet.len() as f64) < MIN_WALLS * AZIMUTHS as f64 {
            return None;
        }
        let min_radius_mm = radii_mm.iter().copied().fold(f64::INFINITY, f64::min);
        (min_radius_mm >= MIN_RADIUS_MM).then_some(Self {
            middle,
            min_radius_mm,
            radii_mm,
            bottom_mm: low.y,
            // The lowest foot: a wall below the base would not be spread.
            base_mm: feet.into_iter().fold(f64::INFINITY, f64::min),
            top_mm,
        })
    }

    /// Returns the insert with the space around the post spread, its triangles divided so that no edge is longer than `edge_mm`.
    pub(super) fn spread(&self, shell: &TriangleMesh, edge_mm: f64) -> TriangleMesh {
        let divided = shell
            .clone()
            .with_sides_up_to(edge_mm, |a, b| (a + b) / 2.0);
        divided.mapped(|point| self.moved(point, [0, 1]))
    }

    /// Moves a point along its distance from the axis: of whole and spread insert, the first of two numbers is that of the space from
    /// which it comes.
    fn moved(&self, point: &Vec3, [from, to]: [usize; 2]) -> Vec3 {
        let from_axis = Place::new(point.x, point.z) - self.middle;
        let away_mm = from_axis.norm();
        if away_mm == 0.0 {
            return *point;
        }
        let turns = from_axis.y.atan2(from_axis.x).rem_euclid(TAU) / TAU * AZIMUTHS as f64;
        let (before, part) = (turns as usize % AZIMUTHS, turns.fract());
        let [radius, next] = [before, (before + 1) % AZIMUTHS].map(|n| self.radii_mm[n]);
        let radius = radius + part * (next - radius);
        let height_mm = self.top_mm - self.base_mm;
        let shrinkage = (MAX_SHRINKAGE * self.min_radius_mm).min(RUN * height_mm);
        let at_base = RUN * height_mm - shrinkage;
        let above = point.y - self.base_mm;
        let knots = if above > 0.0 {
            // Around the post the space is stretched, at most by three. A longer way would make slopes of the sides of the insert.
            let fade = RUN * height_mm / 2.0;
            let side = [radius, radius + at_base - RUN * above];
            [[0.0; 2], side, [radius + fade, radius + fade + at_base]]
        } else {
            let lean = LEAN * radius;
            let part = -above / (self.base_mm - self.bottom_mm);
            let fade = FADE_OF_LEAN * lean;
            let side = [radius - part * lean, radius + at_base];
            [[0.0; 2], side, [radius + fade, radius + fade + at_base]]
        };
        let moved_mm = match knots[1..].iter().position(|knot| away_mm < knot[from]) {
            Some(n) => {
                let [start, end] = [knots[n], knots[n + 1]];
                let part = (away_mm - start[from]) / (end[from] - start[from]);
                start[to] + part * (end[to] - start[to])
            }
            None => away_mm + knots[2][to] - knots[2][from],
        };
        let place = self.middle + from_axis * (moved_mm / away_mm);
        Vec3::new(place.x, point.y, place.y)
    }

    /// Moves hexahedra of the spread insert back, and the nodes of their faces onto the curved surface of `shell`.
    ///
    /// The divided triangles of the spread insert are flat. Where a vertical line meets the shell near a node, that place counts, and
    /// on a wall the nearest one.
    pub(super) fn gather(
        &self,
        (columns, holes): &mut (ColumnMesh, Vec<Hole>),
        shell: &TriangleMesh,
        lines: &VerticalLines<'_>,
    ) {
        for node in &mut columns.mesh.nodes {
            *node = self.moved(node, [1, 0]);
        }
        for hole in holes {
            let back = |[x, z]: [f64; 2]| {
                let back = self.moved(&Vec3::new(x, self.base_mm, z), [1, 0]);
                [back.x, back.z]
            };
            [hole.x_mm, hole.z_mm] = back([hole.x_mm, hole.z_mm]);
            hole.outline_mm = hole.outline_mm.iter().copied().map(back).collect();
        }
        let walls = DividedMesh::new(&self.triangles_around(shell));
        let tops = columns.articulating.iter().flatten();
        let faces = tops.map(|&node| (node, true));
        let bottoms = columns.backside.iter().flatten();
        let faces: BTreeMap<u32, bool> = faces.chain(bottoms.map(|&node| (node, false))).collect();
        for (node, is_top) in faces {
            let node = &mut columns.mesh.nodes[node as usize];
            let through = lines.at(Place::new(node.x, node.z));
            let y = through.map(|through| if is_top { through.top } else { through.bottom });
            let vertical = y.map(|y| Vec3::new(node.x, y, node.z));
            let is_near = |at: &Vec3| (at - *node).norm() < MAX_CHORD_MM;
            let nearest = || is_top.then(|| nearest(&walls, node)).flatten();
            let at = vertical
                .filter(is_near)
                .or_else(|| nearest().filter(is_near));
            *node = at.unwrap_or(*node);
        }
    }

    /// Returns the triangles of the post and those next to it.
    fn triangles_around(&self, shell: &TriangleMesh) -> TriangleMesh {
        let reach_mm = self.radii_mm.iter().copied().fold(0.0, f64::max) + 2.0 * ASIDE_MM;
        let is_near = |&vertex: &u32| {
            let at = shell.vertices[vertex as usize];
            (Place::new(at.x, at.z) - self.middle).norm() < reach_mm
        };
        let near = shell
            .triangles
            .iter()
            .filter(|corners| corners.iter().any(is_near));
        TriangleMesh {
            vertices: shell.vertices.clone(),
            triangles: near.copied().collect(),
        }
    }
}

/// Returns the distance at which a way that begins at 0 leaves a region, mm; 0 if it begins outside.
fn way_out_mm(is_inside: impl Fn(f64) -> bool) -> f64 {
    let mut outside = 0.0;
    while is_inside(outside) {
        outside += LINES_EVERY_MM;
    }
    let mut inside = (outside - LINES_EVERY_MM).max(0.0);
    for _ in 0..HALVINGS {
        let between = (inside + outside) / 2.0;
        if is_inside(between) {
            inside = between;
        } else {
            outside = between;
        }
    }
    outside
}

/// Returns the place of a curved surface nearest to a point.
fn nearest(surface: &DividedMesh, point: &Vec3) -> Option<Vec3> {
    let mut nearest = (f64::INFINITY, None);
    for triangle in 0..surface.mesh.triangles.len() {
        if surface.plane_distance2(triangle, point) < nearest.0 {
            let distance2 = surface.distance2(triangle, point);
            if distance2 < nearest.0 {
                nearest = (distance2, Some(triangle));
            }
        }
    }
    nearest
        .1
        .map(|triangle| surface.foot(triangle, point).point)
}
