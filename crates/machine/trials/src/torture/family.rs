//! What a family of controls says of a machine that is tried.

use bahn_host::HostError;

use super::catalogue::{Catalogue, Mishap};
use super::plan::{Happening, Plan};
use super::trial::Trial;

/// Why a program cannot be tried.
pub(super) enum Refused {
    /// What belongs to this machine is not there: the PLC never acknowledges what it says.
    Waits(String),
    /// The files, or the program itself.
    Fails(HostError),
}

impl From<HostError> for Refused {
    fn from(error: HostError) -> Refused {
        Refused::Fails(error)
    }
}

/// A machine with a control of some family.
pub(super) trait Tried {
    /// The name of the machine.
    fn name(&self) -> &str;

    /// Runs a program to its end: what trials begin at.
    ///
    /// # Errors
    /// When it does not come to its end by itself.
    fn bench(&self, program: &str) -> Result<Box<dyn Bench>, Refused>;

    /// Whether a script could have it.
    ///
    /// # Errors
    /// In words.
    fn could_happen(&self, what: &str) -> Result<(), String>;

    /// What of a program `bahn run` gets to run it again.
    fn named<'a>(&self, program: &'a str) -> &'a str {
        program
    }
}

/// A program on its machine, run once undisturbed, with moments that every trial can begin at.
pub(super) trait Bench {
    /// The kept moments, µs since power-on.
    fn moments_us(&self) -> Vec<u64>;

    /// What the handwheel may do beside the path of the program.
    fn turns(&self) -> Vec<Mishap> {
        Vec::new()
    }

    /// Tries a plan, or a part of what happens in it.
    fn run(&mut self, catalogue: &Catalogue, plan: &Plan, happenings: &[Happening]) -> Trial;
}
