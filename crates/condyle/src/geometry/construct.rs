//! Where the polyethylene of a tibial construct ends: an insert whose file holds its tray and stem too.

mod sections;

use self::sections::Sections;
use condyle_mesh::TriangleMesh;

use super::dishes::Dishes;

/// Distance between the vertical lines that sample a body, mm.
const LINES_EVERY_MM: f64 = 0.5;
/// Distance between its sections, mm.
const SECTIONS_EVERY_MM: f64 = 0.25;
/// A body that reaches no farther below its dishes is taken as it is, mm: a thin insert on a thin tray, or a thick
/// insert, which its shape does not tell apart.
const INSERT_MM: f64 = 12.0;
/// No insert is thicker below its dishes, mm.
const MAX_MM: f64 = 25.0;
/// No insert is thinner below its dishes, mm.
const MIN_MM: f64 = 3.0;
/// Below a plate, where a stem, a keel or pegs stand, a section has less than this share of its area.
const STEM_SHARE: f64 = 0.5;
/// What stands so far below a plate is a stem, a keel or a peg, mm ...
const MIN_STEM_MM: f64 = 5.0;
/// ... and one that stands less far may be a peg of the insert itself, where no ledge shows a plate, mm.
const MAX_PEG_MM: f64 = 10.0;
/// A ledge around the body changes the area of a section by this share at least: a third of a millimetre all
/// around a knee's insert.
const LEDGE_SHARE: f64 = 0.02;
/// What falls or rises over less than this height is a ledge, and more a bevel, mm.
const LEDGE_MM: f64 = 0.02;
/// Of a vertex no farther off, a ledge has its height, mm.
const VERTEX_MM: f64 = 0.03;

/// Where the polyethylene of a body with two dishes ends, as far as its shape shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Underside {
    /// The body shows nothing else than an insert.
    Whole,
    /// It stands on a larger plate: one ledge between the dishes and the plate's underside looks up.
    Ledge {
        /// Height of the ledge along y, mm.
        height_mm: f64,
        /// Polyethylene between it and the lowest place of the dishes, mm.
        below_dishes_mm: f64,
        /// How far the body reaches below its dishes, mm.
        reach_mm: f64,
    },
    /// It reaches farther down than an insert, and does not show where the polyethylene ends.
    Unclear {
        /// How far the body reaches below its dishes, mm.
        reach_mm: f64,
        /// Height of the underside of the plate, or of the whole if it has no stem, mm.
        plate_mm: f64,
        /// Heights of ledges between that and the dishes, mm: of those that look up none or several.
        ledges_mm: Vec<f64>,
    },
}

impl Underside {
    /// That of a closed body with its articulating surface above, x anterior, y superior, z right, mm.
    ///
    /// A body that reaches more than 12 mm below its dishes is looked at in horizontal sections. It is a construct if
    /// a stem, a keel or pegs of 5 mm stand on less than half of its area (10 mm, where no ledge shows a plate), or if it
    /// reaches 25 mm below the dishes. The
    /// polyethylene ends at the height, 3 mm below the dishes or more, below which the area within the outer line of the
    /// section jumps up: on a plate that is larger. Where the area jumps down, the insert may overhang its plate, or be
    /// cut out for its rim, so that is not taken for the end.
    pub fn of(body: &TriangleMesh) -> Self {
        let (low, _) = body.bounds();
        let dishes = Dishes::of(&body.seen_from_above(LINES_EVERY_MM));
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
        let is_whole_below = |stem_most_mm| stem_mm < stem_most_mm && reach_mm < MAX_MM;
        if is_whole_below(MIN_STEM_MM) {
            return Self::Whole;
        }
        let ledges = profile.ledges(plate_mm);
        let mut on_plate = ledges.iter().filter(|ledge| ledge.looks_up);
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
    /// Whether the body is larger below it.
    looks_up: bool,
}

/// How large the horizontal sections of a body are below its dishes.
struct Profile<'a> {
    body: &'a TriangleMesh,
    sections: Sections,
    dish_mm: f64,
    /// Area just below the dishes, mm2.
    whole_mm2: f64,
}

impl<'a> Profile<'a> {
    fn new(body: &'a TriangleMesh, dish_mm: f64) -> Self {
        let sections = Sections::of(body, LINES_EVERY_MM);
        Self {
            body,
            whole_mm2: sections.area_mm2(dish_mm - SECTIONS_EVERY_MM),
            sections,
            dish_mm,
        }
    }

    /// Heights of sections from the dishes down to another.
    fn heights(&self, lowest_mm: f64) -> impl Iterator<Item = f64> + use<> {
        let dish_mm = self.dish_mm;
        let count = ((dish_mm - lowest_mm) / SECTIONS_EVERY_MM) as usize;
        (1..=count).map(move |n| dish_mm - n as f64 * SECTIONS_EVERY_MM)
    }

    /// Where most of the body ends, on the way down; its lowest point if all of it goes on to there.
    fn plate_mm(&self, lowest_mm: f64) -> f64 {
        let is_stem = |y: &f64| self.sections.area_mm2(*y) < STEM_SHARE * self.whole_mm2;
        let below = self.heights(lowest_mm).find(is_stem);
        below.map_or(lowest_mm, |below| {
            self.at_vertex(self.jump(below, below + SECTIONS_EVERY_MM))
        })
    }

    /// Ledges between the thinnest insert and the plate's underside, on the way down.
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

    /// The ledge between two heights, if the area changes by one, and all at once.
    fn ledge(&self, low_mm: f64, high_mm: f64) -> Option<Ledge> {
        let is_ledge = |grown: f64| grown.abs() > LEDGE_SHARE * self.whole_mm2;
        if !is_ledge(self.grown_mm2(low_mm, high_mm)) {
            return None;
        }
        let height_mm = self.at_vertex(self.jump(low_mm, high_mm));
        let grown = self.grown_mm2(height_mm - LEDGE_MM, height_mm + LEDGE_MM);
        is_ledge(grown).then_some(Ledge {
            height_mm,
            looks_up: grown > 0.0,
        })
    }

    /// By how much the lower one of two sections is larger, mm2.
    fn grown_mm2(&self, low_mm: f64, high_mm: f64) -> f64 {
        self.sections.area_mm2(low_mm) - self.sections.area_mm2(high_mm)
    }

    /// Where between two heights the area changes most, by halving.
    fn jump(&self, low_mm: f64, high_mm: f64) -> f64 {
        let (mut low, mut high) = (low_mm, high_mm);
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

    /// The height of the nearest vertex, or the height itself if none is near.
    fn at_vertex(&self, y: f64) -> f64 {
        let heights = self.body.vertices.iter().map(|vertex| vertex.y);
        let nearest = heights.min_by(|a, b| (a - y).abs().total_cmp(&(b - y).abs()));
        nearest
            .filter(|vertex| (vertex - y).abs() < VERTEX_MM)
            .unwrap_or(y)
    }
}

#[cfg(test)]
mod tests;
