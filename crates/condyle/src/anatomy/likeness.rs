//! The body that a mesh resembles: one of a whole knee, or others that are mistaken for them.

use std::{f64::consts::PI, fmt};

use super::{
    sampled::{Sampled, area},
    upright::{MIN_BACKSIDE, Upright},
};
use crate::geometry::TriangleMesh;

/// Smallest share of a sphere that makes a body a head or a cup: half a sphere, less a hole for the stem and a rim. A
/// condyle covers a twentieth.
const MIN_COVERED: f64 = 0.3;
/// Share of a ball that a head fills: it is cut flat or bored for a stem.
const MIN_FULL: f64 = 0.7;
/// Share of the area seen from above, and of that seen from below, that lies in one plane in a tray. The dishes of an insert
/// are flat over at most a quarter; one flat compartment of an insert, and each wall of a femur's box, is less than half.
const MIN_FLAT: f64 = 0.6;
/// Thickness of a whole insert, as a share of its longest extent, below which a body that resembles both is one; femora
/// are over half as thick as long.
const MAX_THIN: f64 = 0.45;
/// Length, width and thickness up to which a body is an insert of one compartment, mm: whole ones are wider.
const MAX_OF_ONE_MM: [f64; 3] = [62.0, 34.0, 20.0];

/// The body that a mesh resembles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Likeness {
    /// A whole femoral component.
    Femur,
    /// An insert with two dishes.
    Insert,
    /// A ball, with its radius in the unit of the mesh.
    Head(f64),
    /// A cup.
    Cup,
    /// A plate that is flat above and below.
    Tray,
    /// The insert of one compartment, or another part as small.
    OneCompartment,
}

impl Likeness {
    /// Recognises a closed body, or an open shell that faces out; `mesh` in mm. None if it resembles none of them.
    pub fn of(mesh: &TriangleMesh) -> Option<Self> {
        let sampled = Sampled::new(mesh)?;
        if let Some(round) = round(mesh, &sampled) {
            return Some(round);
        }
        let (flat, extents) = (sampled.flattest(), extents(mesh));
        if [flat.normal, -flat.normal]
            .iter()
            .all(|side| sampled.plane_share(side) > MIN_FLAT)
        {
            // Bearings of one compartment are nearly flat.
            return one_compartment(&extents).or(Some(Self::Tray));
        }
        let femur = || Upright::of_femur(mesh).map(|_| Self::Femur);
        // Without a backside, condyles from behind look like dishes.
        let has_backside = flat.share > MIN_BACKSIDE;
        let insert = || {
            Upright::of_insert(mesh)
                .filter(|_| has_backside)
                .map(|_| Self::Insert)
        };
        if extents[2] > MAX_THIN * extents[0] {
            // An insert that lies oblique has a high box.
            return femur().or_else(insert);
        }
        match Upright::of_insert(mesh) {
            Some(_) => has_backside.then_some(Self::Insert),
            None => one_compartment(&extents).or_else(femur),
        }
    }
}

fn one_compartment(extents: &[f64; 3]) -> Option<Likeness> {
    let mut small = extents.iter().zip(MAX_OF_ONE_MM);
    let is_small = small.all(|(one, most)| *one < most);
    is_small.then_some(Likeness::OneCompartment)
}

/// Returns the lengths of the box of a mesh, the longest first.
fn extents(mesh: &TriangleMesh) -> [f64; 3] {
    let (low, high) = mesh.bounds();
    let mut extents: [f64; 3] = (high - low).into();
    extents.sort_by(|a, b| b.total_cmp(a));
    extents
}

impl fmt::Display for Likeness {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Femur => "a femoral component",
            Self::Insert => "an insert with two dishes",
            Self::Head(_) => "the head of a hip or shoulder",
            Self::Cup => "the cup of a hip or shoulder",
            Self::Tray => "a tray, flat above and below",
            Self::OneCompartment => "an insert of one compartment",
        })
    }
}

/// Returns a head or a cup. A shell may face either way, so only its volume shows which side of a sphere is solid.
fn round(mesh: &TriangleMesh, sampled: &Sampled) -> Option<Likeness> {
    let solid = mesh.signed_volume().signum();
    let (radius, covered) = sampled.sphere(area(mesh))?;
    if covered < MIN_COVERED {
        return None;
    }
    // The outside of a cup is convex as a head is, but a cup has about half the volume of a ball, or less.
    let ball = 4.0 / 3.0 * PI * radius.abs().powi(3);
    let is_full = mesh.signed_volume().abs() > MIN_FULL * ball;
    Some(if solid * radius > 0.0 && is_full {
        Likeness::Head(radius.abs())
    } else {
        Likeness::Cup
    })
}
