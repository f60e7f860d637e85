//! The simulator: reference nodes, rigid bodies, connectors, springs, inertia and damping.

use std::io::{self, Write};

use condyle::Vec3;
use condyle::machine::{Spring, knee};

use super::model::Model;
use super::names;
use condyle_mesh::formats::InpWriter;

/// How far the table of a spring reaches beyond its free play, mm.
const SPRING_REACH_MM: f64 = 100.0;

const ABOUT: &str = "\nMACHINE. The simulator's frame is the global one: x anterior, y superior, z lateral.
  insert -- VV hinge about x -- CARRIAGE (turns IE about y, slides ML along z and AP along x) -- frame
  femur -- FEMUR-REF (turns in flexion about z, slides IS along y) -- frame
FEMUR-REF lies on the flexion axis, CARRIAGE on the IE axis, INSERT-REF on the VV axis. Each of the
first two turns about one axis only, so its rotation is an angle and not a vector of large rotations:
  AP = U1 of CARRIAGE (+ anterior)     ML = U3 of CARRIAGE (+ lateral)     IE = UR2 of CARRIAGE (+ internal)
  IS = U2 of FEMUR-REF (+ superior)    flexion = UR3 of FEMUR-REF (+ flexion)
  VV = CUR1 of VV-HINGE (+ varus)
All of them count from the pose in which the file begins.";

pub(super) fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    inp.comment(ABOUT)?;
    nodes(model, inp)?;
    rigid_bodies(model, inp)?;
    let mut element = model.labels.machine;
    joints(model, &mut element, inp)?;
    springs(model, &mut element, inp)?;
    inertias(model, &mut element, inp)
}

/// The next element label.
fn next(element: &mut u32) -> u32 {
    *element += 1;
    *element - 1
}

fn nodes<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    let labels = &model.labels;
    inp.nodes(
        labels.femur_ref,
        &[model.flexion_centre()],
        names::FEMUR_REF,
    )?;
    inp.nodes(labels.carriage, &[model.ie_centre()], names::CARRIAGE)?;
    inp.nodes(labels.hinge, &[model.vv_centre()], names::CARRIAGE_NODES)?;
    inp.nodes(labels.insert_ref, &[model.vv_centre()], names::INSERT_REF)?;
    let held = |spring: &Spring| model.ie_centre() + Vec3::z() * spring.offset_mm;
    let held: Vec<Vec3> = model.test.machine().springs.iter().map(held).collect();
    if held.is_empty() {
        return Ok(());
    }
    inp.nodes(labels.spring, &held, names::CARRIAGE_NODES)
}

fn rigid_bodies<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    let labels = &model.labels;
    inp.rigid_body(names::FEMUR, labels.femur_ref)?;
    inp.keyword(&format!(
        "*RIGID BODY, REF NODE={}, TIE NSET={}",
        labels.carriage,
        names::CARRIAGE_NODES
    ))?;
    if model.options.deformable {
        inp.keyword(&format!(
            "*RIGID BODY, REF NODE={}, PIN NSET={}",
            labels.insert_ref,
            names::BACKSIDE
        ))
    } else {
        inp.rigid_body(names::INSERT, labels.insert_ref)
    }
}

