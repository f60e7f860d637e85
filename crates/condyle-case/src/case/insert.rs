//! The tibial insert.

use condyle::geometry::{CupShape, GenericInsertShape, Meshing, TroughShape};

use super::frame::{FileFrame, LengthUnit};
use crate::config::*;

settings! {
    /// The tibial insert.
    Insert [check] {
        /// Its shape.
        [flat] shape: InsertShape;
        /// Its placement in the holder.
        [flat] placement: InsertPlacement;
    }

    /// Two dishes with an eminence between.
    GenericInsert {
        /// Its dimensions.
        [flat] shape: GenericInsertShape;
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = Meshing::default().edge_mm, in within(0.1, 10.0);
        /// Hexahedra through the thickness. With enough of them, the top one is as thick as an edge is long, and the others are thicker downwards.
        layers: u64 = Meshing::default().layers as u64, in within(1.0, 40.0);
    }

    /// An insert whose triangle mesh is turned into columns of hexahedra.
    MeshInsert {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// The frame of the file.
        [flat] frame: FileFrame;
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = Meshing::default().edge_mm, in within(0.1, 10.0);
        /// Hexahedra through the thickness. With enough of them, the top one is as thick as an edge is long, and the others are thicker downwards.
        layers: u64 = Meshing::default().layers as u64, in within(1.0, 40.0);
        /// Height along y of the insert frame below which the mesh is cut off and closed flat, for an insert in one piece with its tray.
        clip_below_mm: Option<f64> = None, in within(-500.0, 500.0);
        /// Smallest thickness; only for an open articulating surface.
        thickness_mm: Option<f64> = None, in within(1.0, 50.0);
    }

    /// An insert read as hexahedra.
    HexahedralInsert {
        /// Abaqus .inp, Gmsh .msh or .vtu file, relative to the case file.
        file: DataFile;
        /// The frame of the file.
        [flat] frame: FileFrame;
        /// Name of the articulating surface in the file; by default the surface visible from above.
        articulating_surface: Option<String> = None;
        /// Name of the backside in the file; by default the surface visible from below.
        backside: Option<String> = None;
    }

    /// The hemispherical cup of a hip around the origin, below its head.
    CupInsert {
        /// Its dimensions and mounting.
        [flat] shape: CupShape;
        /// Edge of a hexahedron along the surface.
        edge_mm: f64 = 1.0, in within(0.1, 10.0);
        /// Hexahedra through the thickness. With enough of them, the top one is as thick as an edge is long, and the others are thicker downwards.
        layers: u64 = 6, in within(1.0, 40.0);
    }

    /// The cup of a hip whose closed triangle mesh is turned into columns of hexahedra along the radii of its socket. The centre of the socket comes to the origin.
    CupMeshInsert {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Direction in the file in which the cup opens, [x, y, z]; from the middle of its socket to the centre if not given.
        opens_along: Option<[f64; 3]> = None, in within(-1.0, 1.0);
        /// Angle between the plane of the opening and the plane across the load, in the frontal plane.
        inclination_deg: f64 = CupShape::default().inclination_deg, in within(0.0, 90.0);
        /// Rotation of the inclined cup about the load, + turns its opening from lateral to anterior.
        anteversion_deg: f64 = CupShape::default().anteversion_deg, in within(-90.0, 90.0);
        /// Edge of a hexahedron along the surface.
        edge_mm: f64 = 1.0, in within(0.1, 10.0);
        /// Hexahedra through the thickness. With enough of them, the top one is as thick as an edge is long, and the others are thicker downwards.
        layers: u64 = 6, in within(1.0, 40.0);
    }

    /// A cylindrical trough along z, such as the bearing of an ankle.
    TroughInsert {
        /// Its dimensions.
        [flat] shape: TroughShape;
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = 1.0, in within(0.1, 10.0);
        /// Hexahedra through the thickness. With enough of them, the top one is as thick as an edge is long, and the others are thicker downwards.
        layers: u64 = 6, in within(1.0, 40.0);
    }

    /// A cylindrical pin with its flat end up.
    PinInsert {
        /// Radius of the pin.
        radius_mm: f64 = 4.5, in within(0.5, 50.0);
        /// Height of the pin.
        thickness_mm: f64 = 10.0, in within(1.0, 50.0);
        /// Edge of a hexahedron along the surface.
        edge_mm: f64 = 0.5, in within(0.05, 10.0);
        /// Hexahedra through the height, as through a thickness.
        layers: u64 = 6, in within(1.0, 40.0);
    }

    /// A flat block, for verification.
    FlatInsert {
        /// Thickness.
        thickness_mm: f64 = GenericInsertShape::default().thickness_mm, in within(1.0, 50.0);
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = Meshing::default().edge_mm, in within(0.1, 10.0);
        /// Hexahedra through the thickness. With enough of them, the top one is as thick as an edge is long, and the others are thicker downwards.
        layers: u64 = Meshing::default().layers as u64, in within(1.0, 40.0);
    }
}

settings_of! {
    GenericInsertShape {
        /// Radius of each dish, seen from the side.
        sagittal_radius_mm: f64 = Self::default().sagittal_radius_mm, in within(5.0, 10000.0);
        /// Radius of each dish, seen from the front.
        coronal_radius_mm: f64 = Self::default().coronal_radius_mm, in within(2.0, 10000.0);
        /// Distance between the lowest lines of the dishes.
        spacing_mm: f64 = Self::default().spacing_mm, in within(10.0, 100.0);
        /// Smallest thickness.
        thickness_mm: f64 = Self::default().thickness_mm, in within(1.0, 50.0);
    }
}

