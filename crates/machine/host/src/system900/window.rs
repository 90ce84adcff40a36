//! The window of `machine.toml`: which markers and double words of the PLC are which parameters.

use bahn_control900::Window900;
use bahn_exchange::{Bit, BitArea, Number, Size, signal};
use bahn_machine::Said;
use bahn_plc::Subject;
use bahn_system900::{Direction, M_MAX, MarkerPart, Memory, Name, marker_names};
use bahn_text::{Diagnostic, Span, nearest};

/// How an entry is written.
const FORM: &str = "a window has entries as \"SAFREK1 = M300\", \"P8050-P8064 = D200\", \"M3-M9 = M403\"";

/// Markers of the interface of a TNC begin here.
const INTERFACE: u16 = 2000;

/// A marker that nobody serves here.
pub(super) fn is_of_interface(bit: Bit) -> bool {
    let serves = [
        signal::FIRST_SCAN_AFTER_POWER_ON,
        signal::FIRST_SCAN_AFTER_PLC_INTERRUPTION,
    ];
    bit.area() == BitArea::M && bit.number() >= INTERFACE && !serves.contains(&bit)
}

/// What stands in the memory of the PLC.
pub(super) struct Given {
    /// Where the entry stands.
    pub span: Span,
    /// What it is called.
    pub name: String,
    /// Where in the memory of the PLC.
    pub subject: Subject,
    /// The control gives it, and the PLC may not set it.
    pub by_control: bool,
    /// It is one of a range.
    pub of_range: bool,
}

impl Given {
    /// As programs write it.
    pub fn operand(&self) -> String {
        format!("{}, {}", self.subject, self.name)
    }
}

/// What is read of a window.
struct Reading<'a> {
    memory: &'a Memory,
    window: Window900,
    given: Vec<Given>,
    faults: Vec<Diagnostic>,
}

/// What the left side of an entry names.
enum Named {
    /// M functions of a channel from one to another.
    Functions(u8, u16, u16),
    /// Parameters, one after the other.
    Parameters(Vec<Name>),
    Marker(bahn_system900::Marker),
}

/// An entry while it is read: its words with their places.
struct Entry<'a> {
    name: (&'a str, Span),
    operand: (&'a str, Span),
}

/// Reads the entries; all faults, at their words.
pub(super) fn read(entries: &[Said], memory: &Memory) -> (Window900, Vec<Given>, Vec<Diagnostic>) {
    let mut reading = Reading {
        memory,
        window: Window900::default(),
        given: Vec::new(),
        faults: Vec::new(),
    };
    for entry in entries {
        reading.entry(entry);
    }
    (reading.window, reading.given, reading.faults)
}

/// The place of a word of an entry, which begins with a quotation mark.
fn place(entry: &Said, from: usize, word: &str) -> Span {
    let before = entry.text.get(..from).map_or(0, |before| before.chars().count());
    Span::new(
        entry.span.line as usize,
        entry.span.column as usize + 1 + before,
        word.chars().count().max(1),
    )
}

/// A word without blanks, from a byte of the entry on.
fn word<'a>(entry: &'a Said, from: usize, text: &'a str) -> (&'a str, Span) {
    let trimmed = text.trim();
    let blank = text.len() - text.trim_start().len();
    (trimmed, place(entry, from + blank, trimmed))
}

