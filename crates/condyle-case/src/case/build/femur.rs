//! The femur of a case, and its triangles for pictures and other programs.

use std::path::Path;
use std::sync::Arc;

use condyle::Vec3;
use condyle::evolve::WearTest;
use condyle::geometry::{
    Cylinder, FemoralSurface, GenericFemur, GenericFemurShape, PlacedFemur, SmoothField,
    TriangleMesh, posterior_arc_centre_mm,
};
use condyle_mesh::repair::CheckedMesh;
use serde::{Deserialize, Serialize};

use super::super::contents::Case;
use super::super::femur::{Femur, FemurPlacement, FemurShape, MeshFemur};
use super::super::frame::Side;
use super::super::run_options::Limits;
use super::error::{Body, BuildError, BuildWarning, MeshFault};
use super::meshes::{Placing, ShellOf, parsed_shell, shell, warn};
use super::orientation_check::{check_orientation, check_side};
use super::rigid_motion::RigidMotion;
use crate::cache::{Keep, kept};
use condyle_mesh::formats::surface_bytes;

/// A femoral surface with its flexion axis and the start of that axis over the insert.
pub(super) struct BuiltFemur {
    pub surface: Arc<FemoralSurface>,
    /// (x, y) in the femoral frame.
    pub flexion_axis_mm: (f64, f64),
    /// (x, z) of the flexion axis in the insert frame.
    pub start_mm: (f64, f64),
}

/// Options of the one-time work on a mesh.
#[derive(Clone, Copy)]
pub(super) struct Preparing<'a> {
    pub threads: usize,
    pub keep: &'a dyn Keep,
    pub limits: &'a Limits,
}

impl Femur {
    /// Builds the femur, which starts the cycle flexed by `flexion_rad`.
    pub(super) fn build(
        &self,
        side: Side,
        flexion_rad: f64,
        preparing: Preparing<'_>,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<BuiltFemur, BuildError> {
        let placement = &self.placement;
        let start = |start: Option<[f64; 2]>| start.map(|start| on_the_right(start, side));
        Ok(match &self.shape {
            FemurShape::Generic(femur) => {
                let shape = GenericFemurShape {
                    distal_radius_mm: femur.distal_radius_mm,
                    posterior_radius_mm: femur.posterior_radius_mm,
                    transition_deg: femur.transition_deg,
                    coronal_radius_mm: femur.coronal_radius_mm,
                    spacing_mm: femur.spacing_mm,
                };
                BuiltFemur {
                    surface: Arc::new(placed(
                        GenericFemur::new(shape),
                        placement.motion((0.0, 0.0)),
                    )),
                    flexion_axis_mm: (0.0, 0.0),
                    start_mm: start(femur.start_mm).unwrap_or(over_the_dish(&shape, flexion_rad)),
                }
            }
            FemurShape::Sphere(femur) => BuiltFemur {
                surface: Arc::new(FemoralSurface::sphere(femur.radius_mm)),
                flexion_axis_mm: (0.0, 0.0),
                start_mm: start(femur.start_mm).unwrap_or((0.0, 0.0)),
            },
            FemurShape::Cylinder(femur) => BuiltFemur {
                surface: Arc::new(FemoralSurface::Cylinder(Cylinder {
                    radius_mm: femur.radius_mm,
                })),
                flexion_axis_mm: (0.0, 0.0),
                start_mm: start(femur.start_mm).unwrap_or((0.0, 0.0)),
            },
            FemurShape::Mesh(femur) => {
                let prepared = femur.prepared(placement, side, preparing)?;
                warn(&femur.file, &prepared.shell, warnings);
                femur.check_orientation(&prepared.shell.mesh, side, warnings)?;
                femur.over_the_insert(prepared, side, flexion_rad)
            }
        })
    }
}

impl MeshFemur {
    /// Returns its triangles as a checked shell in the femoral frame of a right knee, mm.
    pub(crate) fn triangles(
        &self,
        placement: &FemurPlacement,
        side: Side,
    ) -> Result<TriangleMesh, BuildError> {
        let placing = Placing::new(self.length_unit, &self.axes, side)?;
        let mesh = shell(&self.file, &placing, ShellOf::FEMUR, &mut Vec::new())?.mesh;
        Ok(self.moved(mesh, placement))
    }

