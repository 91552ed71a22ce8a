//! A queue for searches whose keys are small integers that never fall back.
//!
//! R. Dial, "Algorithm 360: Shortest-path forest with topological ordering" (CACM
//! 1969). Push and pop are O(1); keys within the queue must lie within one ring of the
//! last one popped. No allocation once the buckets have grown.

/// A ring of buckets, one for each key.
#[derive(Clone, Debug)]
pub struct BucketQueue {
    buckets: Vec<Vec<u32>>,
    /// The key popped last; of the first push before that.
    current: Option<u32>,
    len: usize,
}

impl BucketQueue {
    /// A queue in which no key exceeds the one popped last, or before that the one
    /// pushed first, by more than `spread`.
    #[must_use]
    pub fn new(spread: u32) -> Self {
        let ring = (spread as usize + 1).next_power_of_two();
        Self { buckets: vec![Vec::new(); ring], current: None, len: 0 }
    }

    /// Empties the queue and keeps its memory.
    pub fn clear(&mut self) {
        self.buckets.iter_mut().for_each(Vec::clear);
        self.current = None;
        self.len = 0;
    }

    /// Adds an item. A key below the one popped last counts as that one.
    #[inline]
    pub fn push(&mut self, key: u32, item: u32) {
        let current = *self.current.get_or_insert(key);
        let ring = self.buckets.len();
        debug_assert!(key.saturating_sub(current) < ring as u32);
        let slot = key.max(current) as usize & (ring - 1);
        self.buckets[slot].push(item);
        self.len += 1;
    }

    /// Takes an item with the smallest key; among equals the last one pushed.
    #[inline]
    pub fn pop(&mut self) -> Option<(u32, u32)> {
        if self.len == 0 {
            return None;
        }
        let mask = self.buckets.len() - 1;
        let mut key = self.current?;
        loop {
            if let Some(item) = self.buckets[key as usize & mask].pop() {
                self.current = Some(key);
                self.len -= 1;
                return Some((key, item));
            }
            key += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_come_out_in_order_round_the_ring() {
        let mut queue = BucketQueue::new(3);
        queue.push(5, 50);
        queue.push(8, 80);
        queue.push(6, 60);
        assert_eq!(queue.pop(), Some((5, 50)));
        queue.push(8, 81);
        assert_eq!(queue.pop(), Some((6, 60)));
        queue.push(9, 90);
        let rest: Vec<_> = std::iter::from_fn(|| queue.pop()).collect();
        assert_eq!(rest, [(8, 81), (8, 80), (9, 90)]);
    }

    #[test]
    fn a_queue_that_ran_empty_keeps_the_order() {
        let mut queue = BucketQueue::new(7);
        queue.push(10, 0);
        queue.pop();
        queue.push(15, 1);
        queue.push(12, 2);
        assert_eq!((queue.pop(), queue.pop(), queue.pop()), (Some((12, 2)), Some((15, 1)), None));
        queue.clear();
        queue.push(3, 3);
        assert_eq!(queue.pop(), Some((3, 3)));
    }
}
