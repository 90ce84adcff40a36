//! TABLE: markers, inputs, outputs, timers, counters and numbers as they are now, to be set [000:11474-11476].

use bahn_dialogue::Key;
use bahn_exchange::signal::{self, SignalOperand};
use bahn_exchange::{Assignment, Bit, BitArea, Number, Operand, Size};
use bahn_parameters::MessageId;
use bahn_screen::{Dialogue, Line, Mark, WindowKind};
use bahn_tnc::Command;

use crate::page::{Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::site::Site;

/// Its first row of soft keys; the second has the areas.
const SOFT_KEYS: [&str; 8] = [
    "SET",
    "RESET",
    "HEX/DECIMAL",
    "GOTO",
    "PAGE UP",
    "PAGE DOWN",
    "",
    "END",
];
/// Characters of a value at most: a sign and ten digits.
const VALUE_MAX: usize = 11;
/// Characters of an operand at most.
const OPERAND_MAX: usize = 6;
/// Bytes of the PLC's memory.
const BYTES: u16 = 1024;

/// What a table has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Area {
    /// Inputs, outputs, markers and the like: 0 or 1.
    Bits(BitArea),
    /// Bytes, words or doublewords.
    Numbers(Size),
}

impl Area {
    /// In the order of the soft keys.
    const ALL: [Area; 8] = [
        Area::Bits(BitArea::M),
        Area::Bits(BitArea::I),
        Area::Bits(BitArea::O),
        Area::Bits(BitArea::T),
        Area::Bits(BitArea::C),
        Area::Numbers(Size::Byte),
        Area::Numbers(Size::Word),
        Area::Numbers(Size::Double),
    ];

    fn of(operand: Operand) -> Option<Area> {
        match operand {
            Operand::Bit(bit) => Some(Area::Bits(bit.area())),
            Operand::Number(number) => Some(Area::Numbers(number.size())),
            Operand::Text(_) => None,
        }
    }

    fn letter(self) -> char {
        match self {
            Area::Bits(area) => area.letter(),
            Area::Numbers(size) => size.letter(),
        }
    }

    fn operands(self) -> Vec<Operand> {
        match self {
            Area::Bits(area) => {
                let bits = (0..area.count()).filter_map(|number| Bit::new(area, number));
                bits.filter(|bit| bit.is_listed()).map(Operand::Bit).collect()
            }
            Area::Numbers(size) => (0..BYTES)
                .filter_map(|address| Number::new(size, address))
                .map(Operand::Number)
                .collect(),
        }
    }
}

/// Operands with their contents after the last scan.
pub(super) struct Table {
    area: Area,
    operands: Vec<Operand>,
    current: usize,
    entry: Option<String>,
    hexadecimal: bool,
    goto: Later,
}

impl Default for Table {
    fn default() -> Table {
        let [area, ..] = Area::ALL;
        Table {
            area,
            operands: area.operands(),
            current: 0,
            entry: None,
            hexadecimal: false,
            goto: Later::default(),
        }
    }
}

impl Table {
    fn select(&mut self, area: Area) {
        (self.area, self.operands) = (area, area.operands());
        (self.current, self.entry) = (0, None);
    }

    fn operand(&self) -> Option<Operand> {
        self.operands.get(self.current).copied()
    }

    fn go(&mut self, lines: isize) -> Turn {
        self.current = list::moved(self.current, lines, self.operands.len());
        self.entry = None;
        Turn::Done
    }

    /// `2045` of the table that is shown, or `W260` of any one.
    fn goto(&mut self, text: &str) -> bool {
        let named = match text.starts_with(|first: char| first.is_ascii_digit()) {
            true => format!("{}{text}", self.area.letter()),
            false => text.to_ascii_uppercase(),
        };
        let Ok(operand) = named.parse::<Operand>() else {
            return false;
        };
        let Some(area) = Area::of(operand) else {
            return false;
        };
        let operands = area.operands();
        let Some(place) = operands.iter().position(|own| *own == operand) else {
            return false;
        };
        (self.area, self.operands, self.current, self.entry) = (area, operands, place, None);
        true
    }

