//! ParaView collections (`.pvd`): a series of files, each at a time.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use roxmltree::Document;

use super::{
    error::{FileLine, MeshFileError},
    text,
    vtu_write::escaped,
};

/// The text of a `.pvd` file: each data set's time and its file relative to the collection.
///
/// For a wear test the time is the number of cycles.
pub fn pvd_text<'a>(series: impl IntoIterator<Item = (f64, &'a str)>) -> String {
    let parts = series.into_iter().map(|(time, file)| (time, 0, file));
    pvd_text_of_parts(parts)
}

/// The text of a `.pvd` file with several parts, such as bodies, at each time: time, number of the part,
/// and file.
pub fn pvd_text_of_parts<'a>(series: impl IntoIterator<Item = (f64, usize, &'a str)>) -> String {
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
         byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (time, part, file) in series {
        let file = escaped(file);
        let _ = writeln!(
            xml,
            "<DataSet timestep=\"{time}\" part=\"{part}\" file=\"{file}\"/>"
        );
    }
    xml.push_str("</Collection>\n</VTKFile>\n");
    xml
}

/// Each data set's time and its file, joined to the collection's folder, from the bytes of the
/// `.pvd` file called `path`.
///
/// # Errors
/// No collection, a data set without a time or a file.
pub fn parse_pvd(path: &Path, bytes: &[u8]) -> Result<Vec<(f64, PathBuf)>, MeshFileError> {
    let content = text::decode(bytes);
    let document = Document::parse(&content).map_err(|error| {
        let line = error.pos().row as usize;
        FileLine::line(path, line).error(format!("is not XML: {error}"))
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let sets = document
        .descendants()
        .filter(|node| node.has_tag_name("DataSet"));
    sets.map(|node| {
        let time = node
            .attribute("timestep")
            .and_then(|time| time.parse().ok());
        let line = document.text_pos_at(node.range().start).row as usize;
        time.zip(node.attribute("file"))
            .map(|(time, file)| (time, folder.join(file)))
            .ok_or_else(|| {
                FileLine::line(path, line).error("a DataSet needs a number as timestep, and a file")
            })
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{
        fixtures::message,
        on_disk::{read_pvd, write_pvd},
    };

    #[test]
    fn times_and_files_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("insert.pvd");
        write_pvd(&path, [(0.0, "insert_0000.vtu"), (5e5, "insert_0001.vtu")]).unwrap();
        let series = read_pvd(&path).unwrap();
        assert_eq!(series[0], (0.0, folder.path().join("insert_0000.vtu")));
        assert_eq!(series[1].0, 500_000.0);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("insert.pvd");
        let text = pvd_text([(0.0, "a.vtu")]).replace("timestep=\"0\"", "timestep=\"now\"");
        std::fs::write(&path, text).unwrap();
        assert!(message(read_pvd(&path)).contains("pvd:4: a DataSet needs a number"));
        std::fs::write(&path, "<VTKFile>").unwrap();
        assert!(message(read_pvd(&path)).contains("pvd:1: is not XML"));
        let said = message(read_pvd(folder.path().join("none.pvd")));
        assert!(said.contains("there is no such file"), "{said}");
    }
}
