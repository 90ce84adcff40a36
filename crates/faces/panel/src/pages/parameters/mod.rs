//! The machine parameter editor: the whole list (95 148), those of the operator (123), USER PARAMETERS [000:9969-10065].
//!
//! What is entered is checked against the list; END writes the file with its comments and lets the control take over what has
//! changed, with the reset or the reference run that it needs. A list that is empty or has faults is presented when the
//! control is switched on, and END goes on when it is whole [000:10011] [000:10050-10066].
//!
//! Decision: The machine parameter editor writes the list, then gives the control what has changed: what acts at
//! once, then what needs the reference marks, then what needs a reset; DEL leaves it without
//!
//! Decision: A line of a list that names no parameter stands before the others, and DEL takes it away; one with an
//! incorrect entry is the line of its parameter

mod file;
mod lists;
mod user;

use bahn_dialogue::Key;
use bahn_parameters::operation::UserParameter;
use bahn_parameters::{Definition, ListError, MessageId, ParameterList, Reaction};
use bahn_screen::{Dialogue, Line, Mark, WindowKind};
use bahn_tnc::Command;

use crate::page::{Overlay, Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::external::{self, Own};
use crate::pages::{interface, list};
use crate::site::Site;
use crate::transfer::TransferFiles;
use file::{Entered, ListFile, Refused};
use user::dialogue_of;

/// What EXT transfers: the lists of the machine.
const LISTS: Own = Own {
    files: TransferFiles::Lists,
    names: |site| file::names(site).iter().map(|name| name.to_uppercase()).collect(),
    named: |name, _| match name.contains('.') {
        true => name.to_owned(),
        false => format!("{name}.MP"),
    },
};

/// Characters of a value at most: a sign, 32 binary digits, blanks.
const VALUE_MAX: usize = 40;
/// Lines below the list: what the value under the cursor means.
const MEANING: usize = 4;
const SOFT_KEYS: [&str; 8] = ["%", "$", "PAGE UP", "PAGE DOWN", "FIND", ";", "QUIT", "END"];
/// Characters of a comment at most (inferred).
const COMMENT_MAX: usize = 60;

/// A line of the editor.
struct Row {
    /// The parameter; `None` of a line that names none, or has one that has its value elsewhere.
    definition: Option<&'static Definition>,
    /// The dialogue of the machine builder (MP7340).
    dialogue: Option<String>,
    /// Why it cannot be read, and what stands in the file.
    fault: Option<(ListError, String)>,
}

impl Row {
    fn of(definition: &'static Definition) -> Row {
        Row {
            definition: Some(definition),
            dialogue: None,
            fault: None,
        }
    }
}

/// Editor of a list of machine parameters.
struct Parameters {
    title: String,
    /// Which parameters are shown.
    rows: Vec<Row>,
    list: ParameterList,
    file: ListFile,
    entered: Entered,
    /// A list may have come over a data interface.
    exchanged: bool,
    /// The control goes on when the list is whole, and not before.
    commissions: bool,
    current: usize,
    entry: Option<String>,
    comment: Later,
    goto: Later,
    find: Later,
    /// Name of another list, which is to be edited.
    chosen: Later,
}

/// The whole list, at power-on: its first fault has the cursor.
///
/// # Errors
/// In words: the file cannot be read.
pub(crate) fn commission(site: &Site) -> Result<Box<dyn Page>, String> {
    let machine = site.machine;
    let name = machine
        .to_be_entered
        .as_ref()
        .unwrap_or(&machine.folder.parameters)
        .clone();
    let rows = Definition::all(site.control().model()).iter().map(Row::of);
    let mut editor = Parameters::new(rows.collect(), ListFile::new(name, site), site);
    editor.commissions = true;
    editor.read(site)?;
    editor.go_to_fault();
    Ok(Box::new(editor))
}

/// The memory of the machine parameters of a TNC 151/155 is empty [001:2489-2493].
pub(crate) fn is_erased(site: &Site) -> bool {
    let machine = site.machine;
    let name = machine
        .to_be_entered
        .as_ref()
        .unwrap_or(&machine.folder.parameters);
    let text = ListFile::new(name.clone(), site).with(&Entered::default(), site);
    site.control().model().erases_its_list() && text.is_ok_and(|text| text.entries().is_empty())
}

/// Opens the editor with all parameters of the list.
pub(crate) fn all(site: &Site) -> Turn {
    editor(site, |_| true)
}

/// What the manual lets the operator change.
pub(crate) fn of_code(site: &Site) -> Turn {
    editor(site, |definition| definition.user)
}

/// Up to sixteen that the machine builder has chosen, with his dialogues [000:6907-6926] [001:1299-1334].
pub(crate) fn user(site: &Site) -> Turn {
    let list = site.parameters();
    let row = |own: UserParameter| {
        let definition = Definition::named(list.model(), own.id).ok()?;
        let control = site.control();
        Some(Row {
            dialogue: dialogue_of(own.text, control.plc_dialogues(), control.plc_messages()),
            ..Row::of(definition)
        })
    };
    let rows: Vec<Row> = list.user_parameters().into_iter().filter_map(row).collect();
    opened(rows, site)
}

fn editor(site: &Site, is_meant: impl Fn(&Definition) -> bool) -> Turn {
    let all = Definition::all(site.parameters().model()).iter();
    let rows = all.filter(|definition| is_meant(definition)).map(Row::of);
    opened(rows.collect(), site)
}

/// Parameters are edited while no program runs.
fn opened(rows: Vec<Row>, site: &Site) -> Turn {
    if !site.is_idle() {
        return Turn::Say(site.message(MessageId::KeyNonFunctional));
    }
    if rows.is_empty() {
        return Turn::Say(site.words("NO USER PARAMETERS"));
    }
    let editor = Parameters::new(rows, ListFile::new(file::in_force(site), site), site);
    Turn::Open(Box::new(editor))
}

impl Parameters {
    fn new(rows: Vec<Row>, file: ListFile, site: &Site) -> Parameters {
        Parameters {
            title: site.words("MACHINE PARAMETERS"),
            rows,
            list: site.parameters().clone(),
            file,
            entered: Entered::default(),
            exchanged: false,
            commissions: false,
            current: 0,
            entry: None,
            comment: Later::default(),
            goto: Later::default(),
            find: Later::default(),
            chosen: Later::default(),
        }
    }

    /// Shows what stands in the file. Lines that belong to no parameter come first.
    fn read(&mut self, site: &Site) -> Result<(), String> {
        let text = self.file.with(&self.entered, site)?;
        self.list = ParameterList::reference(text.model()).with_equipment(self.list.equipment());
        self.list.take(&text);
        self.rows.retain(|row| row.definition.is_some());
        let found = |fault: &ListError| (fault.clone(), text.line(fault.span.line as usize));
        for row in &mut self.rows {
            let fault = row.definition.and_then(|own| text.fault_of(own.id));
            row.fault = fault.map(found);
        }
        let strangers = text.faults().iter().filter(|fault| !self.has(fault));
        let strangers = strangers.map(|fault| Row {
            definition: None,
            dialogue: None,
            fault: Some(found(fault)),
        });
        let strangers: Vec<Row> = strangers.collect();
        self.rows.splice(0..0, strangers);
        self.current = self.current.min(self.rows.len().saturating_sub(1));
        Ok(())
    }

    /// A fault stands at the line of its parameter.
    fn has(&self, fault: &ListError) -> bool {
        let mut rows = self.rows.iter();
        rows.any(|row| row.fault.as_ref().is_some_and(|(own, _)| own == fault))
    }

    /// The cursor goes to the first line of the file that cannot be read; whether there is one.
    fn go_to_fault(&mut self) -> bool {
        let line = |row: &Row| Some(row.fault.as_ref()?.0.span.line);
        let faults = self.rows.iter().enumerate();
        let faults = faults.filter_map(|(place, row)| Some((line(row)?, place)));
        let first = faults.min();
        if let Some((_, place)) = first {
            self.current = place;
        }
        first.is_some()
    }

    fn row(&self) -> Option<&Row> {
        self.rows.get(self.current)
    }

    /// The parameter under the cursor; a line that names none has none.
    fn definition(&self) -> Option<&'static Definition> {
        self.row().and_then(|row| row.definition)
    }

    /// The value of a parameter as it is best written.
    fn value(&self, definition: &Definition) -> String {
        let id = definition.id;
        let value = self.list.get(id.number, id.index.unwrap_or(0));
        definition.format_value(value.unwrap_or_default())
    }

    /// Takes what was entered, when the list allows it.
    fn take(&mut self, site: &Site) -> Turn {
        let Some(entry) = self.entry.clone() else {
            return Turn::Done;
        };
        let Some(id) = self.definition().map(|own| own.id) else {
            return Turn::Refused;
        };
        // A comment may stand after the value, or alone.
        let (value, comment) = match entry.split_once(';') {
            Some((value, comment)) => (value.trim(), Some(comment.trim())),
            None => (entry.as_str(), None),
        };
        if let Some(comment) = comment {
            self.entered.comments.insert(id, comment.to_owned());
            if value.is_empty() {
                self.entry = None;
                return Turn::Done;
            }
        }
        match self.list.assign(&format!("{id}={value}")) {
            Ok(_) => {
                let value = self.list.get(id.number, id.index.unwrap_or(0));
                self.entered.values.insert(id, value.unwrap_or_default());
                self.entry = None;
                if let Some(row) = self.rows.get_mut(self.current) {
                    row.fault = None;
                }
                Turn::Done
            }
            Err(error) => Turn::Say(said(&error, site)),
        }
    }

    /// DEL takes a line away that belongs to no parameter.
    fn remove(&mut self) -> Turn {
        let stranger = self.row().filter(|row| row.definition.is_none());
        let Some((fault, text)) = stranger.and_then(|row| row.fault.clone()) else {
            return match self.commissions {
                true => Turn::Refused,
                false => Turn::Close,
            };
        };
        self.entered.removed.insert(fault.span.line as usize, text);
        self.rows.remove(self.current);
        Turn::Done
    }

    /// Goes on when what was entered is taken: it belongs to the line and the list in which it was entered.
    fn taken<'s>(
        &mut self,
        site: &mut Site<'s>,
        on: impl FnOnce(&mut Parameters, &mut Site<'s>) -> Turn,
    ) -> Turn {
        match self.take(site) {
            Turn::Done => on(self, site),
            turn => turn,
        }
    }

    fn go(&mut self, rows: isize) -> Turn {
        self.current = list::moved(self.current, rows, self.rows.len());
        Turn::Done
    }

    /// Another list than the control has: it was selected, or came over a data interface meanwhile.
    fn is_other(&self, site: &Site) -> bool {
        self.file.name != file::in_force(site) || self.file.was_written()
    }

    /// END: the list is checked as a whole, written and taken over.
    fn finish(&mut self, site: &mut Site) -> Turn {
        let is_other = self.is_other(site);
        if self.entered.is_empty() && !is_other && !self.commissions {
            return Turn::Close;
        }
        let list = match self.store(site) {
            Ok(list) => list,
            Err(turn) => return turn,
        };
        if !self.act(&list, is_other, site) {
            return Turn::Say(site.message(MessageId::KeyNonFunctional));
        }
        let own = |id| self.entered.values.contains_key(&id);
        match list.inconsistencies().iter().find(|found| own(found.id)) {
            Some(found) => Turn::CloseSaying(format!("{}: {}", found.id, found.rule)),
            None => Turn::Close,
        }
    }

    /// The list with what was entered is checked and on the medium; else what is to be said. A faulty list is not
    /// written: no control is switched on with it.
    fn store(&mut self, site: &mut Site) -> Result<ParameterList, Turn> {
        if !site.is_idle() {
            return Err(Turn::Say(site.message(MessageId::KeyNonFunctional)));
        }
        let mut text = self.file.with(&self.entered, site).map_err(Turn::Say)?;
        // A list without any entry becomes the one that the control makes by itself: a programming station
        // [000:10066-10070].
        if self.commissions && text.entries().is_empty() && text.faults().is_empty() {
            text.complete();
        }
        let list = self.file.check(&text, site).map_err(|refused| match refused {
            Refused::Words(why) => Turn::Say(why),
            Refused::Line(fault) => self.refused(&fault, site),
        })?;
        self.file.write(&text).map_err(Turn::Say)?;
        Ok(list)
    }

    /// The list that was written goes into effect, as a whole where it is another one than the control has; `false` when
    /// that is not possible now.
    fn act(&self, list: &ParameterList, is_other: bool, site: &mut Site) -> bool {
        match (self.commissions, is_other) {
            (true, _) => true,
            (false, true) => self.file.put_into_effect(list.clone(), site),
            (false, false) => self.take_over(site),
        }
    }

    /// A line that cannot be read is said, and has the cursor.
    fn refused(&mut self, fault: &ListError, site: &Site) -> Turn {
        if let Err(why) = self.read(site) {
            return Turn::Say(why);
        }
        self.go_to_fault();
        Turn::Say(format!("{}: {}", fault.span.line, said(&fault.error, site)))
    }

    /// Another list is edited from now on. The one before is left as with END; one that is not in force is written, and
    /// goes into no effect.
    fn edit_other(&mut self, name: String, site: &mut Site) -> Turn {
        if !self.entered.is_empty() {
            let was_written = self.file.was_written();
            let list = match self.store(site) {
                Ok(list) => list,
                Err(turn) => return turn,
            };
            if self.file.name == file::in_force(site) && !self.act(&list, was_written, site) {
                return Turn::Say(site.message(MessageId::KeyNonFunctional));
            }
        }
        self.file = ListFile::new(name, site);
        self.entered = Entered::default();
        match self.read(site) {
            Ok(()) if self.go_to_fault() => Turn::Done,
            Ok(()) => {
                self.current = 0;
                Turn::Done
            }
            Err(why) => Turn::Say(why),
        }
    }

    /// The control takes over what has changed: at once, with the reference marks, with a reset, in this order. `false`
    /// when it refuses something.
    fn take_over(&self, site: &mut Site) -> bool {
        let mut changed: Vec<&Definition> = self
            .entered
            .values
            .keys()
            .filter_map(|id| Definition::named(self.list.model(), *id).ok())
            .collect();
        changed.sort_by_key(|definition| match definition.reaction {
            Reaction::None => 0,
            Reaction::ReferenceMarks => 1,
            Reaction::Reset => 2,
        });
        let taken = |definition: &&Definition| {
            let text = format!("{}={}", definition.id, self.value(definition));
            let command = text.parse::<Command>();
            command.is_ok_and(|command| site.command(command))
        };
        changed.iter().map(taken).fold(true, |all, taken| all & taken)
    }

    /// GOTO goes to a number, or the next greater one.
    fn goto(&mut self, text: &str) -> bool {
        let (number, index) = text.split_once('.').unwrap_or((text, "0"));
        let (Ok(number), Ok(index)) = (number.parse::<u16>(), index.parse::<u8>()) else {
            return false;
        };
        let from = (number, index);
        let key = |row: &Row| {
            let id = row.definition?.id;
            Some((id.number, id.index.unwrap_or(0)))
        };
        let found = self.rows.iter().position(|row| key(row) >= Some(from));
        self.current = found.unwrap_or(self.rows.len().saturating_sub(1));
        true
    }

    /// FIND goes to the next line that has a word in its name.
    fn find(&mut self, word: &str) -> bool {
        let word = word.to_lowercase();
        let count = self.rows.len();
        let order = (1..=count).map(|way| (self.current + way) % count.max(1));
        let has = |place: &usize| {
            let row = self.rows.get(*place);
            let definition = row.and_then(|row| row.definition);
            definition.is_some_and(|own| own.name.to_lowercase().contains(&word))
        };
        let found = order.into_iter().find(has);
        if let Some(place) = found {
            self.current = place;
        }
        found.is_some()
    }

    fn typed(&mut self, key: Key) -> Turn {
        let entry = self.entry.clone().unwrap_or_default();
        let hexadecimal = entry.starts_with('$');
        let character = match key {
            Key::Sign => {
                let other = match entry.strip_prefix('-') {
                    Some(rest) => rest.to_owned(),
                    None => format!("-{entry}"),
                };
                self.entry = Some(other);
                return Turn::Done;
            }
            Key::Point => '.',
            key => match key.character() {
                Some(digit) if digit.is_ascii_digit() => digit,
                Some(letter @ 'A'..='F') if hexadecimal => letter,
                _ => return Turn::Refused,
            },
        };
        if entry.len() >= VALUE_MAX {
            return Turn::Refused;
        }
        self.entry = Some(format!("{entry}{character}"));
        Turn::Done
    }

    /// A binary or hexadecimal number begins.
    fn radix(&mut self, sign: char) -> Turn {
        let digits: String = self.entry.take().unwrap_or_default();
        let digits = digits.trim_start_matches(['%', '$', '-']);
        self.entry = Some(format!("{sign}{digits}"));
        Turn::Done
    }

    /// What is shown of a value: what is typed, what stands in the file and cannot be read, or what it is.
    fn shown(&self, place: usize, row: &Row, definition: &Definition) -> String {
        let entry = self.entry.as_ref().filter(|_| place == self.current);
        match (entry, &row.fault) {
            (Some(entry), _) => entry.clone(),
            (None, Some((fault, text))) => {
                let wrong = text.chars().skip((fault.span.column as usize).saturating_sub(1));
                wrong.take(fault.span.length as usize).collect()
            }
            (None, None) => self.value(definition),
        }
    }

    fn line(&self, place: usize, row: &Row) -> Line {
        let current = place == self.current;
        let Some(definition) = row.definition else {
            let (line, text) = row
                .fault
                .as_ref()
                .map_or((0, ""), |(fault, text)| (fault.span.line, text));
            let text = format!("{line:>5}: {text}");
            return Line {
                marks: match current {
                    true => vec![(7, text.chars().count(), Mark::Cursor)],
                    false => Vec::new(),
                },
                text,
                current,
            };
        };
        let shown = self.shown(place, row, definition);
        let mut text = match &row.dialogue {
            Some(dialogue) => format!("{dialogue:<34}: {shown}"),
            None => definition.line(&shown),
        };
        let id = definition.id;
        if self.entered.values.contains_key(&id) || self.entered.comments.contains_key(&id) {
            text.push_str(" *");
        }
        if let Some(comment) = self.entered.comments.get(&id) {
            text.push_str(&format!(" ; {comment}"));
        }
        let from = text
            .find(": ")
            .map_or(0, |at| text.chars().take(at + 2).count().min(at + 2));
        let mark = if current && self.entry.is_some() {
            Mark::Entry
        } else {
            Mark::Cursor
        };
        Line {
            marks: match current {
                true => vec![(from, from + shown.chars().count(), mark)],
                false => Vec::new(),
            },
            text,
            current,
        }
    }

    /// What is wrong with the line under the cursor, else what its value means, and its range.
    fn meaning(&self, site: &Site) -> Vec<Line> {
        let Some(row) = self.row() else {
            return Vec::new();
        };
        let wrong = row.fault.as_ref().map(|(fault, _)| said(&fault.error, site));
        let own = row.definition.map(|definition| {
            let id = definition.id;
            let value = self.list.get(id.number, id.index.unwrap_or(0));
            let range = definition.range_text().map(|[least, greatest]| {
                format!("{}: {least} .. {greatest} {}", definition.name, definition.unit)
            });
            let means = match row.fault {
                Some(_) => Vec::new(),
                None => definition.meaning(value.unwrap_or_default()),
            };
            range.into_iter().chain(means)
        });
        let lines = wrong.into_iter().chain(own.into_iter().flatten());
        let quiet = |text: String| Line {
            marks: vec![(0, text.chars().count(), Mark::Quiet)],
            text,
            current: false,
        };
        lines.take(MEANING).map(quiet).collect()
    }
}

