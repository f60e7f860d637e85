//! Abaqus input files: the mesh, its sets and its element surfaces; the rest is passed over.

use std::collections::HashMap;
use std::path::Path;

use super::error::{MeshFileError, Place};
use super::hex_draft::{DraftHex, HexDraft};
use super::hex_file::HexFile;
use super::inp_keyword::{Keyword, keywords};
use super::text;

/// Keywords that would make or move nodes and elements in ways not followed here.
const NOT_FOLLOWED: [&str; 10] = [
    "INCLUDE",
    "NGEN",
    "NFILL",
    "NCOPY",
    "NMAP",
    "ELGEN",
    "ELCOPY",
    "SYSTEM",
    "TIE",
    "MODEL CHANGE",
];

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    let mut reading = Reading {
        path,
        draft: HexDraft::new(path),
        node_sets: HashMap::new(),
        element_sets: HashMap::new(),
        parts: 0,
        instances: 0,
    };
    let content = text::decode(bytes);
    let keywords = keywords(path, &content)?;
    for keyword in &keywords {
        reading.take(keyword)?;
    }
    // A surface may stand before the sets it is made of.
    for keyword in keywords.iter().filter(|keyword| keyword.name == "SURFACE") {
        reading.surface(keyword)?;
    }
    reading.draft.finish()
}

struct Reading<'a> {
    path: &'a Path,
    draft: HexDraft<'a>,
    /// Members by the name in capitals, since names do not know their case.
    node_sets: HashMap<String, Vec<u64>>,
    element_sets: HashMap<String, Vec<u64>>,
    parts: usize,
    instances: usize,
}