    /// Sets the operand under the cursor; a hexadecimal number begins with `$` there.
    fn set(&mut self, value: &str, site: &mut Site) -> Turn {
        let incorrect = |site: &Site| Turn::Say(site.message(MessageId::EntryValueIncorrect));
        let Some(operand) = self.operand() else {
            return Turn::Refused;
        };
        let is_number = matches!(operand, Operand::Number(_));
        let text = match (self.hexadecimal && is_number, value.strip_prefix('-')) {
            (false, _) => value.to_owned(),
            (true, None) => format!("${value}"),
            (true, Some(digits)) => format!("-${digits}"),
        };
        let Ok(content) = operand.content(&text) else {
            return incorrect(site);
        };
        self.entry = None;
        let assignment = Assignment::Operand(operand, content);
        let command = assignment.to_string().parse::<Command>();
        match command.is_ok_and(|command| site.command(command)) {
            true => Turn::Done,
            false => incorrect(site),
        }
    }

    fn typed(&mut self, key: Key) -> Turn {
        let mut entry = self.entry.clone().unwrap_or_default();
        match key.character() {
            Some('-') => match entry.strip_prefix('-') {
                Some(rest) => entry = rest.to_owned(),
                None => entry.insert(0, '-'),
            },
            Some(digit) if digit.is_ascii_digit() => entry.push(digit),
            Some(letter @ 'A'..='F') if self.hexadecimal => entry.push(letter),
            _ => return Turn::Refused,
        }
        if entry.len() > VALUE_MAX {
            return Turn::Refused;
        }
        self.entry = Some(entry);
        Turn::Done
    }

    fn line(&self, place: usize, operand: Operand, site: &Site) -> Line {
        let [decimal, hexadecimal, _] = operand.forms(&operand.read(site.control().exchange().plc()));
        let current = place == self.current;
        let entry = self.entry.clone().filter(|_| current);
        let is_hexadecimal = self.hexadecimal && !hexadecimal.is_empty();
        let mark = if entry.is_some() {
            Mark::Entry
        } else {
            Mark::Cursor
        };
        let value = entry.unwrap_or(if is_hexadecimal { hexadecimal } else { decimal });
        let name = format!("{:<8}", operand.to_string());
        let known = signal::named(match operand {
            Operand::Bit(bit) => SignalOperand::Bit(bit),
            Operand::Number(number) => SignalOperand::Number(number),
            Operand::Text(_) => return Line::default(),
        });
        let meaning = known.map_or("", |signal| signal.name);
        Line {
            text: format!("{name}{value:<13}{meaning}").trim_end().to_owned(),
            current,
            marks: match current {
                true => vec![(name.len(), name.len() + value.len(), mark)],
                false => Vec::new(),
            },
        }
    }
}

impl Page for Table {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines);
        }
        match key {
            Key::Ent => match self.entry.clone() {
                Some(entry) => self.set(&entry, site),
                None => self.go(1),
            },
            Key::Goto => self.goto.ask(site.words("GOTO: OPERAND ="), OPERAND_MAX),
            Key::Ce if self.entry.is_some() => {
                self.entry = None;
                Turn::Done
            }
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            key => self.typed(key),
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let areas = Area::ALL.iter().map(|area| area.letter().to_string());
        vec![list::soft_keys(&SOFT_KEYS, site), areas.collect()]
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        if row == 1 {
            if let Some(area) = Area::ALL.get(place) {
                self.select(*area);
            }
            return Turn::Done;
        }
        match list::name_at(&SOFT_KEYS, place) {
            "SET" | "RESET" if !matches!(self.operand(), Some(Operand::Bit(_))) => Turn::Refused,
            "SET" => self.set("1", site),
            "RESET" => self.set("0", site),
            "HEX/DECIMAL" => {
                self.hexadecimal = !self.hexadecimal;
                self.entry = None;
                Turn::Done
            }
            "GOTO" => self.goto.ask(site.words("GOTO: OPERAND ="), OPERAND_MAX),
            name => list::way_of(name).map_or(Turn::Close, |lines| self.go(lines)),
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let line = |place| {
            let operand = self.operands.get(place);
            operand.map_or_else(Line::default, |operand| self.line(place, *operand, site))
        };
        let title = format!("{} {}", site.words("TABLE"), self.area.letter());
        let cursor = (self.current, self.operands.len());
        let current = self.operand().map(|operand| format!("{operand} ="));
        View {
            window: Some(list::window(title, WindowKind::Table, cursor, lines, line)),
            dialogue: Dialogue {
                prompt: current.unwrap_or_default(),
                entry: self.entry.clone().unwrap_or_default(),
                open: true,
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        match self.goto.take() {
            Some(text) if !self.goto(&text) => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
            _ => Turn::Done,
        }
    }
}
