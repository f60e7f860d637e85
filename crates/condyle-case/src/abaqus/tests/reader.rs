//! A strict reader of what the export writes: everything known, everything referred to there.

use std::collections::{HashMap, HashSet};

use condyle::Vec3;

/// Keywords, the parameters each may have, and nothing else.
const KNOWN: &[(&str, &[&str])] = &[
    ("HEADING", &[]),
    ("NODE", &["NSET"]),
    ("ELEMENT", &["TYPE", "ELSET"]),
    ("NSET", &["NSET"]),
    ("SURFACE", &["NAME", "TYPE"]),
    ("MATERIAL", &["NAME"]),
    ("ELASTIC", &[]),
    ("PLASTIC", &[]),
    ("SOLID SECTION", &["ELSET", "MATERIAL"]),
    ("SURFACE INTERACTION", &["NAME"]),
    ("SURFACE BEHAVIOR", &["PRESSURE-OVERCLOSURE"]),
    ("FRICTION", &[]),
    ("CONTACT PAIR", &["INTERACTION", "TYPE"]),
    ("STEP", &["NAME", "INC"]),
    ("STATIC", &[]),
    ("CHANGE FRICTION", &["INTERACTION"]),
    ("NODE PRINT", &["NSET", "TOTALS"]),
    ("EL PRINT", &["ELSET", "FREQUENCY"]),
    ("NODE FILE", &[]),
    ("CONTACT FILE", &[]),
    ("BOUNDARY", &[]),
    ("END STEP", &[]),
];

/// Keywords that stand in a step, and only there.
const IN_A_STEP: &[&str] = &[
    "STATIC",
    "CHANGE FRICTION",
    "NODE PRINT",
    "EL PRINT",
    "NODE FILE",
    "CONTACT FILE",
    "BOUNDARY",
    "END STEP",
];

/// Keywords that stand in a step or before it.
const EITHER: &[&str] = &["CONTACT PAIR", "FRICTION"];

/// A keyword with its data lines, cut at the commas.
pub(super) struct Block {
    pub name: String,
    pub parameters: HashMap<String, String>,
    pub rows: Vec<Vec<String>>,
}

impl Block {
    pub fn is(&self, name: &str) -> bool {
        self.name == name
    }

    pub fn get(&self, parameter: &str) -> Option<&str> {
        self.parameters.get(parameter).map(String::as_str)
    }

    pub fn numbers(&self) -> Vec<Vec<f64>> {
        let number = |word: &String| word.parse().unwrap_or_else(|_| panic!("{word:?}"));
        self.rows
            .iter()
            .map(|row| row.iter().map(number).collect())
            .collect()
    }
}

/// A file that has passed every check.
pub(super) struct Deck {
    pub blocks: Vec<Block>,
    pub nodes: HashMap<u32, Vec3>,
    /// Type and nodes.
    pub elements: HashMap<u32, (String, Vec<u32>)>,
    pub node_sets: HashMap<String, Vec<u32>>,
    pub element_sets: HashMap<String, Vec<u32>>,
}

impl Deck {
    pub fn read(text: &str) -> Self {
        let mut deck = Self {
            blocks: blocks(text),
            nodes: HashMap::new(),
            elements: HashMap::new(),
            node_sets: HashMap::new(),
            element_sets: HashMap::new(),
        };
        deck.check_keywords();
        deck.define();
        deck.check_elements();
        deck.check_references();
        deck
    }

    pub fn named<'a>(&'a self, keyword: &'a str) -> impl Iterator<Item = &'a Block> {
        self.blocks.iter().filter(move |block| block.is(keyword))
    }

    /// Elements of a set with the places of their nodes.
    pub fn corners(&self, elset: &str) -> Vec<Vec<Vec3>> {
        let places = |label: &u32| {
            self.elements[label]
                .1
                .iter()
                .map(|n| self.nodes[n])
                .collect()
        };
        self.element_sets[elset].iter().map(places).collect()
    }

    fn check_keywords(&self) {
        let mut in_step = false;
        for block in &self.blocks {
            let known = KNOWN.iter().find(|(name, _)| *name == block.name);
            let (_, parameters) = known.unwrap_or_else(|| panic!("*{}", block.name));
            for parameter in block.parameters.keys() {
                assert!(parameters.contains(&parameter.as_str()), "{parameter}");
            }
            if block.is("STEP") {
                assert!(!in_step, "a step in a step");
                in_step = true;
            } else if !EITHER.contains(&block.name.as_str()) {
                let belongs = IN_A_STEP.contains(&block.name.as_str());
                assert_eq!(belongs, in_step, "*{}", block.name);
            }
            in_step &= !block.is("END STEP");
        }
        assert!(!in_step, "a step does not end");
        assert!(self.blocks[0].is("HEADING"));
    }

