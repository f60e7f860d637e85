//! Differences of depth in numbers.

use condyle_io::measured::Scan;
use condyle_report::SurfaceFields;
use serde::Serialize;

use super::super::CompareError;
use super::{depth::Compared, register::Registration};

/// What a scan of an unloaded insert shows beside wear.
const CREEP: &str = "a scan of an unloaded insert shows wear and about half of the creep; the \
    prediction is wear alone, so scanned depths are expected to be larger where pressure was high";
/// Depth above which a place counts as part of a scar, as a share of the deepest predicted.
const SCAR_SHARE: f64 = 0.05;
/// A motion fixed less well than this is worth a word, mm.
const WEAK_MM: f64 = 0.02;
/// A scan that covers less than this share of the surface is worth a word.
const LITTLE: f64 = 0.9;

/// How far a scanned surface is from the predicted one. Depths are measured from the unworn
/// surface along its normal; differences are scanned minus predicted.
#[derive(Clone, Debug, Serialize)]
pub struct SurfaceComparison {
    /// How the scan was laid onto the prediction.
    pub registration: Registration,
    /// Points of the scan.
    pub scan_points: usize,
    /// Part of the articulating surface that the scan covers, by area, 0 to 1.
    pub covered_area_share: f64,
    /// Nodes compared.
    pub nodes: usize,
    /// Over all nodes compared, weighted by area.
    pub everywhere: SurfaceErrors,
    /// Where either depth is above 5 % of the deepest predicted; none without such a place.
    pub in_scars: Option<SurfaceErrors>,
    /// The node where the two differ most.
    pub worst: NodeDepths,
    /// The node of the deepest predicted wear.
    pub deepest_predicted: NodeDepths,
    /// The node of the deepest scanned wear.
    pub deepest_scanned: NodeDepths,
    /// Predicted volume over the area compared.
    pub predicted_volume_mm3: f64,
    /// Scanned volume over the same area.
    pub scanned_volume_mm3: f64,
    /// What to keep in mind.
    pub notes: Vec<String>,
    /// The unworn surface with the three fields `predicted_mm`, `scanned_mm`, `difference_mm`, NaN
    /// where the scan does not reach.
    #[serde(skip)]
    pub fields: SurfaceFields,
}

/// How far two surfaces are apart, weighted by area; scanned minus predicted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SurfaceErrors {
    /// Mean difference.
    pub mean_mm: f64,
    /// Mean of the absolute differences.
    pub mean_absolute_mm: f64,
    /// Root of the mean square.
    pub rms_mm: f64,
    /// Area that these are taken over.
    pub area_mm2: f64,
}

/// A node and its depths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NodeDepths {
    /// Position on the unworn surface, x.
    pub x_mm: f64,
    /// Position on the unworn surface, y.
    pub y_mm: f64,
    /// Position on the unworn surface, z.
    pub z_mm: f64,
    /// Predicted depth.
    pub predicted_mm: f64,
    /// Scanned depth.
    pub scanned_mm: f64,
    /// Scanned minus predicted.
    pub difference_mm: f64,
}

