//! A preview of a case: its bodies, the settled femur, and the expected time and memory of a run.

use std::{
    collections::BTreeSet,
    path::Path,
    time::{Duration, Instant},
};

use condyle::{
    Vec3,
    contact::{ContactMemory, ContactModel},
    evolve::March,
    geometry::{Dishes, TriangleMesh, bounds},
    machine::knee::{IE, KNEE, VV},
    spatial::{Pose, RelativeMotion},
};
use condyle_case::{
    cache::Cache,
    case::{Assignment, Case, FEMUR_TRIANGLES, Side, Update},
    config::DataFile,
};
use condyle_report::bodies::{BodiesPicture, MachineAxes, bodies_svg};
use condyle_results::{Directions, TestedJoint, point_on_side};
use serde::Serialize;

use crate::{
    at_rest::AtRest,
    plausibility::finished::rim_of,
    run::{
        Clock,
        error::RunError,
        prepare::{build, mean_load_n, memory_mb, start},
    },
};

/// A preview of a case; units are in the names.
#[derive(Serialize)]
pub struct Preview {
    /// Title of the case.
    pub title: String,
    /// The joint whose replacement the machine tests.
    pub joint: TestedJoint,
    /// The side of the joint.
    pub side: &'static str,
    /// Corrections of the input, and remarks on suspicious input.
    pub warnings: Vec<String>,
    /// Reasons to expect that the bodies do not belong together, or lie otherwise than the case says.
    pub doubts: Vec<String>,
    /// The femoral component.
    pub femur: BodyFacts,
    /// The insert.
    pub insert: InsertFacts,
    /// The place that the machine's axes pass through, where it depends on a ball or socket of a mesh.
    pub axes: Option<String>,
    /// The settled femur on the insert.
    pub at_rest: AtRest,
    /// Expected time and memory of a run.
    pub expected: Expected,
    /// The case, checked.
    #[serde(skip)]
    pub case: Case,
    #[serde(skip)]
    march: March,
    #[serde(skip)]
    femur_triangles: TriangleMesh,
}

impl Preview {
    /// Prepares a run of the case at `case_path`, with some of its values changed, up to its first
    /// cycle: reads the file and the meshes, and settles the femur on the insert.
    ///
    /// # Errors
    /// The errors of a run that cannot start.
    pub fn of(case_path: &Path, changes: &[Assignment], threads: usize) -> Result<Self, RunError> {
        Self::of_case(Case::read_changed(case_path, changes)?, threads)
    }

    /// Previews a case that has been read.
    ///
    /// # Errors
    /// As [`Preview::of`].
    pub fn of_case(case: Case, threads: usize) -> Result<Self, RunError> {
        let mut clock = Clock::default();
        let built = clock.time(|| build(&case, threads, &Cache::off()))?;
        let warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
        let march = clock.time(|| start(&case, built.test, &built.warnings))?;
        let triangles = case.femur_triangles(march.test(), FEMUR_TRIANGLES);
        let triangles = triangles.map_err(|source| RunError::of_build(&case, &source))?;
        let at_rest = AtRest::of(&march);
        let mut doubts = case.misfit_remarks();
        doubts.extend(at_rest.beside_dishes(&march));
        let file = case.femur.file();
        let femur = BodyFacts::of(
            case.femur.shape.word(),
            file,
            triangles.bounds(),
            file.map(|_| triangles.triangles.len()),
            file.and_then(|_| EdgeFacts::of(&triangles)),
            &warnings,
        );
        let insert = InsertFacts::of(&case, &march, &warnings);
        Ok(Self {
            title: case.heading.title.clone(),
            joint: march.test().machine().mechanism.tests,
            side: case.heading.side.word(),
            expected: Expected::of(&case, &march, &at_rest, clock.spent),
            warnings,
            doubts,
            femur,
            insert,
            axes: built.axes,
            at_rest,
            case,
            march,
            femur_triangles: triangles,
        })
    }

    /// Returns the joint with its side.
    pub fn directions(&self) -> Directions {
        Directions {
            joint: self.joint,
            side: self.case.side_in_frame(),
        }
    }

