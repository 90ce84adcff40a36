//! Commissioning: a list of machine parameters that is empty or has faults is presented when the control is switched on,
//! and it goes on when the list is whole [000:10011] [000:10050-10066]. And another machine in the place of this one, when
//! its files are those of a backup.
//!
//! Decision: A list that is empty, missing or faulty is presented while the supply of the control is off; what can be
//! read of it, else the reference list, says the rest of the machine meanwhile, and what the control kept is neither
//! read nor written. It is whole when no line has a fault: what it does not name has its value of the reference list,
//! as in every list of a folder. A list that is there and cannot be read is a fault of the folder. No lesson begins,
//! and nobody goes to another moment, while it is entered; where the editor could not be presented, switching the
//! supply on tries again. Lists of further channels are no part of it (also `host/src/machine_folder/load.rs`)

use std::sync::Arc;

use bahn_host::backup::Restore;
use bahn_host::{Action, PowerOn, Source};
use bahn_live::Refusal;
use bahn_parameters::MessageId;
use bahn_path::Switch;
use bahn_screen::programs::ProgramMemory;
use bahn_screen::texts;
use bahn_teaching::timeline::Past;
use bahn_tnc::{Command, Programs};
use bahn_why::Waits;

use super::Station;
use crate::console::Console;
use crate::pages;
use crate::to_enter::{Commissioning, load, operator_of};

impl Station {
    /// Presents the list; without one to be entered nothing happens.
    pub(super) fn commission(&mut self) {
        if self.commissioning.is_none() {
            return;
        }
        let off = Action::Command(0, Command::Power(Switch::Off));
        let _ = self.host.act(Source::Client("panel".to_owned()), off);
        self.supply.is_on = false;
        let (console, site) = self.parts();
        let presented = pages::commission(&site).map(|page| console.enter(page));
        if pages::is_erased(&site) {
            console.say(site.message(MessageId::OperatingParametersErased));
        }
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
        let lost = std::mem::take(&mut power_on.warnings);
        let commissioning = Commissioning::of(&machine, &mut power_on);
        let programs = Arc::new(ProgramMemory::new(&machine.programs(0)));
        let shared = Arc::clone(&programs) as Arc<dyn Programs>;
        let replaced = self
            .host
            .replace(&machine, power_on, shared, operator_of(&machine));
        replaced.map_err(|error| error.to_string())?;
        self.commissioning = commissioning;
        self.programs = programs;
        self.machine = machine;
        self.supply.is_on = true;
        let control = self.host.control();
        self.console = Console::new(control.mode(), control.model());
        self.read_settings();
        self.say_lost(lost);
        self.instruments.plc.power_off();
        self.study.waits = Waits::new(&self.machine, self.host.plant());
        self.study.past = Past::new(&mut self.host);
        Ok(())
    }

    /// What was lost at power-on is said, a message each.
    pub(super) fn say_lost(&mut self, lost: Vec<String>) {
        for text in lost {
            let lines: Vec<&str> = text.lines().map(str::trim).collect();
            self.console.say(lines.join(" "));
        }
    }

    /// What the operator has chosen is what was kept of it; what cannot be read is said.
    pub(super) fn read_settings(&mut self) {
        let folder = self.machine.root.join(&self.machine.folder.state);
        if let Some(wrong) = self.chosen.read(&folder) {
            let words = texts::words(self.language(), "WHAT THE OPERATOR HAS CHOSEN CANNOT BE READ");
            self.console.say(format!("{words}: {wrong}"));
        }
    }
}
