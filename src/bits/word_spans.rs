//! A range of words for each row of a plane: what changed, or what must be looked at again.

use std::ops::Range;

/// The words of a row from one to before another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WordSpan {
    /// The first word.
    pub start: u32,
    /// One past the last.
    pub end: u32,
}

impl WordSpan {
    /// No word.
    pub const NONE: Self = Self { start: u32::MAX, end: 0 };

    /// These words.
    pub const fn of(words: &Range<usize>) -> Self {
        if words.start < words.end { Self { start: words.start as u32, end: words.end as u32 } } else { Self::NONE }
    }

    /// Whether there is no word.
    pub const fn is_empty(self) -> bool {
        self.start >= self.end
    }

    /// The words, none from 0 on if there is none.
    pub const fn words(self) -> Range<usize> {
        if self.is_empty() { 0..0 } else { self.start as usize..self.end as usize }
    }

    /// Takes in another span and all between the two.
    #[inline(always)]
    pub fn join(&mut self, other: Self) {
        *self = Self { start: self.start.min(other.start), end: self.end.max(other.end) };
    }
}

/// A span for each row of a plane.
#[derive(Clone, Debug, Default)]
pub(crate) struct WordSpans {
    spans: Vec<WordSpan>,
    row_words: usize,
    /// All rows that have words lie in here.
    rows: Range<usize>,
}

impl WordSpans {
    /// Starts over with no words of planes of this size.
    pub fn reset(&mut self, row_words: usize, height: usize) {
        self.spans.clear();
        self.spans.resize(height, WordSpan::NONE);
        self.row_words = row_words;
        self.rows = 0..0;
    }

    /// Forgets all words.
    pub fn clear(&mut self) {
        self.spans[self.rows.clone()].fill(WordSpan::NONE);
        self.rows = 0..0;
    }

    /// Adds words of a row.
    #[inline(always)]
    pub fn add(&mut self, y: usize, span: WordSpan) {
        if span.is_empty() {
            return;
        }
        self.spans[y].join(span);
        self.expect(&(y..y + 1));
    }

    /// Tells that words of these rows may be added by [`Self::add_if`].
    pub fn expect(&mut self, rows: &Range<usize>) {
        self.rows = if self.rows.is_empty() {
            rows.clone()
        } else {
            self.rows.start.min(rows.start)..self.rows.end.max(rows.end)
        };
    }

    /// Adds a word of a row that is expected, or not: nobody can guess which, so there is no
    /// branch.
    #[inline(always)]
    pub fn add_if(&mut self, y: usize, word: usize, is_added: bool) {
        let WordSpan { start, end } = self.spans[y];
        let (word_start, word_end) = if is_added { (word as u32, word as u32 + 1) } else { (u32::MAX, 0) };
        self.spans[y] = WordSpan { start: start.min(word_start), end: end.max(word_end) };
    }

    /// Adds words of a row, and those around them in it, below and above.
    pub fn add_with_margin(&mut self, y: usize, span: WordSpan) {
        if span.is_empty() {
            return;
        }
        let wider = WordSpan { start: span.start.saturating_sub(1), end: (span.end + 1).min(self.row_words as u32) };
        for y in y.saturating_sub(1)..(y + 2).min(self.spans.len()) {
            self.add(y, wider);
        }
    }

    /// Adds all words.
    pub fn add_all(&mut self) {
        self.spans.fill(WordSpan { start: 0, end: self.row_words as u32 });
        self.rows = 0..self.spans.len();
    }

    /// From the first to one past the last row that has words.
    pub fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    /// The words of a row.
    pub fn of_row(&self, y: usize) -> WordSpan {
        self.spans[y]
    }

    /// The rows that have words, each with these.
    pub fn iter(&self) -> impl Iterator<Item = (usize, WordSpan)> {
        let rows = self.rows.clone().zip(&self.spans[self.rows.clone()]);
        rows.filter(|(_, span)| !span.is_empty()).map(|(y, &span)| (y, span))
    }

    /// Whether a word of a row is among them.
    pub fn contain(&self, y: usize, word: usize) -> bool {
        self.spans.get(y).is_some_and(|span| span.words().contains(&word))
    }

    /// What the spans take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.spans.capacity() * size_of::<WordSpan>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_joined_row_by_row_and_forgotten() {
        let mut spans = WordSpans::default();
        spans.reset(5, 4);
        spans.add(2, WordSpan::of(&(1..2)));
        spans.add(2, WordSpan::of(&(3..4)));
        spans.add(1, WordSpan::NONE);
        assert_eq!(spans.iter().map(|(y, span)| (y, span.words())).collect::<Vec<_>>(), [(2, 1..4)]);
        assert!(spans.contain(2, 2) && !spans.contain(2, 4) && !spans.contain(1, 2) && !spans.contain(9, 0));
        spans.clear();
        assert_eq!((spans.rows(), spans.iter().count()), (0..0, 0));
        spans.add_with_margin(0, WordSpan::of(&(0..1)));
        spans.add_with_margin(3, WordSpan::of(&(4..5)));
        let words = |y: usize| spans.spans[y].words();
        assert_eq!([words(0), words(1), words(2), words(3)], [0..2, 0..2, 3..5, 3..5]);
        spans.add_all();
        assert_eq!((spans.rows(), spans.iter().all(|(_, span)| span.words() == (0..5))), (0..4, true));
    }
}
