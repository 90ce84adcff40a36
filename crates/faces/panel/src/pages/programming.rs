//! PROGRAMMING AND EDITING [003:1692-1790]: a program is written by dialogue. Every block is on the medium when it is
//! complete, and what is still open of one is kept, too.
//!
//! Decision: In PROGRAMMING AND EDITING GRAPHICS switches AUTO DRAW, START draws the whole program; a cycle is drawn
//! while its words are asked for, with HELP where the screen has one column; what is drawn is the contour as it is
//! programmed up to the block at the cursor, the path of the tool where a block has no RL or RR and in cycles, called
//! programs and subprograms after it in the colour of MP7363.2 (also `graphics/src/contour.rs`)

use std::sync::Arc;

use bahn_dialogue::{BuilderCycle, Draft, Editor, Key, Setting};
use bahn_graphics::{Asked, Subject, Wish};
use bahn_host::oem_cycles;
use bahn_parameters::MessageId;
use bahn_program::Program;
use bahn_screen::SoftKeys;
use bahn_screen::texts;
use serde_json::Value;

use crate::page::{Page, Turn, View};
use crate::pages::files::{Directory, Purpose, runs};
use crate::pages::row_after::RowAfter;
use crate::pages::{editing, table};
use crate::site::Site;

/// A program is edited.
pub(crate) struct Programming {
    open: Option<Open>,
    drawn: Drawn,
    /// What is still to be said.
    said: Option<String>,
}

/// What is drawn beside the program.
#[derive(Default)]
struct Drawn {
    /// AUTO DRAW: each block is drawn when it is complete.
    auto: bool,
    /// The program and its last block as they were drawn; the whole program without.
    last: Option<(Arc<Program>, Option<u32>)>,
    /// The soft keys of the graphics.
    keys: RowAfter,
    /// Cycles are drawn while their words are asked for: beside the dialogue where the screen has room. HELP switches.
    cycles: bool,
}

struct Open {
    name: String,
    editor: Editor,
    /// The program memory as this editor knows it.
    version: u64,
}

impl Programming {
    /// With the program that was edited last, and what was open of it.
    pub fn new(site: &mut Site) -> Programming {
        let name = site.settings.edited.clone();
        let (builder_cycles, said) = builder_cycles(site);
        let mut open = name.and_then(|name| Open::of(name, builder_cycles, site));
        let kept = site.settings.draft.as_ref().and_then(Value::as_str);
        if let (Some(open), Some(draft)) = (&mut open, kept.and_then(|text| text.parse::<Draft>().ok())) {
            open.editor.restore(&draft);
        }
        let drawn = Drawn {
            auto: site.graphics.shows_programmed(),
            cycles: site.control().model().has_windows(),
            ..Drawn::default()
        };
        Programming { open, drawn, said }
    }

    /// The program that is to be edited now; what HELP has chosen stays.
    fn renew(&mut self, site: &mut Site) {
        let cycles = self.drawn.cycles;
        *self = Programming::new(site);
        self.drawn.cycles = cycles;
    }

    /// What has changed is on the medium before the next key.
    fn keep(&mut self, changed: bool, site: &mut Site) -> Option<String> {
        let open = self.open.as_mut()?;
        site.settings.draft = open.editor.draft().map(|draft| Value::from(draft.to_string()));
        let stored = match changed {
            true => site.programs.write(&open.name, &open.editor.program().to_bytes()),
            false => Ok(()),
        };
        open.version = site.programs.version();
        stored.err()
    }

