//! Named arrays in one block of bytes, with a list of their places.

use serde_json::{Value, json};

/// The largest quantised value.
const LEVELS: f64 = 65535.0;

/// Named arrays, one after the other.
#[derive(Debug, Default)]
pub(super) struct Arrays {
    /// For each array: name, kind, offset from the start of the first array in bytes, length, and the values of the
    /// quantised numbers 0 and 65535.
    entries: Vec<Value>,
    bytes: Vec<u8>,
}

impl Arrays {
    /// Adds whole numbers, in 16 bits where they fit.
    pub fn whole(&mut self, name: &str, values: &[u32]) {
        let narrow: Option<Vec<u16>> = values.iter().map(|&value| value.try_into().ok()).collect();
        if let Some(values) = narrow {
            let bytes = values.into_iter().flat_map(u16::to_le_bytes);
            self.add(name, "u16", 2, bytes.collect(), None);
        } else {
            let bytes = values.iter().flat_map(|value| value.to_le_bytes());
            self.add(name, "u32", 4, bytes.collect(), None);
        }
    }

    /// Adds numbers in full precision.
    pub fn exact(&mut self, name: &str, values: impl Iterator<Item = f64>) {
        let bytes = values.flat_map(f64::to_le_bytes);
        self.add(name, "f64", 8, bytes.collect(), None);
    }

    /// Adds numbers in 16 bits of their range; values that are not finite become the lower end.
    pub fn quantised(&mut self, name: &str, values: impl Iterator<Item = f64>, range: [f64; 2]) {
        let [low, high] = range;
        let span = (high - low).max(f64::MIN_POSITIVE);
        let level = |value: f64| (((value - low) / span).clamp(0.0, 1.0) * LEVELS).round() as u16;
        let bytes = values.flat_map(|value| level(value).to_le_bytes());
        self.add(name, "q16", 2, bytes.collect(), Some(range));
    }

    fn add(
        &mut self,
        name: &str,
        kind: &'static str,
        width: usize,
        bytes: Vec<u8>,
        range: Option<[f64; 2]>,
    ) {
        let (offset, length) = (self.bytes.len(), bytes.len() / width);
        let entry = json!({ "name": name, "kind": kind, "offset": offset, "length": length, "range": range });
        self.entries.push(entry);
        self.bytes.extend(bytes);
        // Typed arrays of JavaScript must start at a multiple of their width.
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
    }

    /// Encodes eight bytes with the length of a header, the header as JSON with `facts` and the list, and the arrays.
    pub fn to_bytes(&self, facts: &Value) -> Vec<u8> {
        let head = json!({ "facts": facts, "arrays": self.entries });
        let mut head = head.to_string().into_bytes();
        head.resize(head.len().next_multiple_of(8), b' ');
        let mut bytes = (head.len() as u64).to_le_bytes().to_vec();
        bytes.append(&mut head);
        bytes.extend_from_slice(&self.bytes);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_says_where_each_array_begins() {
        let mut arrays = Arrays::default();
        arrays.whole("faces", &[1, 2, 3]);
        arrays.quantised("depth", [0.0, 0.5, 1.0, f64::NAN].into_iter(), [0.0, 1.0]);
        arrays.exact("cycles", [2.5].into_iter());
        arrays.whole("many", &[70_000]);
        let bytes = arrays.to_bytes(&json!("facts"));
        let head = u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes")) as usize;
        let list: Value = serde_json::from_slice(&bytes[8..8 + head]).expect("the list is JSON");
        let data = &bytes[8 + head..];
        let begin = |at: usize| list["arrays"][at]["offset"].as_u64().expect("is listed") as usize;
        assert_eq!(data[begin(0)..][..6], [1, 0, 2, 0, 3, 0]);
        assert_eq!(data[begin(1)..][..8], [0, 0, 0, 128, 255, 255, 0, 0]);
        assert_eq!(data[begin(2)..][..8], 2.5_f64.to_le_bytes());
        assert_eq!(list["arrays"][3]["kind"], "u32");
        assert_eq!(bytes.len() % 8, 0);
    }
}
