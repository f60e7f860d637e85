//! Reading of Abaqus input files: the mesh, its element sets and element surfaces; other keywords are ignored.

use std::path::Path;

use super::{
    error::MeshFileError,
    hex_draft::{DraftHex, HexDraft, HexFile, NamedLists, list_of, not_hexahedron},
    text::{At, Rows, decode},
};

/// Keywords that create or move nodes and elements in ways that the reader does not support.
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

/// Members of sets for each byte of the file: a short row can make a set of any size. An element takes more bytes than
/// this, and a set seldom has more members than the file has elements.
const MAX_MEMBERS_PER_BYTE: u64 = 8;
/// Members of sets that a file of any length may have: short files may number sparsely.
const MIN_MEMBERS_LIMIT: u64 = 1_000_000;

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    let content = decode(bytes);
    let keywords = keywords(path, &content)?;
    let mut model = Model {
        draft: HexDraft::new(path),
        element_sets: NamedLists::default(),
        max_members: MIN_MEMBERS_LIMIT + MAX_MEMBERS_PER_BYTE * bytes.len() as u64,
        members: 0,
    };
    for what in ["part", "instance"] {
        let mut named = keywords
            .iter()
            .filter(|k| k.name.eq_ignore_ascii_case(what));
        if let Some(second) = named.nth(1) {
            return Err(second.at.error(format!(
                "a second {what} starts here; give a file with one only, \
                 or write the model flat (no parts and assemblies)"
            )));
        }
    }
    for keyword in &keywords {
        match keyword.name.as_str() {
            "NODE" => model.nodes(keyword)?,
            "ELEMENT" => model.elements(keyword)?,
            "ELSET" => {
                let name = keyword.required("ELSET")?;
                let members = model.members(keyword)?;
                list_of(&mut model.element_sets, name).extend(members);
            }
            "INSTANCE" => {
                for &(at, row) in &keyword.data {
                    if at.numbers(fields(row))?.iter().any(|&by: &f64| by != 0.0) {
                        let problem = "an instance that is moved or turned is not supported; \
                                       move the part itself instead";
                        return Err(at.error(problem));
                    }
                }
            }
            name if NOT_FOLLOWED.contains(&name) => {
                let problem = format!("*{name} is not supported; write the mesh out in full");
                return Err(keyword.at.error(problem));
            }
            _ => {}
        }
    }
    // A surface may precede the sets that it consists of.
    for keyword in keywords.iter().filter(|keyword| keyword.name == "SURFACE") {
        model.surface(keyword)?;
    }
    model.draft.finish()
}

/// `*NAME, KEY=value, FLAG` and its data lines.
struct Keyword<'t> {
    at: At<'t>,
    /// In capitals, without the asterisk.
    name: String,
    parameters: Vec<(String, String)>,
    data: Vec<(At<'t>, &'t str)>,
}

impl<'t> Keyword<'t> {
    fn new(at: At<'t>, line: &str) -> Self {
        let mut words = line.split(',').map(str::trim);
        let name = words.next().unwrap_or_default().split_whitespace();
        let name = name.collect::<Vec<_>>().join(" ");
        let parameters = words.filter(|word| !word.is_empty()).map(|word| {
            let (key, value) = word.split_once('=').unwrap_or((word, ""));
            let value = value.trim().trim_matches('"');
            (key.trim().to_ascii_uppercase(), value.to_string())
        });
        Self {
            at,
            name: name.to_ascii_uppercase(),
            parameters: parameters.collect(),
            data: Vec::new(),
        }
    }

    fn value(&self, parameter: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|(key, _)| key == parameter);
        found.map(|(_, value)| value.as_str())
    }

    fn required(&self, parameter: &str) -> Result<&str, MeshFileError> {
        self.value(parameter).ok_or_else(|| {
            let problem = format!("*{} needs {parameter}=name", self.name);
            self.at.error(problem)
        })
    }
}

/// Returns all keywords of a file; comments (`**`) are left out.
fn keywords<'t>(path: &'t Path, content: &'t str) -> Result<Vec<Keyword<'t>>, MeshFileError> {
    let mut rows = Rows::new(path, content).filter(|(_, row)| !row.starts_with("**"));
    let mut keywords: Vec<Keyword> = Vec::new();
    while let Some((at, row)) = rows.next() {
        if let Some(first) = row.strip_prefix('*') {
            let mut whole = first.to_string();
            // A keyword line that ends in a comma continues in the next line.
            while whole.ends_with(',') {
                let Some((_, more)) = rows.next() else { break };
                whole.push_str(more);
            }
            keywords.push(Keyword::new(at, &whole));
        } else if let Some(keyword) = keywords.last_mut() {
            keyword.data.push((at, row));
        } else {
            let problem = "a data line stands before the first keyword; is this an Abaqus file?";
            return Err(at.error(problem));
        }
    }
    Ok(keywords)
}

