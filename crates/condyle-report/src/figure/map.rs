//! A field on the articulating surface, seen as a surgeon looks down on the tibia:
//! anterior up, +z to the right.

use condyle_results::Side;

use super::axis::{Axis, round_step};
use super::contour::{Contours, borders};
use super::escape::escape;
use super::marker::{Marker, TextRow};
use super::path::Path;
use crate::number::{fixed, significant};
use crate::results::{
    measure::{Extreme, Region},
    surface::SurfaceFields,
};

/// Bands between 0 and the largest value, at most.
const MAX_BANDS: usize = 12;
/// Half the width of the text below a marker, px, in the large letters of a narrow screen.
const HALF_TEXT_WIDTH: f64 = 110.0;
/// Half the width of the name of a direction, px.
const HALF_DIRECTION: f64 = 40.0;
/// Distance between the height lines of the bare surface, mm.
const HEIGHT_STEP: f64 = 1.0;
/// A largest value below this counts as nothing to show.
const NOTHING: f64 = 1e-12;
/// Share of the first band that stays bare.
const NEXT_TO_NOTHING: f64 = 0.2;
/// Colour of the surface below the first band: polyethylene.
const BARE: &str = "#f2f0ea";

const LEFT: f64 = 30.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 86.0;
const BAR_GAP: f64 = 48.0;
const BAR_WIDTH: f64 = 15.0;
const BAR_LABELS: f64 = 62.0;

/// The colours of a map, from light for little to dark for much, perceptually uniform.
#[derive(Clone, Copy)]
pub(crate) enum Shades {
    /// Yellow, red, black.
    Magma,
    /// Yellow, green, violet.
    Viridis,
    /// Yellow, grey, blue.
    Cividis,
    /// Blue below 0, red above.
    RedBlue,
}

/// What the colours of a map range over.
#[derive(Clone, Copy)]
pub(crate) enum ColourRange {
    /// From 0 to the largest value.
    Own,
    /// From 0 to this value, so that two maps can be compared.
    UpTo(f64),
    /// To this value on both sides of 0; values that are NaN stay bare.
    BothWays(f64),
}

/// A map of one field.
pub(crate) struct Map<'a> {
    /// Distinguishes the picture on a page.
    pub(crate) id: &'static str,
    /// What is shown.
    pub(crate) title: &'static str,
    /// Its unit; empty for a pure number.
    pub(crate) unit: &'static str,
    /// What the largest value of a side is called.
    pub(crate) largest: &'static str,
    /// The surface.
    pub(crate) surface: &'a SurfaceFields,
    /// A value a node.
    pub(crate) values: &'a [f64],
    /// Which knee it is.
    pub(crate) side: Side,
    /// The colours.
    pub(crate) shades: Shades,
    /// What they range over.
    pub(crate) range: ColourRange,
    /// Scale of the picture, px per mm.
    pub(crate) px_per_mm: f64,
}

