//! Changes valid inputs: bits, bytes, numbers, words and whole pieces.

use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use std::ops::Range;

/// Numbers at the ends of what types hold, as texts.
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "-0.0",
    "1e-320",
    "1e-9",
    "0.5",
    "1e6",
    "1e9",
    "1e30",
    "1e308",
    "-1e308",
    "1e999",
    "nan",
    "NaN",
    ".nan",
    "inf",
    "-inf",
    ".inf",
    "-.inf",
    "null",
    "true",
    "\"\"",
    "[]",
    "{}",
    "127",
    "255",
    "32768",
    "65535",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "340282350000000000000000000000000000000",
];
/// The same for four bytes.
const WORDS: &[u32] = &[0, 1, 2, 4, 255, 256, 65_535, 65_536, 1 << 24, 1 << 28, i32::MAX as u32, 1 << 31, u32::MAX];
/// The same for numbers with a point, of four and of eight bytes.
const FLOATS: &[f64] = &[
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1e-45,
    1e-9,
    1e-6,
    1e-3,
    100.0,
    1e3,
    1e6,
    1e9,
    1e30,
    1e38,
    1e300,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];
/// So many inputs with answers of their own are changed further: of those that were taken, and of
/// those that were refused.
const MOST_TAKEN: usize = 2000;
const MOST_REFUSED: usize = 200;
/// So many bytes are changed as often as all of an input.
const HEAD: usize = 120;
/// Changed inputs are no longer than so many times the longest of the corpus, and some bytes.
const LONGEST: (usize, usize) = (2, 2000);

/// Makes inputs of others.
pub struct Mutator {
    random: Pcg64,
    taken: Vec<Vec<u8>>,
    refused: Vec<Vec<u8>>,
    longest: usize,
}

impl Mutator {
    /// Begins with a corpus.
    pub fn new(seed: u64, corpus: &[Vec<u8>]) -> Self {
        let longest = corpus.iter().map(Vec::len).max().expect("a corpus");
        let longest = LONGEST.0 * longest + LONGEST.1;
        Self { random: Pcg64::seed_from_u64(seed), taken: corpus.to_vec(), refused: Vec::new(), longest }
    }

    /// Changes this input further, too.
    pub fn keep(&mut self, input: Vec<u8>, is_taken: bool) {
        let (kept, most) = if is_taken { (&mut self.taken, MOST_TAKEN) } else { (&mut self.refused, MOST_REFUSED) };
        if kept.len() < most {
            kept.push(input);
        }
    }

    /// An input with one to eight changes; mostly few.
    pub fn next_input(&mut self) -> Vec<u8> {
        let mut input = self.any().clone();
        let changes = [1, 1, 1, 2, 2, 3, 5, 8].choose(&mut self.random).copied().unwrap_or(1);
        for _ in 0..changes {
            self.change(&mut input);
        }
        input.truncate(self.longest);
        input
    }

    /// One of those that are changed: seldom one that was refused.
    fn any(&mut self) -> &Vec<u8> {
        let is_refused = !self.refused.is_empty() && self.random.random_range(0..10) == 0;
        let kept = if is_refused { &self.refused } else { &self.taken };
        &kept[self.random.random_range(0..kept.len())]
    }

    fn change(&mut self, input: &mut Vec<u8>) {
        let random = &mut self.random;
        if input.is_empty() {
            return input.push(random.random());
        }
        // What says how the rest is to be read stands at the beginning.
        let head = if random.random() { input.len() } else { input.len().min(HEAD) };
        let at = random.random_range(0..head);
        match random.random_range(0..14) {
            0 => input[at] ^= 1 << random.random_range(0..8),
            1 => input[at] = *[0, 1, 0x7f, 0x80, 0xff, b' ', b'\n', b'-', b'['].choose(random).unwrap(),
            2 => input[at] = random.random(),
            3 => overwrite(input, at, &WORDS.choose(random).unwrap().to_le_bytes()),
            4 => overwrite(input, at, &WORDS.choose(random).unwrap().to_be_bytes()),
            5 => overwrite(input, at, &(*FLOATS.choose(random).unwrap() as f32).to_le_bytes()),
            6 => overwrite(input, at, &FLOATS.choose(random).unwrap().to_le_bytes()),
            7 => input.truncate(at),
            8 => drop(input.drain(self.piece(input.len()))),
            9 => {
                let piece = input[self.piece(input.len())].to_vec();
                let times = *[1, 1, 2, 10, 300].choose(&mut self.random).unwrap();
                let times = times.min(self.longest / piece.len().max(1));
                input.splice(at..at, piece.repeat(times));
            }
            10 => {
                let other = self.any().clone();
                let piece = self.piece(other.len());
                let end = (at + piece.len() * self.random.random_range(0..2)).min(input.len());
                input.splice(at..end, other[piece].iter().copied());
            }
            11 | 12 => {
                let is_part = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+');
                if let Some(token) = self.token(input, is_part) {
                    input.splice(token, NUMBERS.choose(&mut self.random).unwrap().bytes());
                }
            }
            _ => {
                let other = self.any().clone();
                let is_part = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'-');
                if let (Some(token), Some(theirs)) = (self.token(input, is_part), self.token(&other, is_part)) {
                    input.splice(token, other[theirs].iter().copied());
                }
            }
        }
    }

    /// A piece, mostly a short one.
    fn piece(&mut self, length: usize) -> Range<usize> {
        let begin = self.random.random_range(0..=length);
        let most = *[4, 16, 100, length].choose(&mut self.random).unwrap();
        begin..length.min(begin + self.random.random_range(0..=most))
    }

    /// One of the tokens made of some bytes.
    fn token(&mut self, input: &[u8], is_part: impl Fn(u8) -> bool) -> Option<Range<usize>> {
        let from = self.random.random_range(0..=input.len());
        let begin = from + input[from..].iter().position(|&byte| is_part(byte))?;
        let begin = input[..begin].iter().rposition(|&byte| !is_part(byte)).map_or(0, |before| before + 1);
        let end = input[begin..].iter().position(|&byte| !is_part(byte)).map_or(input.len(), |length| begin + length);
        Some(begin..end)
    }
}

fn overwrite(input: &mut [u8], at: usize, bytes: &[u8]) {
    for (byte, &new) in input[at..].iter_mut().zip(bytes) {
        *byte = new;
    }
}

#[test]
fn the_same_seed_makes_the_same_inputs() {
    let corpus = [b"a: 1.5\nb: [2, 3]\n".to_vec()];
    let make = |seed| {
        let mut mutator = Mutator::new(seed, &corpus);
        (0..200).map(|_| mutator.next_input()).collect::<Vec<_>>()
    };
    assert_eq!(make(1), make(1));
    assert_ne!(make(1), make(2));
    assert!(make(1).iter().any(|input| input != &corpus[0] && input.starts_with(b"a: ")));
}