    /// Both bodies from three sides, as the text of an SVG file.
    pub fn picture_svg(&self) -> String {
        let (march, at_rest, side) = (&self.march, &self.at_rest, self.case.side_in_frame());
        let insert = march.test().insert.mesh();
        let on_insert = |vertex: &Vec3| at_rest.pose.to_insert(vertex);
        let femur = self.femur_triangles.clone().mapped(on_insert);
        let insert = TriangleMesh::of_quads(insert.nodes.clone(), insert.boundary_quads());
        let bodies = [femur, insert, pressed(march, at_rest)];
        let on_side = |vertex: &Vec3| point_on_side(vertex, side);
        let [femur, insert, contact] = bodies.map(|body| body.mapped(on_side));
        bodies_svg(&BodiesPicture {
            title: &self.title,
            directions: self.directions(),
            femur: &femur,
            insert: &insert,
            contact: &contact,
            axes: (*march.test().machine().mechanism == KNEE).then(|| axes(march, at_rest, side)),
            caption: &format!(
                "Red: in contact at rest under {:.0} N, {:.0} mm2, up to {:.1} MPa.",
                at_rest.axial_force_n, at_rest.contact_area_mm2, at_rest.peak_pressure_mpa
            ),
        })
    }
}

/// Radius around the lowest place of a dish within which the thickness under the femur is smallest, mm.
const AROUND_DISH_MM: f64 = 10.0;

/// A body and its source.
#[derive(Debug, Serialize)]
pub struct BodyFacts {
    /// The word for its shape in the case.
    pub shape: &'static str,
    /// Its file without the folder, if it has one.
    pub file: Option<String>,
    /// Size antero-posterior, supero-inferior and medio-lateral, mm.
    pub size_mm: [f64; 3],
    /// Triangles of its file; none for hexahedra and for a shape by dimensions.
    pub triangles: Option<usize>,
    /// Their edges.
    pub edges: Option<EdgeFacts>,
    /// Defects of its file.
    pub defects: Vec<String>,
}

impl BodyFacts {
    fn of(
        shape: &'static str,
        file: Option<&DataFile>,
        (low, high): (Vec3, Vec3),
        triangles: Option<usize>,
        edges: Option<EdgeFacts>,
        warnings: &[String],
    ) -> Self {
        let file = file.map(DataFile::name);
        // The warnings of a file start with its name.
        let start = file.as_ref().map(|file| format!("{file}: "));
        let own = |warning: &String| warning.strip_prefix(start.as_deref()?).map(str::to_owned);
        Self {
            shape,
            size_mm: (high - low).into(),
            triangles,
            edges,
            defects: warnings.iter().filter_map(own).collect(),
            file,
        }
    }
}

/// The shape of the triangles of a mesh.
#[derive(Debug, Serialize)]
pub struct EdgeFacts {
    /// Length of the shortest, the median and the longest edge, mm.
    pub edge_mm: [f64; 3],
    /// Triangles whose height is less than a twentieth of their longest edge.
    pub slivers: usize,
}

impl EdgeFacts {
    /// Returns the shape of the triangles of `mesh`; `None` without triangles.
    fn of(mesh: &TriangleMesh) -> Option<Self> {
        const SLIVER: f64 = 0.05;
        let mut lengths = Vec::with_capacity(3 * mesh.triangles.len());
        let mut slivers = 0;
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle);
            let edges = [b - a, c - b, a - c].map(|edge| edge.norm());
            let longest = edges.into_iter().fold(0.0, f64::max);
            slivers += usize::from((b - a).cross(&(c - a)).norm() < SLIVER * longest * longest);
            lengths.extend(edges);
        }
        lengths.sort_unstable_by(f64::total_cmp);
        let (first, last) = (lengths.first()?, lengths.last()?);
        Some(Self {
            edge_mm: [*first, lengths[lengths.len() / 2], *last],
            slivers,
        })
    }
}

