//! Shape criteria for the superior, anterior and right directions of both bodies, and for the side of a femur.

use super::views::{Orientation, Picture, Views, beyond, mean, median, part};
use crate::{Vec3, geometry::TriangleMesh};

/// Depth between the condyles beyond which there is no surface.
const DEEPEST_RECESS: f64 = 0.2;
/// Largest difference between left and right that counts as symmetric.
const LEVEL: f64 = 0.05;

/// Returns the score of an orientation of a femoral component, and whether it shows the signs of every whole
/// component; if not, the score is meaningless. Lengths are shares of the longest extent.
pub(super) fn fit_femur(views: &Views, of: &Orientation) -> (f64, bool) {
    let (anterior, superior, right) = (of.anterior, of.superior, of.right);
    let below = views.picture(superior.reversed(), anterior, right);
    let front = views.picture(anterior, superior, right);
    let behind = views.picture(anterior.reversed(), superior, right);
    // Mean share of each view without a mirror image on the other side.
    let asymmetry = [&below, &front, &behind]
        .map(|seen| seen.asymmetry(LEVEL))
        .iter()
        .sum::<f64>()
        / 3.0;
    // Amount by which the silhouette from the side, a box open above, holds more water than in other rotations, -1 to
    // 1.
    let side = |up, along| views.picture(right, up, along).water();
    let others = [
        side(superior.reversed(), anterior),
        side(anterior, superior),
        side(anterior.reversed(), superior),
    ];
    let (water, other) = (
        side(superior, anterior),
        others.into_iter().fold(0.0, f64::max),
    );
    let open_above = (water - other) / water.max(other).max(MIN_WATER);
    // Depth between the condyles where they are lowest.
    let two_condyles = at_the_lowest(&below);
    // Amount by which the recess between the condyles is deeper behind, at the notch, than in front, at the trochlea,
    // -1 to 1.
    let from_below = recess(&below, 0.0, 0.4) - recess(&below, 0.6, 1.0);
    let from_the_ends = recess(&behind, 0.0, 0.6) - recess(&front, 0.0, 0.6);
    let notch_behind = (from_below + from_the_ends) / 2.0;
    // Amount by which the condyles rise more steeply behind than in front; used where neither end is bridged.
    let unbridged = least_recess(&below, 0.0, 0.4).min(least_recess(&below, 0.6, 1.0));
    let curl_behind =
        beyond(unbridged, MIN_UNBRIDGED) / (1.0 - MIN_UNBRIDGED) * curl_behind(&below);
    let score = -10.0 * asymmetry
        + 4.0 * open_above
        + 20.0 * two_condyles
        + 8.0 * notch_behind
        + 20.0 * curl_behind.clamp(-0.15, 0.15);
    (score, asymmetry < 0.5 && two_condyles > 0.05 && score > 5.0)
}

/// Upper bound of the recess over a trochlea, however deep its groove, as a share of the deepest.
const MIN_UNBRIDGED: f64 = 0.7;
/// Smallest share of the silhouette's area that counts as held water.
const MIN_WATER: f64 = 0.02;

/// Returns the depth of the middle of a row, seen from below, relative to both sides.
fn recess_of(below: &Picture, row: usize) -> Option<f64> {
    let highest = |from, to| below.across(row, from, to).reduce(f64::max);
    let sides = highest(0.05, 0.4)?.min(highest(0.6, 0.95)?);
    let deep = highest(0.46, 0.54).map_or(DEEPEST_RECESS, |middle| sides - middle);
    Some(deep.clamp(-DEEPEST_RECESS, DEEPEST_RECESS))
}

/// Returns the recess over a part of the length, as a share of the deepest.
fn recess(below: &Picture, from: f64, to: f64) -> f64 {
    let rows = part(below.rows, from, to);
    mean(rows.filter_map(|row| recess_of(below, row))) / DEEPEST_RECESS
}

/// Returns the shallowest recess over a part of the length, as a share of the deepest.
fn least_recess(below: &Picture, from: f64, to: f64) -> f64 {
    let rows = part(below.rows, from, to);
    let least = rows
        .filter_map(|row| recess_of(below, row))
        .reduce(f64::min);
    least.unwrap_or(0.0).max(0.0) / DEEPEST_RECESS
}

/// Returns the recess where the body reaches lowest.
fn at_the_lowest(below: &Picture) -> f64 {
    let lowest_of = |row: usize| below.across(row, 0.0, 1.0).reduce(f64::max);
    let lowest = (0..below.rows).filter_map(lowest_of).reduce(f64::max);
    let is_low = |row: &usize| lowest_of(*row) > lowest.map(|lowest| lowest - LEVEL);
    mean(
        (0..below.rows)
            .filter(is_low)
            .filter_map(|row| recess_of(below, row)),
    )
}

/// Height above the lowest row within which rows count as lowest.
const FLAT: f64 = 0.003;

