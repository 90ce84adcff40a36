//! The files of the PLC: in one window or two, of the memory or of an EPROM, with what is done with them
//! [000:11273-11368].
//!
//! Decision: A protected file of the PLC is one that may not be written; TNC/EPROM shows what the binary files of the
//! folder hold, and TRANSFER takes it into the memory, where nothing is overwritten; UNFORM. makes single blanks of
//! what sets words in columns (also `panel/src/pages/plc/convert.rs`)

use std::collections::{BTreeSet, VecDeque};

use bahn_dialogue::Key;
use bahn_host::eprom::LoadList;
use bahn_host::s_records::Image;
use bahn_parameters::MessageId;
use bahn_screen::programs::NAME_MAX;
use bahn_screen::{Line, Mark, Window, WindowKind};

use super::convert;
use super::editor::Editor;
use super::keys::Keys;
use super::source;
use crate::page::{Page, Turn, View};
use crate::pages::ask::{Choice, Later, Name};
use crate::pages::{axis_errors, external, list, transfer};
use crate::site::Site;
use crate::transfer::{TransferAction, TransferFiles};

/// Soft keys with one window, in two rows; what has no name is not there.
const ONE: [[&str; 8]; 2] = [
    [
        "PAGE UP",
        "PAGE DOWN",
        "SELECT",
        "COPY",
        "MODIFY WINDOW",
        "SELECT TYPE",
        "WINDOW",
        "END",
    ],
    [
        "PAGE UP",
        "PAGE DOWN",
        "PROTECT",
        "UNPROTECT",
        "RENAME",
        "CONVERT",
        "NEW FILE",
        "END",
    ],
];
/// Soft keys while two windows are shown.
const TWO: [[&str; 8]; 2] = [
    [
        "PAGE UP",
        "PAGE DOWN",
        "TRANSFER",
        "TRANSFER TAGGED",
        "TRANSFER ALL",
        "SELECT TYPE",
        "WINDOW",
        "END",
    ],
    [
        "PAGE UP",
        "PAGE DOWN",
        "CONVERT",
        "MODIFY WINDOW",
        "TAG",
        "",
        "",
        "END",
    ],
];
/// Soft keys of SELECT TYPE: the ending of the files that are shown [000:11335-11350].
const TYPES: &[&str] = &[
    "SHOW ALL", ".PLC", ".ER1", ".ERE", ".DI1", ".DIE", ".A", "END", ".HLP", ".BIN", ".COM", ".CMA",
];
/// Soft keys of MODIFY WINDOW: the memory that a window shows [000:11300-11304].
const DEVICES: &[&str] = &["SELECT TYPE", TNC, EPROM, EXT];
const TNC: &str = "SELECT TNC";
const EPROM: &str = "SELECT TNC/EPROM";
const EXT: &str = "SELECT EXT";
/// Binary files, the contents of EPROMs.
const BINARY: &str = ".BIN";
/// Characters of each of two windows.
const WIDTH: usize = 30;

/// A file of a window.
struct Entry {
    name: String,
    protected: bool,
    /// The EPROM it lies in, by its binary file, and what it has.
    eprom: Option<(String, Vec<u8>)>,
}

/// A window with files of one memory.
#[derive(Default)]
struct Pane {
    entries: Vec<Entry>,
    current: usize,
    /// Files of EPROMs are shown, too.
    eprom: bool,
    /// Files of this ending only.
    ending: Option<String>,
    /// Names that are tagged.
    tagged: BTreeSet<String>,
}

impl Pane {
    fn list(&mut self, site: &Site) {
        let names = source::list(site);
        let of_eproms: Vec<Entry> = match self.eprom {
            true => names.iter().flat_map(|name| of_eprom(name, site)).collect(),
            false => Vec::new(),
        };
        let of_memory = names.into_iter().map(|name| Entry {
            protected: source::is_protected(&source::path(&name, site)),
            name,
            eprom: None,
        });
        let shown = |entry: &Entry| {
            let ending = self.ending.as_deref();
            ending.is_none_or(|ending| entry.name.to_uppercase().ends_with(ending))
        };
        self.entries = of_memory.chain(of_eproms).filter(shown).collect();
        self.current = list::moved(self.current, 0, self.entries.len());
        let names = self.entries.iter().map(|entry| entry.name.as_str());
        let names: BTreeSet<&str> = names.collect();
        self.tagged.retain(|name| names.contains(name.as_str()));
    }

    /// Tags the file under the cursor, or takes its tag away, and goes on to the next.
    fn tag(&mut self) -> Turn {
        let Some(name) = self.entry().map(|entry| entry.name.clone()) else {
            return Turn::Refused;
        };
        if !self.tagged.remove(&name) {
            self.tagged.insert(name);
        }
        self.current = list::moved(self.current, 1, self.entries.len());
        Turn::Done
    }

