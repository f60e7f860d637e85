//! Horizontal bars: tornado, indices, ranking.

use crate::figure::{Axis, escape, svg_file, titled};
use crate::number::significant;

const WIDTH: f64 = 760.0;
/// Room for the names, to the left of the bars.
const LEFT: f64 = 270.0;
const RIGHT: f64 = 70.0;
const TOP: f64 = 44.0;
/// Distance of the bars, px.
const PITCH: f64 = 26.0;
const THICK: f64 = 14.0;
const MAX_INTERVALS: usize = 6;

/// One bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// The label.
    pub name: String,
    /// Both ends.
    pub span: [f64; 2],
    /// An interval, drawn as a thin line over the bar.
    pub interval: Option<[f64; 2]>,
}

/// A picture of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// The heading.
    pub title: String,
    /// Unit of the values; may be empty.
    pub unit: String,
    /// A vertical line for comparison.
    pub middle: Option<f64>,
    /// The bars from the top.
    pub bars: Vec<Bar>,
}

/// Returns the text of an SVG file.
pub fn bars_svg(bars: &Bars) -> String {
    let axis = axis(bars);
    let bottom = TOP + PITCH * bars.bars.len() as f64;
    let title = titled(&bars.title, &bars.unit);
    let mut body = format!(r#"<text x="0" y="16" class="title">{title}</text>"#);
    for tick in axis.ticks() {
        let (x, label) = (to_x(&axis, tick), axis.label(tick));
        body += &format!(
            r#"<path class="grid" d="M{x:.1} {TOP}V{bottom}"/><text x="{x:.1}" y="{}" text-anchor="middle">{label}</text>"#,
            bottom + 17.0
        );
    }
    for (place, bar) in bars.bars.iter().enumerate() {
        body += &one(&axis, bar, TOP + PITCH * (place as f64 + 0.5));
    }
    if let Some(middle) = bars.middle {
        let x = to_x(&axis, middle);
        body += &format!(r#"<path class="axis" d="M{x:.1} {TOP}V{bottom}"/>"#);
    }
    let described = bars.bars.iter().map(|bar| {
        let [low, high] = bar.span.map(|end| significant(end, 4));
        format!("{}: {low} to {high}", bar.name)
    });
    let described = described.collect::<Vec<_>>().join("; ");
    svg_file(&bars.title, &described, (WIDTH, bottom + 26.0), &body)
}

fn axis(bars: &Bars) -> Axis {
    let ends = bars.bars.iter().flat_map(|bar| {
        bar.span
            .into_iter()
            .chain(bar.interval.into_iter().flatten())
    });
    let all: Vec<f64> = ends
        .chain(bars.middle)
        .filter(|end| end.is_finite())
        .collect();
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low > high {
        return Axis::covering(0.0, 1.0, 0.0, MAX_INTERVALS);
    }
    let least = 1e-9 * low.abs().max(high.abs()).max(1e-9);
    Axis::covering(low, high, least, MAX_INTERVALS)
}

fn to_x(axis: &Axis, value: f64) -> f64 {
    LEFT + axis.fraction(value) * (WIDTH - LEFT - RIGHT)
}

fn one(axis: &Axis, bar: &Bar, y: f64) -> String {
    let [low, high] = bar.span;
    let (x, end) = (to_x(axis, low.min(high)), to_x(axis, low.max(high)));
    let (width, top, base) = ((end - x).max(1.0), y - THICK / 2.0, y + 3.8);
    let (name, name_x) = (escape(&bar.name), LEFT - 10.0);
    let mut out = format!(
        r#"<text x="{name_x}" y="{base:.1}" text-anchor="end">{name}</text><rect class="bar" x="{x:.1}" y="{top:.1}" width="{width:.1}" height="{THICK}"/>"#
    );
    let mut label_at = end;
    if let Some(interval) = bar.interval {
        let [from, to] = interval.map(|end| to_x(axis, end));
        out += &format!(r#"<path class="mark" d="M{from:.1} {y:.1}H{to:.1}"/>"#);
        label_at = label_at.max(to);
    }
    let (label, label_x) = (significant(high - low, 3), label_at + 6.0);
    out + &format!(r#"<text x="{label_x:.1}" y="{base:.1}">{label}</text>"#)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bar_has_its_name_and_text_is_escaped() {
        let bar = |name: &str, high| Bar {
            name: name.to_owned(),
            span: [1.0, high],
            interval: Some([high - 0.1, high + 0.1]),
        };
        let svg = bars_svg(&Bars {
            title: "Mass & more".to_owned(),
            unit: "mg".to_owned(),
            middle: Some(1.0),
            bars: vec![bar("friction <a>", 3.0), bar("load", 2.0)],
        });
        assert_eq!(svg.matches("<rect class=\"bar\"").count(), 2);
        assert!(svg.contains("friction &lt;a&gt;") && svg.contains("Mass &amp; more"));
        assert!(roxmltree::Document::parse(&svg).is_ok());
    }
}
