//! Who has the keys: the machine side with its operating mode, or programming beside it, and the pages that stand on
//! them.
//!
//! Decision: To module 9035 positions stand on every screen that is displayed, and graphics where the page has them;
//! a table on the editing screen is its file and lies over nothing; the machine screen has no code for the editors
//! that a code number opens, so it is MOD; .CMA and .COM are the compensation table (7), the file is the one that is
//! edited or tested (also `panel/src/page.rs`)

use bahn_dialogue::Key;
use bahn_graphics::Subject;
use bahn_parameters::{ControlModel, MessageId};
use bahn_screen::{Heading, SoftKeys};
use bahn_tnc::{Command, Mode, ScreenCommand};

use crate::page::{Page, Side, Turn, View};
use crate::pages;
use crate::site::Site;

/// Messages of the panel itself that are kept at most.
const NOTES: usize = 8;

/// Modes of the programming side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Programming {
    /// PROGRAMMING AND EDITING: programs are written.
    Edit,
    /// TEST RUN: a program is tested without the machine.
    Test,
}

/// The pages of a side: the mode below, what was opened on it above.
struct Stack {
    base: Box<dyn Page>,
    opened: Vec<Box<dyn Page>>,
    /// The soft-key row that is shown.
    row: usize,
}

impl Stack {
    fn new(base: Box<dyn Page>) -> Stack {
        Stack {
            base,
            opened: Vec::new(),
            row: 0,
        }
    }

    fn top(&mut self) -> &mut dyn Page {
        self.opened.last_mut().unwrap_or(&mut self.base).as_mut()
    }

    fn shown(&self) -> &dyn Page {
        self.opened.last().unwrap_or(&self.base).as_ref()
    }

    /// What a page that lies open shows, with the window of the one below where it has none.
    fn view(&self, site: &Site, lines: usize) -> View {
        let mut view = self.shown().show(site, lines);
        let mut below = self.opened.iter().rev().skip(1).chain([&self.base]);
        while view.window.is_none()
            && let Some(page) = below.next()
        {
            view.window = page.show(site, lines).window;
        }
        view
    }

    /// The code of what lies over the mode, on a side.
    fn overlay(&self, side: Side) -> u8 {
        let mut opened = self.opened.iter().rev();
        let code = opened.find_map(|page| page.overlay().code(side));
        code.unwrap_or_default()
    }

    /// The file that is edited or tested.
    fn file(&self) -> Option<&str> {
        let mut pages = self.opened.iter().rev().chain([&self.base]);
        pages.find_map(|page| page.file())
    }

    /// Goes on with what came of a key; what is to be said.
    fn turn(&mut self, turn: Turn) -> Result<(), Said> {
        match turn {
            Turn::Done => {}
            Turn::Close => drop(self.opened.pop()),
            Turn::Open(page) => self.opened.push(page),
            Turn::Replace(page) => {
                self.opened.pop();
                self.opened.push(page);
            }
            Turn::Refused => return Err(Said::KeyNonFunctional),
            Turn::Say(text) => return Err(Said::Text(text)),
            Turn::CloseSaying(text) => {
                self.opened.pop();
                return Err(Said::Text(text));
            }
        }
        Ok(())
    }
}

enum Said {
    KeyNonFunctional,
    Text(String),
}

/// Who has the keys.
pub(crate) struct Console {
    front: Side,
    /// The machine operating mode to which the base of the machine side belongs.
    mode: Mode,
    machine: Stack,
    programming: Option<(Programming, Stack)>,
    /// The screen is split [000:2784].
    pub split: bool,
    /// Messages of the panel, the oldest first.
    notes: Vec<String>,
    /// The list of machine parameters is entered, and nothing else can be chosen.
    enters: bool,
}

impl Console {
    /// The console at power-on.
    pub fn new(mode: Mode, model: ControlModel) -> Console {
        Console {
            front: Side::Machine,
            mode,
            machine: Stack::new(pages::of_mode(mode, model)),
            programming: None,
            split: false,
            notes: Vec::new(),
            enters: false,
        }
    }

    /// The control goes on when this page is left: it has all keys.
    pub fn enter(&mut self, page: Box<dyn Page>) {
        self.machine.opened = vec![page];
        self.enters = true;
    }

    /// Whether such a page still stands.
    pub fn enters(&self) -> bool {
        self.enters && !self.machine.opened.is_empty()
    }

