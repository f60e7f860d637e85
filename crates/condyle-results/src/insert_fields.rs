//! `insert_*.vtu` and `insert.pvd`: the insert with its results at the nodes at each update, for ParaView.

use condyle::{
    Vec3,
    contact::{PlasticUnderSurface, UnderSurface},
    evolve::{March, UpdateRecord},
};
use condyle_fem::HexMesh;
use condyle_mesh::formats::{MeshFileError, PointArray, PointValues, pvd_text, vtu_bytes};

use super::{
    side::{Side, mesh_on_side, point_on_side},
    tables::described,
};

/// The insert as worn so far, with the results of its last update at the nodes; 0 at nodes that are not on the
/// articulating surface.
#[derive(Clone, Debug, PartialEq)]
pub struct InsertFields {
    /// The hexahedra, with the present positions of their nodes, mm.
    pub mesh: HexMesh,
    /// Name with its unit, and one value per node.
    pub scalars: Vec<(&'static str, Vec<f64>)>,
    /// Name with its unit, and one vector per node, in the insert frame.
    pub vectors: Vec<(&'static str, Vec<[f64; 3]>)>,
    /// 1 at the nodes of the articulating surface.
    pub articulating: Vec<u8>,
}

struct Source<'a> {
    march: &'a March,
    mesh: &'a HexMesh,
}

/// A field of `insert_*.vtu` with one value per node.
#[derive(Clone, Copy)]
pub struct NodeField {
    /// Its name, which ends in its unit.
    pub name: &'static str,
    /// A description.
    pub about: &'static str,
    value: fn(&Source<'_>) -> Option<Vec<f64>>,
}

described! {
    /// The fields with one value per node, in the order of the file.
    NODE_FIELDS: NodeField;
    /// Wear depth along the normal.
    wear_depth_mm = |source| source.at_surface(&source.march.fields().wear_depth_mm);
    /// Wear depth of one cycle, the mean over all activities by their shares of the cycles.
    depth_per_cycle_mm = |source| source.at_surface(&source.march.fields().depth_per_cycle_mm);
    /// Highest pressure in the cycle of any activity.
    peak_pressure_mpa = |source| source.at_surface(&source.march.fields().peak_pressure_mpa);
    /// Sliding distance under pressure in the cycle, the mean over all activities by their shares of the cycles.
    sliding_distance_mm = |source| source.at_surface(&source.march.fields().sliding_distance_mm);
    /// Cross-shear ratio of the cycles of all activities together, by their shares.
    cross_shear = |source| source.at_surface(&source.march.fields().cross_shear);
    /// Thickness left.
    thickness_mm = |source| source.at_surface(&source.march.fields().thickness_mm);
    /// Depth of creep; of an insert that creeps.
    creep_depth_mm = |source| source.of_creep(source.march.state().depths.creep_mm.as_deref());
    /// Depth of creep that is left after a rest without load.
    creep_left_unloaded_mm = |source| {
        let law = source.march.test().creep.as_ref()?;
        let left_mm = source.march.state().creep.left_mm(law);
        source.of_creep(Some(left_mm.as_slice()).filter(|left| !left.is_empty()))
    };
    /// Von Mises stress at the instant of highest pressure; of a deformable insert, the mean of the elements around.
    von_mises_mpa = |source| Some(mean_around(source.mesh, &source.under_surface()?.von_mises_mpa));
    /// Largest shear stress at that instant, likewise.
    max_shear_mpa = |source| Some(mean_around(source.mesh, &source.under_surface()?.max_shear_mpa));
    /// Permanent set of the surface; of an insert that yields.
    permanent_set_mm = |source| source.at_surface(&source.plastic()?.permanent_set_mm);
    /// Accumulated plastic strain, the largest of the elements around.
    plastic_strain = |source| Some(most_around(source.mesh, &source.plastic()?.plastic_strain));
    /// Number of the plastic regime, the largest of the elements around.
    plastic_regime = |source| {
        let regimes = source.plastic()?.regime.iter();
        let regimes: Vec<f64> = regimes.map(|regime| f64::from(regime.number())).collect();
        Some(most_around(source.mesh, &regimes))
    };
}

impl Source<'_> {
    /// Returns the values at the nodes of the articulating surface as values at all nodes.
    fn at_surface(&self, values: &[f64]) -> Option<Vec<f64>> {
        let surface = self.march.insert().surface_nodes();
        Some(spread(surface, values, 0.0, self.mesh.nodes.len()))
    }

