//! The text of a list: its lines with comments and order, and what can be read of them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use bahn_text::{MARK_BYTES, Span, utf8_or_latin};

use crate::definition::{parse_id, parse_number};
use crate::{ControlModel, Definition, ListError, ParameterError, ParameterId};

/// The text of a list of machine parameters. Reading it never fails and keeps every byte; a value can be
/// changed in its place, so that comments and order stay.
///
/// A line holds number, separator (`:`, `=` or blanks), value and, after a semicolon, a comment
/// [000:10017]. In a list of a TNC 151/155 a `P` behind the value gives it to the operator [001:1303-1307]. The value is decimal, `%` binary or `$` hexadecimal [000:10019-10046]. A line that starts
/// with `;` or `*` is a comment [001:2521-2523].
///
/// ```
/// use bahn_parameters::{ControlModel, ListText, ParameterId};
/// let mut text = ListText::from_bytes(ControlModel::Tnc415b, b"; mill\r\nMP7430 : 1.2   ;overlap\r\n");
/// text.set(ParameterId { number: 7430, index: None }, 0.9)?;
/// assert_eq!(text.to_bytes(), b"; mill\r\nMP7430 : 0.9   ;overlap\r\n");
/// # Ok::<(), bahn_parameters::ParameterError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ListText {
    model: ControlModel,
    /// The bytes, without the mark of UTF-8.
    bytes: Vec<u8>,
    has_mark: bool,
    /// Where each line begins.
    lines: Vec<usize>,
    entries: Vec<Entry>,
    faults: Vec<ListError>,
    /// How many faults were found beyond [`LISTED_MAX`].
    not_listed: usize,
}

/// Parameters that the operator may change, of a TNC 151/155 [001:1301].
pub(crate) const USERS_MAX: usize = 16;

/// Faults of a list that are kept: a file that is no list has one in each of a million lines.
const LISTED_MAX: usize = 1000;

/// A line of a list that holds a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The parameter that the line sets.
    pub id: ParameterId,
    /// Its value, in range and rounded to what is stored.
    pub value: f64,
    /// The operator may change it: `P` behind the value, TNC 151/155 [001:1303-1307].
    pub user: bool,
    /// Line of the text, from 1.
    pub line: usize,
    /// The bytes of the value.
    value_at: Range<usize>,
}

impl Entry {
    /// The bytes of the value in the text, a mark of UTF-8 not counted.
    pub fn value_at(&self) -> Range<usize> {
        self.value_at.clone()
    }
}

impl ListText {
    /// Reads a text for a control model.
    pub fn from_bytes(model: ControlModel, bytes: &[u8]) -> ListText {
        let plain = bytes.strip_prefix(MARK_BYTES);
        let mut text = ListText {
            model,
            bytes: plain.unwrap_or(bytes).to_vec(),
            has_mark: plain.is_some(),
            lines: Vec::new(),
            entries: Vec::new(),
            faults: Vec::new(),
            not_listed: 0,
        };
        text.read();
        text
    }

    /// The model that the text is read for.
    pub fn model(&self) -> ControlModel {
        self.model
    }

    /// The lines that hold a value, in their order. A parameter that is defined twice is here once, with
    /// its first value.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// What cannot be read, in the order of lines; the first thousand.
    pub fn faults(&self) -> &[ListError] {
        &self.faults
    }

    /// How many further lines cannot be read.
    pub fn not_listed(&self) -> usize {
        self.not_listed
    }

    /// What keeps the control from taking the list: what cannot be read, and every parameter of the model
    /// that is not defined [000:10050-10062]. A list without any entry has none of these: the control makes
    /// the standard list of it [000:10066]. Parameters of certain software versions may be missing.
    pub fn all_faults(&self) -> Vec<ListError> {
        let mut faults = self.faults.clone();
        if self.entries.is_empty() && faults.is_empty() {
            return faults;
        }
        let line = self.lines.len().max(1);
        // What has a line that cannot be read is not missing.
        let named: BTreeSet<ParameterId> = faults.iter().filter_map(|fault| fault.error.id()).collect();
        let missing = self
            .missing()
            .filter(|definition| !definition.is_optional() && !named.contains(&definition.id));
        faults.extend(missing.map(|definition| ListError {
            span: Span::new(line, 1, 0),
            error: ParameterError::NotDefined(definition.id),
        }));
        faults
    }

