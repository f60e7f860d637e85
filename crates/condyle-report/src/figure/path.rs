//! SVG path data, rounded to a tenth of a unit and written as differences, to keep it short.

use std::fmt::Write as _;

/// Path data under construction; coordinates are those of the picture.
#[derive(Default)]
pub(crate) struct Path {
    data: String,
    pen: (i64, i64),
}

impl Path {
    /// Starts a new line at a point.
    pub(crate) fn start(&mut self, (x, y): (f64, f64)) {
        self.step('m', x, y, true);
    }

    /// Draws a line to a point; a point that rounds to where the pen is adds nothing.
    pub(crate) fn line(&mut self, (x, y): (f64, f64)) {
        self.step('l', x, y, false);
    }

    /// Closes the line.
    pub(crate) fn close(&mut self, (x, y): (f64, f64)) {
        self.data.push('z');
        self.pen = (tenths(x), tenths(y));
    }

    /// Adds a closed loop.
    pub(crate) fn closed(&mut self, points: &[(f64, f64)]) {
        let Some((&first, rest)) = points.split_first() else {
            return;
        };
        self.start(first);
        for &point in rest {
            self.line(point);
        }
        self.close(first);
    }

    /// Adds an open line; it is broken where a coordinate is not a number.
    pub(crate) fn open(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        let mut down = false;
        for (x, y) in points {
            let drawable = x.is_finite() && y.is_finite();
            match (drawable, down) {
                (true, true) => self.line((x, y)),
                (true, false) => self.start((x, y)),
                (false, _) => {}
            }
            down = drawable;
        }
    }

    /// The value of the attribute `d`.
    pub(crate) fn data(self) -> String {
        self.data
    }

    fn step(&mut self, command: char, x: f64, y: f64, always: bool) {
        let to = (tenths(x), tenths(y));
        let (dx, dy) = (to.0 - self.pen.0, to.1 - self.pen.1);
        if !always && dx == 0 && dy == 0 {
            return;
        }
        self.data.push(command);
        push_tenths(&mut self.data, dx);
        if dy >= 0 {
            self.data.push(' ');
        }
        push_tenths(&mut self.data, dy);
        self.pen = to;
    }
}

fn tenths(value: f64) -> i64 {
    (value * 10.0).round() as i64
}

fn push_tenths(out: &mut String, tenths: i64) {
    if tenths < 0 {
        out.push('-');
    }
    let (whole, tenth) = (tenths.abs() / 10, tenths.abs() % 10);
    if whole != 0 || tenth == 0 {
        write!(out, "{whole}").expect("a String takes any text");
    }
    if tenth != 0 {
        write!(out, ".{tenth}").expect("a String takes any text");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
