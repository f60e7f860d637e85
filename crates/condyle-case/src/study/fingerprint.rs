//! A hash of all that the tests of a study follow from.

use std::io;

use super::contents::Study;
use super::declared::Design;
use crate::case::Assignment;
use crate::config::{Settings, Writer};

impl Study {
    /// Hash of the case, its meshes, what varies and how tests are chosen, in hexadecimal.
    ///
    /// What is asked does not count, nor where files lie; of a search what is minimised and its limits do, since its tests
    /// follow from them.
    ///
    /// # Errors
    /// A file that can no longer be read.
    pub fn inputs_blake3(&self) -> io::Result<String> {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.case.inputs_blake3()?.as_bytes());
        hasher.update(self.in_words().as_bytes());
        for file in self.files() {
            let bytes = self.cases.files().read(&file)?;
            hasher.update(blake3::hash(&bytes).as_bytes());
        }
        Ok(hasher.finalize().to_hex().to_string())
    }

    fn in_words(&self) -> String {
        let mut out = Writer::default();
        for input in &self.inputs {
            out.line(&input.key, "");
            input.variation.write(&mut out);
        }
        match &self.design {
            Design::Rows(_) => out.line(&format!("{:?}", self.rows), ""),
            Design::Optimise(keys) => {
                keys.write(&mut out);
                let bounds = self.answers.bounds.iter();
                let bound = bounds.map(|bound| (bound.output.key, bound.least, bound.most));
                out.line(&format!("{:?}", bound.collect::<Vec<_>>()), "");
            }
            design => design.write(&mut out),
        }
        out.line(&format!("{:?}", self.correlations), "");
        for design in &self.alternatives {
            let set: Vec<String> = design.set.iter().map(Assignment::to_string).collect();
            out.line(&design.name, &set.join(", "));
        }
        out.into_text()
    }
}
