//! Moves places one by one until the quads between them are well shaped.

use std::f64::consts::FRAC_PI_4;

use super::{
    grid::Place,
    outline::{Loop, turn},
};

/// Quads whose corners all have a larger sine than this are left as they are.
const WELL_SHAPED: f64 = 0.6;
/// Lengths of the trial moves of a place, in edges.
const STEPS: [f64; 4] = [0.3, 0.1, 0.03, 0.01];
/// Maximum number of rounds; a badly shaped quad takes about ten.
const MAX_ROUNDS: usize = 40;

#[derive(Clone, Copy)]
pub(super) enum Freedom<'a> {
    Held,
    Along(&'a Loop),
    Within(&'a Loop),
}

impl Freedom<'_> {
    fn trials(self, place: &Place, length_mm: f64) -> Vec<Place> {
        match self {
            Self::Held => Vec::new(),
            Self::Along(outline) => {
                let here = outline.nearest(place).0;
                let ends = [here - length_mm, here + length_mm];
                ends.map(|along| outline.at(along)).to_vec()
            }
            Self::Within(outline) => {
                let around = eight_directions().map(|way| place + way * length_mm);
                around.filter(|tried| outline.goes_round(tried)).collect()
            }
        }
    }
}

pub(super) fn eight_directions() -> impl Iterator<Item = Place> + Clone {
    (0..8).map(|eighth| {
        let (sine, cosine) = (f64::from(eighth) * FRAC_PI_4).sin_cos();
        Place::new(cosine, sine)
    })
}

/// Moves places so that the worst corner next to each is as good as possible, until no corner is bad.
pub(super) fn shape(
    places: &mut [Place],
    quads: &[[u32; 4]],
    freedoms: &[Freedom<'_>],
    edge_mm: f64,
) {
    let mut quads_of = vec![Vec::new(); places.len()];
    for quad in quads {
        for &place in quad {
            quads_of[place as usize].push(*quad);
        }
    }
    for _ in 0..MAX_ROUNDS {
        let mut has_moved = false;
        for place in 0..places.len() {
            let around = &quads_of[place];
            let worst = min_sine(places, around);
            if worst >= WELL_SHAPED {
                continue;
            }
            let start = places[place];
            let mut best = (worst, start);
            for step in STEPS {
                for tried in freedoms[place].trials(&start, step * edge_mm) {
                    places[place] = tried;
                    let sine = min_sine(places, around);
                    if sine > best.0 {
                        best = (sine, tried);
                    }
                }
            }
            places[place] = best.1;
            has_moved |= best.1 != start;
        }
        if !has_moved {
            return;
        }
    }
}

/// Returns the smallest sine of a corner of some quads; negative if one is inverted.
fn min_sine(places: &[Place], quads: &[[u32; 4]]) -> f64 {
    let corners = quads
        .iter()
        .flat_map(|quad| (0..4).map(move |corner| (quad, corner)));
    let sines = corners.map(|(quad, corner)| {
        let [here, after, before] =
            [0, 1, 3].map(|step| places[quad[(corner + step) % 4] as usize]);
        let (along, back) = (after - here, before - here);
        turn(&along, &back) / (along.norm() * back.norm()).max(f64::MIN_POSITIVE)
    });
    sines.fold(f64::INFINITY, f64::min)
}
