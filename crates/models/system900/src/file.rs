//! Data files: a line `NAME: VALUE [STATUS]` for each parameter [002:409-430].
//!
//! Decision: A comment in braces may go over several lines; one that holds a brace of its own, or does not end, is a
//! fault. A semicolon within it says nothing
//!
//! Decision: A name leads where the descriptors lead that stand before its line. A later line that moves them is a
//! warning, since what has been written stays where it is
//!
//! Decision: Of a status the bit that says whether the parameter is loaded follows from the value; another one there is a
//! warning

use std::collections::HashMap;
use std::ops::Range;

use bahn_text::{Diagnostic, Encoding, Severity, Span};

use crate::array::{PARAMETERS_MAX, PARAMETERS_MIN};
use crate::memory::{Memory, Place, SpaceError};
use crate::name::Name;
use crate::numbers::{ACTIVATE, AXES, AXIS_WORDS, CHANNELS_MAX, DESCRIPTOR, FUNCTION, PARAMETERS};
use crate::status::Status;
use crate::value::Value;

/// One line that gives a parameter a value. Places are bytes of the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub line: usize,
    pub name: Range<usize>,
    pub value: Range<usize>,
    pub status: Option<Range<usize>>,
}

/// A data file: its text, what it says, what is wrong with it.
///
/// ```
/// use bahn_system900::{DataFile, Name};
/// let file = DataFile::read(b"q102: 10000\nq103: 5000\nP7000: 2.5 ; as it is delivered\nP7001: x\n");
/// assert_eq!(file.memory().cell(Name::Q(15_000)).unwrap().number(), Some(2.5));
/// assert_eq!(file.faults()[0].to_string(), "4:8: `x` is no value: 12.5, -3, $1F, --");
/// ```
#[derive(Clone, Debug)]
pub struct DataFile {
    text: String,
    encoding: Encoding,
    memory: Memory,
    faults: Vec<Diagnostic>,
    entries: Vec<Entry>,
    /// The last entry of each place.
    last: HashMap<Place, usize>,
    /// Channels whose lines may follow at the end.
    active: u8,
}

/// What a battery keeps: the parameters with the values that a data file gives some of them, and what is wrong with its lines.
pub(crate) fn over(bytes: &[u8], memory: &Memory) -> (Memory, Vec<Diagnostic>) {
    let (text, _) = Encoding::read(bytes);
    let mut reader = Reader::over(&text, memory.clone(), memory.channels());
    reader.read();
    (reader.memory, reader.faults)
}

impl DataFile {
    /// Reads a file; whatever it holds, what can be read is read.
    pub fn read(bytes: &[u8]) -> DataFile {
        let (text, encoding) = Encoding::read(bytes);
        let mut reader = Reader::new(&text);
        reader.read();
        let Reader {
            memory,
            mut faults,
            entries,
            last,
            active,
            ..
        } = reader;
        faults.sort();
        DataFile {
            memory,
            faults,
            entries,
            last,
            active,
            encoding,
            text,
        }
    }

    /// The text as it was read, or as it was changed.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The bytes of the file, written as it was read.
    pub fn bytes(&self) -> Vec<u8> {
        self.encoding.write(&self.text)
    }

    pub(crate) fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// What the parameters hold.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// What is wrong with its lines, in their order: errors and warnings.
    pub fn faults(&self) -> &[Diagnostic] {
        &self.faults
    }

    /// Whether all of its lines could be read.
    pub fn is_readable(&self) -> bool {
        self.faults.iter().all(|fault| fault.severity != Severity::Error)
    }

    /// How many lines give a parameter a value.
    pub fn entries(&self) -> usize {
        self.entries.len()
    }

    /// The channels whose lines may follow at its end.
    pub(crate) fn active(&self) -> u8 {
        self.active
    }

    /// The last line that gives a place a value.
    pub(crate) fn entry(&self, place: Place) -> Option<&Entry> {
        self.entries.get(*self.last.get(&place)?)
    }

    /// Where the value of a system parameter stands; the file as a whole where it is not in it.
    pub(crate) fn span(&self, number: u32) -> Span {
        self.entry(Place::Q(number))
            .map_or(Span::FILE, |entry| span(&self.text, entry.line, &entry.value))
    }
}

/// A place of a line in characters.
fn span(text: &str, line: usize, bytes: &Range<usize>) -> Span {
    let begin = text
        .get(..bytes.start)
        .map_or(0, |before| before.rfind('\n').map_or(0, |newline| newline + 1));
    let chars = |range: Range<usize>| text.get(range).map_or(0, |part| part.chars().count());
    let length = chars(bytes.clone()).max(1);
    Span::new(line, chars(begin..bytes.start) + 1, length)
}

