//! Reading the description of a machine: every fault with its place, unknown keys refused.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::RangeInclusive;

use bahn_servo::{ENCODERS, INPUTS, NOMINALS, OUTPUTS};
use bahn_text::{Diagnostic, LineIndex, Span};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Something that is wired to a PLC input or output, and where the description says so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wire {
    /// The place.
    pub span: Span,
    /// The input or output, as `I24` or `O10`.
    pub operand: String,
    /// The section of the description, as `axis.X`.
    pub section: String,
    /// Its key there, as `limit_plus`.
    pub key: String,
    /// A contact that opens, or an output that acts when it is off.
    pub opens: bool,
}

/// A PLC input and the sense in which it is wired.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    input: usize,
    inverted: bool,
}

impl Contact {
    /// What the contact says when its wire gives this level.
    pub fn says(self, level: bool) -> bool {
        level != self.inverted
    }

    pub fn input(self) -> usize {
        self.input
    }

    pub fn set(self, inputs: &mut [bool; INPUTS], on: bool) {
        if let Some(input) = inputs.get_mut(self.input) {
            *input = on != self.inverted;
        }
    }
}

/// A PLC output and the sense in which it acts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coil {
    output: usize,
    inverted: bool,
}

impl Coil {
    pub fn is_on(self, outputs: &[bool; OUTPUTS]) -> bool {
        outputs.get(self.output).copied().unwrap_or(false) != self.inverted
    }
}

/// Faults that are named at most, and wires whose places are kept.
const FAULTS_MAX: usize = 1000;
const WIRES_MAX: usize = 10_000;

/// The text being read and what was found wrong in it.
pub(crate) struct Reader<'t> {
    text: &'t str,
    lines: LineIndex,
    /// Outputs and encoders are those of physical axes.
    pub numbered: bool,
    faults: RefCell<Vec<Diagnostic>>,
    /// The inputs given away: where, which, to whom.
    taken: RefCell<Vec<(usize, usize, String)>>,
    wires: RefCell<Vec<Wire>>,
    /// Contacts of the cabinet and their places behind the outputs.
    contacts: RefCell<Vec<(String, usize)>>,
}

impl<'t> Reader<'t> {
    pub fn new(text: &'t str) -> Reader<'t> {
        Reader {
            text,
            lines: LineIndex::of(text),
            numbered: false,
            faults: RefCell::default(),
            taken: RefCell::default(),
            wires: RefCell::default(),
            contacts: RefCell::default(),
        }
    }

    /// Contacts that may stand where an output does.
    pub fn know_contacts(&self, contacts: Vec<(String, usize)>) {
        *self.contacts.borrow_mut() = contacts;
    }

    /// An output, or a contact of the cabinet, and whether it opens.
    fn switch(&self, text: &str) -> Option<(usize, bool)> {
        let (inverted, plain) = match text.strip_prefix("not ") {
            Some(rest) => (true, rest.trim_start()),
            None => (false, text),
        };
        let contacts = self.contacts.borrow();
        let contact = contacts.iter().find(|(name, _)| name == plain);
        operand(text, OUTPUT_LETTERS, OUTPUTS).or_else(|| Some((contact?.1, inverted)))
    }

    /// Notes an input or output that something is wired to.
    pub fn wire(&self, at: usize, operand: String, opens: bool) {
        if self.wires.borrow().len() == WIRES_MAX {
            return self.fault(at, "too many wires".to_owned());
        }
        let span = self.place(at);
        self.wires.borrow_mut().push(Wire {
            span,
            operand,
            section: String::new(),
            key: String::new(),
            opens,
        });
    }

    /// The inputs and outputs that were read, each with the section and the key where it stands.
    pub fn wires(&self) -> Vec<Wire> {
        let lines: Vec<&str> = self.text.lines().collect();
        let sections: Vec<&str> = lines.iter().scan("", Reader::section_at).collect();
        let mut wires = self.wires.take();
        for wire in &mut wires {
            let at = (wire.span.line as usize).saturating_sub(1);
            let line = lines.get(at).copied().unwrap_or_default();
            let key = line.split('=').next().unwrap_or_default().trim();
            sections
                .get(at)
                .copied()
                .unwrap_or_default()
                .clone_into(&mut wire.section);
            key.trim_matches('"').clone_into(&mut wire.key);
        }
        wires
    }

    /// The section of a line after those before it.
    fn section_at<'l>(section: &mut &'l str, line: &&'l str) -> Option<&'l str> {
        if let Some(header) = line.trim().strip_prefix('[') {
            let name = header.split(']').next().unwrap_or_default();
            *section = name.trim_start_matches('[').trim();
        }
        Some(section)
    }

    /// The tables of the text; faults in its form are noted.
    pub fn parse(&self) -> Spanned<DeTable<'t>> {
        let (table, errors) = DeTable::parse_recoverable(self.text);
        for error in errors {
            self.fault(
                error.span().map_or(0, |span| span.start),
                error.message().to_owned(),
            );
        }
        table
    }

