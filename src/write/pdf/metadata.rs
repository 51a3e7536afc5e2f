//! Metadata: the information dictionary, and the same as XMP with the recipe (ISO 32000-1, 14.3).

use crate::write::SvgHead;
use pdf_writer::writers::DocumentInfo;
use pdf_writer::{Date, TextStr};
use std::fmt::Write as _;

const PRODUCER: &str = concat!("drypoint ", env!("CARGO_PKG_VERSION"));

pub(super) fn info(info: &mut DocumentInfo<'_>, head: &SvgHead, seconds: Option<u64>) {
    info.title(TextStr(&head.title)).subject(TextStr(&head.description)).creator(TextStr(PRODUCER)).producer(TextStr(PRODUCER));
    if let Some([year, month, day, hour, minute, second]) = seconds.map(date) {
        let date = Date::new(year as u16)
            .month(month as u8)
            .day(day as u8)
            .hour(hour as u8)
            .minute(minute as u8)
            .second(second as u8)
            .utc_offset_hour(0)
            .utc_offset_minute(0);
        info.creation_date(date).modified_date(date);
    }
}

/// The XMP packet.
pub(super) fn packet(head: &SvgHead, seconds: Option<u64>) -> String {
    let mut text = String::from("<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n");
    text.push_str(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n",
    );
    text.push_str("<rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" xmlns:pdf=\"http://ns.adobe.com/pdf/1.3/\" xmlns:drypoint=\"urn:drypoint:\">\n");
    let _ = writeln!(text, "<dc:format>application/pdf</dc:format>");
    for (name, value) in [("title", &head.title), ("description", &head.description)] {
        let value = escaped(value);
        let _ = writeln!(text, "<dc:{name}><rdf:Alt><rdf:li xml:lang=\"x-default\">{value}</rdf:li></rdf:Alt></dc:{name}>");
    }
    let _ = writeln!(text, "<xmp:CreatorTool>{PRODUCER}</xmp:CreatorTool>\n<pdf:Producer>{PRODUCER}</pdf:Producer>");
    if let Some([year, month, day, hour, minute, second]) = seconds.map(date) {
        let date = format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z");
        let _ = writeln!(text, "<xmp:CreateDate>{date}</xmp:CreateDate>\n<xmp:ModifyDate>{date}</xmp:ModifyDate>");
    }
    if !head.recipe.is_empty() {
        let _ = writeln!(text, "<drypoint:recipe>{}</drypoint:recipe>", escaped(&head.recipe));
    }
    text.push_str("</rdf:Description>\n</rdf:RDF>\n</x:xmpmeta>\n<?xpacket end=\"r\"?>");
    text
}

/// Escapes the text of an XML element; characters that XML does not allow become spaces.
fn escaped(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut out, c| {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            c if c.is_control() && c != '\n' && c != '\t' || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
        out
    })
}

/// Year, month, day, hour, minute and second of a time in seconds since 1970; the year is at most 9999.
fn date(seconds: u64) -> [u64; 6] {
    let is_leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let (mut day, time) = (seconds / 86_400, seconds % 86_400);
    let mut year = 1970;
    while year < 9999 && day >= 365 + u64::from(is_leap(year)) {
        day -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let mut month = 1;
    for length in [31, 28 + u64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if day < length {
            break;
        }
        day -= length;
        month += 1;
    }
    [year, month, (day + 1).min(31), time / 3600, time / 60 % 60, time % 60]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates() {
        assert_eq!(date(0), [1970, 1, 1, 0, 0, 0]);
        assert_eq!(date(951_827_696), [2000, 2, 29, 12, 34, 56]);
        assert_eq!(date(1_704_067_199), [2023, 12, 31, 23, 59, 59]);
        assert_eq!(date(u64::MAX)[0], 9999);
    }

    #[test]
    fn what_xml_cannot_hold_is_left_out() {
        assert_eq!(escaped("a<b>&\u{1}c"), "a&lt;b&gt;&amp; c");
    }
}