impl Reading<'_> {
    fn fault(&mut self, span: Span, message: impl Into<String>) {
        self.faults.push(Diagnostic::error(span, message));
    }

    fn entry(&mut self, said: &Said) {
        let Some((name, operand)) = said.text.split_once('=') else {
            return self.fault(word(said, 0, &said.text).1, FORM);
        };
        let entry = Entry {
            name: word(said, 0, name),
            operand: word(said, name.len() + 1, operand),
        };
        if entry.name.0.is_empty() || entry.operand.0.is_empty() {
            return self.fault(word(said, 0, &said.text).1, FORM);
        }
        match self.named(entry.name.0) {
            Ok(Named::Functions(channel, first, last)) => self.functions(&entry, channel, first..=last),
            Ok(Named::Parameters(names)) => self.parameters(&entry, &names),
            Ok(Named::Marker(marker)) => self.marker(&entry, marker),
            Err(message) => self.fault(entry.name.1, message),
        }
    }

    /// What a name means: a marker of the table, an M function, a parameter; of the last two also several.
    fn named(&self, text: &str) -> Result<Named, String> {
        let unknown = match self.memory.marker(text) {
            Ok(marker) => return Ok(Named::Marker(marker)),
            Err(bahn_system900::NoMarker::Unknown(_)) => {
                let names = marker_names();
                let meant = nearest(&text.to_ascii_uppercase(), names);
                let meant = meant.map_or(String::new(), |meant| format!("; did you mean `{meant}`?"));
                format!("`{text}` is no marker of the table, no parameter and no M function{meant}")
            }
            Err(number) => return Err(number.to_string()),
        };
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        if let (Some(first), Some(last)) = (function(first), function(last)) {
            let (channel, first) = first;
            let last = last.1;
            let channels = self.memory.channels();
            if !(1..=channels).contains(&channel) {
                return Err(format!("there is no channel {channel}, they are 1 to {channels}"));
            }
            if first > last || last > M_MAX {
                return Err(format!("M functions are M0 to M{M_MAX}, the lower number first"));
            }
            return Ok(Named::Functions(channel, first, last));
        }
        let (Ok(first), Ok(last)) = (first.parse::<Name>(), last.parse::<Name>()) else {
            return Err(unknown);
        };
        Ok(Named::Parameters(range(first, last)?))
    }

    /// A marker of the PLC that is free.
    fn bit(&mut self, entry: &Entry, text: &str) -> Option<Bit> {
        let bit = text.parse::<Bit>().ok().filter(|bit| bit.area() == BitArea::M);
        let Some(bit) = bit else {
            self.fault(
                entry.operand.1,
                format!(
                    "`{text}` is no marker of the PLC: {} stands at one, M0 to M1999",
                    entry.name.0
                ),
            );
            return None;
        };
        if bit.number() >= INTERFACE {
            self.fault(entry.operand.1, format!("{bit}: free markers are M0 to M1999"));
            return None;
        }
        Some(bit)
    }

    fn double(&mut self, entry: &Entry) -> Option<Number> {
        let text = entry.operand.0;
        let number = text.parse::<Number>().ok();
        let number = number.filter(|number| number.size() == Size::Double);
        if number.is_none() {
            self.fault(
                entry.operand.1,
                format!(
                    "`{text}` is no double word of the PLC: {} stands at one, D0 to D1020",
                    entry.name.0
                ),
            );
        }
        number
    }

    /// Notes what stands where; `false` when something else stands there, or it stands elsewhere, which is said.
    fn takes(
        &mut self,
        entry: &Entry,
        name: String,
        subject: Subject,
        by_control: bool,
        of_range: bool,
    ) -> bool {
        if let Some(other) = self.given.iter().find(|other| other.name == name) {
            let message = format!("{name} stands in the window already, at {}", other.subject);
            self.fault(entry.name.1, message);
            return false;
        }
        if let Some(other) = self.given.iter().find(|other| other.subject.meets(subject)) {
            let message = format!("{subject} is taken already, by {}", other.name);
            self.fault(entry.operand.1, message);
            return false;
        }
        self.given.push(Given {
            span: entry.name.1,
            name,
            subject,
            by_control,
            of_range,
        });
        true
    }

    fn marker(&mut self, entry: &Entry, marker: bahn_system900::Marker) {
        let name = entry.name.0.to_ascii_uppercase();
        let by_control = marker.direction == Direction::ToPlc;
        if marker.part == MarkerPart::Word {
            let Some(at) = self.double(entry) else { return };
            if self.takes(entry, name, number_subject(at), by_control, false) {
                let window = std::mem::take(&mut self.window);
                self.window = window.number(marker.place, marker.direction, at);
            }
            return;
        }
        let Some(at) = self.bit(entry, entry.operand.0) else {
            return;
        };
        if self.takes(entry, name, bit_subject(at), by_control, false) {
            self.window = std::mem::take(&mut self.window).marker(marker, at);
        }
    }

    fn functions(&mut self, entry: &Entry, channel: u8, all: std::ops::RangeInclusive<u16>) {
        let Some(first) = self.bit(entry, entry.operand.0) else {
            return;
        };
        let of_range = all.start() != all.end();
        for (m, number) in all.zip(first.number()..) {
            let Some(at) = self.bit(entry, &format!("M{number}")) else {
                return;
            };
            let name = match channel {
                1 => format!("M function {m}"),
                channel => format!("M function {m} of channel {channel}"),
            };
            if !self.takes(entry, name, bit_subject(at), true, of_range) {
                return;
            }
            self.window = std::mem::take(&mut self.window).function(channel, m, at);
        }
    }

    fn parameters(&mut self, entry: &Entry, names: &[Name]) {
        let Some(first) = self.double(entry) else { return };
        let of_range = names.len() > 1;
        for (name, address) in names
            .iter()
            .zip((first.address()..).step_by(usize::from(Size::Double.bytes())))
        {
            let Some(at) = Number::new(Size::Double, address) else {
                return self.fault(
                    entry.operand.1,
                    format!("{name} would stand at D{address}: double words are D0 to D1020"),
                );
            };
            let place = match self.memory.place(*name) {
                Ok(place) => place,
                Err(error) => return self.fault(entry.name.1, error.to_string()),
            };
            let direction = self.memory.direction(place);
            let by_control = direction == Direction::ToPlc;
            let name = self.memory.name_of(place).to_string();
            if !self.takes(entry, name, number_subject(at), by_control, of_range) {
                return;
            }
            self.window = std::mem::take(&mut self.window).number(place, direction, at);
        }
    }
}

