//! SVG path data, rounded to a tenth of a unit and written as differences, which keeps files small.

/// Path data under construction; coordinates are those of the picture.
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