/// Difference between the slopes of the lower outline, seen from the side, behind and in front of its lowest rows.
///
/// The sagittal radius of the condyles falls from distal to posterior in every design.
fn curl_behind(below: &Picture) -> f64 {
    let outline = |row: usize| below.across(row, 0.0, 1.0).reduce(f64::max);
    let Some(lowest) = (0..below.rows).filter_map(outline).reduce(f64::max) else {
        return 0.0;
    };
    let is_lowest = |row: &usize| outline(*row).is_some_and(|height| height >= lowest - FLAT);
    let first = (0..below.rows).find(is_lowest).unwrap_or(0);
    let last = (0..below.rows).rev().find(is_lowest).unwrap_or(0);
    let reach = first.min(below.rows - 1 - last);
    let steeper = |away: usize| {
        let (behind, in_front) = (outline(first - away)?, outline(last + away)?);
        Some((in_front - behind) / away as f64 * below.rows as f64)
    };
    mean(
        (reach / 2..=reach)
            .filter(|&away| away > 0)
            .filter_map(steeper),
    )
}

/// Returns the score of an orientation of an insert, and whether it shows the signs of every insert of a whole knee; if
/// not, the score is meaningless. Each sign counts up to a limit. Lengths are shares of the longest extent.
pub(super) fn fit_insert(views: &Views, of: &Orientation) -> (f64, bool) {
    let (anterior, superior, right) = (of.anterior, of.superior, of.right);
    let above = views.picture(superior, anterior, right);
    let below = views.picture(superior.reversed(), anterior, right);
    let (length, width, height) = (
        views.cells(anterior),
        views.cells(right),
        views.cells(superior),
    );
    let thin = (length.min(width) / height).ln();
    let wide = (width / length).ln();
    let eminence = eminence(&above);
    // Height of the line between the dishes' ends over their middles, which a slope does not change.
    let (front, back, middle) = dish_heights(&above, None);
    let hollow = f64::midpoint(front, back) - middle;
    // Depth of the cut-out in the middle of the back over that of the front.
    let notch = cut_out(&above, false) - cut_out(&above, true);
    // Thickness of the front ends of the dishes over that of the back ends: 0 for an open surface, whose tilt is unknown.
    let (thick_front, thick_back, _) = dish_heights(&above, Some(&below));
    let lip = thick_front - thick_back;
    let score = 3.0 * thin.clamp(-1.0, 1.0)
        + 6.0 * wide.clamp(-0.5, 0.5)
        + 60.0 * eminence.clamp(-0.1, 0.1)
        + 60.0 * hollow.clamp(-0.1, 0.1)
        + 25.0 * beyond(notch, 0.08).clamp(-0.1, 0.1)
        + 80.0 * beyond(lip, 0.02).clamp(-0.03, 0.03);
    let is_insert = thin > 0.3 && wide > 0.1 && eminence > 0.02 && hollow > 0.005;
    (score, is_insert)
}

/// Returns the height of the middle over both sides of it, in the middle half of the length.
fn eminence(above: &Picture) -> f64 {
    let rows = part(above.rows, 0.25, 0.75);
    mean(rows.filter_map(|row| {
        let left = median(above.across(row, 0.15, 0.4))?;
        let right = median(above.across(row, 0.6, 0.85))?;
        Some(median(above.across(row, 0.45, 0.55))? - left.max(right))
    }))
}

/// Heights of the front ends, the back ends and the middles of the dishes; thicknesses with the view from below.
fn dish_heights(above: &Picture, below: Option<&Picture>) -> (f64, f64, f64) {
    let columns = || part(above.columns, 0.2, 0.4).chain(part(above.columns, 0.6, 0.8));
    let at = |from, to| {
        mean(columns().filter_map(|column| {
            let (first, end) = seen_rows(above, column)?;
            let share =
                |share: f64| (first as f64 + share * (end - first) as f64) / above.rows as f64;
            let (from, to) = (share(from), share(to));
            let high = median(above.along(column, from, to))?;
            let low = below.and_then(|below| median(below.along(column, from, to)));
            Some(high + low.unwrap_or(0.0))
        }))
    };
    (at(0.85, 1.0), at(0.0, 0.15), at(0.35, 0.65))
}

/// Returns the first row that is seen in a column, and one past the last.
fn seen_rows(picture: &Picture, column: usize) -> Option<(usize, usize)> {
    let first = (0..picture.rows).find(|&row| picture.height(row, column).is_some())?;
    Some((first, picture.top(column)))
}

/// Returns the depth of the cut-out in the middle over that of the dishes, from the front or from the back.
fn cut_out(above: &Picture, from_front: bool) -> f64 {
    let empty = |column: usize| {
        let (first, end) = seen_rows(above, column).unwrap_or((above.rows, 0));
        if from_front { above.rows - end } else { first }
    };
    let next_to_it = part(above.columns, 0.25, 0.35).chain(part(above.columns, 0.65, 0.75));
    let middle = part(above.columns, 0.47, 0.53);
    let share = |rows: Option<usize>| rows.unwrap_or(0) as f64 / above.rows as f64;
    share(middle.map(empty).min()) - share(next_to_it.map(empty).max())
}