/// Returns the fields between commas; a comma at the end of a row is not a field.
fn fields(row: &str) -> impl Iterator<Item = &str> {
    let fields = row.split(',').map(str::trim);
    fields.filter(|field| !field.is_empty())
}

/// Returns a name in capitals without its instance and quotes: `Insert-1.Top` is `TOP`.
fn plain(name: &str) -> String {
    let name = name.trim_matches('"');
    name.rsplit('.').next().unwrap_or(name).to_ascii_uppercase()
}

/// Parses a label, perhaps behind the name of the instance: `Insert-1.17`.
fn label(at: At, field: &str) -> Result<u64, MeshFileError> {
    plain(field).parse().map_err(|_| {
        at.error(format!(
            "{field:?} is neither a number nor the name of a previously defined set"
        ))
    })
}

/// The model as far as it has been read.
struct Model<'a> {
    draft: HexDraft<'a>,
    element_sets: NamedLists<u64>,
    max_members: u64,
    members: u64,
}

impl Model<'_> {
    /// Counts members of sets and surfaces before they are made.
    fn count_members(&mut self, at: At, more: u64) -> Result<(), MeshFileError> {
        self.members = self.members.saturating_add(more);
        if self.members <= self.max_members {
            return Ok(());
        }
        Err(at.error(format!(
            "with the {more} members of this row, the sets of the file have more than {}, \
             which a file of its length does not need; name only existing elements",
            self.max_members
        )))
    }

    fn nodes(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let system = keyword.value("SYSTEM").unwrap_or("R");
        if !system.eq_ignore_ascii_case("R") {
            let problem = "only rectangular coordinates can be read; write the nodes with SYSTEM=R";
            return Err(keyword.at.error(problem));
        }
        for &(at, row) in &keyword.data {
            let mut words = fields(row);
            let label = at.number(words.next().unwrap_or_default())?;
            self.draft.node(at, label, at.coordinates(words)?)?;
        }
        Ok(())
    }

    fn elements(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let kind = keyword
            .value("TYPE")
            .unwrap_or("(none given)")
            .to_ascii_uppercase();
        let mut labels = Vec::with_capacity(keyword.data.len());
        let mut rows = keyword.data.iter();
        while let Some(&(at, row)) = rows.next() {
            let mut numbers: Vec<i64> = at.numbers(fields(row))?;
            let label = numbers.first().copied().unwrap_or_default();
            // C3D8 with any suffix for its integration or formulation has the same eight nodes.
            if !kind.starts_with("C3D8") {
                return Err(not_hexahedron(at, label.cast_unsigned(), &kind, &[]));
            }
            // A label and eight nodes may take several rows.
            while numbers.len() < 9
                && let Some((at, row)) = rows.next()
            {
                numbers.extend(at.numbers::<i64>(fields(row))?);
            }
            let nodes = numbers.get(1..).unwrap_or_default();
            let nodes = at.corners(format_args!("element {label}"), nodes)?;
            labels.push(label.cast_unsigned());
            self.draft.hex(at, label.cast_unsigned(), nodes)?;
        }
        if let Some(set) = keyword.value("ELSET") {
            list_of(&mut self.element_sets, set).extend(labels);
        }
        Ok(())
    }

    /// Reads the members of a set: numbers, names of earlier sets, or with GENERATE first, last, step.
    fn members(&mut self, keyword: &Keyword) -> Result<Vec<u64>, MeshFileError> {
        let generate = keyword.value("GENERATE").is_some();
        let mut members = Vec::new();
        for &(at, row) in &keyword.data {
            if generate {
                let (first, last, step) = match at.numbers::<u64>(fields(row))?[..] {
                    [first, last] if first <= last => (first, last, 1),
                    [first, last, step] if first <= last && step > 0 => (first, last, step),
                    _ => {
                        let problem =
                            "GENERATE takes first, last and a step above 0, with first up to last";
                        return Err(at.error(problem));
                    }
                };
                self.count_members(at, ((last - first) / step).saturating_add(1))?;
                let step = usize::try_from(step).unwrap_or(usize::MAX);
                members.extend((first..=last).step_by(step));
                continue;
            }
            for field in fields(row) {
                let name = plain(field);
                match self.element_sets.get(&name).map(|(_, own)| own.len()) {
                    Some(count) => {
                        self.count_members(at, count as u64)?;
                        members.extend(&self.element_sets[&name].1);
                    }
                    None => members.push(label(at, field)?),
                }
            }
        }
        Ok(members)
    }

    fn surface(&mut self, keyword: &Keyword) -> Result<(), MeshFileError> {
        let kind = keyword.value("TYPE").unwrap_or("ELEMENT");
        if !kind.eq_ignore_ascii_case("ELEMENT") {
            return Ok(());
        }
        let name = keyword.required("NAME")?;
        for &(at, row) in &keyword.data {
            let mut words = fields(row);
            let set = words.next().unwrap_or_default();
            let elements = match self.element_sets.get(&plain(set)) {
                Some((_, elements)) => elements.clone(),
                None => vec![label(at, set)?],
            };
            self.count_members(at, elements.len() as u64)?;
            let hexes = elements.iter().map(|&label| {
                self.draft.labelled_hex(label).ok_or_else(|| {
                    at.error(format!(
                        "element {label} of this surface is not in the file"
                    ))
                })
            });
            let hexes = hexes.collect::<Result<Vec<&DraftHex>, _>>()?;
            let quads = match words.next() {
                Some(side) => {
                    let sides = ["S1", "S2", "S3", "S4", "S5", "S6"];
                    let face = sides
                        .iter()
                        .position(|name| name.eq_ignore_ascii_case(side));
                    let face = face.ok_or_else(|| {
                        at.error(format!("{side:?} is not one of the faces S1 to S6"))
                    })?;
                    hexes.iter().map(|hex| hex.quads()[face]).collect()
                }
                // Without a face, a surface is all faces of its elements that lie on the outside.
                None => self.draft.free_quads(hexes),
            };
            for quad in quads {
                self.draft.quad(name, at, quad);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::tests::{message, two_cubes};

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
*elset, elset=Both, generate
 7, 8, 1
 7, 7
*ELSET, ELSET=More
 both, 8, 8,
*ELSET, ELSET=Last
 8,
*SURFACE, NAME=Top, TYPE=ELEMENT
 Solid, S2
*Surface, name=Right
 last, S4
*SURFACE, NAME=Skin
 more,
*STEP
*END STEP
";

    fn read(content: &str) -> Result<HexFile, MeshFileError> {
        parse(Path::new("a.inp"), content.as_bytes())
    }

    fn reported(from: &str, to: &str) -> String {
        assert!(TEXT.contains(from), "{from}");
        message(read(&TEXT.replace(from, to)))
    }

    #[test]
    fn mesh_sets_and_surfaces_are_read() {
        let file = read(TEXT).unwrap();
        assert_eq!(file.mesh, two_cubes());
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
        let part = reported("*NODE", "*PART, NAME=A\n*END PART\n*PART, NAME=B\n*NODE");
        assert!(
            part.starts_with("a.inp:5: a second part starts here; give a file with"),
            "{part}"
        );
        let instance = reported(
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
        let kind = reported("type=C3D8R", "type=C3D10");
        assert!(
            kind.starts_with("a.inp:19: element 7 is of type C3D10; only"),
            "{kind}"
        );
    }

    #[test]
    fn an_inverted_element_is_named_with_its_line() {
        let inverted = reported(
            "7, 1, 2, 12, 11, 21, 22, 32, 31",
            "7, 21, 22, 32, 31, 1, 2, 12, 11",
        );
        let expected = "a.inp:19: hexahedron 7 is inverted or flat (scaled Jacobian -1.000); check its node order, or mesh again";
        assert_eq!(inverted, expected);
    }

    /// The second hexahedron with nodes of its own, shifted along x by the given decimals.
    fn apart(decimals: &str) -> String {
        let of_second = " 8, 102, 3, 13, 112,\n 122, 23, 33, 132";
        let twins = [102, 112, 122, 132].map(|twin| {
            let [y, z] = [i32::from(twin % 20 == 12), i32::from(twin > 120)];
            format!(" {twin}, 1.{decimals}, {y}., {z}.\n")
        });
        let text = TEXT.replace(" 8, 2, 3, 13, 12,\n 22, 23, 33, 32", of_second);
        text.replace("*Element", &format!("{}*Element", twins.concat()))
    }

    #[test]
    fn hexahedra_that_are_not_connected_are_refused() {
        let cut = message(read(&apart("000001")));
        let expected = "a.inp: node 102 lies at the place of node 2 (pairs of such nodes: 4), which cuts the mesh there";
        assert!(cut.starts_with(expected), "{cut}");
        let two = message(read(&apart("1")));
        assert!(
            two.starts_with("a.inp: holds 2 bodies that share no nodes"),
            "{two}"
        );
    }

    #[test]
    fn nodes_that_are_wrong_are_named_with_their_line() {
        let missing = reported("22, 23, 33, 32", "22, 23, 34, 32");
        assert!(
            missing.starts_with("a.inp:20: element 8 names vertex 34"),
            "{missing}"
        );
        assert!(reported(" 2, 1., 0.", " 2, nan, 0.").starts_with("a.inp:5: node 2 has"));
        assert!(reported(" 2, 1.,", " 1, 1.,").contains("a.inp:5: node 1 is given twice"));
        assert!(reported(" 2, 1., 0., 0.", " 2, 1., 0.").starts_with("a.inp:5: a point needs"));
        assert!(reported(" 2, 1., 0., 0.", " 2, 1., O., 0.").contains("\"O.\" is not a number"));
        assert!(reported(" 8, 2,", " 7, 2,").contains("element 7 is given twice"));
        assert!(reported(" 22, 23, 33, 32", " 22, 23").contains("element 8 has 6 corners"));
        assert!(reported(", 33, 32\n", ", 33, 32, 5\n").contains("element 8 has 9 corners"));
    }

    #[test]
    fn sets_and_surfaces_that_are_wrong_are_named_with_their_line() {
        assert!(reported(" both, 8", " boht, 8").contains("\"boht\" is neither"));
        assert!(reported(" 7, 8, 1", " 8, 7, 1").contains("GENERATE takes"));
        assert!(reported(" 7, 8, 1", " 7, 8, 0").contains("GENERATE takes"));
        assert!(reported("Solid, S2", "Solid, S7").contains("\"S7\" is not one of the faces"));
        assert!(reported(" last, S4", " 9, S4").contains("element 9 of this surface"));
        let inside = reported(" last, S4", " last, S6");
        assert!(
            inside.contains("face of surface \"Right\" is not on the outside"),
            "{inside}"
        );
        assert!(reported("SURFACE, NAME=Skin", "SURFACE").contains("*SURFACE needs NAME=name"));
    }

    #[test]
    fn a_range_without_a_bound_is_refused() {
        let expected = "a.inp:23: with the 18446744073709551615 members of this row, the sets of \
            the file have more than 1004704, which a file of its length does not need; name only \
            existing elements";
        assert_eq!(
            reported(" 7, 8, 1", " 1, 18446744073709551615, 1"),
            expected
        );
        let all = reported(" 7, 8, 1", " 0, 18446744073709551615");
        assert!(
            all.starts_with("a.inp:23: with the 18446744073709551615 members"),
            "{all}"
        );
        let elements = reported(
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
        let stepped = TEXT
            .replace(" 7, 8, 1", " 7, 18446744073709551614, 18446744073709551614")
            .replace(" Solid, S2", " both, S2");
        let file = read(&stepped).unwrap();
        assert_eq!(file.surface("top").unwrap().quads, [[6, 7, 10, 9]]);
    }

    #[test]
    fn sets_that_double_and_double_are_refused() {
        let mut doubling = String::from("*ELSET, ELSET=D\n both\n");
        for _ in 0..40 {
            doubling += "*ELSET, ELSET=D\n D, D\n";
        }
        let doubled = reported(
            "*SURFACE, NAME=Top",
            &format!("{doubling}*SURFACE, NAME=Top"),
        );
        assert!(
            doubled.contains("the sets of the file have more than"),
            "{doubled}"
        );
    }

    #[test]
    fn many_sets_and_free_surfaces_are_read_in_time() {
        let sets: String = (0..30_000)
            .map(|set| format!("*ELSET, ELSET=N{set}\n 7\n"))
            .collect();
        let faces = " Solid,\n".repeat(30_000);
        let many = TEXT
            .replace("*ELSET, ELSET=Last", &format!("{sets}*ELSET, ELSET=Last"))
            .replace(" Solid, S2", " N29999, S2")
            .replace(
                "*SURFACE, NAME=Skin\n",
                &format!("*SURFACE, NAME=Skin\n{faces}"),
            );
        let file = read(&many).unwrap();
        assert_eq!(file.surface("top").unwrap().quads.len(), 1);
        assert_eq!(file.surface("skin").unwrap().quads.len(), 10);
    }

    #[test]
    fn what_is_not_followed_is_refused() {
        let include = reported("*STEP", "*INCLUDE, INPUT=more.inp\n*STEP");
        assert!(include.ends_with("*INCLUDE is not supported; write the mesh out in full"));
        assert!(reported("NSET=Everything", "SYSTEM=C").contains("rectangular coordinates"));
        assert!(message(read("*NODE\n1, 0, 0, 0\n")).contains("holds no hexahedra"));
        assert!(message(read("1, 2, 3\n*NODE\n")).starts_with("a.inp:1: a data line"));
    }
}
