//! Arrays one behind the other, with a list of what they are.

use serde::Serialize;

/// Largest number of a quantised value.
const LEVELS: f64 = 65535.0;

/// What an array is and where it begins.
#[derive(Debug, Serialize)]
struct Entry {
    name: String,
    kind: &'static str,
    /// Bytes from the start of the first array.
    offset: usize,
    /// Numbers in it.
    length: usize,
    /// What the quantised number 0 stands for, and 65535.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
}

/// Arrays one behind the other, with a list of what they are.
#[derive(Debug, Default)]
pub(super) struct Arrays {
    entries: Vec<Entry>,
    bytes: Vec<u8>,
}

impl Arrays {
    /// Whole numbers, in 16 bits where they fit.
    pub fn whole(&mut self, name: impl Into<String>, values: &[u32]) {
        if values.iter().all(|&value| value <= u32::from(u16::MAX)) {
            let values = values
                .iter()
                .flat_map(|&value| (value as u16).to_le_bytes());
            self.add(name.into(), "u16", 2, values.collect(), None);
        } else {
            let values = values.iter().flat_map(|value| value.to_le_bytes());
            self.add(name.into(), "u32", 4, values.collect(), None);
        }
    }

    /// Numbers as they are.
    pub fn exact(&mut self, name: impl Into<String>, values: impl IntoIterator<Item = f64>) {
        let values = values.into_iter().flat_map(f64::to_le_bytes).collect();
        self.add(name.into(), "f64", 8, values, None);
    }

    /// Numbers in 16 bits of their range; what is not finite is taken for the lower end.
    pub fn quantised(
        &mut self,
        name: impl Into<String>,
        values: impl Iterator<Item = f64> + Clone,
        range: [f64; 2],
    ) {
        let [low, high] = range;
        let span = (high - low).max(f64::MIN_POSITIVE);
        let level = |value: f64| (((value - low) / span).clamp(0.0, 1.0) * LEVELS).round() as u16;
        let values = values.flat_map(|value| level(value).to_le_bytes());
        self.add(name.into(), "q16", 2, values.collect(), Some(range));
    }

    fn add(
        &mut self,
        name: String,
        kind: &'static str,
        width: usize,
        bytes: Vec<u8>,
        range: Option<[f64; 2]>,
    ) {
        self.entries.push(Entry {
            name,
            kind,
            offset: self.bytes.len(),
            length: bytes.len() / width,
            range,
        });
        self.bytes.extend(bytes);
        // A typed array begins at a multiple of its width.
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
    }

    /// A header of eight bytes with the length of the list, the list as JSON beside `facts`, the arrays.
    pub fn to_bytes(&self, facts: &impl Serialize) -> Vec<u8> {
        let head = serde_json::json!({ "facts": facts, "arrays": self.entries });
        let mut head = head.to_string().into_bytes();
        head.resize(head.len().next_multiple_of(8), b' ');
        let mut bytes = (head.len() as u64).to_le_bytes().to_vec();
        bytes.append(&mut head);
        bytes.extend_from_slice(&self.bytes);
        bytes
    }
}

/// Smallest and largest finite value; 0 twice where there is none.
pub(super) fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let widen = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
    let found = values
        .filter(|value| value.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], widen);
    if found[0] <= found[1] {
        found
    } else {
        [0.0; 2]
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
        arrays.exact("cycles", [2.5]);
        arrays.whole("many", &[70_000]);
        let bytes = arrays.to_bytes(&"facts");
        let head = u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes")) as usize;
        let list: serde_json::Value =
            serde_json::from_slice(&bytes[8..8 + head]).expect("the list is JSON");
        let data = &bytes[8 + head..];
        let begin = |at: usize| list["arrays"][at]["offset"].as_u64().expect("is listed") as usize;
        assert_eq!(data[begin(0)..][..6], [1, 0, 2, 0, 3, 0]);
        assert_eq!(data[begin(1)..][..8], [0, 0, 0, 128, 255, 255, 0, 0]);
        assert_eq!(data[begin(2)..][..8], 2.5_f64.to_le_bytes());
        assert_eq!(list["arrays"][3]["kind"], "u32");
        assert_eq!(bytes.len() % 8, 0);
    }
}
