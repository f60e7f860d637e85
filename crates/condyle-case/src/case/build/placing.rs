//! Placement of components: from the unit and axes of a file to the frame of a right knee, mm, and the rigid motions of
//! the case; triangles of a file as a checked shell in that frame.

use std::path::Path;

use condyle::anatomy::Orientation;
use condyle::geometry::{Dishes, TriangleMesh};
use condyle::{Mat3, Vec3};
use condyle_mesh::formats::{parse_surface, surface_bytes};
use condyle_mesh::repair::{
    CheckedMesh, Checks, Defect, LeftOut, Parts, RepairError, Touching, WhyLeftOut,
};

use super::error::{Body, BuildError, BuildWarning, Finding};
use super::size::{check_triangles, stray_piece};
use crate::case::femur::FemurPlacement;
use crate::case::frame::{Axes, FileFrame, LengthUnit, Side};
use crate::case::insert::{InsertOrigin, InsertPlacement};
use crate::config::DataFile;

/// Map from the unit and axes of a file to mm, x anterior, y superior, z to the right of a right knee.
pub(super) struct Placing {
    pub unit: LengthUnit,
    axes: Mat3,
    linear: Mat3,
    /// The place of the origin after the linear part.
    origin_mm: Option<Vec3>,
    /// A left knee is mirrored, and its faces are turned round.
    pub mirrors: bool,
}

impl Placing {
    /// Creates the map of a file whose point `origin_mm` becomes the origin; without one, its own origin stays.
    pub(super) fn new(
        frame: &FileFrame,
        origin_mm: Option<[f64; 3]>,
        side: Side,
    ) -> Result<Self, BuildError> {
        let (unit, axes) = (frame.length_unit, frame.axes.rotation(side));
        let axes = axes.map_err(|why| BuildError::new(&["axes"], format!("`axes`: {why}")))?;
        let axes = match frame.rotation_deg {
            Some([x, y, z]) => rotation(z, x, y) * axes,
            None => axes,
        };
        let mirrors = side == Side::Left;
        let linear = mirror(mirrors) * (axes * unit.in_mm());
        let origin_mm = origin_mm.map(|origin| mirror(mirrors) * Vec3::from(origin));
        Ok(Self {
            unit,
            axes,
            linear,
            origin_mm,
            mirrors,
        })
    }

    /// Returns the rotation of a file whose body must be turned by `turn` after this placing.
    pub(super) fn rotation_turned(&self, turn: &Mat3) -> Mat3 {
        // The turn holds in the mirrored frame: it is mirrored back before it meets the axes of the file.
        let mirror = mirror(self.mirrors);
        mirror * turn * mirror * self.axes
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let numbers = self.linear.iter().chain(self.origin_mm.iter().flatten());
        numbers.flat_map(|entry| entry.to_le_bytes()).collect()
    }

    pub(super) fn point(&self, point: &Vec3) -> Vec3 {
        let point = self.linear * point;
        self.origin_mm.map_or(point, |origin| point - origin)
    }

    /// Returns a place of the computed frame in the frame of the results.
    pub(super) fn mirrored(&self, place: &Vec3) -> Vec3 {
        mirror(self.mirrors) * place
    }

    pub(super) fn mesh(&self, mesh: TriangleMesh) -> TriangleMesh {
        let mut placed = mesh.mapped(|vertex| self.point(vertex));
        if self.mirrors {
            turn_round(&mut placed);
        }
        placed
    }
}

fn mirror(mirrors: bool) -> Mat3 {
    Mat3::from_diagonal(&Vec3::new(1.0, 1.0, if mirrors { -1.0 } else { 1.0 }))
}

fn turn_round(mesh: &mut TriangleMesh) {
    mesh.triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(1, 2));
}

/// Returns the checks of a body's mesh.
pub(in crate::case) fn checks_of(body: Body, clip_below_mm: Option<f64>) -> Checks {
    let (touching, parts) = match body {
        Body::Femur => (Touching::FromBelowAndBehind, Parts::All),
        Body::Insert => (Touching::FromAbove, Parts::SeenFromAbove),
    };
    Checks {
        touching,
        parts,
        clip_below_mm,
    }
}

