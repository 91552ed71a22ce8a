//! Counts what was wrong with a bag, by kind.

/// The most problems that are told apart.
const MAX_PROBLEMS: usize = 20;

/// A sentence for each problem, each once.
#[derive(Clone, Debug, Default)]
pub struct Problems(Vec<String>);

impl Problems {
    /// Adds a sentence.
    pub fn tell(&mut self, problem: String) {
        if self.0.len() < MAX_PROBLEMS && !self.0.contains(&problem) {
            self.0.push(problem);
        }
    }

    /// All sentences.
    pub fn all(&self) -> &[String] {
        &self.0
    }
}