impl Reading<'_> {
    fn take(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        match keyword.name.as_str() {
            "NODE" => self.nodes(keyword),
            "ELEMENT" => self.elements(keyword),
            "NSET" => self.node_set(keyword),
            "ELSET" => self.element_set(keyword),
            "PART" => {
                self.parts += 1;
                self.only_one(keyword, "part", self.parts)
            }
            "INSTANCE" => self.instance(keyword),
            name if NOT_FOLLOWED.contains(&name) => {
                let what = format!("*{name} is not followed; write the mesh out in full");
                Err(self.at(keyword.line).error(what))
            }
            _ => Ok(()),
        }
    }

    fn at(&self, line: usize) -> Place {
        Place::line(self.path, line)
    }

    fn only_one(
        &self,
        keyword: &Keyword,
        what: &'static str,
        count: usize,
    ) -> Result<(), MeshFileError> {
        if count < 2 {
            return Ok(());
        }
        let at = self.at(keyword.line);
        Err(MeshFileError::SeveralBodies { at, what })
    }

    fn instance(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        self.instances += 1;
        self.only_one(keyword, "instance", self.instances)?;
        for (line, row) in &keyword.data {
            for field in fields(row) {
                if text::number::<f64>(self.path, *line, field)? != 0.0 {
                    let what = "an instance that is moved or turned is not followed; \
                        move the part itself instead";
                    return Err(self.at(*line).error(what));
                }
            }
        }
        Ok(())
    }

    fn nodes(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        if keyword
            .value("SYSTEM")
            .is_some_and(|system| !system.eq_ignore_ascii_case("R"))
        {
            let what = "only rectangular coordinates can be read; write the nodes with SYSTEM=R";
            return Err(self.at(keyword.line).error(what));
        }
        let mut labels = Vec::with_capacity(keyword.data.len());
        for &(line, row) in &keyword.data {
            let mut words = fields(row);
            let label = text::number(self.path, line, words.next().unwrap_or_default())?;
            let position = text::coordinates(self.path, line, &mut words)?;
            self.draft.node(Some(line), label, position)?;
            labels.push(label);
        }
        if let Some(set) = keyword.value("NSET") {
            self.add_to_node_set(set, &labels);
        }
        Ok(())
    }

    fn elements(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let kind = keyword
            .value("TYPE")
            .unwrap_or("(none given)")
            .to_ascii_uppercase();
        let mut labels = Vec::with_capacity(keyword.data.len());
        let mut numbers: Vec<u64> = Vec::with_capacity(9);
        let mut first_line = keyword.line;
        for &(line, row) in &keyword.data {
            if numbers.is_empty() {
                first_line = line;
            }
            for field in fields(row) {
                numbers.push(text::number(self.path, line, field)?);
            }
            if !is_hexahedron(&kind) {
                let at = self.at(line);
                let element = numbers.first().copied().unwrap_or_default();
                return Err(MeshFileError::NotHexahedron { at, element, kind });
            }
            if numbers.len() >= 9 {
                labels.push(self.element(first_line, &numbers)?);
                numbers.clear();
            }
        }
        if !numbers.is_empty() {
            return Err(self.wrong_corners(first_line, &numbers));
        }
        if let Some(set) = keyword.value("ELSET") {
            self.element_sets
                .entry(set.to_ascii_uppercase())
                .or_default()
                .extend(labels);
        }
        Ok(())
    }

    fn element(&mut self, line: usize, numbers: &[u64]) -> Result<u64, MeshFileError> {
        let label = numbers[0];
        let nodes =
            <[u64; 8]>::try_from(&numbers[1..]).map_err(|_| self.wrong_corners(line, numbers))?;
        self.draft.hex(DraftHex {
            label,
            line: Some(line),
            nodes,
        })?;
        Ok(label)
    }

    fn wrong_corners(&self, line: usize, numbers: &[u64]) -> MeshFileError {
        let nodes = numbers.len() - 1;
        let what = format!("element {} has {nodes} nodes; C3D8 has eight", numbers[0]);
        self.at(line).error(what)
    }

    fn node_set(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let name = self.required(keyword, "NSET")?;
        let mut nodes = self.members(keyword, &self.node_sets)?;
        if let Some(elements) = keyword.value("ELSET") {
            let labels = self
                .element_sets
                .get(&plain(elements))
                .cloned()
                .unwrap_or_default();
            let hexes = labels
                .iter()
                .filter_map(|&label| self.draft.labelled_hex(label));
            nodes.extend(hexes.flat_map(|hex| hex.nodes));
        }
        self.add_to_node_set(name, &nodes);
        Ok(())
    }

    fn add_to_node_set(&mut self, name: &str, nodes: &[u64]) {
        self.draft.set_nodes(name, nodes.iter().copied());
        self.node_sets
            .entry(name.to_ascii_uppercase())
            .or_default()
            .extend(nodes);
    }

    fn element_set(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let name = self.required(keyword, "ELSET")?.to_ascii_uppercase();
        let members = self.members(keyword, &self.element_sets)?;
        self.element_sets.entry(name).or_default().extend(members);
        Ok(())
    }

    fn required<'k>(
        &self,
        keyword: &'k Keyword,
        parameter: &str,
    ) -> Result<&'k str, MeshFileError> {
        keyword.value(parameter).ok_or_else(|| {
            let what = format!("*{} needs {parameter}=name", keyword.name);
            self.at(keyword.line).error(what)
        })
    }

    /// Members of a set: numbers, names of earlier sets, or with GENERATE first, last, step.
    fn members(
        &self,
        keyword: &Keyword,
        sets: &HashMap<String, Vec<u64>>,
    ) -> Result<Vec<u64>, MeshFileError> {
        let generate = keyword.value("GENERATE").is_some();
        let mut members = Vec::new();
        for &(line, row) in &keyword.data {
            if generate {
                members.extend(self.range(line, row)?);
                continue;
            }
            for field in fields(row) {
                match sets.get(&plain(field)) {
                    Some(set) => members.extend(set),
                    None => members.push(self.label(line, field)?),
                }
            }
        }
        Ok(members)
    }

    fn range(
        &self,
        line: usize,
        row: &str,
    ) -> Result<impl Iterator<Item = u64> + use<>, MeshFileError> {
        let numbers: Result<Vec<u64>, _> = fields(row)
            .map(|field| text::number(self.path, line, field))
            .collect();
        match numbers?[..] {
            [first, last] if first <= last => Ok((first..=last).step_by(1)),
            [first, last, step] if first <= last && step > 0 => {
                Ok((first..=last).step_by(step as usize))
            }
            _ => {
                let what = "GENERATE takes first, last and a step above 0, with first up to last";
                Err(self.at(line).error(what))
            }
        }
    }

    /// A number, perhaps behind the name of the instance: `Insert-1.17`.
    fn label(&self, line: usize, field: &str) -> Result<u64, MeshFileError> {
        plain(field).parse().map_err(|_| {
            let what = format!("{field:?} is neither a number nor a set given before");
            self.at(line).error(what)
        })
    }

    fn surface(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        if keyword
            .value("TYPE")
            .is_some_and(|kind| !kind.eq_ignore_ascii_case("ELEMENT"))
        {
            return Ok(());
        }
        let name = self.required(keyword, "NAME")?;
        for &(line, row) in &keyword.data {
            let mut words = fields(row);
            let set = words.next().unwrap_or_default();
            let elements = match self.element_sets.get(&plain(set)) {
                Some(elements) => elements.clone(),
                None => vec![self.label(line, set)?],
            };
            let quads = match words.next() {
                Some(side) => self.side(line, &elements, side)?,
                None => self.free_faces(line, &elements)?,
            };
            for quad in quads {
                self.draft.quad(name, Some(line), quad);
            }
        }
        Ok(())
    }

    /// Face S1 to S6 of each element.
    fn side(
        &self,
        line: usize,
        elements: &[u64],
        side: &str,
    ) -> Result<Vec<[u64; 4]>, MeshFileError> {
        let face = ["S1", "S2", "S3", "S4", "S5", "S6"]
            .iter()
            .position(|name| name.eq_ignore_ascii_case(side))
            .ok_or_else(|| {
                self.at(line)
                    .error(format!("{side:?} is not a face S1 to S6"))
            })?;
        elements
            .iter()
            .map(|&label| Ok(self.hex(line, label)?.quads()[face]))
            .collect()
    }

    /// Without a face, a surface is all faces of its elements that lie on the outside.
    fn free_faces(&self, line: usize, elements: &[u64]) -> Result<Vec<[u64; 4]>, MeshFileError> {
        let hexes: Result<Vec<_>, _> = elements
            .iter()
            .map(|&label| self.hex(line, label))
            .collect();
        Ok(self.draft.free_quads(hexes?))
    }

    fn hex(&self, line: usize, label: u64) -> Result<&DraftHex, MeshFileError> {
        self.draft.labelled_hex(label).ok_or_else(|| {
            let what = format!("element {label} of this surface is not in the file");
            self.at(line).error(what)
        })
    }
}

