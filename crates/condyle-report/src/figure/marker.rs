//! Rings at the largest values of a map, with leaders to texts that do not overlap.

/// Baseline of the texts below the surface, px.
const TEXT_BELOW: f64 = 50.0;
/// Leaders leave the vertical only below the surface, px: on it leaders of different rings stay apart.
const ELBOW_BELOW: f64 = 6.0;
/// Distance of a leader's end above the baseline, px.
const ABOVE_TEXT: f64 = 13.0;
/// Distance of a leader's end inside the text, px, which shows whose it is.
const INSIDE_TEXT: f64 = 24.0;
const RING: f64 = 4.5;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Marker {
    ring: (f64, f64),
    text_x: f64,
    /// Lines of the text, which are safe SVG.
    lines: [String; 2],
    /// The horizontal end of the leader, and the heights of its elbow and end.
    leader_x: f64,
    elbow_y: f64,
    end_y: f64,
}

/// The row of texts below a map, px.
#[derive(Clone, Copy)]
pub(super) struct TextRow {
    /// Half the width of the longest text.
    pub(super) half_width: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl TextRow {
    /// Markers from left to right, with their texts below their rings where there is room.
    pub(super) fn markers(self, rings: Vec<((f64, f64), [String; 2])>) -> Vec<Marker> {
        let mut middles: Vec<f64> = rings.iter().map(|((x, _), _)| self.inside(*x)).collect();
        if let [left, right] = middles.as_mut_slice() {
            // Two texts move apart by equal distances, or away from the end of the picture.
            let missing = (2.0 * self.half_width - (*right - *left)).max(0.0);
            *left = self.inside(*left - missing / 2.0);
            *right = right.max(*left + 2.0 * self.half_width);
            let over = (*right - self.right.max(3.0 * self.half_width)).max(0.0);
            (*left, *right) = (self.inside(*left - over), *right - over);
        }
        let reach = self.half_width - INSIDE_TEXT;
        let marker = |((ring, lines), text_x): (((f64, f64), [String; 2]), f64)| Marker {
            ring,
            text_x,
            lines,
            // Straight below the ring where its text reaches there, else at the nearer end of the text.
            leader_x: ring.0.clamp(text_x - reach, text_x + reach),
            elbow_y: self.bottom + ELBOW_BELOW,
            end_y: self.bottom + TEXT_BELOW - ABOVE_TEXT,
        };
        rings.into_iter().zip(middles).map(marker).collect()
    }

    /// Limits the place of a text so that it stays inside the picture, even if its ring is at the rim.
    fn inside(self, x: f64) -> f64 {
        x.clamp(self.half_width, self.right.max(self.half_width))
    }
}

impl Marker {
    pub(super) fn svg(&self) -> String {
        let ((x, y), [first, second]) = (self.ring, &self.lines);
        let (text_x, text_y) = (self.text_x, self.end_y + ABOVE_TEXT);
        let (from_y, elbow_y) = (y + RING, self.elbow_y);
        let (end_x, end_y) = (self.leader_x, self.end_y);
        let leader = format!("M{x:.1} {from_y:.1}V{elbow_y:.1}L{end_x:.1} {end_y:.1}");
        format!(
            r#"<circle class="halo" cx="{x:.1}" cy="{y:.1}" r="{RING}"/><path class="halo" d="{leader}"/><circle class="mark" cx="{x:.1}" cy="{y:.1}" r="{RING}"/><path class="leader" d="{leader}"/><text x="{text_x:.1}" y="{text_y:.1}" text-anchor="middle">{first}<tspan x="{text_x:.1}" dy="1.35em">{second}</tspan></text>"#
        )
    }

    /// Returns the horizontal position of the leader at a height of the picture, px.
    pub(super) fn leader_at(&self, y: f64) -> f64 {
        let part = (y - self.elbow_y) / (self.end_y - self.elbow_y);
        self.ring.0 + part.clamp(0.0, 1.0) * (self.leader_x - self.ring.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: TextRow = TextRow {
        half_width: 80.0,
        right: 420.0,
        bottom: 300.0,
    };

    fn markers(rings: &[(f64, f64)]) -> Vec<Marker> {
        let lines = || [String::new(), String::new()];
        ROW.markers(rings.iter().map(|&ring| (ring, lines())).collect())
    }

    #[test]
    fn texts_stand_below_rings_that_are_far_apart() {
        let texts = markers(&[(120.0, 50.0), (330.0, 90.0)])
            .into_iter()
            .map(|marker| marker.text_x);
        assert_eq!(texts.collect::<Vec<_>>(), [120.0, 330.0]);
        assert_eq!(markers(&[(10.0, 50.0)])[0].text_x, 80.0);
    }

    #[test]
    fn neither_texts_nor_leaders_meet_wherever_the_rings_are() {
        for left in (0..=42).map(|step| 10.0 * f64::from(step)) {
            for right in (0..=42).map(|step| 10.0 * f64::from(step) + 1.0) {
                if right < left {
                    continue;
                }
                let [a, b] = markers(&[(left, 40.0), (right, 200.0)])
                    .try_into()
                    .expect("two");
                assert!(
                    b.text_x - a.text_x >= 2.0 * ROW.half_width - 1e-9,
                    "{left} {right}"
                );
                assert!(
                    a.text_x >= ROW.half_width && b.text_x <= ROW.right + 1e-9,
                    "{left} {right}"
                );
                let apart = (200..=337)
                    .map(f64::from)
                    .all(|y| a.leader_at(y) < b.leader_at(y));
                assert!(apart, "{left} {right}");
            }
        }
    }
}