    /// Takes a key of the keyboard.
    pub fn key(&mut self, key: Key, site: &mut Site) {
        if let Some(mode) = machine_mode(key).filter(|_| !self.enters) {
            return self.choose(mode, site);
        }
        match key {
            Key::Program | Key::Test if self.enters => {
                self.say(site.message(MessageId::KeyNonFunctional));
            }
            Key::Program => self.program(Programming::Edit, site),
            Key::Test => self.program(Programming::Test, site),
            Key::Ce if !self.notes.is_empty() => drop(self.notes.pop()),
            // A screen of one column is not split.
            Key::Screen if site.control().model().has_windows() => self.split = !self.split,
            Key::Screen => self.say(site.message(MessageId::KeyNonFunctional)),
            Key::SkLeft | Key::SkRight => self.turn_row(key, site),
            _ => self.pass_on(key, site),
        }
    }

    /// A line of text as a whole.
    pub fn text(&mut self, text: &str, site: &mut Site) {
        let stack = self.stack();
        let turn = stack.top().text(text, site);
        self.went(turn, site);
    }

    fn pass_on(&mut self, key: Key, site: &mut Site) {
        let stack = self.stack();
        let own = stack.shown().own_soft_keys().is_some();
        let turn = match key.soft_key() {
            Some(place) if !own => {
                let rows = stack.shown().soft_keys(site);
                let row = stack.row.min(rows.len().saturating_sub(1));
                let text = rows.get(row).and_then(|row| row.get(place));
                match text.is_some_and(|text| !text.is_empty()) {
                    true => stack.top().soft_key(row, place, site),
                    false => Turn::Refused,
                }
            }
            _ => stack.top().key(key, site),
        };
        // CE that nobody wants clears the message of the control.
        if key == Key::Ce && matches!(turn, Turn::Refused) {
            site.command(Command::Ce);
            return;
        }
        // CAPTURE by hand is for the program that is written beside.
        let turn = match (turn, &mut self.programming) {
            (Turn::Refused, Some((_, beside)))
                if key == Key::Capture
                    && self.front == Side::Machine
                    && self.machine.opened.is_empty()
                    && matches!(self.mode, Mode::Manual | Mode::Handwheel) =>
            {
                beside.top().capture(site)
            }
            (turn, _) => turn,
        };
        // MOD and HELP are there wherever the page itself does not take them.
        let turn = match turn {
            Turn::Refused => {
                let note = self.notes.last().map(String::as_str);
                pages::everywhere(key, self.front(), note, site)
            }
            turn => turn,
        };
        self.went(turn, site);
    }

    /// The soft key with a name, on whichever side shows it, the one with the keys first.
    pub fn soft_key(&mut self, name: &'static str, site: &mut Site) {
        let front = self.front();
        let wanted = site.words(name);
        for side in [front, front.other()] {
            self.front = side;
            let rows = match (side, &self.programming) {
                (Side::Programming, None) => continue,
                _ => self.stack().shown().soft_keys(site),
            };
            let place_in = |row: &Vec<String>| row.iter().position(|text| *text == wanted);
            let mut rows = rows.iter().enumerate();
            let found = rows.find_map(|(row, texts)| Some((row, place_in(texts)?)));
            if let Some((row, place)) = found {
                let turn = self.stack().top().soft_key(row, place, site);
                return self.went(turn, site);
            }
        }
        self.front = front;
        self.say(site.message(MessageId::KeyNonFunctional));
    }

    fn went(&mut self, turn: Turn, site: &Site) {
        let changes = matches!(
            turn,
            Turn::Close | Turn::CloseSaying(_) | Turn::Open(_) | Turn::Replace(_)
        );
        let stack = self.stack();
        if changes {
            stack.row = 0;
        }
        match stack.turn(turn) {
            Ok(()) => {}
            Err(Said::KeyNonFunctional) => self.say(site.message(MessageId::KeyNonFunctional)),
            Err(Said::Text(text)) => self.say(text),
        }
    }

    /// Shows a message of the panel.
    pub fn say(&mut self, text: String) {
        self.notes.retain(|note| *note != text);
        if self.notes.len() == NOTES {
            self.notes.remove(0);
        }
        self.notes.push(text);
    }