/// The insert as it is meshed.
#[derive(Debug, Serialize)]
pub struct InsertFacts {
    /// The body.
    #[serde(flatten)]
    pub body: BodyFacts,
    /// Hexahedra.
    pub hexahedra: usize,
    /// Nodes of the articulating surface.
    pub surface_nodes: usize,
    /// Smallest scaled Jacobian of a hexahedron.
    pub worst_quality: f64,
    /// Least thickness within 10 mm of the lowest place of the medial and of the lateral dish, mm.
    pub dish_thickness_mm: Option<[f64; 2]>,
    /// Least thickness of the surface anywhere but on its rim, mm: where a scar reaches it, a run reports it.
    pub least_thickness_mm: f64,
    /// Middle between the dishes: anterior, superior and lateral of the origin, where the machine's axes are, mm.
    pub dishes_middle_mm: Option<[f64; 3]>,
}

impl InsertFacts {
    fn of(case: &Case, march: &March, warnings: &[String]) -> Self {
        let insert = march.test().insert.as_ref();
        let (mesh, places) = (insert.mesh(), insert.surface().positions);
        let is_knee = march.test().machine().mechanism.tests == TestedJoint::Knee;
        let dishes = Dishes::find(&places).filter(|_| is_knee);
        let triangles = case.insert_triangles();
        let thickness = |dish: Vec3| {
            let nodes = places.iter().zip(insert.thickness_mm());
            let near = nodes.filter(|(place, _)| (*place - dish).norm() < AROUND_DISH_MM);
            near.map(|(_, thickness)| *thickness)
                .fold(f64::INFINITY, f64::min)
        };
        let rim: BTreeSet<u32> = rim_of(insert).into_iter().flatten().collect();
        let nodes = (0..).zip(insert.thickness_mm());
        let inside = nodes.filter(|(node, _)| !rim.contains(node));
        let inside = inside.map(|(_, thickness)| *thickness);
        Self {
            body: BodyFacts::of(
                case.insert.shape.word(),
                case.insert.file(),
                bounds(&mesh.nodes),
                triangles.as_ref().map(|mesh| mesh.triangles.len()),
                triangles.as_ref().and_then(EdgeFacts::of),
                warnings,
            ),
            hexahedra: mesh.hexes.len(),
            surface_nodes: places.len(),
            worst_quality: mesh.worst_quality(),
            least_thickness_mm: inside.fold(f64::INFINITY, f64::min),
            dish_thickness_mm: dishes.map(|d| [d.medial_mm, d.lateral_mm].map(thickness)),
            dishes_middle_mm: dishes.map(|dishes| dishes.middle_mm().into()),
        }
    }
}

/// Cycles solved for an update: some are solved again until they repeat themselves.
const CYCLES_AN_UPDATE: f64 = 1.15;
/// Contact evaluations for an increment.
const EVALUATIONS_AN_INCREMENT: f64 = 2.3;
/// Approximate number of updates of a march that determines them itself.
const OWN_UPDATES: f64 = 8.0;
/// Number of timed evaluations, and the length of the steps between them, mm: as in a cycle, each step loads other
/// nodes.
const TIMED: usize = 8;
const STEP_MM: f64 = 0.1;
/// Lowerings of the femur until it carries the mean load of the cycle.
const LOWERINGS: usize = 8;

/// Expected time and memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Expected {
    /// Memory at its highest, MB.
    pub memory_mb: f64,
    /// Memory that the case allows, MB.
    pub memory_allowed_mb: f64,
    /// Time on this computer, s.
    pub time_s: f64,
}

impl Expected {
    /// Estimates time and memory of a march that was built in the time `built_in`.
    fn of(case: &Case, march: &March, at_rest: &AtRest, built_in: Duration) -> Self {
        let updates = match &case.march.update {
            Update::Fixed(fixed) => fixed.updates as f64,
            Update::Auto(_) => OWN_UPDATES,
        };
        let cycles = updates * march.test().activities.len() as f64 * CYCLES_AN_UPDATE;
        let increments = cycles * march.test().time.increments as f64;
        let evaluations = increments * EVALUATIONS_AN_INCREMENT;
        // The estimate of the error solves cycles again, with finer increments and a coarser mesh: about 60 % more.
        let again = if case.accuracy.estimate { 1.6 } else { 1.0 };
        let solving_s = again * evaluations * evaluation_s(march, at_rest);
        Self {
            memory_mb: memory_mb(case, march, at_rest),
            memory_allowed_mb: 1e3 * case.limits.memory_gb,
            time_s: built_in.as_secs_f64() + solving_s,
        }
    }
}

