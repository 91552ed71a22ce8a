//! Where the runs begin, as the command line says it.

use anyhow::Context;
use frontier_explorer::io::read_text;
use frontier_explorer::run::comparison::Starts;
use std::path::PathBuf;

/// What the user asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StartsArg {
    /// This many open spots.
    Auto(usize),
    /// A CSV file.
    File(PathBuf),
}

/// Reads `auto`, `auto:N` or a file name.
pub fn parse(text: &str) -> Result<StartsArg, String> {
    let Some(count) = text.strip_prefix("auto") else { return Ok(StartsArg::File(text.into())) };
    match count.trim_start_matches([':', ' ', '=']) {
        "" if count.is_empty() => Ok(StartsArg::Auto(1)),
        _ if text.ends_with(".csv") => Ok(StartsArg::File(text.into())),
        number => match number.parse() {
            Ok(number) if number > 0 => Ok(StartsArg::Auto(number)),
            _ => Err(format!("{text:?}: must be auto:N with N > 0, or a CSV file")),
        },
    }
}

impl StartsArg {
    /// The starts that are asked for.
    pub fn load(&self) -> anyhow::Result<Starts> {
        match self {
            Self::Auto(count) => Ok(Starts::auto(*count)),
            Self::File(file) => {
                let text = read_text(file).with_context(|| format!("cannot read {}", file.display()))?;
                Starts::from_csv(&text).with_context(|| file.display().to_string())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_are_a_file_or_a_number() {
        assert_eq!(parse("auto"), Ok(StartsArg::Auto(1)));
        assert_eq!(parse("auto:3"), Ok(StartsArg::Auto(3)));
        assert_eq!(parse("auto 3"), Ok(StartsArg::Auto(3)));
        assert_eq!(parse("starts.csv"), Ok(StartsArg::File("starts.csv".into())));
        assert_eq!(parse("automatic.csv"), Ok(StartsArg::File("automatic.csv".into())));
        assert!(parse("auto:0").is_err() && parse("auto:x").is_err());
    }
}
