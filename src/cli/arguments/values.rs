//! Parsers of option values: lengths, times, fractions, crops.

use crate::drawing::Ink;
use crate::geometry::{parse_drawn_length, parse_length, parse_size};
use std::ops::RangeInclusive;

/// Nib widths in millimetres, from finer than any pen to a broad brush.
pub(in crate::cli) const NIBS: RangeInclusive<f64> = 0.01..=20.0;
/// Curve tolerances in millimetres. Less is below any plotter's step and only makes files larger; with more, letters lose their shape.
const TOLERANCES: RangeInclusive<f64> = 0.001..=1.0;
/// Scale factors of a drawing.
const SCALES: RangeInclusive<f64> = 0.001..=1000.0;

/// One number of a crop box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cli) enum CropNumber {
    Pixels(f64),
    Percent(f64),
}

/// The part of a photograph that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cli) enum CropPart {
    /// Heads and shoulders of the faces.
    Head,
    /// The faces.
    Face,
    /// A box: x, y, width, height.
    Box([CropNumber; 4]),
}

pub(super) fn key_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write it as KEY=VALUE".to_owned()),
    }
}

pub(super) fn role_file(text: &str) -> Result<(String, String), String> {
    key_value(text).map_err(|_| "write it as ROLE=FILE, such as subject=mask.png".to_owned())
}

pub(super) fn length_above_zero(text: &str) -> Result<f64, String> {
    let mm = parse_length(text).map_err(|error| error.to_string())?;
    if mm > 0.0 { length_from_zero(text) } else { Err("must be above 0".to_owned()) }
}

pub(super) fn length_from_zero(text: &str) -> Result<f64, String> {
    let mm = parse_length(text).map_err(|error| error.to_string())?;
    if (0.0..=100_000.0).contains(&mm) { Ok(mm) } else { Err("must be from 0 to 100 m".to_owned()) }
}

/// Work for reading a file, in millions of steps.
pub(super) fn work(text: &str) -> Result<f64, String> {
    let millions = number_above_zero(text).ok().filter(|millions| *millions <= crate::read::MOST_WORK);
    millions.ok_or_else(|| format!("must be a number of millions above 0, up to {}", crate::read::MOST_WORK))
}

/// A length for a drawing that is read; it may be in pixels.
pub(super) fn drawn_length_from_zero(text: &str) -> Result<f64, String> {
    let mm = parse_drawn_length(text).map_err(|error| error.to_string())?;
    if (0.0..=100_000.0).contains(&mm) { Ok(mm) } else { Err("must be from 0 to 100 m".to_owned()) }
}

pub(super) fn nib(text: &str) -> Result<f64, String> {
    length_within(text, &NIBS)
}

pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    length_within(text, &TOLERANCES)
}

/// By how much pens miss each other.
pub(super) fn registration(text: &str) -> Result<f64, String> {
    length_within(text, &(0.0..=2.0))
}

fn length_within(text: &str, range: &RangeInclusive<f64>) -> Result<f64, String> {
    let mm = parse_drawn_length(text).map_err(|error| error.to_string())?;
    if range.contains(&mm) { Ok(mm) } else { Err(format!("must be from {} to {} mm", range.start(), range.end())) }
}

pub(super) fn scale(text: &str) -> Result<f64, String> {
    let factor = text.parse::<f64>().ok().filter(|factor| SCALES.contains(factor));
    factor.ok_or_else(|| format!("must be a number from {} to {}", SCALES.start(), SCALES.end()))
}

pub(super) fn size_above_zero(text: &str) -> Result<(f64, f64), String> {
    let (width, height) = parse_size(text).map_err(|error| error.to_string())?;
    let sound = |mm: f64| (1.0..=100_000.0).contains(&mm);
    if sound(width) && sound(height) { Ok((width, height)) } else { Err("both sides must be from 1 mm to 100 m".to_owned()) }
}

