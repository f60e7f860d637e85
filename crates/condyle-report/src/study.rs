//! Pictures of studies over many tests, and the page that shows them.

use std::path::{Path, PathBuf};

use crate::error::ReportError;
use crate::figure::{Axis, Curve, MEASURED, Panel, escape, finite_range, sheet, svg_file, titled};
use crate::number::{path_in_words, significant};
pub use crate::number::{title_of_path, with_powers};
use crate::sheets::{Sheets, filled, write_text};

const MAX_INTERVALS: usize = 6;

/// Writes `study.html` and every picture into `folder`, and returns the path of the page.
///
/// `tables`: headings and rows, of which the first is the head; paths of inputs in heads and first columns become words.
/// `pictures`: file names, captions and texts.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_study_page(
    folder: &Path,
    title: &str,
    lede: &str,
    tables: &[(String, Vec<Vec<String>>)],
    pictures: &[(String, String, String)],
) -> Result<PathBuf, ReportError> {
    for (name, _, svg) in pictures {
        write_text(folder.join(name), svg)?;
    }
    let mut tables = tables.to_vec();
    for (place, row) in tables
        .iter_mut()
        .flat_map(|(_, rows)| rows.iter_mut().enumerate())
    {
        let named = if place == 0 { row.len() } else { 1 };
        let cells = row.iter_mut().take(named);
        cells.for_each(|cell| *cell = path_in_words(cell));
        row.iter_mut().for_each(|cell| *cell = with_powers(cell));
    }
    let lede = &with_powers(lede);
    let sheets = Sheets {
        kicker: "condyle study",
        title,
        lede,
        tables: &tables,
        pictures,
        ..Sheets::default()
    };
    write_text(folder.join("study.html"), &filled(&sheets))
}

/// Size of a picture of bars, px: with space for the names on the left, the values on the right, and the heading.
const WIDTH: f64 = 760.0;
const LEFT: f64 = 270.0;
const RIGHT: f64 = 70.0;
const TOP: f64 = 44.0;
/// Distance between bars and their thickness, px.
const PITCH: f64 = 26.0;
const THICK: f64 = 14.0;

/// A horizontal bar: of a tornado, an index or a ranking.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// The label.
    pub name: String,
    /// Both ends.
    pub span: [f64; 2],
    /// An interval, drawn as a thin line over the bar.
    pub interval: Option<[f64; 2]>,
    /// True for a bar that may be chance.
    pub is_grey: bool,
}

