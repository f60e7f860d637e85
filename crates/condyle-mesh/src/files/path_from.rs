//! The way from a folder to a file.

use std::path::{Component, Path, PathBuf};

/// The path of `file` counted from `folder`, both absolute and without `..` or links; none where
/// they have nothing in common, as on two drives.
pub fn path_from(folder: &Path, file: &Path) -> Option<PathBuf> {
    let both = folder.components().zip(file.components());
    let common = both.take_while(|(one, other)| one == other).count();
    let up = folder
        .components()
        .skip(common)
        .map(|_| Component::ParentDir);
    let down = file.components().skip(common);
    (common > 0).then(|| up.chain(down).collect())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn up_to_what_is_common_and_down_again() {
        let from = |folder, file| path_from(Path::new(folder), Path::new(file));
        assert_eq!(from("/a/b", "/a/b/c.stl"), Some("c.stl".into()));
        assert_eq!(from("/a/b/c", "/a/d/e.stl"), Some("../../d/e.stl".into()));
        assert_eq!(from("/a", "/b.stl"), Some("../b.stl".into()));
        assert_eq!(from("a", "b.stl"), None);
    }
}
