//! What one check found.

use serde::Serialize;

/// How grave a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FindingLevel {
    /// All is well.
    Ok,
    /// The exploration runs, but not as well as it could.
    Warning,
    /// The exploration cannot run so.
    Error,
}

impl FindingLevel {
    /// The word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// What one check found, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What was looked at: `clock`, `map`, `frames` and so on.
    pub check: &'static str,
    /// How grave it is.
    pub level: FindingLevel,
    /// What was found, in a sentence.
    pub what: String,
    /// How to mend it; none where all is well.
    pub remedy: Option<String>,
}

impl Finding {
    /// All is well.
    #[must_use]
    pub fn ok(check: &'static str, what: impl Into<String>) -> Self {
        Self { check, level: FindingLevel::Ok, what: what.into(), remedy: None }
    }

    /// Something could be better.
    #[must_use]
    pub fn warning(check: &'static str, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { check, level: FindingLevel::Warning, what: what.into(), remedy: Some(remedy.into()) }
    }

    /// Something is wrong.
    #[must_use]
    pub fn error(check: &'static str, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { check, level: FindingLevel::Error, what: what.into(), remedy: Some(remedy.into()) }
    }
}