/// Reads a surface, checks it and turns it to face out; adds a warning for each repair.
pub(super) fn shell(
    file: &DataFile,
    placing: &Placing,
    checks: Checks,
    warnings: &mut Vec<BuildWarning>,
) -> Result<CheckedMesh, BuildError> {
    let bytes = surface_bytes(file.files(), file.path())?;
    let shell = parsed_shell(file.path(), &bytes, placing, checks)?;
    warn(file, &shell, &shell.mesh, warnings);
    Ok(shell)
}

/// As [`shell`], from the bytes of the file and without warnings.
pub(super) fn parsed_shell(
    file: &Path,
    bytes: &[u8],
    placing: &Placing,
    checks: Checks,
) -> Result<CheckedMesh, BuildError> {
    let mesh = placing.mesh(parse_surface(file, bytes)?);
    check_triangles(file, &mesh, placing.unit)?;
    let (low_mm, high_mm) = (mesh.bounds().0.y, mesh.bounds().1.y);
    if let Some(height_mm) = checks.clip_below_mm
        && (height_mm <= low_mm || height_mm >= high_mm)
    {
        let message = format!(
            "`clip_below_mm` = {height_mm} removes nothing or everything: with its axes turned, the body reaches from \
             y = {low_mm:.2} mm to {high_mm:.2} mm"
        );
        return Err(BuildError::mesh(file, &["clip_below_mm"], message));
    }
    let mut shell = checked(
        file,
        (&mesh, &|place| placing.mirrored(place)),
        &mesh,
        checks,
    )?;
    // A closed shell shows its inside; an open one must face the other body.
    let must_face_up = checks.touching == Touching::FromAbove;
    if !shell.closed && faces_up(&shell.mesh) != must_face_up {
        turn_round(&mut shell.mesh);
        shell.turned_round = true;
    }
    Ok(shell)
}

/// Checks a mesh in place; the noise of the scan from which it was made is named before the crossings that it causes. `in_results`
/// returns a place of the mesh in the frame of the results, or of its file.
pub(in crate::case) fn checked(
    file: &Path,
    (mesh, in_results): (&TriangleMesh, &dyn Fn(&Vec3) -> Vec3),
    scan: &TriangleMesh,
    checks: Checks,
) -> Result<CheckedMesh, BuildError> {
    let mut checked = checks.check(mesh.clone());
    let (defects, left_out) = match &mut checked {
        Ok(shell) => (&mut shell.defects[..], &mut shell.left_out[..]),
        Err(RepairError::Defects { defects }) => (&mut defects[..], &mut [][..]),
        Err(RepairError::Empty) => (&mut [][..], &mut [][..]),
    };
    let defects = defects.iter_mut().flat_map(|defect| &mut defect.places_mm);
    let places = defects.chain(left_out.iter_mut().map(|part| &mut part.at_mm));
    places.for_each(|place| *place = in_results(place));
    checked.map_err(|error| match noise(scan) {
        Some((_, noise)) => {
            BuildError::mesh(file, &["file"], format_args!("{noise}; as it is, {error}"))
        }
        None => BuildError::shell(file, &error),
    })
}

/// Largest noise of a scan of an implant, mm: beyond it, coarse facets scatter.
const MAX_NOISE_MM: f64 = 0.3;

/// Returns the noise of a mesh, mm, and its description.
fn noise(mesh: &TriangleMesh) -> Option<(f64, String)> {
    let scatter_mm = mesh.scatter_mm()?;
    let limit_mm = BuildWarning::MAX_SCATTER_MM;
    (limit_mm..MAX_NOISE_MM).contains(&scatter_mm).then(|| {
        let text = format!(
            "its vertices scatter by about {scatter_mm:.3} mm around a smooth surface, as after a scan or decimation, and up to \
             {limit_mm} mm is acceptable; the highest pressure is unreliable: smooth the mesh, or use the body from CAD"
        );
        (scatter_mm, text)
    })
}