    /// Checks the orientation of the component by its shape; `mesh` is in the frame of its file.
    fn check_orientation(
        &self,
        mesh: &TriangleMesh,
        side: Side,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<(), BuildError> {
        let placing = Placing::new(self.length_unit, &self.axes, side)?;
        if check_orientation(Body::Femur, &self.file, mesh, &placing, warnings)? {
            check_side(&self.file, mesh, side, warnings);
        }
        Ok(())
    }

    /// Returns the flexion axis (x, y) of the unplaced component.
    fn axis_mm(&self, mesh: &TriangleMesh) -> (f64, f64) {
        match self.flexion_axis_mm {
            Some([x, y]) => (x, y),
            None => posterior_arc_centre_mm(mesh),
        }
    }

    fn moved(&self, mesh: TriangleMesh, placement: &FemurPlacement) -> TriangleMesh {
        match placement.motion(self.axis_mm(&mesh)) {
            Some(motion) => motion.mesh(mesh),
            None => mesh,
        }
    }

    /// Returns bytes that identify a placement; `None` if it moves nothing.
    fn placement_bytes(&self, placement: &FemurPlacement) -> Option<Vec<u8>> {
        let axis = self.flexion_axis_mm.into_iter().flatten();
        let numbers = placement.numbers().into_iter().chain(axis);
        let bytes = || numbers.flat_map(f64::to_le_bytes).collect();
        placement.is_moved().then(bytes)
    }

    /// Returns the unplaced shell and the field of the placed one, computed or kept from an earlier run.
    fn prepared(
        &self,
        placement: &FemurPlacement,
        side: Side,
        preparing: Preparing<'_>,
    ) -> Result<PreparedFemur, BuildError> {
        let placing = Placing::new(self.length_unit, &self.axes, side)?;
        let path = self.file.path();
        let bytes = surface_bytes(self.file.files(), path)?;
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let (placing_bytes, placed) = (placing.bytes(), self.placement_bytes(placement));
        let mut inputs = vec![ending.as_encoded_bytes(), &placing_bytes, &bytes];
        inputs.extend(placed.as_deref());
        kept(preparing.keep, "femur", &inputs, || {
            let shell = parsed_shell(path, &bytes, &placing, ShellOf::FEMUR)?;
            let mesh = self.moved(shell.mesh.clone(), placement);
            check_node_count(path, &mesh, preparing.limits)?;
            let field = SmoothField::new(&mesh, preparing.threads);
            Ok(PreparedFemur { shell, field })
        })
    }

    fn over_the_insert(&self, prepared: PreparedFemur, side: Side, flexion_rad: f64) -> BuiltFemur {
        let flexion_axis_mm = self.axis_mm(&prepared.shell.mesh);
        let (x, z) = on_the_right(self.start_mm.unwrap_or_default(), side);
        BuiltFemur {
            surface: Arc::new(FemoralSurface::Mesh(prepared.field)),
            flexion_axis_mm,
            start_mm: (x + axis_ahead_mm(flexion_axis_mm, flexion_rad), z),
        }
    }
}

fn placed(femur: GenericFemur, motion: Option<RigidMotion>) -> FemoralSurface {
    match motion {
        Some(motion) => {
            FemoralSurface::Placed(PlacedFemur::new(femur, motion.rotation, motion.shift_mm))
        }
        None => FemoralSurface::Generic(femur),
    }
}

/// Mirrors a place [x, z] of the insert frame of a left knee.
fn on_the_right([x, z]: [f64; 2], side: Side) -> (f64, f64) {
    match side {
        Side::Right => (x, z),
        Side::Left => (x, -z),
    }
}

/// Returns the place of the frame for which the centre of the distal arc is over x = 0.
///
/// That centre lies (distal - posterior radius) from the origin, opposite to the transition.
fn over_the_dish(shape: &GenericFemurShape, flexion_rad: f64) -> (f64, f64) {
    let to_centre_mm = shape.distal_radius_mm - shape.posterior_radius_mm;
    let anterior_rad = shape.transition_deg.to_radians() - flexion_rad;
    (-to_centre_mm * anterior_rad.sin(), 0.0)
}

/// The one-time work on a mesh femur.
#[derive(Serialize, Deserialize)]
struct PreparedFemur {
    shell: CheckedMesh,
    field: SmoothField,
}

fn check_node_count(file: &Path, mesh: &TriangleMesh, limits: &Limits) -> Result<(), BuildError> {
    let nodes = SmoothField::node_count(mesh);
    let most = limits.most(Limits::BYTES_OF_FIELD_NODE);
    if nodes <= most {
        return Ok(());
    }
    let memory_gb = limits.memory_gb;
    let fault = MeshFault::TooManyNodes {
        nodes,
        most,
        memory_gb,
    };
    Err(BuildError::mesh(file, fault))
}

/// Returns the distance of the flexion axis anterior of the frame's origin, in the insert frame.
fn axis_ahead_mm(flexion_axis_mm: (f64, f64), flexion_rad: f64) -> f64 {
    let axis = Vec3::new(flexion_axis_mm.0, flexion_axis_mm.1, 0.0);
    let (sine, cosine) = flexion_rad.sin_cos();
    axis.x * cosine - axis.y * sine
}

/// Number of triangles for a femur that is not a mesh, as in Knight 2007: they lie within a hundredth of a millimetre
/// of its surface.
pub const FEMUR_TRIANGLES: f64 = 25_000.0;
const ICOSAHEDRON: f64 = 20.0;

impl Case {
    /// Returns the surface of the femur of `test`, which this case built, in the femoral frame of a right knee, mm;
    /// triangles anticlockwise seen from outside. A mesh has its own triangles; other shapes get about `about`.
    ///
    /// # Errors
    /// A mesh that cannot be read again.
    pub fn femur_triangles(&self, test: &WearTest, about: f64) -> Result<TriangleMesh, BuildError> {
        match (&self.femur.shape, test.femur.as_ref()) {
            (FemurShape::Mesh(femur), _) => {
                femur.triangles(&self.femur.placement, self.heading.side)
            }
            (_, FemoralSurface::Generic(femur)) => Ok(generic(femur, about)),
            (_, FemoralSurface::Placed(placed)) => {
                Ok(generic(placed.femur(), about).mapped(|point| placed.to_frame(point)))
            }
            (FemurShape::Sphere(ball), _) => Ok(sphere(ball.radius_mm, about)),
            (FemurShape::Cylinder(cylinder), _) => Ok(tube(cylinder.radius_mm)),
            (FemurShape::Generic(_), _) => {
                unreachable!("a generic femur is built as one")
            }
        }
    }
}

fn generic(femur: &GenericFemur, about: f64) -> TriangleMesh {
    const COARSE_MM: f64 = 1.0;
    let coarse = femur.surface_mesh(COARSE_MM).triangles.len() as f64;
    femur.surface_mesh(COARSE_MM * (coarse / about).sqrt())
}

/// Returns a tube about the z axis, longer than any insert is wide.
fn tube(radius_mm: f64) -> TriangleMesh {
    const HALF_LENGTH_MM: f64 = 60.0;
    const EDGE_MM: f64 = 1.5;
    let around = (std::f64::consts::TAU * radius_mm / EDGE_MM).ceil() as u32;
    let along = (2.0 * HALF_LENGTH_MM / EDGE_MM).ceil() as u32;
    let mut mesh = TriangleMesh::default();
    for ring in 0..=along {
        let z = HALF_LENGTH_MM * (2.0 * f64::from(ring) / f64::from(along) - 1.0);
        for i in 0..around {
            let (sine, cosine) =
                (std::f64::consts::TAU * f64::from(i) / f64::from(around)).sin_cos();
            let place = Vec3::new(radius_mm * cosine, radius_mm * sine, z);
            mesh.vertices.push(place);
        }
    }
    for ring in 0..along {
        for i in 0..around {
            let (a, b) = (ring * around + i, ring * around + (i + 1) % around);
            let (c, d) = (b + around, a + around);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// Returns a ball about the origin by repeated subdivision of an icosahedron.
fn sphere(radius_mm: f64, about: f64) -> TriangleMesh {
    let halvings = (about / ICOSAHEDRON).log(4.0).round() as usize;
    let mut ball = icosahedron();
    for _ in 0..halvings {
        ball = in_four(&ball, |a, b| (a + b).normalize());
    }
    ball.mapped(|vertex| vertex.normalize() * radius_mm)
}

fn icosahedron() -> TriangleMesh {
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    let mut vertices = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        vertices.extend([
            Vec3::new(0.0, a, b),
            Vec3::new(a, b, 0.0),
            Vec3::new(b, 0.0, a),
        ]);
    }
    let mut triangles = Vec::new();
    for i in 0..12u32 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let corners = [i, j, k].map(|n| vertices[n as usize]);
                if is_face(&corners) {
                    let [a, b, c] = corners;
                    let outward = (b - a).cross(&(c - a)).dot(&a) > 0.0;
                    triangles.push(if outward { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    TriangleMesh {
        vertices,
        triangles,
    }
}

/// Returns true if three corners of the icosahedron, whose edges are 2 long, are neighbours.
fn is_face([a, b, c]: &[Vec3; 3]) -> bool {
    [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(one, other)| ((*one - *other).norm() - 2.0).abs() < 1e-9)
}

/// Divides every triangle in four at its midpoints, which `middle_of` places between two corners.
pub(crate) fn in_four(
    mesh: &TriangleMesh,
    middle_of: impl Fn(&Vec3, &Vec3) -> Vec3,
) -> TriangleMesh {
    let mut vertices = mesh.vertices.clone();
    let mut middles = std::collections::HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push(middle_of(&vertices[a as usize], &vertices[b as usize]));
            vertices.len() as u32 - 1
        })
    };
    let mut triangles = Vec::with_capacity(4 * mesh.triangles.len());
    for &[a, b, c] in &mesh.triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    TriangleMesh {
        vertices,
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn verify_extended_generic_femur_starts_with_its_distal_centre_over_the_dish() {
        let (x, z) = over_the_dish(&GenericFemurShape::default(), -7f64.to_radians());
        // The centre, 16 mm out at 20 degrees, leans 7 degrees further forward.
        assert!((x + 16.0 * 27f64.to_radians().sin()).abs() < 1e-12);
        assert_eq!(z, 0.0);
    }

    #[test]
    fn verify_axis_turns_with_the_femur() {
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!((axis_ahead_mm((3.0, 5.0), 0.0) - 3.0).abs() < 1e-12);
        assert!((axis_ahead_mm((3.0, 5.0), quarter) + 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_left_start_is_mirrored() {
        assert_eq!(on_the_right([1.0, 2.0], Side::Left), (1.0, -2.0));
    }

    #[test]
    fn verify_the_ball_is_closed_faces_out_and_has_its_volume() {
        let ball = sphere(24.0, 25_000.0);
        assert_eq!(
            (ball.triangles.len(), ball.vertices.len()),
            (20_480, 10_242)
        );
        let exact = 4.0 / 3.0 * PI * 24f64.powi(3);
        let volume = ball.signed_volume();
        assert!((volume / exact - 1.0).abs() < 1e-3, "{volume} {exact}");
    }

    #[test]
    fn verify_the_tube_faces_out_and_has_the_radius() {
        let tube = tube(20.0);
        for triangle in 0..tube.triangles.len() {
            let [a, b, c] = tube.corners(triangle);
            let outward = Vec3::new(a.x, a.y, 0.0);
            assert!((outward.norm() - 20.0).abs() < 1e-9);
            assert!((b - a).cross(&(c - a)).dot(&outward) > 0.0);
        }
    }
}