impl Map<'_> {
    /// The map as an element of a page.
    pub(crate) fn svg(&self) -> String {
        self.svg_with(&self.desc(), "")
    }

    /// The map with something drawn over it, by [`Map::place`], and what it shows in a sentence.
    pub(crate) fn svg_with(&self, desc: &str, over: &str) -> String {
        let ((width, height), id) = (self.size(), self.id);
        let (title, desc, place) = (escape(self.title), escape(desc), self.place_in_words());
        format!(
            r#"<svg class="fig" role="img" data-map="{place}" aria-labelledby="{id}-t {id}-d" viewBox="0 0 {width:.1} {height:.1}"><title id="{id}-t">{title}</title><desc id="{id}-d">{desc}</desc>{}{over}</svg>"#,
            self.body()
        )
    }

    /// The map as content of a larger picture.
    pub(crate) fn body(&self) -> String {
        let (bands, markers) = (self.bands(), self.markers());
        [
            self.surface_picture(&bands),
            self.directions(&markers),
            self.colour_bar(&bands),
            self.scale_bar(),
            markers.iter().map(Marker::svg).collect(),
        ]
        .concat()
    }

    /// Width and height, px.
    pub(crate) fn size(&self) -> (f64, f64) {
        let (width, height) = self.surface_size();
        (
            LEFT + width + BAR_GAP + BAR_WIDTH + BAR_LABELS,
            TOP + height + BOTTOM,
        )
    }

    /// A sentence for those who cannot see it.
    pub(crate) fn desc(&self) -> String {
        let [left, right] = self.side.regions();
        let found: Vec<_> = self
            .extremes()
            .into_iter()
            .map(|(name, extreme)| {
                let (value, place) = (self.value_text(extreme.value), place_text(&extreme));
                format!(
                    "{} {} {value} at {place}",
                    self.largest,
                    name.to_lowercase()
                )
            })
            .collect();
        let found = match found.as_slice() {
            [] => String::from("There is nothing to show yet"),
            found => found.join("; "),
        };
        format!(
            "{} on the articulating surface from above, anterior up, {} on the left, {} on the right. {}.",
            self.title,
            left.to_lowercase(),
            right.to_lowercase(),
            found
        )
    }

    fn largest_value(&self) -> f64 {
        match self.range {
            ColourRange::Own => self
                .surface
                .largest(self.values, Region::Whole)
                .map_or(0.0, |extreme| extreme.value),
            ColourRange::UpTo(largest) | ColourRange::BothWays(largest) => largest,
        }
    }

    fn bands(&self) -> Axis {
        let largest = self.largest_value();
        let (sides, low) = match self.range {
            ColourRange::Own | ColourRange::UpTo(_) => (1, 0.0),
            ColourRange::BothWays(_) => (2, -1.0),
        };
        let step = round_step(largest.max(NOTHING) / (MAX_BANDS / sides) as f64);
        let high = (largest / step - 1e-9).ceil().max(1.0) * step;
        Axis {
            low: low * high,
            high,
            step,
        }
    }

    fn surface_size(&self) -> (f64, f64) {
        let [(x_low, x_high), (z_low, z_high)] = self.surface.bounds();
        (
            (z_high - z_low) * self.px_per_mm,
            (x_high - x_low) * self.px_per_mm,
        )
    }

    /// Where x and z of the insert frame, mm, are in the picture.
    pub(crate) fn place(&self) -> impl Fn(f64, f64) -> (f64, f64) {
        let [(_, x_high), (z_low, _)] = self.surface.bounds();
        let scale = self.px_per_mm;
        move |x, z| (LEFT + (z - z_low) * scale, TOP + (x_high - x) * scale)
    }

    /// What [`Map::place`] follows, for programs of the page: x at the top, z at the left, mm; where these are, px, and px
    /// per mm.
    fn place_in_words(&self) -> String {
        let [(_, x_high), (z_low, _)] = self.surface.bounds();
        let scale = self.px_per_mm;
        format!("{x_high} {z_low} {LEFT} {TOP} {scale}")
    }

    fn surface_picture(&self, bands: &Axis) -> String {
        let borders = borders(&self.surface.quads);
        let contours = Contours::new(self.surface, &borders, self.values, self.place());
        let outline = path(&self.outline(&borders).region(f64::NEG_INFINITY));
        let mut out = format!(r#"<path fill="{BARE}" d="{outline}"/>"#);
        if self.largest_value() > NOTHING {
            out += &self.filled(&contours, bands);
        }
        out += &self.height_lines(&borders);
        out += &self.middle_line();
        out + &format!(r#"<path class="rim" d="{outline}"/>"#)
    }

    /// The whole surface, whatever the values on it.
    fn outline<'a>(&'a self, borders: &'a [[bool; 4]]) -> Contours<'a> {
        let flat = vec![0.0; self.surface.nodes.len()];
        Contours::new(self.surface, borders, &flat, self.place())
    }

    /// Each band is painted over the one below; the first leaves out what is next to nothing.
    fn filled(&self, contours: &Contours, bands: &Axis) -> String {
        (0..bands.intervals())
            .map(|band| {
                let level = match (band, self.range) {
                    (0, ColourRange::BothWays(_)) => f64::NEG_INFINITY,
                    (0, ColourRange::Own | ColourRange::UpTo(_)) => bands.step * NEXT_TO_NOTHING,
                    (band, _) => bands.low + bands.step * band as f64,
                };
                let (fill, shape) = (self.colour(band, bands), path(&contours.region(level)));
                format!(r#"<path class="iso" fill="{fill}" d="{shape}"/>"#)
            })
            .collect()
    }

    fn colour(&self, band: usize, bands: &Axis) -> String {
        let share = (band as f64 + 0.5) / bands.intervals() as f64;
        let is_next_to_zero = (share - 0.5).abs() * (bands.intervals() as f64) < 1.0;
        if matches!(self.range, ColourRange::BothWays(_)) && is_next_to_zero {
            return BARE.to_owned();
        }
        let gradient = match self.shades {
            Shades::Magma => colorous::MAGMA,
            Shades::Viridis => colorous::VIRIDIS,
            Shades::Cividis => colorous::CIVIDIS,
            Shades::RedBlue => colorous::RED_BLUE,
        };
        format!("#{:x}", gradient.eval_continuous(1.0 - 0.95 * share))
    }

    fn height_lines(&self, borders: &[[bool; 4]]) -> String {
        let heights: Vec<_> = self.surface.nodes.iter().map(|node| node.y).collect();
        let (low, high) = heights
            .iter()
            .fold((f64::MAX, f64::MIN), |(low, high), &y| {
                (low.min(y), high.max(y))
            });
        let contours = Contours::new(self.surface, borders, &heights, self.place());
        let steps = ((high - low) / HEIGHT_STEP).ceil() as usize;
        let loops: Vec<_> = (1..steps)
            .flat_map(|step| contours.region(low + step as f64 * HEIGHT_STEP))
            .collect();
        let lines = path(&loops);
        format!(r#"<path class="height" d="{lines}"/>"#)
    }

    fn middle_line(&self) -> String {
        let [(x_low, x_high), _] = self.surface.bounds();
        let mut line = Path::default();
        line.open([(x_high, 0.0), (x_low, 0.0)].map(|(x, z)| self.place()(x, z)));
        format!(r#"<path class="middle" d="{}"/>"#, line.data())
    }

    fn directions(&self, markers: &[Marker]) -> String {
        let ((width, height), [left, right]) = (self.surface_size(), self.side.regions());
        let (across, down) = (LEFT + width / 2.0, TOP + height / 2.0);
        let (low, far) = (TOP + height + 17.0, LEFT + width + 16.0);
        let below = self.clear_of_leaders(low, markers);
        format!(
            r#"<g class="side" text-anchor="middle"><text class="side" x="{across:.1}" y="{:.1}">Anterior</text><text class="side" x="{below:.1}" y="{low:.1}">Posterior</text><text class="side" transform="translate({:.1} {down:.1}) rotate(-90)">{left}</text><text class="side" transform="translate({far:.1} {down:.1}) rotate(-90)">{right}</text></g>"#,
            TOP - 10.0,
            LEFT - 11.0,
        )
    }

    /// The middle, or where else at that height below the surface no leader passes.
    fn clear_of_leaders(&self, y: f64, markers: &[Marker]) -> f64 {
        let at = |part: f64| LEFT + part * self.surface_size().0;
        let is_clear = |x: &f64| {
            let mut leaders = markers.iter().map(|marker| marker.leader_at(y));
            leaders.all(|leader| (leader - x).abs() > HALF_DIRECTION)
        };
        let mut places = [0.5, 0.25, 0.75].map(at).into_iter();
        places.find(is_clear).unwrap_or(at(0.5))
    }

    fn colour_bar(&self, bands: &Axis) -> String {
        let (width, height) = self.surface_size();
        let x = LEFT + width + BAR_GAP;
        if self.largest_value() <= NOTHING {
            return self.bar_title(x);
        }
        let band_height = height / bands.intervals() as f64;
        let mut out = String::new();
        for band in 0..bands.intervals() {
            let y = TOP + height - (band + 1) as f64 * band_height;
            let fill = self.colour(band, bands);
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
        out + &self.bar_title(x)
    }

    fn bar_title(&self, x: f64) -> String {
        let (x, y) = (x + BAR_WIDTH + BAR_LABELS, TOP - 14.0);
        let title = escape(self.title);
        let unit = if self.unit.is_empty() {
            String::new()
        } else {
            format!(r#"<tspan class="unit">, {}</tspan>"#, escape(self.unit))
        };
        format!(r#"<text class="strong" x="{x:.1}" y="{y}" text-anchor="end">{title}{unit}</text>"#)
    }

    /// Below the colours, where no leader passes.
    fn scale_bar(&self) -> String {
        const LENGTH_MM: f64 = 10.0;
        let (_, height) = self.surface_size();
        let (length, y) = (LENGTH_MM * self.px_per_mm, TOP + height + 26.0);
        let end = self.size().0 - 1.0;
        let (start, middle) = (end - length, end - length / 2.0);
        format!(
            r#"<path class="leader" d="M{start:.1} {:.1}v7M{start:.1} {y:.1}H{end:.1}M{end:.1} {:.1}v7"/><text x="{middle:.1}" y="{:.1}" text-anchor="middle">{LENGTH_MM} mm</text>"#,
            y - 3.5,
            y - 3.5,
            y + 14.0,
        )
    }

    fn extremes(&self) -> Vec<(&'static str, Extreme)> {
        [Region::Left, Region::Right]
            .into_iter()
            .zip(self.side.regions())
            .filter_map(|(region, name)| Some((name, self.extreme(region)?)))
            .filter(|(_, extreme)| extreme.value.abs() > NOTHING)
            .collect()
    }

    /// The largest value of a region; with its sign, where values go both ways.
    fn extreme(&self, region: Region) -> Option<Extreme> {
        let highest = self.surface.largest(self.values, region)?;
        if !matches!(self.range, ColourRange::BothWays(_)) {
            return Some(highest);
        }
        let turned: Vec<f64> = self.values.iter().map(|value| -value).collect();
        let lowest = self.surface.largest(&turned, region)?;
        if lowest.value <= highest.value {
            return Some(highest);
        }
        Some(Extreme {
            value: -lowest.value,
            ..lowest
        })
    }

    /// A ring at the largest value of each side, with what it is and where.
    fn markers(&self) -> Vec<Marker> {
        let (width, height) = self.surface_size();
        let row = TextRow {
            half_width: HALF_TEXT_WIDTH,
            right: LEFT + width,
            bottom: TOP + height,
        };
        let ring = |(name, extreme): &(&str, Extreme)| {
            let place = self.place()(extreme.position.x, extreme.position.z);
            (place, self.marker_lines(name, extreme))
        };
        row.markers(&self.extremes().iter().map(ring).collect::<Vec<_>>())
    }

    fn marker_lines(&self, name: &str, extreme: &Extreme) -> [String; 2] {
        let (largest, name) = (self.largest, name.to_lowercase());
        let value = self.value_text(extreme.value);
        let first = format!(r#"{largest} {name}: <tspan class="strong">{value}</tspan>"#);
        [first, place_text(extreme)]
    }

    fn value_text(&self, value: f64) -> String {
        let text = format!("{}\u{a0}{}", significant(value, 3), self.unit);
        text.trim_end().to_owned()
    }
}

fn place_text(extreme: &Extreme) -> String {
    let (x, z) = (fixed(extreme.position.x, 1), fixed(extreme.position.z, 1));
    format!("x\u{a0}{x}, z\u{a0}{z}\u{a0}mm")
}

fn path(loops: &[Vec<(f64, f64)>]) -> String {
    let mut path = Path::default();
    for points in loops {
        path.closed(points);
    }
    path.data()
}