    fn define(&mut self) {
        for block in &self.blocks {
            match block.name.as_str() {
                "NODE" => {
                    let set = self
                        .node_sets
                        .entry(block.parameters["NSET"].clone())
                        .or_default();
                    for row in block.numbers() {
                        let label = row[0] as u32;
                        let place = Vec3::new(row[1], row[2], row[3]);
                        assert!(place.iter().all(|x| x.is_finite()) && row.len() == 4);
                        assert!(
                            self.nodes.insert(label, place).is_none(),
                            "node {label} twice"
                        );
                        set.push(label);
                    }
                }
                "ELEMENT" => {
                    let name = &block.parameters["ELSET"];
                    let set = self.element_sets.entry(name.clone()).or_default();
                    for row in &block.rows {
                        let label: u32 = row[0].parse().unwrap();
                        let nodes = row[1..].iter().map(|word| word.parse().unwrap()).collect();
                        let element = (block.parameters["TYPE"].clone(), nodes);
                        assert!(
                            self.elements.insert(label, element).is_none(),
                            "{label} twice"
                        );
                        set.push(label);
                    }
                }
                "NSET" => {
                    let labels = block.numbers().into_iter().flatten().map(|x| x as u32);
                    let name = block.parameters["NSET"].clone();
                    assert!(self.node_sets.insert(name, labels.collect()).is_none());
                }
                _ => {}
            }
        }
    }

    fn check_elements(&self) {
        for (label, (kind, nodes)) in &self.elements {
            let count = match kind.as_str() {
                "C3D8I" => 8,
                "C3D6" => 6,
                other => panic!("{other}"),
            };
            assert_eq!(nodes.len(), count, "element {label}");
            for node in nodes {
                assert!(self.nodes.contains_key(node), "element {label}");
            }
        }
        for nodes in self.node_sets.values() {
            assert!(nodes.iter().all(|node| self.nodes.contains_key(node)));
        }
    }

    fn names<'a>(&'a self, keyword: &'a str, parameter: &str) -> HashSet<&'a str> {
        let names: Vec<&str> = self
            .named(keyword)
            .map(|block| &*block.parameters[parameter])
            .collect();
        let set: HashSet<&str> = names.iter().copied().collect();
        assert_eq!(set.len(), names.len(), "*{keyword} with one name twice");
        set
    }

    fn check_references(&self) {
        let surfaces = self.names("SURFACE", "NAME");
        let interactions = self.names("SURFACE INTERACTION", "NAME");
        let materials = self.names("MATERIAL", "NAME");
        let elset = |name: &str| assert!(self.element_sets.contains_key(name), "elset {name}");
        let nset = |name: &str| assert!(self.node_sets.contains_key(name), "nset {name}");
        for block in &self.blocks {
            if let (Some(name), false) = (block.get("ELSET"), block.is("ELEMENT")) {
                elset(name);
            }
            if let (Some(name), false) = (block.get("NSET"), block.is("NODE")) {
                nset(name);
            }
            if let Some(name) = block.get("INTERACTION") {
                assert!(interactions.contains(name), "{name}");
            }
            if let Some(name) = block.get("MATERIAL") {
                assert!(materials.contains(name), "{name}");
            }
            match block.name.as_str() {
                "CONTACT PAIR" => {
                    assert!(block.rows[0].iter().all(|name| surfaces.contains(&**name)));
                }
                "BOUNDARY" => block.rows.iter().for_each(|row| nset(&row[0])),
                "SURFACE" => self.check_surface(block),
                _ => {}
            }
        }
    }

    fn check_surface(&self, block: &Block) {
        for row in &block.rows {
            let label = row[0].parse().ok();
            let element = label.and_then(|label: u32| self.elements.get(&label));
            let of_face = element.is_some_and(|(kind, _)| kind.starts_with("C3D"))
                && ["S1", "S2", "S3", "S4", "S5", "S6"].contains(&&*row[1]);
            assert!(of_face, "{row:?}");
        }
    }
}

fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    for line in text.lines() {
        assert!(line.len() <= 256 && line.is_ascii(), "{line:?}");
        if line.starts_with("**") {
            continue;
        }
        let mut words = line
            .trim_end_matches(',')
            .split(',')
            .map(|word| word.trim().to_owned());
        if let Some(keyword) = line.strip_prefix('*') {
            let name = keyword.split(',').next().unwrap().to_owned();
            let pair = |word: String| match word.split_once('=') {
                Some((key, value)) => (key.to_owned(), value.to_owned()),
                None => (word, String::new()),
            };
            let parameters = words.skip(1).map(pair).collect();
            let rows = Vec::new();
            blocks.push(Block {
                name,
                parameters,
                rows,
            });
        } else {
            let block = blocks.last_mut().expect("a keyword comes first");
            let row: Vec<String> = words.by_ref().collect();
            assert!(row.len() <= 16, "{line:?}");
            block.rows.push(row);
        }
    }
    blocks
}
