//! What a running program says, line by line.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};

/// Longest line that is looked at, in bytes.
const MAX_LINE: u64 = 1 << 16;
/// Lines of standard error that are kept.
const LOG_LINES: usize = 12;
/// Characters of a line that are shown.
pub(crate) const SHOWN: usize = 200;

/// The next line, trimmed, bytes that are no text replaced; `None` at the end.
pub(crate) fn next_line(reader: &mut impl BufRead) -> std::io::Result<Option<String>> {
    let mut bytes = Vec::new();
    let count = reader.take(MAX_LINE).read_until(b'\n', &mut bytes)?;
    Ok((count > 0).then(|| String::from_utf8_lossy(&bytes).trim().to_owned()))
}

/// The last lines of a stream, read to its end so that the writer never waits.
pub(crate) fn tail(stream: impl Read) -> String {
    let mut reader = BufReader::new(stream);
    let mut lines = VecDeque::new();
    while let Ok(Some(line)) = next_line(&mut reader) {
        if !line.is_empty() {
            lines.push_back(line.chars().take(SHOWN).collect::<String>());
        }
        if lines.len() > LOG_LINES {
            lines.pop_front();
        }
    }
    Vec::from(lines).join("\n")
}