/// Adds a warning for each repair of a file, and for each suspicious property; the noise is that of `scan`.
pub(super) fn warn(
    file: &DataFile,
    shell: &CheckedMesh,
    scan: &TriangleMesh,
    warnings: &mut Vec<BuildWarning>,
) {
    if let Some(piece) = stray_piece(&shell.mesh) {
        let remark = format!("{}; delete it unless it belongs to the body", piece.text);
        warnings.push(BuildWarning::mesh(file, remark).with(Finding::StrayPiece));
    }
    if let Some((scatter_mm, remark)) = noise(scan) {
        warnings.push(BuildWarning::mesh(file, remark).with(Finding::Scatter(scatter_mm)));
    }
    let mut remarks = Vec::new();
    if !shell.left_out.is_empty() {
        let parts = parts_listed(&shell.left_out);
        remarks.push(format!(
            "removed, since they are not part of the insert: {parts}"
        ));
    }
    if shell.turned_round {
        remarks.push("the triangles faced inwards and were reversed".to_owned());
    }
    let counted = [
        (
            shell.made_consistent,
            "triangles were reversed to match their neighbours",
        ),
        (
            shell.wrinkles,
            "pairs of neighbouring triangles cross slightly; they are kept",
        ),
        (
            shell.removed_degenerate,
            "triangles without area were removed",
        ),
    ];
    let counted = counted.into_iter().filter(|(count, _)| *count > 0);
    remarks.extend(counted.map(|(count, what)| format!("{count} {what}")));
    if !shell.defects.is_empty() {
        let listed = |defect: &Defect| defect.listed_with_repair(3);
        let defects: Vec<String> = shell.defects.iter().map(listed).collect();
        remarks.push(format!(
            "defects that do not affect the contact: {}",
            defects.join("; ")
        ));
    }
    warnings.extend(
        remarks
            .iter()
            .map(|remark| BuildWarning::mesh(file, remark)),
    );
}

/// Lists the first parts, each with its size, its place and the reason.
fn parts_listed(parts: &[LeftOut]) -> String {
    const MAX_LISTED: usize = 5;
    let listed = parts.iter().take(MAX_LISTED).map(|part| {
        let why = match part.why {
            WhyLeftOut::Below => "below it",
            WhyLeftOut::Speck => "next to it",
        };
        let ([x, y, z], [long, high, wide]) = (part.at_mm.into(), part.size_mm.into());
        format!(
            "{} triangles {why} around ({x:.1}, {y:.1}, {z:.1}) mm, {long:.1} mm long, {high:.1} mm high and {wide:.1} mm wide",
            part.triangles
        )
    });
    let more = parts.len().checked_sub(MAX_LISTED).filter(|more| *more > 0);
    let more = more.map(|more| format!("{more} more"));
    listed.chain(more).collect::<Vec<_>>().join("; ")
}

/// Returns true if most of the surface faces up, by its area seen from above.
fn faces_up(mesh: &TriangleMesh) -> bool {
    let upward = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle);
        (b - a).cross(&(c - a)).y
    };
    // An open surface has no inside; areas seen from above weigh a rim that curls over little.
    (0..mesh.triangles.len()).map(upward).sum::<f64>() > 0.0
}

/// A rigid motion, p' = R p + t.
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidMotion {
    pub rotation: Mat3,
    pub shift_mm: Vec3,
}

impl RigidMotion {
    pub(super) fn point(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.shift_mm
    }

    pub(super) fn mesh(&self, mesh: TriangleMesh) -> TriangleMesh {
        mesh.mapped(|vertex| self.point(vertex))
    }
}

impl InsertPlacement {
    /// Returns the rotation about the origin, Ry(rotation) Rx(-tilt) Rz(slope).
    pub(super) fn rotation(&self) -> Mat3 {
        rotation(
            self.posterior_slope_deg,
            -self.coronal_tilt_deg,
            self.axial_rotation_deg,
        )
    }

    /// Returns the motion of an insert whose dishes have their middle at `middle_mm`; `None` for no motion.
    pub(super) fn motion(&self, middle_mm: impl FnOnce() -> Vec3) -> Option<RigidMotion> {
        let origin_mm = match self.origin {
            InsertOrigin::File => Vec3::zeros(),
            InsertOrigin::Centre => middle_mm(),
        };
        let rotation = self.rotation();
        let moves = self.is_turned() || self.origin == InsertOrigin::Centre;
        moves.then(|| RigidMotion {
            rotation,
            shift_mm: -(rotation * origin_mm),
        })
    }
}

