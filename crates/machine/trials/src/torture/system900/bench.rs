//! The programs of a machine, run once undisturbed: contours of all channels, and moments that every trial can begin at.

use std::path::PathBuf;

use bahn_control900::Control900;
use bahn_host::{
    AnyPlant, Attendance, Host, Host900, HostError, Job900, Machine900, Operator900, PowerOn900, Saved,
};
use bahn_system900::Memory;

use crate::torture::contour::Contour;
use crate::torture::family::Refused;

/// Moments that are kept of a run at most.
const MOMENTS_MAX: usize = 96;
/// Between two of them at first, µs.
const EVERY_US: u64 = 250_000;
/// A run that takes longer is tried as far as this, µs.
const LONGEST_US: u64 = 1_800_000_000;
/// Whoever stands longer waits for what is not there, µs.
const PATIENCE_US: u64 = 300_000_000;

/// A machine on which plans are tried, with moments of an undisturbed run.
pub(super) struct Bench900 {
    pub host: Host900,
    pub moments: Vec<Saved<AnyPlant, Control900>>,
    /// The contour of each channel.
    pub contours: Vec<Contour>,
    /// What the data file says.
    described: Memory,
}

impl Bench900 {
    /// Runs what the channels start with, or a named program in channel 1, to the end.
    ///
    /// # Errors
    /// When it does not come to its end by itself.
    pub fn new(machine: &Machine900, program: &str) -> Result<Bench900, Refused> {
        let mut host = host(machine, program)?;
        host.keep_path();
        let channels = usize::from(host.control().channels());
        let mut bench = Bench900 {
            contours: (0..channels).map(|_| Contour::default()).collect(),
            host,
            moments: Vec::new(),
            described: machine.parameters.memory().clone(),
        };
        let (mut every_us, mut due_us, mut moved_us) = (EVERY_US, 0, 0);
        while !bench.has_ended() {
            let now = bench.host.control().now_us();
            if now >= LONGEST_US {
                break;
            }
            if let Some(said) = bench.said() {
                return Err(Refused::Fails(HostError::File(format!(
                    "the programs do not come to their end undisturbed: {said}"
                ))));
            }
            if bench.host.control().moves() {
                moved_us = now;
            } else if now >= moved_us + PATIENCE_US {
                return Err(Refused::Waits("stands for ever".to_owned()));
            }
            if now >= due_us {
                if bench.moments.len() == MOMENTS_MAX {
                    let mut place = 0;
                    bench.moments.retain(|_| {
                        place += 1;
                        place % 2 == 1
                    });
                    every_us *= 2;
                }
                bench.moments.extend(bench.host.save());
                due_us = now + every_us;
            }
            bench.host.step()?;
            bench.take_path();
        }
        if bench.contours.iter().all(Contour::is_empty) {
            return Err(Refused::Fails(HostError::File(
                "the programs move no axis".to_owned(),
            )));
        }
        match bench.moments.is_empty() {
            true => Err(Refused::Fails(HostError::File(
                "the plant cannot be copied".to_owned(),
            ))),
            false => Ok(bench),
        }
    }

    /// The parameters of the data file.
    pub fn described(&self) -> &Memory {
        &self.described
    }

    fn take_path(&mut self) {
        for (channel, contour) in self.contours.iter_mut().enumerate() {
            for element in self.host.take_prepared(channel).elements {
                contour.add(element);
            }
        }
    }

    fn has_ended(&self) -> bool {
        let control = self.host.control();
        let mut jobs = (1..=control.channels()).filter(|channel| control.has_program(*channel));
        self.host.operator().has_started() && jobs.all(|channel| control.run(channel).1)
    }

    /// The first message that nobody has acknowledged.
    fn said(&self) -> Option<String> {
        let control = self.host.control();
        let mut all = (1..=control.channels()).flat_map(|channel| control.pending_messages(channel));
        all.next().map(ToString::to_string)
    }
}

/// A machine that is switched on, with an operator who stands by.
fn host(machine: &Machine900, program: &str) -> Result<Host900, HostError> {
    let mut power_on = PowerOn900::fresh(machine);
    if !program.is_empty() {
        power_on.run(&[PathBuf::from(program)]).map_err(HostError::File)?;
    }
    let job = Job900 { single_block: false };
    let operator = Operator900::new(Attendance::Full, job);
    let plant = machine.plant(&power_on.memory);
    Ok(Host::of_system900(power_on, plant, operator))
}
