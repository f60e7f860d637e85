//! The end of the polyethylene in a tibial construct: an insert whose file includes its tray and stem.

use condyle_mesh::TriangleMesh;

use super::landmarks::Dishes;
use crate::Vec3;

/// Distance between the vertical lines that sample a body, mm.
const LINES_EVERY_MM: f64 = 0.5;
const SECTIONS_EVERY_MM: f64 = 0.25;
/// A body that reaches no farther below its dishes counts as an insert, mm: the shape does not distinguish a thin
/// insert on a thin tray from a thick insert.
const INSERT_MM: f64 = 12.0;
/// Largest thickness of an insert below its dishes, mm.
const MAX_MM: f64 = 25.0;
/// Smallest thickness of an insert below its dishes, mm.
const MIN_MM: f64 = 3.0;
/// Largest section of a stem, a keel or pegs as a share of the section of the plate above.
const STEM_SHARE: f64 = 0.5;
/// Smallest length of a stem, a keel or a peg below a plate, mm, ...
const MIN_STEM_MM: f64 = 5.0;
/// ... and largest length of a peg of the insert itself, where no ledge shows a plate, mm.
const MAX_PEG_MM: f64 = 10.0;
/// Smallest relative change of the area of a section at a ledge: a third of a millimetre all around
/// the insert of a knee.
const LEDGE_SHARE: f64 = 0.02;
/// Largest height of a ledge, mm; a higher one is a bevel.
const LEDGE_MM: f64 = 0.02;
/// Distance within which a ledge takes the height of a vertex, mm.
const VERTEX_MM: f64 = 0.03;

/// The end of the polyethylene in a body with two dishes, as far as its shape shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Underside {
    /// The body is an insert alone.
    Whole,
    /// The insert stands on a larger plate: one ledge between the dishes and the plate's underside faces up.
    Ledge {
        /// Height of the ledge along y, mm.
        height_mm: f64,
        /// Polyethylene between it and the lowest place of the dishes, mm.
        below_dishes_mm: f64,
        /// Extent of the body below its dishes, mm.
        reach_mm: f64,
    },
    /// The body reaches farther down than an insert, and does not show the end of the polyethylene.
    Unclear {
        /// Extent of the body below its dishes, mm.
        reach_mm: f64,
        /// Height of the underside of the plate, or of the body if it has no stem, mm.
        plate_mm: f64,
        /// Heights of the ledges between it and the dishes, mm; none or several of them face up.
        ledges_mm: Vec<f64>,
    },
}

impl Underside {
    /// Finds the end in a closed body with its articulating surface above, x anterior, y superior, z right, mm.
    ///
    /// A body that reaches more than 12 mm below its dishes is examined in horizontal sections. It is a construct if
    /// it has a stem, a keel or pegs of 5 mm with less than half of its area (10 mm, where no ledge shows a plate), or if it
    /// reaches 25 mm below the dishes. The polyethylene ends at the height, at least 3 mm below the dishes, below which the
    /// area within the outline of the section jumps up, on a larger plate. A jump down is not the end: the
    /// insert may overhang its plate, or be cut out for its rim.
    pub fn find(body: &TriangleMesh) -> Self {
        let (low, _) = body.bounds();
        let dishes = Dishes::find(&body.seen_from_above(LINES_EVERY_MM));
        let Some(dish_mm) = dishes.map(|dishes| dishes.middle_mm().y) else {
            return Self::Whole;
        };
        let reach_mm = dish_mm - low.y;
        if reach_mm <= INSERT_MM {
            return Self::Whole;
        }
        let profile = Profile::new(body, dish_mm);
        let plate_mm = profile.plate_mm(low.y);
        let stem_mm = plate_mm - low.y;
        let is_whole_below = |max_stem_mm| stem_mm < max_stem_mm && reach_mm < MAX_MM;
        if is_whole_below(MIN_STEM_MM) {
            return Self::Whole;
        }
        let ledges = profile.ledges(plate_mm);
        let mut on_plate = ledges.iter().filter(|ledge| ledge.faces_up);
        match (on_plate.next(), on_plate.next()) {
            (Some(ledge), None) => Self::Ledge {
                height_mm: ledge.height_mm,
                below_dishes_mm: dish_mm - ledge.height_mm,
                reach_mm,
            },
            _ if is_whole_below(MAX_PEG_MM) => Self::Whole,
            _ => Self::Unclear {
                reach_mm,
                plate_mm,
                ledges_mm: ledges.iter().map(|ledge| ledge.height_mm).collect(),
            },
        }
    }
}

