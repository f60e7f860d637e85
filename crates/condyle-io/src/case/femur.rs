//! The two bodies.

use super::axes;
use super::declared::{
    CylinderFemur, FlatInsert, GenericFemur, GenericInsert, HexahedralInsert, MeshFemur,
    MeshInsert, Side, SphereFemur,
};
use super::files::DataFile;
use super::keys::{Key, Settings, choice};
use super::parse::{Log, Others, Section, names};

choice! {
    /// What the femoral component is made from.
    FemurShape {
        /// A pair of condyles, each a piece of torus.
        Generic = "generic",
        /// A triangle mesh.
        Mesh = "mesh",
        /// One sphere.
        Sphere = "sphere",
        /// One cylinder.
        Cylinder = "cylinder",
    }

    /// What the insert is made from.
    InsertShape {
        /// Two dishes.
        Generic = "generic",
        /// A triangle mesh.
        Mesh = "mesh",
        /// A mesh of hexahedra.
        Hexahedra = "hexahedra",
        /// A flat block.
        Flat = "flat",
    }
}

/// The femoral component.
#[derive(Clone, Debug, PartialEq)]
pub enum Femur {
    /// A pair of condyles, each a piece of torus.
    Generic(GenericFemur),
    /// A triangle mesh.
    Mesh(MeshFemur),
    /// One sphere, for verification.
    Sphere(SphereFemur),
    /// One cylinder about the medio-lateral axis, for verification.
    Cylinder(CylinderFemur),
}

/// The tibial insert.
#[derive(Clone, Debug, PartialEq)]
pub enum Insert {
    /// Two dishes.
    Generic(GenericInsert),
    /// A triangle mesh.
    Mesh(MeshInsert),
    /// A mesh of hexahedra.
    Hexahedra(HexahedralInsert),
    /// A flat block, for verification.
    Flat(FlatInsert),
}

/// The key that chooses the shape of a body.
pub(super) const FEMUR_SHAPE: Key = Key {
    name: "shape",
    doc: "What the femoral component is made from.",
    kind: <FemurShape as super::setting::Setting>::kind,
    default: Some(|| Some("\"generic\"".to_owned())),
    limits: None,
};

/// The key that chooses the shape of the insert.
pub(super) const INSERT_SHAPE: Key = Key {
    name: "shape",
    doc: "What the insert is made from.",
    kind: <InsertShape as super::setting::Setting>::kind,
    default: Some(|| Some("\"generic\"".to_owned())),
    limits: None,
};

impl Femur {
    /// Words for `shape` and the keys each brings.
    pub(super) const SHAPES: &'static [(&'static str, &'static [Key])] = &[
        ("generic", GenericFemur::KEYS),
        ("mesh", MeshFemur::KEYS),
        ("sphere", SphereFemur::KEYS),
        ("cylinder", CylinderFemur::KEYS),
    ];

    pub(super) fn read(section: &Section<'_>, side: Side, log: &mut Log<'_>) -> Option<Self> {
        let shape = section.setting(&FEMUR_SHAPE, Some(FemurShape::Generic), log)?;
        check_keys(section, shape.word(), Self::SHAPES, log);
        let femur = match shape {
            FemurShape::Generic => Self::Generic(GenericFemur::read(section, log)?),
            FemurShape::Mesh => Self::Mesh(MeshFemur::read(section, log)?),
            FemurShape::Sphere => Self::Sphere(SphereFemur::read(section, log)?),
            FemurShape::Cylinder => Self::Cylinder(CylinderFemur::read(section, log)?),
        };
        if let Self::Mesh(mesh) = &femur {
            axes::check(&mesh.axes, side, section.value_span("axes"), log);
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

    /// The word for its shape.
    pub fn shape(&self) -> &'static str {
        match self {
            Self::Generic(_) => FemurShape::Generic.word(),
            Self::Mesh(_) => FemurShape::Mesh.word(),
            Self::Sphere(_) => FemurShape::Sphere.word(),
            Self::Cylinder(_) => FemurShape::Cylinder.word(),
        }
    }
}

impl Insert {
    /// Words for `shape` and the keys each brings.
    pub(super) const SHAPES: &'static [(&'static str, &'static [Key])] = &[
        ("generic", GenericInsert::KEYS),
        ("mesh", MeshInsert::KEYS),
        ("hexahedra", HexahedralInsert::KEYS),
        ("flat", FlatInsert::KEYS),
    ];

    pub(super) fn read(section: &Section<'_>, side: Side, log: &mut Log<'_>) -> Option<Self> {
        let shape = section.setting(&INSERT_SHAPE, Some(InsertShape::Generic), log)?;
        check_keys(section, shape.word(), Self::SHAPES, log);
        let insert = match shape {
            InsertShape::Generic => Self::Generic(GenericInsert::read(section, log)?),
            InsertShape::Mesh => Self::Mesh(MeshInsert::read(section, log)?),
            InsertShape::Hexahedra => Self::Hexahedra(HexahedralInsert::read(section, log)?),
            InsertShape::Flat => Self::Flat(FlatInsert::read(section, log)?),
        };
        let axes = match &insert {
            Self::Mesh(mesh) => Some(&mesh.axes),
            Self::Hexahedra(mesh) => Some(&mesh.axes),
            Self::Generic(_) | Self::Flat(_) => None,
        };
        if let Some(axes) = axes {
            axes::check(axes, side, section.value_span("axes"), log);
        }
        Some(insert)
    }

    /// The mesh file it comes from, if any.
    pub fn file(&self) -> Option<&DataFile> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.file),
            Self::Hexahedra(mesh) => Some(&mesh.file),
            Self::Generic(_) | Self::Flat(_) => None,
        }
    }

    /// The word for its shape.
    pub fn shape(&self) -> &'static str {
        match self {
            Self::Generic(_) => InsertShape::Generic.word(),
            Self::Mesh(_) => InsertShape::Mesh.word(),
            Self::Hexahedra(_) => InsertShape::Hexahedra.word(),
            Self::Flat(_) => InsertShape::Flat.word(),
        }
    }
}

fn check_keys(section: &Section<'_>, shape: &str, all: &[(&str, &[Key])], log: &mut Log<'_>) {
    let own = all.iter().filter(|(word, _)| *word == shape);
    let mut known: Vec<&str> = own.flat_map(|(_, keys)| names(keys)).collect();
    known.push("shape");
    let others = Others {
        key: "shape",
        word: shape,
        all,
    };
    section.check_keys(&known, &others, log);
}
