//! The insert in hexahedra, cut off the tray and stem that its file may also contain.

use std::collections::BTreeSet;
use std::path::Path;

use condyle::Vec3;
use condyle::geometry::{
    self, GenericInsertShape, Meshing, TriangleMesh, Underside, UnrolledCup, cup_mounting,
    flat_insert, pin,
};
use condyle_fem::HexMesh;
use condyle_mesh::columns::listed_holes;
use condyle_mesh::formats::{HexFile, read_hexahedra, read_surface};
use condyle_mesh::repair::{CheckedMesh, RepairError};
use condyle_mesh::{FittedSphere, Roundness};

use super::checks::off_centre;
use super::error::{Body, BuildError, BuildWarning, Finding};
use super::placing::{Placing, checked, checks_of, middle_of_mesh, middle_of_points, shell, warn};
use super::size::{check_points, check_triangles};
use crate::case::contents::Case;
use crate::case::frame::{Axes, FileFrame};
use crate::case::insert::{
    CupMeshInsert, GenericInsert, HexahedralInsert, Insert, InsertShape, MeshInsert,
};
use crate::case::run_options::Limits;
use crate::config::DataFile;

/// Length and width of the flat block, mm, about those of the generic insert.
const FLAT_SIZE_MM: (f64, f64) = (46.0, 72.0);
/// Resolution of reported heights: a copied height then cuts where the program did.
const PER_MM: f64 = 100.0;
/// Cosine of the largest angle between the axis of a cup and the mean direction from its socket: a lip turns it by less.
const MIN_COSINE_TO_SOCKET: f64 = 0.5;
/// Share of a hundredth of a millimetre that is rounding error, so that a height is not rounded up for it.
const ROUNDING: f64 = 1e-6;

