//! The input file of a rigid femur pressed on the deformable insert.

use std::io::{self, Write};

use condyle::Vec3;
use condyle::contact::Bodies;
use condyle::geometry::TriangleMesh;
use condyle::spatial::Pose;
use condyle_fem::{Elastic, Hardening};

use super::facets::{facets, inside};
use condyle_mesh::formats::{InpWriter, element_faces};

/// Contact stiffness, MPa/mm: nodes under pressure overlap by some hundredths of a micrometre; a tenth of this stiffness
/// changes the force by a thousandth.
const STIFFNESS_MPA_PER_MM: f64 = 1e6;
/// Stiffness of sticking friction, MPa/mm: nodes slide after some hundredths of a millimetre.
const STICK_MPA_PER_MM: f64 = 100.0;
/// CalculiX can change a coefficient of friction in a later step only if there was one before.
const NEGLIGIBLE_FRICTION: f64 = 1e-9;
/// Smallest gap before the femur descends, mm.
const CLEARANCE_MM: f64 = 1e-3;
/// Thickness of the rigid wedges, mm; it has no effect, because all their nodes are prescribed.
const WEDGE_MM: f64 = 0.5;
/// Elastic constants of the prescribed wedges; they have no effect, but the format requires a material.
const METAL_MPA: f64 = 210_000.0;
const METAL_RATIO: f64 = 0.3;
/// Largest share of a step in one increment while an elastic insert is pressed, a yielding one is pressed, and while the
/// femur slides.
const ELASTIC_SHARE: f64 = 0.5;
const YIELDING_SHARE: f64 = 0.25;
const SLIDING_SHARE: f64 = 0.1;
/// Length of the last step of a slide, mm, and its largest share in one increment. CalculiX may search the facet over a
/// node once per increment, before the femur moves: the error of the normal is then its change over that increment.
const LAST_MM: f64 = 0.02;
const LAST_SHARE: f64 = 0.5;
const MIN_SHARE: f64 = 1e-6;
const MAX_INCREMENTS: u32 = 1000;

const HEAD: &str = "\nUNITS mm, N, MPa.
FRAME that of the insert: the counterface presses along -y; in a knee x is anterior, z lateral of a right one.
MODEL small displacements, as condyle's deformable insert: the steps have no NLGEOM. The insert is bonded
by its backside; the counterface is rigid and prescribed. The reaction is the total force on BACKSIDE, the pressure
that at the nodes of ARTICULATING.";

/// A slide of the pressed femur.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide {
    /// Displacement in the insert frame, mm.
    pub by_mm: Vec3,
    /// Coulomb's coefficient during the slide.
    pub friction: f64,
}

