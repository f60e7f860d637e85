//! A plot of lines with title and unit on top, round ticks and a light grid; and sheets of several plots.

use std::borrow::Cow;

use super::{
    axis::Axis,
    svg::{Path, escape, svg_file, titled},
};

/// Space around the grid for heading and labels, px.
const LEFT: f64 = 46.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 38.0;
const BOTTOM: f64 = 30.0;
const X_TITLE: f64 = 15.0;
const MAX_INTERVALS: usize = 5;

/// Space between rows of panels on a sheet, px.
const GAP: f64 = 14.0;
/// Height of the key below the panels of a sheet, px.
const KEY: f64 = 26.0;

pub(crate) const MEASURED: &str = "specimen";

/// Returns the style of a run, or of another of several alike; styles repeat after six.
pub(crate) fn run_class(run: usize) -> &'static str {
    const CLASSES: [&str; 6] = ["run-1", "run-2", "run-3", "run-4", "run-5", "run-6"];
    CLASSES[run % CLASSES.len()]
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Curve {
    /// Its name in the legend of the interactive plot.
    pub(crate) name: String,
    /// Class of its style: `first`, `last`, [`MEASURED`] or `run-1` and so on.
    pub(crate) class: &'static str,
    /// Points (x, y); a point with NaN breaks the line.
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) has_dots: bool,
    pub(crate) end: Option<String>,
}

impl Curve {
    pub(crate) fn new(class: &'static str, points: Vec<(f64, f64)>) -> Self {
        Self {
            class,
            points,
            ..Self::default()
        }
    }

    pub(crate) fn dotted(self) -> Self {
        Self {
            has_dots: true,
            ..self
        }
    }

