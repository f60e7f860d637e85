//! A case back as a file.

use std::path::Path;

use super::contents::Case;
use super::machine::Preset;
use super::machine::{WriteWaveform, write_knots, write_name};
use super::reader::CaseReader;
use crate::config::{Settings, Variants, Writer};
use crate::files::MemoryFiles;

impl Case {
    /// The case as a file that reads back as an equal case: every default written out, waveforms
    /// as points, files by their absolute paths.
    pub fn to_toml(&self) -> String {
        self.written(write_knots)
    }

    pub(super) fn written(&self, write_waveform: WriteWaveform) -> String {
        let mut out = Writer::default();
        self.heading.write(&mut out);
        out.table("femur");
        self.femur.write(&mut out);
        self.femur_placement.write(&mut out);
        out.table("insert");
        self.insert.write(&mut out);
        self.insert_placement.write(&mut out);
        out.table("material");
        self.material.write(&mut out);
        out.table("contact");
        self.contact.write(&mut out);
        self.machine.write(write_waveform, &mut out);
        self.activities.write(write_waveform, &mut out);
        out.table("wear");
        self.wear.write(&mut out);
        out.table("creep");
        self.creep.write(&mut out);
        out.table("march");
        self.march.write(&mut out);
        out.table("time");
        self.time.write(&mut out);
        out.table("accuracy");
        self.accuracy.write(&mut out);
        out.table("limits");
        self.limits.write(&mut out);
        out.table("output");
        self.output.write(&mut out);
        out.into_text()
    }
}

/// A case to start from: every key with its default and its meaning.
pub fn template(preset: Preset) -> String {
    let text = format!("[machine]\npreset = {:?}\n", preset.word());
    match CaseReader::new(MemoryFiles::default()).parse(&text, "template", Path::new("")) {
        Ok(case) => case.written(write_name),
        Err(error) => unreachable!("the defaults are a case, a test reads them: {error}"),
    }
}