    /// Notes a fault at a place of the text, in bytes. The last one that is noted says that there are more.
    pub fn fault(&self, at: usize, message: String) {
        let message = match self.faults.borrow().len() {
            ..FAULTS_MAX => message,
            FAULTS_MAX => "too many faults: further ones are not named".to_owned(),
            _ => return,
        };
        let span = self.place(at);
        self.faults.borrow_mut().push(Diagnostic::error(span, message));
    }

    /// The word that begins at a byte of the text.
    pub fn place(&self, at: usize) -> Span {
        let span = self.lines.span(self.text, at..at);
        let line = self.lines.line(self.text, span.line as usize);
        Span::word(span.line as usize, span.column as usize, line)
    }

    /// All faults in the order of the text.
    pub fn faults(self) -> Vec<Diagnostic> {
        self.check_taken();
        let mut faults = self.faults.into_inner();
        faults.sort();
        faults.dedup();
        faults
    }

    /// An input has one source.
    fn check_taken(&self) {
        let mut taken = self.taken.take();
        taken.sort();
        let mut owners: BTreeMap<usize, String> = BTreeMap::new();
        for (at, input, owner) in taken {
            match owners.entry(input) {
                Entry::Occupied(first) => {
                    self.fault(at, format!("I{input} belongs to {} already", first.get()));
                }
                Entry::Vacant(free) => {
                    free.insert(owner);
                }
            }
        }
    }
}

/// A table of the description. What is read is checked; what is not read is refused at
/// [`Section::finish`].
pub(crate) struct Section<'r, 't> {
    pub reader: &'r Reader<'t>,
    pub name: String,
    at: usize,
    table: &'r DeTable<'t>,
    known: RefCell<Vec<&'static str>>,
}

impl<'r, 't> Section<'r, 't> {
    pub fn root(reader: &'r Reader<'t>, table: &'r Spanned<DeTable<'t>>) -> Section<'r, 't> {
        Section::new(reader, String::new(), table.span().start, table.get_ref())
    }

    fn new(reader: &'r Reader<'t>, name: String, at: usize, table: &'r DeTable<'t>) -> Section<'r, 't> {
        Section {
            reader,
            name,
            at,
            table,
            known: RefCell::default(),
        }
    }

    /// Notes a fault of the whole table.
    pub fn fault(&self, message: String) {
        self.reader.fault(self.at, message);
    }

    /// Notes a fault of the value of a key.
    pub fn fault_at(&self, key: &str, message: String) {
        let at = self.table.get(key).map_or(self.at, |value| value.span().start);
        self.reader.fault(at, message);
    }

    fn value(&self, key: &'static str) -> Option<&'r Spanned<DeValue<'t>>> {
        self.known.borrow_mut().push(key);
        self.table.get(key)
    }

