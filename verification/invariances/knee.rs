//! A knee of triangles, told by a case file and two mesh files.

use std::{fmt::Write, fs};

use condyle::{
    Vec3,
    evolve::{March, WearTest},
    geometry::{GenericFemur, GenericFemurShape, GenericInsertShape, Meshing, TriangleMesh},
};

use crate::marched::{built, case_in};

/// Flexion at the start of the cycle, degrees: that of the machine.
const START_FLEXION_DEG: f64 = -7.0;

/// A knee and how it is told.
pub(super) struct Knee {
    pub femur: TriangleMesh,
    pub insert: TriangleMesh,
    pub side: &'static str,
    pub unit: &'static str,
    /// Units of the files in a millimetre.
    pub per_mm: f64,
    pub femur_axes: [&'static str; 3],
    pub insert_axes: [&'static str; 3],
    pub flexion_axis_mm: [f64; 2],
    pub start_mm: [f64; 2],
    pub vv_axis_medial_mm: f64,
    pub ie_axis_anterior_mm: f64,
}

impl Default for Knee {
    fn default() -> Self {
        let isb = ["anterior", "superior", "right"];
        Self {
            femur: wider(GenericFemur::new(GenericFemurShape::default()).surface_mesh(1.5)),
            insert: wider(dishes()),
            side: "right",
            unit: "mm",
            per_mm: 1.0,
            femur_axes: isb,
            insert_axes: isb,
            flexion_axis_mm: [0.0, 0.0],
            start_mm: [-7.0, 0.3],
            vv_axis_medial_mm: 5.0,
            ie_axis_anterior_mm: 1.0,
        }
    }
}

/// The generic insert's articulating surface.
fn dishes() -> TriangleMesh {
    let meshing = Meshing {
        edge_mm: 2.0,
        layers: 1,
    };
    let insert = GenericInsertShape::default()
        .insert(meshing)
        .expect("an insert");
    let faces = insert.surface_faces().iter();
    TriangleMesh {
        vertices: insert.surface().positions,
        triangles: faces
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
    }
}

/// The lateral half a little wider, so that a mirror image shows.
fn wider(mesh: TriangleMesh) -> TriangleMesh {
    mesh.mapped(|v| Vec3::new(v.x, v.y, v.z * if v.z > 0.0 { 1.03 } else { 1.0 }))
}

impl Knee {
    /// The left knee that is its mirror image.
    pub(super) fn mirrored(self) -> Self {
        let mirrored = |mesh: TriangleMesh| {
            let mut mesh = mesh.mapped(|v| Vec3::new(v.x, v.y, -v.z));
            mesh.triangles
                .iter_mut()
                .for_each(|corners| corners.swap(1, 2));
            mesh
        };
        let [x, z] = self.start_mm;
        Self {
            femur: mirrored(self.femur),
            insert: mirrored(self.insert),
            side: "left",
            start_mm: [x, -z],
            ..self
        }
    }

    /// Where the femoral frame starts if its origin is moved in the file, so that the flexion axis
    /// starts where it did.
    pub(super) fn start_of_axis_mm(&self, away: Vec3) -> [f64; 2] {
        let (sine, cosine) = START_FLEXION_DEG.to_radians().sin_cos();
        let [x, z] = self.start_mm;
        [x - (away.x * cosine - away.y * sine), z]
    }

    /// The wear test, by way of files.
    pub(super) fn test(&self) -> WearTest {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, mesh) in [("femur.obj", &self.femur), ("insert.obj", &self.insert)] {
            fs::write(folder.path().join(name), self.obj(mesh)).expect("a file");
        }
        built(&case_in(&self.case(), folder.path()))
    }

    fn obj(&self, mesh: &TriangleMesh) -> String {
        let mut text = String::new();
        for vertex in &mesh.vertices {
            let v = vertex * self.per_mm;
            writeln!(text, "v {:e} {:e} {:e}", v.x, v.y, v.z).expect("text takes text");
        }
        for [a, b, c] in &mesh.triangles {
            writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("text takes text");
        }
        text
    }

    fn case(&self) -> String {
        let Self {
            side,
            unit,
            femur_axes,
            insert_axes,
            flexion_axis_mm,
            start_mm,
            vv_axis_medial_mm,
            ie_axis_anterior_mm,
            ..
        } = self;
        format!(
            "\
side = \"{side}\"
[femur]
shape = \"mesh\"
file = \"femur.obj\"
length_unit = \"{unit}\"
axes = {femur_axes:?}
flexion_axis_mm = {flexion_axis_mm:?}
start_mm = {start_mm:?}
[insert]
shape = \"mesh\"
file = \"insert.obj\"
length_unit = \"{unit}\"
axes = {insert_axes:?}
thickness_mm = 9.0
edge_mm = 1.5
layers = 2
[contact]
slip_tolerance_mm_per_s = 10.0
[machine]
vv_axis_medial_mm = {vv_axis_medial_mm:?}
ie_axis_anterior_mm = {ie_axis_anterior_mm:?}
{EXACTLY}"
        )
    }
}

/// Two updates, Newton's method to round-off. With 100 increments and soft friction no step is
/// halved: a step that is halved for one telling and not for another is no round-off.
pub(super) const EXACTLY: &str = "\
[march]
cycles = 1_000_000
updates = 2
[time]
increments = 100
force_tolerance_n = 1e-7
[wear]
law = \"archard\"
";

/// What a knee has worn.
pub(super) struct Worn {
    pub volume_mm3: f64,
    /// Depths of all nodes, least first.
    depths_mm: Vec<f64>,
}

impl Worn {
    pub(super) fn of(march: &March) -> Self {
        let mut depths_mm = march.fields().wear_depth_mm.clone();
        depths_mm.sort_unstable_by(f64::total_cmp);
        let last = march.state().updates.last().expect("an update");
        Self {
            volume_mm3: last.volume_loss_mm3,
            depths_mm,
        }
    }

    pub(super) fn deepest_mm(&self) -> f64 {
        self.depths_mm.last().copied().unwrap_or_default()
    }

    /// Largest difference of two knees' depths; infinite where they have not as many nodes.
    pub(super) fn farthest_depth_mm(&self, other: &Self) -> f64 {
        if self.depths_mm.len() != other.depths_mm.len() {
            return f64::INFINITY;
        }
        let pairs = self.depths_mm.iter().zip(&other.depths_mm);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}
