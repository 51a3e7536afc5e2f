//! What GRBL 1.1 and `FluidNC` say, line by line (gnea/grbl, `interface.md`).

/// A line that the machine sent.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Reply {
    /// A line was taken: parsed and planned, which is not drawn.
    Ok,
    /// A line was refused.
    Error(u32),
    /// The machine stopped itself.
    Alarm(u32),
    /// `<Idle|MPos:...>`.
    Status(Status),
    /// The greeting after a start or a reset.
    Banner(String),
    /// `$110=5000.000`.
    Setting(u32, f64),
    /// Anything else, such as `[MSG:...]`.
    Other(String),
}

/// What the machine does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MachineState {
    /// Nothing, and it is ready.
    #[default]
    Idle,
    /// It moves.
    Run,
    /// It was told to hold, and stands still.
    Held,
    /// It was told to hold, and still moves.
    Holding,
    /// It moves to where it was told by hand.
    Jog,
    /// It looks for its end switches.
    Home,
    /// It is locked.
    Alarm,
    /// It only checks.
    Check,
    /// Its door is open, or it sleeps.
    Away,
}

/// A status report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// What the machine does.
    pub state: MachineState,
    /// Position on the machine, if it is reported.
    pub machine: Option<[f64; 3]>,
    /// Position of the work, if it is reported.
    pub work: Option<[f64; 3]>,
    /// Offset of the work on the machine, if it is reported.
    pub offset: Option<[f64; 3]>,
    /// The spindle's speed, by which a servo is set, if it is reported.
    pub spindle: Option<f64>,
    /// Free blocks of the planner and free bytes of the line buffer, if they are reported.
    pub free: Option<[u32; 2]>,
}

impl Reply {
    /// The meaning of a line without its end; `None` for an empty one.
    pub fn of(line: &str) -> Option<Self> {
        let line = line.trim();
        if line.is_empty() {
            return None;
        }
        let number = |text: &str| text.trim().parse().unwrap_or(0);
        Some(if line == "ok" {
            Self::Ok
        } else if let Some(code) = line.strip_prefix("error:") {
            Self::Error(number(code))
        } else if let Some(code) = line.strip_prefix("ALARM:") {
            Self::Alarm(number(code))
        } else if let Some(report) = line.strip_prefix('<').and_then(|rest| rest.strip_suffix('>')) {
            Self::Status(Status::of(report))
        } else if line.starts_with("Grbl ") || line.starts_with("GrblHAL ") {
            Self::Banner(line.split(['[', '\'']).next().unwrap_or(line).trim().to_owned())
        } else {
            setting(line).unwrap_or_else(|| Self::Other(line.to_owned()))
        })
    }
}

fn setting(line: &str) -> Option<Reply> {
    let (name, value) = line.strip_prefix('$')?.split_once('=')?;
    let value = value.split([' ', '(']).next()?;
    Some(Reply::Setting(name.parse().ok()?, value.parse().ok()?))
}

impl Status {
    fn of(report: &str) -> Self {
        let mut parts = report.split('|');
        let mut status = Self { state: MachineState::of(parts.next().unwrap_or("")), ..Self::default() };
        for part in parts {
            let Some((name, values)) = part.split_once(':') else { continue };
            match name {
                "MPos" => status.machine = place(values),
                "WPos" => status.work = place(values),
                "WCO" => status.offset = place(values),
                "FS" => status.spindle = values.split(',').nth(1).and_then(|speed| speed.parse().ok()),
                "Bf" => {
                    let mut free = values.split(',').map(|value| value.parse().unwrap_or(0));
                    status.free = Some([free.next().unwrap_or(0), free.next().unwrap_or(0)]);
                }
                _ => {}
            }
        }
        status
    }
}

/// Three coordinates; a machine of two axes has no z.
fn place(values: &str) -> Option<[f64; 3]> {
    let mut place = [0.0; 3];
    for (coordinate, value) in place.iter_mut().zip(values.split(',')) {
        *coordinate = value.parse().ok()?;
    }
    Some(place)
}

impl MachineState {
    fn of(word: &str) -> Self {
        match word.split_once(':').unwrap_or((word, "")) {
            ("Idle", _) => Self::Idle,
            ("Run", _) => Self::Run,
            ("Hold", "0") => Self::Held,
            ("Hold", _) => Self::Holding,
            ("Jog", _) => Self::Jog,
            ("Home", _) => Self::Home,
            ("Check", _) => Self::Check,
            ("Alarm", _) => Self::Alarm,
            _ => Self::Away,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_the_machine_are_understood() {
        assert_eq!(Reply::of("ok\r"), Some(Reply::Ok));
        assert_eq!(Reply::of("error:20"), Some(Reply::Error(20)));
        assert_eq!(Reply::of("ALARM:1"), Some(Reply::Alarm(1)));
        assert_eq!(Reply::of("$110=5000.000"), Some(Reply::Setting(110, 5000.0)));
        assert_eq!(Reply::of("$32=0 (laser)"), Some(Reply::Setting(32, 0.0)));
        assert_eq!(Reply::of("Grbl 1.1h ['$' for help]"), Some(Reply::Banner("Grbl 1.1h".into())));
        assert_eq!(Reply::of("Grbl 3.7 [FluidNC v3.7.8 (wifi) '$' for help]"), Some(Reply::Banner("Grbl 3.7".into())));
        assert_eq!(Reply::of("[MSG:Caution: Unlocked]"), Some(Reply::Other("[MSG:Caution: Unlocked]".into())));
        assert_eq!(Reply::of(" \r"), None);
        let Some(Reply::Status(status)) = Reply::of("<Hold:0|MPos:1.000,-2.500,0.000|Bf:15,128|FS:0,700|WCO:1.000,0.000,0.000>")
        else {
            panic!("a status")
        };
        assert_eq!((status.state, status.machine), (MachineState::Held, Some([1.0, -2.5, 0.0])));
        assert_eq!((status.offset, status.free, status.spindle), (Some([1.0, 0.0, 0.0]), Some([15, 128]), Some(700.0)));
    }

    #[test]
    fn noise_is_no_panic() {
        for line in ["<", "<>", "<Idle|MPos:a,b>", "error:", "$=", "ALARM:x", "\u{0}\u{ff}", "<|:|,>"] {
            let _ = Reply::of(line);
        }
    }
}