/// An entry error with its number, as the control shows it [000:10052-10062].
fn said(error: &bahn_parameters::ParameterError, site: &Site) -> String {
    let text = bahn_screen::texts::translate(site.language(), error.control_text());
    format!("{} {text}: {error}", error.number())
}

impl Page for Parameters {
    fn overlay(&self) -> Overlay {
        Overlay::Parameters
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Up => self.taken(site, |own, _| own.go(-1)),
            Key::Down | Key::Ent => self.taken(site, |own, _| own.go(1)),
            Key::End => self.taken(site, Parameters::finish),
            Key::Ce | Key::NoEnt | Key::Del if self.entry.is_some() => {
                self.entry = None;
                Turn::Done
            }
            Key::Del => self.remove(),
            Key::PgmNr => self.taken(site, |own, site| lists::ask(&own.file.name, &own.chosen, site)),
            Key::Ext => self.taken(site, |own, site| {
                own.exchanged = true;
                external::of(LISTS, site)
            }),
            Key::Mod => Turn::Open(interface::with_backup()),
            Key::Goto => self.taken(site, |own, site| own.goto.ask(site.words("GOTO: NUMBER ="), 8)),
            key => self.typed(key),
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "%" => self.radix('%'),
            "$" => self.radix('$'),
            "FIND" => self.taken(site, |own, site| own.find.ask(site.words("FIND ="), 24)),
            // A comment belongs to a parameter.
            ";" if self.definition().is_none() => Turn::Refused,
            ";" => self.comment.ask(";".to_owned(), COMMENT_MAX),
            "QUIT" if self.commissions => Turn::Refused,
            "QUIT" => Turn::Close,
            name => match list::way_of(name) {
                Some(rows) => self.taken(site, |own, _| own.go(rows)),
                None => self.taken(site, Parameters::finish),
            },
        }
    }

    fn text(&mut self, text: &str, _site: &mut Site) -> Turn {
        let fits = |character: char| character.is_ascii_hexdigit() || "%$-. ".contains(character);
        let (value, comment) = text.split_once(';').unwrap_or((text, ""));
        let is_short = value.len() <= VALUE_MAX && comment.chars().count() <= COMMENT_MAX;
        if !is_short || !value.chars().all(fits) {
            return Turn::Refused;
        }
        self.entry = Some(text.to_owned());
        Turn::Done
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let rows = lines.saturating_sub(MEANING);
        let line = |place| {
            let row = self.rows.get(place);
            row.map_or_else(Line::default, |row| self.line(place, row))
        };
        let cursor = (self.current, self.rows.len());
        let title = match self.file.name == site.machine.folder.parameters {
            true => self.title.clone(),
            false => format!("{}  {}", self.title, self.file.name),
        };
        let mut window = list::window(title, WindowKind::Table, cursor, rows, line);
        window.lines.extend(self.meaning(site));
        let asks = site.control().model().erases_its_list();
        let prompt = self.definition().map(|own| match asks {
            true => site
                .words("MACHINE PARAMETER {} ?")
                .replace("{}", &own.id.to_string()),
            false => format!("{} =", own.id),
        });
        View {
            window: Some(window),
            dialogue: Dialogue {
                prompt: prompt.unwrap_or_default(),
                entry: self.entry.clone().unwrap_or_default(),
                open: true,
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        if std::mem::take(&mut self.exchanged)
            && self.file.was_written()
            && let Err(why) = self.read(site)
        {
            return Turn::Say(why);
        }
        let gone = self.goto.take().is_some_and(|text| !self.goto(&text));
        let lost = self.find.take().is_some_and(|word| !self.find(&word));
        if let (Some(comment), Some(definition)) = (self.comment.take(), self.definition()) {
            self.entered.comments.insert(definition.id, comment);
        }
        if let Some(name) = self.chosen.take() {
            return self.edit_other(name, site);
        }
        match gone || lost {
            true => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
            false => Turn::Done,
        }
    }
}
