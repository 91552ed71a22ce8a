//! Runs a target on one changed input after the other, with a limit to time and memory.

use super::mutate::Mutator;
use std::collections::HashSet;
use std::os::unix::fs::FileExt as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// An input that takes longer has failed, however slow the machine; `FRONTIER_FUZZ_LIMIT_S` says
/// another limit.
const LIMIT_S: f64 = 10.0;
/// How long a target is tried where nothing else is said, seconds.
const DEFAULT_S: f64 = 1.0;
/// So many kinds of answers are told apart.
const MOST_KINDS: usize = 10_000;
/// What a target makes of an input: what it is taken for, or why it is refused.
pub type Answer = Result<String, String>;

/// What is fed with inputs.
pub struct Target {
    /// Its name, and that of its folder in `corpus`.
    pub name: &'static str,
    /// Takes an input.
    pub run: fn(&[u8]) -> Answer,
    /// The valid inputs that are made by code, as names and bytes; others lie in the corpus.
    pub seeds: fn() -> Vec<(String, Vec<u8>)>,
    /// The most memory that an input may take at a time: bytes, and bytes for each of its own.
    pub memory: (u64, u64),
    /// Of the changed inputs, at least so many of a hundred are taken: else nothing behind the first
    /// check is tried.
    pub least_taken_percent: f64,
}

/// No seeds but those that lie in the corpus.
pub const fn none() -> Vec<(String, Vec<u8>)> {
    Vec::new()
}

/// The files of a folder of the project, by name; none where there is no such folder.
pub fn files_in(folder: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let paths = std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
    let files = paths.filter(|path| path.is_file()).map(|path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read(path).unwrap())
    });
    files.collect()
}

fn setting(name: &str) -> Option<f64> {
    std::env::var(name).ok().map(|value| value.parse().expect("a number"))
}

impl Target {
    /// Tries the corpus, and then changes of it.
    pub fn fuzz(&self) {
        let corpus = self.corpus();
        let watch = Watch::begin(self.name);
        let mut kinds = HashSet::new();
        for (name, input) in &corpus {
            let answer = self.try_one(input, &watch);
            // What was found once may be refused, and whatever else is there is valid.
            assert!(name.starts_with("found") || answer.is_ok(), "{} {name}: {answer:?}", self.name);
            kinds.insert(kind(&answer));
        }
        let seconds = setting("FRONTIER_FUZZ_S").unwrap_or(DEFAULT_S);
        let inputs: Vec<Vec<u8>> = corpus.into_iter().map(|(_, input)| input).collect();
        let mut mutator = Mutator::new(setting("FRONTIER_FUZZ_SEED").map_or(1, |seed| seed as u64), &inputs);
        let (began, mut tried, mut taken) = (Instant::now(), 0_u64, 0_u64);
        while began.elapsed().as_secs_f64() < seconds {
            let input = mutator.next_input();
            let answer = self.try_one(&input, &watch);
            tried += 1;
            taken += u64::from(answer.is_ok());
            if kinds.len() < MOST_KINDS && kinds.insert(kind(&answer)) {
                mutator.keep(input, answer.is_ok());
            }
        }
        let percent = 100.0 * taken as f64 / tried.max(1) as f64;
        eprintln!(
            "{}: {tried} inputs in {:.0} s, {percent:.1} % of them taken, answers of {} kinds",
            self.name,
            began.elapsed().as_secs_f64(),
            kinds.len()
        );
        assert!(tried < 50 || percent >= self.least_taken_percent, "{}: only {percent} % are taken", self.name);
    }

    /// The valid inputs that are made by code, and those of the target's folder, by name.
    fn corpus(&self) -> Vec<(String, Vec<u8>)> {
        let mut corpus = (self.seeds)();
        corpus.extend(files_in(&format!("tests/fuzz/corpus/{}", self.name)));
        assert!(!corpus.is_empty(), "{} has no input to begin with", self.name);
        corpus.sort();
        corpus
    }

    /// Runs one input, which lies in a file while that lasts.
    fn try_one(&self, input: &[u8], watch: &Watch) -> Answer {
        watch.enter(input);
        let mut result = None;
        let used = allocation_counter::measure(|| result = Some(catch_unwind(AssertUnwindSafe(|| (self.run)(input)))));
        watch.leave();
        let (name, path) = (self.name, watch.path.display());
        let Some(Ok(answer)) = result else { panic!("{name}: the input in {path} panics") };
        let most = self.memory.0 + self.memory.1 * input.len() as u64;
        assert!(
            used.bytes_max <= most,
            "{name}: the {} bytes of {path} take {} bytes: must be at most {most}",
            input.len(),
            used.bytes_max
        );
        answer
    }
}

/// What distinguishes an answer from others: its words, without numbers and names.
fn kind(answer: &Answer) -> String {
    let (Ok(text) | Err(text)) = answer;
    let mut is_quoted = false;
    let words = text.chars().filter(|&c| {
        is_quoted ^= matches!(c, '"' | '\'' | '`');
        !is_quoted && !c.is_numeric()
    });
    answer.is_ok().then_some('+').into_iter().chain(words.take(60)).collect()
}

/// Ends the process when an input takes too long.
struct Watch {
    path: PathBuf,
    file: std::fs::File,
    /// When the input under way began, milliseconds after `epoch`; 0 between two.
    since_ms: Arc<AtomicU64>,
    epoch: Instant,
    length: Mutex<u64>,
}

impl Watch {
    fn begin(name: &'static str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}"));
        let file = std::fs::File::create(&path).unwrap();
        let (since_ms, epoch) = (Arc::new(AtomicU64::new(0)), Instant::now());
        let (theirs, shown) = (Arc::downgrade(&since_ms), path.display().to_string());
        let limit_s = setting("FRONTIER_FUZZ_LIMIT_S").unwrap_or(LIMIT_S);
        std::thread::spawn(move || {
            while let Some(since_ms) = theirs.upgrade() {
                let since_ms = since_ms.load(Ordering::Relaxed);
                if since_ms > 0 && epoch.elapsed().as_millis() as u64 > since_ms + (1000.0 * limit_s) as u64 {
                    eprintln!("{name}: the input in {shown} takes longer than {limit_s} s");
                    std::process::exit(101);
                }
                std::thread::sleep(Duration::from_millis(100));
            }
        });
        Self { path, file, since_ms, epoch, length: Mutex::new(0) }
    }

    fn enter(&self, input: &[u8]) {
        let mut length = self.length.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        self.file.write_all_at(input, 0).unwrap();
        if *length != input.len() as u64 {
            *length = input.len() as u64;
            self.file.set_len(*length).unwrap();
        }
        self.since_ms.store(self.epoch.elapsed().as_millis() as u64 + 1, Ordering::Relaxed);
    }

    fn leave(&self) {
        self.since_ms.store(0, Ordering::Relaxed);
    }
}

#[test]
fn answers_are_told_apart_by_their_words() {
    let refused = |text: &str| kind(&Err(text.to_owned()));
    assert_eq!(refused("key 'a' is 12"), refused("key 'b' is 3"));
    assert_ne!(refused("key 'a' is 12"), refused("key 'a' is no number"));
    assert_ne!(refused("x"), kind(&Ok("x".to_owned())));
}
