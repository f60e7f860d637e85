//! Places moved a little, until no quad beside them is badly shaped.

use super::outline::{Loop, Place, turn};

/// Quads whose corners all have a larger sine than this are left as they are.
const WELL_SHAPED: f64 = 0.6;
/// How far a place is tried to be moved, in edges.
const STEPS: [f64; 4] = [0.3, 0.1, 0.03, 0.01];
/// Rounds at most; a badly shaped quad takes some ten.
const ROUNDS: usize = 40;

/// The least sine of a corner of some quads; less than 0 where one is turned round.
fn least_sine(places: &[Place], quads: &[[u32; 4]]) -> f64 {
    let corners = |quad: &[u32; 4]| {
        let quad = *quad;
        (0..4).map(move |corner| (quad, corner))
    };
    let sines = quads.iter().flat_map(corners).map(|(quad, corner)| {
        let [here, after, before] =
            [0, 1, 3].map(|step| places[quad[(corner + step) % 4] as usize]);
        let (along, back) = (after - here, before - here);
        turn(&along, &back) / (along.norm() * back.norm()).max(f64::MIN_POSITIVE)
    });
    sines.fold(f64::INFINITY, f64::min)
}

/// Where a place may be moved to.
#[derive(Clone, Copy)]
pub enum Freedom<'a> {
    /// Nowhere.
    Held,
    /// Along an outline that it is on.
    Along(&'a Loop),
    /// Anywhere inside an outline.
    Within(&'a Loop),
}

impl Freedom<'_> {
    /// Where a place may be tried that is moved by about a length, mm.
    fn tried(self, place: &Place, length_mm: f64) -> Vec<Place> {
        match self {
            Self::Held => Vec::new(),
            Self::Along(outline) => {
                let here = outline.nearest(place).0;
                let ends = [here - length_mm, here + length_mm];
                ends.map(|along| outline.at(along)).to_vec()
            }
            Self::Within(outline) => (0..8)
                .map(|eighth| {
                    let (sine, cosine) =
                        (f64::from(eighth) * std::f64::consts::FRAC_PI_4).sin_cos();
                    place + Place::new(cosine, sine) * length_mm
                })
                .filter(|tried| outline.goes_round(tried))
                .collect(),
        }
    }
}

/// Moves places one by one to where the worst corner beside them is best, while one is bad.
pub fn shape(places: &mut [Place], quads: &[[u32; 4]], freedoms: &[Freedom<'_>], edge_mm: f64) {
    let beside = quads_beside(places.len(), quads);
    let is_bad = |sine: f64| sine < WELL_SHAPED;
    for _ in 0..ROUNDS {
        let mut has_moved = false;
        for place in 0..places.len() {
            let around: Vec<[u32; 4]> = beside[place].iter().map(|&n| quads[n as usize]).collect();
            if is_bad(least_sine(places, &around)) {
                has_moved |= improve(places, place, &around, freedoms[place], edge_mm);
            }
        }
        if !has_moved {
            return;
        }
    }
}

/// Moves one place to the best of those that are tried, and says whether it is better than where it was.
fn improve(
    places: &mut [Place],
    place: usize,
    around: &[[u32; 4]],
    freedom: Freedom<'_>,
    edge_mm: f64,
) -> bool {
    let start = places[place];
    let mut best = (least_sine(places, around), start);
    for step in STEPS {
        for tried in freedom.tried(&start, step * edge_mm) {
            places[place] = tried;
            let sine = least_sine(places, around);
            if sine > best.0 {
                best = (sine, tried);
            }
        }
    }
    places[place] = best.1;
    best.1 != start
}

fn quads_beside(place_count: usize, quads: &[[u32; 4]]) -> Vec<Vec<u32>> {
    let mut beside = vec![Vec::new(); place_count];
    for (number, quad) in quads.iter().enumerate() {
        for &place in quad {
            beside[place as usize].push(number as u32);
        }
    }
    beside
}
