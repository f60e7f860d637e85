//! A case back as a file.

use condyle::machine::{Interpolation, Waveform};

use super::channel::Channel;
use super::contact::{self, PressureLawChoice};
use super::declared::{Preset, Rotation, Translation};
use super::keys::{Key, Settings};
use super::machine::{FREEDOMS, PRESET};
use super::setting::Setting;
use super::shapes::{FEMUR_SHAPE, INSERT_SHAPE};
use super::waveforms::DEFAULT_WAVEFORM;
use super::{Case, Femur, Insert, unit_of};

/// A case file being written.
#[derive(Default)]
pub struct Writer {
    text: String,
}

/// Column at which comments start, where the value is short enough.
const COMMENT_COLUMN: usize = 40;

impl Writer {
    /// Starts a table.
    fn table(&mut self, path: &str) {
        self.text.push_str(&format!("\n[{path}]\n"));
    }

    fn comment(&mut self, text: &str) {
        self.text.push_str(&format!("# {text}\n"));
    }

    /// Writes a key with its value and what it means; a value that is left out only as a remark.
    pub(crate) fn setting<T: Setting>(&mut self, key: &Key, value: &T) {
        match value.text() {
            Some(text) => self.line(&format!("{} = {text}", key.name), key.doc),
            None => self.line(&format!("# {} =", key.name), key.doc),
        }
    }

    fn line(&mut self, assignment: &str, doc: &str) {
        let doc = doc.trim();
        let line = format!("{assignment:<COMMENT_COLUMN$} # {doc}\n");
        self.text.push_str(&line);
    }

    /// Writes pairs of numbers, a few on each line.
    fn pairs(&mut self, key: &str, pairs: &[(f64, f64)]) {
        const PAIRS_ON_A_LINE: usize = 4;
        self.text.push_str(&format!("{key} = [\n"));
        for some in pairs.chunks(PAIRS_ON_A_LINE) {
            let some: Vec<String> = some
                .iter()
                .map(|(a, b)| format!("[{a:?}, {b:?}]"))
                .collect();
            self.text.push_str(&format!("    {},\n", some.join(", ")));
        }
        self.text.push_str("]\n");
    }
}

impl Case {
    /// The case as a file that reads back as an equal case: every default written out, waveforms
    /// as points, files by their absolute paths.
    pub fn to_toml(&self) -> String {
        self.written(write_knots)
    }

    fn written(&self, write_waveform: impl Fn(&mut Writer, Channel, &Waveform)) -> String {
        let mut out = Writer::default();
        self.heading.write(&mut out);
        self.write_bodies(&mut out);
        out.table("material");
        self.material.write(&mut out);
        self.write_contact(&mut out);
        self.write_machine(&mut out, write_waveform);
        out.table("wear");
        self.wear.write(&mut out);
        out.table("march");
        self.march.write(&mut out);
        out.table("time");
        self.time.write(&mut out);
        out.table("accuracy");
        self.accuracy.write(&mut out);
        out.text
    }

    fn write_bodies(&self, out: &mut Writer) {
        out.table("femur");
        out.setting(&FEMUR_SHAPE, &self.femur.shape().to_owned());
        match &self.femur {
            Femur::Generic(femur) => femur.write(out),
            Femur::Mesh(femur) => femur.write(out),
            Femur::Sphere(femur) => femur.write(out),
            Femur::Cylinder(femur) => femur.write(out),
        }
        out.table("insert");
        out.setting(&INSERT_SHAPE, &self.insert.shape().to_owned());
        match &self.insert {
            Insert::Generic(insert) => insert.write(out),
            Insert::Mesh(insert) => insert.write(out),
            Insert::Hexahedra(insert) => insert.write(out),
            Insert::Flat(insert) => insert.write(out),
        }
    }

    fn write_contact(&self, out: &mut Writer) {
        out.table("contact");
        out.setting(&contact::LAW, &self.contact.law.form());
        if let PressureLawChoice::Tabulated(table) = &self.contact.law {
            out.comment(contact::TABLE.doc);
            out.pairs(contact::TABLE.name, table.points());
        }
        self.contact.friction.write(out);
    }

    fn write_machine(
        &self,
        out: &mut Writer,
        write_waveform: impl Fn(&mut Writer, Channel, &Waveform),
    ) {
        let machine = &self.machine;
        out.table("machine");
        out.setting(&PRESET, &machine.preset);
        machine.settings.write(out);
        out.table("machine.springs");
        machine.springs.write(out);
        for channel in Channel::ALL {
            if let Some(waveform) = machine.waveforms.get(channel) {
                write_waveform(out, channel, waveform);
            }
        }
        let freedoms = &machine.freedoms;
        let rows: [&dyn Row; 6] = [
            &freedoms.ap,
            &freedoms.ie,
            &freedoms.ml,
            &freedoms.vv,
            &freedoms.is,
            &freedoms.flexion,
        ];
        for (name, row) in FREEDOMS.iter().zip(rows) {
            out.table(&format!("machine.freedoms.{name}"));
            row.write_row(out);
        }
    }
}

/// A freedom of either kind.
trait Row {
    fn write_row(&self, out: &mut Writer);
}

impl Row for Translation {
    fn write_row(&self, out: &mut Writer) {
        self.write(out);
    }
}

impl Row for Rotation {
    fn write_row(&self, out: &mut Writer) {
        self.write(out);
    }
}

/// The points of a waveform as its table.
fn write_knots(out: &mut Writer, channel: Channel, waveform: &Waveform) {
    let interpolation = match waveform.interpolation() {
        Interpolation::HalfCosine => "half-cosine",
        Interpolation::Spline => "spline",
    };
    out.table(&format!("machine.{}", channel.name()));
    out.comment(channel.about());
    out.line(
        &format!("interpolation = {interpolation:?}"),
        "From point to point.",
    );
    let unit = unit_of(channel.knots_key()).unwrap_or_default();
    out.comment(&format!("[percent of the cycle, {unit}]"));
    let knots = waveform.knots().iter();
    let pairs: Vec<(f64, f64)> = knots.map(|knot| (knot.percent, knot.value)).collect();
    out.pairs(channel.knots_key(), &pairs);
}

/// The table of a waveform by its name.
fn write_name(out: &mut Writer, channel: Channel, _: &Waveform) {
    out.table(&format!("machine.{}", channel.name()));
    out.comment(channel.about());
    out.line(
        &format!("waveform = {DEFAULT_WAVEFORM:?}"),
        "Or file and column, or knots.",
    );
}

/// A case to start from: every key with its default and its meaning.
pub fn template(preset: Preset) -> String {
    let text = format!("[machine]\npreset = {:?}\n", preset.word());
    let case = Case::parse(&text, "template", std::path::Path::new(""));
    match case {
        Ok(case) => case.written(write_name),
        Err(error) => unreachable!("the defaults are a case, a test reads them: {error}"),
    }
}