    /// A key of the graphics: GRAPHICS switches AUTO DRAW on and off, START draws the whole program. Their soft keys
    /// stand in a row of their own.
    fn graphics_key(&mut self, key: Key, site: &mut Site) -> Option<Turn> {
        let editor = &self.open.as_ref()?.editor;
        match key {
            Key::Graphics | Key::Start | Key::Magn if !site.control().model().has_graphics() => {
                return Some(Turn::Refused);
            }
            Key::SkLeft | Key::SkRight => return self.drawn.keys.turn(key, editor),
            Key::Graphics => self.switch(!self.drawn.auto, site),
            Key::Start => self.draw(None, site),
            Key::Help => {
                self.asked()?;
                self.drawn.cycles = !self.drawn.cycles;
            }
            Key::Magn => return site.graphics.key(Subject::Programmed, key).then_some(Turn::Done),
            _ => match self.drawn.keys.place(key, editor) {
                Some(0) => self.switch(!self.drawn.auto, site),
                Some(1) => self.draw(None, site),
                Some(2) => return Some(self.draw_next(site)),
                Some(3) => self.switch(false, site),
                Some(_) => return Some(Turn::Refused),
                None => return None,
            },
        }
        Some(Turn::Done)
    }

    /// The cycle whose words are asked for, where it has a drawing, and the prompt.
    fn asked(&self) -> Option<Asked> {
        let question = self.open.as_ref()?.editor.question()?;
        let cycle = question.about.strip_prefix("CYCL DEF ")?.split('.').next()?;
        let cycle = cycle.parse::<u16>().ok()?;
        bahn_dialogue::figure(cycle).map(|_| (cycle, question.id))
    }

    /// AUTO DRAW on or off.
    fn switch(&mut self, on: bool, site: &mut Site) {
        self.drawn.auto = on;
        self.drawn.last = None;
        site.graphics.show_programmed(on);
    }

    /// Draws the program up to a block, or the whole.
    fn draw(&mut self, upto: Option<u32>, site: &mut Site) {
        let Some(open) = &self.open else { return };
        let program = Arc::clone(open.editor.program());
        self.drawn.last = Some((Arc::clone(&program), upto));
        if !site.graphics.shows_programmed() {
            site.graphics.show_programmed(true);
        }
        let name = open.name.clone();
        let wish = Wish { name, program, upto };
        site.graphics
            .draw(wish, site.host.control(), site.machine, site.programs);
    }

    /// START SINGLE: one block more than is drawn, as long as there is one.
    fn draw_next(&mut self, site: &mut Site) -> Turn {
        let upto = self.drawn.last.as_ref().and_then(|(_, upto)| *upto);
        let next = upto.map_or(0, |upto| upto + 1);
        let count = self
            .open
            .as_ref()
            .map_or(0, |open| open.editor.program().block_count());
        if next >= count {
            return Turn::Refused;
        }
        self.drawn.auto = false;
        self.draw(Some(next), site);
        Turn::Done
    }

    /// AUTO DRAW follows program and cursor.
    fn follow(&mut self, site: &mut Site) {
        let Some(open) = self.open.as_ref().filter(|_| self.drawn.auto) else {
            return;
        };
        let (program, cursor) = (open.editor.program(), open.editor.cursor());
        let same = |(last, upto): &(Arc<Program>, Option<u32>)| {
            Arc::ptr_eq(last, program) && upto.is_none_or(|upto| upto == cursor)
        };
        if !self.drawn.last.as_ref().is_some_and(same) {
            self.draw(Some(cursor), site);
        }
    }

    fn with(&mut self, site: &mut Site, what: impl FnOnce(&mut Editor, &mut Site) -> (Turn, bool)) -> Turn {
        let Some(open) = &mut self.open else {
            return Turn::Refused;
        };
        if runs(&open.name, site.control()) {
            return Turn::Say(site.words("BACKGROUND PROGRAMMING NOT POSSIBLE"));
        }
        let (turn, changed) = what(&mut open.editor, site);
        // MP7224.1: files of a protected type are not edited; what stands in this one counts [000:6870-6882].
        if changed && table::is_protected(&open.name, site) {
            self.renew(site);
            return Turn::Say(site.message(MessageId::ProtectedPgm));
        }
        match self.keep(changed, site) {
            Some(fault) => Turn::Say(fault),
            None => turn,
        }
    }
}

