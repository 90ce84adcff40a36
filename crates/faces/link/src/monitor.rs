//! What passes over a line in words: blocks with their check characters, telegrams of LSV/2, lines of text.

/// Names of the control characters.
const NAMES: [&str; 32] = [
    "NUL", "SOH", "STX", "ETX", "EOT", "ENQ", "ACK", "BEL", "BS", "HT", "LF", "VT", "FF", "CR", "SO", "SI",
    "DLE", "DC1", "DC2", "DC3", "DC4", "NAK", "SYN", "ETB", "CAN", "EM", "SUB", "ESC", "FS", "GS", "RS",
    "US",
];
const SOH: u8 = 1;
const STX: u8 = 2;
const ETX: u8 = 3;
const LF: u8 = 10;
const DLE: u8 = 0x10;
const ETB: u8 = 0x17;
/// Bytes in a line at most.
const LINE_MAX: usize = 256;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Between,
    /// Between SOH or STX and ETB.
    Block,
    /// The next byte is a check character.
    Check,
    /// Between DLE STX and DLE ETX.
    Telegram,
    /// The next byte is that of a telegram.
    TelegramCheck,
}

/// One direction of a line.
///
/// ```
/// use bahn_link::Monitor;
///
/// let mut monitor = Monitor::default();
/// let mut lines = Vec::new();
/// for byte in b"\x01H15E\x17\x1F\x11\x06" {
///     lines.extend(monitor.byte(*byte));
/// }
/// lines.extend(monitor.rest());
/// assert_eq!(lines, ["SOH \"H15E\" ETB BCC=1F", "DC1 ACK"]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Monitor {
    state: State,
    line: String,
    bytes: usize,
    /// Text that is between quotation marks.
    text: bool,
    check: u8,
    /// The last byte was a DLE.
    escaped: bool,
    /// NUL characters in sequence, which are counted.
    nuls: usize,
}

impl Monitor {
    /// A byte passes; the line that is whole with it.
    pub fn byte(&mut self, byte: u8) -> Option<String> {
        self.bytes += 1;
        if byte == 0 && self.state == State::Between {
            self.nuls += 1;
            return None;
        }
        self.end_nuls();
        let whole = match self.state {
            State::Between => self.between(byte),
            State::Block => {
                self.check ^= byte;
                self.show(byte);
                if byte == ETB {
                    self.state = State::Check;
                }
                false
            }
            State::Check => self.end(byte & 0x7F, self.check & 0x7F),
            State::Telegram => {
                self.telegram(byte);
                false
            }
            State::TelegramCheck => self.end(byte, self.check),
        };
        (whole || self.bytes >= LINE_MAX).then(|| self.flush()).flatten()
    }

    /// What has begun, when something else follows.
    pub fn rest(&mut self) -> Option<String> {
        self.end_nuls();
        self.flush()
    }

    fn between(&mut self, byte: u8) -> bool {
        let after_dle = std::mem::replace(&mut self.escaped, byte == DLE);
        self.show(byte);
        match byte {
            STX if after_dle => {
                self.state = State::Telegram;
                self.check = 0;
                self.escaped = false;
            }
            SOH | STX => {
                self.state = State::Block;
                self.check = byte;
            }
            _ => {}
        }
        byte == LF
    }

    fn telegram(&mut self, byte: u8) {
        if std::mem::take(&mut self.escaped) {
            match byte {
                ETX => {
                    self.word("DLE");
                    self.word("ETX");
                    self.check ^= ETX;
                    self.state = State::TelegramCheck;
                }
                // A doubled DLE is one of the telegram.
                _ => {
                    self.check ^= byte;
                    self.show(byte);
                }
            }
        } else if byte == DLE {
            self.escaped = true;
        } else {
            self.check ^= byte;
            self.show(byte);
        }
    }

    fn end(&mut self, found: u8, expected: u8) -> bool {
        if found == expected {
            self.word(&format!("BCC={found:02X}"));
        } else {
            self.word(&format!("BCC={found:02X} WRONG, {expected:02X}"));
        }
        self.state = State::Between;
        self.escaped = false;
        true
    }

    fn end_nuls(&mut self) {
        match std::mem::take(&mut self.nuls) {
            0 => {}
            1 => self.word("NUL"),
            count => self.word(&format!("NUL*{count}")),
        }
    }

    fn show(&mut self, byte: u8) {
        match NAMES.get(usize::from(byte)) {
            Some(name) => self.word(name),
            None if byte < 0x7F => {
                if !self.text {
                    self.space();
                    self.line.push('"');
                    self.text = true;
                }
                self.line.push(char::from(byte));
            }
            None => self.word(&format!("{byte:02X}")),
        }
    }

    fn space(&mut self) {
        if !self.line.is_empty() {
            self.line.push(' ');
        }
    }

    fn word(&mut self, word: &str) {
        self.end_text();
        self.space();
        self.line.push_str(word);
    }

    fn end_text(&mut self) {
        if std::mem::take(&mut self.text) {
            self.line.push('"');
        }
    }

    fn flush(&mut self) -> Option<String> {
        self.end_text();
        self.bytes = 0;
        let line = std::mem::take(&mut self.line);
        (!line.is_empty()).then_some(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<String> {
        let mut monitor = Monitor::default();
        let mut lines: Vec<String> = bytes.iter().filter_map(|byte| monitor.byte(*byte)).collect();
        lines.extend(monitor.rest());
        lines
    }

    #[test]
    fn all_protocols() {
        let mut tape = vec![0; 50];
        tape.extend(b"0 BEGIN PGM 1 MM\r\n1 END PGM 1 MM\r\n\x03\x04");
        assert_eq!(
            lines(&tape),
            [
                "NUL*50 \"0 BEGIN PGM 1 MM\" CR LF",
                "\"1 END PGM 1 MM\" CR LF",
                "ETX EOT"
            ]
        );
        assert_eq!(lines(b"\x02ab\x17\x00"), ["STX \"ab\" ETB BCC=00 WRONG, 16"]);
        // The request for the version, with the check byte of the captures.
        assert_eq!(
            lines(b"\x05\x10\x02R_VR\x10\x03\x0A\x04"),
            ["ENQ DLE STX \"R_VR\" DLE ETX BCC=0A", "EOT"]
        );
        assert_eq!(lines(&[b'A'; 300]).len(), 2);
    }
}