    pub(crate) fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// Returns whether two of its points are joined.
    fn has_line(&self) -> bool {
        let joined = |pair: &[(f64, f64)]| pair.iter().all(|point| point.1.is_finite());
        self.points.windows(2).any(joined)
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Panel {
    /// Distinguishes the plot on a page.
    pub(crate) id: String,
    /// Interactive plots of one group share their cursor.
    pub(crate) group: String,
    pub(crate) title: String,
    pub(crate) unit: String,
    /// The positive direction in words; may be empty.
    pub(crate) positive: Cow<'static, str>,
    pub(crate) x: Axis,
    /// Ticks of the horizontal axis with their texts; round numbers if empty.
    pub(crate) x_marks: Vec<(f64, String)>,
    /// Unit of the horizontal axis, after its last tick; may be empty.
    pub(crate) x_unit: &'static str,
    /// Title of the horizontal axis, on a line below it; may be empty.
    pub(crate) x_title: String,
    /// Cycles for one unit of the horizontal axis; 0 where it shows no cycles.
    pub(crate) cycles_per_x: f64,
    pub(crate) size: (f64, f64),
    pub(crate) from_zero: bool,
    pub(crate) min_span: f64,
    pub(crate) curves: Vec<Curve>,
    /// A sentence for readers who cannot see it.
    pub(crate) desc: String,
}

impl Panel {
    pub(crate) fn svg(&self) -> String {
        let ((width, height), id) = (self.size, escape(&self.id));
        let (title, desc) = (escape(&self.title), escape(&self.desc));
        format!(
            r#"<svg class="fig" role="img" data-chart="{id}" aria-labelledby="{id}-t {id}-d" viewBox="0 0 {width} {height}"><title id="{id}-t">{title}</title><desc id="{id}-d">{desc}</desc>{}</svg>"#,
            self.body()
        )
    }

    fn body(&self) -> String {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        let base = self.from_zero.then_some([0.0, self.min_span]);
        let all = points
            .map(|point| point.1)
            .chain(base.into_iter().flatten());
        let y = Axis::over(all, self.min_span, MAX_INTERVALS);
        let lines = self.curves.iter().map(|curve| self.line(curve, &y));
        self.heading() + &self.grid(&y) + &lines.collect::<String>()
    }

    fn heading(&self) -> String {
        let title = titled(&self.title, &self.unit);
        let heading = format!(r#"<text x="{LEFT}" y="16" class="title">{title}</text>"#);
        if self.positive.is_empty() {
            return heading;
        }
        let (right, positive) = (self.right(), escape(&self.positive));
        heading + &format!(r#"<text x="{right}" y="16" text-anchor="end">+ {positive}</text>"#)
    }

    fn grid(&self, y: &Axis) -> String {
        let (mut lines, mut zero) = (Path::default(), Path::default());
        let mut labels = String::new();
        for tick in y.ticks() {
            let height = self.to_y(y, tick);
            let is_zero = tick.abs() < y.step / 2.0;
            let line = if is_zero { &mut zero } else { &mut lines };
            line.open([(LEFT, height), (self.right(), height)]);
            let (x, base, label) = (LEFT - 7.0, height + 3.8, y.label(tick));
            labels += &format!(r#"<text x="{x}" y="{base:.1}" text-anchor="end">{label}</text>"#);
        }
        let (lines, zero, across) = (lines.data(), zero.data(), self.x_labels());
        format!(
            r#"<path class="grid" d="{lines}"/><path class="axis" d="{zero}"/>{labels}{across}"#
        )
    }

    fn x_labels(&self) -> String {
        let base = self.bottom() + 17.0;
        let centred = |x: f64, y: f64, text: &str| {
            format!(r#"<text x="{x:.1}" y="{y}" text-anchor="middle">{text}</text>"#)
        };
        let mark = |(at, text): &(f64, String)| centred(self.to_x(*at), base, &escape(text));
        let tick = |tick: f64| {
            let label = self.x.label(tick);
            let is_last = tick > self.x.high - self.x.step / 2.0;
            if !is_last || self.x_unit.is_empty() {
                return centred(self.to_x(tick), base, &label);
            }
            let (unit, end) = (escape(self.x_unit), self.right() + 8.0);
            format!(r#"<text x="{end:.1}" y="{base}" text-anchor="end">{label}&#160;{unit}</text>"#)
        };
        let mut labels: String = match self.x_marks.as_slice() {
            [] => self.x.ticks().map(tick).collect(),
            marks => marks.iter().map(mark).collect(),
        };
        if !self.x_title.is_empty() {
            let middle = f64::midpoint(LEFT, self.right());
            labels += &centred(middle, self.bottom() + 33.0, &escape(&self.x_title));
        }
        labels
    }

    fn line(&self, curve: &Curve, y: &Axis) -> String {
        let place = |&(u, v): &(f64, f64)| (self.to_x(u), self.to_y(y, v));
        let points = || curve.points.iter().map(place);
        let mut path = Path::default();
        path.open(points());
        let mut out = format!(r#"<path class="{}" d="{}"/>"#, curve.class, path.data());
        if curve.has_dots {
            let seen = points().filter(|point| point.1.is_finite());
            out.extend(seen.map(|(x, y)| dot(curve.class, x, y)));
        }
        if let (Some(label), Some((x, y))) = (&curve.end, points().next_back()) {
            let (x, y) = (x + 4.0, y - 9.0);
            out += &format!(
                r#"<text class="end" x="{x:.1}" y="{y:.1}" text-anchor="end">{label}</text>"#
            );
        }
        out
    }

    fn right(&self) -> f64 {
        self.size.0 - RIGHT
    }

    fn bottom(&self) -> f64 {
        let has_title = !self.x_title.is_empty();
        self.size.1 - BOTTOM - if has_title { X_TITLE } else { 0.0 }
    }

    fn to_x(&self, value: f64) -> f64 {
        LEFT + self.x.fraction(value) * (self.right() - LEFT)
    }

    fn to_y(&self, axis: &Axis, value: f64) -> f64 {
        self.bottom() - axis.fraction(value) * (self.bottom() - TOP)
    }
}

fn dot(class: &str, x: f64, y: f64) -> String {
    let class = match class {
        "first" | "last" => "dot".to_owned(),
        own => format!("dot {own}"),
    };
    format!(r#"<circle class="{class}" cx="{x:.1}" cy="{y:.1}" r="2.6"/>"#)
}

/// Returns an SVG file of panels in rows of `columns`, with a key of (class, meaning) below.
pub(crate) fn sheet(
    title: &str,
    desc: &str,
    panels: &[Panel],
    columns: usize,
    key: &[(&str, &str)],
) -> String {
    let (across, down) = panels.first().map_or((0.0, 0.0), |panel| panel.size);
    let pitch = down + GAP;
    let place = |(index, panel): (usize, &Panel)| {
        let x = (index % columns) as f64 * across;
        let y = (index / columns) as f64 * pitch;
        format!(r#"<g transform="translate({x} {y})">{}</g>"#, panel.body())
    };
    let mut body: String = panels.iter().enumerate().map(place).collect();
    let height = panels.len().div_ceil(columns) as f64 * pitch;
    let size = (columns as f64 * across, height + KEY);
    // Width of a letter, and the least distance from one entry of the key to the next, px.
    const LETTER: f64 = 6.2;
    const PITCH: f64 = 130.0;
    let (mut x, y) = (LEFT, height + KEY / 2.0);
    for (class, meaning) in key {
        let (end, text, base) = (x + 24.0, x + 32.0, y + 3.8);
        let words = escape(meaning);
        let curves = panels.iter().flat_map(|panel| &panel.curves);
        let own: Vec<&Curve> = curves.filter(|curve| curve.class == *class).collect();
        if own.iter().any(|curve| curve.has_line()) {
            body += &format!(r#"<path class="{class}" d="M{x} {y}H{end}"/>"#);
        }
        if own.iter().any(|curve| curve.has_dots) {
            body += &dot(class, x + 12.0, y);
        }
        body += &format!(r#"<text x="{text}" y="{base}">{words}</text>"#);
        x += PITCH.max(56.0 + LETTER * meaning.chars().count() as f64);
    }
    svg_file(title, desc, size, &body)
}
