//! Binary data arrays of VTK files: raw or base64, compressed or not.

use std::io::Read;

use base64::{Engine, engine::general_purpose::STANDARD};
use roxmltree::Node;

const CUT_OFF: &str = "an array ends before its announced length; was it cut off?";
const TOO_MANY: &str = "an array unpacks to more values than a mesh in a file of this length has; \
                        save the file uncompressed";

/// Layout of the binary arrays of a file.
pub(super) struct BinaryLayout {
    count_bytes: usize,
    big_endian: bool,
    zlib: bool,
}

impl BinaryLayout {
    pub(super) fn new(root: Node) -> Result<Self, String> {
        let compressor = root.attribute("compressor");
        if let Some(other) = compressor.filter(|name| *name != "vtkZLibDataCompressor") {
            return Err(format!(
                "is compressed by {other}; save it with zlib or uncompressed"
            ));
        }
        let is_long = root.attribute("header_type") == Some("UInt64");
        Ok(Self {
            count_bytes: if is_long { 8 } else { 4 },
            big_endian: root.attribute("byte_order") == Some("BigEndian"),
            zlib: compressor.is_some(),
        })
    }

    /// Returns the values of the array at the start of `bytes`, an error if they are more than `max`.
    pub(super) fn values(&self, kind: &str, bytes: &[u8], max: usize) -> Result<Vec<f64>, String> {
        let decoder = decoder(kind);
        let (size, decode) =
            decoder.ok_or_else(|| format!("an array's type {kind:?} is not known"))?;
        let inflated;
        let data = if self.zlib {
            inflated = self.inflate(bytes, max.saturating_mul(size))?;
            inflated.as_slice()
        } else {
            let end = self.whole_length(bytes);
            let data = end.and_then(|end| bytes.get(self.count_bytes..end));
            data.ok_or(CUT_OFF)?
        };
        if data.len() / size > max {
            return Err(TOO_MANY.into());
        }
        Ok(decode(data, self.big_endian))
    }

    /// Decodes the base64 of one array; the rest of `encoded` is left.
    pub(super) fn decoded(&self, encoded: &[u8]) -> Result<Vec<u8>, String> {
        // The first count gives the number of counts, and these the length: no more is decoded than is needed.
        let mut needed = self.count_bytes;
        loop {
            let bytes = base64_bytes(encoded, needed)?;
            let length = self.whole_length(&bytes).unwrap_or_default();
            if length <= needed || bytes.len() < needed {
                return Ok(bytes);
            }
            needed = length;
        }
    }

    /// Returns the length of the array with its counts, as far as `bytes` show it: a compressed one starts with the
    /// number of its counts.
    fn whole_length(&self, bytes: &[u8]) -> Option<usize> {
        let first = self.count(bytes, 0)?;
        if !self.zlib {
            return first.checked_add(self.count_bytes);
        }
        let counts = self.counts_length(first)?;
        if counts > bytes.len() {
            return Some(counts);
        }
        (0..first).try_fold(counts, |end, block| {
            end.checked_add(self.count(bytes, 3 + block)?)
        })
    }

    /// Returns the bytes of the counts before compressed blocks: blocks, size, last size, and a size for each.
    fn counts_length(&self, blocks: usize) -> Option<usize> {
        blocks.checked_add(3)?.checked_mul(self.count_bytes)
    }

    fn count(&self, bytes: &[u8], index: usize) -> Option<usize> {
        let start = index.checked_mul(self.count_bytes)?;
        let bytes = bytes.get(start..start.checked_add(self.count_bytes)?)?;
        let append = |value: usize, &byte: &u8| value << 8 | usize::from(byte);
        Some(if self.big_endian {
            bytes.iter().fold(0, append)
        } else {
            bytes.iter().rev().fold(0, append)
        })
    }

    fn inflate(&self, bytes: &[u8], max: usize) -> Result<Vec<u8>, String> {
        let count = |index| self.count(bytes, index).ok_or(CUT_OFF);
        let blocks = count(0)?;
        let mut data = Vec::new();
        if blocks == 0 {
            return Ok(data);
        }
        let (full, last) = (count(1)?, count(2)?);
        let mut start = self.counts_length(blocks).ok_or(CUT_OFF)?;
        for block in 0..blocks {
            // A last block of size 0 is as large as the others.
            let is_partial = block + 1 == blocks && last > 0;
            let announced = if is_partial { last } else { full };
            let end = start.checked_add(count(3 + block)?);
            let packed = end.and_then(|end| bytes.get(start..end)).ok_or(CUT_OFF)?;
            start += packed.len();
            // A few bytes can hold a thousand times as many, so the output is bounded while it is unpacked.
            let room = max - data.len();
            let stop = announced.min(room).saturating_add(1);
            let mut decoder = flate2::read::ZlibDecoder::new(packed).take(stop as u64);
            let found = decoder.read_to_end(&mut data).map_err(|_| CUT_OFF)?;
            if found > announced {
                return Err(format!(
                    "an array has a compressed block of more than its announced {announced} bytes; \
                     save the file again"
                ));
            }
            if found > room {
                return Err(TOO_MANY.into());
            }
        }
        Ok(data)
    }
}

/// Decodes the first bytes of base64, `needed` or up to three more. Counts and values may each have their own padding.
fn base64_bytes(encoded: &[u8], needed: usize) -> Result<Vec<u8>, String> {
    let characters = needed.div_ceil(3).saturating_add(1).saturating_mul(4);
    let filled = encoded.iter().copied().take_while(|&byte| byte != b'<');
    let filled = filled.filter(|byte| !byte.is_ascii_whitespace());
    let encoded: Vec<u8> = filled.take(characters).collect();
    let mut rest = encoded.as_slice();
    let mut bytes = Vec::with_capacity(rest.len() / 4 * 3);
    while !rest.is_empty() {
        let padding = rest.iter().position(|&byte| byte == b'=');
        let padding = padding.unwrap_or(rest.len());
        // At least one group of four, so that misplaced padding is decoded, and refused.
        let end = padding.next_multiple_of(4).max(4).min(rest.len());
        let (segment, after) = rest.split_at(end);
        let decoded = STANDARD.decode_vec(segment, &mut bytes);
        decoded.map_err(|error| format!("an array's base64 is broken: {error}"))?;
        rest = after;
    }
    Ok(bytes)
}

type Decoder = fn(&[u8], bool) -> Vec<f64>;

/// Returns the size of a value of VTK's type `kind` in bytes, and its decoder.
fn decoder(kind: &str) -> Option<(usize, Decoder)> {
    macro_rules! of {
        ($number:ty) => {
            (size_of::<$number>(), |bytes, big_endian| {
                let values = bytes.as_chunks::<{ size_of::<$number>() }>().0.iter();
                let from = if big_endian {
                    <$number>::from_be_bytes
                } else {
                    <$number>::from_le_bytes
                };
                values.map(|&value| from(value) as f64).collect()
            })
        };
    }
    Some(match kind {
        "Float32" => of!(f32),
        "Float64" => of!(f64),
        "Int8" => of!(i8),
        "UInt8" => of!(u8),
        "Int16" => of!(i16),
        "UInt16" => of!(u16),
        "Int32" => of!(i32),
        "UInt32" => of!(u32),
        "Int64" => of!(i64),
        "UInt64" => of!(u64),
        _ => return None,
    })
}
