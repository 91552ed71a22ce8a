//! Numbers that must lie in a range (floor 0).

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
        Self::unless(value.is_finite() && value > 0.0, key, value, "finite and > 0")
    }

    /// The error unless the number is finite and at least 0.
    ///
    /// # Errors
    /// [`OutOfRange`] that says so.
    pub const fn unless_not_negative(key: &'static str, value: f64) -> Result<(), Self> {
        Self::unless(value.is_finite() && value >= 0.0, key, value, "finite and >= 0")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_what_is_allowed() {
        let error = OutOfRange::unless_positive("limits.max_linear_mps", f64::NAN).unwrap_err();
        assert_eq!(error.to_string(), "limits.max_linear_mps is NaN: must be finite and > 0");
        assert!(OutOfRange::unless_not_negative("x", 0.0).is_ok());
        assert!(OutOfRange::unless_not_negative("x", f64::INFINITY).is_err());
    }
}