    /// Messages of the panel.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Once in every contour cycle.
    pub fn tick(&mut self, site: &mut Site) {
        // What the control says, too, stands there once.
        if !self.notes.is_empty() {
            let shown = site.control().shown().iter();
            let said: Vec<String> = shown.map(|own| site.translated(own)).collect();
            self.notes.retain(|note| !said.contains(note));
        }
        pages::follow_help(site);
        // The PLC, an error or power-off may have chosen another mode.
        if site.mode() != self.mode {
            self.mode = site.mode();
            self.machine = Stack::new(pages::of_mode(self.mode, site.control().model()));
        }
        let front = self.front;
        for side in [Side::Machine, Side::Programming] {
            self.front = side;
            let stack = match (side, &mut self.programming) {
                (Side::Machine, _) => &mut self.machine,
                (Side::Programming, Some((_, stack))) => stack,
                (Side::Programming, None) => continue,
            };
            // The mode below what was opened shows what goes on, too, and says it.
            let below = (!stack.opened.is_empty()).then(|| stack.base.tick(site));
            let turn = stack.top().tick(site);
            if !matches!(turn, Turn::Done) {
                self.went(turn, site);
            }
            if let Some(Turn::Say(text)) = below {
                self.say(text);
            }
        }
        self.front = front;
    }

    /// The control was switched off: nothing of what was open is left but the program that is being written.
    pub fn power_off(&mut self) {
        self.machine.opened.clear();
        self.front = Side::Machine;
        self.notes.clear();
    }

    /// The machine was brought to another moment: its mode has a page as it is then. What is programmed beside it is of
    /// now.
    pub fn machine_is_elsewhere(&mut self, mode: Mode, model: ControlModel) {
        self.mode = mode;
        self.machine = Stack::new(pages::of_mode(mode, model));
        self.notes.clear();
    }

    fn choose(&mut self, mode: Mode, site: &mut Site) {
        let there = self.mode == mode && self.front == Side::Machine;
        let misses_marks = site.control().first().misses_marks();
        let has_soft_key = site.control().model().has_soft_keys();
        if there && mode == Mode::Manual && misses_marks && !has_soft_key {
            site.command(Command::Mode(Mode::Reference));
        } else if there {
            self.machine.opened.clear();
        } else if site.command(Command::Mode(mode)) {
            self.front = Side::Machine;
        } else {
            self.say(site.message(MessageId::KeyNonFunctional));
        }
    }

    fn program(&mut self, mode: Programming, site: &mut Site) {
        if self.programming.as_ref().is_none_or(|(is, _)| *is != mode) {
            let base = match mode {
                Programming::Edit => pages::editing(site),
                Programming::Test => pages::test_run(site),
            };
            self.programming = Some((mode, Stack::new(base)));
        }
        self.front = Side::Programming;
    }

    fn turn_row(&mut self, key: Key, site: &mut Site) {
        let stack = self.stack();
        if stack.shown().own_soft_keys().is_some() {
            let turn = stack.top().key(key, site);
            return self.went(turn, site);
        }
        let (right, rows) = (key == Key::SkRight, stack.shown().soft_keys(site).len().max(1));
        stack.row = (stack.row + if right { 1 } else { rows - 1 }) % rows;
    }

    fn stack(&mut self) -> &mut Stack {
        match (self.front, &mut self.programming) {
            (Side::Programming, Some((_, stack))) => stack,
            _ => &mut self.machine,
        }
    }

    /// Which side has the keys.
    pub fn front(&self) -> Side {
        match self.programming {
            Some(_) => self.front,
            None => Side::Machine,
        }
    }

    /// What a side shows, in so many lines.
    pub fn view(&self, side: Side, site: &Site, lines: usize) -> Option<View> {
        match side {
            Side::Machine => Some(self.machine.view(site, lines)),
            Side::Programming => self
                .programming
                .as_ref()
                .map(|(_, stack)| stack.view(site, lines)),
        }
    }

    /// What the graphics of a side show: that of the page that is shown. Those of the mode below make room for a menu.
    pub fn subject(&self, side: Side) -> Option<Subject> {
        let stack = match side {
            Side::Machine => &self.machine,
            Side::Programming => self.programming.as_ref().map(|(_, stack)| stack)?,
        };
        stack.shown().subject()
    }

    /// The soft-key row of the side that has the keys.
    pub fn soft_keys(&self, site: &Site) -> SoftKeys {
        if !site.control().model().has_soft_keys() {
            return SoftKeys::default();
        }
        let stack = match (self.front(), &self.programming) {
            (Side::Programming, Some((_, stack))) => stack,
            _ => &self.machine,
        };
        if let Some(own) = stack.shown().own_soft_keys() {
            return own;
        }
        let rows = stack.shown().soft_keys(site);
        let row = stack.row.min(rows.len().saturating_sub(1));
        SoftKeys {
            keys: rows.get(row).cloned().unwrap_or_default(),
            row,
            rows: rows.len(),
        }
    }

