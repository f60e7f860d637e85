//! Abaqus input files: the mesh, its sets and its element surfaces; the rest is passed over.

mod named;
use std::{cell::Cell, collections::HashMap, path::Path};

use super::{
    error::{FileLine, MeshFileError},
    hex_draft::{HexDraft, HexFile},
    text,
};

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
    let mut reading = Reading::new(path, bytes.len());
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
}

/// `*NAME, KEY=value, FLAG` and its data lines.
pub(crate) struct Keyword<'t> {
    pub(crate) line: usize,
    /// In capitals, without the asterisk.
    pub(crate) name: String,
    parameters: Vec<(String, String)>,
    /// Line number and text.
    pub(crate) data: Vec<(usize, &'t str)>,
}

impl Keyword<'_> {
    /// Value of a parameter, empty for a flag.
    pub(crate) fn value(&self, parameter: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|(key, _)| key == parameter);
        found.map(|(_, value)| value.as_str())
    }
}

/// All keywords of a file; comments (`**`) and empty lines are left out.
pub(crate) fn keywords<'t>(
    path: &Path,
    content: &'t str,
) -> Result<Vec<Keyword<'t>>, MeshFileError> {
    let rows = (1..).zip(content.lines().map(str::trim));
    let mut rows = rows.filter(|(_, row)| !row.is_empty() && !row.starts_with("**"));
    let mut keywords: Vec<Keyword> = Vec::new();
    while let Some((line, row)) = rows.next() {
        if let Some(first) = row.strip_prefix('*') {
            let mut whole = first.to_string();
            // A keyword line that ends in a comma goes on in the next.
            while whole.ends_with(',') {
                let Some((_, more)) = rows.next() else { break };
                whole.push_str(more);
            }
            keywords.push(keyword(line, &whole));
        } else if let Some(keyword) = keywords.last_mut() {
            keyword.data.push((line, row));
        } else {
            let what = "a data line stands before the first keyword; is this an Abaqus file?";
            return Err(FileLine::line(path, line).error(what));
        }
    }
    Ok(keywords)
}

fn keyword<'t>(line: usize, whole: &str) -> Keyword<'t> {
    let mut words = whole.split(',').map(str::trim);
    let name = words
        .next()
        .unwrap_or_default()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let parameters = words.filter(|word| !word.is_empty()).map(|word| {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        let value = value.trim().trim_matches('"');
        (key.trim().to_ascii_uppercase(), value.to_string())
    });
    Keyword {
        line,
        name: name.to_ascii_uppercase(),
        parameters: parameters.collect(),
        data: Vec::new(),
    }
}

/// A row of a few bytes can make a set of any size, so that the length of the file bounds them
/// all: a node takes more bytes than this, and a set seldom has more than all nodes.
const MEMBERS_A_BYTE: u64 = 8;
/// Short files may number sparsely.
const MEMBERS_OF_ANY_FILE: u64 = 1_000_000;

/// What has been read so far.
pub(super) struct Reading<'a> {
    pub path: &'a Path,
    pub draft: HexDraft<'a>,
    /// Members by the name in capitals, since names do not know their case.
    pub node_sets: HashMap<String, Vec<u64>>,
    pub element_sets: HashMap<String, Vec<u64>>,
    pub parts: usize,
    pub instances: usize,
    most_members: u64,
    members: Cell<u64>,
}

impl<'a> Reading<'a> {
    /// Nothing read yet of the file at `path`, which has `length` bytes.
    pub(super) fn new(path: &'a Path, length: usize) -> Self {
        Self {
            path,
            draft: HexDraft::new(path),
            node_sets: HashMap::new(),
            element_sets: HashMap::new(),
            parts: 0,
            instances: 0,
            most_members: MEMBERS_OF_ANY_FILE + MEMBERS_A_BYTE * length as u64,
            members: Cell::new(0),
        }
    }

