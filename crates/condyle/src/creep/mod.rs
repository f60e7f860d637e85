//! How polyethylene under load grows thinner with time, without losing mass.

mod lee_pienkowski;

pub use lee_pienkowski::LeePienkowski;
