//! The readers of files that a user or another program wrote.

use std::{path::Path, sync::Arc};

use condyle_case::{
    cache::{Cache, Keep},
    case::{CaseReader, Side},
    measured::Measured,
    study::Study,
};
use condyle_mesh::files::{Files, MemoryFiles};
use condyle_mesh::formats::{parse_pvd, parse_surface, parse_vtu_points, read_hexahedra};
use condyle_mesh::repair::{Checks, Parts, Touching};
use condyle_results::Checkpoint;

use super::seeds;

/// Reads the bytes of a file, or refuses them.
pub type Read = dyn Fn(&[u8]);

/// A reader with valid files for it.
pub struct Reader {
    /// Without a hyphen, which ends it in the names of inputs.
    pub name: &'static str,
    pub corpus: Vec<Vec<u8>>,
    pub read: Box<Read>,
}

impl Reader {
    fn new(name: &'static str, corpus: Vec<Vec<u8>>, read: impl Fn(&[u8]) + 'static) -> Self {
        let read = Box::new(read);
        Self { name, corpus, read }
    }
}

/// Returns all readers; `folder` is for the cache.
pub fn all(folder: &Path) -> Vec<Reader> {
    vec![
        Reader::new("stl", seeds::stl(), |bytes| surface("a.stl", bytes)),
        Reader::new("obj", seeds::obj(), |bytes| surface("a.obj", bytes)),
        Reader::new("ply", seeds::ply(), |bytes| surface("a.ply", bytes)),
        Reader::new("vtp", seeds::vtp(), |bytes| surface("a.vtp", bytes)),
        Reader::new("vtu", seeds::vtu(), vtu),
        Reader::new("msh", seeds::msh(), |bytes| hexahedra("a.msh", bytes)),
        Reader::new("inp", seeds::inp(), |bytes| hexahedra("a.inp", bytes)),
        Reader::new("pvd", seeds::pvd(), |bytes| {
            drop(parse_pvd(Path::new("a.pvd"), bytes));
        }),
        Reader::new("case", seeds::case(), |bytes| case("case.toml", bytes)),
        Reader::new("waveform", seeds::waveform(), |bytes| {
            case("wave.csv", bytes);
        }),
        Reader::new("pressure_table", seeds::pressure_table(), |bytes| {
            case("table.csv", bytes);
        }),
        Reader::new("strain_table", seeds::strain_table(), |bytes| {
            case("strain.csv", bytes);
        }),
        Reader::new("study", seeds::study(), |bytes| study("study.toml", bytes)),
        Reader::new("study_rows", seeds::study_rows(), |bytes| {
            study("rows.csv", bytes);
        }),
        Reader::new("measured", seeds::measured("measured.toml"), |bytes| {
            measured("measured.toml", bytes);
        }),
        Reader::new("kinematics", seeds::measured("kinematics.csv"), |bytes| {
            measured("kinematics.csv", bytes);
        }),
        Reader::new("masses", seeds::measured("masses.csv"), |bytes| {
            measured("masses.csv", bytes);
        }),
        Reader::new("scan", seeds::measured("scan.csv"), |bytes| {
            measured("scan.csv", bytes);
        }),
        Reader::new("checkpoint", seeds::checkpoint(), checkpoint),
        cached(folder),
    ]
}

/// Reads a surface and checks it as an insert's and as a femur's.
fn surface(name: &str, bytes: &[u8]) {
    let Ok(mesh) = parse_surface(Path::new(name), bytes) else {
        return;
    };
    for (touching, parts, clip_below_mm) in [
        (Touching::FromAbove, Parts::SeenFromAbove, Some(2.0)),
        (Touching::FromBelowAndBehind, Parts::All, None),
    ] {
        let checks = Checks {
            touching,
            parts,
            clip_below_mm,
        };
        if let Err(error) = checks.check(mesh.clone()) {
            let _ = error.to_string();
        }
    }
}

fn hexahedra(name: &str, bytes: &[u8]) {
    let files = MemoryFiles::default().with(name, bytes);
    if let Ok(file) = read_hexahedra(&files, name) {
        let _ = file.mesh.boundary_quads();
    }
}

fn vtu(bytes: &[u8]) {
    hexahedra("a.vtu", bytes);
    let _ = parse_vtu_points(Path::new("a.vtu"), bytes);
}

/// Reads a case with one corrupted file, and renders its problems.
fn case(name: &str, bytes: &[u8]) {
    // A case has one law of pressure.
    let path = match name {
        "strain.csv" => "strain.toml",
        _ => "case.toml",
    };
    let read = CaseReader::new(good_files().with(name, bytes)).read(Path::new(path));
    if let Err(problems) = read {
        let _ = problems.to_string();
    }
}

fn good_files() -> MemoryFiles {
    let files = seeds::case_files().into_iter();
    files.fold(MemoryFiles::default(), |files, (name, content)| {
        files.with(name, content)
    })
}

/// Reads a study of a case with one corrupted file.
fn study(name: &str, bytes: &[u8]) {
    let files = good_files().with(name, bytes);
    let path = match name {
        "rows.csv" => "rows.toml",
        _ => "study.toml",
    };
    if let Err(problems) = Study::read_in(files, Path::new(path)) {
        let _ = problems.to_string();
    }
}

/// Reads measured data with one corrupted file.
fn measured(name: &str, bytes: &[u8]) {
    let mut files = MemoryFiles::default();
    for good in seeds::MEASURED {
        files = files.with(good, seeds::measured(good).remove(0));
    }
    let files: Arc<dyn Files> = Arc::new(files.with(name, bytes));
    if let Err(problems) = Measured::read_from(&files, Path::new("measured.toml"), Side::Right) {
        let _ = problems.to_string();
    }
}

/// Reads a checkpoint as it is, and with its hash corrected, as another version may have written it.
fn checkpoint(bytes: &[u8]) {
    let _ = Checkpoint::from_bytes(bytes);
    let (magic, hash) = (20, 32);
    if let Some(content) = bytes.get(magic + hash..) {
        let sealed = [&bytes[..magic], blake3::hash(content).as_bytes(), content].concat();
        let _ = Checkpoint::from_bytes(&sealed);
    }
}

/// Reads a damaged field of the cache, which must be found intact or not at all.
fn cached(folder: &Path) -> Reader {
    const INPUTS: &[&[u8]] = &[b"input"];
    let cache = Cache::in_folder(folder);
    let content: Vec<u8> = (0..300u32).flat_map(u32::to_le_bytes).collect();
    cache.keep("field", INPUTS, &content);
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let Some(file) = files.map(|file| file.path()).next() else {
        return Reader::new("cached_field", vec![Vec::new()], |_| ());
    };
    let corpus = vec![std::fs::read(&file).unwrap_or_default()];
    Reader::new("cached_field", corpus, move |bytes| {
        if std::fs::write(&file, bytes).is_ok() {
            let found = cache.find("field", INPUTS);
            assert!(
                found.is_none_or(|found| found == content),
                "a damaged field was read"
            );
        }
    })
}