/// A position on the sheet, x and y in millimetres. A unit at the end applies to both, as in `2,3.5cm`.
pub(super) fn place(text: &str) -> Result<(f64, f64), String> {
    let refuse = || "write it as X,Y, such as 20,35mm".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(refuse)?;
    let has_unit = x.trim().ends_with(|c: char| c.is_ascii_alphabetic());
    let unit = y.trim().trim_start_matches(|c: char| !c.is_ascii_alphabetic());
    let x = if has_unit { x.to_owned() } else { format!("{}{unit}", x.trim()) };
    let within = |text: &str| parse_length(text).ok().filter(|mm| mm.abs() <= 100_000.0).ok_or_else(refuse);
    Ok((within(&x)?, within(y)?))
}

/// A share such as `35%`, as a fraction.
#[cfg(feature = "drive")]
pub(super) fn percent(text: &str) -> Result<f64, String> {
    let share = text.trim().strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok());
    share.filter(|share| (0.0..=100.0).contains(share)).map(|share| share / 100.0).ok_or_else(|| "write it as 35%".to_owned())
}

/// When a pen is dipped: after a length such as `3m` or a time such as `5min`.
#[cfg(feature = "drive")]
pub(super) fn dip(text: &str) -> Result<crate::drive::Dip, String> {
    use crate::drive::Dip;
    let text = text.trim().trim_start_matches("every=");
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
    let after = |unit: &str| text.strip_suffix(unit).and_then(number);
    let time = after("min").map(|minutes| 60.0 * minutes).or_else(|| after("s")).map(Dip::Seconds);
    let length = || match parse_length(text) {
        Ok(mm) if mm > 0.0 => Some(Dip::Millimetres(mm)),
        _ => after("m").map(|metres| Dip::Millimetres(1000.0 * metres)),
    };
    time.or_else(length).ok_or_else(|| "write it as a length or a time, such as 3m or 5min".to_owned())
}

/// Two percents, such as `60,30`.
#[cfg(feature = "drive")]
pub(super) fn pen_heights(text: &str) -> Result<(f64, f64), String> {
    let percent = |text: &str| text.trim().parse::<f64>().ok().filter(|percent| (0.0..=100.0).contains(percent));
    let heights = text.split_once(',').and_then(|(up, down)| Some((percent(up)?, percent(down)?)));
    heights.filter(|(up, down)| up != down).ok_or_else(|| "write it as UP,DOWN, such as 60,30, each from 0 to 100".to_owned())
}

/// A box in millimetres: x, y, width, height.
#[cfg(feature = "drive")]
pub(super) fn region(text: &str) -> Result<[f64; 4], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| parse_length(number.trim()).ok()).collect();
    let sides = numbers.and_then(|numbers| <[f64; 4]>::try_from(numbers).ok());
    sides.filter(|[_, _, w, h]| *w > 0.0 && *h > 0.0).ok_or_else(|| "write it as X,Y,W,H, such as 10,20,50,40".to_owned())
}

/// Cells of a sheet, side by side and above one another.
pub(super) fn cells(text: &str) -> Result<(usize, usize), String> {
    let count = |text: &str| text.trim().parse().ok().filter(|count| (1..=100).contains(count));
    let cells = text.split_once('x').and_then(|(columns, rows)| Some((count(columns)?, count(rows)?)));
    cells.ok_or_else(|| "write it as COLUMNSxROWS, such as 3x2, each from 1 to 100".to_owned())
}

pub(super) fn number_above_zero(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("must be a number above 0".to_owned()),
    }
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('s').unwrap_or(text).trim();
    number.parse().ok().filter(|s: &f64| (0.0..=60.0).contains(s)).ok_or_else(|| "must be from 0 to 60 seconds".to_owned())
}

/// A time such as `2h`, `90min`, `1h30m` or `45s`, in seconds.
pub(super) fn duration(text: &str) -> Result<f64, String> {
    let refuse = || "write it as 2h, 90min, 1h30m or 45s, above 0".to_owned();
    let (mut rest, mut seconds, mut last) = (text.trim(), 0.0, f64::INFINITY);
    while !rest.is_empty() {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').ok_or_else(refuse)?;
        let number: f64 = rest[..end].parse().map_err(|_| refuse())?;
        let after = rest[end..].trim_start();
        let unit = after.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(after.len());
        let size = match &after[..unit] {
            "h" => 3600.0,
            "m" | "min" => 60.0,
            "s" => 1.0,
            _ => return Err(refuse()),
        };
        // Larger units come first, each at most once.
        if size >= last {
            return Err(refuse());
        }
        (seconds, last, rest) = (seconds + number * size, size, after[unit..].trim_start());
    }
    if seconds > 0.0 && seconds <= 1e7 { Ok(seconds) } else { Err(refuse()) }
}