    /// The parameters of the model that the text does not define, in ascending order.
    pub fn missing(&self) -> impl Iterator<Item = &'static Definition> {
        let mut defined: Vec<ParameterId> = self.entries.iter().map(|entry| entry.id).collect();
        defined.sort_unstable();
        Definition::all(self.model)
            .iter()
            .filter(move |definition| defined.binary_search(&definition.id).is_err())
    }

    /// The bytes of the text.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mark = if self.has_mark { MARK_BYTES } else { &[] };
        [mark, &self.bytes].concat()
    }

    /// The text of a line, from 1, without its end; empty for a line that does not exist.
    pub fn line(&self, number: usize) -> String {
        let bytes = self.line_at(number).and_then(|at| self.bytes.get(at));
        let text = utf8_or_latin(bytes.unwrap_or_default());
        text.trim_end_matches(['\r', '\n']).to_owned()
    }

    /// The place of a value.
    pub(crate) fn span_of(&self, entry: &Entry) -> Span {
        let start = self.line_at(entry.line).map_or(0, |line| line.start);
        let count = |bytes: Range<usize>| {
            let part = self.bytes.get(bytes).unwrap_or_default();
            utf8_or_latin(part).chars().count()
        };
        let value = entry.value_at();
        Span::new(entry.line, count(start..value.start) + 1, count(value))
    }

    /// Sets a value in its place, or appends a line for it with its name. A line of the parameter that cannot be read
    /// gives way to it, and keeps its comment.
    ///
    /// # Errors
    /// When the model has no such parameter, or the value is outside its range.
    pub fn set(&mut self, id: ParameterId, value: f64) -> Result<(), ParameterError> {
        let definition = Definition::named(self.model, id)?;
        let value = definition.check(value)?;
        let written = definition.format_value(value);
        let entry = self.entries.iter().find(|entry| entry.id == definition.id);
        let unread = self.fault_of(definition.id).map(|fault| fault.span.line as usize);
        match (entry, unread) {
            (Some(entry), _) => self.replace(entry.value_at.clone(), &written),
            (None, Some(line)) => self.mend(line, definition, &written),
            (None, None) => {
                let end = self.line_end();
                self.end_last_line(end);
                self.append(definition, &written, end);
            }
        }
        self.read();
        Ok(())
    }

    /// What keeps the value of a parameter from being read: its line has no value, or one that it does not take.
    pub fn fault_of(&self, id: ParameterId) -> Option<&ListError> {
        let mut faults = self.faults.iter();
        faults.find(|fault| fault.error.entry_id() == Some(id))
    }

    /// Takes a line away, from 1, with its end.
    pub fn remove_line(&mut self, number: usize) {
        if let Some(at) = self.line_at(number) {
            self.bytes.drain(at);
            self.read();
        }
    }

    /// A line that cannot be read becomes one that sets a parameter; its comment and its end stay to the byte.
    fn mend(&mut self, number: usize, definition: &Definition, value: &str) {
        let Some(at) = self.line_at(number) else { return };
        let old = self.bytes.get(at.clone()).unwrap_or_default();
        let (length, new) = match old.iter().position(|byte| *byte == b';') {
            Some(comment) => (comment, format!("{:<9}: {value:<12} ", definition.id.to_string())),
            None => {
                let text = old.iter().rposition(|byte| !matches!(byte, b'\r' | b'\n'));
                (text.map_or(0, |last| last + 1), definition.line(value))
            }
        };
        self.bytes.splice(at.start..at.start + length, new.into_bytes());
    }

    /// The bytes of a line, from 1, with its end.
    fn line_at(&self, number: usize) -> Option<Range<usize>> {
        let start = *self.lines.get(number.checked_sub(1)?)?;
        Some(start..self.lines.get(number).copied().unwrap_or(self.bytes.len()))
    }

    /// The comment after a value, without its semicolon; empty where there is none [000:10017].
    pub fn comment(&self, id: ParameterId) -> String {
        let after = self.after(id).map(|at| {
            let text = utf8_or_latin(self.bytes.get(at).unwrap_or_default());
            text.split_once(';')
                .map_or_else(String::new, |(_, comment)| comment.trim().to_owned())
        });
        after.unwrap_or_default()
    }

    /// Writes a comment after the value of a parameter that the text defines; an empty one takes it away.
    pub fn set_comment(&mut self, id: ParameterId, comment: &str) {
        let Some(at) = self.after(id) else { return };
        let old = self.bytes.get(at.clone()).unwrap_or_default();
        // The column of the comment stays.
        let blanks = old.iter().take_while(|byte| **byte == b' ').count().max(1);
        let one_line: String = comment.chars().filter(|letter| !letter.is_control()).collect();
        let new = match one_line.trim() {
            "" => String::new(),
            words => format!("{}; {words}", " ".repeat(blanks)),
        };
        self.bytes.splice(at, new.into_bytes());
        self.read();
    }

    /// What stands in the line of a parameter after its value.
    fn after(&self, id: ParameterId) -> Option<Range<usize>> {
        let entry = self.entries.iter().find(|entry| entry.id == id)?;
        let start = entry.value_at.end;
        let rest = self.bytes.get(start..)?;
        let length = rest.iter().position(|byte| matches!(byte, b'\r' | b'\n'));
        Some(start..start + length.unwrap_or(rest.len()))
    }

    /// Appends every parameter that is missing with the value of the list that the control makes by itself
    /// [000:10066], after a comment that says so.
    pub fn complete(&mut self) {
        let missing: Vec<&Definition> = self.missing().collect();
        if missing.is_empty() {
            return;
        }
        let end = self.line_end();
        self.end_last_line(end);
        let heading = format!("{end}; Values of the list that the control makes by itself{end}");
        self.bytes.extend_from_slice(heading.as_bytes());
        for definition in missing {
            let value = definition.format_value(definition.standard());
            self.append(definition, &value, end);
        }
        self.read();
    }

    fn end_last_line(&mut self, end: &str) {
        if self.bytes.last().is_some_and(|byte| *byte != b'\n') {
            self.bytes.extend_from_slice(end.as_bytes());
        }
    }

    fn append(&mut self, definition: &Definition, value: &str, end: &str) {
        self.bytes.extend_from_slice(definition.line(value).as_bytes());
        self.bytes.extend_from_slice(end.as_bytes());
    }

    /// Replaces a value; the blanks after it give or take, so that the comment keeps its column.
    fn replace(&mut self, at: Range<usize>, value: &str) {
        let old = at.len();
        let blanks = self.bytes[at.end..]
            .iter()
            .take_while(|byte| **byte == b' ')
            .count();
        let comment_follows = self.bytes.get(at.end + blanks) == Some(&b';');
        let mut new = value.as_bytes().to_vec();
        let mut end = at.end;
        if comment_follows && value.len() < old {
            new.resize(old, b' ');
        } else if comment_follows && value.len() > old {
            // One blank stays before the comment.
            end += (value.len() - old).min(blanks.saturating_sub(1));
        }
        self.bytes.splice(at.start..end, new);
    }

    fn line_end(&self) -> &'static str {
        if self.bytes.windows(2).any(|pair| pair == b"\r\n") {
            "\r\n"
        } else {
            "\n"
        }
    }

    fn read(&mut self) {
        let mut first_lines = BTreeMap::new();
        let (mut lines, mut entries, mut faults) = (Vec::new(), Vec::new(), Vec::new());
        let (mut not_listed, mut users) = (0, 0);
        let mut list = |fault| match faults.len() < LISTED_MAX {
            true => faults.push(fault),
            false => not_listed += 1,
        };
        let mut start = 0;
        for (index, bytes) in self.bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
            lines.push(start);
            let line = index + 1;
            let text = utf8_or_latin(bytes);
            match read_line(self.model, &text) {
                Ok(None) => (),
                Ok(Some(found)) => match first_lines.get(&found.id) {
                    None => {
                        first_lines.insert(found.id, line);
                        users += usize::from(found.user_at.is_some());
                        let is_user = found.user_at.is_some() && users <= USERS_MAX;
                        if let Some(at) = found.user_at.filter(|_| users > USERS_MAX) {
                            let error = ParameterError::TooManyUserParameters(found.id);
                            list(fault(error, line, &text, at));
                        }
                        entries.push(Entry {
                            id: found.id,
                            value: found.value,
                            user: is_user,
                            line,
                            // What stands before a value that could be read is ASCII.
                            value_at: start + found.value_at.start..start + found.value_at.end,
                        });
                    }
                    Some(&first_line) => {
                        let error = ParameterError::DoublyDefined {
                            id: found.id,
                            first_line,
                        };
                        list(fault(error, line, &text, found.id_at));
                    }
                },
                Err((error, at)) => list(fault(error, line, &text, at)),
            }
            start += bytes.len();
        }
        self.lines = lines;
        self.entries = entries;
        self.faults = faults;
        self.not_listed = not_listed;
    }
}