/// A flat step around a body.
struct Ledge {
    height_mm: f64,
    /// True if the section is larger below it.
    faces_up: bool,
}

/// The areas of the horizontal sections of a body below its dishes.
struct Profile<'a> {
    body: &'a TriangleMesh,
    sections: Sections,
    dish_mm: f64,
    /// Area just below the dishes, mm2.
    whole_mm2: f64,
}

impl<'a> Profile<'a> {
    fn new(body: &'a TriangleMesh, dish_mm: f64) -> Self {
        let sections = Sections::new(body, LINES_EVERY_MM);
        Self {
            body,
            whole_mm2: sections.area_mm2(dish_mm - SECTIONS_EVERY_MM),
            sections,
            dish_mm,
        }
    }

    fn heights(&self, lowest_mm: f64) -> impl Iterator<Item = f64> + use<> {
        let dish_mm = self.dish_mm;
        // Counted from the dishes, so that the heights do not depend on the place of the body.
        let count = ((dish_mm - lowest_mm) / SECTIONS_EVERY_MM) as usize;
        (1..=count).map(move |n| dish_mm - n as f64 * SECTIONS_EVERY_MM)
    }

    /// Returns the height at which most of the body ends; its lowest point if there is no stem.
    fn plate_mm(&self, lowest_mm: f64) -> f64 {
        let is_stem = |y: &f64| self.sections.area_mm2(*y) < STEM_SHARE * self.whole_mm2;
        let below = self.heights(lowest_mm).find(is_stem);
        below.map_or(lowest_mm, |below| {
            self.at_vertex(self.jump(below, below + SECTIONS_EVERY_MM))
        })
    }

    /// Returns the ledges between the thinnest insert and the plate's underside, downwards.
    fn ledges(&self, plate_mm: f64) -> Vec<Ledge> {
        let heights: Vec<f64> = self.heights(plate_mm + SECTIONS_EVERY_MM).collect();
        let between = heights.windows(2).map(|pair| (pair[1], pair[0]));
        let mut ledges: Vec<Ledge> = Vec::new();
        for (below, above) in between.filter(|(below, _)| self.dish_mm - below >= MIN_MM) {
            let ledge = self.ledge(below, above);
            let known = |ledge: &Ledge| {
                let is_one =
                    |other: &Ledge| (other.height_mm - ledge.height_mm).abs() < 2.0 * VERTEX_MM;
                ledges.iter().any(is_one)
            };
            let new = ledge.filter(|ledge| !known(ledge));
            ledges.extend(new);
        }
        ledges
    }

    /// Returns the ledge between two heights, if the area changes by enough within the height of a ledge.
    fn ledge(&self, low_mm: f64, high_mm: f64) -> Option<Ledge> {
        let is_ledge = |grown: f64| grown.abs() > LEDGE_SHARE * self.whole_mm2;
        if !is_ledge(self.grown_mm2(low_mm, high_mm)) {
            return None;
        }
        let height_mm = self.at_vertex(self.jump(low_mm, high_mm));
        let grown = self.grown_mm2(height_mm - LEDGE_MM, height_mm + LEDGE_MM);
        is_ledge(grown).then_some(Ledge {
            height_mm,
            faces_up: grown > 0.0,
        })
    }

    /// Returns the area of the lower one of two sections less that of the upper one, mm2.
    fn grown_mm2(&self, low_mm: f64, high_mm: f64) -> f64 {
        self.sections.area_mm2(low_mm) - self.sections.area_mm2(high_mm)
    }

    /// Returns the height between two at which the area changes most, by bisection.
    fn jump(&self, low_mm: f64, high_mm: f64) -> f64 {
        let (mut low, mut high) = (low_mm, high_mm);
        // A quarter, so that the sections a ledge above and below lie on both sides of the jump.
        while high - low > LEDGE_MM / 4.0 {
            let middle = (low + high) / 2.0;
            let [below, at, above] = [low, middle, high].map(|y| self.sections.area_mm2(y));
            if (at - below).abs() > (above - at).abs() {
                high = middle;
            } else {
                low = middle;
            }
        }
        (low + high) / 2.0
    }

    /// Returns the height of the nearest vertex, or the given height if none is near.
    fn at_vertex(&self, y: f64) -> f64 {
        let heights = self.body.vertices.iter().map(|vertex| vertex.y);
        let nearest = heights.min_by(|a, b| (a - y).abs().total_cmp(&(b - y).abs()));
        nearest
            .filter(|vertex| (vertex - y).abs() < VERTEX_MM)
            .unwrap_or(y)
    }
}

