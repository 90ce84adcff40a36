//! A machine of which nothing is known but its parameters, as a plant that can be operated.

use bahn_control900::ideal_machine;
use bahn_machine::{Event, Fault};
use bahn_servo::{Commands, IdealAxes, Measured, Plant, Step};
use bahn_system900::Memory;

use crate::operable::Operable;

/// Handwheels that scripts can turn.
const WHEELS: u8 = 3;

/// An ideal machine: physical axis n moves without delay as its voltage says.
///
/// ```
/// use bahn_host::{Event, IdealMachine, Operable};
/// use bahn_system900::DataFile;
/// let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nP12000: 1\nP12004: 6000\n");
/// let mut machine = IdealMachine::of(file.memory());
/// assert_eq!(machine.operate(&Event::parse("fault drive 1 dead").map_err(|error| error.to_string())?), Ok(()));
/// let refused = machine.operate(&Event::parse("fault drive 2 dead").map_err(|error| error.to_string())?);
/// assert_eq!(refused, Err("the machine has no physical axis 2".to_owned()));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone)]
pub struct IdealMachine {
    axes: IdealAxes,
    /// The encoder of each handwheel, from 0.
    wheels: [Option<usize>; WHEELS as usize],
}

impl IdealMachine {
    /// That of these parameters.
    pub fn of(memory: &Memory) -> IdealMachine {
        let encoder = |number: usize| {
            let block = memory.handwheel(number as u8 + 1)?;
            usize::from(block.encoder).checked_sub(1)
        };
        IdealMachine {
            axes: ideal_machine(memory),
            wheels: std::array::from_fn(encoder),
        }
    }

    fn drive(&mut self, number: u8, is_dead: bool) -> Result<(), String> {
        let place = usize::from(number).checked_sub(1);
        let drive = place.and_then(|place| self.axes.drives.get_mut(place)?.as_mut());
        let drive = drive.ok_or_else(|| format!("the machine has no physical axis {number}"))?;
        drive.is_dead = is_dead;
        Ok(())
    }
}

impl Plant for IdealMachine {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.axes.exchange(step, commands, measured);
    }
}

impl Operable for IdealMachine {
    fn operate(&mut self, event: &Event) -> Result<(), String> {
        match event {
            Event::Fault(Fault::PhysicalDrive(number)) => self.drive(*number, true),
            Event::Repair(what) if what == "all" => {
                self.axes
                    .drives
                    .iter_mut()
                    .flatten()
                    .for_each(|drive| drive.is_dead = false);
                Ok(())
            }
            Event::Repair(what) => match what.parse() {
                Ok(number) => self.drive(number, false),
                Err(_) => Err(format!(
                    "an ideal machine has drives alone, as `repair 1`, no `{what}`"
                )),
            },
            Event::Handwheel(number, steps) => {
                let encoder = self.wheels.get(*number).copied().flatten();
                let encoder = encoder.ok_or("no handwheel is described, P11400 and following")?;
                self.axes.turn(encoder, *steps);
                Ok(())
            }
            _ => Err(
                "an ideal machine has `fault drive 1 dead`, `repair 1` and `handwheel 1 STEPS` alone"
                    .to_owned(),
            ),
        }
    }

    fn copied(&self) -> Option<IdealMachine> {
        Some(self.clone())
    }
}
