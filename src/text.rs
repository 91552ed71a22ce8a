//! Texts of others, such as the names of frames and topics, made fit for a terminal.

use std::borrow::Cow;

/// A text in which control characters are written out, so that a terminal shows them and does not
/// obey them; line ends and tabs stay.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_obeyed = |c: char| c.is_control() && c != '\n' && c != '\t';
    if !text.contains(is_obeyed) {
        return text.into();
    }
    let shown = |c: char| if is_obeyed(c) { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(shown).collect::<String>().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_written_out() {
        assert_eq!(printable("base\x1b[2J\u{9b}31m\n\tö"), "base\\u{1b}[2J\\u{9b}31m\n\tö");
        assert!(matches!(printable("base_link"), Cow::Borrowed(_)));
    }
}
