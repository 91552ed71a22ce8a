//! Numbers that must lie in a range, and the words that say which (floor 0).

/// The numbers that are allowed, with the words in which errors and the documentation say so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The smallest number.
    pub least: f64,
    /// The largest number.
    pub most: f64,
    /// What follows "must be".
    pub words: &'static str,
}

impl Range {
    /// Any finite number.
    pub(crate) const FINITE: Self = Self::within(f64::MIN, f64::MAX, "finite");
    /// Any finite number from 0 on.
    pub(crate) const NOT_NEGATIVE: Self = Self::within(0.0, f64::MAX, "finite and >= 0");
    /// Any finite number above 0.
    pub(crate) const POSITIVE: Self = Self::above(0.0, f64::MAX, "finite and > 0");

    /// The numbers from `least` to `most`, both included.
    pub(crate) const fn within(least: f64, most: f64, words: &'static str) -> Self {
        Self { least, most, words }
    }

    /// The numbers above `bound`, up to `most`.
    pub(crate) const fn above(bound: f64, most: f64, words: &'static str) -> Self {
        Self::within(bound.next_up(), most, words)
    }

    /// A number that must lie in this range; `None` is a setting that is left out.
    pub(crate) fn of(self, key: &'static str, value: impl Into<Option<f64>>) -> Ranged {
        Ranged { key, value: value.into(), range: self }
    }

    /// Whether a number lies in this range.
    pub(crate) const fn holds(&self, value: f64) -> bool {
        self.least <= value && value <= self.most
    }

    /// The error unless the number lies in this range.
    const fn check(&self, key: &'static str, value: f64) -> Result<(), OutOfRange> {
        OutOfRange::unless(self.holds(value), key, value, self.words)
    }
}

/// A number of a configuration beside the range that it must lie in, so that what is checked is
/// also what the documentation states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ranged {
    /// Where the number stands in its file.
    pub key: &'static str,
    /// As given, if it is.
    pub value: Option<f64>,
    /// What is allowed.
    pub range: Range,
}

impl Ranged {
    /// Checks numbers in their order.
    ///
    /// # Errors
    /// [`OutOfRange`] of the first that lies outside its range.
    pub fn check_all(numbers: impl IntoIterator<Item = Self>) -> Result<(), OutOfRange> {
        let given = |number: Self| Some((number.value?, number));
        numbers.into_iter().filter_map(given).try_for_each(|(value, Self { key, range, .. })| range.check(key, value))
    }
}

/// A number outside its range: the key, the value and what is allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key} is {value}: must be {allowed}")]
pub struct OutOfRange {
    /// Where the number stands in its file.
    pub key: &'static str,
    /// As given.
    pub value: f64,
    /// The range in words.
    pub allowed: &'static str,
}

impl OutOfRange {
    /// The error unless `holds`.
    ///
    /// # Errors
    /// [`OutOfRange`] with these words.
    pub const fn unless(holds: bool, key: &'static str, value: f64, allowed: &'static str) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self { key, value, allowed }) }
    }

    /// The error unless the number is finite and greater than 0.
    ///
    /// # Errors
    /// [`OutOfRange`] that says so.
    pub const fn unless_positive(key: &'static str, value: f64) -> Result<(), Self> {
        Range::POSITIVE.check(key, value)
    }

    /// The error unless the number is finite and at least 0.
    ///
    /// # Errors
    /// [`OutOfRange`] that says so.
    pub const fn unless_not_negative(key: &'static str, value: f64) -> Result<(), Self> {
        Range::NOT_NEGATIVE.check(key, value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_what_is_allowed() {
        let error = OutOfRange::unless_positive("limits.max_linear_mps", f64::NAN).unwrap_err();
        assert_eq!(error.to_string(), "limits.max_linear_mps is NaN: must be finite and > 0");
        assert!(OutOfRange::unless_positive("x", 0.0).is_err() && OutOfRange::unless_positive("x", 1e-300).is_ok());
        assert!(OutOfRange::unless_not_negative("x", 0.0).is_ok());
        assert!(OutOfRange::unless_not_negative("x", f64::INFINITY).is_err());
    }

    #[test]
    fn the_first_number_outside_is_named_and_none_is_never_outside() {
        let share = Range::above(0.0, 1.0, "above 0 and at most 1");
        let numbers = |b: f64| [share.of("a", None), share.of("b", b), Range::FINITE.of("c", f64::NAN)];
        assert_eq!(Ranged::check_all(numbers(0.0)).unwrap_err().to_string(), "b is 0: must be above 0 and at most 1");
        assert_eq!(Ranged::check_all(numbers(1.0)).unwrap_err().to_string(), "c is NaN: must be finite");
    }
}