/// Offsets of the lines from round numbers, where edges of triangles often are, relative to their
/// distance; different, so that the lines are not on diagonals either.
const OFFSET: (f64, f64) = (0.137, 0.291);
/// Largest distance of two passes of one line through the common edge of two triangles, mm.
const ONE_PASS_MM: f64 = 1e-6;

/// A closed body by the heights at which the vertical lines of a square grid pass its surface.
struct Sections {
    step_mm: f64,
    rows: usize,
    columns: usize,
    /// Heights of every line, the highest first, with 1 where it enters from above and -1 where it leaves.
    passes: Vec<Vec<(f64, i32)>>,
}

impl Sections {
    /// Creates the sections of a body with lines `step_mm` apart, and a rim of lines outside it.
    fn new(body: &TriangleMesh, step_mm: f64) -> Self {
        let (low, high) = body.bounds();
        let count = |length: f64| (length / step_mm) as usize + 3;
        let (rows, columns) = (count(high.x - low.x), count(high.z - low.z));
        let mut sections = Self {
            step_mm,
            rows,
            columns,
            passes: vec![Vec::new(); rows * columns],
        };
        let origin = Vec3::new(low.x - OFFSET.0 * step_mm, 0.0, low.z - OFFSET.1 * step_mm);
        for triangle in 0..body.triangles.len() {
            sections.add(&body.corners(triangle).map(|corner| corner - origin));
        }
        for passes in &mut sections.passes {
            passes.sort_by(|a, b| b.0.total_cmp(&a.0));
            passes.dedup_by(|a, b| a.1 == b.1 && (a.0 - b.0).abs() < ONE_PASS_MM);
        }
        sections
    }

    fn add(&mut self, corners: &[Vec3; 3]) {
        let [a, b, c] = corners;
        let (least, most) = (
            a.inf(b).inf(c) / self.step_mm,
            a.sup(b).sup(c) / self.step_mm,
        );
        let lines = |from: f64, to: f64, count: usize| {
            from.ceil().max(0.0) as usize
                ..(to.floor().max(-1.0) + 1.0).min(count as f64 - 1.0) as usize
        };
        for row in lines(least.x, most.x, self.rows) {
            for column in lines(least.z, most.z, self.columns) {
                let place = (row as f64 * self.step_mm, column as f64 * self.step_mm);
                if let Some(pass) = pass(corners, place) {
                    self.passes[(row + 1) * self.columns + column + 1].push(pass);
                }
            }
        }
    }

    /// Returns the area within the outline of the section at a height, mm2, hollows included.
    fn area_mm2(&self, y: f64) -> f64 {
        let is_inside = |line: usize| {
            let above = self.passes[line].iter().take_while(|pass| pass.0 > y);
            above.map(|pass| pass.1).sum::<i32>() > 0
        };
        // Flood from the rim: hollows that it does not reach count as inside.
        let mut is_outside = vec![false; self.passes.len()];
        let mut open = vec![0];
        let mut outside = 0;
        while let Some(line) = open.pop() {
            if !is_outside[line] && !is_inside(line) {
                is_outside[line] = true;
                outside += 1;
                let (row, column) = (line / self.columns, line % self.columns);
                let before = [
                    (row > 0).then(|| line - self.columns),
                    (column > 0).then(|| line - 1),
                ];
                let after = [
                    (row + 1 < self.rows).then_some(line + self.columns),
                    (column + 1 < self.columns).then_some(line + 1),
                ];
                open.extend(before.into_iter().chain(after).flatten());
            }
        }
        (self.passes.len() - outside) as f64 * self.step_mm * self.step_mm
    }
}

/// Returns the height at which the vertical line at (x, z) passes a triangle, and 1 if it enters from above.
fn pass([a, b, c]: &[Vec3; 3], (x, z): (f64, f64)) -> Option<(f64, i32)> {
    let twice_area = |p: &Vec3, q: &Vec3| (p.z - z) * (q.x - x) - (p.x - x) * (q.z - z);
    let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
    let whole: f64 = weights.iter().sum();
    let covers = whole != 0.0 && weights.iter().all(|weight| weight * whole >= 0.0);
    let height = (weights[0] * a.y + weights[1] * b.y + weights[2] * c.y) / whole;
    covers.then_some((height, if whole > 0.0 { 1 } else { -1 }))
}

#[cfg(test)]
mod tests;
