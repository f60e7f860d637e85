//! What tells the top, the front and the right of a femoral component.

use super::{
    numbers::{beyond, mean},
    orientation::Orientation,
    views::{Picture, Views, part},
};

/// Deeper than this beside the condyles there is no surface to speak of.
const DEEPEST_RECESS: f64 = 0.2;
/// Left and right may stand out differently by this much and still be called the same.
const LEVEL: f64 = 0.05;

/// What a femoral component shows if it lies as an orientation says, lengths as shares of its longest extent.
#[derive(Clone, Copy, Debug)]
pub(super) struct FemurSigns {
    /// Share of it that has no mirror image on the other side.
    asymmetry: f64,
    /// How much more its shadow from the side holds water than turned any other way, -1 to 1.
    open_above: f64,
    /// How deep the surface lies between the condyles where they are lowest.
    two_condyles: f64,
    /// How much deeper it lies between them behind than in front, -1 to 1: there the notch, here the trochlea.
    notch_behind: f64,
    /// Where neither end is bridged, how much more steeply the condyles rise behind than in front.
    curl_behind: f64,
}

impl FemurSigns {
    pub(super) fn of(views: &Views, orientation: &Orientation) -> Self {
        let Orientation {
            anterior,
            superior,
            right,
        } = *orientation;
        let below = views.picture(superior.reversed(), anterior, right);
        let front = views.picture(anterior, superior, right);
        let behind = views.picture(anterior.reversed(), superior, right);
        let side = |up, along| views.picture(right, up, along);
        let others = [
            side(superior.reversed(), anterior),
            side(anterior, superior),
            side(anterior.reversed(), superior),
        ];
        let upright = side(superior, anterior);
        let from_below = recess(&below, 0.0, 0.4) - recess(&below, 0.6, 1.0);
        let from_the_ends = recess(&behind, 0.0, 0.6) - recess(&front, 0.0, 0.6);
        let unbridged = least_recess(&below, 0.0, 0.4).min(least_recess(&below, 0.6, 1.0));
        Self {
            asymmetry: [&below, &front, &behind]
                .map(|seen| seen.asymmetry(LEVEL))
                .iter()
                .sum::<f64>()
                / 3.0,
            open_above: more_water(&upright, &others),
            two_condyles: at_the_lowest(&below),
            notch_behind: (from_below + from_the_ends) / 2.0,
            curl_behind: beyond(unbridged, MIN_UNBRIDGED) / (1.0 - MIN_UNBRIDGED)
                * curl_behind(&below),
        }
    }

    /// Whether it shows what every femoral component of a whole knee does; if not, its score means nothing.
    pub(super) fn is_a_femur(&self) -> bool {
        self.asymmetry < 0.5 && self.two_condyles > 0.05 && self.score() > 5.0
    }

    /// How well all this fits a femoral component; each sign counts up to a limit, beyond which it proves no more.
    pub(super) fn score(&self) -> f64 {
        -10.0 * self.asymmetry
            + 4.0 * self.open_above
            + 20.0 * self.two_condyles
            + 8.0 * self.notch_behind
            + 20.0 * self.curl_behind.clamp(-0.15, 0.15)
    }
}

/// A trochlea, however deep its groove, leaves less than this share of the deepest recess.
const MIN_UNBRIDGED: f64 = 0.7;
/// Least share of the shadow's area that counts as held water.
const MIN_WATER: f64 = 0.02;

fn more_water(upright: &Picture, others: &[Picture]) -> f64 {
    let water = upright.water();
    let other = others.iter().map(Picture::water).fold(0.0, f64::max);
    (water - other) / water.max(other).max(MIN_WATER)
}

/// How deep the surface seen from below lies in the middle of a row, below both sides of it.
fn recess_of(below: &Picture, row: usize) -> Option<f64> {
    let highest = |from, to| below.across(row, from, to).reduce(f64::max);
    let sides = highest(0.05, 0.4)?.min(highest(0.6, 0.95)?);
    let deep = highest(0.46, 0.54).map_or(DEEPEST_RECESS, |middle| sides - middle);
    Some(deep.clamp(-DEEPEST_RECESS, DEEPEST_RECESS))
}

/// The recess over a part of the length, as a share of the deepest.
fn recess(below: &Picture, from: f64, to: f64) -> f64 {
    let rows = part(below.rows, from, to);
    mean(rows.filter_map(|row| recess_of(below, row))) / DEEPEST_RECESS
}

/// The shallowest recess over a part of the length, as a share of the deepest.
fn least_recess(below: &Picture, from: f64, to: f64) -> f64 {
    let rows = part(below.rows, from, to);
    let least = rows
        .filter_map(|row| recess_of(below, row))
        .reduce(f64::min);
    least.unwrap_or(0.0).max(0.0) / DEEPEST_RECESS
}

/// The recess where the body reaches lowest.
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

/// Rows count as lowest that lie no higher than this above the lowest.
const FLAT: f64 = 0.003;

/// How much more steeply the lower outline, seen from the side, rises behind its lowest rows than in
/// front of them.
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