    fn path(&self, key: &str) -> String {
        if self.name.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.name)
        }
    }

    /// The line of the table, and of each of its keys, from 1.
    pub fn lines(&self) -> (usize, BTreeMap<String, usize>) {
        let line = |at| self.reader.place(at).line as usize;
        let keys = self.table.iter();
        let keys = keys.map(|(key, _)| (key.get_ref().to_string(), line(key.span().start)));
        (line(self.at), keys.collect())
    }

    /// Whether the key is there.
    pub fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A number within its range.
    pub fn number(&self, key: &'static str, range: RangeInclusive<f64>) -> Option<f64> {
        let value = self.value(key)?;
        self.as_number(key, value, &range)
    }

    fn as_number(&self, key: &str, value: &Spanned<DeValue<'t>>, range: &RangeInclusive<f64>) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|integer| integer as f64),
            DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
            _ => None,
        };
        let number = number.filter(|number| range.contains(number));
        if number.is_none() {
            let (min, max) = (range.start(), range.end());
            self.reader.fault(
                value.span().start,
                format!("{key} is a number from {min} to {max}"),
            );
        }
        number
    }

    /// A number that must be there; 1 stands for a wrong one while reading goes on.
    pub fn needed_number(&self, key: &'static str, range: RangeInclusive<f64>) -> f64 {
        if !self.has(key) {
            self.missing(key);
        }
        self.number(key, range).unwrap_or(1.0)
    }

    fn missing(&self, key: &str) {
        self.fault(format!("[{}] needs {key}", self.name));
    }

    /// Two numbers, the first below the second.
    pub fn range(&self, key: &'static str) -> Option<[f64; 2]> {
        let limits = self.numbers::<2>(key)?;
        if limits[0] >= limits[1] {
            self.fault_at(key, format!("{key} runs from a lower to a higher value"));
            return None;
        }
        Some(limits)
    }

    /// As many numbers as wanted.
    pub fn numbers<const N: usize>(&self, key: &'static str) -> Option<[f64; N]> {
        let value = self.value(key)?;
        let Some(list) = value.get_ref().as_array().filter(|list| list.len() == N) else {
            self.reader
                .fault(value.span().start, format!("{key} is a list of {N} numbers"));
            return None;
        };
        let mut numbers = [0.0; N];
        for (number, entry) in numbers.iter_mut().zip(list.iter()) {
            *number = self.as_number(key, entry, &(-1e6..=1e6))?;
        }
        Some(numbers)
    }

    /// A list of pairs of numbers.
    pub fn pairs(&self, key: &'static str) -> Vec<[f64; 2]> {
        let Some(value) = self.value(key) else {
            return Vec::new();
        };
        let pair = |entry: &Spanned<DeValue<'t>>| {
            let list = entry.get_ref().as_array().filter(|list| list.len() == 2)?;
            let number = |place: usize| self.as_number(key, list.get(place)?, &(-1e6..=1e6));
            Some([number(0)?, number(1)?])
        };
        let list = value.get_ref().as_array();
        list.and_then(|list| list.iter().map(pair).collect())
            .unwrap_or_else(|| {
                let form = format!("{key} is a list of pairs like [[0, 0], [100, 4.5]]");
                self.reader.fault(value.span().start, form);
                Vec::new()
            })
    }

    /// A list of whole numbers within a range.
    pub fn whole_numbers(&self, key: &'static str, range: RangeInclusive<u8>) -> Vec<u8> {
        let Some(value) = self.value(key) else {
            return Vec::new();
        };
        let whole = |entry: &Spanned<DeValue<'t>>| {
            let number = entry.get_ref().as_integer()?.as_str().parse().ok()?;
            range.contains(&number).then_some(number)
        };
        let list = value.get_ref().as_array();
        list.and_then(|list| list.iter().map(whole).collect())
            .unwrap_or_else(|| {
                let (min, max) = (range.start(), range.end());
                self.reader.fault(
                    value.span().start,
                    format!("{key} is a list of whole numbers from {min} to {max}"),
                );
                Vec::new()
            })
    }

    pub fn flag(&self, key: &'static str) -> Option<bool> {
        let value = self.value(key)?;
        let flag = value.get_ref().as_bool();
        if flag.is_none() {
            self.reader
                .fault(value.span().start, format!("{key} is true or false"));
        }
        flag
    }

    pub fn text(&self, key: &'static str) -> Option<&'r str> {
        let value = self.value(key)?;
        let text = value.get_ref().as_str();
        if text.is_none() {
            self.reader
                .fault(value.span().start, format!("{key} is a text in quotes"));
        }
        text
    }

    /// A text, or a whole number as it is written, with its place.
    pub fn text_or_number(&self, key: &'static str) -> Option<(usize, &'r str)> {
        let value = self.value(key)?;
        let text = match value.get_ref() {
            DeValue::Integer(number) => Some(number.as_str()),
            other => other.as_str(),
        };
        if text.is_none() {
            let form = format!("{key} is a text in quotes, or a whole number");
            self.reader.fault(value.span().start, form);
        }
        Some((value.span().start, text?))
    }

    /// Where the value of a key stands, or the table without one.
    pub fn place_of(&self, key: &str) -> Span {
        self.reader
            .place(self.table.get(key).map_or(self.at, |value| value.span().start))
    }

    /// A list of texts, each with its place.
    pub fn texts(&self, key: &'static str) -> Vec<(usize, &'r str)> {
        let Some(value) = self.value(key) else {
            return Vec::new();
        };
        let list = value.get_ref().as_array().and_then(|list| {
            list.iter()
                .map(|entry| Some((entry.span().start, entry.get_ref().as_str()?)))
                .collect()
        });
        list.unwrap_or_else(|| {
            self.reader
                .fault(value.span().start, format!("{key} is a list of texts"));
            Vec::new()
        })
    }

    /// One of several words; its place in the list.
    pub fn word(&self, key: &'static str, words: &[&str]) -> Option<usize> {
        let text = self.text(key)?;
        let index = words.iter().position(|word| *word == text);
        if index.is_none() {
            self.fault_at(key, format!("{key} is one of {}", words.join(", ")));
        }
        index
    }

    /// A nominal value output: 1 to 5 and S are those of a control, 7 and following those of further channels; its
    /// place among all.
    pub fn output(&self, key: &'static str) -> Option<usize> {
        if self.reader.numbered {
            let form = format!("one of 1 to {NOMINALS}, as the physical axis");
            return self.place(key, |text| connector(text, NOMINALS), &form);
        }
        let place = |text: &str| match text {
            "S" => Some(SPINDLE),
            _ => connector(text, NOMINALS).filter(|place| *place != SPINDLE),
        };
        let form = format!("one of 1, 2, 3, 4, 5, S, and 7 to {NOMINALS} of further channels");
        self.place(key, place, &form)
    }

    /// An input of an encoder, X1 to X6, X7 and following of further channels; its place among all.
    pub fn encoder_input(&self, key: &'static str) -> Option<usize> {
        let place = |text: &str| connector(text.strip_prefix('X')?, ENCODERS);
        let form = format!("one of X1, X2, X3, X4, X5, X6, and X7 to X{ENCODERS} of further channels");
        self.place(key, place, &form)
    }

    fn place(&self, key: &'static str, place: impl Fn(&str) -> Option<usize>, form: &str) -> Option<usize> {
        let place = place(self.text(key)?);
        if place.is_none() {
            self.fault_at(key, format!("{key} is {form}"));
        }
        place
    }

    /// A PLC input: `I24`, or `not I24` for a contact that opens.
    pub fn contact(&self, key: &'static str) -> Option<Contact> {
        let value = self.value(key)?;
        match self.contacts(key, value).as_slice() {
            [contact] => Some(*contact),
            [] => None,
            _ => {
                self.fault_at(key, format!("{key} is one input"));
                None
            }
        }
    }

    /// One PLC input or a list of them.
    fn contacts(&self, key: &str, value: &'r Spanned<DeValue<'t>>) -> Vec<Contact> {
        let entries: Vec<&Spanned<DeValue<'t>>> = match value.get_ref() {
            DeValue::Array(list) => list.iter().collect(),
            _ => vec![value],
        };
        let mut contacts = Vec::new();
        for entry in entries {
            let at = entry.span().start;
            match entry
                .get_ref()
                .as_str()
                .and_then(|text| operand(text, INPUT_LETTERS, INPUTS))
            {
                Some((input, inverted)) => {
                    self.reader.taken.borrow_mut().push((at, input, self.path(key)));
                    self.reader.wire(at, format!("I{input}"), inverted);
                    contacts.push(Contact { input, inverted });
                }
                None => {
                    let last = INPUTS - 1;
                    self.reader.fault(
                        at,
                        format!("{key} is an input \"I0\" to \"I{last}\", or \"not I0\""),
                    );
                }
            }
        }
        contacts
    }

    /// A PLC output: `O10`, or `not O10` for one that acts when it is off.
    pub fn coil(&self, key: &'static str) -> Option<Coil> {
        let value = self.value(key)?;
        self.as_coil(key, value)
    }

    fn as_coil(&self, key: &str, value: &'r Spanned<DeValue<'t>>) -> Option<Coil> {
        let at = value.span().start;
        let text = value.get_ref().as_str();
        let coil = text.and_then(|text| self.switched_by(at, text));
        if coil.is_none() {
            let last = OUTPUTS - 1;
            let message = format!("{key} is an output \"O0\" to \"O{last}\", or \"not O0\"");
            self.reader.fault(at, message);
        }
        coil
    }

    /// A contact of a circuit: an output, or one of the cabinet.
    pub fn contact_at(&self, at: usize, text: &str) -> Option<Coil> {
        let coil = self.switched_by(at, text);
        if coil.is_none() {
            let known = self.reader.contacts.borrow();
            let known: Vec<&str> = known.iter().map(|(name, _)| name.as_str()).collect();
            let message = format!(
                "`{text}` is neither an output nor a contact; there are {}",
                known.join(", ")
            );
            self.reader.fault(at, message);
        }
        coil
    }

    fn switched_by(&self, at: usize, text: &str) -> Option<Coil> {
        let (output, inverted) = self.reader.switch(text)?;
        if operand(text, OUTPUT_LETTERS, OUTPUTS).is_some() {
            self.reader.wire(at, format!("O{output}"), inverted);
        }
        Some(Coil { output, inverted })
    }

    /// The names that the user has given in a table, without reading it.
    pub fn names(&self, key: &str) -> Vec<String> {
        let table = self.table.get(key).and_then(|value| value.get_ref().as_table());
        let names = table.into_iter().flat_map(|table| table.keys());
        names.map(|name| name.get_ref().to_string()).collect()
    }

    /// The entries of a table whose keys are the user's names.
    fn entries(&self) -> impl Iterator<Item = (&'r str, &'r Spanned<DeValue<'t>>)> {
        self.table.iter().map(|(name, value)| {
            let name: &str = name.get_ref();
            (name, value)
        })
    }

    /// Names and their inputs, as `"X+" = "I133"` or `NC_START = ["I146", "not I147"]`.
    pub fn named_contacts(&self, key: &'static str) -> Vec<(String, Vec<Contact>)> {
        let Some(section) = self.section(key) else {
            return Vec::new();
        };
        section
            .entries()
            .map(|(name, value)| (name.to_owned(), section.contacts(name, value)))
            .collect()
    }

    /// Names and their outputs.
    pub fn named_coils(&self, key: &'static str) -> Vec<(String, Coil)> {
        let Some(section) = self.section(key) else {
            return Vec::new();
        };
        section
            .entries()
            .filter_map(|(name, value)| Some((name.to_owned(), section.as_coil(name, value)?)))
            .collect()
    }

    /// A table within this one.
    pub fn section(&self, key: &'static str) -> Option<Section<'r, 't>> {
        let value = self.value(key)?;
        self.as_section(self.path(key), value)
    }

    fn as_section(&self, name: String, value: &'r Spanned<DeValue<'t>>) -> Option<Section<'r, 't>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            self.reader.fault(
                value.span().start,
                format!("{name} is a table: [{name}] or {{ .. }}"),
            );
        }
        Some(Section::new(self.reader, name, value.span().start, table?))
    }

    /// The tables named by the user, as `[axis.X]` and `[axis.Y]`, in the order of the file.
    pub fn named_sections(&self, key: &'static str) -> Vec<(String, Section<'r, 't>)> {
        let Some(section) = self.section(key) else {
            return Vec::new();
        };
        section
            .entries()
            .filter_map(|(name, value)| {
                Some((name.to_owned(), section.as_section(section.path(name), value)?))
            })
            .collect()
    }

    /// One table, or the tables of a list: `[spindle]`, or several `[[spindle]]`.
    pub fn one_or_more(&self, key: &'static str) -> Vec<Section<'r, 't>> {
        match self.value(key).is_some_and(|value| value.get_ref().is_array()) {
            true => self.list(key),
            false => self.section(key).into_iter().collect(),
        }
    }

    /// The tables of a list, as several `[[spindle.gear]]`.
    pub fn list(&self, key: &'static str) -> Vec<Section<'r, 't>> {
        let Some(value) = self.value(key) else {
            return Vec::new();
        };
        let Some(list) = value.get_ref().as_array() else {
            let name = self.path(key);
            self.reader
                .fault(value.span().start, format!("{name} is a list: [[{name}]]"));
            return Vec::new();
        };
        let path = self.path(key);
        list.iter()
            .filter_map(|entry| self.as_section(path.clone(), entry))
            .collect()
    }

    /// Refuses all keys that were not asked for.
    pub fn finish(self) {
        let mut known = self.known.into_inner();
        known.sort_unstable();
        known.dedup();
        for (key, _) in self.table {
            let name: &str = key.get_ref();
            if !known.contains(&name) {
                let known = known.join(", ");
                let place = if self.name.is_empty() {
                    "here".to_owned()
                } else {
                    format!("in [{}]", self.name)
                };
                self.reader.fault(
                    key.span().start,
                    format!("unknown key `{name}` {place}; there are {known}"),
                );
            }
        }
    }
}

/// The output of the spindle, after 1 to 5.
const SPINDLE: usize = 5;

/// The place of a connector that is numbered from 1.
fn connector(text: &str, count: usize) -> Option<usize> {
    let digits = !text.starts_with('0') && text.bytes().all(|byte| byte.is_ascii_digit());
    let number = text.parse::<usize>().ok().filter(|_| digits)?;
    (number <= count).then(|| number.checked_sub(1))?
}

/// Letters of PLC inputs and outputs, the second ones as the TNC 151 and 155 write them [001:477-482].
pub(crate) const INPUT_LETTERS: [char; 2] = ['I', 'E'];
pub(crate) const OUTPUT_LETTERS: [char; 2] = ['O', 'A'];

/// `I12` or `not I12`.
fn operand(text: &str, letters: [char; 2], count: usize) -> Option<(usize, bool)> {
    let (inverted, plain) = match text.strip_prefix("not ") {
        Some(rest) => (true, rest.trim_start()),
        None => (false, text),
    };
    let digits = plain.strip_prefix(letters)?;
    if !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let number = digits.parse().ok().filter(|number| *number < count)?;
    Some((number, inverted))
}
