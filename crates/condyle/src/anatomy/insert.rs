//! Signs of the top, the front and the right of an insert.

use super::{
    orientation::Orientation,
    views::{Picture, Views, beyond, mean, median, part},
};

/// Returns the score of an orientation of an insert, and whether it shows the signs of every insert of a whole knee; if
/// not, the score is meaningless. Each sign counts up to a limit. Lengths are shares of the longest extent.
pub(super) fn fit(views: &Views, orientation: &Orientation) -> (f64, bool) {
    let Orientation {
        anterior,
        superior,
        right,
    } = *orientation;
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
    // Height of the dishes' ends over their middles.
    let (front, back, middle) = dish_heights(&above, None);
    let hollow = front.min(back) - middle;
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
    let beside = part(above.columns, 0.25, 0.35).chain(part(above.columns, 0.65, 0.75));
    let middle = part(above.columns, 0.47, 0.53);
    let share = |rows: Option<usize>| rows.unwrap_or(0) as f64 / above.rows as f64;
    share(middle.map(empty).min()) - share(beside.map(empty).max())
}
