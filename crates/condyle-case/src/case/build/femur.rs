//! The femur of a case, and its triangles for pictures and other programs.

use std::f64::consts::TAU;
use std::sync::Arc;

use condyle::Vec3;
use condyle::evolve::WearTest;
use condyle::geometry::{
    Counterface, Cylinder, FittedArc, GenericFemur, GenericFemurShape, PlacedFemur, SmoothField,
    TriangleMesh,
};
use condyle::machine::TestedJoint;
use condyle_mesh::formats::surface_bytes;
use condyle_mesh::repair::CheckedMesh;
use condyle_mesh::{FittedSphere, Roundness};
use condyle_results::point_on_side;
use serde::{Deserialize, Serialize};

use super::checks::check_side;
use super::error::{Body, BuildError, BuildWarning};
use super::placing::{Placing, checks_of, parsed_shell, shell, warn};
use crate::cache::{Keep, kept};
use crate::case::contents::Case;
use crate::case::femur::{FemurPlacement, FemurShape, MeshFemur};
use crate::case::frame::Side;
use crate::case::run_options::Limits;

/// A femoral surface with its flexion axis and the start of that axis over the insert.
pub(super) struct BuiltFemur {
    pub surface: Arc<Counterface>,
    /// (x, y) in the femoral frame.
    pub flexion_axis_mm: (f64, f64),
    /// Radius of its ball or socket, which is fitted to a mesh.
    pub ball_radius_mm: Option<f64>,
    /// Origin of the axes of a mesh without a fitted arc, in words.
    pub axes: Option<String>,
    /// (x, z) of the flexion axis in the insert frame.
    pub start_mm: (f64, f64),
}

/// The one-time work on a mesh femur.
#[derive(Serialize, Deserialize)]
struct PreparedFemur {
    shell: CheckedMesh,
    field: SmoothField,
}

