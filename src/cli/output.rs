//! Reading inputs, and writing files atomically: an output appears whole or not at all.

use super::claims::{self, follow_links};
use super::failure::Failure;
use super::interruption::{Temporary, is_interrupted};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::{self, Read, Write};
use std::num::NonZeroU64;
use std::path::Path;

/// Maximum size of a TOML file in bytes: about 2000 keys; a machine's profile has 50. Limited because the search for each key's line
/// starts at the beginning of the file.
const MOST_SETTINGS: u64 = 1 << 16;

/// The bytes of a file, or of stdin for `-`, at most `most`; endless input is refused, not read on. `advice` is appended to the
/// refusal.
pub(super) fn read(name: &str, most: u64, advice: &str) -> Result<Vec<u8>, Failure> {
    let shown = if name == "-" { "stdin" } else { name };
    let mut bytes = Vec::new();
    let taken = open(name)?.take(most.saturating_add(1)).read_to_end(&mut bytes);
    taken.map_err(|error| Failure::Work(format!("{shown} cannot be read: {error}")))?;
    if bytes.len() as u64 > most {
        return Err(Failure::Work(format!("{shown} is longer than {most} bytes, the maximum for this file{advice}")));
    }
    Ok(bytes)
}

/// The text of a TOML file.
pub(super) fn read_settings(name: &str) -> Result<String, Failure> {
    String::from_utf8(read(name, MOST_SETTINGS, "")?).map_err(|_| Failure::Work(format!("{name} is not UTF-8 text")))
}

/// A reader of a file, or of stdin for `-`.
pub(super) fn open(name: &str) -> Result<Box<dyn Read>, Failure> {
    if name == "-" {
        claims::record_stdin();
        return Ok(Box::new(io::stdin().lock()));
    }
    let refuse = |problem: &str| Failure::Work(format!("{name} {problem}"));
    let file = fs::File::open(name).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => refuse("does not exist; check its name"),
        io::ErrorKind::PermissionDenied => refuse("cannot be read: permission denied"),
        _ => refuse(&format!("cannot be opened: {error}")),
    })?;
    if let Ok(found) = file.metadata() {
        if found.is_dir() {
            return Err(refuse("is a folder; give a file"));
        }
        claims::reads(name, Path::new(name), &found);
    }
    Ok(Box::new(file))
}

/// Writes a file through a temporary one beside it; `.svgz` is compressed. `-` is stdout; devices and pipes are written in place.
pub(super) fn write(name: &str, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let is_compressed = Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svgz"));
    let mut fill = Some(fill);
    // Called once; built once for all that is written.
    let mut fill = |out: &mut dyn Write| fill.take().map_or(Ok(()), |fill| fill(out));
    if is_compressed { write_compressed(name, &mut fill) } else { write_plain(name, &mut fill) }
}

/// Longest text in bytes that is compressed as well as gzip's format allows, in about a second: what stands in a page of the web is
/// shorter. Longer sheets are compressed fast, a fifteenth larger.
const MOST_PACKED: usize = 1 << 20;
/// Rounds of it: with 5 embedded portraits are up to 0.1 % larger, with 15 no smaller.
const PACKING_ROUNDS: NonZeroU64 = NonZeroU64::MIN.saturating_add(7);

fn write_compressed(name: &str, fill: Filling<'_>) -> Result<(), Failure> {
    write_plain(name, &mut |out| {
        let mut text = Vec::new();
        fill(&mut text)?;
        if text.len() <= MOST_PACKED {
            let options = zopfli::Options { iteration_count: PACKING_ROUNDS, ..zopfli::Options::default() };
            return zopfli::compress(options, zopfli::Format::Gzip, text.as_slice(), out);
        }
        let mut compressed = GzEncoder::new(out, Compression::best());
        compressed.write_all(&text)?;
        compressed.finish().map(drop)
    })
}

/// Writes a file's contents.
type Filling<'a> = &'a mut dyn FnMut(&mut dyn Write) -> io::Result<()>;

fn write_plain(name: &str, fill: Filling<'_>) -> Result<(), Failure> {
    claims::check_not_input(name)?;
    if name == "-" {
        let mut stdout = io::BufWriter::new(io::stdout().lock());
        return fill(&mut stdout).and_then(|()| stdout.flush()).map_err(Failure::writing("stdout"));
    }
    let fail = Failure::writing(name);
    let followed = follow_links(Path::new(name));
    let path = followed.as_path();
    let mut replaced = None;
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err(Failure::Work(format!("{name} is a folder; give a file name with -o"))),
        Ok(found) if !found.is_file() => {
            let file = fs::OpenOptions::new().write(true).open(path).map_err(&fail)?;
            let mut out = io::BufWriter::new(file);
            return fill(&mut out).and_then(|()| out.flush()).map_err(fail);
        }
        // A rename would replace a read-only file; respect its permissions.
        Ok(found) if found.permissions().readonly() => return Err(fail(io::ErrorKind::PermissionDenied.into())),
        Ok(found) => replaced = Some(found.permissions()),
        Err(_) => {}
    }
    let mut temporary =
        Temporary::beside(path, replaced).map_err(|error| Failure::writing(name)(io::Error::from(error.kind())))?;
    {
        let mut out = io::BufWriter::new(temporary.file());
        fill(&mut out).and_then(|()| out.flush()).map_err(&fail)?;
    }
    if is_interrupted() {
        return Err(Failure::Interrupted);
    }
    temporary.replace(path).map_err(fail)
}

/// Seconds since 1970 from `SOURCE_DATE_EPOCH`, the only date ever written to a file.
pub(super) fn source_date() -> Result<Option<u64>, Failure> {
    match std::env::var_os("SOURCE_DATE_EPOCH").filter(|text| !text.is_empty()) {
        None => Ok(None),
        Some(text) => text.to_str().and_then(|text| text.parse().ok()).map(Some).ok_or_else(|| {
            Failure::Usage(format!("SOURCE_DATE_EPOCH is '{}'; it must be whole seconds since 1970", text.to_string_lossy()))
        }),
    }
}

/// Writes data to stdout.
pub(super) fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    write("-", |out| out.write_all(bytes))
}

/// Prints one JSON object.
pub(super) fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    to_stdout(format!("{value:#}\n").as_bytes())
}
