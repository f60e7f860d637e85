//! Whether an insert's dishes lie about the origin, where the machine's axes are.

use std::path::PathBuf;

use condyle::{Vec3, geometry};

use super::super::placement::{InsertOrigin, InsertPlacement};
use super::error::BuildWarning;
use super::rigid_motion::middle_of_points;
use crate::config::DataFile;

/// The dishes may have their middle so far to a side of the origin, mm: each mm moves 2 % of the load to one of them ...
pub(in crate::case) const MAX_ACROSS_MM: f64 = 2.5;
/// ... and so far in front or behind, mm: dishes are lowest behind the middle of an insert, and flat ones at no certain
/// place.
const MAX_ALONG_MM: f64 = 10.0;

/// A warning where the dishes lie off the origin of their file, wherever the case's own keys turn them.
pub(super) fn off_centre(
    file: &DataFile,
    placement: &InsertPlacement,
    insert: &geometry::Insert,
) -> Option<BuildWarning> {
    let rotation = placement.rotation();
    let nodes = insert.surface().positions;
    let unturned: Vec<Vec3> = nodes
        .iter()
        .map(|node| rotation.transpose() * node)
        .collect();
    let middle = rotation * middle_of_points(&unturned);
    let is_of_file = placement.origin == InsertOrigin::File;
    let is_off = middle.z.abs() > MAX_ACROSS_MM || middle.x.abs() > MAX_ALONG_MM;
    (is_of_file && is_off).then(|| BuildWarning::OffCentre {
        file: PathBuf::from(file.name()),
        anterior_mm: middle.x,
        lateral_mm: middle.z,
        most_mm: (MAX_ALONG_MM, MAX_ACROSS_MM),
    })
}
