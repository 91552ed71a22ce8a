//! Parts of the list of runs, for several computers.

/// One of several parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    number: usize,
    /// Of how many.
    of: usize,
}

impl Shard {
    /// Whether a run belongs to this part: they are dealt round robin, so that long and
    /// short worlds are spread evenly.
    pub const fn holds(self, index: usize) -> bool {
        index % self.of == self.number - 1
    }
}

/// Reads `I/N`, from `1/N` to `N/N`.
pub fn parse(text: &str) -> Result<Shard, String> {
    let wrong = || format!("{text:?} is no part: must be I/N with 1 <= I <= N");
    let (number, of) = text.split_once('/').ok_or_else(wrong)?;
    match (number.trim().parse(), of.trim().parse()) {
        (Ok(number), Ok(of)) if 1 <= number && number <= of => Ok(Shard { number, of }),
        _ => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_is_in_one_part() {
        let parts = ["1/3", "2/3", "3/3"].map(|text| parse(text).unwrap());
        for index in 0..20 {
            assert_eq!(parts.iter().filter(|part| part.holds(index)).count(), 1, "{index}");
        }
        assert!(parts[0].holds(0) && parts[2].holds(5));
    }

    #[test]
    fn parts_that_cannot_be_are_refused() {
        for wrong in ["3/2", "0/2", "1/0", "0/0", "1", "a/b", "-1/2", ""] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