/// Returns the time of a contact evaluation under the mean load with derivatives, s: the shorter of two times on a
/// path.
fn evaluation_s(march: &March, at_rest: &AtRest) -> f64 {
    let surface = march.surface();
    let memory = ContactMemory::default();
    let mut contact = march.test().contact.contact(march.bodies(&surface), memory);
    let pose = lowered(contact.as_mut(), at_rest, mean_load_n(march));
    // A ball that moves across would press on the wall of its cup.
    let is_round = march.test().start_height_mm.is_some();
    let step_mm = if is_round { 0.0 } else { STEP_MM };
    let mut once = || {
        let began = Instant::now();
        contact.begin_cycle();
        for step in 0..TIMED {
            let along = Vec3::new(step_mm * step as f64, 0.0, 0.0);
            let motion =
                RelativeMotion::at_rest(Pose::new(pose.rotation, pose.translation + along));
            contact.begin_increment(step);
            contact.respond(&motion);
            std::hint::black_box(contact.tangent());
            // The time includes settling, which is long for an insert that yields. The run reports a load that the
            // insert does not carry.
            let settled = contact.settle(&motion);
            std::hint::black_box(settled.is_ok());
            contact.accept(&motion);
        }
        began.elapsed().as_secs_f64() / TIMED as f64
    };
    // The second time excludes what a contact computes only once.
    once().min(once())
}

/// Returns the pose at rest with the femur lowered until it approximately carries a load.
fn lowered(contact: &mut dyn ContactModel, at_rest: &AtRest, load_n: f64) -> Pose {
    let mut pose = at_rest.pose;
    for _ in 0..LOWERINGS {
        let response = contact.respond(&RelativeMotion::at_rest(pose));
        let missing_n = load_n + response.wrench.force.y;
        let stiffness_n_per_mm = contact.tangent().by_pose.matrix[(4, 4)].abs();
        // Within 5 % the time of an evaluation no longer changes; without contact there is no stiffness to divide by.
        if missing_n.abs() < 0.05 * load_n || stiffness_n_per_mm < 1.0 {
            break;
        }
        // A stiffness at little contact is far too small: a full step would push the femur through the insert.
        pose.translation.y -= (missing_n / stiffness_n_per_mm).clamp(-0.1, 0.1);
    }
    pose
}

/// Returns the faces of the articulating surface with most corners under pressure.
fn pressed(march: &March, at_rest: &AtRest) -> TriangleMesh {
    const MAX_CORNERS: usize = 3;
    let places = march.test().insert.surface().positions;
    let mut is_pressed = vec![false; places.len()];
    for node in &at_rest.touched {
        is_pressed[node.node as usize] = true;
    }
    let corners = |face: &[u32; 4]| {
        face.iter()
            .filter(|&&node| is_pressed[node as usize])
            .count()
    };
    let faces = march.test().insert.surface_faces().iter().copied();
    let faces = faces.filter(|face| corners(face) >= MAX_CORNERS);
    TriangleMesh::of_quads(places, faces)
}

fn axes(march: &March, at_rest: &AtRest, side: Side) -> MachineAxes {
    let machine = march.test().machine();
    let [vv, ie] = [VV, IE].map(|joint| point_on_side(&machine.joint(joint).axis_point_mm, side));
    let [x, y, _] = at_rest.flexion_axis_mm;
    MachineAxes {
        flexion_mm: (x, y),
        vv_mm: (vv.y, vv.z),
        ie_mm: (ie.x, ie.z),
        ap_zero_mm: x,
    }
}
