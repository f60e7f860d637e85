//! A rigid femur pressed on the deformable insert, bodies alone: a file that CalculiX and Abaqus read.

use std::io::{self, Write};

use condyle::Vec3;
use condyle::contact::Bodies;
use condyle::geometry::TriangleMesh;
use condyle::spatial::Pose;
use condyle_fem::{Elastic, Hardening};

use super::facets::{facets, inside};
use super::lift::lift;
use super::model::{after, in_mesh};
use super::names;
use condyle_mesh::formats::{InpWriter, PressureOverclosure, element_faces};

/// Pressure over overlap of the contact, MPa/mm: nodes that press overlap by some hundredths of a micrometre, and a
/// tenth of this changes the force by a thousandth.
const STIFFNESS_MPA_PER_MM: f64 = 1e6;
/// Friction over slip while a node sticks, MPa/mm: after some hundredths of a millimetre all slide.
const STICK_MPA_PER_MM: f64 = 100.0;
/// Where CalculiX is to change the friction, there must have been some.
const AS_GOOD_AS_NONE: f64 = 1e-9;
/// Smallest gap before the femur comes down, mm.
const CLEARANCE_MM: f64 = 1e-3;
/// Thickness of the rigid wedges, mm; it is of no matter.
const WEDGE_MM: f64 = 0.5;
/// Most of a step in an increment: of pressing an elastic insert, one that yields, and of sliding.
const ELASTIC: f64 = 0.5;
const YIELDING: f64 = 0.25;
const SLIDING: f64 = 0.1;
/// The last way of a slide, mm, and most of that step in an increment. CalculiX may look for the facet over a node once an
/// increment, before the femur moves in it: what it finds is then as wrong as the femur's normal turns over an increment.
const LAST_MM: f64 = 0.02;
const ARRIVING: f64 = 0.5;

/// Most increments of a step.
const MAX_INCREMENTS: u32 = 1000;

/// How far the pressed femur slides on, and the friction while it slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide {
    /// Way in the insert frame, mm.
    pub by_mm: Vec3,
    /// Coulomb's coefficient.
    pub friction: f64,
}

/// A femur that is pressed straight down on an insert to a pose, without friction unless it slides on from there.
///
/// The insert is bonded by its backside. Everything is small displacements, as in [`condyle::contact::Deformable`].
#[derive(Clone, Copy)]
pub struct Pressed<'a> {
    /// A line that says what it is.
    pub title: &'a str,
    /// More lines for the head of the file.
    pub note: &'a str,
    /// The bodies.
    pub bodies: Bodies<'a>,
    /// The femur, coarsely; in its own frame, anticlockwise seen from outside.
    pub triangles: &'a TriangleMesh,
    /// The insert's elasticity, MPa.
    pub elastic: Elastic,
    /// How its yield stress rises, MPa, if it yields. Its kinematic modulus is not written.
    pub hardening: Option<&'a Hardening>,
    /// Where the femur ends pressed, in the insert frame.
    pub pose: Pose,
    /// What it does then.
    pub slide: Option<Slide>,
}

/// The first labels of the bodies.
struct Labels {
    hexahedron: u32,
    wedge: u32,
    node: u32,
    outer: u32,
    inner: u32,
}

