//! The text of an XML file: UTF-8, UTF-16 or Latin-1, compressed or not.

use super::SvgError;
use super::budget::Budget;
use flate2::read::GzDecoder;
use std::borrow::Cow;
use std::io::Read;

/// The text of a file's bytes, decompressed as far as the budget allows.
pub(super) fn text_of<'a>(bytes: &'a [u8], budget: &mut Budget) -> Result<Cow<'a, str>, SvgError> {
    match bytes {
        [0x1f, 0x8b, ..] => {
            let unpacked = unpacked(bytes, budget)?;
            decoded(&unpacked).map(|text| Cow::Owned(text.into_owned()))
        }
        _ => decoded(bytes),
    }
}

fn unpacked(bytes: &[u8], budget: &mut Budget) -> Result<Vec<u8>, SvgError> {
    let mut text = Vec::new();
    GzDecoder::new(bytes).take(budget.most_bytes() + 1).read_to_end(&mut text).map_err(|_| SvgError::Packed)?;
    if text.len() as u64 > budget.most_bytes() {
        budget.text(text.len() as f64)?;
    }
    Ok(text)
}

fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, SvgError> {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        String::from_utf16(&units).map(Cow::Owned).map_err(|_| SvgError::NotText)
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => std::str::from_utf8(rest).map(Cow::Borrowed).map_err(|_| SvgError::NotText),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Cow::Borrowed(text)),
            Err(_) if says_latin_1(bytes) => Ok(Cow::Owned(bytes.iter().copied().map(char::from).collect())),
            Err(_) => Err(SvgError::NotText),
        },
    }
}

/// True if the XML declaration names a one-byte encoding that matches Unicode's first 256 characters.
fn says_latin_1(bytes: &[u8]) -> bool {
    let start: String = bytes.iter().take(120).map(|&byte| char::from(byte).to_ascii_lowercase()).collect();
    let declaration = start.split("?>").next().unwrap_or_default();
    ["iso-8859-1", "latin1", "windows-1252"].iter().any(|name| declaration.contains(name))
}
