//! An insert in a file that may hold its tray too.

use condyle::{
    Mat3,
    anatomy::{Orientation, Recognition},
    geometry::{CheckedShell, ShellError, TriangleMesh, Underside},
};

use crate::case::build::{Body, checks_of, cut_at, heights_to_write, rounded_up};

/// An insert without the tray that its file may hold too.
pub(super) struct Alone {
    pub shell: CheckedShell,
    underside: Underside,
}

impl Alone {
    pub fn of(whole: CheckedShell) -> Result<Self, ShellError> {
        let underside = if whole.closed {
            Underside::of(&whole.mesh)
        } else {
            Underside::Whole
        };
        let shell = match &underside {
            Underside::Ledge { height_mm, .. } => cut_at(whole, rounded_up(*height_mm))?,
            Underside::Whole | Underside::Unclear { .. } => whole,
        };
        Ok(Self { shell, underside })
    }

    /// Whether the file held more than the insert.
    fn is_part(&self) -> bool {
        matches!(self.underside, Underside::Ledge { .. }) || !self.shell.left_out.is_empty()
    }

    /// The height at which it is cut.
    pub fn key(&self) -> String {
        match &self.underside {
            Underside::Ledge { height_mm, .. } => {
                format!("clip_below_mm = {:?}\n", rounded_up(*height_mm))
            }
            _ => String::new(),
        }
    }

    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let parts = self.shell.left_out.len();
        if parts > 0 {
            remarks.push(format!(
                "  The file has {parts} more parts, below the insert or beside it: they are left out."
            ));
        }
        match &self.underside {
            Underside::Whole => {}
            Underside::Ledge {
                below_dishes_mm,
                reach_mm,
                ..
            } => remarks.push(format!(
                "  clip_below_mm: the body reaches {reach_mm:.1} mm below its dishes, as with a tray or stem; cut at the ledge \
                 around it, {below_dishes_mm:.2} mm of polyethylene are left below the dishes: check it."
            )),
            Underside::Unclear {
                reach_mm,
                plate_mm,
                ledges_mm,
            } => remarks.push(format!(
                "  The body reaches {reach_mm:.1} mm below its dishes, as with a tray or stem, and does not show where the \
                 polyethylene ends: write {}.",
                heights_to_write(*plate_mm, ledges_mm)
            )),
        }
        remarks
    }
}

/// Recognises an insert in one with its tray, which is none by its shape: it is cut off as it would be in every
/// orientation, until one shows an insert that lies so.
pub(super) fn recognised_alone(mesh: &TriangleMesh) -> Option<Recognition> {
    Orientation::all().find_map(|lies| {
        let rotation: Mat3 = lies.rotation();
        let placed = mesh.clone().mapped(|vertex| rotation * vertex);
        let alone = Alone::of(checks_of(Body::Insert).check(placed).ok()?).ok()?;
        if !alone.is_part() {
            return None;
        }
        let lies_so = Body::Insert.recognise(&alone.shell.mesh)?.nearest() == Orientation::ISB;
        let back = || {
            alone
                .shell
                .mesh
                .mapped(|vertex| rotation.transpose() * vertex)
        };
        lies_so
            .then(back)
            .and_then(|mesh| Body::Insert.recognise(&mesh))
    })
}
