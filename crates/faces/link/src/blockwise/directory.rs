//! The directory of an FE [000:17460-17474].
//!
//! Decision: A sector of the directory has 512 bytes, 1580 are free on an empty disk (790 kByte); more may be stored,
//! as the folder has room

use std::collections::VecDeque;
use std::time::Duration;

use bahn_parameters::MessageId;

use super::{SECTOR, SECTORS};
use crate::files::Listed;
use crate::protocol::{Ended, Event, Protocol, Shown};
use crate::settings::Settings;
use crate::text::LINE_MAX;
use crate::{DC1, DC3, FileType};

/// What the control asks with: DC3 ESC DC1 `0 D` CR LF.
pub(super) const REQUEST: [u8; 8] = [DC3, 0x1B, DC1, b'0', b' ', b'D', b'\r', b'\n'];
/// Lines of the answer that are ignored.
const IGNORED: usize = 4;
/// Characters before a name that are ignored.
const BEFORE_NAME: usize = 6;

/// The directory as the device sends it: four lines, a line for each file, and the free sectors.
pub(super) fn answer(files: &[Listed]) -> Vec<u8> {
    let mut text = String::from("BAHN\r\nDIRECTORY\r\n\r\nNo. T NAME             SECTORS\r\n");
    let mut used = 0;
    for (number, file) in (1..).zip(files) {
        let (stem, extension) = file.name.rsplit_once('.').unwrap_or((&file.name, ""));
        let code = FileType::of_extension(extension).map_or('A', FileType::code);
        let sectors = file.size.div_ceil(SECTOR);
        used += sectors;
        // Protected files have a P.
        let mark = if file.protected { " P" } else { "" };
        text += &format!("{number:>3} {code} {stem:<16} {sectors:>5}{mark}\r\n");
    }
    text += &format!("FREE: {}\r\n", SECTORS.saturating_sub(used));
    text.into_bytes()
}

/// A line of the answer.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Row {
    File(String, Option<u32>),
    Free(u32),
}

fn row(line: &str) -> Option<Row> {
    let number = |text: &str| {
        let digits: String = text
            .trim_start()
            .chars()
            .take_while(char::is_ascii_digit)
            .collect();
        digits.parse().ok()
    };
    if let Some((_, free)) = line.split_once("FREE:") {
        return number(free).map(Row::Free);
    }
    let rest = line.get(BEFORE_NAME..)?.trim_start();
    // Devices may print the name between quotation marks, as the manual does.
    let (name, rest) = match rest.strip_prefix('"') {
        Some(quoted) => quoted.split_once('"')?,
        None => rest.split_at(rest.find(' ').unwrap_or(rest.len())),
    };
    let sectors = number(rest.trim_start_matches([' ', '"']));
    (!name.is_empty()).then(|| Row::File(name.to_owned(), sectors))
}

/// The control asks for the directory in mode FE1.
pub struct DirectoryRequest {
    settings: Settings,
    outgoing: VecDeque<u8>,
    line: Vec<u8>,
    lines: usize,
    quiet: Duration,
    over: bool,
    events: VecDeque<Event>,
}

impl DirectoryRequest {
    /// Asks the device for its directory.
    pub fn new(settings: Settings) -> DirectoryRequest {
        DirectoryRequest {
            settings,
            outgoing: REQUEST.into(),
            line: Vec::new(),
            lines: 0,
            quiet: Duration::ZERO,
            over: false,
            events: VecDeque::new(),
        }
    }

    fn take_line(&mut self) {
        let line = std::mem::take(&mut self.line);
        self.lines += 1;
        let Some(row) = row(&String::from_utf8_lossy(&line)) else {
            return;
        };
        match row {
            // The end of the answer, however short it is.
            Row::Free(sectors) => {
                self.events.push_back(Event::Free(sectors));
                self.finish(None);
            }
            Row::File(name, sectors) if self.lines > IGNORED => {
                self.events.push_back(Event::Listed(name, sectors));
            }
            Row::File(..) => {}
        }
    }

    fn finish(&mut self, shown: Option<Shown>) {
        if !self.over {
            self.over = true;
            let ended = Ended::unless(shown.is_some());
            self.events.extend(shown.map(Event::Message));
            self.events.push_back(Event::Ended(ended));
        }
    }
}

impl Protocol for DirectoryRequest {
    fn receive(&mut self, byte: u8, now: Duration) {
        self.quiet = now;
        let control = &self.settings.control;
        match byte {
            _ if self.over => {}
            b'\n' => self.take_line(),
            _ if byte == control.etx || byte == control.eot => {
                let answered = self.lines >= IGNORED;
                self.finish((!answered).then_some(Shown::Control(MessageId::ProgramIncomplete, None)));
            }
            b' '.. if self.line.len() < LINE_MAX => self.line.push(byte),
            _ => {}
        }
    }

    fn clock(&mut self, now: Duration) {
        if self.deadline().is_some_and(|deadline| now >= deadline) {
            self.finish(match self.lines {
                0 => Some(Shown::Control(MessageId::ExtInOutputNotReady, None)),
                // A device that does not report what is free.
                lines if lines >= IGNORED => None,
                _ => Some(Shown::Control(MessageId::ProgramIncomplete, None)),
            });
        }
    }

    fn deadline(&self) -> Option<Duration> {
        (!self.over && self.outgoing.is_empty()).then(|| self.quiet + self.settings.patience)
    }

    fn has_output(&self) -> bool {
        !self.outgoing.is_empty()
    }

    fn send(&mut self, room: usize, now: Duration, into: &mut Vec<u8>) {
        if !self.outgoing.is_empty() {
            into.extend(self.outgoing.drain(..room.min(self.outgoing.len())));
            self.quiet = now;
        }
    }

    fn unplugged(&mut self, _now: Duration) {
        self.outgoing.clear();
        self.finish(Some(Shown::Control(MessageId::ProgramIncomplete, None)));
    }

    fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    fn answer(&mut self, _yes: bool, _now: Duration) {}

    fn end(&mut self, _now: Duration) {
        self.outgoing.clear();
        self.finish(None);
    }

    fn is_idle(&self) -> bool {
        self.over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_a_directory() {
        for (line, expected) in [
            ("  1 H 15                  3", Row::File("15".into(), Some(3))),
            ("xxxxxx\"100\" \"12\"xxxxxx", Row::File("100".into(), Some(12))),
            ("xxxxxxABC     7 xx", Row::File("ABC".into(), Some(7))),
            ("xxxxxxABC", Row::File("ABC".into(), None)),
            ("FREE: 1234 SECTORS", Row::Free(1234)),
            ("      FREE:    7", Row::Free(7)),
        ] {
            assert_eq!(row(line), Some(expected), "{line}");
        }
        for line in ["", "xxx", "xxxxxx", "xxxxxx   "] {
            assert_eq!(row(line), None, "{line:?}");
        }
    }

    /// What the device sends the control understands.
    #[test]
    fn an_answer_is_read_as_it_was_meant() {
        let files = [("1.H", 1), ("LONGEST-NAME_0#$.T", 51_200), ("2.PLC", 0)].map(|(name, size)| Listed {
            name: name.into(),
            size,
            protected: size == 0,
        });
        let text = String::from_utf8(answer(&files)).unwrap_or_default();
        let rows: Vec<Row> = text.lines().skip(IGNORED).filter_map(row).collect();
        let file = |name: &str, sectors| Row::File(name.into(), Some(sectors));
        let free = Row::Free((SECTORS - 101) as u32);
        assert_eq!(
            rows,
            [file("1", 1), file("LONGEST-NAME_0#$", 100), file("2", 0), free]
        );
    }
}