fn bit_subject(bit: Bit) -> Subject {
    Subject::Bit { bit, indexed: false }
}

fn number_subject(number: Number) -> Subject {
    Subject::Number {
        number,
        indexed: false,
    }
}

/// Channel and number of `M8` or `2:M8`.
fn function(text: &str) -> Option<(u8, u16)> {
    let text = text.trim().to_ascii_uppercase();
    let (channel, rest) = match text.split_once(':') {
        Some((channel, rest)) => (channel.trim_start_matches('K').trim().parse().ok()?, rest.trim()),
        None => (1, text.as_str()),
    };
    let digits = rest.strip_prefix('M')?;
    let all = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
    Some((channel, all.then(|| digits.parse().ok())??))
}

/// The names from one to another; the channel of the first holds for both.
fn range(first: Name, last: Name) -> Result<Vec<Name>, String> {
    let (numbers, of): (_, Box<dyn Fn(u32) -> Name>) = match (first, last) {
        (Name::Q(first), Name::Q(last)) => (first..=last, Box::new(Name::Q)),
        (Name::P(channel, first), Name::P(other, last)) if other == channel || other == 1 => {
            (first..=last, Box::new(move |number| Name::P(channel, number)))
        }
        _ => return Err(format!("{first} and {last} are no range of one kind")),
    };
    // As many double words as the memory of the PLC has.
    const MOST: u32 = 256;
    match numbers.end().checked_sub(*numbers.start()) {
        Some(count) if count < MOST => Ok(numbers.map(of).collect()),
        Some(_) => Err(format!(
            "{first} to {last} are more than the {MOST} double words of the PLC"
        )),
        None => Err(format!("{first} comes after {last}")),
    }
}