    /// What the screen shows, for module 9035 [000:14899-14916].
    pub fn shown(&self, site: &Site, has_plc_window: bool) -> ScreenCommand {
        let programming = self.programming.as_ref().map(|(_, stack)| stack);
        let kind = programming.and_then(Stack::file).map_or(0, kind_of_file);
        let both = self.split && programming.is_some();
        let side = |side: Side, stack: Option<&Stack>| {
            let is_there = stack.is_some() && (both || self.front() == side);
            // Positions and the PLC's window stand beside every mode.
            let position_alone = side == Side::Machine
                && matches!(self.mode, Mode::Manual | Mode::Handwheel | Mode::Reference)
                && stack.is_some_and(|stack| stack.opened.is_empty());
            let graphics = self
                .subject(side)
                .is_some_and(|cut| site.graphics.line(cut).is_some());
            let bits = [true, both, !position_alone, true, has_plc_window, graphics];
            let bits = (0u16..).zip(bits).filter(|(_, on)| *on && is_there);
            bits.fold(0u16, |windows, (bit, _)| windows | 1 << bit)
        };
        ScreenCommand {
            editing: programming.map_or(0, |stack| stack.overlay(Side::Programming)),
            machine: self.machine.overlay(Side::Machine),
            windows: side(Side::Programming, programming) | side(Side::Machine, Some(&self.machine)) << 8,
            file: kind,
            inch: site.settings.inch,
        }
    }

    /// The headings of both sides.
    pub fn headings(&self, site: &Site) -> Vec<Heading> {
        let (key, title) = heading(site.mode());
        let machine = Heading {
            key: key.name().to_owned(),
            title: site.words(title),
            active: self.front() == Side::Machine,
        };
        let programming = self.programming.as_ref().map(|(mode, _)| {
            let (key, title) = match mode {
                Programming::Edit => (Key::Program, site.words("PROGRAMMING AND EDITING")),
                Programming::Test => (Key::Test, site.words("TEST RUN")),
            };
            Heading {
                key: key.name().to_owned(),
                title,
                active: self.front() == Side::Programming,
            }
        });
        std::iter::once(machine).chain(programming).collect()
    }
}

/// Kinds of files in item 5 of module 9035 by their endings [000:14902]. The compensation table of kind 7 has the letter .S
/// there, which is that of .CMA at the interface [000:3867-3869]; its tables (.COM) are one, too (inferred).
const KINDS: [(&str, u8); 8] = [
    ("H", 1),
    ("I", 2),
    ("T", 3),
    ("D", 4),
    ("P", 5),
    ("A", 6),
    ("CMA", 7),
    ("COM", 7),
];

/// The kind of a file by its ending; 0 for others.
fn kind_of_file(name: &str) -> u8 {
    let ending = name.rsplit_once('.').map_or("H", |(_, ending)| ending);
    let mut kinds = KINDS.iter();
    let own = kinds.find(|(kind, _)| kind.eq_ignore_ascii_case(ending));
    own.map_or(0, |(_, code)| *code)
}

/// The machine operating mode of a key.
fn machine_mode(key: Key) -> Option<Mode> {
    Some(match key {
        Key::Manual => Mode::Manual,
        Key::Handwheel => Mode::Handwheel,
        Key::Mdi => Mode::Mdi,
        Key::Single => Mode::SingleBlock,
        Key::Full => Mode::FullSequence,
        _ => return None,
    })
}

/// Key and heading of a machine operating mode; the reference run belongs to MANUAL OPERATION.
fn heading(mode: Mode) -> (Key, &'static str) {
    match mode {
        Mode::Manual => (Key::Manual, "MANUAL OPERATION"),
        Mode::Handwheel => (Key::Handwheel, "ELECTRONIC HANDWHEEL"),
        Mode::Mdi => (Key::Mdi, "POSITIONING WITH MANUAL DATA INPUT"),
        Mode::SingleBlock => (Key::Single, "PROGRAM RUN, SINGLE BLOCK"),
        Mode::FullSequence => (Key::Full, "PROGRAM RUN, FULL SEQUENCE"),
        Mode::Reference => (Key::Manual, "PASS OVER REFERENCE MARKS"),
    }
}
