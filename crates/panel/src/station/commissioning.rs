//! Commissioning: a list of machine parameters that is empty or has faults is presented when the control is switched on,
//! and it goes on when the list is whole [000:10011] [000:10050-10066]. And another machine in the place of this one, when
//! its files are those of a backup.

use std::path::Path;
use std::sync::Arc;

use bahn_control::{Command, Programs};
use bahn_host::backup::Restore;
use bahn_host::{Action, Attendance, LoadedMachine, Operator, PowerOn, Source, State};
use bahn_screen::programs::ProgramMemory;
use bahn_screen::texts;
use bahn_teaching::timeline::Past;
use bahn_text::Diagnostic;
use bahn_why::Waits;

use super::Station;
use crate::console::Console;
use crate::input::Refusal;
use crate::pages;
use crate::settings::Settings;

/// The list is entered: the control is off, and what it kept stays as it is.
pub(super) struct Commissioning {
    /// Held, so that nobody else switches the machine on.
    state: Option<State>,
    /// The editor was presented: the control goes on when it is left.
    is_presented: bool,
}

impl Commissioning {
    /// Takes what the control kept out of its hands, when the list of a machine is to be entered.
    pub fn of(machine: &LoadedMachine, power_on: &mut PowerOn) -> Option<Commissioning> {
        machine.to_be_entered.as_ref().map(|_| Commissioning {
            state: power_on.state.take(),
            is_presented: false,
        })
    }
}

impl Station {
    /// Presents the list; without one to be entered nothing happens.
    pub(super) fn commission(&mut self) {
        if self.commissioning.is_none() {
            return;
        }
        let off = Action::Command(0, Command::Power(false));
        let _ = self.host.act(Source::Client("panel".to_owned()), off);
        self.is_on = false;
        let (console, site) = self.parts();
        let presented = pages::commission(&site).map(|page| console.enter(page));
        let is_presented = presented.map_err(|why| console.say(why)).is_ok();
        if let Some(own) = &mut self.commissioning {
            own.is_presented = is_presented;
        }
    }

    /// The list was left: it is whole, and the control goes on.
    pub(super) fn follow_commissioning(&mut self) {
        let own = self.commissioning.as_ref();
        if own.is_some_and(|own| own.is_presented) && !self.console.enters() {
            self.load_anew();
        }
    }

    /// Nothing goes on, and nothing was, before the list is whole: no lesson begins, and nobody goes to another moment.
    ///
    /// # Errors
    /// The list is entered.
    pub(super) fn has_its_list(&self) -> Result<(), Refusal> {
        match self.commissioning {
            Some(_) => Err(self.refusal()),
            None => Ok(()),
        }
    }

    /// The supply is switched on once more, where the list could not be presented; whether that was so.
    pub(super) fn try_again(&mut self) -> bool {
        let own = self.commissioning.as_ref();
        let tries = own.is_some_and(|own| !own.is_presented);
        if tries {
            self.load_anew();
        }
        tries
    }

    /// The machine is switched on as its files are now; what cannot be read of them is said, and it stays as it is.
    fn load_anew(&mut self) {
        if let Err(why) = self.loaded_anew() {
            self.console.say(why);
        }
        self.commission();
    }

    /// The machine becomes what it was when a backup was made; where it cannot be switched on with that it stays what it is,
    /// its files, too.
    pub(super) fn restore(&mut self, restore: Restore) {
        let (_, mut site) = self.parts();
        let before = match pages::everything(&mut site) {
            Ok(before) => before,
            Err(why) => return self.console.say(why),
        };
        let restored = restore.commit().map_err(|error| error.to_string());
        if let Err(why) = restored.and_then(|_| self.loaded_anew()) {
            self.console.say(why);
            if let Err(why) = self.bring_back(&before) {
                self.console.say(why);
            }
        }
        self.commission();
    }

    /// The files of a backup are there again, and what is kept is kept in them: those that were open are gone.
    fn bring_back(&mut self, before: &str) -> Result<(), String> {
        let mut restore = Restore::new(&self.machine.root);
        let read = before.lines().try_for_each(|line| restore.line(line));
        read.and_then(|()| restore.commit())
            .map_err(|error| error.to_string())?;
        if let Some(own) = &mut self.commissioning {
            own.state = None;
        }
        self.host.release_state();
        let found = PowerOn::kept(&self.machine).map_err(|error| error.to_string())?;
        match (&mut self.commissioning, found.state) {
            (Some(own), state) => own.state = state,
            (None, Some(state)) => self.host.keep_in(state),
            (None, None) => {}
        }
        Ok(())
    }

    fn loaded_anew(&mut self) -> Result<(), String> {
        let machine = load(&self.machine.root)?;
        // The state is free before it is taken again.
        if let Some(own) = &mut self.commissioning {
            own.state = None;
        }
        self.host.release_state();
        let mut power_on = PowerOn::kept(&machine).map_err(|error| error.to_string())?;
        self.commissioning = Commissioning::of(&machine, &mut power_on);
        self.programs = Arc::new(ProgramMemory::new(&machine.programs(0)));
        let shared = Arc::clone(&self.programs) as Arc<dyn Programs>;
        self.host
            .replace(&machine, power_on, shared, operator_of(&machine));
        self.state_folder = machine.root.join(&machine.folder.state);
        self.machine = machine;
        self.is_on = true;
        let control = self.host.control();
        self.console = Console::new(control.mode(), control.model());
        self.read_settings();
        self.plc.power_off();
        self.waits = Waits::new(&self.machine);
        self.past = Past::new(&mut self.host);
        Ok(())
    }

    /// What the operator has chosen is what was kept of it; what cannot be read is said.
    pub(super) fn read_settings(&mut self) {
        let (settings, unread) = Settings::read(&self.state_folder);
        self.stored = settings.clone();
        self.settings = settings;
        if let Some(wrong) = unread {
            let words = texts::words(self.language(), "WHAT THE OPERATOR HAS CHOSEN CANNOT BE READ");
            self.console.say(format!("{words}: {wrong}"));
        }
    }
}

/// Nobody acts at the machine but who has the panel.
pub(super) fn operator_of(machine: &LoadedMachine) -> Operator {
    Operator::new(Attendance::Absent, machine.folder.operator.clone(), None)
}

/// Loads the machine of a folder, with its faults in words. A list of machine parameters that is empty or has faults is
/// none: it is entered.
///
/// # Errors
/// All faults of all files, one a line.
pub fn load(folder: &Path) -> Result<LoadedMachine, String> {
    let loaded = LoadedMachine::load_to_enter(folder).map_err(|error| error.to_string())?;
    loaded.map_err(|faults| {
        let lines = faults.iter().map(Diagnostic::words);
        lines.collect::<Vec<_>>().join("\n")
    })
}