fn fault(error: ParameterError, line: usize, text: &str, at: Range<usize>) -> ListError {
    let characters = |range: Range<usize>| text.get(range).map_or(0, |part| part.chars().count());
    ListError {
        span: Span::new(line, characters(0..at.start) + 1, characters(at)),
        error,
    }
}

/// A line or an assignment that could be read.
pub(crate) struct Assignment {
    pub id: ParameterId,
    pub value: f64,
    /// Where it is said that the operator may change it.
    pub user_at: Option<Range<usize>>,
    pub id_at: Range<usize>,
    pub value_at: Range<usize>,
}

/// Something wrong with a part of a line.
type Wrong = (ParameterError, Range<usize>);

/// Reads a line of a list; a comment or an empty line holds nothing.
fn read_line(model: ControlModel, line: &str) -> Result<Option<Assignment>, Wrong> {
    // Control characters frame lists on tape and interface.
    let is_frame = |c: char| c.is_whitespace() || c.is_control();
    let start = line.len() - line.trim_start_matches(is_frame).len();
    let end = line.trim_end_matches(is_frame).len().max(start);
    let end = line[start..end].find(';').map_or(end, |at| start + at);
    if line[start..end].trim().is_empty() || line[start..end].starts_with('*') {
        return Ok(None);
    }
    read_assignment(model, &line[..end], start).map(Some)
}

