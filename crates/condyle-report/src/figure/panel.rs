//! One plot of lines: title and unit on top, round ticks, light grid.

use std::fmt::Write as _;

use super::axis::Axis;
use super::escape::escape;
use super::path::Path;

/// Space above a plot's grid for its heading, and around it for the labels, px.
const LEFT: f64 = 46.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 38.0;
const BOTTOM: f64 = 30.0;
const X_TITLE: f64 = 15.0;
const MAX_INTERVALS: usize = 5;

/// Class of what was measured on one of several specimens.
const SPECIMEN: &str = "specimen";

/// A line of a plot.
pub(crate) struct Curve {
    /// Class of its style: `first`, `last` or `specimen`.
    pub(crate) class: &'static str,
    /// Points (x, y); a point with NaN breaks the line.
    pub(crate) points: Vec<(f64, f64)>,
    /// Whether each point gets a dot.
    pub(crate) dots: bool,
    /// A label at the last point.
    pub(crate) end: Option<String>,
}

/// A plot with one or more lines.
pub(crate) struct Panel {
    /// Distinguishes the picture on a page.
    pub(crate) id: String,
    /// What is plotted.
    pub(crate) title: String,
    /// Its unit.
    pub(crate) unit: String,
    /// What the positive direction means; may be empty.
    pub(crate) positive: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// Ticks of the horizontal axis, if not at its round numbers: where, and their texts.
    pub(crate) x_marks: Vec<(f64, String)>,
    /// Unit of the horizontal axis, after its last tick; may be empty.
    pub(crate) x_unit: &'static str,
    /// What the horizontal axis shows, on a line below it; may be empty.
    pub(crate) x_title: String,
    /// Width and height, px.
    pub(crate) size: (f64, f64),
    /// Whether the vertical axis starts at 0.
    pub(crate) from_zero: bool,
    /// The least that the vertical axis spans.
    pub(crate) least_span: f64,
    /// The lines, the lowest first.
    pub(crate) curves: Vec<Curve>,
    /// A sentence for those who cannot see it.
    pub(crate) desc: String,
}

impl Panel {
    /// The panel as an element of a page.
    pub(crate) fn svg(&self) -> String {
        let ((width, height), id) = (self.size, &self.id);
        let (title, desc) = (escape(&self.title), escape(&self.desc));
        format!(
            r#"<svg class="fig" role="img" aria-labelledby="{id}-t {id}-d" viewBox="0 0 {width} {height}"><title id="{id}-t">{title}</title><desc id="{id}-d">{desc}</desc>{}</svg>"#,
            self.body()
        )
    }

    /// The panel as content of a larger picture.
    pub(crate) fn body(&self) -> String {
        let y = self.y_axis();
        let mut out = self.heading();
        out += &self.grid(&y);
        for curve in &self.curves {
            out += &self.line(curve, &y);
        }
        out
    }

    fn y_axis(&self) -> Axis {
        let values = || {
            let all = self.curves.iter().flat_map(|curve| &curve.points);
            all.map(|point| point.1).filter(|value| value.is_finite())
        };
        let start = if self.from_zero { 0.0 } else { f64::INFINITY };
        let low = values().fold(start, f64::min);
        let high = values().fold(if self.from_zero { self.least_span } else { low }, f64::max);
        if !low.is_finite() {
            return Axis::covering(0.0, 1.0, 0.0, MAX_INTERVALS);
        }
        Axis::covering(low, high, self.least_span, MAX_INTERVALS)
    }

    fn heading(&self) -> String {
        let title = escape(&self.title);
        let unit = match escape(&self.unit) {
            unit if unit.is_empty() => String::new(),
            unit => format!(r#"<tspan class="unit">, {unit}</tspan>"#),
        };
        let mut out = format!(r#"<text x="{LEFT}" y="16" class="title">{title}{unit}</text>"#);
        if !self.positive.is_empty() {
            let x = self.right();
            let positive = escape(&self.positive);
            write!(
                out,
                r#"<text x="{x}" y="16" text-anchor="end">+ {positive}</text>"#
            )
            .expect("a String takes any text");
        }
        out
    }

    fn grid(&self, y: &Axis) -> String {
        let mut out = String::new();
        let (mut lines, mut zero) = (Path::default(), Path::default());
        for tick in y.ticks() {
            let height = self.to_y(y, tick);
            let is_zero = tick.abs() < y.step / 2.0;
            let line = if is_zero { &mut zero } else { &mut lines };
            line.open([(LEFT, height), (self.right(), height)]);
            let (x, base, label) = (LEFT - 7.0, height + 3.8, y.label(tick));
            out += &format!(r#"<text x="{x}" y="{base:.1}" text-anchor="end">{label}</text>"#);
        }
        if self.x_marks.is_empty() {
            out.extend(self.x.ticks().map(|tick| self.x_label(tick)));
        }
        out.extend(self.x_marks.iter().map(|mark| self.x_mark(mark)));
        out += &self.x_title();
        let (lines, zero) = (lines.data(), zero.data());
        format!(r#"<path class="grid" d="{lines}"/><path class="axis" d="{zero}"/>{out}"#)
    }

    fn x_label(&self, tick: f64) -> String {
        let (x, y) = (self.to_x(tick), self.bottom() + 17.0);
        let label = self.x.label(tick);
        let last = tick > self.x.high - self.x.step / 2.0;
        if !last || self.x_unit.is_empty() {
            return format!(r#"<text x="{x:.1}" y="{y}" text-anchor="middle">{label}</text>"#);
        }
        let (unit, end) = (escape(self.x_unit), self.right() + 8.0);
        format!(r#"<text x="{end:.1}" y="{y}" text-anchor="end">{label}&#160;{unit}</text>"#)
    }

    fn x_mark(&self, (at, text): &(f64, String)) -> String {
        let (x, y, text) = (self.to_x(*at), self.bottom() + 17.0, escape(text));
        format!(r#"<text x="{x:.1}" y="{y}" text-anchor="middle">{text}</text>"#)
    }

    fn x_title(&self) -> String {
        if self.x_title.is_empty() {
            return String::new();
        }
        let (x, y, title) = (
            (LEFT + self.right()) / 2.0,
            self.bottom() + 33.0,
            escape(&self.x_title),
        );
        format!(r#"<text x="{x:.1}" y="{y}" text-anchor="middle">{title}</text>"#)
    }

    fn line(&self, curve: &Curve, y: &Axis) -> String {
        let points = || {
            curve
                .points
                .iter()
                .map(|&(u, v)| (self.to_x(u), self.to_y(y, v)))
        };
        let mut path = Path::default();
        path.open(points());
        let mut out = format!(r#"<path class="{}" d="{}"/>"#, curve.class, path.data());
        if curve.dots {
            let seen = points().filter(|point| point.1.is_finite());
            out.extend(seen.map(|point| dot(point, curve.class)));
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
        let title = if self.x_title.is_empty() {
            0.0
        } else {
            X_TITLE
        };
        self.size.1 - BOTTOM - title
    }

    fn to_y(&self, axis: &Axis, value: f64) -> f64 {
        self.bottom() - axis.fraction(value) * (self.bottom() - TOP)
    }

    fn to_x(&self, value: f64) -> f64 {
        LEFT + self.x.fraction(value) * (self.right() - LEFT)
    }
}

fn dot((x, y): (f64, f64), class: &str) -> String {
    let class = match class {
        SPECIMEN => "dot specimen",
        _ => "dot",
    };
    format!(r#"<circle class="{class}" cx="{x:.1}" cy="{y:.1}" r="2.6"/>"#)
}
