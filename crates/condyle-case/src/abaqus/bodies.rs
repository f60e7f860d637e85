//! Insert and femur: nodes, elements, sets, surfaces, material.

use std::io::{self, Write};

use condyle::Vec3;

use super::model::{Model, in_mesh};
use super::names;
use condyle_mesh::formats::{InpWriter, RigidTriangle, element_faces};

/// Milligrams in a tonne.
const MG_PER_TONNE: f64 = 1e9;
/// A face belongs to the backside if it leans from straight down by less than 60 degrees.
const MIN_COSINE: f64 = 0.5;

pub(super) fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    insert(model, inp)?;
    femur(model, inp)
}

fn insert<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    let (labels, mesh) = (&model.labels, &model.insert);
    inp.comment(&format!(
        "\nINSERT: {} hexahedra of the unworn insert.\n{}",
        mesh.hexes.len(),
        body_comment(model)
    ))?;
    inp.nodes(labels.insert_node, &mesh.nodes, names::INSERT_NODES)?;
    let kind = if model.options.deformable {
        "C3D8"
    } else {
        "C3D8R"
    };
    let (first, node) = (labels.hexahedron, labels.insert_node);
    inp.hexahedra(kind, first, &mesh.hexes, node, names::INSERT)?;
    if model.options.deformable {
        let backside = backside(model).into_iter().map(|n| n + labels.insert_node);
        inp.node_set(names::BACKSIDE, backside)?;
    }
    inp.comment("The articulating surface.")?;
    let faces = element_faces(mesh, &in_mesh(&model.test.insert), labels.hexahedron);
    inp.surface_of_faces(names::ARTICULATING, &faces)?;
    let material = &model.case.material;
    let density = material.density_mg_per_mm3 / MG_PER_TONNE;
    let (young, poisson) = (material.youngs_modulus_mpa, material.poissons_ratio);
    inp.elastic_material(names::MATERIAL, young, poisson, density)?;
    inp.solid_section(names::INSERT, names::MATERIAL)
}

fn body_comment(model: &Model<'_>) -> &'static str {
    if model.options.deformable {
        "Elastic (C3D8: B-bar, so that it does not lock near incompressibility); its backside is held\n\
         by the reference node on the VV axis."
    } else {
        "Rigid, as in condyle: the elastic layer is in the pressure law of the contact. Abaqus wants\n\
         elements that could deform under a secondary surface, so these are C3D8R made rigid."
    }
}

/// Nodes of the faces that look down, ascending.
fn backside(model: &Model<'_>) -> Vec<u32> {
    let mesh = model.test.insert.mesh();
    let looks_down = |quad: &[u32; 4]| {
        let [a, b, c, d]: [Vec3; 4] = quad.map(|node| mesh.nodes[node as usize]);
        let normal = (c - a).cross(&(d - b));
        -normal.y > MIN_COSINE * normal.norm()
    };
    let quads = mesh.boundary_quads().into_iter().filter(looks_down);
    let nodes: std::collections::BTreeSet<u32> = quads.flatten().collect();
    nodes.into_iter().collect()
}

fn femur<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    let (labels, mesh) = (&model.labels, &model.femur);
    inp.comment(&format!(
        "\nFEMUR: {} rigid triangles; their outer side (SPOS) looks out of the metal.\n\
         condyle's femur is smooth; these facets are not.",
        mesh.triangles.len()
    ))?;
    let (first, node) = (labels.triangle, labels.femur_node);
    inp.nodes(node, &mesh.vertices, names::FEMUR_NODES)?;
    inp.triangles(
        RigidTriangle::R3d3,
        first,
        &mesh.triangles,
        node,
        names::FEMUR,
    )?;
    inp.surface_of_set(names::FEMUR_SURFACE, names::FEMUR)
}
