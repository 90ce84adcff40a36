//! Commissioning: a list of machine parameters that is empty or has faults is presented when the control is switched on,
//! and it goes on when the list is whole [000:10011] [000:10050-10066]. And another machine in the place of this one, when
//! its files are those of a backup.

use std::path::Path;
use std::sync::Arc;

use bahn_control::{Command, Programs};
use bahn_host::backup::Restore;
use bahn_host::{Attendance, Deed, LoadedMachine, Operator, PowerOn, Source, State};

use super::Station;
use crate::console::Console;
use crate::pages;
use crate::programs::ProgramMemory;
use crate::settings::Settings;
use crate::timeline::Past;
use crate::why::Waits;

/// The list is entered: the control is off, and what it kept stays as it is.
pub(super) struct Commissioning {
    /// Held, so that nobody else switches the machine on.
    _state: Option<State>,
}

impl Commissioning {
    /// Takes what the control kept out of its hands, when the list of a machine is to be entered.
    pub fn of(machine: &LoadedMachine, power_on: &mut PowerOn) -> Option<Commissioning> {
        machine.to_be_entered.as_ref().map(|_| Commissioning {
            _state: power_on.state.take(),
        })
    }
}

impl Station {
    /// Presents the list; without one to be entered nothing happens.
    pub(super) fn commission(&mut self) {
        if self.commissioning.is_none() {
            return;
        }
        let off = Deed::Command(0, Command::Power(false));
        let _ = self.host.act(Source::Client("panel".to_owned()), off);
        self.is_on = false;
        let (console, site) = self.parts();
        match pages::commission(&site) {
            Ok(page) => console.enter(page),
            Err(why) => console.say(why),
        }
    }

    /// The list was left: it is whole, and the control goes on.
    pub(super) fn follow_commissioning(&mut self) {
        if self.commissioning.is_some() && !self.console.enters() {
            self.load_anew();
        }
    }

    /// The machine is switched on as its files are now; what cannot be read of them is said, and it stays as it is.
    pub(super) fn load_anew(&mut self) {
        match self.loaded_anew() {
            Ok(()) => self.commission(),
            Err(why) => {
                self.console.say(why);
                self.commission();
            }
        }
    }

    /// The machine becomes what it was when a backup was made.
    pub(super) fn restore(&mut self, restore: Restore) {
        // What the control keeps is not written over what is restored.
        self.host.release_state();
        match restore.commit() {
            Ok(_) => self.load_anew(),
            Err(error) => self.console.say(error.to_string()),
        }
    }

    fn loaded_anew(&mut self) -> Result<(), String> {
        let machine = load(&self.machine.root)?;
        // The state is free before it is taken again.
        self.commissioning = None;
        self.host.release_state();
        let mut power_on = PowerOn::kept(&machine).map_err(|error| error.to_string())?;
        self.commissioning = Commissioning::of(&machine, &mut power_on);
        self.programs = Arc::new(ProgramMemory::new(&machine.programs(0)));
        let shared = Arc::clone(&self.programs) as Arc<dyn Programs>;
        self.host
            .replace(&machine, power_on, shared, operator_of(&machine));
        self.state_folder = machine.root.join(&machine.folder.state);
        let (settings, _) = Settings::read(&self.state_folder);
        self.stored = settings.clone();
        self.settings = settings;
        self.machine = machine;
        self.is_on = true;
        let control = self.host.control();
        self.console = Console::new(control.mode(), control.model());
        self.plc.power_off();
        self.waits = Waits::new(&self.machine);
        self.past = Past::new(&mut self.host);
        Ok(())
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
        let lines = faults.iter().map(|fault| fault.title.clone());
        lines.collect::<Vec<_>>().join("\n")
    })
}
