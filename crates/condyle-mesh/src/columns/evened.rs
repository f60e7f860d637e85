//! An outline without chips, slits and teeth narrower than a hexahedron.

use super::grid::ColumnGrid;

/// Takes away what of some samples is narrower than `2 reach + 1` of them, and fills what is narrower
/// between them: an opening and a closing by a square.
pub fn without_details(samples: &ColumnGrid, holds: &[bool], reach: usize) -> Vec<bool> {
    let grown = |of: &[bool]| spread(samples, of, reach, true);
    let shrunk = |of: &[bool]| spread(samples, of, reach, false);
    let opened = grown(&shrunk(holds));
    shrunk(&grown(&opened))
}

/// Takes away teeth: what sticks out of the rest, is narrower than `2 reach + 1` samples, and longer than `longest`.
///
/// Corners, which no square of samples fills to the tip, are shorter, and stay.
pub fn without_teeth(
    samples: &ColumnGrid,
    holds: &[bool],
    reach: usize,
    longest: usize,
) -> Vec<bool> {
    let shrunk = spread(samples, holds, reach, false);
    let body = spread(samples, &shrunk, reach, true);
    let near = spread(samples, &body, longest, true);
    let mut kept = holds.to_vec();
    for first in 0..holds.len() {
        if kept[first] && !near[first] {
            let piece = piece_beside(samples, &kept, &body, first);
            // What nothing holds together with the rest is no tooth of it.
            if piece.touches_body {
                piece.samples.iter().for_each(|&n| kept[n] = false);
            }
        }
    }
    kept
}

/// Samples that hang together outside of a body.
struct Piece {
    samples: Vec<usize>,
    touches_body: bool,
}

/// The piece of what is held, less a body, to which a sample belongs.
fn piece_beside(samples: &ColumnGrid, holds: &[bool], body: &[bool], first: usize) -> Piece {
    let mut piece = Piece {
        samples: vec![first],
        touches_body: false,
    };
    let mut is_found = vec![false; holds.len()];
    is_found[first] = true;
    let mut at = 0;
    while let Some(&n) = piece.samples.get(at) {
        at += 1;
        for other in samples.around(n).filter(|&other| holds[other]) {
            piece.touches_body |= body[other];
            if !body[other] && !std::mem::replace(&mut is_found[other], true) {
                piece.samples.push(other);
            }
        }
    }
    piece
}

/// Lets samples that are `value` spread by `reach` samples along both axes.
fn spread(samples: &ColumnGrid, of: &[bool], reach: usize, value: bool) -> Vec<bool> {
    let along_z = samples.cells.1 + 1;
    let along = |of: &[bool], stride: usize, place: &dyn Fn(usize) -> (usize, usize)| {
        let mut spread = of.to_vec();
        for (n, spread) in spread.iter_mut().enumerate() {
            let (at, count) = place(n);
            let first = n - stride * at.min(reach);
            let steps = at.min(reach) + (count - 1 - at).min(reach);
            if (0..=steps).any(|step| of[first + stride * step] == value) {
                *spread = value;
            }
        }
        spread
    };
    let along_x = samples.cells.0 + 1;
    let rows = along(of, 1, &|n| (n % along_z, along_z));
    along(&rows, along_z, &|n| (n / along_z, along_x))
}
