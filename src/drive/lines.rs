//! Lines that a machine says, put together from what arrives.

use super::port::Port;
use std::io;
use std::time::Duration;

/// A line of any firmware is shorter; endless noise must not fill the memory.
const LONGEST: usize = 4096;
/// XON and XOFF, which are for the line and not of it.
const FLOW: [u8; 2] = [0x11, 0x13];

/// The part of a line that has arrived.
#[derive(Default)]
pub(super) struct Lines {
    unfinished: Vec<u8>,
}

impl Lines {
    /// Whole lines without their ends, which are carriage returns, line feeds or both; waits up to `wait` for the first byte. Empty
    /// lines are left out.
    pub fn receive(&mut self, port: &mut dyn Port, wait: Duration) -> io::Result<Vec<String>> {
        let mut buffer = [0; 1024];
        let count = port.receive(&mut buffer, wait)?;
        let mut lines = Vec::new();
        for &byte in &buffer[..count] {
            match byte {
                b'\r' | b'\n' if self.unfinished.is_empty() => {}
                b'\r' | b'\n' => lines.push(String::from_utf8_lossy(&std::mem::take(&mut self.unfinished)).into_owned()),
                byte if FLOW.contains(&byte) || self.unfinished.len() >= LONGEST => {}
                byte => self.unfinished.push(byte),
            }
        }
        Ok(lines)
    }

    /// Forgets an unfinished line.
    pub fn clear(&mut self) {
        self.unfinished.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Saying(Vec<&'static [u8]>);

    impl Port for Saying {
        fn send(&mut self, _: &[u8]) -> io::Result<()> {
            Ok(())
        }

        fn receive(&mut self, buffer: &mut [u8], _: Duration) -> io::Result<usize> {
            let said = self.0.remove(0);
            buffer[..said.len()].copy_from_slice(said);
            Ok(said.len())
        }
    }

    #[test]
    fn lines_are_put_together_whatever_ends_them() {
        let mut port = Saying(vec![b"ok\r\n\x13err", b"or:2\n\r1,2\r", b"\x11half"]);
        let mut lines = Lines::default();
        let mut next = || lines.receive(&mut port, Duration::ZERO).unwrap();
        assert_eq!([next(), next(), next()], [vec!["ok".to_owned()], vec!["error:2".to_owned(), "1,2".to_owned()], vec![]]);
    }
}
