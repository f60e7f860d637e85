//! ParaView collections (`.pvd`): a series of files, each at a time.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use super::{
    error::MeshFileError,
    text::{At, decode},
    vtk_xml::parse_xml,
    vtu_write::escaped,
};

/// Returns the text of a `.pvd` file: of each data set the time, the number of its part, such as a body, and its file,
/// relative to the collection.
///
/// For a wear test the time is the number of cycles.
pub fn pvd_text<'a>(series: impl IntoIterator<Item = (f64, usize, &'a str)>) -> String {
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

/// Reads the time of each data set and its file, joined to the collection's folder, from the bytes of the
/// `.pvd` file at `path`.
///
/// # Errors
/// Content that is not XML, a data set without a time or a file.
pub fn parse_pvd(path: &Path, bytes: &[u8]) -> Result<Vec<(f64, PathBuf)>, MeshFileError> {
    let content = decode(bytes);
    let document = parse_xml(path, &content)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let nodes = document.descendants();
    let sets = nodes.filter(|node| node.has_tag_name("DataSet"));
    sets.map(|node| {
        let time = node
            .attribute("timestep")
            .and_then(|time| time.parse().ok());
        let file = node.attribute("file").map(|file| folder.join(file));
        time.zip(file).ok_or_else(|| {
            let line = document.text_pos_at(node.range().start).row as usize;
            At::line(path, line).error("a DataSet needs a number as timestep, and a file")
        })
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{read_pvd, tests::message};

    #[test]
    fn times_and_files_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("insert.pvd");
        let text = pvd_text([(0.0, 0, "insert_0000.vtu"), (5e5, 0, "insert_0001.vtu")]);
        std::fs::write(&path, text).unwrap();
        let series = read_pvd(&path).unwrap();
        assert_eq!(series[0], (0.0, folder.path().join("insert_0000.vtu")));
        assert_eq!(series[1].0, 500_000.0);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("insert.pvd");
        let text = pvd_text([(0.0, 0, "a.vtu")]).replace("timestep=\"0\"", "timestep=\"now\"");
        std::fs::write(&path, text).unwrap();
        assert!(message(read_pvd(&path)).contains("pvd:4: a DataSet needs a number"));
        std::fs::write(&path, "<VTKFile>").unwrap();
        assert!(message(read_pvd(&path)).contains("pvd:1: is not XML"));
        let reported = message(read_pvd(folder.path().join("none.pvd")));
        assert!(reported.contains("there is no such file"), "{reported}");
    }
}
