//! A field on the articulating surface, seen from above or, of a cup, unrolled: anterior up, +z to the right.

use colorous::Gradient;

use super::{
    axis::{Axis, finite_range, round_step},
    contour::{Contours, Loop},
    marker::{Marker, TextRow},
    svg::{Path, escape, scale_bar, titled},
};
use condyle_results::Directions;

use crate::number::{fixed, significant};
use crate::results::{Extreme, Region, SurfaceFields};

/// Most bands between 0 and the largest value.
const MAX_BANDS: usize = 12;
/// Half the width of the text below a marker, px, in the large letters of a narrow screen.
const HALF_TEXT_WIDTH: f64 = 110.0;
const HALF_DIRECTION: f64 = 40.0;
const HEIGHT_STEP_MM: f64 = 1.0;
/// A largest value below this counts as nothing to show.
const NOTHING: f64 = 1e-12;
/// Share of the first band that stays bare: rounding noise around a scar would have an outline.
const NEXT_TO_NOTHING: f64 = 0.2;
/// Colour of the surface below the first band: polyethylene.
const BARE: &str = "#f2f0ea";

const LEFT: f64 = 30.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 86.0;
const BAR_GAP: f64 = 48.0;
const BAR_WIDTH: f64 = 15.0;
const BAR_LABELS: f64 = 62.0;

#[derive(Clone, Copy)]
pub(crate) struct MapStyle {
    /// Distinguishes the picture on a page.
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) unit: &'static str,
    /// The word for the largest value of a side.
    pub(crate) largest: &'static str,
    /// The colours, perceptually uniform, which run from dark for much to light for little.
    pub(crate) shades: Gradient,
}

impl MapStyle {
    /// Returns the colour of a share of the range, `#rrggbb`.
    pub(crate) fn colour(&self, share: f64) -> String {
        // The lightest twentieth is hard to distinguish from paper.
        let colour = self.shades.eval_continuous(1.0 - 0.95 * share);
        format!("#{colour:x}")
    }
}

#[derive(Clone, Copy)]
pub(crate) enum ColourRange {
    Own,
    /// From 0 to this value, so that two maps can be compared.
    UpTo(f64),
    /// To this value on both sides of 0; values that are NaN stay bare.
    BothWays(f64),
}

#[derive(Clone, Copy)]
pub(crate) struct Map<'a> {
    pub(crate) style: MapStyle,
    pub(crate) surface: &'a SurfaceFields,
    pub(crate) values: &'a [f64],
    pub(crate) directions: Directions,
    pub(crate) range: ColourRange,
    pub(crate) px_per_mm: f64,
}

pub(crate) fn largest_size(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold(0.0, |most, value| value.abs().max(most))
}