impl FemurPlacement {
    /// Returns the motion of a component that flexes about `axis_mm`, (x, y) of the femoral frame, which only a motion needs; `None`
    /// for no motion.
    ///
    /// A component moves on its bone in the direction opposite to that of the bone over the component: Ry(-external)
    /// Rx(varus) Rz(-flexion).
    pub(super) fn motion(&self, axis_mm: impl FnOnce() -> (f64, f64)) -> Option<RigidMotion> {
        if !self.is_moved() {
            return None;
        }
        let (x, y) = axis_mm();
        let rotation = rotation(
            -self.flexion_deg,
            self.varus_deg,
            -self.external_rotation_deg,
        );
        let shift_mm = Vec3::new(
            self.anterior_offset_mm,
            self.superior_offset_mm,
            self.lateral_offset_mm,
        );
        let about_mm = Vec3::new(x, y, 0.0);
        let shift_mm = about_mm - rotation * about_mm + shift_mm;
        Some(RigidMotion { rotation, shift_mm })
    }
}

pub(in crate::case) struct WrittenRotation {
    pub axes: Axes,
    /// None for a rotation that the axes describe.
    pub rotation_deg: Option<[f64; 3]>,
}

impl WrittenRotation {
    /// Describes a rotation to a hundredth of a degree.
    pub(in crate::case) fn of(rotation: &Mat3) -> Self {
        let nearest = Orientation::nearest_to(rotation).rotation();
        let angles = angles_deg(&(rotation * nearest.transpose()));
        // Adding zero turns -0 into 0.
        let angles = angles.map(|angle| (angle * PER_DEGREE).round() / PER_DEGREE + 0.0);
        Self {
            axes: Axes::of(&nearest),
            rotation_deg: (angles != [0.0; 3]).then_some(angles),
        }
    }

    /// Returns the rotation that is written.
    pub(in crate::case) fn rotation(&self) -> Mat3 {
        // The words of an orientation do not depend on the side, and are right-handed.
        let axes = self
            .axes
            .rotation(Side::Right)
            .unwrap_or_else(|_| Mat3::identity());
        match self.rotation_deg {
            Some([x, y, z]) => rotation(z, x, y) * axes,
            None => axes,
        }
    }

    pub(in crate::case) fn lines(&self) -> String {
        let [x, y, z] = self.axes.words();
        let axes = format!("axes = [\"{x}\", \"{y}\", \"{z}\"]\n");
        let turn = self
            .rotation_deg
            .map(|[x, y, z]| format!("rotation_deg = [{x:?}, {y:?}, {z:?}]\n"));
        axes + &turn.unwrap_or_default()
    }
}

/// Steps of written angles in a degree.
const PER_DEGREE: f64 = 100.0;

/// Returns the angles about x, y and z, degrees, of a rotation about the fixed axes z, x, y, in this order.
fn angles_deg(rotation: &Mat3) -> [f64; 3] {
    let x = (-rotation[(1, 2)]).clamp(-1.0, 1.0).asin();
    let y = rotation[(0, 2)].atan2(rotation[(2, 2)]);
    let z = rotation[(1, 0)].atan2(rotation[(1, 1)]);
    [x, y, z].map(f64::to_degrees)
}

/// Returns the rotation about the fixed axes z, x, y, in this order.
fn rotation(about_z_deg: f64, about_x_deg: f64, about_y_deg: f64) -> Mat3 {
    let (sz, cz) = about_z_deg.to_radians().sin_cos();
    let (sx, cx) = about_x_deg.to_radians().sin_cos();
    let (sy, cy) = about_y_deg.to_radians().sin_cos();
    let about_z = Mat3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0);
    let about_x = Mat3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx);
    let about_y = Mat3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy);
    about_y * about_x * about_z
}

/// Returns the midpoint between the dishes of an insert of triangles; the origin if it has none.
pub(in crate::case) fn middle_of_mesh(mesh: &TriangleMesh) -> Vec3 {
    /// Spacing of the points among which the dishes are searched, mm.
    const SPACING_MM: f64 = 0.5;
    /// Cosine of the steepest part of a surface; a point on a wall that is not quite vertical would be lower than any dish.
    const STEEPEST: f64 = 0.1;
    let is_wall = |[a, b, c]: [Vec3; 3]| {
        let normal = (b - a).cross(&(c - a));
        normal.y.abs() < STEEPEST * normal.norm()
    };
    let mut surface = mesh.clone();
    let triangles = 0..mesh.triangles.len();
    let kept = triangles.filter(|&triangle| !is_wall(mesh.corners(triangle)));
    surface.triangles = kept.map(|triangle| mesh.triangles[triangle]).collect();
    middle_of_points(&surface.seen_from_above(SPACING_MM))
}

