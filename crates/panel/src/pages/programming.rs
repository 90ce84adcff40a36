//! PROGRAMMING AND EDITING [003:1692-1790]: a program is written by dialogue. Every block is on the medium when it is
//! complete, and what is still open of one is kept, too.

use bahn_control::RunState;
use bahn_dialogue::{BuilderCycle, Draft, Editor, Key, Setting};
use bahn_host::oem_cycles;
use serde_json::Value;

use crate::page::{Page, Turn, View};
use crate::pages::editing;
use crate::pages::files::{Directory, Purpose};
use crate::screen::{SoftKeys, Window, WindowKind};
use crate::site::Site;

/// A program is edited.
pub(crate) struct Programming {
    open: Option<Open>,
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
        let mut open = name.and_then(|name| Open::of(name, site));
        let kept = site.settings.draft.as_ref().and_then(Value::as_str);
        if let (Some(open), Some(draft)) = (&mut open, kept.and_then(|text| text.parse::<Draft>().ok())) {
            open.editor.restore(&draft);
        }
        Programming { open }
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

    fn with(&mut self, site: &mut Site, what: impl FnOnce(&mut Editor, &mut Site) -> (Turn, bool)) -> Turn {
        let Some(open) = &mut self.open else {
            return Turn::Refused;
        };
        if open.runs(site) {
            return Turn::Say(site.words("BACKGROUND PROGRAMMING NOT POSSIBLE"));
        }
        let (turn, changed) = what(&mut open.editor, site);
        match self.keep(changed, site) {
            Some(fault) => Turn::Say(fault),
            None => turn,
        }
    }
}

impl Open {
    fn of(name: String, site: &Site) -> Option<Open> {
        let program = site.programs.read(&name)?;
        let mut setting = Setting::of(site.parameters());
        setting.tongue = site.language();
        setting.builder_cycles = builder_cycles(site);
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

    /// The machine runs this program.
    fn runs(&self, site: &Site) -> bool {
        let control = site.control();
        let stem = self
            .name
            .rsplit_once('.')
            .map_or(self.name.as_str(), |(stem, _)| stem);
        control.run_state() != RunState::Idle
            && control
                .selected_program()
                .is_some_and(|selected| selected.eq_ignore_ascii_case(stem))
    }
}

/// The cycles of the machine builder with their dialogue texts; a folder that cannot be read has none.
fn builder_cycles(site: &Site) -> Vec<BuilderCycle> {
    let folder = site.machine.programs(0);
    let found = oem_cycles::find(&folder, &site.machine.plc_dialogues, site.parameters());
    let shown = found
        .unwrap_or_default()
        .into_iter()
        .filter(|cycle| !cycle.is_hidden);
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
    cycles.collect()
}

impl Page for Programming {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::ClPgm => Turn::Open(Box::new(Directory::new(Purpose::Erase, site))),
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Edit, site))),
            _ => self.with(site, |editor, site| editing::key(editor, key, site)),
        }
    }

    fn text(&mut self, text: &str, site: &mut Site) -> Turn {
        self.with(site, |editor, site| editing::text(editor, text, site))
    }

    fn own_soft_keys(&self) -> Option<SoftKeys> {
        self.open.as_ref().map(|open| editing::soft_keys(&open.editor))
    }

    fn show(&self, _site: &Site, lines: usize) -> View {
        match &self.open {
            Some(open) => editing::view(&open.editor, &open.name, lines),
            None => View::of(Window {
                kind: WindowKind::Program,
                ..Window::default()
            }),
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        if self.open.as_mut().is_some_and(|open| open.is_stale(site)) {
            *self = Programming::new(site);
        }
        let open = self.open.as_ref().map(|open| open.name.as_str());
        if open != site.settings.edited.as_deref() {
            site.settings.draft = None;
            *self = Programming::new(site);
            // A name without its program is not asked for again.
            if self.open.is_none() {
                site.settings.edited = None;
            }
        }
        Turn::Done
    }
}
