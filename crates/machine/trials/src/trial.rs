//! A machine on trial: switched on, over its reference marks, through a program, and what its tables did meanwhile.

use std::sync::Arc;

use bahn_machine::Machine;
use bahn_parameters::{MessageId, ParameterList};
use bahn_program::Program;
use bahn_tnc::{Control, Message, Programs};

use bahn_host::Host;
use bahn_host::LoadedMachine;
use bahn_host::PowerOn;
use bahn_host::{Attendance, Job, Operator};

/// Time of the machine after which a trial is given up, µs.
const TIME_MAX_US: u64 = 86_400_000_000;
/// So long power-on and reference run may take, µs.
const BEGIN_MAX_US: u64 = 1_200_000_000;
/// Name of the program.
const NAME: &str = "TRIAL.H";

/// One program in memory, which can call no other.
struct Alone(Arc<Program>);

impl Programs for Alone {
    fn open(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        Ok((name == NAME).then(|| Arc::clone(&self.0)))
    }
}

/// Runs blocks on a machine with a list of machine parameters; it keeps nothing. `each` sees every contour cycle of the
/// program. Block 1 is the first one.
///
/// # Errors
/// The message that broke the run off, or what it waited for.
pub(crate) fn run(
    machine: &LoadedMachine,
    parameters: &ParameterList,
    blocks: &str,
    each: impl FnMut(&Control, &Machine),
) -> Result<(), String> {
    run_within(TIME_MAX_US, machine, parameters, blocks, each)
}

/// The same, given up after a time of the machine, µs.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_within(
    most_us: u64,
    machine: &LoadedMachine,
    parameters: &ParameterList,
    blocks: &str,
    mut each: impl FnMut(&Control, &Machine),
) -> Result<(), String> {
    let text = format!("BEGIN PGM TRIAL MM\n{}\nEND PGM TRIAL MM\n", blocks.trim());
    let program = Arc::new(Program::from_bytes(NAME, text.into_bytes()));
    let mut power_on = PowerOn::fresh(machine);
    power_on.parameters = parameters.clone();
    let keys = machine.folder.operator.clone();
    let mut operator = Operator::new(Attendance::Full, keys, Some(Job::whole(NAME)));
    for channel in &machine.channels {
        operator = operator.with_channel(channel.folder.operator.clone(), None);
    }
    let mut host = Host::new(machine, power_on, Arc::new(Alone(program)), operator)
        .map_err(|error| error.to_string())?;
    let mut begun = false;
    loop {
        host.step().map_err(|error| error.to_string())?;
        let control = host.control();
        begun |= host.operator().has_started() && control.element().is_some();
        if begun {
            each(control, host.plant());
        }
        let mut shown = control.shown().iter();
        let broken = shown.find(|shown| {
            let of_axis = matches!(
                shown.message,
                Message::Axis { .. } | Message::Program(_) | Message::Limit { .. }
            );
            // Nobody unlocks it in a trial.
            let stopped = begun && shown.message == Message::Plain(MessageId::ExternalEmergencyStop);
            of_axis || stopped || shown.flashing && !matches!(shown.message, Message::Plc(_))
        });
        if let Some(shown) = broken {
            return Err(control.shown_text(shown));
        }
        if begun && control.has_ended() {
            return Ok(());
        }
        if !begun && control.time_us() > BEGIN_MAX_US {
            return Err("the machine does not get as far as its program".to_owned());
        }
        if control.time_us() > most_us {
            return Err("the trial does not end".to_owned());
        }
    }
}