/// C3D8 with any suffix for its integration or formulation has the same eight nodes.
fn is_hexahedron(kind: &str) -> bool {
    kind.starts_with("C3D8")
}

/// Fields between commas; a comma at the end of a row is not a field.
fn fields(row: &str) -> impl Iterator<Item = &str> {
    row.split(',')
        .map(str::trim)
        .filter(|field| !field.is_empty())
}

/// A name in capitals without its instance and quotes: `Insert-1.Top` is `TOP`.
fn plain(name: &str) -> String {
    let name = name.trim_matches('"');
    name.rsplit('.').next().unwrap_or(name).to_ascii_uppercase()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::fixtures::{message, two_cubes};

    /// Two cubes in a row along x, the second element's row continued, in mixed case.
    const TEXT: &str = "*Heading
** two cubes
*NODE, NSET=Everything
 1, 0., 0., 0.
 2, 1., 0., 0.
 3, 2., 0., 0.
 11, 0., 1., 0.
 12, 1., 1., 0.
 13, 2., 1., 0.
 21, 0., 0., 1.
 22, 1., 0., 1.
 23, 2., 0., 1.
 31, 0., 1., 1.
 32, 1., 1., 1.
 33, 2., 1., 1.
 99, 9., 9., 9.
*Element, type=C3D8R,
 elset=Solid
 7, 1, 2, 12, 11, 21, 22, 32, 31
 8, 2, 3, 13, 12,
 22, 23, 33, 32
*nset, nset=Bottom, generate
 1, 3, 1
 11, 13
*NSET, NSET=Ends
 bottom, 33, 99,
*ELSET, ELSET=Last
 8,
*SURFACE, NAME=Top, TYPE=ELEMENT
 Solid, S2
*Surface, name=Right
 last, S4
*SURFACE, NAME=Skin
 Solid,
*STEP
*END STEP
";

    fn read(content: &str) -> Result<HexFile, MeshFileError> {
        parse(Path::new("a.inp"), content.as_bytes())
    }

    fn said(from: &str, to: &str) -> String {
        assert!(TEXT.contains(from), "{from}");
        message(read(&TEXT.replace(from, to)))
    }

    #[test]
    fn mesh_sets_and_surfaces_are_read() {
        let file = read(TEXT).unwrap();
        assert_eq!(file.mesh, two_cubes());
        assert_eq!(file.node_set("bottom").unwrap().nodes, [0, 1, 2, 3, 4, 5]);
        assert_eq!(file.node_set("Ends").unwrap().nodes, [0, 1, 2, 3, 4, 5, 11]);
        assert_eq!(file.node_set("everything").unwrap().nodes.len(), 12);
        assert_eq!(
            file.surface("TOP").unwrap().quads,
            [[6, 7, 10, 9], [7, 8, 11, 10]]
        );
        assert_eq!(file.surface("Right").unwrap().quads, [[2, 5, 11, 8]]);
        assert_eq!(file.surface("skin").unwrap().quads.len(), 10);
    }

    #[test]
    fn one_part_and_one_instance_are_read_flat() {
        let wrapped = TEXT
            .replace("*NODE", "*PART, NAME=Insert\n*NODE")
            .replace("*SURFACE, NAME=Top", "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I-1, PART=Insert\n 0., 0., 0.\n*END INSTANCE\n*SURFACE, NAME=Top")
            .replace(" Solid, S2", " I-1.Solid, S2");
        assert_eq!(read(&wrapped).unwrap(), read(TEXT).unwrap());
        let moved = wrapped.replace(" 0., 0., 0.\n*END INST", " 0., 5., 0.\n*END INST");
        assert!(message(read(&moved)).contains("moved or turned"));
    }

    #[test]
    fn several_parts_or_instances_are_refused() {
        let part = said("*NODE", "*PART, NAME=A\n*END PART\n*PART, NAME=B\n*NODE");
        assert!(
            part.starts_with("a.inp:5: a second part starts here; give a file with"),
            "{part}"
        );
        let instance = said(
            "*STEP",
            "*INSTANCE, NAME=A, PART=P\n*INSTANCE, NAME=B, PART=P\n*STEP",
        );
        assert!(
            instance.contains("a second instance starts here"),
            "{instance}"
        );
    }

    #[test]
    fn other_elements_are_named() {
        let kind = said("type=C3D8R", "type=C3D10");
        assert!(
            kind.starts_with("a.inp:19: element 7 is of type C3D10; only"),
            "{kind}"
        );
    }

    #[test]
    fn an_inverted_element_is_named_with_its_line() {
        let inverted = said(
            "7, 1, 2, 12, 11, 21, 22, 32, 31",
            "7, 21, 22, 32, 31, 1, 2, 12, 11",
        );
        let expected = "a.inp:19: hexahedron 7 is inverted or flat (scaled Jacobian -1.000); check its node order, or mesh again";
        assert_eq!(inverted, expected);
    }

    #[test]
    fn nodes_that_are_wrong_are_named_with_their_line() {
        let missing = said("22, 23, 33, 32", "22, 23, 34, 32");
        assert!(
            missing.starts_with("a.inp:20: element 8 names vertex 34"),
            "{missing}"
        );
        assert!(said(" 2, 1., 0.", " 2, nan, 0.").starts_with("a.inp:5: node 2 has"));
        assert!(said(" 2, 1.,", " 1, 1.,").contains("a.inp:5: node 1 is given twice"));
        assert!(said(" 2, 1., 0., 0.", " 2, 1., 0.").starts_with("a.inp:5: a point needs"));
        assert!(said(" 2, 1., 0., 0.", " 2, 1., O., 0.").contains("\"O.\" is not a number"));
        assert!(said(" 8, 2,", " 7, 2,").contains("element 7 is given twice"));
        assert!(said(" 22, 23, 33, 32", " 22, 23").contains("element 8 has 6 nodes"));
        assert!(said(", 33, 32\n", ", 33, 32, 5\n").contains("element 8 has 9 nodes"));
    }

    #[test]
    fn sets_and_surfaces_that_are_wrong_are_named_with_their_line() {
        assert!(said(" bottom, 33", " botom, 33").contains("\"botom\" is neither"));
        assert!(said(" 1, 3, 1", " 3, 1, 1").contains("GENERATE takes"));
        assert!(said("Solid, S2", "Solid, S7").contains("\"S7\" is not a face"));
        assert!(said(" last, S4", " 9, S4").contains("element 9 of this surface"));
        let inside = said(" last, S4", " last, S6");
        assert!(
            inside.contains("face of surface \"Right\" is not on the outside"),
            "{inside}"
        );
        assert!(said("SURFACE, NAME=Skin", "SURFACE").contains("*SURFACE needs NAME=name"));
    }

    #[test]
    fn what_is_not_followed_is_refused() {
        let include = said("*STEP", "*INCLUDE, INPUT=more.inp\n*STEP");
        assert!(include.ends_with("*INCLUDE is not followed; write the mesh out in full"));
        assert!(said("NSET=Everything", "SYSTEM=C").contains("rectangular coordinates"));
        assert!(message(read("*NODE\n1, 0, 0, 0\n")).contains("holds no hexahedra"));
        assert!(message(read("1, 2, 3\n*NODE\n")).starts_with("a.inp:1: a data line"));
    }
}