impl Map<'_> {
    /// Returns the map as an element of a page, with a description, and with something drawn over it by
    /// [`Map::place`].
    pub(crate) fn svg(&self, desc: &str, over: &str) -> String {
        let ((width, height), MapStyle { id, title, .. }) = (self.size(), self.style);
        let (title, desc) = (escape(title), escape(desc));
        let [(_, x_high), (z_low, _)] = self.surface.bounds();
        // The inverse of `place` for the page's program: x at the top and z at the left, mm; where these are, px; px per mm.
        let place = format!(
            "data-map=\"{x_high} {z_low} {LEFT} {TOP} {}\"",
            self.px_per_mm
        );
        // Places of an unrolled cup are no x and z.
        let place = if self.surface.is_cup { "" } else { &place };
        format!(
            r#"<svg class="fig" role="img" {place} aria-labelledby="{id}-t {id}-d" viewBox="0 0 {width:.1} {height:.1}"><title id="{id}-t">{title}</title><desc id="{id}-d">{desc}</desc>{}{over}</svg>"#,
            self.body()
        )
    }

    pub(crate) fn body(&self) -> String {
        let (bands, markers) = (self.bands(), self.markers());
        let (_, height) = self.surface_size();
        // Below the colours, where no leader passes.
        let scale_bar_end = (self.size().0 - 1.0, TOP + height + 26.0);
        [
            self.surface_picture(&bands),
            self.directions(&markers),
            self.colour_bar(&bands),
            scale_bar(scale_bar_end, self.px_per_mm),
            markers.iter().map(Marker::svg).collect(),
        ]
        .concat()
    }

    pub(crate) fn size(&self) -> (f64, f64) {
        let (width, height) = self.surface_size();
        let bar = BAR_GAP + BAR_WIDTH + BAR_LABELS;
        (LEFT + width + bar, TOP + height + BOTTOM)
    }

    /// Returns a sentence for readers who cannot see it.
    pub(crate) fn desc(&self) -> String {
        let [left, right] = self.directions.along_z().map(str::to_lowercase);
        let top = self.directions.along_x()[0].to_lowercase();
        let view = if self.surface.is_cup {
            "unrolled from its middle"
        } else {
            "from above"
        };
        let (title, largest) = (self.style.title, self.style.largest);
        let sentence = |(name, extreme): &(&str, Extreme)| {
            let (value, place) = (self.value_text(extreme.value), place_text(extreme));
            let name = with_space(name);
            format!("{largest}{name} {value} at {place}")
        };
        let found: Vec<_> = self.extremes().iter().map(sentence).collect();
        let found = match found.as_slice() {
            [] => String::from("There is nothing to show yet"),
            found => found.join("; "),
        };
        format!(
            "{title} on the articulating surface {view}, {top} up, {left} on the left, {right} on the right. {found}."
        )
    }

    /// Maps a place of [`SurfaceFields::flat`], mm, to the picture, px.
    pub(crate) fn place(&self) -> impl Fn(f64, f64) -> (f64, f64) {
        let [(_, x_high), (z_low, _)] = self.surface.bounds();
        let scale = self.px_per_mm;
        move |x, z| (LEFT + (z - z_low) * scale, TOP + (x_high - x) * scale)
    }

    fn largest_value(&self) -> f64 {
        let largest = || self.surface.largest(self.values, Region::Whole);
        match self.range {
            ColourRange::Own => largest().map_or(0.0, |extreme| extreme.value),
            ColourRange::UpTo(largest) | ColourRange::BothWays(largest) => largest,
        }
    }

    fn is_both_ways(&self) -> bool {
        matches!(self.range, ColourRange::BothWays(_))
    }

    fn bands(&self) -> Axis {
        let largest = self.largest_value();
        let sides = if self.is_both_ways() { 2 } else { 1 };
        let step = round_step(largest.max(NOTHING) / (MAX_BANDS / sides) as f64);
        // A largest value that is a multiple of the step but for rounding gets no empty band.
        let high = (largest / step - 1e-9).ceil().max(1.0) * step;
        let low = if self.is_both_ways() { -high } else { 0.0 };
        Axis { low, high, step }
    }

    fn surface_size(&self) -> (f64, f64) {
        let [(x_low, x_high), (z_low, z_high)] = self.surface.bounds();
        let scale = self.px_per_mm;
        ((z_high - z_low) * scale, (x_high - x_low) * scale)
    }

    fn surface_picture(&self, bands: &Axis) -> String {
        let contours = Contours::new(self.surface, self.place());
        let flat = vec![0.0; self.surface.nodes.len()];
        let outline = path(&contours.regions(&flat, &[f64::NEG_INFINITY]).concat());
        let mut out = format!(r#"<path fill="{BARE}" d="{outline}"/>"#);
        if self.largest_value() > NOTHING {
            // Each band is painted over the one below.
            let level = |band: usize| match (band, self.is_both_ways()) {
                (0, true) => f64::NEG_INFINITY,
                (0, false) => bands.step * NEXT_TO_NOTHING,
                (band, _) => bands.low + bands.step * band as f64,
            };
            let levels: Vec<f64> = (0..bands.intervals()).map(level).collect();
            let regions = contours.regions(self.values, &levels);
            for (band, region) in regions.iter().enumerate() {
                let (fill, shape) = (self.colour(band, bands), path(region));
                out += &format!(r#"<path class="iso" fill="{fill}" d="{shape}"/>"#);
            }
        }
        let heights: Vec<f64> = self.surface.nodes.iter().map(|node| node.y).collect();
        let (low, high) = finite_range(heights.iter().copied()).unwrap_or_default();
        let steps = ((high - low) / HEIGHT_STEP_MM).ceil() as usize;
        let level = |step: usize| low + step as f64 * HEIGHT_STEP_MM;
        let levels: Vec<f64> = (1..steps).map(level).collect();
        let heights = path(&contours.regions(&heights, &levels).concat());
        let mut middle = Path::default();
        let [(x_low, x_high), _] = self.surface.bounds();
        if self.directions.is_knee() {
            middle.open([x_high, x_low].map(|x| self.place()(x, 0.0)));
        }
        let middle = middle.data();
        out + &format!(
            r#"<path class="height" d="{heights}"/><path class="middle" d="{middle}"/><path class="rim" d="{outline}"/>"#
        )
    }

    fn colour(&self, band: usize, bands: &Axis) -> String {
        let count = bands.intervals() as f64;
        let share = (band as f64 + 0.5) / count;
        let is_next_to_zero = (share - 0.5).abs() * count < 1.0;
        if self.is_both_ways() && is_next_to_zero {
            return BARE.to_owned();
        }
        self.style.colour(share)
    }

    fn directions(&self, markers: &[Marker]) -> String {
        let ((width, height), [left, right]) = (self.surface_size(), self.directions.along_z());
        let [top, bottom] = self.directions.along_x();
        let (across, down) = (LEFT + width / 2.0, TOP + height / 2.0);
        let (low, far) = (TOP + height + 17.0, LEFT + width + 16.0);
        // "Posterior" is in the middle, or at a place where no leader passes at that height.
        let is_clear = |x: &f64| {
            let mut leaders = markers.iter().map(|marker| marker.leader_at(low));
            leaders.all(|leader| (leader - x).abs() > HALF_DIRECTION)
        };
        let mut places = [0.5, 0.25, 0.75]
            .map(|part| LEFT + part * width)
            .into_iter();
        let below = places.find(is_clear).unwrap_or(across);
        format!(
            r#"<g class="side" text-anchor="middle"><text class="side" x="{across:.1}" y="{:.1}">{top}</text><text class="side" x="{below:.1}" y="{low:.1}">{bottom}</text><text class="side" transform="translate({:.1} {down:.1}) rotate(-90)">{left}</text><text class="side" transform="translate({far:.1} {down:.1}) rotate(-90)">{right}</text></g>"#,
            TOP - 10.0,
            LEFT - 11.0,
        )
    }

    fn colour_bar(&self, bands: &Axis) -> String {
        let (width, height) = self.surface_size();
        let x = LEFT + width + BAR_GAP;
        let mut out = String::new();
        if self.largest_value() > NOTHING {
            let band_height = height / bands.intervals() as f64;
            for band in 0..bands.intervals() {
                let y = TOP + height - (band + 1) as f64 * band_height;
                let fill = self.colour(band, bands);
                // A little higher than the band, so that no paper shows between two.
                out += &format!(
                    r#"<rect x="{x:.1}" y="{y:.2}" width="{BAR_WIDTH}" height="{:.2}" fill="{fill}"/>"#,
                    band_height + 0.3
                );
            }
            for tick in bands.ticks() {
                let y = TOP + height * (1.0 - bands.fraction(tick)) + 3.8;
                let (x, label) = (x + BAR_WIDTH + 6.0, bands.label(tick));
                out += &format!(r#"<text x="{x:.1}" y="{y:.1}">{label}</text>"#);
            }
        }
        let (end, y) = (x + BAR_WIDTH + BAR_LABELS, TOP - 14.0);
        let title = titled(self.style.title, self.style.unit);
        out + &format!(
            r#"<text class="strong" x="{end:.1}" y="{y}" text-anchor="end">{title}</text>"#
        )
    }

    /// Returns the largest value of each region and the region's name; with its sign if values have both signs.
    fn extremes(&self) -> Vec<(&'static str, Extreme)> {
        let size = |value: f64| {
            if self.is_both_ways() {
                value.abs()
            } else {
                value
            }
        };
        let of_side = |(region, name)| {
            let extreme = self.surface.largest_by(self.values, region, size)?;
            (extreme.value.abs() > NOTHING).then_some((name, extreme))
        };
        let regions = Region::all_of(self.directions).into_iter();
        regions.filter_map(of_side).collect()
    }

    /// Returns a ring at the largest value of each region, with value and place.
    fn markers(&self) -> Vec<Marker> {
        let (width, height) = self.surface_size();
        let row = TextRow {
            half_width: HALF_TEXT_WIDTH,
            right: LEFT + width,
            bottom: TOP + height,
        };
        let flat = self.surface.flat();
        let ring = |(name, extreme): (&str, Extreme)| {
            let [x, z] = flat[extreme.node];
            let (largest, name) = (self.style.largest, with_space(name));
            let (place, value) = (self.place()(x, z), self.value_text(extreme.value));
            let first = format!(r#"{largest}{name}: <tspan class="strong">{value}</tspan>"#);
            (place, [first, place_text(&extreme)])
        };
        row.markers(self.extremes().into_iter().map(ring).collect())
    }

    fn value_text(&self, value: f64) -> String {
        let text = format!("{}\u{a0}{}", significant(value, 3), self.style.unit);
        text.trim_end().to_owned()
    }
}

/// Returns the name of a region in small letters after a space; nothing without a name.
fn with_space(name: &str) -> String {
    let space = if name.is_empty() { "" } else { " " };
    format!("{space}{}", name.to_lowercase())
}

fn place_text(extreme: &Extreme) -> String {
    let (x, z) = (fixed(extreme.position.x, 1), fixed(extreme.position.z, 1));
    format!("x\u{a0}{x}, z\u{a0}{z}\u{a0}mm")
}

fn path(loops: &[Loop]) -> String {
    let mut path = Path::default();
    for points in loops {
        path.closed(points);
    }
    path.data()
}
