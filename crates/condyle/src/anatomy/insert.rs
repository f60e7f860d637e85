//! What tells the top, the front and the right of an insert.

use super::{
    numbers::{beyond, mean, median},
    orientation::Orientation,
    views::{Picture, Views, part},
};

/// What an insert shows if it lies as `orientation` says, each as a share of its longest extent.
#[derive(Clone, Copy, Debug)]
pub(super) struct InsertSigns {
    /// How much less high than long it is, as the logarithm of the ratio.
    thin: f64,
    /// How much wider than long it is, as the logarithm of the ratio.
    wide: f64,
    /// How much higher the eminence is than both dishes beside it.
    eminence: f64,
    /// How much higher the dishes' ends are than their middles.
    hollow: f64,
    /// How much farther the middle of the back is cut out than that of the front.
    notch: f64,
    /// How much thicker the front ends of the dishes are than their back ends: none of an open surface, since nothing says how
    /// it leans.
    lip: f64,
}

impl InsertSigns {
    pub(super) fn of(views: &Views, orientation: &Orientation) -> Self {
        let Orientation {
            anterior,
            superior,
            right,
        } = *orientation;
        let above = views.picture(superior, anterior, right);
        let (length, width, height) = (
            views.cells(anterior),
            views.cells(right),
            views.cells(superior),
        );
        let below = views.picture(superior.reversed(), anterior, right);
        let (front, back, middle) = dish_heights(&above, None);
        let (thick_front, thick_back, _) = dish_heights(&above, Some(&below));
        Self {
            thin: (length.min(width) / height).ln(),
            wide: (width / length).ln(),
            eminence: eminence(&above),
            hollow: front.min(back) - middle,
            notch: cut_out(&above, false) - cut_out(&above, true),
            lip: thick_front - thick_back,
        }
    }

    /// Whether it shows what every insert of a whole knee does; if not, its score means nothing.
    pub(super) fn is_an_insert(&self) -> bool {
        self.thin > 0.3 && self.wide > 0.1 && self.eminence > 0.02 && self.hollow > 0.005
    }

    /// How well all this fits an insert; each sign counts up to a limit, beyond which it proves no more.
    pub(super) fn score(&self) -> f64 {
        3.0 * self.thin.clamp(-1.0, 1.0)
            + 6.0 * self.wide.clamp(-0.5, 0.5)
            + 60.0 * self.eminence.clamp(-0.1, 0.1)
            + 60.0 * self.hollow.clamp(-0.1, 0.1)
            + 25.0 * beyond(self.notch, 0.08).clamp(-0.1, 0.1)
            + 80.0 * beyond(self.lip, 0.02).clamp(-0.03, 0.03)
    }
}

/// How much higher the middle stands than what is beside it, in the middle half of the length.
fn eminence(above: &Picture) -> f64 {
    let rows = part(above.rows, 0.25, 0.75);
    mean(rows.filter_map(|row| {
        let left = median(above.across(row, 0.15, 0.4))?;
        let right = median(above.across(row, 0.6, 0.85))?;
        Some(median(above.across(row, 0.45, 0.55))? - left.max(right))
    }))
}

/// Heights of the front ends, the back ends and the middles of the dishes; thicknesses, if it is seen from below as well.
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

/// The first row that is seen in a column, and the one behind the last.
fn seen_rows(picture: &Picture, column: usize) -> Option<(usize, usize)> {
    let first = (0..picture.rows).find(|&row| picture.height(row, column).is_some())?;
    Some((first, picture.top(column)))
}

/// How much farther the middle is cut out than the dishes beside it, from the front or from the back.
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
