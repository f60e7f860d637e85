//! Meshes, solids and a material for tests.

use crate::{
    Elastic, ElasticPlastic, ElasticSolid, Hardening, HexMesh, Strain, Stress, Vec3,
    element::{Element, POINTS},
};

/// A block of `n` unit cubes along each axis, nodes numbered x fastest, then y, then z.
pub(crate) fn block(n: [usize; 3]) -> HexMesh {
    let id = |i: usize, j: usize, k: usize| (i + (n[0] + 1) * (j + (n[1] + 1) * k)) as u32;
    let mut nodes = Vec::new();
    for k in 0..=n[2] {
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                nodes.push(Vec3::new(i as f64, j as f64, k as f64));
            }
        }
    }
    let mut hexes = Vec::new();
    for k in 0..n[2] {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let quad = |k| {
                    [
                        id(i, j, k),
                        id(i + 1, j, k),
                        id(i + 1, j + 1, k),
                        id(i, j + 1, k),
                    ]
                };
                let ([a, b, c, d], [e, f, g, h]) = (quad(k), quad(k + 1));
                hexes.push([a, b, c, d, e, f, g, h]);
            }
        }
    }
    HexMesh {
        nodes,
        hexes: hexes.into(),
    }
}

/// A block of which no element is a brick, the outside still flat.
pub(crate) fn distorted(n: [usize; 3]) -> HexMesh {
    let mut mesh = block(n);
    for (i, node) in mesh.nodes.iter_mut().enumerate() {
        for axis in 0..3 {
            if node[axis] > 0.0 && node[axis] < n[axis] as f64 {
                node[axis] += 0.25 * ((7 * i + 3 * axis) as f64).sin();
            }
        }
    }
    mesh
}

pub(crate) fn nodes_where(mesh: &HexMesh, is_there: impl Fn(&Vec3) -> bool) -> Vec<u32> {
    let nodes = (0..mesh.nodes.len() as u32).zip(&mesh.nodes);
    nodes.filter(|(_, p)| is_there(p)).map(|(n, _)| n).collect()
}

/// Forces of a uniform traction on the quads whose corners are all there.
pub(crate) fn traction(
    mesh: &HexMesh,
    on: impl Fn(&Vec3) -> bool,
    traction: Vec3,
) -> Vec<(u32, Vec3)> {
    let mut quads = mesh.boundary_quads();
    quads.retain(|quad| mesh.positions(quad).all(|place| on(&place)));
    mesh.traction_forces(&quads, |_, _| traction)
}

/// A distorted block held as planes of symmetry hold it, so that stress can be uniform.
pub(crate) fn between_planes(mesh: &HexMesh, elastic: Elastic) -> ElasticSolid {
    let supports = (0..3).flat_map(|axis| {
        let on_plane = nodes_where(mesh, |p| p[axis] == 0.0);
        let along = [0, 1, 2].map(|k| k == axis);
        on_plane.into_iter().map(move |node| (node, along))
    });
    ElasticSolid::with_supports(mesh, elastic, supports.collect::<Vec<_>>()).unwrap()
}

/// A distorted block of polyethylene that stands on held nodes.
pub(crate) fn standing(n: [usize; 3]) -> ElasticSolid {
    let mesh = distorted(n);
    let held = nodes_where(&mesh, |place| place.z == 0.0);
    ElasticSolid::new(&mesh, Elastic::new(463.0, 0.46).unwrap(), held).unwrap()
}

pub(crate) fn material(kinematic: f64) -> ElasticPlastic {
    let points = vec![(0.0, 14.0), (0.02, 20.0), (0.1, 28.0)];
    ElasticPlastic {
        elastic: Elastic::new(571.6, 0.45).unwrap(),
        hardening: Hardening::new(points, kinematic).unwrap(),
    }
}

impl Element {
    /// Returns the stresses at the Gauss points, with the modes in balance.
    pub(crate) fn stresses(
        &self,
        elastic: &Elastic,
        nodes: &[Vec3; 8],
        eigenstrains: &[Strain; POINTS],
    ) -> [Stress; POINTS] {
        let (_, pull) = self.forces(&eigenstrains.map(|strain| elastic.stress(&strain)));
        let modes = self.stiffness(elastic).modes(nodes, &pull);
        let strains = self.strains(nodes, &modes);
        std::array::from_fn(|p| elastic.stress(&strains[p].less(&eigenstrains[p])))
    }
}
