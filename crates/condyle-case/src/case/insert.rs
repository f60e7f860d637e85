//! The tibial insert.

use condyle::geometry::{GenericInsertShape, Meshing};

use super::frame::LengthUnit;
use super::frame::Side;
use super::frame::{Axes, check as check_axes};
use super::table::{Context, Table, WearLaws, WriteWaveform};
use crate::config::{
    DataFile, Log, Page, Section, Settings, TableSchema, Variants, Writer, choice, settings,
    variants, within,
};

settings! {
    /// Two dishes with an eminence between.
    GenericInsert {
        /// Radius of each dish, seen from the side.
        sagittal_radius_mm: f64 = GenericInsertShape::default().sagittal_radius_mm, in within(5.0, 10000.0);
        /// Radius of each dish, seen from the front.
        coronal_radius_mm: f64 = GenericInsertShape::default().coronal_radius_mm, in within(2.0, 10000.0);
        /// Distance between the lowest lines of the dishes.
        spacing_mm: f64 = GenericInsertShape::default().spacing_mm, in within(10.0, 100.0);
        /// Thickness where it is thinnest.
        thickness_mm: f64 = GenericInsertShape::default().thickness_mm, in within(1.0, 50.0);
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = Meshing::default().edge_mm, in within(0.1, 10.0);
        /// Hexahedra through the thickness.
        layers: u64 = Meshing::default().layers as u64, in within(1.0, 40.0);
    }

    /// An insert whose triangle mesh is turned into columns of hexahedra.
    MeshInsert {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = Meshing::default().edge_mm, in within(0.1, 10.0);
        /// Hexahedra through the thickness.
        layers: u64 = Meshing::default().layers as u64, in within(1.0, 40.0);
        /// Height along y of the insert frame below which the mesh is cut away and closed flat: for an insert that its file fuses with the tray.
        clip_below_mm: Option<f64> = None, in within(-500.0, 500.0);
        /// Thickness where it is thinnest: only for an open articulating surface, which has none of its own.
        thickness_mm: Option<f64> = None, in within(1.0, 50.0);
    }

    /// An insert read as hexahedra.
    HexahedralInsert {
        /// Abaqus .inp, Gmsh .msh or .vtu file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Name in the file of the surface that articulates; found from above if not given.
        articulating_surface: Option<String> = None;
        /// Name in the file of the backside; found from below if not given.
        backside: Option<String> = None;
    }

    /// A flat block, for verification.
    FlatInsert {
        /// Thickness.
        thickness_mm: f64 = GenericInsertShape::default().thickness_mm, in within(1.0, 50.0);
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = Meshing::default().edge_mm, in within(0.1, 10.0);
        /// Hexahedra through the thickness.
        layers: u64 = Meshing::default().layers as u64, in within(1.0, 40.0);
    }
}

variants! {
    /// The tibial insert.
    Insert by
    /// What the insert is made from.
    shape = "generic" {
        /// Two dishes.
        Generic(GenericInsert) = "generic",
        /// A triangle mesh.
        Mesh(MeshInsert) = "mesh",
        /// A mesh of hexahedra.
        Hexahedra(HexahedralInsert) = "hexahedra",
        /// A flat block, for verification.
        Flat(FlatInsert) = "flat",
    }
}

impl Insert {
    /// Reads `[insert]` of a `side` knee.
    pub(super) fn read_checked(
        section: &Section<'_>,
        side: Side,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let insert = Self::read(section, &InsertPlacement::keys(), log)?;
        if let Some(axes) = insert.axes() {
            check_axes(axes, side, section.value_span("axes"), log);
        }
        Some(insert)
    }

    /// Where the axes of its mesh file point, if it comes from one.
    fn axes(&self) -> Option<&Axes> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.axes),
            Self::Hexahedra(mesh) => Some(&mesh.axes),
            Self::Generic(_) | Self::Flat(_) => None,
        }
    }

    /// The mesh file it comes from, if any.
    pub fn file(&self) -> Option<&DataFile> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.file),
            Self::Hexahedra(mesh) => Some(&mesh.file),
            Self::Generic(_) | Self::Flat(_) => None,
        }
    }

    #[cfg(feature = "file-system")]
    pub(super) fn file_mut(&mut self) -> Option<&mut DataFile> {
        match self {
            Self::Mesh(mesh) => Some(&mut mesh.file),
            Self::Hexahedra(mesh) => Some(&mut mesh.file),
            Self::Generic(_) | Self::Flat(_) => None,
        }
    }
}

choice! {
    /// What of an insert is put at the origin of the insert frame, where the machine's axes are.
    InsertOrigin {
        /// The origin of its file.
        File = "file",
        /// Half-way between the lowest places of its dishes.
        Centre = "centre",
    }
}

settings! {
    /// How the insert sits in its holder: turned about the origin of the insert frame, first by the slope, then by the tilt, then by the rotation.
    InsertPlacement {
        /// What of the insert is at the origin of the insert frame, from which the machine's axes and the medial and lateral side count: the file's origin, or half-way between the dishes; of a generic insert they are the same.
        origin: InsertOrigin = InsertOrigin::File;
        /// Posterior slope added to what the shape has, + lowers the posterior edge.
        posterior_slope_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// Tilt in the frontal plane, + lowers the medial edge: a component in varus.
        coronal_tilt_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// Turn about the long axis, + internal: the front goes medially.
        axial_rotation_deg: f64 = 0.0, in within(-90.0, 90.0);
    }
}

impl InsertPlacement {
    /// Reads the placement from the table of its insert; a flat block has none.
    pub(super) fn read_checked(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let placement = Self::read(section, log)?;
        if section.word("shape") == Some("flat") && placement.is_turned() {
            section.report_idle(&Self::keys(), "another shape than \"flat\"", log);
        }
        Some(placement)
    }

    /// Whether it turns the insert.
    pub(super) fn is_turned(&self) -> bool {
        [
            self.posterior_slope_deg,
            self.coronal_tilt_deg,
            self.axial_rotation_deg,
        ] != [0.0; 3]
    }
}

impl Table for Insert {
    const NAME: &'static str = "insert";

    fn read_in(root: &Section<'_>, context: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read_checked(&root.table(Self::NAME, log), context.side, log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let table = TableSchema::new("The tibial insert.")
            .with_choices(&Self::choices())
            .with_keys(&InsertPlacement::keys());
        case.with_table(Self::NAME, table)
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        let choices = Self::choices();
        page.chosen(
            "`[insert]`",
            &[vec![choices.by.clone()], InsertPlacement::keys()].concat(),
            &choices,
        );
    }
}

impl Table for InsertPlacement {
    const NAME: &'static str = "insert";

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
