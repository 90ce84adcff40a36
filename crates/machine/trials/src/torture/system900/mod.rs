//! The campaign on a machine with a System 900: all its channels at once.
//!
//! `bench` runs the programs undisturbed, `course` is a trial on its way: `axes` and `messages` judge its cycles, `recovery` puts
//! everything back.

mod action;
mod axes;
mod bench;
mod catalogue;
mod course;
mod messages;
mod recovery;

use bahn_host::{HostError, Machine900};

use self::action::action;
use self::bench::Bench900;
use super::catalogue::Catalogue;
use super::family::{Bench, Refused, Tried};
use super::plan::{Happening, Plan};
use super::trial::Trial;

/// A machine with a System 900.
pub(super) struct System900(Machine900);

impl System900 {
    /// Its channels run what they start with.
    pub const OWN: &'static str = "P8800 of all channels";

    /// A machine, and what can happen to it.
    ///
    /// # Errors
    /// When its plant cannot be copied.
    pub fn of(machine: Machine900) -> Result<(System900, Catalogue), HostError> {
        let catalogue = catalogue::catalogue(&machine);
        Ok((System900(machine), catalogue))
    }
}

impl Tried for System900 {
    fn name(&self) -> &str {
        &self.0.folder.name
    }

    fn bench(&self, program: &str) -> Result<Box<dyn Bench>, Refused> {
        Ok(Box::new(Bench900::new(&self.0, self.named(program))?))
    }

    fn could_happen(&self, what: &str) -> Result<(), String> {
        action(what).map(drop)
    }

    fn named<'a>(&self, program: &'a str) -> &'a str {
        match program {
            System900::OWN => "",
            named => named,
        }
    }
}

impl Bench for Bench900 {
    fn moments_us(&self) -> Vec<u64> {
        self.moments.iter().map(|moment| moment.time_us()).collect()
    }

    fn run(&mut self, catalogue: &Catalogue, plan: &Plan, happenings: &[Happening]) -> Trial {
        course::run(self, catalogue, plan, happenings)
    }
}
