//! Binary arrays of VTK's XML files: byte counts, base64, zlib blocks, numbers of any type.
//!
//! Layout after VTK's "File Formats" document: a binary array is a byte count and the values;
//! a compressed one is the number of blocks, the size of a block, the size of the last block,
//! the compressed sizes, and the blocks.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

const CUT_OFF: &str = "an array ends before its announced length; was it cut off?";

/// How a file lays out its binary arrays.
pub(super) struct BinaryLayout {
    /// Bytes of a count.
    pub(super) count_bytes: usize,
    pub(super) big_endian: bool,
    pub(super) zlib: bool,
}

impl BinaryLayout {
    /// Values of the array that `bytes` start with, at most `most` of them.
    pub(super) fn values(&self, kind: &str, bytes: &[u8], most: usize) -> Result<Vec<f64>, String> {
        let (size, decode) =
            decoder(kind).ok_or_else(|| format!("an array's type {kind:?} is not known"))?;
        let inflated;
        let data = if self.zlib {
            inflated = self.inflate(bytes, most.saturating_mul(size))?;
            inflated.as_slice()
        } else {
            self.whole_length(bytes)
                .and_then(|end| bytes.get(self.count_bytes..end))
                .ok_or(CUT_OFF)?
        };
        if data.len() / size > most {
            return Err(too_many());
        }
        Ok(decode(data, self.big_endian))
    }

    /// The bytes of the array that base64 starts with; what is encoded behind it is left.
    pub(super) fn decoded(&self, encoded: &[u8]) -> Result<Vec<u8>, String> {
        let mut wanted = self.count_bytes;
        loop {
            let bytes = base64_bytes(encoded, wanted)?;
            let length = self.whole_length(&bytes).unwrap_or_default();
            if length <= wanted || bytes.len() < wanted {
                return Ok(bytes);
            }
            wanted = length;
        }
    }

    /// How long the array is with its counts, as far as `bytes` say: a compressed one has
    /// first the number of its counts.
    fn whole_length(&self, bytes: &[u8]) -> Option<usize> {
        let first = self.count(bytes, 0)?;
        if !self.zlib {
            return first.checked_add(self.count_bytes);
        }
        let counts = first.checked_add(3)?.checked_mul(self.count_bytes)?;
        if counts > bytes.len() {
            return Some(counts);
        }
        (0..first).try_fold(counts, |end, block| {
            end.checked_add(self.count(bytes, 3 + block)?)
        })
    }

    fn count(&self, bytes: &[u8], index: usize) -> Option<usize> {
        let start = index.checked_mul(self.count_bytes)?;
        let bytes = bytes.get(start..start.checked_add(self.count_bytes)?)?;
        let fold = |value: usize, &byte: &u8| value << 8 | usize::from(byte);
        Some(if self.big_endian {
            bytes.iter().fold(0, fold)
        } else {
            bytes.iter().rev().fold(0, fold)
        })
    }

    fn inflate(&self, bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
        let count = |index| self.count(bytes, index).ok_or(CUT_OFF);
        let blocks = count(0)?;
        if blocks == 0 {
            return Ok(Vec::new());
        }
        let (full, last) = (count(1)?, count(2)?);
        let counts = blocks
            .checked_add(3)
            .and_then(|n| n.checked_mul(self.count_bytes));
        let mut start = counts.ok_or(CUT_OFF)?;
        let mut data = Vec::new();
        for block in 0..blocks {
            // A last block of size 0 is as large as the others.
            let is_partial = block + 1 == blocks && last > 0;
            let announced = if is_partial { last } else { full };
            let end = start.checked_add(count(3 + block)?);
            let packed = end.and_then(|end| bytes.get(start..end)).ok_or(CUT_OFF)?;
            inflate_block(packed, announced, most, &mut data)?;
            start += packed.len();
        }
        Ok(data)
    }
}

/// Adds a block to `data`; a few bytes can hold a thousand times as many, so that what comes
/// out is bounded as it comes.
fn inflate_block(
    packed: &[u8],
    announced: usize,
    most: usize,
    data: &mut Vec<u8>,
) -> Result<(), String> {
    let room = most - data.len();
    let stop = announced.min(room).saturating_add(1);
    let decoder = flate2::read::ZlibDecoder::new(packed);
    let found = decoder
        .take(stop as u64)
        .read_to_end(data)
        .map_err(|_| CUT_OFF)?;
    if found > announced {
        return Err(format!(
            "an array has a compressed block of more than its announced {announced} bytes; \
             save the file again"
        ));
    }
    if found > room {
        return Err(too_many());
    }
    Ok(())
}

fn too_many() -> String {
    "an array unpacks to more values than a mesh in a file of this length has; save the file uncompressed"
        .to_owned()
}

/// The first bytes in base64, `wanted` or up to three more; the counts and the values may each be
/// padded on their own.
fn base64_bytes(encoded: &[u8], wanted: usize) -> Result<Vec<u8>, String> {
    let characters = wanted.div_ceil(3).saturating_add(1).saturating_mul(4);
    let filled = encoded.iter().copied().take_while(|&byte| byte != b'<');
    let filled = filled.filter(|byte| !byte.is_ascii_whitespace());
    let encoded: Vec<u8> = filled.take(characters).collect();
    let mut rest = encoded.as_slice();
    let mut bytes = Vec::with_capacity(rest.len() / 4 * 3);
    while !rest.is_empty() {
        let padding = rest.iter().position(|&byte| byte == b'=');
        let padding = padding.unwrap_or(rest.len());
        // At least one group of four, so that a padding out of place is decoded, and refused.
        let end = padding.next_multiple_of(4).max(4).min(rest.len());
        let (segment, after) = rest.split_at(end);
        STANDARD
            .decode_vec(segment, &mut bytes)
            .map_err(|error| format!("an array's base64 is broken: {error}"))?;
        rest = after;
    }
    Ok(bytes)
}

type Decoder = fn(&[u8], bool) -> Vec<f64>;

/// Bytes of a value of that type, and what makes numbers of them.
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