/// The comparison of a registered scan.
pub(super) fn summarised(
    unworn: &SurfaceFields,
    compared: &Compared,
    registration: Registration,
    scan: &Scan,
) -> Result<SurfaceComparison, CompareError> {
    let nodes = covered(compared);
    let place = |node: &usize| place(unworn, compared, *node);
    let all: Vec<NodeDepths> = nodes.iter().map(place).collect();
    let largest = |of: fn(&NodeDepths) -> f64| {
        let found = all.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
        let farthest_mm = scan.keys.farthest_mm;
        found
            .copied()
            .ok_or(CompareError::NothingScanned { farthest_mm })
    };
    let deepest_predicted = largest(|place| place.predicted_mm)?;
    let scar = SCAR_SHARE * deepest_predicted.predicted_mm;
    let worn = |&&node: &&usize| {
        scar > 0.0 && compared.predicted_mm[node].max(compared.scanned_mm[node]) > scar
    };
    let scars: Vec<usize> = nodes.iter().filter(worn).copied().collect();
    let area: f64 = compared.areas_mm2.iter().sum();
    let volume = |depth: &[f64]| {
        nodes
            .iter()
            .map(|&i| depth[i] * compared.areas_mm2[i])
            .sum()
    };
    let everywhere = errors(compared, &nodes);
    let covered_area_share = everywhere.area_mm2 / area;
    Ok(SurfaceComparison {
        notes: notes(&registration, covered_area_share),
        registration,
        scan_points: scan.points.len(),
        covered_area_share,
        nodes: nodes.len(),
        everywhere,
        in_scars: (!scars.is_empty()).then(|| errors(compared, &scars)),
        worst: largest(|place| place.difference_mm.abs())?,
        deepest_predicted,
        deepest_scanned: largest(|place| place.scanned_mm)?,
        predicted_volume_mm3: volume(&compared.predicted_mm),
        scanned_volume_mm3: volume(&compared.scanned_mm),
        fields: fields(unworn, compared),
    })
}

fn covered(compared: &Compared) -> Vec<usize> {
    let both = |node: &usize| {
        compared.scanned_mm[*node].is_finite() && compared.predicted_mm[*node].is_finite()
    };
    (0..compared.scanned_mm.len()).filter(both).collect()
}

fn place(unworn: &SurfaceFields, compared: &Compared, node: usize) -> NodeDepths {
    let position = unworn.nodes[node];
    let (predicted_mm, scanned_mm) = (compared.predicted_mm[node], compared.scanned_mm[node]);
    NodeDepths {
        x_mm: position.x,
        y_mm: position.y,
        z_mm: position.z,
        predicted_mm,
        scanned_mm,
        difference_mm: scanned_mm - predicted_mm,
    }
}

fn errors(compared: &Compared, nodes: &[usize]) -> SurfaceErrors {
    let area_mm2: f64 = nodes.iter().map(|&node| compared.areas_mm2[node]).sum();
    let mean = |of: fn(f64) -> f64| {
        let part = |&node: &usize| {
            let difference = compared.scanned_mm[node] - compared.predicted_mm[node];
            compared.areas_mm2[node] * of(difference)
        };
        nodes.iter().map(part).sum::<f64>() / area_mm2
    };
    SurfaceErrors {
        mean_mm: mean(|difference| difference),
        mean_absolute_mm: mean(f64::abs),
        rms_mm: mean(|difference| difference * difference).sqrt(),
        area_mm2,
    }
}

fn fields(unworn: &SurfaceFields, compared: &Compared) -> SurfaceFields {
    let pairs = || compared.scanned_mm.iter().zip(&compared.predicted_mm);
    let predicted = pairs().map(|(scanned, predicted)| predicted + 0.0 * scanned);
    let difference = pairs().map(|(scanned, predicted)| scanned - predicted);
    SurfaceFields {
        nodes: unworn.nodes.clone(),
        quads: unworn.quads.clone(),
        fields: vec![
            ("predicted_mm".to_owned(), predicted.collect()),
            ("scanned_mm".to_owned(), compared.scanned_mm.clone()),
            ("difference_mm".to_owned(), difference.collect()),
        ],
    }
}

fn notes(registration: &Registration, covered: f64) -> Vec<String> {
    let mut notes = vec![CREEP.to_owned()];
    if registration.weakest_standard_error_mm > WEAK_MM {
        notes.push(format!(
            "the fitted surface leaves one motion of the scan uncertain by {:.3} mm (standard error)",
            registration.weakest_standard_error_mm
        ));
    }
    if covered < LITTLE {
        notes.push(format!(
            "the scan covers {:.0} % of the articulating surface",
            100.0 * covered
        ));
    }
    notes
}