    fn entry(&self) -> Option<&Entry> {
        self.entries.get(self.current)
    }
}

/// What an EPROM has of which a binary file is the contents; nothing of one that is none.
fn of_eprom(name: &str, site: &Site) -> Vec<Entry> {
    if !name.to_uppercase().ends_with(BINARY) {
        return Vec::new();
    }
    let text = std::fs::read_to_string(source::path(name, site)).unwrap_or_default();
    let image = Image::from_records(&text).ok();
    let Some((list, contents)) = image.and_then(|image| LoadList::of_image(&image).ok()) else {
        return Vec::new();
    };
    let entries = list.files.into_iter().zip(contents).map(|(file, bytes)| Entry {
        name: file.name,
        protected: true,
        eprom: Some((name.to_owned(), bytes)),
    });
    entries.collect()
}

/// The file management of the PLC mode.
pub(super) struct Files {
    panes: [Pane; 2],
    active: usize,
    two: bool,
    chosen: Later,
    /// Something was done: there may be other files.
    stale: bool,
}

/// The directory, with the cursor on the file that is most likely meant.
pub(super) fn open(site: &Site) -> Turn {
    let stopped = site.control().plc().stopped().map(|error| error.file.as_str());
    let wanted = stopped.or(site.plc.edited.as_deref());
    let wanted = wanted.map_or_else(|| source::main_file(site), str::to_owned);
    let mut panes = [Pane::default(), Pane::default()];
    for pane in &mut panes {
        pane.list(site);
        pane.current = pane
            .entries
            .iter()
            .position(|entry| entry.name == wanted)
            .unwrap_or(0);
    }
    Turn::Open(Box::new(Files {
        panes,
        active: 0,
        two: false,
        chosen: Later::default(),
        stale: false,
    }))
}

impl Files {
    fn pane(&self) -> &Pane {
        let [first, second] = &self.panes;
        if self.active == 0 { first } else { second }
    }

    fn pane_mut(&mut self) -> &mut Pane {
        let [first, second] = &mut self.panes;
        if self.active == 0 { first } else { second }
    }