pub(super) fn middle_of_points(points: &[Vec3]) -> Vec3 {
    Dishes::find(points).map_or(Vec3::zeros(), |dishes| dishes.middle_mm())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: InsertPlacement = InsertPlacement {
        origin: InsertOrigin::File,
        posterior_slope_deg: 0.0,
        coronal_tilt_deg: 0.0,
        axial_rotation_deg: 0.0,
    };
    const ON_BONE: FemurPlacement = FemurPlacement {
        flexion_deg: 0.0,
        varus_deg: 0.0,
        external_rotation_deg: 0.0,
        anterior_offset_mm: 0.0,
        superior_offset_mm: 0.0,
        lateral_offset_mm: 0.0,
    };

    fn insert(placement: &InsertPlacement, point: Vec3) -> Vec3 {
        placement
            .motion(Vec3::zeros)
            .expect("it moves")
            .point(&point)
    }

    fn femur(placement: &FemurPlacement, point: Vec3) -> Vec3 {
        let motion = placement.motion(|| (1.0, 2.0)).expect("it moves");
        motion.point(&(point + Vec3::new(1.0, 2.0, 0.0))) - Vec3::new(1.0, 2.0, 0.0)
    }

    #[test]
    fn verify_signs_of_the_insert() {
        let slope = InsertPlacement {
            posterior_slope_deg: 3.0,
            ..NONE
        };
        assert!(insert(&slope, -Vec3::x()).y < 0.0);
        let varus = InsertPlacement {
            coronal_tilt_deg: 3.0,
            ..NONE
        };
        assert!(insert(&varus, -Vec3::z()).y < 0.0);
        let internal = InsertPlacement {
            axial_rotation_deg: 3.0,
            ..NONE
        };
        assert!(insert(&internal, Vec3::x()).z < 0.0);
    }

    #[test]
    fn verify_signs_of_the_femur() {
        let flexed = FemurPlacement {
            flexion_deg: 3.0,
            ..ON_BONE
        };
        assert!(femur(&flexed, Vec3::y()).x > 0.0);
        let varus = FemurPlacement {
            varus_deg: 3.0,
            ..ON_BONE
        };
        assert!(femur(&varus, Vec3::z()).y < 0.0);
        let external = FemurPlacement {
            external_rotation_deg: 3.0,
            ..ON_BONE
        };
        assert!(femur(&external, Vec3::x()).z > 0.0);
        let shifted = FemurPlacement {
            lateral_offset_mm: 3.0,
            ..ON_BONE
        };
        assert_eq!(femur(&shifted, Vec3::zeros()), Vec3::new(0.0, 0.0, 3.0));
    }

    #[test]
    fn slope_comes_before_rotation() {
        let both = InsertPlacement {
            posterior_slope_deg: 5.0,
            axial_rotation_deg: 90.0,
            ..NONE
        };
        // The front rises by the slope and then lies where internal rotation takes it.
        let front = insert(&both, Vec3::x());
        let (sine, cosine) = 5f64.to_radians().sin_cos();
        assert!((front - Vec3::new(0.0, sine, -cosine)).norm() < 1e-12);
    }

    #[test]
    fn the_centre_becomes_the_origin_whatever_the_turn() {
        let centred = InsertPlacement {
            origin: InsertOrigin::Centre,
            coronal_tilt_deg: 4.0,
            ..NONE
        };
        let middle = Vec3::new(4.0, 30.0, -5.0);
        let motion = centred.motion(|| middle).expect("it moves");
        assert!(motion.point(&middle).norm() < 1e-12);
        assert!(NONE.motion(|| middle).is_none() && ON_BONE.motion(|| (0.0, 0.0)).is_none());
    }

    #[test]
    fn verify_a_left_knee_becomes_its_mirror_image() {
        let frame = FileFrame {
            length_unit: LengthUnit::Metre,
            axes: Axes::ISB,
            rotation_deg: None,
        };
        let placing = Placing::new(&frame, None, Side::Left).unwrap();
        let placed = placing.point(&Vec3::new(0.001, 0.002, 0.003));
        assert!((placed - Vec3::new(1.0, 2.0, -3.0)).norm() < 1e-12);
        let mesh = TriangleMesh {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::z()],
            triangles: vec![[0, 2, 1]],
        };
        assert!(faces_up(&mesh) && faces_up(&placing.mesh(mesh)));
    }
}