impl Open {
    fn of(name: String, builder_cycles: Vec<BuilderCycle>, site: &Site) -> Option<Open> {
        let program = site.programs.read(&name)?;
        let mut setting = Setting::of(site.parameters());
        setting.tongue = site.language();
        setting.builder_cycles = builder_cycles;
        Some(Open {
            name,
            editor: Editor::new(program, setting),
            version: site.programs.version(),
        })
    }

    /// The file is another one than is edited: it was protected, or written elsewhere.
    fn is_stale(&mut self, site: &Site) -> bool {
        let version = std::mem::replace(&mut self.version, site.programs.version());
        let own = || Some(self.editor.program().to_bytes());
        version != self.version && site.programs.read(&self.name).map(|program| program.to_bytes()) != own()
    }
}

/// The cycles of the machine builder with their dialogue texts, and what is to be said of a folder that cannot be read.
fn builder_cycles(site: &Site) -> (Vec<BuilderCycle>, Option<String>) {
    let folder = site.machine.programs(0);
    let found = oem_cycles::find(&folder, site.control().plc_dialogues(), site.parameters());
    let found = match found {
        Ok(found) => found,
        Err(error) => {
            let words = site.words("CYCLES OF THE MACHINE BUILDER CANNOT BE READ");
            return (Vec::new(), Some(format!("{words}: {error}")));
        }
    };
    let shown = found.into_iter().filter(|cycle| !cycle.is_hidden);
    let cycles = shown.filter_map(|cycle| {
        let dialog = cycle.dialog?;
        let parameters = dialog.parameters.into_iter();
        Some(BuilderCycle {
            number: u16::try_from(cycle.number).ok()?,
            name: dialog.name.text,
            parameters: parameters
                .filter_map(|(number, text)| Some((u16::try_from(number).ok()?, text.text)))
                .collect(),
        })
    });
    (cycles.collect(), None)
}

impl Page for Programming {
    fn file(&self) -> Option<&str> {
        self.open.as_ref().map(|open| open.name.as_str())
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::ClPgm => Turn::Open(Box::new(Directory::new(Purpose::Erase, site))),
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Edit, site))),
            _ if let Some(turn) = self.graphics_key(key, site) => turn,
            _ => self.with(site, |editor, site| editing::key(editor, key, site)),
        }
    }

    fn text(&mut self, text: &str, site: &mut Site) -> Turn {
        self.with(site, |editor, site| editing::text(editor, text, site))
    }

    fn capture(&mut self, site: &mut Site) -> Turn {
        self.with(site, editing::capture_block)
    }

    fn own_soft_keys(&self) -> Option<SoftKeys> {
        let editor = &self.open.as_ref()?.editor;
        let auto = match self.drawn.auto {
            true => "AUTO DRAW OFF",
            false => "AUTO DRAW ON",
        };
        Some(self.drawn.keys.show(editor, || {
            let words = |english| texts::words(editor.setting().tongue, english).to_owned();
            [auto, "RESET + START", "START SINGLE", "CLEAR GRAPHICS"]
                .map(words)
                .to_vec()
        }))
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        match &self.open {
            Some(open) => editing::view(&open.editor, &open.name, lines),
            None => super::no_program(site),
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        if self.open.as_mut().is_some_and(|open| open.is_stale(site)) {
            self.renew(site);
        }
        let open = self.open.as_ref().map(|open| open.name.as_str());
        if open != site.settings.edited.as_deref() {
            site.settings.draft = None;
            self.renew(site);
            // A name without its program is not asked for again.
            if self.open.is_none() {
                site.settings.edited = None;
            }
        }
        self.follow(site);
        let asked = match self.drawn.cycles {
            true => self.asked(),
            false => None,
        };
        site.graphics.show_cycle(asked);
        self.said.take().map_or(Turn::Done, Turn::Say)
    }

    fn subject(&self) -> Option<Subject> {
        Some(Subject::Programmed)
    }
}
