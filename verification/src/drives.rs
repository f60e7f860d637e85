//! Simple motions of a freedom.

use condyle::machine::{Drive, Interpolation, Knot, Waveform};

/// To and fro: -a cos(2 pi t), t in cycles.
pub(crate) fn to_and_fro(amplitude: f64) -> Drive {
    between([(0.0, -amplitude), (50.0, amplitude)])
}

/// To and fro, a quarter of a cycle later: -a sin(2 pi t).
pub(crate) fn to_and_fro_later(amplitude: f64) -> Drive {
    between([(25.0, -amplitude), (75.0, amplitude)])
}

/// A half-cosine between two knots is a whole cosine.
fn between(ends: [(f64, f64); 2]) -> Drive {
    let knots = ends.map(|(percent, value)| Knot { percent, value });
    let waveform = Waveform::new(knots.to_vec(), Interpolation::HalfCosine);
    Drive::Prescribed(waveform.expect("two good knots"))
}
