//! The femoral component.

use condyle::geometry::GenericFemurShape;

use super::frame::LengthUnit;
use super::frame::Side;
use super::frame::{Axes, check as check_axes};
use super::table::{Context, Table, WearLaws, WriteWaveform};
use crate::config::{
    DataFile, Log, Page, Section, Settings, TableSchema, Variants, Writer, settings, variants,
    within,
};

settings! {
    /// A pair of condyles, each a piece of torus.
    GenericFemur {
        /// Radius of the distal arc, seen from the side.
        distal_radius_mm: f64 = GenericFemurShape::default().distal_radius_mm, in within(5.0, 200.0);
        /// Radius of the posterior arc, seen from the side.
        posterior_radius_mm: f64 = GenericFemurShape::default().posterior_radius_mm, in within(5.0, 200.0);
        /// Where the posterior arc takes over, behind straight down.
        transition_deg: f64 = GenericFemurShape::default().transition_deg, in within(0.0, 90.0);
        /// Radius of each condyle, seen from the front.
        coronal_radius_mm: f64 = GenericFemurShape::default().coronal_radius_mm, in within(2.0, 200.0);
        /// Distance between the lowest lines of the condyles.
        spacing_mm: f64 = GenericFemurShape::default().spacing_mm, in within(10.0, 100.0);
        /// Where the femoral frame starts in the insert frame, [x, z], before it settles; over the dish if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// One sphere, for verification.
    SphereFemur {
        /// Radius of the sphere.
        radius_mm: f64 = 24.0, in within(1.0, 500.0);
        /// Where its centre starts in the insert frame, [x, z], before it settles; over the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// One endless cylinder about the medio-lateral axis, for verification.
    CylinderFemur {
        /// Radius of the cylinder.
        radius_mm: f64 = 24.0, in within(1.0, 500.0);
        /// Where its axis starts in the insert frame, [x, z], before it settles; over the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// A femoral component read from a triangle mesh.
    MeshFemur {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Flexion axis [x, y] in the femoral frame; fitted to the posterior condyles if not given.
        flexion_axis_mm: Option<[f64; 2]> = None, in within(-200.0, 200.0);
        /// Where the femoral frame starts in the insert frame, [x, z], before it settles; at the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }
}

variants! {
    /// The femoral component.
    Femur by
    /// What the femoral component is made from.
    shape = "generic" {
        /// A pair of condyles, each a piece of torus.
        Generic(GenericFemur) = "generic",
        /// A triangle mesh.
        Mesh(MeshFemur) = "mesh",
        /// One sphere, for verification.
        Sphere(SphereFemur) = "sphere",
        /// One cylinder about the medio-lateral axis, for verification.
        Cylinder(CylinderFemur) = "cylinder",
    }
}

impl Femur {
    /// Reads `[femur]` of a `side` knee.
    pub(super) fn read_checked(
        section: &Section<'_>,
        side: Side,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let femur = Self::read(section, &FemurPlacement::keys(), log)?;
        if let Self::Mesh(mesh) = &femur {
            check_axes(&mesh.axes, side, section.value_span("axes"), log);
        }
        Some(femur)
    }

    /// The mesh file it comes from, if any.
    pub fn file(&self) -> Option<&DataFile> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.file),
            Self::Generic(_) | Self::Sphere(_) | Self::Cylinder(_) => None,
        }
    }

    #[cfg(feature = "file-system")]
    pub(super) fn file_mut(&mut self) -> Option<&mut DataFile> {
        match self {
            Self::Mesh(mesh) => Some(&mut mesh.file),
            Self::Generic(_) | Self::Sphere(_) | Self::Cylinder(_) => None,
        }
    }
}

settings! {
    /// How the femoral component sits on its bone: turned about the flexion axis, first by flexion, then by varus, then by rotation, and then shifted; the axis stays.
    FemurPlacement {
        /// Flexion of the component on the bone, + brings its front up and forward, as a flexed bone over a component that lies still.
        flexion_deg: f64 = 0.0, in within(-45.0, 45.0);
        /// Varus of the component on the bone, + lowers its lateral condyle.
        varus_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// External rotation of the component on the bone, + turns its front laterally.
        external_rotation_deg: f64 = 0.0, in within(-45.0, 45.0);
        /// How far anterior of its place by the file it sits.
        anterior_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
        /// How far superior of its place by the file it sits.
        superior_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
        /// How far lateral of its place by the file it sits; where ML is free, it finds its own place.
        lateral_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
    }
}

impl FemurPlacement {
    /// Reads the placement from the table of its femur; the shapes for verification have none.
    pub(super) fn read_checked(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let placement = Self::read(section, log)?;
        let of_verification = matches!(section.word("shape"), Some("sphere" | "cylinder"));
        if of_verification && placement.is_moved() {
            section.report_idle(&Self::keys(), "shape = \"generic\" or \"mesh\"", log);
        }
        Some(placement)
    }

    /// Whether it turns or shifts the femoral component.
    pub(super) fn is_moved(&self) -> bool {
        self.numbers() != [0.0; 6]
    }

    /// Degrees and mm, in the order of the keys.
    pub(super) fn numbers(&self) -> [f64; 6] {
        [
            self.flexion_deg,
            self.varus_deg,
            self.external_rotation_deg,
            self.anterior_offset_mm,
            self.superior_offset_mm,
            self.lateral_offset_mm,
        ]
    }
}

impl Table for Femur {
    const NAME: &'static str = "femur";

    fn read_in(root: &Section<'_>, context: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read_checked(&root.table(Self::NAME, log), context.side, log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let table = TableSchema::new("The femoral component.")
            .with_choices(&Self::choices())
            .with_keys(&FemurPlacement::keys());
        case.with_table(Self::NAME, table)
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        let choices = Self::choices();
        page.chosen(
            "`[femur]`",
            &[vec![choices.by.clone()], FemurPlacement::keys()].concat(),
            &choices,
        );
    }
}

impl Table for FemurPlacement {
    const NAME: &'static str = "femur";

    fn read_in(root: &Section<'_>, _: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read_checked(&root.part(Self::NAME), log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        case
    }

    fn add_to_page(_: &mut Page, _: WearLaws) {}
}