/// A femur pressed straight down on an insert without friction, then slid if `slide` is given.
///
/// The insert is bonded by its backside, and displacements are small, as in [`condyle::contact::Deformable`].
#[derive(Clone, Copy)]
pub struct Pressed<'a> {
    /// The file's title, one line.
    pub title: &'a str,
    /// Further lines of comment at the head of the file.
    pub note: &'a str,
    /// The bodies.
    pub bodies: Bodies<'a>,
    /// A coarse mesh of the femur in its own frame, anticlockwise seen from outside.
    pub triangles: &'a TriangleMesh,
    /// The insert's elasticity, MPa.
    pub elastic: Elastic,
    /// The insert's hardening, MPa, if it yields. Its kinematic modulus is not written.
    pub hardening: Option<&'a Hardening>,
    /// The femur's pose at the end of the descent, in the insert frame.
    pub pose: Pose,
    /// The slide after the descent.
    pub slide: Option<Slide>,
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
        self.insert(inp)?;
        self.femur(lift_mm, inp)?;
        self.materials(inp)?;
        self.contact(inp)?;
        inp.comment("\nSTEP PRESSED: the counterface descends from a pose without contact.")?;
        let down = Vec3::new(0.0, -lift_mm, 0.0);
        let share = match self.hardening {
            Some(_) => YIELDING_SHARE,
            None => ELASTIC_SHARE,
        };
        inp.keyword(&begin_step("PRESSED"))?;
        self.finish_step(share, &down, inp)?;
        let Some(slide) = &self.slide else {
            return Ok(());
        };
        inp.comment("\nSTEP SLIDING: it slides almost to the end of its path.")?;
        inp.keyword(&begin_step("SLIDING"))?;
        inp.keyword("*CHANGE FRICTION, INTERACTION=BEARING")?;
        friction(slide.friction, inp)?;
        let way_mm = slide.by_mm.norm();
        let nearly = (way_mm - LAST_MM).max(0.0) / way_mm;
        self.finish_step(SLIDING_SHARE, &(down + slide.by_mm * nearly), inp)?;
        inp.comment("\nSTEP SLID: it completes its path in short increments.")?;
        inp.keyword(&begin_step("SLID"))?;
        self.finish_step(LAST_SHARE, &(down + slide.by_mm), inp)
    }

    /// Returns the height above the pose at which no gap is smaller than the clearance.
    ///
    /// A gap grows no faster than the femur rises, so the height is approached from below.
    fn lift_mm(&self) -> f64 {
        const MAX_STEPS: usize = 100;
        const MIN_STEP_MM: f64 = 1e-4;
        let Bodies {
            counterface: femur,
            surface,
            ..
        } = self.bodies;
        let mut lift_mm = 0.0;
        for _ in 0..MAX_STEPS {
            let pose = shifted(&self.pose, Vec3::new(0.0, lift_mm, 0.0));
            let gaps = surface.positions.iter();
            let gaps = gaps.map(|node| femur.gap_mm(&pose.to_counterface(node)));
            let nearest_mm = gaps.fold(f64::INFINITY, f64::min);
            if nearest_mm >= CLEARANCE_MM {
                break;
            }
            lift_mm += (CLEARANCE_MM - nearest_mm).max(MIN_STEP_MM);
        }
        lift_mm
    }

    fn insert<W: Write>(&self, inp: &mut InpWriter<W>) -> io::Result<()> {
        let insert = self.bodies.insert;
        let mesh = insert.mesh();
        inp.comment(&format!(
            "\nINSERT: {} hexahedra with incompatible modes.",
            mesh.hexes.len()
        ))?;
        inp.nodes(1, &mesh.nodes, "INSERT-NODES")?;
        let corners: Vec<[u32; 8]> = mesh.hexes.iter().map(|hex| hex.map(|at| at + 1)).collect();
        inp.elements("C3D8I", 1, &corners, "INSERT")?;
        inp.node_set("BACKSIDE", insert.backside_nodes().iter().map(|at| at + 1))?;
        let in_mesh = |face: &[u32; 4]| face.map(|at| insert.surface_nodes()[at as usize]);
        let quads: Vec<[u32; 4]> = insert.surface_faces().iter().map(in_mesh).collect();
        inp.surface_of_faces("ARTICULATING", &element_faces(mesh, &quads, 1))
    }

    fn femur<W: Write>(&self, lift_mm: f64, inp: &mut InpWriter<W>) -> io::Result<()> {
        let Bodies {
            counterface: femur,
            insert,
            surface,
        } = self.bodies;
        let mut poses = vec![self.pose];
        poses.extend(self.slide.map(|slide| shifted(&self.pose, slide.by_mm)));
        let facets = facets(femur, self.triangles, &surface.positions, &poses);
        let outer = after(1, insert.mesh().nodes.len());
        let inner = after(outer, facets.vertices.len());
        let first_wedge = after(1, insert.mesh().hexes.len());
        inp.comment(&format!(
            "\nFEMUR: its part that may touch as {} wedges with all nodes prescribed.",
            facets.triangles.len()
        ))?;
        let start = shifted(&self.pose, Vec3::new(0.0, lift_mm, 0.0));
        let placed = |corners: &[Vec3]| -> Vec<Vec3> {
            corners.iter().map(|at| start.to_insert(at)).collect()
        };
        let within = inside(femur, &facets.vertices, WEDGE_MM);
        inp.nodes(outer, &placed(&facets.vertices), "FEMUR-NODES")?;
        inp.nodes(inner, &placed(&within), "FEMUR-NODES")?;
        let wedge = |&[a, b, c]: &[u32; 3]| {
            [
                a + inner,
                b + inner,
                c + inner,
                a + outer,
                b + outer,
                c + outer,
            ]
        };
        let wedges: Vec<[u32; 6]> = facets.triangles.iter().map(wedge).collect();
        inp.elements("C3D6", first_wedge, &wedges, "FEMUR")?;
        // Face 2 of a wedge is the one through its last three nodes.
        let outside: Vec<(u32, u8)> = (first_wedge..)
            .zip(&wedges)
            .map(|(at, _)| (at, 2))
            .collect();
        inp.surface_of_faces("FEMUR-SURFACE", &outside)
    }

    fn materials<W: Write>(&self, inp: &mut InpWriter<W>) -> io::Result<()> {
        let Elastic {
            youngs_modulus,
            poissons_ratio,
        } = self.elastic;
        inp.keyword("*MATERIAL, NAME=UHMWPE")?;
        inp.keyword("*ELASTIC")?;
        inp.reals(&[youngs_modulus, poissons_ratio])?;
        if let Some(hardening) = self.hardening {
            inp.comment("Von Mises: yield stress, MPa, over plastic strain.")?;
            inp.keyword("*PLASTIC")?;
            for &(strain, stress_mpa) in hardening.points() {
                inp.reals(&[stress_mpa, strain])?;
            }
        }
        inp.keyword("*SOLID SECTION, ELSET=INSERT, MATERIAL=UHMWPE")?;
        inp.comment("All nodes of the counterface are prescribed: its material has no effect.")?;
        inp.keyword("*MATERIAL, NAME=METAL")?;
        inp.keyword("*ELASTIC")?;
        inp.reals(&[METAL_MPA, METAL_RATIO])?;
        inp.keyword("*SOLID SECTION, ELSET=FEMUR, MATERIAL=METAL")
    }

    fn contact<W: Write>(&self, inp: &mut InpWriter<W>) -> io::Result<()> {
        inp.comment(
            "\nCONTACT. The nodes of the insert against the facets of the femur; stiff enough to be practically hard.",
        )?;
        inp.keyword("*SURFACE INTERACTION, NAME=BEARING")?;
        inp.keyword("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR")?;
        inp.reals(&[0.0, 0.0])?;
        inp.reals(&[STIFFNESS_MPA_PER_MM, 1.0])?;
        if self.slide.is_some() {
            inp.comment("Negligible friction while the femur descends.")?;
            friction(NEGLIGIBLE_FRICTION, inp)?;
        }
        inp.keyword("*CONTACT PAIR, INTERACTION=BEARING, TYPE=NODE TO SURFACE")?;
        inp.line("ARTICULATING, FEMUR-SURFACE")
    }

    /// Writes the rest of a step in which the femur moves to `to_mm` from its first position, in increments of at most
    /// `max_share` of the step.
    fn finish_step<W: Write>(
        &self,
        max_share: f64,
        to_mm: &Vec3,
        inp: &mut InpWriter<W>,
    ) -> io::Result<()> {
        inp.keyword("*STATIC")?;
        inp.reals(&[max_share, 1.0, MIN_SHARE, max_share])?;
        inp.keyword("*BOUNDARY")?;
        inp.line("BACKSIDE, 1, 3")?;
        inp.keyword("*BOUNDARY")?;
        for (freedom, to_mm) in (1..).zip(to_mm.iter()) {
            inp.line(&format!("FEMUR-NODES, {freedom}, {freedom}, {to_mm:?}"))?;
        }
        inp.keyword("*NODE PRINT, NSET=BACKSIDE, TOTALS=YES")?;
        inp.line("RF")?;
        inp.keyword("*NODE FILE")?;
        inp.line("U")?;
        inp.keyword("*CONTACT FILE")?;
        inp.line("CDISP, CSTRESS")?;
        if self.hardening.is_some() {
            inp.keyword(&format!(
                "*EL PRINT, ELSET=INSERT, FREQUENCY={MAX_INCREMENTS}"
            ))?;
            inp.line("PEEQ")?;
        }
        inp.keyword("*END STEP")
    }
}

fn shifted(pose: &Pose, by_mm: Vec3) -> Pose {
    Pose::new(pose.rotation, pose.translation + by_mm)
}

fn begin_step(name: &str) -> String {
    format!("*STEP, NAME={name}, INC={MAX_INCREMENTS}")
}

fn friction<W: Write>(coefficient: f64, inp: &mut InpWriter<W>) -> io::Result<()> {
    inp.keyword("*FRICTION")?;
    inp.reals(&[coefficient, STICK_MPA_PER_MM])
}

/// Returns a round label after `count` labels from `first`.
fn after(first: u32, count: usize) -> u32 {
    const ROUND: u32 = 100_000;
    (first + count as u32).div_ceil(ROUND) * ROUND + 1
}