impl Case {
    /// Returns the insert of this case in a mesh with twice the edge length and half the layers.
    ///
    /// # Errors
    /// In words: an insert that is read as hexahedra, or that has no such mesh.
    pub fn coarser_insert(&self) -> Result<geometry::Insert, String> {
        let mut coarser = self.insert.clone();
        match &mut coarser.shape {
            InsertShape::Generic(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::Cup(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::CupMesh(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::Trough(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::Pin(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::Flat(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::Mesh(insert) => coarsen(&mut insert.edge_mm, &mut insert.layers),
            InsertShape::Hexahedra(_) => {
                return Err("an insert read as hexahedra has no coarser mesh".to_owned());
            }
        }
        let built = self.built_insert(&coarser, &mut Vec::new());
        built.map_err(|why| why.to_string())
    }

    /// Returns the triangles in the file of its insert, if there are any, in the insert frame of a right knee, mm.
    pub fn insert_triangles(&self) -> Option<TriangleMesh> {
        let InsertShape::Mesh(insert) = &self.insert.shape else {
            return None;
        };
        let placing = Placing::new(&insert.frame, None, self.side_in_frame()).ok()?;
        Some(placing.mesh(read_surface(insert.file.files(), insert.file.path()).ok()?))
    }

    pub(super) fn built_insert(
        &self,
        insert: &Insert,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        let (placement, limits) = (&insert.placement, &self.limits);
        let built = match &insert.shape {
            InsertShape::Generic(GenericInsert {
                shape,
                edge_mm,
                layers,
            }) => {
                let meshing = meshing(*edge_mm, *layers);
                check_node_count(GenericInsertShape::SIZE_MM, meshing, limits)?;
                // Its dishes have their middle at its origin.
                match placement.motion(Vec3::zeros) {
                    Some(motion) => shape.insert_moved(meshing, |point| motion.point(point))?,
                    None => shape.insert(meshing)?,
                }
            }
            InsertShape::Cup(insert) => {
                let meshing = meshing(insert.edge_mm, insert.layers);
                // A hemisphere has the area of a square with sides of 2.5 radii.
                let side_mm = 2.5 * insert.shape.radius_mm;
                check_node_count((side_mm, side_mm), meshing, limits)?;
                insert.shape.insert(meshing)?
            }
            InsertShape::CupMesh(insert) => self.cup_from_mesh(insert, warnings)?,
            InsertShape::Trough(insert) => {
                let meshing = meshing(insert.edge_mm, insert.layers);
                let size_mm = (insert.shape.length_mm, insert.shape.width_mm);
                check_node_count(size_mm, meshing, limits)?;
                insert.shape.insert(meshing)?
            }
            InsertShape::Pin(insert) => {
                let meshing = meshing(insert.edge_mm, insert.layers);
                let side_mm = 2.0 * insert.radius_mm;
                check_node_count((side_mm, side_mm), meshing, limits)?;
                pin(insert.radius_mm, insert.thickness_mm, meshing)?
            }
            InsertShape::Flat(insert) => {
                let meshing = meshing(insert.edge_mm, insert.layers);
                check_node_count(FLAT_SIZE_MM, meshing, limits)?;
                flat_insert(FLAT_SIZE_MM, insert.thickness_mm, meshing)?
            }
            InsertShape::Mesh(mesh) => self.insert_from_mesh(mesh, insert, warnings)?,
            InsertShape::Hexahedra(mesh) => self.insert_from_hexahedra(mesh, insert, warnings)?,
        };
        // With a stray piece the positions of the dishes are unreliable.
        let is_stray = |warning: &BuildWarning| warning.finding == Finding::StrayPiece;
        let is_whole = !warnings.iter().any(is_stray);
        let has_dishes = self.tests_knee();
        if let Some(file) = insert.file().filter(|_| is_whole && has_dishes) {
            warnings.extend(off_centre(file, placement, &built));
        }
        Ok(built)
    }

    fn insert_from_mesh(
        &self,
        insert: &MeshInsert,
        of: &Insert,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        let file = &insert.file;
        let placing = Placing::new(&insert.frame, None, self.side_in_frame())?;
        let checks = checks_of(Body::Insert, insert.clip_below_mm);
        let mut shell = shell(file, &placing, checks, warnings)?;
        if shell.closed && insert.thickness_mm.is_some() {
            let message = "the mesh is closed, so it determines the thickness; remove [insert] `thickness_mm`";
            return Err(BuildError::mesh(file.path(), &["thickness_mm"], message));
        }
        self.check_orientation(Body::Insert, file, &shell.mesh, &placing, warnings)?;
        if shell.closed && insert.clip_below_mm.is_none() {
            let count = shell.mesh.triangles.len();
            shell = without_tray(file, shell, warnings)?;
            // The body that remains may lie another way than the construct seemed to.
            if shell.mesh.triangles.len() != count {
                self.check_orientation(Body::Insert, file, &shell.mesh, &placing, warnings)?;
            }
        }
        let mesh = match of.placement.motion(|| middle_of_mesh(&shell.mesh)) {
            Some(motion) => motion.mesh(shell.mesh),
            None => shell.mesh,
        };
        let meshing = meshing(insert.edge_mm, insert.layers);
        let (low, high) = mesh.bounds();
        check_node_count((high.x - low.x, high.z - low.z), meshing, &self.limits)?;
        let built = geometry::Insert::over_holes(&mesh, shell.closed, insert.thickness_mm, meshing);
        let (built, holes) =
            built.map_err(|error| BuildError::shell_insert(file.path(), &error))?;
        if !holes.is_empty() {
            let edge_mm = meshing.edge_mm;
            let remark = format!(
                "the surface is interpolated smoothly over a {}; contact there or within {edge_mm} mm is an error, \
                 which every update checks",
                listed_holes(&holes)
            );
            let warning = BuildWarning::mesh(file, remark);
            warnings.push(warning.with(Finding::Bridged(holes, edge_mm)));
        }
        Ok(built)
    }

    fn cup_from_mesh(
        &self,
        cup: &CupMeshInsert,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        let (file, path) = (&cup.file, cup.file.path());
        let frame = FileFrame {
            length_unit: cup.length_unit,
            axes: Axes::ISB,
            rotation_deg: None,
        };
        let placing = Placing::new(&frame, None, self.side_in_frame())?;
        let mesh = placing.mesh(read_surface(file.files(), path)?);
        check_triangles(path, &mesh, cup.length_unit)?;
        let Some(socket) = FittedSphere::new(&mesh, Roundness::Concave) else {
            let message = "this body has no spherical socket, as a cup has; check that it is the cup, not its head, and that its \
                           triangles face outwards";
            return Err(BuildError::mesh(path, &["file"], message));
        };
        let meshing = meshing(cup.edge_mm, cup.layers);
        // A hemisphere has the area of a square with sides of 2.5 radii.
        let side_mm = 2.5 * socket.radius_mm;
        check_node_count((side_mm, side_mm), meshing, &self.limits)?;
        let given = |along| placing.point(&Vec3::from(along));
        let opens_along = cup.opens_along.map_or(socket.opens_along, given);
        if opens_along.norm() == 0.0 {
            let message = "`opens_along` has no direction; write that from the pole of the socket to its centre";
            return Err(BuildError::mesh(path, &["opens_along"], message));
        }
        if opens_along.normalize().dot(&socket.opens_along) < MIN_COSINE_TO_SOCKET {
            let [x, y, z]: [f64; 3] = placing.mirrored(&socket.opens_along).into();
            let message = format!(
                "`opens_along` points away from the opening of the socket, which is along ({x:.3}, {y:.3}, {z:.3}); correct it, or \
                 remove it"
            );
            return Err(BuildError::mesh(path, &["opens_along"], message));
        }
        let unrolled = UnrolledCup::new(mesh.clone(), &socket, opens_along, cup.edge_mm);
        // Unrolled, its sides are divided: only the vertices of the file scatter.
        let checks = checks_of(Body::Insert, None);
        let in_file = |place: &Vec3| placing.mirrored(&unrolled.rolled(place));
        let shell = checked(path, (&unrolled.mesh, &in_file), &mesh, checks)?;
        if !shell.closed {
            let message = "the cup is open, so its thickness is unknown; give its closed surface";
            return Err(BuildError::mesh(path, &["file"], message));
        }
        warn(file, &shell, &mesh, warnings);
        let mounting = cup_mounting(cup.inclination_deg, cup.anteversion_deg);
        let built = unrolled.insert(&shell.mesh, meshing, &mounting);
        built.map_err(|error| BuildError::shell_insert(path, &error))
    }

    /// Returns the hexahedra of a file in the frame of a right knee, mm.
    pub(super) fn placed_hexahedra(
        &self,
        insert: &HexahedralInsert,
    ) -> Result<(HexFile, Placing), BuildError> {
        let placing = Placing::new(&insert.frame, None, self.side_in_frame())?;
        let mut file = read_hexahedra(insert.file.files(), insert.file.path())?;
        for node in &mut file.mesh.nodes {
            *node = placing.point(node);
        }
        if placing.mirrors {
            // A mirror turns a hexahedron inside out; with its two faces exchanged, its volume is positive again.
            let swapped = |[a, b, c, d, e, f, g, h]: [u32; 8]| [e, f, g, h, a, b, c, d];
            file.mesh.hexes = file.mesh.hexes.iter().copied().map(swapped).collect();
            let surfaces = file.surfaces.iter_mut();
            let quads = surfaces.flat_map(|surface| &mut surface.quads);
            quads.for_each(|quad| quad.reverse());
        }
        Ok((file, placing))
    }

    fn insert_from_hexahedra(
        &self,
        insert: &HexahedralInsert,
        of: &Insert,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        let path = insert.file.path();
        let (mut file, placing) = self.placed_hexahedra(insert)?;
        check_points(path, &file.mesh.nodes, insert.frame.length_unit)?;
        check_nodes(file.mesh.nodes.len() as f64, &self.limits)?;
        let boundary = file.mesh_of_boundary();
        self.check_orientation(Body::Insert, &insert.file, &boundary, &placing, warnings)?;
        let articulating = match &insert.articulating_surface {
            Some(name) => {
                let key = &["articulating_surface", "axes"];
                let quads = named(&file, path, key, name)?;
                refuse_downward(&file.mesh, &quads, name)
                    .map_err(|message| BuildError::mesh(path, key, message))?;
                quads
            }
            None => facing(&file.mesh, 1.0),
        };
        let backside = match &insert.backside {
            Some(name) => named(&file, path, &["backside"], name)?,
            None => facing(&file.mesh, -1.0),
        };
        let middle = || {
            let nodes: BTreeSet<u32> = articulating.iter().flatten().copied().collect();
            let nodes = nodes.into_iter().map(|node| file.mesh.nodes[node as usize]);
            middle_of_points(&nodes.collect::<Vec<Vec3>>())
        };
        if let Some(motion) = of.placement.motion(middle) {
            for node in &mut file.mesh.nodes {
                *node = motion.point(node);
            }
        }
        Ok(geometry::Insert::new(file.mesh, &articulating, &backside)?)
    }
}

fn coarsen(edge_mm: &mut f64, layers: &mut u64) {
    *edge_mm *= 2.0;
    *layers = layers.div_ceil(2);
}

fn meshing(edge_mm: f64, layers: u64) -> Meshing {
    let layers = layers as usize;
    Meshing { edge_mm, layers }
}

/// Rejects a mesh of hexahedra that would not fit into memory before it is created; `size_mm` is its length and
/// width.
fn check_node_count(
    (length_mm, width_mm): (f64, f64),
    meshing: Meshing,
    limits: &Limits,
) -> Result<(), BuildError> {
    // The grid of the mesher has a whole number of cells, one at least, along each side.
    let points = |length_mm: f64| (length_mm / meshing.edge_mm).round().max(1.0) + 1.0;
    let nodes = points(length_mm) * points(width_mm) * (meshing.layers as f64 + 1.0);
    check_nodes(nodes, limits)
}

fn check_nodes(nodes: f64, limits: &Limits) -> Result<(), BuildError> {
    let (most, memory_gb) = (limits.most(Limits::BYTES_OF_INSERT_NODE), limits.memory_gb);
    if nodes <= most as f64 {
        return Ok(());
    }
    let message = format!(
        "the insert would have {nodes:.0} nodes, and more than {most} take more than the {memory_gb} GB that [limits] \
         memory_gb allows; use a larger edge_mm or fewer layers, check length_unit, or allow more"
    );
    let keys = &["edge_mm", "layers", "file", "length_unit"];
    Err(BuildError::conflict("insert", keys, message))
}

fn named(
    file: &HexFile,
    path: &Path,
    key: &'static [&'static str],
    name: &str,
) -> Result<Vec<[u32; 4]>, BuildError> {
    if let Some(surface) = file.surface(name) {
        return Ok(surface.quads.clone());
    }
    let names = file.surfaces.iter().map(|surface| surface.name.as_str());
    let listed = match names.collect::<Vec<_>>().join(", ") {
        names if names.is_empty() => "none".to_owned(),
        names => names,
    };
    let message = format!("the mesh has no surface \"{name}\"; its surfaces are {listed}");
    Err(BuildError::mesh(path, key, message))
}

/// Refuses an articulating surface that faces down, away from the counterface.
fn refuse_downward(mesh: &HexMesh, quads: &[[u32; 4]], name: &str) -> Result<(), String> {
    let sorted = |mut quad: [u32; 4]| {
        quad.sort_unstable();
        quad
    };
    // Files may turn the faces of a surface either way: those of the boundary face outwards.
    let named: BTreeSet<[u32; 4]> = quads.iter().copied().map(sorted).collect();
    let outward = mesh.boundary_quads().into_iter();
    let outward = outward.filter(|quad| named.contains(&sorted(*quad)));
    let area = |quad: [u32; 4]| {
        let [a, b, c, d]: [Vec3; 4] = quad.map(|node| mesh.nodes[node as usize]);
        (c - a).cross(&(d - b))
    };
    if outward.map(area).sum::<Vec3>().y >= 0.0 {
        return Ok(());
    }
    Err(format!(
        "`articulating_surface` \"{name}\" faces down, away from the counterface; exchange it with `backside`, or correct `axes`"
    ))
}

/// A face counts as seen from above or below if it leans by less than 60 degrees.
const MIN_COSINE: f64 = 0.5;

/// Returns the faces of the boundary that face up (`up` 1) or down (-1).
fn facing(mesh: &HexMesh, up: f64) -> Vec<[u32; 4]> {
    let upward = |quad: &[u32; 4]| {
        let [a, b, c, d]: [Vec3; 4] = quad.map(|node| mesh.nodes[node as usize]);
        let normal = (c - a).cross(&(d - b));
        up * normal.y > MIN_COSINE * normal.norm()
    };
    mesh.boundary_quads().into_iter().filter(upward).collect()
}

/// Returns the insert of a file, cut off its tray if the shape shows the boundary.
///
/// # Errors
/// The shape does not show it, or what remains is no shell.
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
            let remark = format!(
                "this body reaches {reach_mm:.1} mm below its dishes, like an insert in one piece with its tray or stem; it \
                 is cut at the ledge at y = {height_mm:.2} mm, which leaves {below_dishes_mm:.2} mm of polyethylene below the \
                 dishes; write clip_below_mm = {height_mm:.2} in [insert] if that is right, or the right height"
            );
            warnings.push(BuildWarning::mesh(file, remark));
            cut_at(shell, height_mm).map_err(|error| BuildError::shell(file.path(), &error))
        }
        Underside::Unclear {
            reach_mm,
            plate_mm,
            ledges_mm,
        } => {
            let heights = heights_to_write(plate_mm, &ledges_mm);
            let message = format!(
                "this body reaches {reach_mm:.1} mm below its dishes, like an insert in one piece with its tray or stem, \
                 and its shape does not show for certain where the polyethylene ends; write [insert] {heights}"
            );
            let keys = &["clip_below_mm", "file"];
            Err(BuildError::mesh(file.path(), keys, message))
        }
    }
}

/// Returns the insert of a construct above a height, mm, with the parts of the file that were omitted before.
pub(in crate::case) fn cut_at(
    whole: CheckedMesh,
    height_mm: f64,
) -> Result<CheckedMesh, RepairError> {
    let CheckedMesh { mesh, left_out, .. } = whole;
    let cut = checks_of(Body::Insert, Some(height_mm)).check(mesh)?;
    Ok(CheckedMesh { left_out, ..cut })
}

/// Rounds a height to the next hundredth of a millimetre, so that nothing of the plate is left.
pub(in crate::case) fn rounded_up(height_mm: f64) -> f64 {
    // Adding zero turns -0 into 0.
    (height_mm * PER_MM - ROUNDING).ceil() / PER_MM + 0.0
}

/// Lists the heights to choose from; without a ledge, that of a usual plate.
pub(in crate::case) fn heights_to_write(plate_mm: f64, ledges_mm: &[f64]) -> String {
    /// Usual thickness of a tray's plate, mm, as a hint.
    const USUAL_PLATE_MM: f64 = 4.0;
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
    fn heights_are_rounded_up_to_the_reported_digits() {
        assert_eq!(rounded_up(-9.0), -9.0);
        assert_eq!(rounded_up(-8.999_999_999_9), -9.0);
        assert_eq!(rounded_up(-8.9987), -8.99);
        assert_eq!(rounded_up(0.5), 0.5);
    }

    #[test]
    fn heights_to_write_are_lines_of_the_case() {
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