impl Pressed<'_> {
    /// Writes the file, in mm, N and MPa and in the insert frame.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let (lift_mm, inp) = (self.lift_mm(), &mut InpWriter::new(out));
        inp.heading(self.title)?;
        inp.comment(self.note)?;
        inp.comment(HEAD)?;
        let labels = self.bodies(lift_mm, inp)?;
        self.insert_surfaces(&labels, inp)?;
        self.materials(inp)?;
        self.contact(inp)?;
        inp.comment("\nSTEP PRESSED: the femur comes straight down from where nothing touches.")?;
        let press = if self.hardening.is_some() {
            YIELDING
        } else {
            ELASTIC
        };
        let down = Vec3::new(0.0, -lift_mm, 0.0);
        begin_step("PRESSED", inp)?;
        self.end_step(press, &down, inp)?;
        match &self.slide {
            Some(slide) => self.slide(slide, &down, inp),
            None => Ok(()),
        }
    }

    /// Steps in which the femur, pressed by `down`, slides on.
    fn slide<W: Write>(
        &self,
        slide: &Slide,
        down: &Vec3,
        inp: &mut InpWriter<W>,
    ) -> io::Result<()> {
        inp.comment("\nSTEP SLIDING: it slides on,")?;
        begin_step("SLIDING", inp)?;
        inp.keyword(&format!("*CHANGE FRICTION, INTERACTION={}", names::BEARING))?;
        friction(slide.friction, inp)?;
        let way_mm = slide.by_mm.norm();
        let nearly = (way_mm - LAST_MM).max(0.0) / way_mm;
        self.end_step(SLIDING, &(down + slide.by_mm * nearly), inp)?;
        inp.comment("\nSTEP SLID: and arrives, in short increments.")?;
        begin_step("SLID", inp)?;
        self.end_step(ARRIVING, &(down + slide.by_mm), inp)
    }

    /// The rest of a step in which the femur goes to `to_mm` from where the file begins, in increments of `most` of it.
    fn end_step<W: Write>(
        &self,
        most: f64,
        to_mm: &Vec3,
        inp: &mut InpWriter<W>,
    ) -> io::Result<()> {
        lead(most, to_mm, inp)?;
        if self.hardening.is_some() {
            inp.keyword(&format!(
                "*EL PRINT, ELSET={}, FREQUENCY={}",
                names::INSERT,
                MAX_INCREMENTS
            ))?;
            inp.line("PEEQ")?;
        }
        inp.end_step()
    }

    /// How far above the pose nothing touches.
    fn lift_mm(&self) -> f64 {
        let Bodies { femur, surface, .. } = self.bodies;
        let mut lift_mm = 0.0;
        lift(CLEARANCE_MM, |way_mm| {
            lift_mm += way_mm;
            let pose = raised(&self.pose, lift_mm);
            let gaps = surface.positions.iter();
            let gaps = gaps.map(|node| femur.gap_mm(&pose.to_femur(node)));
            gaps.fold(f64::INFINITY, f64::min)
        });
        lift_mm
    }

    /// Nodes and elements of both, and the femur's surface.
    fn bodies<W: Write>(&self, lift_mm: f64, inp: &mut InpWriter<W>) -> io::Result<Labels> {
        let Bodies {
            femur,
            insert,
            surface,
        } = self.bodies;
        let mut poses = vec![self.pose];
        poses.extend(self.slide.map(|slide| shifted(&self.pose, slide.by_mm)));
        let facets = facets(femur, self.triangles, &surface.positions, &poses);
        let mesh = insert.mesh();
        let outer = after(1, mesh.nodes.len());
        let labels = Labels {
            hexahedron: 1,
            wedge: after(1, mesh.hexes.len()),
            node: 1,
            outer,
            inner: after(outer, facets.vertices.len()),
        };
        inp.comment(&format!(
            "\nINSERT: {} hexahedra with incompatible modes.",
            mesh.hexes.len()
        ))?;
        inp.nodes(labels.node, &mesh.nodes, names::INSERT_NODES)?;
        inp.hexahedra(
            "C3D8I",
            labels.hexahedron,
            &mesh.hexes,
            labels.node,
            names::INSERT,
        )?;
        inp.comment(&format!(
            "\nFEMUR: its part that may touch as {} wedges, led by all their nodes.",
            facets.triangles.len()
        ))?;
        let start = raised(&self.pose, lift_mm);
        let placed = |corners: &[Vec3]| {
            corners
                .iter()
                .map(|at| start.to_insert(at))
                .collect::<Vec<_>>()
        };
        let within = inside(femur, &facets.vertices, WEDGE_MM);
        inp.nodes(labels.outer, &placed(&facets.vertices), names::FEMUR_NODES)?;
        inp.nodes(labels.inner, &placed(&within), names::FEMUR_NODES)?;
        let wedge = |corners: &[u32; 3]| {
            let ([a, b, c], [d, e, f]) = (
                corners.map(|at| at + labels.inner),
                corners.map(|at| at + labels.outer),
            );
            [a, b, c, d, e, f]
        };
        let wedges: Vec<[u32; 6]> = facets.triangles.iter().map(wedge).collect();
        inp.wedges(labels.wedge, &wedges, 0, names::FEMUR)?;
        let outside: Vec<(u32, u8)> = (labels.wedge..)
            .zip(&wedges)
            .map(|(label, _)| (label, 2))
            .collect();
        inp.surface_of_faces(names::FEMUR_SURFACE, &outside)?;
        Ok(labels)
    }

    fn insert_surfaces<W: Write>(&self, labels: &Labels, inp: &mut InpWriter<W>) -> io::Result<()> {
        let insert = self.bodies.insert;
        let held = insert
            .backside_nodes()
            .iter()
            .map(|node| node + labels.node);
        inp.node_set(names::BACKSIDE, held)?;
        let faces = element_faces(insert.mesh(), &in_mesh(insert), labels.hexahedron);
        inp.surface_of_faces(names::ARTICULATING, &faces)
    }

    fn materials<W: Write>(&self, inp: &mut InpWriter<W>) -> io::Result<()> {
        let Elastic {
            youngs_modulus,
            poissons_ratio,
        } = self.elastic;
        inp.keyword(&format!("*MATERIAL, NAME={}", names::MATERIAL))?;
        inp.keyword("*ELASTIC")?;
        inp.reals(&[youngs_modulus, poissons_ratio])?;
        if let Some(hardening) = self.hardening {
            inp.comment("Von Mises: yield stress, MPa, over plastic strain.")?;
            inp.keyword("*PLASTIC")?;
            for &(strain, stress_mpa) in hardening.points() {
                inp.reals(&[stress_mpa, strain])?;
            }
        }
        inp.solid_section(names::INSERT, names::MATERIAL)?;
        inp.comment("The femur's nodes are all led: its material is of no matter.")?;
        inp.keyword(&format!("*MATERIAL, NAME={}", names::METAL))?;
        inp.keyword("*ELASTIC")?;
        inp.reals(&[METAL_MPA, METAL_RATIO])?;
        inp.solid_section(names::FEMUR, names::METAL)
    }

    fn contact<W: Write>(&self, inp: &mut InpWriter<W>) -> io::Result<()> {
        inp.comment(CONTACT)?;
        let most_mm = 1.0;
        let law = [0.0, most_mm].map(|overclosure_mm| PressureOverclosure {
            pressure_mpa: STIFFNESS_MPA_PER_MM * overclosure_mm,
            overclosure_mm,
        });
        inp.softened(names::BEARING, &law)?;
        if self.slide.is_some() {
            inp.comment("As good as no friction while the femur comes down.")?;
            friction(AS_GOOD_AS_NONE, inp)?;
        }
        inp.nodes_on_surface(names::BEARING, names::ARTICULATING, names::FEMUR_SURFACE)
    }
}

