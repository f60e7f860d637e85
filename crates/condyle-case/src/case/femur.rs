//! The femoral component.

use condyle::geometry::GenericFemurShape;

use super::frame::FileFrame;
use crate::config::*;

settings! {
    /// The femoral component.
    Femur [check] {
        /// Its shape.
        [flat] shape: FemurShape;
        /// Its placement on the bone.
        [flat] placement: FemurPlacement;
    }

    /// A pair of condyles, each a piece of torus.
    GenericFemur {
        /// Its dimensions.
        [flat] shape: GenericFemurShape;
        /// Start of the femoral frame in the insert frame, [x, z], before it settles; over the dish if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// One sphere, such as the head of a hip.
    SphereFemur {
        /// Radius of the sphere.
        radius_mm: f64 = 24.0, in within(1.0, 500.0);
        /// Start of its centre in the insert frame, [x, z], before it settles; over the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// One endless cylinder about the medio-lateral axis, for verification.
    CylinderFemur {
        /// Radius of the cylinder.
        radius_mm: f64 = 24.0, in within(1.0, 500.0);
        /// Start of its axis in the insert frame, [x, z], before it settles; over the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// A femoral component read from a triangle mesh.
    MeshFemur {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// The frame of the file.
        [flat] frame: FileFrame;
        /// Point of the file that is the origin of the femoral frame, along its axes after `axes` and `rotation_deg`; the file's own if not given.
        origin_mm: Option<[f64; 3]> = None, in within(-100_000.0, 100_000.0);
        /// Flexion axis [x, y] in the femoral frame; if not given, fitted to the posterior condyles of a knee, to the dome of a talus,
        /// to the ball or socket of other joints, and at the origin if there is none.
        flexion_axis_mm: Option<[f64; 2]> = None, in within(-200.0, 200.0);
        /// Start of the femoral frame in the insert frame, [x, z], before it settles; if not given, at the origin, or with its axis in the
        /// centre of a cup or trough.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }
}

settings_of! {
    GenericFemurShape {
        /// Radius of the distal arc, seen from the side.
        distal_radius_mm: f64 = Self::default().distal_radius_mm, in within(5.0, 200.0);
        /// Radius of the posterior arc, seen from the side.
        posterior_radius_mm: f64 = Self::default().posterior_radius_mm, in within(5.0, 200.0);
        /// Start of the posterior arc, measured backwards from straight down.
        transition_deg: f64 = Self::default().transition_deg, in within(0.0, 90.0);
        /// Radius of each condyle, seen from the front.
        coronal_radius_mm: f64 = Self::default().coronal_radius_mm, in within(2.0, 200.0);
        /// Distance between the lowest lines of the condyles.
        spacing_mm: f64 = Self::default().spacing_mm, in within(10.0, 100.0);
    }
}

variants! {
    /// Shape of the femoral component.
    FemurShape by
    /// Shape of the femoral component.
    shape = "generic" {
        /// A pair of condyles, each a piece of torus.
        Generic(GenericFemur) = "generic",
        /// A triangle mesh.
        Mesh(MeshFemur) = "mesh",
        /// One sphere, such as the head of a hip.
        Sphere(SphereFemur) = "sphere",
        /// One cylinder about the medio-lateral axis, for verification.
        Cylinder(CylinderFemur) = "cylinder",
        /// A plane that faces down.
        Plane = "plane",
    }
}

impl Femur {
    /// Returns the mesh file, if there is one.
    pub fn file(&self) -> Option<&DataFile> {
        let FemurShape::Mesh(mesh) = &self.shape else {
            return None;
        };
        Some(&mesh.file)
    }

    #[cfg(feature = "file-system")]
    pub(super) fn file_mut(&mut self) -> Option<&mut DataFile> {
        let FemurShape::Mesh(mesh) = &mut self.shape else {
            return None;
        };
        Some(&mut mesh.file)
    }

    fn check(&self, section: &Section<'_>, log: &mut Log<'_>) {
        let has_placement = matches!(self.shape, FemurShape::Generic(_) | FemurShape::Mesh(_));
        if !has_placement && self.placement.is_moved() {
            let needs = "shape = \"generic\" or \"mesh\"";
            section.report_idle(names(&FemurPlacement::keys()), needs, log);
        }
    }
}

settings! {
    /// Placement of the femoral component on its bone: turned about the flexion axis, first by flexion, then by varus, then by rotation, and then shifted; the axis stays.
    FemurPlacement {
        /// Flexion of the component on the bone, + turns its front upwards and forwards: the bone is then flexed relative to the component.
        flexion_deg: f64 = 0.0, in within(-45.0, 45.0);
        /// Varus of the component on the bone, + lowers its lateral condyle.
        varus_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// External rotation of the component on the bone, + turns its front laterally.
        external_rotation_deg: f64 = 0.0, in within(-45.0, 45.0);
        /// Anterior offset from its place in the file.
        anterior_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
        /// Superior offset from its place in the file.
        superior_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
        /// Lateral offset from its place in the file; if ML is free, the component finds its own place.
        lateral_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
    }
}

impl FemurPlacement {
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