    /// Counts members of sets and surfaces before they are made.
    pub(super) fn count_members(&self, line: usize, more: u64) -> Result<(), MeshFileError> {
        let members = self.members.get().saturating_add(more);
        self.members.set(members);
        if members <= self.most_members {
            return Ok(());
        }
        let what = format!(
            "with the {more} members of this row, the sets of the file have more than {}, \
             which a file of its length does not need; name only nodes and elements that there are",
            self.most_members
        );
        Err(self.at(line).error(what))
    }

    pub(super) fn at(&self, line: usize) -> FileLine {
        FileLine::line(self.path, line)
    }

    pub(super) fn required<'k>(
        &self,
        keyword: &'k Keyword,
        parameter: &str,
    ) -> Result<&'k str, MeshFileError> {
        keyword.value(parameter).ok_or_else(|| {
            let what = format!("*{} needs {parameter}=name", keyword.name);
            self.at(keyword.line).error(what)
        })
    }

    /// A number, perhaps behind the name of the instance: `Insert-1.17`.
    pub(super) fn label(&self, line: usize, field: &str) -> Result<u64, MeshFileError> {
        plain(field).parse().map_err(|_| {
            let what = format!("{field:?} is neither a number nor a set given before");
            self.at(line).error(what)
        })
    }
}

/// Fields between commas; a comma at the end of a row is not a field.
pub(super) fn fields(row: &str) -> impl Iterator<Item = &str> {
    row.split(',')
        .map(str::trim)
        .filter(|field| !field.is_empty())
}

/// A name in capitals without its instance and quotes: `Insert-1.Top` is `TOP`.
pub(super) fn plain(name: &str) -> String {
    let name = name.trim_matches('"');
    name.rsplit('.').next().unwrap_or(name).to_ascii_uppercase()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::fixtures::{message, two_cubes};

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
        assert!(said(" 1, 3, 1", " 1, 3, 0").contains("GENERATE takes"));
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
    fn a_range_without_a_bound_is_refused() {
        let expected = "a.inp:23: with the 18446744073709551615 members of this row, the sets of \
            the file have more than 1004744, which a file of its length does not need; name only \
            nodes and elements that there are";
        assert_eq!(said(" 1, 3, 1", " 1, 18446744073709551615, 1"), expected);
        let all = said(" 1, 3, 1", " 0, 18446744073709551615");
        assert!(
            all.starts_with("a.inp:23: with the 18446744073709551615 members"),
            "{all}"
        );
        let elements = said(
            "ELSET=Last\n 8,",
            "ELSET=Last, GENERATE\n 8, 99999999999, 3",
        );
        assert!(
            elements.starts_with("a.inp:28: with the 33333333331 members"),
            "{elements}"
        );
    }

    #[test]
    fn a_long_step_ends_after_its_first_member() {
        let stepped = TEXT.replace(" 1, 3, 1", " 1, 18446744073709551614, 18446744073709551614");
        let bottom = read(&stepped).unwrap();
        assert_eq!(bottom.node_set("bottom").unwrap().nodes, [0, 3, 4, 5]);
    }

    #[test]
    fn sets_that_double_and_double_are_refused() {
        let mut doubling = String::from("*NSET, NSET=D\n bottom\n");
        for _ in 0..40 {
            doubling += "*NSET, NSET=D\n D, D\n";
        }
        let nodes = said("*ELSET,", &format!("{doubling}*ELSET,"));
        assert!(
            nodes.contains("the sets of the file have more than"),
            "{nodes}"
        );
    }

    #[test]
    fn many_sets_and_free_surfaces_are_read_in_time() {
        let sets: String = (0..30_000)
            .map(|set| format!("*NSET, NSET=N{set}\n 1\n"))
            .collect();
        let faces = " Solid,\n".repeat(30_000);
        let many = TEXT
            .replace("*ELSET, ELSET=Last", &format!("{sets}*ELSET, ELSET=Last"))
            .replace(
                "*SURFACE, NAME=Skin\n",
                &format!("*SURFACE, NAME=Skin\n{faces}"),
            );
        let file = read(&many).unwrap();
        assert_eq!(file.node_sets.len(), 30_003);
        assert_eq!(file.surface("skin").unwrap().quads.len(), 10);
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