/// Reads `MP1010.0 : 10000`, `1010.0=10000` or `MP1010.0 10000` after the first bytes of a text.
pub(crate) fn read_assignment(model: ControlModel, text: &str, from: usize) -> Result<Assignment, Wrong> {
    let end = text.trim_end().len();
    let from = end - text[from..end].trim_start().len();
    let prefix = text
        .get(from..from + 2)
        .is_some_and(|mp| mp.eq_ignore_ascii_case("MP"));
    let after = if prefix { from + 2 } else { from };
    let number_at = end - text[after..end].trim_start().len();
    let is_number = |c: char| c.is_ascii_digit() || c == '.';
    let number_end = text[number_at..end]
        .find(|c| !is_number(c))
        .map_or(end, |at| number_at + at);
    let id_at = from..number_end;
    let id = parse_id(&text[from..number_end]).ok_or((ParameterError::NoNumber, from..end))?;

    let rest = end - text[number_end..end].trim_start().len();
    let separated = if text[rest..end].starts_with([':', '=']) {
        rest + 1
    } else {
        rest
    };
    let value_at = end - text[separated..end].trim_start().len()..end;
    let user_at = user_letter(model, &text[value_at.clone()]).map(|at| value_at.start + at..end);
    let value_end = user_at
        .as_ref()
        .map_or(end, |at| text[..at.start].trim_end().len());
    let value_at = value_at.start..value_end;
    let written = &text[value_at.clone()];
    let definition = Definition::named(model, id).map_err(|error| (error, id_at.clone()))?;
    let (value, value_at) = match read_value(written) {
        Ok(value) => (value, value_at),
        Err(length) => {
            let (first, after) = written.split_at(length);
            let after_at = value_end - after.trim_start().len()..value_end;
            return Err(if length == 0 {
                (
                    ParameterError::NotANumber(definition.id, written.to_owned()),
                    value_at,
                )
            } else {
                debug_assert!(parse_number(first).is_some());
                (
                    ParameterError::NoSeparator(definition.id, after.trim().to_owned()),
                    after_at,
                )
            });
        }
    };
    let value = definition
        .check(value)
        .map_err(|error| (error, value_at.clone()))?;
    Ok(Assignment {
        id: definition.id,
        value,
        user_at,
        id_at,
        value_at,
    })
}

/// Where the letter P stands behind a value, in a list of a TNC 151/155.
fn user_letter(model: ControlModel, written: &str) -> Option<usize> {
    let before = written.strip_suffix(['P', 'p'])?;
    let apart = before.ends_with(char::is_whitespace) && !before.trim().is_empty();
    (apart && model.limits().has_old_numbers()).then_some(before.len())
}

/// Reads a value; the error is the length of what could be read of it, 0 for nothing.
fn read_value(written: &str) -> Result<f64, usize> {
    // Groups of digits may stand apart, and apart from their sign, as in the manual's "%111 000" and "$ 38"
    // [000:10031-10038].
    let groups = || {
        written
            .starts_with(['%', '$'])
            .then(|| parse_number(&written.replace(' ', "")))
            .flatten()
    };
    if let Some(number) = parse_number(written).or_else(groups) {
        return Ok(number);
    }
    let first = written.split(char::is_whitespace).next().unwrap_or_default();
    Err(if parse_number(first).is_some() {
        first.len()
    } else {
        0
    })
}