    /// Returns the same for an insert that creeps; 0 before the first creep.
    fn of_creep(&self, values: Option<&[f64]>) -> Option<Vec<f64>> {
        self.march.test().creep.as_ref()?;
        let none = || Some(vec![0.0; self.mesh.nodes.len()]);
        values.map_or_else(none, |values| self.at_surface(values))
    }

    /// Returns the state inside a deformable insert in the last solved cycle; none for a foundation.
    fn under_surface(&self) -> Option<&UnderSurface> {
        self.march.state().under_surface.as_ref()
    }

    fn plastic(&self) -> Option<&PlasticUnderSurface> {
        self.under_surface()?.plastic.as_ref()
    }
}

impl InsertFields {
    /// Creates the fields of a march, in a knee of the given side.
    pub fn of(march: &March, side: Side) -> Self {
        let surface = march.insert().surface_nodes();
        let mesh = mesh_on_side(march.insert().mesh(), side);
        let count = mesh.nodes.len();
        let source = Source { march, mesh: &mesh };
        let fields = NODE_FIELDS.iter();
        let scalars = fields.filter_map(|field| Some((field.name, (field.value)(&source)?)));
        Self {
            scalars: scalars.collect(),
            vectors: vec![("principal_direction", directions(march, side, count))],
            articulating: spread(surface, &vec![1; surface.len()], 0, count),
            mesh,
        }
    }
}

fn directions(march: &March, side: Side, count: usize) -> Vec<[f64; 3]> {
    let directions = march.fields().principal_direction.iter();
    let on_side = |vector: &[f64; 3]| point_on_side(&Vec3::from(*vector), side).into();
    let directions: Vec<[f64; 3]> = directions.map(on_side).collect();
    spread(march.insert().surface_nodes(), &directions, [0.0; 3], count)
}

/// Returns the values at the `surface` nodes as values at all nodes, elsewhere `none`.
fn spread<T: Copy>(surface: &[u32], values: &[T], none: T, nodes: usize) -> Vec<T> {
    let mut all = vec![none; nodes];
    // VTK has one array for all nodes of a mesh: nodes off the surface get a value too.
    for (&node, &value) in surface.iter().zip(values) {
        all[node as usize] = value;
    }
    all
}

/// Returns the mean value of the elements around each node.
fn mean_around(mesh: &HexMesh, values: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); mesh.nodes.len()];
    for (hex, value) in mesh.hexes.iter().zip(values) {
        for &node in hex {
            let (sum, count) = &mut sums[node as usize];
            *sum += value;
            *count += 1.0;
        }
    }
    let mean = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 };
    sums.into_iter().map(mean).collect()
}

/// Returns the largest value of the elements around each node.
fn most_around(mesh: &HexMesh, values: &[f64]) -> Vec<f64> {
    let mut most = vec![0.0; mesh.nodes.len()];
    for (hex, &value) in mesh.hexes.iter().zip(values) {
        for &node in hex {
            most[node as usize] = value.max(most[node as usize]);
        }
    }
    most
}

/// Name of the file that holds the insert after `update` updates.
pub fn insert_file_name(update: usize) -> String {
    format!("insert_{update:04}.vtu")
}

/// `insert_*.vtu`: the insert as worn so far, with the results of its last update at the nodes, in a knee of the
/// given side.
pub fn insert_vtu(march: &March, side: Side) -> Result<Vec<u8>, MeshFileError> {
    let fields = InsertFields::of(march, side);
    let scalars = fields.scalars.iter().map(|(name, values)| PointArray {
        name,
        values: PointValues::Float64(values),
    });
    let vectors = fields.vectors.iter().map(|(name, values)| PointArray {
        name,
        values: PointValues::Vectors(values),
    });
    let mut points: Vec<_> = scalars.chain(vectors).collect();
    points.push(PointArray {
        name: "articulating",
        values: PointValues::UInt8(&fields.articulating),
    });
    vtu_bytes(&fields.mesh, &points)
}

/// `insert.pvd`: the series of all files so far, with the cycles as time.
pub fn insert_pvd(updates: &[UpdateRecord]) -> String {
    let names: Vec<String> = (0..=updates.len()).map(insert_file_name).collect();
    let cycles = std::iter::once(0.0).chain(updates.iter().map(|update| update.cycles));
    let names = names.iter().map(String::as_str);
    pvd_text(cycles.zip(names).map(|(cycles, name)| (cycles, 0, name)))
}
