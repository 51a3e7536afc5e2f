//! GRBL's errors and alarms in words, with what to do (gnea/grbl 1.1, `doc/csv`; numbers above 38 are `FluidNC`'s).

/// Meaning of `error:N`.
pub(super) fn error(code: u32) -> &'static str {
    match code {
        1 => "a word lacks its letter: the line was garbled on its way; check the cable, and use a shorter or shielded one",
        2 => "a number is malformed: the line was garbled on its way; check the cable",
        3 => "it does not know this $ command; the firmware may be older than 1.1",
        4 => "a value must not be negative; check the line in the file",
        5 => "homing is switched off in its settings; set $22=1 if it has end switches",
        6 => "a step pulse must be at least 3 microseconds; raise $0",
        7 => "its settings in the EEPROM could not be read and were reset; restore yours",
        8 => "this $ command needs an idle machine; wait until it stands still",
        9 => "it is locked by an alarm or while it jogs; home or unlock it first",
        10 => "soft limits need homing; set $22=1 before $20=1",
        11 => "the line is longer than its buffer; choose the profile of your machine so that lines are shorter",
        12 => "this setting would make it step faster than it can; lower the rate or the steps per millimetre",
        13 => "its door is open; close it",
        14 => "a start-up line or the build information is longer than the memory for it",
        15 => "a jog would leave the machine's reach; choose a shorter way",
        16 => "a jog is malformed: it takes G20, G21, G53, G90, G91 and a feed",
        17 => "laser mode needs a PWM output; set $32=0",
        18 => "the start-up line failed; check $N",
        20 => "it does not know one of these words; choose the profile that fits the firmware",
        21 => "two words of this line belong to the same group; check the line in the file",
        22 => "it has no feed yet; the first line to draw needs an F",
        23 => "the value must be a whole number; check the line in the file",
        24 => "two words of this line both need its axes; check the line in the file",
        25 => "a word stands twice in the line: it was garbled on its way; check the cable",
        26 => "the line needs axis words and has none; check the line in the file",
        27 => "the line number is not valid",
        28 => "a value that the command needs is missing; check the line in the file",
        29 => "it has only the work coordinates G54 to G59",
        30 => "G53 needs G0 or G1; check the line in the file",
        31 => "there are axis words that no command of the line uses",
        32 => "an arc has no axis in its plane; check the line in the file",
        33 => "the target cannot be reached by this motion; check the line in the file",
        34 => "an arc's radius is not possible; check the line in the file",
        35 => "an arc lacks its centre; check the line in the file",
        36 => "the line holds values that nothing uses: it was garbled on its way; check the cable",
        37 => "tool length offsets work only on its configured axis",
        38 => "the tool's number is greater than it allows",
        39 => "a parameter's value is out of range",
        60 => "its card could not be mounted",
        61 => "a file on its card could not be opened",
        62 => "a folder on its card could not be opened",
        70 => "its web interface refuses the user",
        71 => "a setting's value is not valid",
        110 => "a value is not valid in the state it is in",
        152 => "its configuration file is invalid; correct it and restart",
        _ => "which its manual explains",
    }
}

/// Meaning of `ALARM:N`.
pub(super) fn alarm(code: u32) -> &'static str {
    match code {
        1 => "an end switch was hit: its position is probably lost; free the carriage, then home it",
        2 => "a move would leave its reach (soft limits); check the sheet's place and where zero is, then unlock it",
        3 => "it was reset while it moved: its position is lost; home it or set zero again",
        4 => "the probe was not in its initial state",
        5 => "the probe did not touch",
        6 => "homing was reset before it ended; home it again",
        7 => "its door was opened while it homed; close it and home again",
        8 => "homing could not free the end switch; raise $27",
        9 => "homing found no end switch; check the switches and the reach in $130 and $131",
        10 => "homing found no second switch of an axis with two motors; check the squaring",
        11 => "it needs homing before anything else",
        12 => "it could not be homed: the homing sequence failed",
        13 => "its emergency stop was pressed; release it and home",
        14 => "it must be homed: its position is not known",
        _ => "which its manual explains",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GRBL 1.1: errors 1 to 38 without 19, alarms 1 to 9.
    #[test]
    fn every_error_and_alarm_of_grbl_has_words_that_help() {
        let unknown = error(999);
        for code in (1..=38).filter(|code| *code != 19) {
            assert!(error(code) != unknown && error(code).len() > 20, "error {code}");
        }
        for code in 1..=10 {
            assert!(alarm(code) != alarm(999) && alarm(code).len() > 20, "alarm {code}");
        }
        assert_eq!(error(0), unknown);
    }
}
