//! Where an insert is worn.

use condyle_report::{Region, Side, SurfaceFields, Vec3};
use serde::Serialize;

use super::{error::StudyError, ran::Ran};

/// Depth above which a face counts as part of a scar, as a share of the largest depth.
const SCAR_SHARE: f64 = 0.05;

/// The scar of one side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Scar {
    /// Deepest wear.
    pub max_depth_mm: f64,
    /// Where that is, anterior of the insert's origin.
    pub x_mm: f64,
    /// Where that is, to the right of the insert's origin.
    pub z_mm: f64,
    /// From the posterior edge of that side to what is deeper than a twentieth of the deepest wear.
    pub to_posterior_edge_mm: f64,
    /// Area deeper than a twentieth of the whole insert's deepest wear.
    pub area_mm2: f64,
    /// Volume.
    pub volume_mm3: f64,
}

/// The medial scar and the lateral one.
pub(super) fn scars(ran: &Ran) -> Result<[Scar; 2], StudyError> {
    let surface = ran.results.surface.as_ref();
    let depth = surface.and_then(|surface| Some((surface, surface.field("wear_depth_mm")?)));
    let (surface, depth) = depth.ok_or_else(|| ran.lacks("wear_depth_mm"))?;
    let whole = surface.largest(depth, Region::Whole);
    let threshold = SCAR_SHARE * whole.map_or(0.0, |deepest| deepest.value);
    let scar = |region: Region| {
        let deepest = surface.largest(depth, region);
        deepest.map_or_else(Scar::default, |deepest| Scar {
            max_depth_mm: deepest.value,
            x_mm: deepest.position.x,
            z_mm: deepest.position.z,
            to_posterior_edge_mm: to_posterior_edge(surface, depth, threshold, region),
            area_mm2: surface.area_above(depth, threshold, region),
            volume_mm3: surface.integral(depth, region),
        })
    };
    Ok(match ran.results.side {
        Side::Right => [Region::Left, Region::Right].map(scar),
        Side::Left => [Region::Right, Region::Left].map(scar),
    })
}

/// How far the nodes of a region that are deeper than `threshold` are from the rearmost of all, mm.
fn to_posterior_edge(
    surface: &SurfaceFields,
    depth: &[f64],
    threshold: f64,
    region: Region,
) -> f64 {
    let nodes = surface.nodes.iter().zip(depth);
    let inside = nodes.filter(|(node, _)| region.holds(node.z));
    let rearmost = |(edge, scar): (f64, f64), (node, depth): (&Vec3, &f64)| {
        let worn = if *depth > threshold {
            scar.min(node.x)
        } else {
            scar
        };
        (edge.min(node.x), worn)
    };
    let (edge, scar) = inside.fold((f64::INFINITY, f64::INFINITY), rearmost);
    scar - edge
}
