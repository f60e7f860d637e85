//! SVG files: their style, escaping, path data, and parts that several pictures share.

/// The style of all pictures; its colours are variables of the page.
pub(crate) const STYLE: &str = include_str!("figure.css");

/// Name, colour on white, colour on black.
const COLOURS: [(&str, &str, &str); 8] = [
    ("paper", "#ffffff", "#14171a"),
    ("panel", "#f6f7f8", "#1c2024"),
    ("ink", "#16191d", "#e9ecef"),
    ("soft", "#5d666f", "#a3adb6"),
    ("rule", "#d8dde2", "#343b42"),
    ("grid", "#e7eaed", "#2a3036"),
    ("last", "#0b4f7d", "#7cc4f5"),
    ("first", "#f3b562", "#a8701f"),
];

const MARGIN: f64 = 16.0;

/// Declarations of the colours as CSS variables: (on white, on black).
pub(crate) fn colour_variables() -> (String, String) {
    let light = COLOURS.map(|(name, light, _)| format!("--{name}:{light};"));
    let dark = COLOURS.map(|(name, _, dark)| format!("--{name}:{dark};"));
    (light.concat(), dark.concat())
}

/// Returns an SVG file of a drawing of `size` (width, height) px, on white.
pub(crate) fn svg_file(title: &str, desc: &str, size: (f64, f64), body: &str) -> String {
    let (width, height) = (size.0 + 2.0 * MARGIN, size.1 + 2.0 * MARGIN);
    // On a page, texts of all pictures have about the same size.
    let (title, desc, widest) = (escape(title), escape(desc), 1.25 * width);
    // The colours of white paper are filled in: readers of SVG files have no CSS variables.
    let fill = |css: String, (name, light, _): (&str, &str, &str)| {
        css.replace(&format!("var(--{name})"), light)
    };
    let style = COLOURS.into_iter().fold(STYLE.to_owned(), fill);
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" class="fig" role="img" aria-labelledby="t d" viewBox="0 0 {width} {height}" width="{width}" height="{height}" style="max-width:{widest:.0}px"><title id="t">{title}</title><desc id="d">{desc}</desc><style>{style}</style><rect width="{width}" height="{height}" fill="#fff"/><g transform="translate({MARGIN} {MARGIN})">{body}</g></svg>
"##
    )
}

pub(crate) fn escape(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

pub(crate) fn titled(title: &str, unit: &str) -> String {
    let title = escape(title);
    if unit.is_empty() {
        return title;
    }
    format!(r#"{title}<tspan class="unit">, {}</tspan>"#, escape(unit))
}

/// Returns a bar of 10 mm that ends at `(end, y)`, with its length below.
pub(crate) fn scale_bar((end, y): (f64, f64), px_per_mm: f64) -> String {
    const LENGTH_MM: f64 = 10.0;
    let start = end - LENGTH_MM * px_per_mm;
    let (tick, middle, below) = (y - 3.5, f64::midpoint(start, end), y + 14.0);
    format!(
        r#"<path class="leader" d="M{start:.1} {tick:.1}v7M{start:.1} {y:.1}H{end:.1}M{end:.1} {tick:.1}v7"/><text x="{middle:.1}" y="{below:.1}" text-anchor="middle">{LENGTH_MM} mm</text>"#
    )
}

/// Path data under construction, in coordinates of the picture: rounded to a tenth of a unit and written as differences,
/// which keeps files small.
#[derive(Default)]
pub(crate) struct Path {
    data: String,
    pen: (i64, i64),
}

impl Path {
    pub(crate) fn closed(&mut self, points: &[(f64, f64)]) {
        let Some((&first, rest)) = points.split_first() else {
            return;
        };
        self.step('m', first);
        for &point in rest {
            self.step('l', point);
        }
        self.data.push('z');
        // Closing takes the pen back to the start.
        self.pen = tenths(first);
    }

    /// Adds an open line; it is broken where a coordinate is not a number.
    pub(crate) fn open(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        let mut is_down = false;
        for (x, y) in points {
            let is_drawn = x.is_finite() && y.is_finite();
            if is_drawn {
                self.step(if is_down { 'l' } else { 'm' }, (x, y));
            }
            is_down = is_drawn;
        }
    }

    pub(crate) fn data(self) -> String {
        self.data
    }

    /// Moves the pen or draws a line; a line to where the pen already is adds nothing.
    fn step(&mut self, command: char, to: (f64, f64)) {
        let to = tenths(to);
        let (dx, dy) = (to.0 - self.pen.0, to.1 - self.pen.1);
        if command == 'l' && dx == 0 && dy == 0 {
            return;
        }
        self.data.push(command);
        push_tenths(&mut self.data, dx);
        // A minus separates the numbers by itself.
        if dy >= 0 {
            self.data.push(' ');
        }
        push_tenths(&mut self.data, dy);
        self.pen = to;
    }
}

fn tenths((x, y): (f64, f64)) -> (i64, i64) {
    ((x * 10.0).round() as i64, (y * 10.0).round() as i64)
}

fn push_tenths(out: &mut String, tenths: i64) {
    if tenths < 0 {
        out.push('-');
    }
    let (whole, tenth) = (tenths.abs() / 10, tenths.abs() % 10);
    if whole != 0 || tenth == 0 {
        *out += &whole.to_string();
    }
    if tenth != 0 {
        *out += &format!(".{tenth}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_on_white_need_no_variables() {
        assert!(!svg_file("a", "b", (1.0, 1.0), "").contains("var("));
    }

    #[test]
    fn paths_are_short_and_exact_to_a_tenth() {
        let mut path = Path::default();
        path.closed(&[(1.0, 2.0), (1.04, 2.0), (1.5, 1.7), (-0.26, 3.0)]);
        assert_eq!(path.data(), "m1 2l.5-.3l-1.8 1.3z");
    }

    #[test]
    fn a_missing_value_breaks_the_line() {
        let mut path = Path::default();
        path.open([
            (0.0, 0.0),
            (1.0, 1.0),
            (2.0, f64::NAN),
            (3.0, 1.0),
            (4.0, 1.0),
        ]);
        assert_eq!(path.data(), "m0 0l1 1m2 0l1 0");
    }
}
