//! Corruption of valid files.

use super::random::Random;

/// Files do not grow beyond this; the limits hold for 1 MB.
const MAX_BYTES: usize = 60_000;

/// Numbers at the limits of types, and texts that are not numbers.
const NUMBERS: &[&str] = &[
    "0",
    "-0",
    "-1",
    "1",
    "2",
    "1e308",
    "-1e308",
    "1e-308",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "9223372036854775807",
    "-9223372036854775808",
    "2147483647",
    "1000000000000",
    "0.1",
    "1e5",
    "0x10",
    "1_000",
    "1.7976931348623157e308",
    "5e-324",
    "",
    "1e",
    "--1",
    "3,5",
];

/// Keywords of the formats, inserted at random places.
const WORDS: &[&str] = &[
    "facet",
    "endsolid",
    "vertex",
    "end_header",
    "list uchar int x",
    "property",
    "binary_big_endian",
    "v",
    "f",
    "vn",
    "*NSET, GENERATE",
    "*ELEMENT, TYPE=C3D8",
    "*NODE",
    "*SURFACE",
    "$Nodes",
    "$EndNodes",
    "$Elements",
    "appended",
    "ascii",
    "binary",
    "<DataArray>",
    "</Piece>",
    "encoding=\"raw\"",
    "offset=\"-1\"",
    "=",
    "==",
    "[",
    "]]",
    "{",
    "}",
    "\"",
    "'''",
    "#",
    ",",
    ",,",
    "\\",
    "\r",
    "\u{0}",
    "\u{1b}[31m",
    "\u{feff}",
    "\u{202e}",
    "&amp;",
    "&#0;",
    "inherit",
    "true",
    "[[",
    "a.b.c",
    "mm",
    "in",
    "\t",
];

/// Returns a seed changed in one to four ways, with pieces of others of the corpus.
pub fn mutated(seed: &[u8], corpus: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(4) {
        let other = corpus[random.below(corpus.len())].as_slice();
        change(&mut bytes, other, random);
        bytes.truncate(MAX_BYTES);
    }
    bytes
}

fn change(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    match random.below(14) {
        0 => flip_bit(bytes, random),
        1 => bytes.truncate(random.below(bytes.len() + 1)),
        2 => drop(bytes.drain(random.range(bytes.len(), 64))),
        3 => insert(bytes, &other[random.range(other.len(), 200)], random),
        4 => swap_tail(bytes, other, random),
        5 => overwrite_binary(bytes, random),
        6 | 7 => swap_number(bytes, random),
        8 => insert(bytes, random.of(NUMBERS).as_bytes(), random),
        9 => insert(bytes, random.of(WORDS).as_bytes(), random),
        10 => repeat_line(bytes, random),
        11 => swap_lines(bytes, random),
        12 => swap_token(bytes, random),
        _ => repeat_byte(bytes, random),
    }
}

fn flip_bit(bytes: &mut [u8], random: &mut Random) {
    let place = random.below(bytes.len());
    if let Some(byte) = bytes.get_mut(place) {
        *byte ^= 1 << random.below(8);
    }
}

fn insert(bytes: &mut Vec<u8>, piece: &[u8], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    bytes.splice(at..at, piece.iter().copied());
}

fn swap_tail(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    bytes.truncate(random.below(bytes.len() + 1));
    bytes.extend(&other[random.below(other.len())..]);
}

/// Overwrites bytes with a number of 1 to 8 bytes at the end of its range.
fn overwrite_binary(bytes: &mut [u8], random: &mut Random) {
    let numbers: [&[u8]; 9] = [
        &[0xff],
        &[0xff; 4],
        &[0xff; 8],
        &[0; 4],
        &[0, 0, 0, 0x80],
        &[0xff, 0xff, 0xff, 0x7f],
        &[0, 0, 0xc0, 0x7f],
        &[0, 0, 0, 0, 0, 0, 0xf0, 0x7f],
        &[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xef, 0x7f],
    ];
    let number = *random.of(&numbers);
    let at = random.below(bytes.len());
    let room = bytes[at..].iter_mut().zip(number);
    room.for_each(|(byte, &new)| *byte = new);
}

/// Returns the places of the pieces between ends.
fn pieces(bytes: &[u8], is_end: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut start = 0;
    let mut pieces = Vec::new();
    for (at, &byte) in bytes.iter().enumerate() {
        if is_end(byte) {
            if at > start {
                pieces.push(start..at);
            }
            start = at + 1;
        }
    }
    if start < bytes.len() {
        pieces.push(start..bytes.len());
    }
    pieces
}

fn is_between_tokens(byte: u8) -> bool {
    byte.is_ascii_whitespace() || b",=\"[]<>".contains(&byte)
}

fn swap_number(bytes: &mut Vec<u8>, random: &mut Random) {
    let mut tokens = pieces(bytes, is_between_tokens);
    tokens.retain(|token| bytes[token.start].is_ascii_digit() || bytes[token.start] == b'-');
    if !tokens.is_empty() {
        let token = random.of(&tokens).clone();
        bytes.splice(token, random.of(NUMBERS).bytes());
    }
}

fn swap_token(bytes: &mut Vec<u8>, random: &mut Random) {
    let tokens = pieces(bytes, is_between_tokens);
    if !tokens.is_empty() {
        let piece = bytes[random.of(&tokens).clone()].to_vec();
        bytes.splice(random.of(&tokens).clone(), piece);
    }
}

fn repeat_line(bytes: &mut Vec<u8>, random: &mut Random) {
    let lines = pieces(bytes, |byte| byte == b'\n');
    if !lines.is_empty() {
        let line = random.of(&lines).clone();
        let mut once = bytes[line.clone()].to_vec();
        once.push(b'\n');
        let times = *random.of(&[1, 2, 10, 300]);
        let many = once.repeat(times.min(MAX_BYTES / once.len()));
        bytes.splice(line.start..line.start, many);
    }
}

fn swap_lines(bytes: &mut Vec<u8>, random: &mut Random) {
    let lines = pieces(bytes, |byte| byte == b'\n');
    if !lines.is_empty() {
        let from = bytes[random.of(&lines).clone()].to_vec();
        bytes.splice(random.of(&lines).clone(), from);
    }
}

fn repeat_byte(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(bytes.len());
    if let Some(&byte) = bytes.get(at) {
        let times = *random.of(&[1, 8, 500, 20_000]);
        bytes.splice(at..at, std::iter::repeat_n(byte, times));
    }
}