    fn rows(&self) -> &'static [[&'static str; 8]; 2] {
        if self.two { &TWO } else { &ONE }
    }

    fn go(&mut self, lines: isize) -> Turn {
        let pane = self.pane_mut();
        pane.current = list::moved(pane.current, lines, pane.entries.len());
        Turn::Done
    }

    /// The file under the cursor, which lies in the memory.
    fn own(&self) -> Option<&str> {
        let entry = self.pane().entry().filter(|entry| entry.eprom.is_none())?;
        Some(&entry.name)
    }

    fn select(&self, site: &mut Site) -> Turn {
        let Some(name) = self.own() else {
            return Turn::Refused;
        };
        if let Some(opened) = axis_errors::editor(name, &source::path(name, site)) {
            return opened.unwrap_or_else(Turn::Say);
        }
        // Where the PLC was stopped: of a time out at the last jump [000:11919].
        let stopped = site.control().plc().stopped();
        let line = stopped
            .filter(|error| error.file == *name)
            .map_or(1, |error| error.line);
        match Editor::open(name, line as usize, site) {
            Ok(editor) => Turn::Replace(Box::new(editor)),
            Err(why) => Turn::Say(why),
        }
    }

    /// Asks for another name, and does something with both.
    fn named(
        &self,
        prompt: &'static str,
        done: fn(&str, &str, &Site) -> Result<(), String>,
        site: &Site,
    ) -> Turn {
        let Some(old) = self.own().map(str::to_owned) else {
            return Turn::Refused;
        };
        let ending = old
            .rfind('.')
            .and_then(|at| old.get(at..))
            .unwrap_or_default()
            .to_owned();
        let prompt = format!("{} {ending}", site.words(prompt));
        Turn::Open(Name::ask(prompt, NAME_MAX, move |new, site| {
            let new = if new.contains('.') { new } else { new + &ending };
            match done(&old, &new, site) {
                Ok(()) => Turn::Close,
                Err(why) => Turn::CloseSaying(why),
            }
        }))
    }

    fn rename(&self, site: &Site) -> Turn {
        // machine.toml names what the machine needs.
        match self.own() {
            Some(name) if is_needed(name, site) => Turn::Say(site.message(MessageId::ProtectedPgm)),
            _ => self.named("NEW FILE NAME =", source::rename, site),
        }
    }

    fn protect(&mut self, on: bool, site: &Site) -> Turn {
        let Some(name) = self.own() else {
            return Turn::Refused;
        };
        match source::protect(name, on, site) {
            Ok(()) => Turn::Done,
            Err(why) => Turn::Say(why),
        }
    }

    /// Erases the file under the cursor, when ENT says so; none that the machine needs [003:985-990].
    fn erase(&self, site: &Site) -> Turn {
        let Some(name) = self.own().map(str::to_owned) else {
            return Turn::Refused;
        };
        if is_needed(&name, site) {
            return Turn::Say(site.message(MessageId::ProtectedPgm));
        }
        let prompt = format!("{name}: {}", site.words("ERASE = ENT / END = NO ENT"));
        Turn::Open(Choice::confirm(
            prompt,
            site.words("ERASE"),
            move |site| match source::erase(&name, site) {
                Ok(()) => Turn::Close,
                Err(why) => Turn::CloseSaying(why),
            },
        ))
    }

    /// Copies into the other window what is under the cursor, what is tagged, or all; a file that is there already is
    /// replaced when ENT says so.
    fn transfer(&mut self, which: &str, site: &Site) -> Turn {
        let from = self.pane();
        let wanted: Vec<&Entry> = match which {
            "TRANSFER ALL" => from.entries.iter().collect(),
            "TRANSFER" => from.entry().into_iter().collect(),
            _ => {
                let tagged = |entry: &&Entry| from.tagged.contains(&entry.name);
                from.entries.iter().filter(tagged).collect()
            }
        };
        // Both windows are of one memory: only what lies in an EPROM is somewhere else.
        let foreign = wanted
            .iter()
            .filter_map(|entry| Some((entry.name.clone(), entry.eprom.as_ref()?.1.clone())));
        let files: VecDeque<_> = foreign.collect();
        match files.is_empty() {
            true => Turn::Refused,
            false => copies(files, 0, false, site),
        }
    }

    fn keys(&self, names: &'static [&'static str]) -> Turn {
        Turn::Open(Keys::ask(names, &self.chosen))
    }

    /// What was chosen of other soft keys.
    fn chose(&mut self, name: &str, site: &mut Site) -> Turn {
        if let Some((_, form)) = convert::FORMS.iter().find(|(own, _)| *own == name) {
            return self
                .own()
                .map_or(Turn::Refused, |file| convert::ask(file, *form, site));
        }
        match name {
            "SELECT TYPE" => return self.keys(TYPES),
            "SHOW ALL" => self.pane_mut().ending = None,
            TNC => self.pane_mut().eprom = false,
            EPROM => self.pane_mut().eprom = true,
            // What is on the device is listed, and read in from there.
            EXT => return transfer::begin_with(TransferFiles::Plc, TransferAction::Directory, site),
            ending => self.pane_mut().ending = Some(ending.to_owned()),
        }
        Turn::Done
    }

    fn two_windows(&self, lines: usize) -> Vec<Line> {
        let first = |pane: &Pane| crate::page::first_in_sight(pane.current, pane.entries.len(), lines);
        let longest = self
            .panes
            .iter()
            .map(|pane| pane.entries.len())
            .max()
            .unwrap_or(0);
        let line = |row: usize| {
            let mut shown = Line::default();
            for (place, pane) in self.panes.iter().enumerate() {
                let at = first(pane) + row;
                let entry = pane.entries.get(at);
                let tag = entry.is_some_and(|entry| pane.tagged.contains(&entry.name));
                let text = entry.map(text_of).unwrap_or_default();
                let text = if tag { format!("*{text}") } else { text };
                let from = shown.text.chars().count();
                shown.text += &match place {
                    0 => format!("{:<WIDTH$.WIDTH$} | ", text),
                    _ => text,
                };
                if at == pane.current && at < pane.entries.len() && place == self.active {
                    shown.current = true;
                    shown.marks = vec![(from, from + WIDTH, Mark::Cursor)];
                }
            }
            shown.text.truncate(shown.text.trim_end().len());
            shown
        };
        (0..longest.min(lines)).map(line).collect()
    }
}

/// A new file: tables of axis errors begin with their head [000:11370].
fn new_file(site: &Site) -> Turn {
    Turn::Open(Name::ask(
        site.words("FILE NAME ="),
        NAME_MAX + 4,
        |name, site| {
            let name = source::named_at_interface(&name);
            match source::create(&name, axis_errors::new_file(&name).as_bytes(), site) {
                Ok(()) => Turn::Close,
                Err(why) => Turn::CloseSaying(why),
            }
        },
    ))
}

