//! The insert of a file that also contains its tray and stem.

use condyle::geometry::Underside;
use condyle_mesh::repair::{CheckedMesh, RepairError};

use super::error::{BuildError, BuildWarning, MeshFault, MeshRemark};
use super::meshes::checks_of_insert;
use crate::config::DataFile;

/// Resolution of reported heights: a copied height then cuts where the program did.
const PER_MM: f64 = 100.0;
const ROUNDING: f64 = 1e-6;
/// Usual thickness of a tray's plate, mm, as a hint.
const USUAL_PLATE_MM: f64 = 4.0;

/// Returns the insert of a file, cut off its tray if the shape shows the boundary.
///
/// # Errors
/// [`MeshFault::UnclearUnderside`] if it does not, and the errors of a shell.
pub(super) fn without_tray(
    file: &DataFile,
    shell: CheckedMesh,
    warnings: &mut Vec<BuildWarning>,
) -> Result<CheckedMesh, BuildError> {
    match Underside::find(&shell.mesh) {
        Underside::Whole => Ok(shell),
        Underside::Ledge {
            height_mm,
            below_dishes_mm,
            reach_mm,
        } => {
            let height_mm = rounded_up(height_mm);
            let remark = MeshRemark::CutOffTray {
                height_mm,
                below_dishes_mm,
                reach_mm,
            };
            warnings.push(BuildWarning::mesh(file, remark));
            cut_at(shell, height_mm)
                .map_err(|error| BuildError::mesh(file.path(), MeshFault::Shell(error)))
        }
        Underside::Unclear {
            reach_mm,
            plate_mm,
            ledges_mm,
        } => {
            let heights = heights_to_write(plate_mm, &ledges_mm);
            let fault = MeshFault::UnclearUnderside { reach_mm, heights };
            Err(BuildError::mesh(file.path(), fault))
        }
    }
}

/// Returns the insert of a construct above a height, mm, with the parts of the file that were left out before.
///
/// # Errors
/// The errors of a shell.
pub(in crate::case) fn cut_at(
    whole: CheckedMesh,
    height_mm: f64,
) -> Result<CheckedMesh, RepairError> {
    let CheckedMesh { mesh, left_out, .. } = whole;
    let cut = checks_of_insert(Some(height_mm)).check(mesh)?;
    Ok(CheckedMesh { left_out, ..cut })
}

/// Rounds a height to the next hundredth of a millimetre, so that nothing of the plate is left.
pub(in crate::case) fn rounded_up(height_mm: f64) -> f64 {
    // Adding zero turns -0 into 0.
    (height_mm * PER_MM - ROUNDING).ceil() / PER_MM + 0.0
}

/// Lists the heights to choose from; without a ledge, that of a usual plate.
pub(in crate::case) fn heights_to_write(plate_mm: f64, ledges_mm: &[f64]) -> String {
    let key = |height_mm: f64| format!("clip_below_mm = {:.2}", rounded_up(height_mm));
    let on_plate = if ledges_mm.is_empty() {
        let usual = key(plate_mm + USUAL_PLATE_MM);
        format!("{usual} where it stands on a plate of {USUAL_PLATE_MM:.0} mm")
    } else {
        let ledges: Vec<String> = ledges_mm.iter().map(|&height| key(height)).collect();
        format!("{}, where its sides have a ledge", ledges.join(" or "))
    };
    let whole = key(plate_mm);
    format!("{on_plate}; or {whole}, where all above its underside is polyethylene")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_rounded_up_to_what_is_told() {
        assert_eq!(rounded_up(-9.0), -9.0);
        assert_eq!(rounded_up(-8.999_999_999_9), -9.0);
        assert_eq!(rounded_up(-8.9987), -8.99);
        assert_eq!(rounded_up(0.5), 0.5);
    }

    #[test]
    fn heights_to_write_are_said_as_the_line_of_the_case() {
        let said = heights_to_write(-13.0, &[]);
        assert!(said.starts_with("clip_below_mm = -9.00 where"), "{said}");
        assert!(said.contains("or clip_below_mm = -13.00,"), "{said}");
        let said = heights_to_write(-13.0, &[-6.5, -9.0]);
        assert!(
            said.starts_with("clip_below_mm = -6.50 or clip_below_mm = -9.00, where"),
            "{said}"
        );
    }
}