/// Smallest lead of a flange that identifies the side, as a share of the longest extent: 1 mm for a knee.
const MIN_LEAD: f64 = 0.013;
/// Front part of the length that contains the flanges.
const FRONT: f64 = 0.35;

/// Returns the lead of the right flange of a femoral component's trochlea over the left one, mm;
/// negative where the left one leads, none if they are alike.
///
/// The lateral flange holds the patella and is larger in every design with a left and a right version. The lead is
/// measured forwards from the line behind both posterior condyles, and upwards from the
/// line below both distal ones, as a surgeon does: it does not change if the component is rotated or tilted by a few
/// degrees. `femur` in mm, x anterior, y superior, z right.
pub fn flange_lead_mm(femur: &TriangleMesh) -> Option<f64> {
    let (low, high) = femur.bounds();
    let middle_z = (low.z + high.z) / 2.0;
    let [behind, below] = [0, 1].map(|axis| Line::across(femur, axis, middle_z));
    let in_front = |vertex: &&Vec3| vertex.x > high.x - FRONT * (high.x - low.x);
    let mut reach = [[f64::NEG_INFINITY; 2]; 2];
    for vertex in femur.vertices.iter().filter(in_front) {
        let of_side = &mut reach[usize::from(vertex.z > middle_z)];
        of_side[0] = of_side[0].max(vertex.x - behind.at(vertex.z));
        of_side[1] = of_side[1].max(vertex.y - below.at(vertex.z));
    }
    let [left, right] = reach.map(|[ahead, up]| ahead + up);
    // A mesh on one side of the middle only has infinite or undefined reaches, which are rejected.
    let lead = right - left;
    (lead.is_finite() && lead.abs() > MIN_LEAD * (high - low).max()).then_some(lead)
}

/// A line that touches both condyles from below or from behind, as a height over z.
struct Line {
    height: f64,
    slope: f64,
    middle_z: f64,
}

impl Line {
    /// Creates the line through the lowest place along `axis` on each side of the middle.
    fn across(femur: &TriangleMesh, axis: usize, middle_z: f64) -> Self {
        let lowest = |is_right: bool| {
            let side = femur
                .vertices
                .iter()
                .filter(|v| (v.z > middle_z) == is_right);
            let ends = side.map(|vertex| (vertex[axis], vertex.z));
            ends.min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((f64::NAN, f64::NAN))
        };
        let (left, right) = (lowest(false), lowest(true));
        let slope = (right.0 - left.0) / (right.1 - left.1);
        let height = left.0 + slope * (middle_z - left.1);
        Self {
            height,
            slope,
            middle_z,
        }
    }

    fn at(&self, z: f64) -> f64 {
        self.height + self.slope * (z - self.middle_z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Mat3,
        geometry::{GenericFemur, GenericFemurShape},
    };

    fn symmetric() -> TriangleMesh {
        GenericFemur::new(GenericFemurShape::default()).surface_mesh(1.0)
    }

    /// Returns the front of the right half further ahead.
    fn with_a_flange(by_mm: f64) -> TriangleMesh {
        symmetric().mapped(|v| {
            let is_flange = v.x > 15.0 && v.z > 0.0;
            v + Vec3::x() * if is_flange { by_mm } else { 0.0 }
        })
    }

    #[test]
    fn a_symmetric_femur_shows_no_side() {
        assert_eq!(flange_lead_mm(&symmetric()), None);
    }

    #[test]
    fn a_flange_is_found_on_its_side_however_the_femur_is_rotated_or_tilted() {
        let lead = flange_lead_mm(&with_a_flange(2.5)).unwrap();
        assert!((lead - 2.5).abs() < 1e-9);
        let mirrored = with_a_flange(2.5).mapped(|v| Vec3::new(v.x, v.y, -v.z));
        assert_eq!(flange_lead_mm(&mirrored), Some(-lead));
        for (x, y) in [(0.07, 0.0), (-0.07, 0.0), (0.0, 0.07), (0.0, -0.07)] {
            let turn = Mat3::identity() + Vec3::new(x, y, 0.0).cross_matrix();
            let turned = flange_lead_mm(&with_a_flange(2.5).mapped(|v| turn * v)).unwrap();
            assert!((turned - lead).abs() < 0.3, "{turned}");
        }
    }

    #[test]
    fn a_mesh_with_one_side_only_shows_none() {
        let sliver = TriangleMesh {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y()],
            triangles: vec![[0, 1, 2]],
        };
        assert_eq!(flange_lead_mm(&sliver), None);
    }
}