/// Copies files one after the other; one that is there already is asked for, with the others after it.
fn copies(mut files: VecDeque<(String, Vec<u8>)>, mut copied: u32, asked: bool, site: &Site) -> Turn {
    while let Some((name, bytes)) = files.pop_front() {
        let path = source::path(&name, site);
        if !path.exists() {
            match source::create(&name, &bytes, site) {
                Ok(()) => copied += 1,
                Err(why) => return said(format!("{name}: {why}"), asked),
            }
            continue;
        }
        if source::is_protected(&path) {
            let protected = site.message(MessageId::ProtectedPgm);
            return said(format!("{name}: {protected}"), asked);
        }
        let erase = site.message(MessageId::EraseOverread);
        let prompt = format!("{erase} {name}: {}", site.words("YES = ENT / NO = NO ENT"));
        let names = ["ENT".to_owned(), "NO ENT".to_owned()];
        let question = Choice::ask(prompt, names, move |yes, site| {
            if yes && let Err(why) = source::write(&name, &bytes, site) {
                return Turn::CloseSaying(why);
            }
            copies(files.clone(), copied + u32::from(yes), true, site)
        });
        return match asked {
            true => Turn::Replace(question),
            false => Turn::Open(question),
        };
    }
    said(format!("{copied} {}", site.words("FILES TRANSFERRED")), asked)
}

/// What is said at the end; a question that stood there goes.
fn said(text: String, asked: bool) -> Turn {
    match asked {
        true => Turn::CloseSaying(text),
        false => Turn::Say(text),
    }
}

/// The files that the machine needs by their names.
fn is_needed(name: &str, site: &Site) -> bool {
    name == source::main_file(site) || super::texts::is_active(name, site)
}

fn text_of(entry: &Entry) -> String {
    let kept = match &entry.eprom {
        Some((image, _)) => format!("EPROM {image}"),
        None if entry.protected => "P".to_owned(),
        None => String::new(),
    };
    format!("{:<18}{kept}", entry.name).trim_end().to_owned()
}

impl Page for Files {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines);
        }
        match key {
            Key::Left | Key::Right if self.two => {
                self.active = usize::from(key == Key::Right);
                Turn::Done
            }
            Key::ClPgm => {
                self.stale = true;
                self.erase(site)
            }
            Key::Ent => self.select(site),
            Key::Ext => {
                self.stale = true;
                external::of(source::FILES, site)
            }
            Key::End | Key::NoEnt | Key::Del => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        self.rows().iter().map(|row| list::soft_keys(row, site)).collect()
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        let name = self.rows().get(row).map_or("", |row| list::name_at(row, place));
        self.stale = true;
        match name {
            "SELECT" => self.select(site),
            "COPY" => self.named("DESTINATION FILE =", source::copy, site),
            "RENAME" => self.rename(site),
            "NEW FILE" => new_file(site),
            "PROTECT" | "UNPROTECT" => self.protect(name == "PROTECT", site),
            "MODIFY WINDOW" => self.keys(DEVICES),
            "SELECT TYPE" => self.keys(TYPES),
            "CONVERT" => self.keys(&convert::KEYS),
            "TRANSFER" | "TRANSFER TAGGED" | "TRANSFER ALL" => self.transfer(name, site),
            "TAG" => self.pane_mut().tag(),
            "WINDOW" => {
                (self.two, self.active) = (!self.two, 0);
                Turn::Done
            }
            "END" => Turn::Close,
            name => list::way_of(name).map_or(Turn::Refused, |lines| self.go(lines)),
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let title = site.words("PLC FILES");
        if self.two {
            let lines = self.two_windows(lines);
            return View::of(Window {
                title,
                kind: WindowKind::List,
                total: lines.len(),
                lines,
                first: 0,
            });
        }
        let pane = self.pane();
        let main = source::main_file(site);
        let line = |place: usize| {
            let entry = pane.entries.get(place);
            let mut text = entry.map(text_of).unwrap_or_default();
            // Status M: the main program, as COMPILE has made it [000:14608].
            if entry.is_some_and(|entry| entry.eprom.is_none() && entry.name == main) {
                text = format!("{text:<32} M {}", site.words("RUNTIME PGM"));
            }
            Line {
                text,
                current: place == pane.current,
                ..Line::default()
            }
        };
        let cursor = (pane.current, pane.entries.len());
        View::of(list::window(title, WindowKind::List, cursor, lines, line))
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let turn = match self.chosen.take() {
            Some(name) => self.chose(&name, site),
            None if !self.stale => return Turn::Done,
            None => Turn::Done,
        };
        self.stale = matches!(turn, Turn::Open(_));
        self.panes.iter_mut().for_each(|pane| pane.list(site));
        turn
    }
}