/// Draws bars from the top as the text of an SVG file; `unit` may be empty, and `middle` is a vertical line for comparison.
pub fn bars_svg(title: &str, unit: &str, middle: Option<f64>, bars: &[Bar]) -> String {
    let ends = bars.iter().flat_map(|bar| {
        let interval = bar.interval.into_iter().flatten();
        bar.span.into_iter().chain(interval)
    });
    let (low, high) = finite_range(ends.chain(middle)).unwrap_or((0.0, 1.0));
    // Round-off of a constant result must not fill the axis.
    let min_span = 1e-9 * low.abs().max(high.abs()).max(1e-9);
    let axis = Axis::covering(low, high, min_span, MAX_INTERVALS);
    let to_x = |value: f64| LEFT + axis.fraction(value) * (WIDTH - LEFT - RIGHT);
    let bottom = TOP + PITCH * bars.len() as f64;
    let heading = titled(title, unit);
    let mut body = format!(r#"<text x="0" y="16" class="title">{heading}</text>"#);
    for tick in axis.ticks() {
        let (x, base, label) = (to_x(tick), bottom + 17.0, axis.label(tick));
        body += &format!(
            r#"<path class="grid" d="M{x:.1} {TOP}V{bottom}"/><text x="{x:.1}" y="{base}" text-anchor="middle">{label}</text>"#
        );
    }
    for (place, bar) in bars.iter().enumerate() {
        let y = TOP + PITCH * (place as f64 + 0.5);
        let [low, high] = bar.span;
        let (x, end) = (to_x(low.min(high)), to_x(low.max(high)));
        let (width, top, base) = ((end - x).max(1.0), y - THICK / 2.0, y + 3.8);
        let (name, name_x) = (escape(&path_in_words(&bar.name)), LEFT - 10.0);
        let class = if bar.is_grey { "bar grey" } else { "bar" };
        body += &format!(
            r#"<text x="{name_x}" y="{base:.1}" text-anchor="end">{name}</text><rect class="{class}" x="{x:.1}" y="{top:.1}" width="{width:.1}" height="{THICK}"/>"#
        );
        let mut label_at = end;
        if let Some(interval) = bar.interval {
            let [from, to] = interval.map(to_x);
            body += &format!(r#"<path class="mark" d="M{from:.1} {y:.1}H{to:.1}"/>"#);
            label_at = label_at.max(to);
        }
        let label = match bar.interval.filter(|_| bar.is_grey) {
            Some([_, most]) => format!("below {}", significant(most, 2)),
            None => significant(high - low, 3),
        };
        let label_x = label_at + 6.0;
        body += &format!(r#"<text x="{label_x:.1}" y="{base:.1}">{label}</text>"#);
    }
    if let Some(middle) = middle {
        let x = to_x(middle);
        body += &format!(r#"<path class="axis" d="M{x:.1} {TOP}V{bottom}"/>"#);
    }
    let described = bars.iter().map(|bar| {
        let [low, high] = bar.span.map(|end| significant(end, 4));
        format!("{}: {low} to {high}", path_in_words(&bar.name))
    });
    let described = described.collect::<Vec<_>>().join("; ");
    svg_file(title, &described, (WIDTH, bottom + 26.0), &body)
}

/// The distribution of an output.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// The output; its distributions for several designs have the same axis.
    pub output: &'static str,
    /// Its name, with that of the design.
    pub title: String,
    /// Its unit.
    pub unit: String,
    /// All values, smallest first.
    pub sorted: Vec<f64>,
    /// Marked percentiles.
    pub marks: Vec<f64>,
    /// Its limits.
    pub limits: Vec<f64>,
}

/// Returns the text of an SVG file with one panel per output.
pub fn distributions_svg(all: &[Distribution]) -> String {
    let panel = |one: &Distribution| {
        let own = all.iter().filter(|other| other.output == one.output);
        let ends = own.flat_map(|own| {
            let ends = [own.sorted.first(), own.sorted.last()];
            ends.into_iter().flatten().chain(&own.limits).copied()
        });
        histogram(one, finite_range(ends).unwrap_or((0.0, 1.0)))
    };
    let panels: Vec<Panel> = all.iter().map(panel).collect();
    let names: Vec<&str> = all.iter().map(|one| one.title.as_str()).collect();
    let desc = format!("Distributions of {} over the tests.", names.join(", "));
    let has_limits = all.iter().any(|one| !one.limits.is_empty());
    let key = [
        ("last", "tests"),
        (MEASURED, "5, 50 and 95 %"),
        ("first", "limit"),
    ];
    let shown = if has_limits { 3 } else { 2 };
    sheet("Distributions", &desc, &panels, 2, &key[..shown])
}

fn histogram(one: &Distribution, (low, high): (f64, f64)) -> Panel {
    let outline = outline(&one.sorted);
    let highest = outline.iter().map(|point| point.1).fold(0.0, f64::max);
    let upright = |class, at: &f64| Curve::new(class, vec![(*at, 0.0), (*at, highest)]);
    let mut curves: Vec<Curve> = one.limits.iter().map(|at| upright("first", at)).collect();
    curves.extend(one.marks.iter().map(|at| upright(MEASURED, at)));
    curves.push(Curve::new("last", outline));
    Panel {
        title: match one.unit.as_str() {
            "" => one.title.clone(),
            unit => format!("{}, {unit}", one.title),
        },
        unit: "% of tests".to_owned(),
        x: Axis::covering(low, high, 1e-9 * high.abs().max(1e-9), MAX_INTERVALS),
        size: (480.0, 232.0),
        from_zero: true,
        min_span: 1e-6,
        curves,
        ..Panel::default()
    }
}

/// Returns the outline of a histogram, % of the values in each slice; the number of slices is the root of the number
/// of values.
fn outline(sorted: &[f64]) -> Vec<(f64, f64)> {
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else {
        return Vec::new();
    };
    // With more slices than this the picture shows noise.
    const MAX_SLICES: usize = 60;
    let slices = ((sorted.len() as f64).sqrt().ceil() as usize).clamp(1, MAX_SLICES);
    // Equal values would give slices without a width.
    let width = ((high - low) / slices as f64).max(1e-12 * high.abs().max(1e-300));
    let mut counts = vec![0.0; slices];
    for value in sorted {
        let slice = ((value - low) / width) as usize;
        counts[slice.min(slices - 1)] += 100.0 / sorted.len() as f64;
    }
    let mut points = vec![(*low, 0.0)];
    for (slice, count) in counts.into_iter().enumerate() {
        let left = low + slice as f64 * width;
        points.extend([(left, count), (left + width, count)]);
    }
    points.push((low + slices as f64 * width, 0.0));
    points
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
            is_grey: high < 2.5,
        };
        let bars = [bar("friction <a>", 3.0), bar("load", 2.0)];
        let svg = bars_svg("Mass & more", "mg", Some(1.0), &bars);
        assert_eq!(svg.matches("<rect class=\"bar\"").count(), 1);
        assert_eq!(svg.matches("<rect class=\"bar grey\"").count(), 1);
        // A bar that may be chance states the end of its interval.
        assert!(
            svg.contains(">2.00<") && svg.contains(">below 2.1<"),
            "{svg}"
        );
        assert!(svg.contains("friction &lt;a&gt;") && svg.contains("Mass &amp; more"));
        assert!(roxmltree::Document::parse(&svg).is_ok());
    }

    #[test]
    fn verify_all_tests_are_in_the_outline() {
        let sorted: Vec<f64> = (0..100).map(f64::from).collect();
        let outline = outline(&sorted);
        let sum: f64 = outline[1..outline.len() - 1]
            .iter()
            .step_by(2)
            .map(|point| point.1)
            .sum();
        assert!((sum - 100.0).abs() < 1e-9);
    }

    #[test]
    fn distributions_of_one_output_have_the_same_axis() {
        let of = |output, sorted| Distribution {
            output,
            title: "a".to_owned(),
            unit: String::new(),
            sorted,
            marks: Vec::new(),
            limits: Vec::new(),
        };
        let svg = distributions_svg(&[
            of("a", vec![1.0, 2.0]),
            of("a", vec![71.0, 72.0]),
            of("b", vec![1.0, 2.0]),
        ]);
        assert_eq!(svg.matches(">60<").count(), 2);
    }

    #[test]
    fn one_value_alone_and_none_are_drawn() {
        let of = |sorted| Distribution {
            output: "a",
            title: "a".to_owned(),
            unit: String::new(),
            sorted,
            marks: Vec::new(),
            limits: vec![2.0],
        };
        let svg = distributions_svg(&[of(vec![1.0, 1.0]), of(Vec::new())]);
        assert!(roxmltree::Document::parse(&svg).is_ok() && !svg.contains("NaN"));
    }
}
