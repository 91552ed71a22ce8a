//! Less of numbers and of lists of them, so that files of many runs stay small.

/// To a millionth.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

/// To a hundredth: enough for what is only drawn.
pub(super) fn centi(value: f64) -> f64 {
    (value * 1e2).round() / 1e2 + 0.0
}

/// No more than `most` (at least 2) of some values, evenly, with the first and the last.
pub(super) fn thinned<T>(values: &[T], most: usize) -> impl Iterator<Item = &T> {
    let last = values.len().saturating_sub(1);
    let kept = values.len().min(most);
    (0..kept).filter_map(move |i| values.get(i * last / kept.saturating_sub(1).max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends() {
        let values: Vec<usize> = (0..1001).collect();
        let kept: Vec<usize> = thinned(&values, 200).copied().collect();
        assert_eq!((kept.len(), kept[0], kept[199]), (200, 0, 1000));
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(thinned(&values[..3], 200).count(), 3);
        assert_eq!(thinned(&values[..1], 200).count(), 1);
        assert_eq!(thinned(&values[..0], 200).count(), 0);
    }
}
