//! EDIT: a screen editor for the PLC's source files [000:11370-11384]. Each line is checked when it is left
//! [000:11925]; what was typed is on the medium before the next key.

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_plc::check_line;
use bahn_screen::{Line, Mark, WindowKind};

use super::form;
use super::source::{self, NotWritten, Source};
use crate::page::{Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::site::Site;

/// Its first row of soft keys; the others have [`CHARACTERS`].
const SOFT_KEYS: [&str; 8] = [
    "INSERT/OVERWRITE",
    "INSERT LINE",
    "DELETE LINE",
    "FIND",
    "GOTO",
    "PAGE UP",
    "PAGE DOWN",
    "END",
];
/// Characters of a line in the window, after its number.
const WIDTH: usize = 70;
/// Width of line numbers.
const NUMBER: usize = 6;
/// Characters of a word to look for at most.
const WORD_MAX: usize = 32;
/// Characters of a line at most: what is longer is no line of a program [000:11940].
const LINE_MAX: usize = 128;
/// Lines of a file at most.
const LINES_MAX: usize = 100_000;

/// Characters that the keyboard does not have, on soft keys.
const CHARACTERS: [&str; 16] = [
    "BLANK", "=", ";", "_", "+", ",", "#", "\"", "(", ")", "[", "]", "<", ">", "*", "/",
];

/// Editor of a source file of the PLC.
pub(super) struct Editor {
    name: String,
    source: Source,
    line: usize,
    /// Characters before the cursor.
    column: usize,
    overwrites: bool,
    /// The line under the cursor is not as it was.
    changed: bool,
    find: Later,
    goto: Later,
    word: String,
    /// What EXT does with the text, where it does something.
    output: Option<fn(&str, &Site) -> Turn>,
}

impl Editor {
    /// Opens a file at a line, from 1.
    ///
    /// # Errors
    /// In words.
    pub fn open(name: &str, line: usize, site: &mut Site) -> Result<Editor, String> {
        let mut source = Source::read(name, site)?;
        if source.lines.is_empty() {
            source.lines.push(String::new());
        }
        site.plc.edited = Some(name.to_owned());
        let last = source.lines.len() - 1;
        Ok(Editor {
            name: name.to_owned(),
            source,
            line: line.saturating_sub(1).min(last),
            column: 0,
            overwrites: false,
            changed: false,
            find: Later::default(),
            goto: Later::default(),
            word: String::new(),
            output: None,
        })
    }

    /// EXT puts the text out.
    pub fn with_output(self, output: fn(&str, &Site) -> Turn) -> Editor {
        Editor {
            output: Some(output),
            ..self
        }
    }

    fn current(&self) -> &str {
        self.source.lines.get(self.line).map_or("", String::as_str)
    }

    fn length(&self) -> usize {
        self.current().chars().count()
    }

    /// The byte before which the cursor stands.
    fn place(&self) -> usize {
        let text = self.current();
        text.char_indices()
            .nth(self.column)
            .map_or(text.len(), |(at, _)| at)
    }

    /// The line is left: it is checked when it has changed.
    fn leave(&mut self, site: &Site) -> Turn {
        if !std::mem::take(&mut self.changed) {
            return Turn::Done;
        }
        if !source::is_source(&self.name) {
            return Turn::Done;
        }
        match check_line(self.current(), site.control().model()) {
            Ok(()) => {
                self.format(site);
                Turn::Done
            }
            Err(error) => Turn::Say(format!("{} {error}", site.words("INPUT ERROR"))),
        }
    }

    /// A line without an error is set in columns [000:11925].
    fn format(&mut self, site: &Site) {
        let new = form::formatted(self.current());
        let is_same = check_line(&new, site.control().model()).is_ok() && new.chars().count() <= LINE_MAX;
        if let Some(line) = self.source.lines.get_mut(self.line).filter(|_| is_same) {
            *line = new;
        }
    }

    /// What a key has changed is on the medium before the next one.
    fn stored(&mut self, turn: Turn, site: &Site) -> Turn {
        match self.source.write() {
            Ok(()) => turn,
            // What is not on the medium is not left.
            Err(NotWritten::Words(why)) => Turn::Say(why),
            Err(NotWritten::Changed) => {
                self.renewed(site.words("FILE WAS CHANGED OUTSIDE, AND IS READ AGAIN"))
            }
            Err(NotWritten::Protected) => self.renewed(site.message(MessageId::ProtectedPgm)),
        }
    }

    /// The text is what lies on the medium, which is said.
    fn renewed(&mut self, said: String) -> Turn {
        let renewed = self.source.renew();
        self.changed = false;
        self.go_to(self.line);
        Turn::Say(match renewed {
            Ok(()) => said,
            Err(why) => why,
        })
    }

    fn go_to(&mut self, line: usize) {
        if self.source.lines.is_empty() {
            self.source.lines.push(String::new());
        }
        self.line = list::moved(line, 0, self.source.lines.len());
        self.column = self.column.min(self.length());
    }

    fn go(&mut self, lines: isize, site: &Site) -> Turn {
        let turn = self.leave(site);
        self.go_to(self.line.saturating_add_signed(lines));
        turn
    }

    fn put(&mut self, character: char) -> bool {
        let replaces = self.overwrites && self.column < self.length();
        if self.length() >= LINE_MAX && !replaces {
            return false;
        }
        let at = self.place();
        let Some(line) = self.source.lines.get_mut(self.line) else {
            return false;
        };
        if replaces {
            line.remove(at);
        }
        line.insert(at, character);
        self.column += 1;
        self.changed = true;
        true
    }

    /// What stands after the cursor becomes a line of its own.
    fn split(&mut self, site: &Site) -> Turn {
        if self.source.lines.len() >= LINES_MAX {
            return Turn::Refused;
        }
        let at = self.place();
        let Some(line) = self.source.lines.get_mut(self.line) else {
            return Turn::Refused;
        };
        let rest = line.split_off(at);
        self.source.lines.insert(self.line + 1, rest);
        self.changed = true;
        let turn = self.leave(site);
        self.column = 0;
        self.go_to(self.line + 1);
        turn
    }

    /// Takes the character before the cursor away, or joins the line with the one before.
    fn back(&mut self) {
        if self.column > 0 {
            self.column -= 1;
            self.delete();
        } else if self.line > 0 && self.line < self.source.lines.len() {
            let rest = self.source.lines.remove(self.line);
            self.line -= 1;
            self.column = self.length();
            if let Some(line) = self.source.lines.get_mut(self.line) {
                line.push_str(&rest);
            }
            self.changed = true;
        }
    }

    /// Takes the character under the cursor away.
    fn delete(&mut self) {
        if self.column >= self.length() {
            return;
        }
        let at = self.place();
        if let Some(line) = self.source.lines.get_mut(self.line) {
            line.remove(at);
            self.changed = true;
        }
    }

    fn delete_line(&mut self, site: &Site) -> Turn {
        if self.line < self.source.lines.len() {
            self.source.lines.remove(self.line);
        }
        self.go_to(self.line);
        self.changed = true;
        self.leave(site)
    }

    fn insert_line(&mut self, site: &Site) -> Turn {
        self.column = self.length();
        self.split(site)
    }

    /// The next line that has the word, from the one behind the cursor on and around.
    fn search(&mut self, site: &Site) -> Turn {
        let turn = self.leave(site);
        let (count, word) = (self.source.lines.len(), self.word.to_uppercase());
        let mut order = (1..=count).map(|way| (self.line + way) % count);
        let has = |place: &usize| {
            let line = self.source.lines.get(*place);
            line.is_some_and(|line| line.to_uppercase().contains(&word))
        };
        match order.find(has) {
            Some(place) => {
                self.column = 0;
                self.go_to(place);
                turn
            }
            None => Turn::Say(site.words("NOT FOUND")),
        }
    }

    fn function(&mut self, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "INSERT/OVERWRITE" => {
                self.overwrites = !self.overwrites;
                Turn::Done
            }
            "INSERT LINE" => self.insert_line(site),
            "DELETE LINE" => self.delete_line(site),
            "FIND" => self.find.ask(site.words("FIND ="), WORD_MAX),
            "GOTO" => self.goto.ask(site.words("GOTO: LINE ="), NUMBER),
            name => match list::way_of(name) {
                Some(lines) => self.go(lines, site),
                None => self.finish(site),
            },
        }
    }

    fn finish(&mut self, site: &mut Site) -> Turn {
        let left = self.leave(site);
        // Texts in use stand there at once.
        let renewed = match super::texts::is_active(&self.name, site) {
            true => super::texts::renew(site),
            false => Ok(()),
        };
        match (left, renewed) {
            (Turn::Say(text), _) | (_, Err(text)) => Turn::CloseSaying(text),
            _ => Turn::Close,
        }
    }

    fn pressed(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines, site);
        }
        match key {
            Key::Left => self.column = self.column.saturating_sub(1),
            Key::Right => self.column = (self.column + 1).min(self.length()),
            Key::Ent => return self.split(site),
            Key::Ce => self.back(),
            Key::Del => self.delete(),
            Key::Goto => return self.goto.ask(site.words("GOTO: LINE ="), NUMBER),
            Key::End => return self.finish(site),
            Key::Ext => {
                let text = self.source.lines.join("\n");
                return self.output.map_or(Turn::Refused, |output| output(&text, site));
            }
            key => match key.character() {
                Some(character) if self.put(character) => {}
                _ => return Turn::Refused,
            },
        }
        Turn::Done
    }

    fn soft_pressed(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        let Some(row) = row.checked_sub(1) else {
            return self.function(place, site);
        };
        let character = match CHARACTERS.get(row * 8 + place) {
            Some(&"BLANK") => Some(' '),
            name => name.and_then(|name| name.chars().next()),
        };
        match character {
            Some(character) if self.put(character) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn shown(&self, place: usize, text: &str) -> Line {
        let current = place == self.line;
        // A long line moves to the left under its cursor.
        let first = if current {
            self.column.saturating_sub(WIDTH - 1)
        } else {
            0
        };
        let visible: String = text.chars().skip(first).take(WIDTH).collect();
        let at = NUMBER + 1 + self.column - first.min(self.column);
        Line {
            text: format!("{:>NUMBER$} {visible}", place + 1),
            current,
            marks: match current {
                true => vec![(at, at + 1, Mark::Cursor)],
                false => Vec::new(),
            },
        }
    }
}

impl Page for Editor {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        let turn = self.pressed(key, site);
        self.stored(turn, site)
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let names = CHARACTERS.map(|name| match name {
            "BLANK" => site.words("BLANK"),
            name => name.to_owned(),
        });
        let rows = names.chunks(8).map(<[String]>::to_vec);
        std::iter::once(list::soft_keys(&SOFT_KEYS, site))
            .chain(rows)
            .collect()
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        let turn = self.soft_pressed(row, place, site);
        self.stored(turn, site)
    }

    /// What is pasted is typed; its ends of lines are those of lines.
    fn text(&mut self, text: &str, site: &mut Site) -> Turn {
        let (overwrites, mut turn) = (std::mem::take(&mut self.overwrites), Turn::Done);
        for (place, line) in text.lines().enumerate() {
            if place > 0 {
                turn = self.split(site);
            }
            let typed = line.chars().map(|c| if c == '\t' { ' ' } else { c });
            if !typed.filter(|c| !c.is_control()).all(|c| self.put(c)) {
                turn = Turn::Say(site.message(MessageId::EntryValueIncorrect));
            }
        }
        self.overwrites = overwrites;
        self.stored(turn, site)
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let line = |place| {
            let text = self.source.lines.get(place);
            self.shown(place, text.map_or("", String::as_str))
        };
        let mode = match self.overwrites {
            true => site.words("OVERWRITE"),
            false => site.words("INSERT"),
        };
        let title = format!(
            "{} {}  {} {}  {} {}  {mode}",
            site.words("FILE"),
            self.name,
            site.words("LINE"),
            self.line + 1,
            site.words("COLUMN"),
            self.column + 1
        );
        let cursor = (self.line, self.source.lines.len());
        View::of(list::window(title, WindowKind::Text, cursor, lines, line))
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        if let Some(word) = self.find.take() {
            self.word = word;
            return self.search(site);
        }
        let Some(text) = self.goto.take() else {
            return Turn::Done;
        };
        match text.parse::<usize>() {
            Ok(line) if line > 0 => {
                let turn = self.leave(site);
                self.go_to(line - 1);
                turn
            }
            _ => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }
}
