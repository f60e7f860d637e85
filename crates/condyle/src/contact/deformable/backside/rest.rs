//! Where the backside of an insert comes to rest on its tray.

use nalgebra::DVector;

use super::tray::Tray;
use crate::{contact::model::Tipped, number::Mixing};

/// The backside rests once what it does under what pushes it and what it may do agree within this, mm: a hundredth of
/// what loads and backside have to agree within.
const AT_REST_MM: f64 = 1e-7;
/// Steps after which there is no rest: ten times what was seen where there is.
const MAX_STEPS: usize = 5000;
/// A backside that is this far off its tray has nothing that holds it, mm.
const TIPPED_MM: f64 = 10.0;

/// A backside at rest.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Rest {
    /// Motion of every point along its own directions, anterior, lateral, off the tray, mm.
    pub moved_mm: Vec<f64>,
    /// What the tray pushes each with, N.
    pub pushes_n: Vec<f64>,
    /// Where the search for the next rest may begin.
    pub searched_mm: DVector<f64>,
}

/// The rest of a backside under forces b of the surface on its points, N, of which each stuck last where `stuck_mm` says.
///
/// Every point lifts without force or presses, and sticks or slips the way that friction points against:
///
/// $$ q_n \ge 0, \quad R_n \ge 0, \quad q_n R_n = 0, \qquad |R_t| \le \mu R_n, \quad
/// R_t = -\mu R_n \frac{q_t - q_t^0}{|q_t - q_t^0|} \quad \text{where it slips}, \qquad R = S q - b. $$
///
/// Douglas and Rachford's splitting [eckstein-bertsekas1992]: what the conditions allow a point alone that is pulled by a
/// spring, and what the whole does with the springs of all, in turns, led by Anderson's mixing.
///
/// # Errors
/// A load under which the insert tips off its tray.
pub(in super::super) fn rest(
    tray: &Tray,
    friction: f64,
    stuck_mm: &[f64],
    forces_n: &DVector<f64>,
    searched_mm: &DVector<f64>,
) -> Result<Rest, Tipped> {
    let mut searched = searched_mm.clone();
    let mut mixing = Mixing::default();
    for _ in 0..MAX_STEPS {
        let allowed = allowed(tray, friction, stuck_mm, &searched);
        let mirrored = &allowed * 2.0 - &searched;
        let apart = tray.pulled(forces_n, &mirrored) - &allowed;
        let apart_mm = apart.amax();
        if apart_mm <= AT_REST_MM {
            let pulls = tray
                .stiffness_of_search
                .iter()
                .zip(allowed.iter().zip(searched.iter()));
            return Ok(Rest {
                pushes_n: pulls.map(|(own, (at, from))| own * (at - from)).collect(),
                moved_mm: allowed.as_slice().to_vec(),
                searched_mm: searched,
            });
        }
        if !allowed.amax().is_finite() || allowed.amax() > TIPPED_MM {
            break;
        }
        let image = &searched + apart;
        searched = mixing
            .next(searched.as_slice(), image.as_slice(), 1.0)
            .into();
    }
    let moved_mm = allowed(tray, friction, stuck_mm, &searched).amax();
    Err(Tipped { moved_mm })
}

/// What the conditions allow every point alone that is pulled to a place by the stiffness of the search.
fn allowed(tray: &Tray, friction: f64, stuck_mm: &[f64], pulled_to: &DVector<f64>) -> DVector<f64> {
    let points = pulled_to.as_slice().as_chunks::<3>().0;
    let stuck = stuck_mm.as_chunks::<3>().0;
    let allowed = points.iter().zip(stuck);
    let allowed = allowed.flat_map(|(to, stuck)| allowed_alone(friction, *stuck, *to));
    DVector::from_iterator(tray.freedoms(), allowed)
}

fn allowed_alone(friction: f64, stuck: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    let [x, z, off] = to;
    if off > 0.0 {
        return to;
    }
    let slip = [x - stuck[0], z - stuck[1]];
    let wanted = slip[0].hypot(slip[1]);
    let held = -friction * off;
    let part = if wanted <= held {
        0.0
    } else {
        1.0 - held / wanted
    };
    [stuck[0] + part * slip[0], stuck[1] + part * slip[1], 0.0]
}