/// A length in metres unless another unit is given; returns millimetres.
pub(super) fn metres(text: &str) -> Result<f64, String> {
    let trimmed = text.trim();
    let (number, unit) = match trimmed.strip_suffix('m') {
        Some(number) if !number.ends_with(['m', 'c']) => (number.trim(), 1000.0),
        _ => (trimmed, if trimmed.ends_with(|c: char| c.is_ascii_digit()) { 1000.0 } else { 1.0 }),
    };
    length_above_zero(number).map(|length| length * unit)
}

pub(super) fn dry_time(text: &str) -> Result<f64, String> {
    let seconds = number_above_zero(text).ok().filter(|seconds| *seconds <= 86_400.0);
    seconds.ok_or_else(|| "must be a number of seconds above 0, up to 86400".to_owned())
}

pub(super) fn gamma(text: &str) -> Result<f64, String> {
    number_above_zero(text).ok().filter(|g| (0.1..=10.0).contains(g)).ok_or_else(|| "must be a number from 0.1 to 10".to_owned())
}

pub(super) fn fraction(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|f| (0.0..=1.0).contains(f)).ok_or_else(|| "must be a number from 0 to 1".to_owned())
}

/// The reflectance of a grey card.
pub(super) fn reflectance(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|f| (0.02..=0.98).contains(f));
    value.ok_or_else(|| "must be a number from 0.02 to 0.98, such as 0.18".to_owned())
}

pub(super) fn dot_gain(text: &str) -> Result<f64, String> {
    fraction(text).ok().filter(|gain| *gain <= 0.5).ok_or_else(|| "must be a number from 0 to 0.5".to_owned())
}

pub(super) fn screen(text: &str) -> Result<f64, String> {
    number_above_zero(text)
        .ok()
        .filter(|lines| (10.0..=200.0).contains(lines))
        .ok_or_else(|| "must be from 10 to 200 lines per cm".to_owned())
}

pub(super) fn ink(text: &str) -> Result<Ink, String> {
    text.parse().map_err(|error: crate::drawing::ColourError| error.to_string())
}

pub(super) fn crop(text: &str) -> Result<CropPart, String> {
    match text.trim() {
        "head" => return Ok(CropPart::Head),
        "face" => return Ok(CropPart::Face),
        _ => {}
    }
    let refuse = || "write it as X,Y,W,H in pixels or %, such as 10%,0,80%,100%, or as head or face".to_owned();
    let numbers: Vec<CropNumber> = text
        .split(',')
        .map(|part| {
            let part = part.trim();
            let (number, is_percent) = part.strip_suffix('%').map_or((part, false), |n| (n, true));
            let value: f64 = number.trim().parse().ok().filter(|v: &f64| v.is_finite())?;
            Some(if is_percent { CropNumber::Percent(value) } else { CropNumber::Pixels(value) })
        })
        .collect::<Option<_>>()
        .ok_or_else(refuse)?;
    numbers.try_into().map(CropPart::Box).map_err(|_| refuse())
}

/// The part of a batch that one machine draws: `number` of `count`, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) struct Shard {
    pub number: u32,
    pub count: u32,
}

impl Shard {
    /// All pictures.
    pub(in crate::cli) const WHOLE: Self = Self { number: 1, count: 1 };
}

/// A part of a batch, such as `3/8`.
pub(super) fn shard(text: &str) -> Result<Shard, String> {
    let parsed = text.split_once('/').and_then(|(number, count)| Some((number.trim().parse().ok()?, count.trim().parse().ok()?)));
    match parsed {
        Some((number, count)) if (1..=count).contains(&number) => Ok(Shard { number, count }),
        _ => Err("write it as I/N, such as 3/8, with I from 1 to N".to_owned()),
    }
}

