//! What Marlin and Klipper say, line by line.

/// A line that the machine sent.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Reply {
    Ok,
    /// It is at work, and takes no more for now.
    Busy,
    Resend(u64),
    /// `Error:...`.
    Error(String),
    /// It restarted.
    Start,
    Place([f64; 3]),
    Firmware(String),
    Other(String),
}

impl Reply {
    /// What a line says; Klipper answers some questions in the line of its `ok`.
    pub fn all(line: &str) -> Vec<Self> {
        let after = line.trim().strip_prefix("ok ").filter(|rest| rest.contains("FIRMWARE_NAME:") || place(rest).is_some());
        after.and_then(Self::of).into_iter().chain(Self::of(line)).collect()
    }

    fn of(line: &str) -> Option<Self> {
        let line = line.trim();
        if line.is_empty() {
            return None;
        }
        let lower = line.to_ascii_lowercase();
        let number = |text: &str| text.trim().trim_start_matches(['N', 'n', ':', ' ']).parse().ok();
        Some(if lower.starts_with("resend:") || lower.starts_with("rs ") {
            Self::Resend(number(&line[line.find([':', ' '])? + 1..])?)
        } else if lower.starts_with("ok") {
            Self::Ok
        } else if lower.contains("busy:") {
            Self::Busy
        } else if lower.starts_with("error:") || line.starts_with("!!") {
            Self::Error(line.split_once(':').map_or(line.trim_start_matches("!!"), |(_, text)| text).trim().to_owned())
        } else if lower == "start" {
            Self::Start
        } else if let Some(place) = place(line) {
            Self::Place(place)
        } else if let Some((_, name)) = line.split_once("FIRMWARE_NAME:") {
            Self::Firmware(
                name.split(" SOURCE_CODE_URL").next().unwrap_or(name).split(" (").next().unwrap_or(name).trim().to_owned(),
            )
        } else {
            Self::Other(line.trim_start_matches("echo:").to_owned())
        })
    }
}

/// `X:1.00 Y:2.00 Z:3.00 E:0.00 Count ...`.
fn place(line: &str) -> Option<[f64; 3]> {
    let before = line.split(" Count").next()?;
    let value = |letter: &str| before.split_whitespace().find_map(|word| word.strip_prefix(letter)?.parse::<f64>().ok());
    Some([value("X:")?, value("Y:")?, value("Z:").unwrap_or(0.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_understood() {
        assert_eq!(Reply::of("ok P15 B3"), Some(Reply::Ok));
        assert_eq!(Reply::of("Resend: 12"), Some(Reply::Resend(12)));
        assert_eq!(Reply::of("rs N12"), Some(Reply::Resend(12)));
        assert_eq!(Reply::of("echo:busy: processing"), Some(Reply::Busy));
        assert_eq!(Reply::of("X:1.00 Y:-2.50 Z:5.00 E:0.00 Count X:80 Y:-200 Z:2000"), Some(Reply::Place([1.0, -2.5, 5.0])));
        assert_eq!(
            Reply::of("Error:checksum mismatch, Last Line: 4"),
            Some(Reply::Error("checksum mismatch, Last Line: 4".into()))
        );
        assert_eq!(
            Reply::of("FIRMWARE_NAME:Marlin 2.1.2 (Jan  1 2026) SOURCE_CODE_URL:x"),
            Some(Reply::Firmware("Marlin 2.1.2".into()))
        );
        assert_eq!(Reply::of(""), None);
        let named = Reply::all("ok FIRMWARE_NAME:Klipper FIRMWARE_VERSION:v0.12");
        assert_eq!(named, [Reply::Firmware("Klipper FIRMWARE_VERSION:v0.12".into()), Reply::Ok]);
        assert_eq!(Reply::all("ok P15 B3"), [Reply::Ok]);
    }
}
