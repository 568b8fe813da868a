//! The text of a file, whatever its encoding.

use std::borrow::Cow;

/// Encodings that a map can name.
pub(super) const ENCODINGS: [&str; 3] = ["utf-8", "utf-16", "latin-1"];

/// What some programs put before a text.
const MARK: char = '\u{feff}';

/// The text of `bytes` in the `encoding` named, or the one that they show: UTF-16 by its mark or its zeros, else UTF-8, else Latin-1.
///
/// # Errors
/// One sentence: what can't be read.
pub fn decoded<'b>(bytes: &'b [u8], encoding: Option<&str>) -> Result<Cow<'b, str>, String> {
    let text = match encoding.unwrap_or_else(|| shown(bytes)) {
        "utf-8" => {
            Cow::Borrowed(std::str::from_utf8(bytes).map_err(|e| format!("is no text in UTF-8: {e}"))?)
        }
        "utf-16" => Cow::Owned(utf16(bytes)?),
        "latin-1" => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
        other => {
            return Err(format!(
                "table.encoding is `{other}`, but it must be one of {}",
                ENCODINGS.join(", ")
            ));
        }
    };
    let text = match text {
        Cow::Borrowed(text) => Cow::Borrowed(text.trim_start_matches(MARK)),
        Cow::Owned(text) => Cow::Owned(text.trim_start_matches(MARK).to_owned()),
    };
    // Windows has dashes and quotation marks where Latin-1 has further control characters
    match text.chars().take(SAMPLE).find(|c| c.is_ascii_control() && !c.is_whitespace()) {
        Some(found) => Err(format!(
            "is no text: it has the character U+{:04X}; export it as text (CSV)",
            u32::from(found)
        )),
        None => Ok(text),
    }
}

/// Refuses a file whose beginning `head` no text has, before the rest is read.
///
/// # Errors
/// As [`decoded`].
pub fn require_text(head: &[u8]) -> Result<(), String> {
    // a character may be cut at the end of the beginning: each byte is looked at alone
    let encoding = if shown(head) == "utf-16" { "utf-16" } else { "latin-1" };
    decoded(&head[..head.len() / 2 * 2], Some(encoding)).map(drop)
}

/// Characters that are looked at for what no text has.
const SAMPLE: usize = 4096;

/// The encoding that `bytes` show.
fn shown(bytes: &[u8]) -> &'static str {
    let head = &bytes[..bytes.len().min(SAMPLE)];
    let zeros = head.iter().filter(|byte| **byte == 0).count();
    match head {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "utf-16",
        _ if 3 * zeros > head.len() => "utf-16",
        _ if std::str::from_utf8(bytes).is_ok() => "utf-8",
        _ => "latin-1",
    }
}

/// Text of UTF-16, whose bytes are in the order that its mark or its first character shows.
fn utf16(bytes: &[u8]) -> Result<String, String> {
    let big = bytes.starts_with(&[0xfe, 0xff]) || bytes.first() == Some(&0);
    let units = bytes.as_chunks::<2>().0.iter().map(|pair| match big {
        true => u16::from_be_bytes(*pair),
        false => u16::from_le_bytes(*pair),
    });
    char::decode_utf16(units).collect::<Result<String, _>>().map_err(|e| format!("is no text in UTF-16: {e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_encoding_is_found() {
        let text = "time [µs];v\n1;2\n";
        let utf16 = |order: fn(u16) -> [u8; 2], mark: &str| -> Vec<u8> {
            format!("{mark}{text}").encode_utf16().flat_map(order).collect()
        };
        let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
        for bytes in [
            text.as_bytes().to_vec(),
            format!("{MARK}{text}").into_bytes(),
            latin.clone(),
            utf16(u16::to_le_bytes, "\u{feff}"),
            utf16(u16::to_be_bytes, "\u{feff}"),
            utf16(u16::to_le_bytes, ""),
            utf16(u16::to_be_bytes, ""),
        ] {
            assert_eq!(decoded(&bytes, None).expect("text"), text);
        }
        assert_eq!(decoded(&latin, Some("latin-1")).expect("text"), text);
        assert!(decoded(&latin, Some("utf-8")).expect_err("none").contains("UTF-8"));
        assert!(decoded(b"\x00\x01\x02\x7f\x03", None).is_err());
        assert!(decoded(b"PK\x03\x04abc", None).expect_err("none").contains("U+0003"));
        assert!(decoded(&latin, Some("ebcdic")).expect_err("none").contains("utf-16"));
    }
}
