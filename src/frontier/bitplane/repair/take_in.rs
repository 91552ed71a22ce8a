//! Packs a next map where it is another than the last, also when it grew.

use super::Repair;
use crate::bits::connectivity::tiling::{TILE_ROWS, TILE_WORDS};
use crate::bits::neighbours::neighbours_of_row;
use crate::bits::placement::{Growth, Placement};
use crate::bits::word_spans::WordSpan;
use crate::bits::words_of;
use crate::frontier::{DetectionInput, Reachability};
use crate::grid::CellRect;
use std::ops::Range;
use std::sync::Arc;

impl Repair {
    /// Packs what changed and tells those whom it concerns; where the map lies in the planes.
    pub(super) fn take_in(&mut self, input: &DetectionInput<'_>, changed: Option<CellRect>) -> Placement {
        let info = input.grid.info();
        let size = (self.frontier.width(), self.frontier.height());
        let Some(step) = self.placed.and_then(|placed| placed.follow(info, size)) else {
            return self.start_over(input);
        };
        if let Some(growth) = &step.growth {
            self.grow(growth);
        }
        if step.moved != (0, 0) {
            Arc::make_mut(&mut self.found).shift(step.moved);
        }
        let placement = *self.placed.insert(step.placement);
        self.changed.clear();
        let told = placement.rect(&changed.unwrap_or_else(|| CellRect::of(info)));
        let walls_block = self.params.reachability == Reachability::WallsBlock;
        for rect in [told].iter().chain(&step.strips).filter(|rect| !rect.is_empty()) {
            let Self { changed, params, planes, reach, .. } = self;
            let (corner, rows) = (placement.corner(), rect.y..rect.y + rect.height);
            planes.repack(input.grid, &params.thresholds, corner, rows, words_of(rect), |y, words, is_free_other| {
                changed.add(y, WordSpan::of(&words));
                if walls_block && is_free_other {
                    words.for_each(|word| reach.mark_dirty(y, word));
                }
            });
        }
        for y in self.changed.rows() {
            let span = self.changed.of_row(y);
            self.stale.add(y, span);
            if !walls_block && !span.is_empty() {
                let Range { start, end } = span.words();
                let words = start.saturating_sub(1)..(end + 1).min(self.open.row_words());
                for y in y.saturating_sub(1)..(y + 2).min(self.open.height()) {
                    self.open_row(&placement, y, words.clone());
                }
            }
        }
        if !walls_block {
            // A cell that is neither free nor unknown leaves no trace in the planes when it comes.
            for rect in &step.strips {
                (rect.y..rect.y + rect.height).for_each(|y| self.open_row(&placement, y, words_of(rect)));
            }
        }
        placement
    }

    /// Takes a map in of which nothing is known.
    fn start_over(&mut self, input: &DetectionInput<'_>) -> Placement {
        let info = input.grid.info();
        let (width, height) = (info.width(), info.height());
        let placement = *self.placed.insert(Placement::first(info));
        self.planes.resize(info);
        self.frontier.resize(width, height);
        if self.params.reachability == Reachability::Textbook {
            self.open.resize(width, height);
        }
        self.reach.reset(width, height);
        self.reset_spans();
        self.stale.add_all();
        self.min_cells = None;
        self.planes.pack(input.grid, &self.params.thresholds);
        if self.params.reachability == Reachability::Textbook {
            (0..height).for_each(|y| self.open_row(&placement, y, 0..self.planes.free().row_words()));
        }
        placement
    }

    /// Goes on with larger planes.
    fn grow(&mut self, growth: &Growth) {
        let ((width, height), (columns, rows)) = (growth.size, growth.tiles);
        let by = (columns * TILE_WORDS, rows * TILE_ROWS);
        self.planes.grow(width, height, by);
        self.frontier.grow(width, height, by);
        if self.params.reachability == Reachability::Textbook {
            self.open.grow(width, height, by);
        }
        self.reach.grow(width, height, growth.tiles);
        // What was not looked at when there was no answer lies elsewhere now.
        let is_behind = !self.stale.rows().is_empty();
        self.reset_spans();
        if is_behind {
            self.stale.add_all();
        }
    }

    fn reset_spans(&mut self) {
        for spans in [&mut self.changed, &mut self.stale, &mut self.regroup] {
            spans.reset(self.frontier.row_words(), self.frontier.height());
        }
        self.row.resize(self.frontier.row_words(), 0);
    }

    /// Finds again which cells of a row have a free neighbour.
    fn open_row(&mut self, placement: &Placement, y: usize, words: Range<usize>) {
        let row = &mut self.row[words.clone()];
        neighbours_of_row(self.planes.free(), self.params.neighbours, y, words.clone(), row);
        let open = self.open.row_mut(y);
        for (word, &new) in words.zip(&*row) {
            let new = new & placement.mask(y, word);
            if open[word] != new {
                open[word] = new;
                self.reach.mark_dirty(y, word);
            }
        }
    }
}