impl Case {
    /// Builds the counterface of a machine for `joint`, which starts the cycle flexed by `flexion_rad`; `threads` share the work
    /// on a mesh.
    pub(super) fn built_femur(
        &self,
        joint: TestedJoint,
        flexion_rad: f64,
        threads: usize,
        keep: &dyn Keep,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<BuiltFemur, BuildError> {
        let (side, placement) = (self.side_in_frame(), &self.femur.placement);
        let at_origin = |surface, start_mm: Option<[f64; 2]>, default_mm| BuiltFemur {
            surface: Arc::new(surface),
            flexion_axis_mm: (0.0, 0.0),
            ball_radius_mm: None,
            axes: None,
            start_mm: start_mm.map_or(default_mm, |start| on_the_right(start, side)),
        };
        Ok(match &self.femur.shape {
            FemurShape::Generic(femur) => {
                let generic = GenericFemur::new(femur.shape);
                let surface = match placement.motion(|| (0.0, 0.0)) {
                    Some(motion) => Counterface::Placed(PlacedFemur::new(
                        generic,
                        motion.rotation,
                        motion.shift_mm,
                    )),
                    None => Counterface::Generic(generic),
                };
                let over_the_dish_mm = over_the_dish(&femur.shape, flexion_rad);
                at_origin(surface, femur.start_mm, over_the_dish_mm)
            }
            FemurShape::Sphere(femur) => {
                let surface = Counterface::sphere(femur.radius_mm);
                BuiltFemur {
                    ball_radius_mm: Some(femur.radius_mm),
                    ..at_origin(surface, femur.start_mm, (0.0, 0.0))
                }
            }
            FemurShape::Cylinder(femur) => {
                let radius_mm = femur.radius_mm;
                let surface = Counterface::Cylinder(Cylinder { radius_mm });
                at_origin(surface, femur.start_mm, (0.0, 0.0))
            }
            FemurShape::Plane => at_origin(Counterface::Plane, None, (0.0, 0.0)),
            FemurShape::Mesh(femur) => {
                return self.built_mesh(femur, (joint, flexion_rad), threads, keep, warnings);
            }
        })
    }

    fn built_mesh(
        &self,
        femur: &MeshFemur,
        (joint, flexion_rad): (TestedJoint, f64),
        threads: usize,
        keep: &dyn Keep,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<BuiltFemur, BuildError> {
        let (side, placement) = (self.side_in_frame(), &self.femur.placement);
        let placing = Placing::new(&femur.frame, femur.origin_mm, side)?;
        let PreparedFemur { shell, field } =
            femur.prepared((joint, placement), &placing, &self.limits, threads, keep)?;
        let (file, mesh) = (&femur.file, &shell.mesh);
        warn(file, &shell, mesh, warnings);
        if self.check_orientation(Body::Femur, file, mesh, &placing, warnings)? {
            check_side(file, mesh, side, warnings);
        }
        let ball = ball(joint, mesh);
        let flexion_axis_mm = femur.axis_mm(joint, mesh, ball.as_ref());
        warnings.extend(ball.as_ref().and_then(|ball| femur.off_axes(ball, side)));
        warnings.extend(femur.not_round(joint, mesh));
        let (x, z) = on_the_right(femur.start_mm.unwrap_or_default(), side);
        Ok(BuiltFemur {
            surface: Arc::new(Counterface::Mesh(field)),
            flexion_axis_mm,
            ball_radius_mm: ball.map(|ball| ball.radius_mm),
            axes: femur.axes_in_words(joint, ball.as_ref()),
            start_mm: (x + axis_ahead_mm(flexion_axis_mm, flexion_rad), z),
        })
    }
}

impl MeshFemur {
    /// Returns the flexion axis (x, y) of the unplaced component.
    fn axis_mm(
        &self,
        joint: TestedJoint,
        mesh: &TriangleMesh,
        ball: Option<&FittedSphere>,
    ) -> (f64, f64) {
        if let Some([x, y]) = self.flexion_axis_mm {
            return (x, y);
        }
        match (self.arc(joint, mesh), ball) {
            (Some(arc), _) => arc.centre_mm,
            (None, Some(ball)) => (ball.centre_mm.x, ball.centre_mm.y),
            (None, None) => (0.0, 0.0),
        }
    }

    /// Returns the place that the axes pass through, where it depends on a ball or socket that may not be found.
    fn axes_in_words(&self, joint: TestedJoint, ball: Option<&FittedSphere>) -> Option<String> {
        let is_given = self.flexion_axis_mm.is_some();
        if is_given || matches!(joint, TestedJoint::Knee | TestedJoint::Ankle) {
            return None;
        }
        let Some(ball) = ball else {
            let origin = self.origin_mm.map_or("the file's origin", |_| "origin_mm");
            return Some(format!(
                "no ball or socket was found: axes pass through {origin}"
            ));
        };
        // The surface faces down, and the centre of a ball is above it.
        let name = if ball.opens_along.y > 0.0 {
            "ball"
        } else {
            "socket"
        };
        let radius_mm = ball.radius_mm;
        Some(format!(
            "axes pass through the centre of a {name} of radius {radius_mm:.2} mm"
        ))
    }

    /// Returns the arc whose centre is the flexion axis, of a joint that has one and a case that gives no axis.
    fn arc(&self, joint: TestedJoint, mesh: &TriangleMesh) -> Option<FittedArc> {
        match (self.flexion_axis_mm, joint) {
            (None, TestedJoint::Knee) => Some(FittedArc::posterior(mesh)),
            (None, TestedJoint::Ankle) => Some(FittedArc::of_dome(mesh)),
            _ => None,
        }
    }

    /// Returns a warning if no circle fits the arc whose centre is the flexion axis.
    fn not_round(&self, joint: TestedJoint, mesh: &TriangleMesh) -> Option<BuildWarning> {
        let off_mm = self.arc(joint, mesh)?.off_mm;
        (off_mm > MAX_OFF_ARC_MM).then(|| {
            let place = match joint {
                TestedJoint::Knee => "posterior condyles, which may end below 90 degrees of flexion",
                _ => "dome",
            };
            let remark = format!(
                "a circle fits its outline only within {off_mm:.2} mm along its {place}: the flexion axis, its centre, may be wrong by \
                 millimetres; write flexion_axis_mm"
            );
            BuildWarning::mesh(&self.file, remark)
        })
    }

    /// Returns a warning if the axes of the machine miss the centre of a ball, of which only x and y are followed.
    fn off_axes(&self, ball: &FittedSphere, side: Side) -> Option<BuildWarning> {
        let centre = ball.centre_mm;
        let off_mm = on_the_right([0.0, centre.z], side).1;
        let [x, y, z] = self.origin_mm.unwrap_or_default();
        let origin = [x + centre.x, y + centre.y, z + off_mm]
            .map(|mm| format!("{:.3}", (1e3 * mm).round() / 1e3 + 0.0));
        (off_mm.abs() > MAX_OFF_AXES_MM).then(|| {
            let remark = format!(
                "the centre of its ball or socket is {off_mm:.2} mm off the plane z = 0, in which the machine's axes lie; write \
                 origin_mm = [{}]",
                origin.join(", ")
            );
            BuildWarning::mesh(&self.file, remark)
        })
    }

    fn moved(
        &self,
        mesh: TriangleMesh,
        (joint, placement): (TestedJoint, &FemurPlacement),
    ) -> TriangleMesh {
        let axis_mm = || self.axis_mm(joint, &mesh, ball(joint, &mesh).as_ref());
        match placement.motion(axis_mm) {
            Some(motion) => motion.mesh(mesh),
            None => mesh,
        }
    }

    /// Returns the unplaced shell and the field of the placed one, computed or kept from an earlier run.
    fn prepared(
        &self,
        (joint, placement): (TestedJoint, &FemurPlacement),
        placing: &Placing,
        limits: &Limits,
        threads: usize,
        keep: &dyn Keep,
    ) -> Result<PreparedFemur, BuildError> {
        let path = self.file.path();
        let bytes = surface_bytes(self.file.files(), path)?;
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let placing_bytes = placing.bytes();
        let axis = self.flexion_axis_mm.into_iter().flatten();
        let placed = placement.numbers().into_iter().chain(axis);
        let mut placed: Vec<u8> = placed.flat_map(f64::to_le_bytes).collect();
        placed.push(joint as u8);
        let mut inputs = vec![ending.as_encoded_bytes(), &placing_bytes, &bytes];
        // A placement that moves nothing does not change the key under which fields are kept.
        inputs.extend(placement.is_moved().then_some(placed.as_slice()));
        kept(keep, "femur", &inputs, || {
            let shell = parsed_shell(path, &bytes, placing, checks_of(Body::Femur, None))?;
            let mesh = self.moved(shell.mesh.clone(), (joint, placement));
            let nodes = SmoothField::node_count(&mesh);
            let (most, memory_gb) = (limits.most(Limits::BYTES_OF_FIELD_NODE), limits.memory_gb);
            if nodes > most {
                let message = format!(
                    "the distance field would have {nodes} nodes, and more than {most} take more than the {memory_gb} GB that \
                     [limits] memory_gb allows; cut away parts that never touch the insert, check length_unit, or allow more"
                );
                return Err(BuildError::mesh(path, &["length_unit", "file"], message));
            }
            let field = SmoothField::new(&mesh, threads);
            Ok(PreparedFemur { shell, field })
        })
    }
}

/// Largest distance of a ball from the axes of the machine, mm: that of a drawing whose origin was meant to be in it.
const MAX_OFF_AXES_MM: f64 = 0.1;

/// Largest distance of an outline from the circle about its flexion axis, mm. The posterior condyles of real knees, which have
/// more than one radius, are off by up to 0.13 mm; an arc of radius 24 mm that ends at 79 degrees is off by this, and its axis by 1 mm.
const MAX_OFF_ARC_MM: f64 = 0.2;

/// Cosine of 78 degrees, within which the normal of a triangle that faces the bearing lies from straight down.
const MIN_DOWN: f64 = 0.2;

/// Returns the ball or socket of the mesh of a joint that has one, of the triangles that face the bearing: the walls of a plate
/// around it would be another sphere.
fn ball(joint: TestedJoint, mesh: &TriangleMesh) -> Option<FittedSphere> {
    if matches!(joint, TestedJoint::Knee | TestedJoint::Ankle) {
        return None;
    }
    let faces_down = |triangle: &usize| {
        let [a, b, c] = mesh.corners(*triangle);
        let normal = (b - a).cross(&(c - a));
        normal.y < -MIN_DOWN * normal.norm()
    };
    let facing = (0..mesh.triangles.len()).filter(faces_down);
    let facing = TriangleMesh {
        vertices: mesh.vertices.clone(),
        triangles: facing.map(|triangle| mesh.triangles[triangle]).collect(),
    };
    // Of an open surface, the sphere on either side is found.
    FittedSphere::new(&facing, Roundness::Convex)
}

/// Mirrors a place [x, z] of the insert frame of a left knee.
fn on_the_right([x, z]: [f64; 2], side: Side) -> (f64, f64) {
    let place = point_on_side(&Vec3::new(x, 0.0, z), side);
    (place.x, place.z)
}

/// Returns the place of the frame for which the centre of the distal arc is over x = 0.
///
/// The centre lies (distal - posterior radius) from the origin, opposite to the transition.
fn over_the_dish(shape: &GenericFemurShape, flexion_rad: f64) -> (f64, f64) {
    let to_centre_mm = shape.distal_radius_mm - shape.posterior_radius_mm;
    let anterior_rad = shape.transition_deg.to_radians() - flexion_rad;
    (-to_centre_mm * anterior_rad.sin(), 0.0)
}

/// Returns the distance of the flexion axis anterior of the frame's origin, in the insert frame.
fn axis_ahead_mm(flexion_axis_mm: (f64, f64), flexion_rad: f64) -> f64 {
    let axis = Vec3::new(flexion_axis_mm.0, flexion_axis_mm.1, 0.0);
    let (sine, cosine) = flexion_rad.sin_cos();
    axis.x * cosine - axis.y * sine
}

/// Number of triangles for a femur that is not a mesh: they lie within a few hundredths of a millimetre of its surface, less
/// than a pixel of a picture of it.
pub const FEMUR_TRIANGLES: f64 = 8_000.0;

impl Case {
    /// Returns the surface of the femur of `test`, which this case built, in the femoral frame of a right knee, mm;
    /// triangles anticlockwise seen from outside. A mesh has its own triangles; other shapes get about `about`.
    ///
    /// # Errors
    /// A mesh that cannot be read again.
    pub fn femur_triangles(&self, test: &WearTest, about: f64) -> Result<TriangleMesh, BuildError> {
        match (&self.femur.shape, test.counterface.as_ref()) {
            (FemurShape::Mesh(femur), _) => {
                let placing = Placing::new(&femur.frame, femur.origin_mm, self.side_in_frame())?;
                let checks = checks_of(Body::Femur, None);
                let shell = shell(&femur.file, &placing, checks, &mut Vec::new())?;
                let joint = test.machine().mechanism.tests;
                Ok(femur.moved(shell.mesh, (joint, &self.femur.placement)))
            }
            (_, Counterface::Generic(femur)) => Ok(generic(femur, about)),
            (_, Counterface::Placed(placed)) => {
                Ok(generic(placed.femur(), about).mapped(|point| placed.to_frame(point)))
            }
            (FemurShape::Sphere(ball), _) => Ok(sphere(ball.radius_mm, about)),
            (FemurShape::Cylinder(cylinder), _) => Ok(tube(cylinder.radius_mm)),
            (FemurShape::Plane, _) => Ok(square()),
            (FemurShape::Generic(_), _) => {
                unreachable!("a generic femur is built as one")
            }
        }
    }
}

fn generic(femur: &GenericFemur, about: f64) -> TriangleMesh {
    const COARSE_MM: f64 = 1.0;
    let coarse = femur.surface_mesh(COARSE_MM).triangles.len() as f64;
    // The number of triangles goes with the inverse square of their edge.
    femur.surface_mesh(COARSE_MM * (coarse / about).sqrt())
}

/// Returns a square in the plane y = 0 that faces down, larger than any pin.
fn square() -> TriangleMesh {
    const HALF_MM: f64 = 30.0;
    let corner = |(x, z): (f64, f64)| Vec3::new(x * HALF_MM, 0.0, z * HALF_MM);
    TriangleMesh {
        vertices: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(corner)
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// Returns a tube about the z axis, longer than any insert is wide.
fn tube(radius_mm: f64) -> TriangleMesh {
    const HALF_LENGTH_MM: f64 = 60.0;
    const EDGE_MM: f64 = 1.5;
    let along = (2.0 * HALF_LENGTH_MM / EDGE_MM).ceil() as u32;
    let height_mm = |ring: u32| HALF_LENGTH_MM * (2.0 * f64::from(ring) / f64::from(along) - 1.0);
    let profile = Vec::from_iter((0..=along).map(|ring| (radius_mm, height_mm(ring))));
    let about_y = TriangleMesh::revolved(&profile, (TAU * radius_mm / EDGE_MM).ceil() as u32);
    about_y.mapped(|at| Vec3::new(at.z, at.x, at.y))
}

/// Returns a ball about the origin by repeated subdivision of an octahedron.
fn sphere(radius_mm: f64, about: f64) -> TriangleMesh {
    const OCTAHEDRON: [[u32; 3]; 8] = [
        [0, 1, 2],
        [0, 2, 4],
        [0, 4, 5],
        [0, 5, 1],
        [3, 2, 1],
        [3, 4, 2],
        [3, 5, 4],
        [3, 1, 5],
    ];
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let mut ball = TriangleMesh {
        vertices: axes.into_iter().chain(axes.map(|axis| -axis)).collect(),
        triangles: OCTAHEDRON.to_vec(),
    };
    // Each subdivision has four times the triangles of the one before.
    let halvings = (about / OCTAHEDRON.len() as f64).log(4.0).round() as usize;
    for _ in 0..halvings {
        ball = ball.in_four(|a, b| (a + b).normalize());
    }
    ball.mapped(|vertex| vertex * radius_mm)
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
            (32_768, 16_386)
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