settings_of! {
    CupShape {
        /// Inner radius of the cup: that of the head plus the radial clearance.
        radius_mm: f64 = Self::default().radius_mm, in within(5.0, 100.0);
        /// Thickness of the wall.
        thickness_mm: f64 = Self::default().thickness_mm, in within(1.0, 50.0);
        /// Angle between its axis and its rim, seen from the centre: 90 for a hemisphere, 20 to 50 for a shallow dish.
        opening_deg: f64 = Self::default().opening_deg, in within(10.0, 90.0);
        /// Angle between the plane of the opening and the plane across the load, in the frontal plane: on a machine about 10 to 15 degrees less than in a patient.
        inclination_deg: f64 = Self::default().inclination_deg, in within(0.0, 90.0);
        /// Rotation of the inclined cup about the load, + turns its opening from lateral to anterior.
        anteversion_deg: f64 = Self::default().anteversion_deg, in within(-90.0, 90.0);
    }
}

settings_of! {
    TroughShape {
        /// Radius of the cylinder: that of the counterface plus the radial clearance.
        radius_mm: f64 = Self::default().radius_mm, in within(5.0, 200.0);
        /// Length along x.
        length_mm: f64 = Self::default().length_mm, in within(5.0, 100.0);
        /// Width along z.
        width_mm: f64 = Self::default().width_mm, in within(5.0, 100.0);
        /// Thickness below the lowest line.
        thickness_mm: f64 = Self::default().thickness_mm, in within(1.0, 50.0);
    }
}

variants! {
    /// Shape of the tibial insert.
    InsertShape by
    /// Shape of the insert.
    shape = "generic" {
        /// Two dishes.
        Generic(GenericInsert) = "generic",
        /// A triangle mesh.
        Mesh(MeshInsert) = "mesh",
        /// A mesh of hexahedra.
        Hexahedra(HexahedralInsert) = "hexahedra",
        /// The cup of a hip.
        Cup(CupInsert) = "cup",
        /// The cup of a hip as a triangle mesh.
        CupMesh(CupMeshInsert) = "cup-mesh",
        /// A cylindrical trough, such as the bearing of an ankle.
        Trough(TroughInsert) = "trough",
        /// A pin.
        Pin(PinInsert) = "pin",
        /// A flat block, for verification.
        Flat(FlatInsert) = "flat",
    }
}

impl InsertShape {
    /// Returns whether the bearing surrounds its counterface, whose centre or axis then starts in its own.
    pub(super) fn is_round(&self) -> bool {
        matches!(self, Self::Cup(_) | Self::CupMesh(_) | Self::Trough(_))
    }
}

impl Insert {
    pub(super) fn frame(&self) -> Option<&FileFrame> {
        match &self.shape {
            InsertShape::Mesh(MeshInsert { frame, .. })
            | InsertShape::Hexahedra(HexahedralInsert { frame, .. }) => Some(frame),
            _ => None,
        }
    }

    /// Returns the mesh file, if there is one.
    pub fn file(&self) -> Option<&DataFile> {
        match &self.shape {
            InsertShape::Mesh(mesh) => Some(&mesh.file),
            InsertShape::CupMesh(mesh) => Some(&mesh.file),
            InsertShape::Hexahedra(mesh) => Some(&mesh.file),
            _ => None,
        }
    }

    #[cfg(feature = "file-system")]
    pub(super) fn file_mut(&mut self) -> Option<&mut DataFile> {
        match &mut self.shape {
            InsertShape::Mesh(mesh) => Some(&mut mesh.file),
            InsertShape::CupMesh(mesh) => Some(&mut mesh.file),
            InsertShape::Hexahedra(mesh) => Some(&mut mesh.file),
            _ => None,
        }
    }

    fn check(&self, section: &Section<'_>, log: &mut Log<'_>) {
        let has_placement = matches!(
            self.shape,
            InsertShape::Generic(_) | InsertShape::Mesh(_) | InsertShape::Hexahedra(_)
        );
        if !has_placement && self.placement.is_turned() {
            let needs = "shape = \"generic\", \"mesh\" or \"hexahedra\"";
            section.report_idle(names(&InsertPlacement::keys()), needs, log);
        }
    }
}

choice! {
    /// The point of an insert at the origin of the insert frame, on the machine's axes.
    InsertOrigin {
        /// The origin of its file.
        File = "file",
        /// Midpoint between the lowest points of its dishes.
        Centre = "centre",
    }
}

settings! {
    /// Placement of the insert in its holder: turned about the origin of the insert frame, first by the slope, then by the tilt, then by the rotation.
    InsertPlacement {
        /// The point of the insert at the origin of the insert frame, to which the machine's axes and the medial and lateral side refer: the file's origin, or the midpoint between the dishes; for a generic insert they coincide.
        origin: InsertOrigin = InsertOrigin::File;
        /// Posterior slope added to that of the shape, + lowers the posterior edge.
        posterior_slope_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// Tilt in the frontal plane, + lowers the medial edge: a component in varus.
        coronal_tilt_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// Rotation about the long axis, + internal: the front turns medially.
        axial_rotation_deg: f64 = 0.0, in within(-90.0, 90.0);
    }
}

impl InsertPlacement {
    pub(super) fn is_turned(&self) -> bool {
        [
            self.posterior_slope_deg,
            self.coronal_tilt_deg,
            self.axial_rotation_deg,
        ] != [0.0; 3]
    }
}