/// Young's modulus and Poisson's ratio of a cobalt-chromium alloy; any would do.
const METAL_MPA: f64 = 210_000.0;
const METAL_RATIO: f64 = 0.3;

const HEAD: &str = "\nUNITS mm, N, MPa.
FRAME that of the insert: x anterior, y superior, z lateral of a right knee.
MODEL small displacements, as condyle's deformable insert: the steps have no NLGEOM. The insert is bonded
by its backside; the femur is rigid and led. The reaction is the total force on BACKSIDE, the pressure
that at the nodes of ARTICULATING.";

const CONTACT: &str = "\nCONTACT. The nodes of the insert against the facets of the femur, so stiff that it is as good as hard.";

fn raised(pose: &Pose, by_mm: f64) -> Pose {
    shifted(pose, Vec3::new(0.0, by_mm, 0.0))
}

fn shifted(pose: &Pose, by_mm: Vec3) -> Pose {
    Pose::new(pose.rotation, pose.translation + by_mm)
}

fn begin_step<W: Write>(name: &str, inp: &mut InpWriter<W>) -> io::Result<()> {
    inp.keyword(&format!("*STEP, NAME={name}, INC={MAX_INCREMENTS}"))
}

/// A coefficient, and how stiffly CalculiX's nodes stick.
fn friction<W: Write>(coefficient: f64, inp: &mut InpWriter<W>) -> io::Result<()> {
    inp.keyword("*FRICTION")?;
    inp.reals(&[coefficient, STICK_MPA_PER_MM])
}

/// The femur goes to `to_mm` from where the file begins, in increments of `most` of the step; and what is to be said.
fn lead<W: Write>(most: f64, to_mm: &Vec3, inp: &mut InpWriter<W>) -> io::Result<()> {
    const LEAST: f64 = 1e-6;
    inp.keyword("*STATIC")?;
    inp.reals(&[most, 1.0, LEAST, most])?;
    inp.fixed(names::BACKSIDE, 1, 3)?;
    inp.keyword("*BOUNDARY")?;
    for (freedom, to_mm) in (1..).zip(to_mm.iter()) {
        inp.line(&format!(
            "{}, {freedom}, {freedom}, {to_mm:?}",
            names::FEMUR_NODES
        ))?;
    }
    inp.keyword(&format!(
        "*NODE PRINT, NSET={}, TOTALS=YES",
        names::BACKSIDE
    ))?;
    inp.line("RF")?;
    inp.keyword("*NODE FILE")?;
    inp.line("U")?;
    inp.keyword("*CONTACT FILE")?;
    inp.line("CDISP, CSTRESS")
}
