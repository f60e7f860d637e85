//! A copy of this program that valgrind can read.
//!
//! The compiler writes `vmovq` from a high register to a low one with the opcode D6, a byte shorter than
//! with 7E. Valgrind (3.19 at least) knows D6 only to memory and gives up. So in the copy a jump stands in
//! the instruction's place, to padding that holds it with 7E, and back: two more instructions, the
//! same numbers.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::Command,
};

/// The byte with which the linker fills the space between functions.
const PADDING: u8 = 0xCC;
/// A jump to a distance of 32 bits: its opcode and its length.
const JUMP: u8 = 0xE9;
const JUMP_LENGTH: usize = 5;
const NO_OPERATION: u8 = 0x90;

/// An instruction as objdump shows it.
struct Instruction {
    address: usize,
    bytes: Vec<u8>,
    text: String,
}

impl Instruction {
    /// Of a line such as `  ac477:\tc5 79 d6 f0 \tvmovq  %xmm14,%xmm0`.
    fn of(line: &str) -> Option<Self> {
        let mut columns = line.split('\t');
        let address = columns.next()?.trim().strip_suffix(':')?;
        let bytes = columns.next()?.split_whitespace();
        Some(Self {
            address: usize::from_str_radix(address, 16).ok()?,
            bytes: bytes
                .map_while(|byte| u8::from_str_radix(byte, 16).ok())
                .collect(),
            text: columns.next().unwrap_or_default().to_owned(),
        })
    }

    /// The same with the opcode 7E, if it is a move that valgrind cannot read.
    fn rewritten(&self) -> Option<[u8; 5]> {
        match self.bytes[..] {
            [0xC5, 0x79, 0xD6, registers] if registers >= 0xC0 => {
                let (from, to) = (registers >> 3 & 7, registers & 7);
                Some([0xC4, 0xC1, 0x7A, 0x7E, 0xC0 | to << 3 | from])
            }
            _ => None,
        }
    }

    /// Returns whether the instruction has the same effect at another address.
    fn may_move(&self) -> bool {
        let goes_on = !["j", "call", "ret", "loop", "bnd", "notrack"]
            .iter()
            .any(|word| self.text.starts_with(word));
        goes_on && !self.text.contains("(%rip)")
    }

    /// Returns the target of a jump, if the text contains it.
    fn target(&self) -> Option<usize> {
        let place = self.text.strip_prefix('j')?.split_whitespace().nth(1)?;
        usize::from_str_radix(place, 16).ok()
    }
}

/// Writes the copy into a folder.
pub fn copy(folder: &Path) -> PathBuf {
    let this = std::env::current_exe().expect("a program knows where it is");
    let mut program = std::fs::read(&this).expect("a program can be read");
    let listing = listing(&this);
    let ahead = ahead_of_file(&listing);
    let code: Vec<Instruction> = listing.lines().filter_map(Instruction::of).collect();
    let targets: BTreeSet<usize> = code.iter().filter_map(Instruction::target).collect();
    for at in 0..code.len() {
        if let Some(rewritten) = code[at].rewritten() {
            // One more instruction has to go, since a jump is a byte longer.
            let is_entered = |at: usize| targets.contains(&code[at].address);
            let (first, moved) = if code[at + 1].may_move() && !is_entered(at + 1) {
                (at, [&rewritten, &code[at + 1].bytes[..]].concat())
            } else {
                let before = &code[at - 1];
                assert!(
                    before.may_move() && !is_entered(at),
                    "nothing beside {:x} may move",
                    code[at].address
                );
                (at - 1, [&before.bytes[..], &rewritten].concat())
            };
            let length = code[first].bytes.len() + code[first + 1].bytes.len();
            detour(&mut program, code[first].address - ahead, length, &moved);
        }
    }
    write(program, &this, &folder.join("figures"))
}

/// Puts a jump to padding in the place of `length` bytes; there `moved` is done in their stead.
fn detour(program: &mut [u8], place: usize, length: usize, moved: &[u8]) {
    let needed = moved.len() + JUMP_LENGTH;
    let padding = padding(program, place, needed);
    program[padding..padding + moved.len()].copy_from_slice(moved);
    jump(program, padding + moved.len(), place + length);
    program[place..place + length].fill(NO_OPERATION);
    jump(program, place, padding);
}

fn jump(program: &mut [u8], from: usize, to: usize) {
    let distance = to as i64 - (from + JUMP_LENGTH) as i64;
    let distance = i32::try_from(distance).expect("a program is not that long");
    program[from] = JUMP;
    program[from + 1..from + JUMP_LENGTH].copy_from_slice(&distance.to_le_bytes());
}

/// The padding that is long enough and nearest to a place, after it if there is one: so it is code.
fn padding(program: &[u8], place: usize, length: usize) -> usize {
    let is_padding = |bytes: &[u8]| bytes.iter().all(|&byte| byte == PADDING);
    let after = program[place..].windows(length).position(is_padding);
    let before = || program[..place].windows(length).rposition(is_padding);
    let found = after.map(|after| place + after).or_else(before);
    found.expect("there is padding between functions")
}

fn listing(program: &Path) -> String {
    let told = Command::new("objdump")
        .args([
            "--disassemble",
            "--wide",
            "--file-offsets",
            "--section=.text",
        ])
        .arg(program)
        .output()
        .expect("objdump runs");
    String::from_utf8_lossy(&told.stdout).into_owned()
}

/// Returns the offset of addresses from file positions, from the first line `address <name> (File Offset: 0xplace):`.
fn ahead_of_file(listing: &str) -> usize {
    let number = |text: &str| usize::from_str_radix(text, 16).ok();
    let ahead = |line: &str| {
        let (name, offset) = line.split_once(" (File Offset: 0x")?;
        Some(number(name.split(' ').next()?)? - number(offset.strip_suffix("):")?)?)
    };
    listing
        .lines()
        .find_map(ahead)
        .expect("objdump names a function")
}

fn write(program: Vec<u8>, like: &Path, to: &Path) -> PathBuf {
    std::fs::copy(like, to).expect("a program can be copied");
    std::fs::write(to, program).expect("a copy can be written");
    to.to_owned()
}
