//! Which knee a draft is of.

use condyle::{anatomy::flange_lead_mm, geometry::TriangleMesh};

use crate::case::heading::Side;

/// Which knee a case is of, and where that comes from.
pub(super) struct ConcludedSide {
    pub side: Side,
    pub remark: String,
}

impl ConcludedSide {
    /// Of a femur that lies x anterior, y superior, z right, of which the user may have said the side.
    pub fn of(femur: &TriangleMesh, said: Option<Side>) -> Self {
        let shown = flange_lead_mm(femur).map(|lead| {
            let side = if lead > 0.0 { Side::Right } else { Side::Left };
            (side, lead.abs())
        });
        let side = said.or(shown.map(|(side, _)| side)).unwrap_or(Side::Right);
        let of_shape = match shown {
            Some((shown, lead_mm)) => format!(
                "likely a {} knee, since one flange of the trochlea stands out by {lead_mm:.1} mm there",
                shown.word()
            ),
            None => "not told by the shape, of which both sides are alike".to_owned(),
        };
        let why = match said {
            Some(_) => "as it was said",
            None if shown.is_some() => "check it",
            None => "assumed: check it",
        };
        let remark = format!("  side \"{}\", {why}; {of_shape}.", side.word());
        Self { side, remark }
    }
}