/// Bytes of memory, such as `4GB`, `512 MB` or `2GiB`; at least 64 MB, which the smallest drawing takes.
pub(super) fn memory_size(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 8] = [
        ("KIB", 1024.0),
        ("MIB", 1_048_576.0),
        ("GIB", 1_073_741_824.0),
        ("KB", 1e3),
        ("MB", 1e6),
        ("GB", 1e9),
        ("M", 1e6),
        ("G", 1e9),
    ];
    let upper = text.trim().to_ascii_uppercase();
    let sized = UNITS.iter().find_map(|(unit, bytes)| Some((upper.strip_suffix(unit)?, bytes)));
    let bytes = sized.and_then(|(number, bytes)| Some(number.trim().parse::<f64>().ok()? * bytes));
    let fits = bytes.filter(|bytes| (64e6..=1e15).contains(bytes));
    fits.map(|bytes| bytes as u64).ok_or_else(|| "write it as 4GB, 512MB or 2GiB; at least 64MB".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lengths() {
        assert_eq!(metres("20m"), Ok(20_000.0));
        assert_eq!(metres("2.5"), Ok(2500.0));
        assert_eq!((metres("500mm"), metres("30cm")), (Ok(500.0), Ok(300.0)));
        assert!(metres("0m").is_err() && metres("far").is_err());
    }

    #[test]
    fn nibs_tolerances_and_scales_have_ends() {
        assert_eq!((nib("0.3"), nib("0.01mm"), nib("2cm")), (Ok(0.3), Ok(0.01), Ok(20.0)));
        assert_eq!((tolerance("0.02"), scale("2.5")), (Ok(0.02), Ok(2.5)));
        for wrong in ["0", "-0.3", "1e-300", "1e-9", "NaN", "inf", "20.1", "1e300"] {
            assert!(
                nib(wrong).unwrap_err().contains(if wrong == "NaN" || wrong == "inf" { "" } else { "0.01 to 20 mm" }),
                "{wrong}"
            );
            assert!(tolerance(wrong).is_err(), "{wrong}");
        }
        assert_eq!(tolerance("1e-300").unwrap_err(), "must be from 0.001 to 1 mm");
        for wrong in ["0", "-1", "1e-9", "1001", "1e300", "inf", "NaN", ""] {
            assert_eq!(scale(wrong).unwrap_err(), "must be a number from 0.001 to 1000", "{wrong}");
        }
    }

    #[test]
    fn shards_and_memory() {
        assert_eq!(shard("3/8"), Ok(Shard { number: 3, count: 8 }));
        for wrong in ["0/8", "9/8", "3", "a/b", "1/0", "-1/2"] {
            assert!(shard(wrong).is_err(), "{wrong}");
        }
        assert_eq!((memory_size("4GB"), memory_size("512 mb")), (Ok(4_000_000_000), Ok(512_000_000)));
        assert_eq!((memory_size("2GiB"), memory_size("1.5g")), (Ok(2_147_483_648), Ok(1_500_000_000)));
        for wrong in ["4", "GB", "1MB", "-4GB", "nanGB"] {
            assert!(memory_size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn durations() {
        assert_eq!((duration("2h"), duration("90min"), duration("1h30m")), (Ok(7200.0), Ok(5400.0), Ok(5400.0)));
        assert_eq!((duration("1.5h"), duration("1h 5 min"), duration("45s")), (Ok(5400.0), Ok(3900.0), Ok(45.0)));
        for wrong in ["", "2", "h", "30m1h", "1h2h", "0h", "-2h", "2 days", "1..5h"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn places() {
        assert_eq!((place("20,35"), place("2, 3.5cm")), (Ok((20.0, 35.0)), Ok((20.0, 35.0))));
        assert_eq!((place("-5mm,1cm"), place("1in,0")), (Ok((-5.0, 10.0)), Ok((25.4, 0.0))));
        for wrong in ["20", "20x35", "a,b", "NaN,1", "1,2,3", "1e9,0", ","] {
            assert!(place(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn crops() {
        let CropPart::Box(numbers) = crop("10%,0,80%,100").unwrap() else { panic!("a box") };
        assert_eq!(numbers[0], CropNumber::Percent(10.0));
        assert_eq!(crop("head"), Ok(CropPart::Head));
        assert!(crop("1,2,3").is_err() && crop("a,b,c,d").is_err() && crop("NaN,0,1,1").is_err());
    }
}
