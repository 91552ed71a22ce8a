//! Results on standard output. A reader that has gone, such as `head`, is no error.

use anyhow::Context;
use frontier_explorer::text::printable;
use serde::Serialize;
use std::fmt::Arguments;
use std::io::{ErrorKind, Write};

/// Writes one line: `output::line(format_args!("..."))?`. Control characters in it, which come from
/// names in bags and maps, are written out.
pub fn line(text: Arguments<'_>) -> anyhow::Result<()> {
    bytes(printable(&format!("{text}\n")).as_bytes())
}

/// Writes bytes as they are.
pub fn bytes(bytes: &[u8]) -> anyhow::Result<()> {
    deliver(&mut std::io::stdout().lock(), bytes)
}

/// Writes a value as indented JSON and a line end.
pub fn json(value: &impl Serialize) -> anyhow::Result<()> {
    let text = serde_json::to_string_pretty(value).context("cannot write the result as JSON")?;
    bytes(format!("{text}\n").as_bytes())
}

fn deliver(out: &mut impl Write, bytes: &[u8]) -> anyhow::Result<()> {
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context("cannot write to standard output"),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Failing(ErrorKind);

    impl Write for Failing {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_closed_reader_is_no_error_and_a_full_disk_is() {
        assert!(deliver(&mut Failing(ErrorKind::BrokenPipe), b"x").is_ok());
        assert!(deliver(&mut Failing(ErrorKind::StorageFull), b"x").is_err());
    }
}