struct Reader<'t> {
    text: &'t str,
    memory: Memory,
    faults: Vec<Diagnostic>,
    entries: Vec<Entry>,
    last: HashMap<Place, usize>,
    /// The entry of each place, and the place that its name meant.
    places: Vec<(usize, Name, Place)>,
    active: u8,
    /// The channels whose parameters have been written.
    used: [bool; CHANNELS_MAX as usize],
}

impl<'t> Reader<'t> {
    fn new(text: &'t str) -> Reader<'t> {
        Reader::over(text, Memory::new(), 1)
    }

    /// What gives values to parameters that have some, of so many channels.
    fn over(text: &'t str, mut memory: Memory, active: u8) -> Reader<'t> {
        memory.resize(PARAMETERS_MAX);
        Reader {
            text,
            memory,
            faults: Vec::new(),
            entries: Vec::new(),
            last: HashMap::new(),
            places: Vec::new(),
            active,
            used: [false; CHANNELS_MAX as usize],
        }
    }

    fn read(&mut self) {
        let mut comment = Comment::default();
        let mut begin = 0;
        for (line, whole) in (1..).zip(self.text.split_inclusive('\n')) {
            let code = comment.without(whole, line, begin);
            self.line(line, begin, &code);
            begin += whole.len();
        }
        for (line, at) in comment.faults.iter().chain(&comment.open) {
            let place = span(self.text, *line, &(*at..at + 1));
            let fault = Diagnostic::error(place, "the comment that begins here does not end");
            self.faults.push(fault);
        }
        self.end();
    }

    fn error(&mut self, line: usize, bytes: Range<usize>, message: impl Into<String>) {
        let place = span(self.text, line, &bytes);
        self.faults.push(Diagnostic::error(place, message));
    }

    fn warning(&mut self, line: usize, bytes: Range<usize>, message: impl Into<String>) {
        let place = span(self.text, line, &bytes);
        self.faults.push(Diagnostic::warning(place, message));
    }

    /// Reads a line without its comments.
    fn line(&mut self, line: usize, begin: usize, code: &str) {
        let whole = within(code, code);
        if whole.is_empty() {
            return;
        }
        let moved = |range: Range<usize>| begin + range.start..begin + range.end;
        let letter = code.find(['q', 'Q', 'p', 'P']);
        let colon = letter.and_then(|letter| Some(letter + code.get(letter..)?.find(':')?));
        let Some((name_text, rest)) = colon.and_then(|at| Some((code.get(..at)?, code.get(at + 1..)?)))
        else {
            self.error(line, moved(whole), "a line is `NAME: VALUE [STATUS]`");
            return;
        };
        let name_at = moved(within(code, name_text));
        let mut words = rest.split_whitespace().map(|word| moved(within(code, word)));
        let (value_at, status_at, more) = (words.next(), words.next(), words.next());
        let name = match name_text.parse::<Name>() {
            Ok(name) => name,
            Err(error) => return self.error(line, name_at, error.to_string()),
        };
        let Some(value_at) = value_at else {
            return self.error(line, name_at, format!("{name} has no value"));
        };
        if let Some(more) = more {
            return self.error(line, more, "after the status nothing follows but a comment");
        }
        let entry = Entry {
            line,
            name: name_at,
            value: value_at,
            status: status_at,
        };
        self.entry(name, entry);
    }

    /// Takes what a line says.
    fn entry(&mut self, name: Name, entry: Entry) {
        let text = self.text;
        let word = |range: &Range<usize>| text.get(range.clone()).unwrap_or_default();
        let value = match word(&entry.value).parse::<Value>() {
            Ok(value) => value,
            Err(error) => return self.error(entry.line, entry.value, error.to_string()),
        };
        let status = match entry.status.as_ref().map(|at| word(at).parse::<Status>()) {
            Some(Err(error)) => {
                let at = entry.status.unwrap_or(entry.value);
                return self.error(entry.line, at, error.to_string());
            }
            Some(Ok(status)) => Some(status),
            None => None,
        };
        let place = match self.place(name) {
            Ok(place) => place,
            Err(message) => return self.error(entry.line, entry.name, message),
        };
        if let Some(status) = status {
            // It leads somewhere.
            let _ = self.memory.set_status(name, status);
            if status.is_loaded() != (value != Value::Cleared) {
                let says = if status.is_loaded() { "loaded" } else { "cleared" };
                let message = format!("the status says that {name} is {says}; the value counts");
                self.warning(entry.line, entry.status.clone().unwrap_or_default(), message);
            }
        }
        let before = self.memory.at(place).whole();
        if let Err(error) = self.memory.write(name, value) {
            return self.error(entry.line, entry.value, error.to_string());
        }
        if let Place::Q(number) = place {
            self.system(number, before, &entry);
        }
        let index = self.entries.len();
        if let Some(earlier) = self.last.insert(place, index) {
            let earlier = self.entries.get(earlier).map_or(0, |earlier| earlier.line);
            let message = format!("{name} stands in line {earlier} already; this line counts");
            self.warning(entry.line, entry.name.clone(), message);
        }
        self.places.push((index, name, place));
        self.entries.push(entry);
    }

    /// Where a name leads, when its channel is active.
    fn place(&mut self, name: Name) -> Result<Place, String> {
        let place = self.memory.place(name).map_err(|error| error.to_string())?;
        if let Some((channel, _)) = name.of_channel() {
            if channel > self.active {
                return Err(format!(
                    "channel {channel} is not active: `q{FUNCTION}: {ACTIVATE}` stands before its lines"
                ));
            }
            let used = usize::from(channel).checked_sub(1);
            if let Some(used) = used.and_then(|index| self.used.get_mut(index)) {
                *used = true;
            }
        }
        Ok(place)
    }

    /// What the line of a system parameter does beside giving it a value.
    fn system(&mut self, number: u32, before: Option<i64>, entry: &Entry) {
        let now = self.memory.system(number).whole();
        if number == FUNCTION {
            match now {
                Some(ACTIVATE) => self.active = self.memory.channels(),
                _ => {
                    let message = format!("q{FUNCTION} is {ACTIVATE} in a data file and nothing else");
                    self.error(entry.line, entry.value.clone(), message);
                }
            }
        }
        let (channel, offset) = (number / DESCRIPTOR, number % DESCRIPTOR);
        let moves = (2..8).contains(&offset) || (AXIS_WORDS..AXIS_WORDS + u32::from(AXES)).contains(&offset);
        let used = (channel as usize)
            .checked_sub(1)
            .and_then(|channel| self.used.get(channel));
        if let (true, Some(true)) = (moves && before != now && before.is_some(), used) {
            let message = format!(
                "q{number} moves parameters of channel {channel}; what stood before this line stays where it was"
            );
            self.warning(entry.line, entry.value.clone(), message);
        }
    }

    /// What is known at the end: how many parameters there are.
    fn end(&mut self) {
        let count = self.memory.system(PARAMETERS).whole();
        let count = count.and_then(|count| usize::try_from(count).ok());
        self.memory.resize(count.unwrap_or(PARAMETERS_MIN));
        let count = self.memory.count();
        let places = std::mem::take(&mut self.places);
        for (index, name, place) in places {
            let is_beyond = place.q().is_some_and(|number| number as usize >= count);
            if let (true, Some(entry)) = (is_beyond, self.entries.get(index)) {
                let (line, at) = (entry.line, entry.name.clone());
                self.error(line, at, SpaceError::BeyondArray { name, count }.to_string());
            }
        }
    }
}

/// The bytes of a part of a line, without blanks around it.
fn within(line: &str, part: &str) -> Range<usize> {
    let trimmed = part.trim();
    let begin = trimmed.as_ptr().addr() - line.as_ptr().addr();
    begin..begin + trimmed.len()
}

/// The comments of a text.
#[derive(Default)]
struct Comment {
    /// Line and place of the brace that is open.
    open: Option<(usize, usize)>,
    /// Braces that were open when another one came.
    faults: Vec<(usize, usize)>,
}

impl Comment {
    /// A line with blanks in place of its comments, as many bytes as before.
    fn without(&mut self, whole: &str, line: usize, begin: usize) -> String {
        let mut code = String::with_capacity(whole.len());
        let mut to_the_end = false;
        for (at, letter) in whole.char_indices() {
            let is_code = self.open.is_none() && !to_the_end;
            match letter {
                ';' if is_code => to_the_end = true,
                '{' if !to_the_end => self.faults.extend(self.open.replace((line, begin + at))),
                '}' if self.open.is_some() => self.open = None,
                letter if is_code => {
                    code.push(letter);
                    continue;
                }
                _ => {}
            }
            code.extend(std::iter::repeat_n(' ', letter.len_utf8()));
        }
        code
    }
}