fn joints<W: Write>(
    model: &Model<'_>,
    element: &mut u32,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    let labels = &model.labels;
    let damping = |freedom| model.test.machine().joint(freedom).damping;
    let frame = Some(names::FRAME);
    inp.orientation(names::FRAME, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
    inp.comment("Carriage: damping of AP (1), ML (3) and IE (5), N s/mm and N mm s/rad.")?;
    let nodes = (None, labels.carriage);
    inp.connector(
        names::CARRIAGE_JOINT,
        next(element),
        nodes,
        "CARTESIAN, CARDAN",
        frame,
    )?;
    inp.connector_behavior(names::CARRIAGE_JOINT)?;
    inp.connector_damping(1, damping(knee::AP))?;
    inp.connector_damping(3, damping(knee::ML))?;
    inp.connector_damping(5, damping(knee::IE))?;
    inp.comment("Femur: damping of IS (2) and flexion (6).")?;
    let nodes = (None, labels.femur_ref);
    inp.connector(
        names::FEMUR_JOINT,
        next(element),
        nodes,
        "CARTESIAN, CARDAN",
        frame,
    )?;
    inp.connector_behavior(names::FEMUR_JOINT)?;
    inp.connector_damping(2, damping(knee::IS))?;
    inp.connector_damping(6, damping(knee::FLEXION))?;
    inp.comment(
        "The insert turns on the carriage about the VV axis, which the carriage carries along.",
    )?;
    let nodes = (Some(labels.hinge), labels.insert_ref);
    inp.connector(names::HINGE, next(element), nodes, "HINGE", frame)?;
    inp.connector_behavior(names::HINGE)?;
    inp.connector_damping(4, damping(knee::VV))
}

fn springs<W: Write>(
    model: &Model<'_>,
    element: &mut u32,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    let springs = &model.test.machine().springs;
    inp.comment(
        "Springs from the frame to points of the carriage, along x whatever the carriage turns.\n\
         Rows: force on the frame, N; anterior motion of the point, mm. No force within the free play.",
    )?;
    for (i, (node, spring)) in (model.labels.spring..).zip(springs).enumerate() {
        let name = format!("AP-SPRING-{}", i + 1);
        let nodes = (None, node);
        inp.comment(&format!("{} mm lateral of the IE axis.", spring.offset_mm))?;
        inp.connector(&name, next(element), nodes, "CARTESIAN", Some(names::FRAME))?;
        inp.connector_behavior(&name)?;
        inp.connector_elasticity(1, &spring_table(spring))?;
    }
    Ok(())
}

/// (force, motion) from far posterior to far anterior; the connector's force has the sign of the
/// motion it resists.
fn spring_table(spring: &Spring) -> Vec<(f64, f64)> {
    let play = spring.free_play_mm;
    let far = play + SPRING_REACH_MM;
    let row = |motion: f64| (-spring.force(motion).0, motion);
    let mut table = vec![row(-far), (0.0, -play), (0.0, play), row(far)];
    table.dedup_by(|later, earlier| later.1 <= earlier.1);
    table
}

fn inertias<W: Write>(
    model: &Model<'_>,
    element: &mut u32,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    let labels = &model.labels;
    let inertia = |freedom| model.test.machine().joint(freedom).inertia;
    let (ap, ml) = (inertia(knee::AP), inertia(knee::ML));
    let (vv, ie) = (inertia(knee::VV), inertia(knee::IE));
    // What turns with VV also turns with IE; a body without inertia about a free axis, or with more
    // about one axis than about the other two together, is refused.
    let shared = vv.min(ie / 2.0);
    inp.comment(
        "Inertia, tonne and tonne mm2. Part of that of IE sits on the insert, which turns with it.",
    )?;
    mass(
        inp,
        names::CARRIAGE,
        next(element),
        labels.carriage,
        [ap, ap.max(ml), ml],
    )?;
    rotary(
        inp,
        names::CARRIAGE,
        next(element),
        labels.carriage,
        [ie - shared; 3],
    )?;
    rotary(
        inp,
        names::INSERT_REF,
        next(element),
        labels.insert_ref,
        [vv, shared, shared],
    )?;
    let is = inertia(knee::IS);
    mass(
        inp,
        names::FEMUR_REF,
        next(element),
        labels.femur_ref,
        [is; 3],
    )?;
    let flexion = inertia(knee::FLEXION);
    rotary(
        inp,
        names::FEMUR_REF,
        next(element),
        labels.femur_ref,
        [flexion; 3],
    )
}

/// A point mass, or one for each direction where they differ.
fn mass<W: Write>(
    inp: &mut InpWriter<W>,
    name: &str,
    element: u32,
    node: u32,
    tonne: [f64; 3],
) -> io::Result<()> {
    if tonne == [0.0; 3] {
        return Ok(());
    }
    inp.keyword(&format!("*ELEMENT, TYPE=MASS, ELSET={name}-MASS"))?;
    inp.line(&format!("{element}, {node}"))?;
    let is_one = tonne.iter().all(|&m| m == tonne[0]);
    if is_one {
        inp.keyword(&format!("*MASS, ELSET={name}-MASS"))?;
        return inp.reals(&tonne[..1]);
    }
    inp.keyword(&format!("*MASS, ELSET={name}-MASS, TYPE=ANISOTROPIC"))?;
    inp.reals(&tonne)
}

fn rotary<W: Write>(
    inp: &mut InpWriter<W>,
    name: &str,
    element: u32,
    node: u32,
    [x, y, z]: [f64; 3],
) -> io::Result<()> {
    if [x, y, z] == [0.0; 3] {
        return Ok(());
    }
    inp.keyword(&format!("*ELEMENT, TYPE=ROTARYI, ELSET={name}-INERTIA"))?;
    inp.line(&format!("{element}, {node}"))?;
    inp.keyword(&format!("*ROTARY INERTIA, ELSET={name}-INERTIA"))?;
    inp.reals(&[x, y, z, 0.0, 0.0, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spring(free_play_mm: f64) -> Spring {
        Spring {
            along: knee::AP,
            about: knee::IE,
            offset_mm: 28.0,
            positive_n_per_mm: 3.62,
            negative_n_per_mm: 16.9,
            free_play_mm,
        }
    }

    #[test]
    fn verify_a_spring_resists_both_ways_behind_its_free_play() {
        let expected = [(-1690.0, -102.5), (0.0, -2.5), (0.0, 2.5), (362.0, 102.5)];
        for (row, expected) in spring_table(&spring(2.5)).into_iter().zip(expected) {
            assert!((row.0 - expected.0).abs() < 1e-9 && row.1 == expected.1);
        }
    }

    #[test]
    fn without_free_play_no_motion_stands_twice() {
        let motions: Vec<f64> = spring_table(&spring(0.0)).iter().map(|row| row.1).collect();
        assert_eq!(motions, [-100.0, 0.0, 100.0]);
    }
}
