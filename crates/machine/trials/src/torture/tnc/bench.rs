//! A program on its machine, run once undisturbed: its contour, and moments that every trial can begin at.

use std::sync::Arc;

use bahn_machine::Machine;
use bahn_program::Program;
use bahn_reader::{Reader, Start};
use bahn_tnc::{Message, Programs};

use super::catalogue::start_keys;
use super::led::Led;
use crate::torture::contour::Contour;
use crate::torture::family::Refused;
use bahn_host::Next;
use bahn_host::PowerOn;
use bahn_host::Saved;
use bahn_host::{Attendance, Job, Operator};
use bahn_host::{FolderPrograms, LoadedMachine};
use bahn_host::{Host, HostError};
use bahn_host::{Notice, Stamped};

/// Moments that are kept of a program at most.
const MOMENTS_MAX: usize = 96;
/// Between two of them at first, µs.
const EVERY_US: u64 = 250_000;
/// A program that takes longer is tried as far as this, µs.
const LONGEST_US: u64 = 1_800_000_000;
/// Whoever waits longer for one acknowledgement of the PLC waits for what is not there, a positioning module say, µs.
const PATIENCE_US: u64 = 300_000_000;

/// A machine on which plans are tried, with moments of an undisturbed run.
pub(super) struct TncBench {
    pub host: Host,
    /// NC start of each channel.
    pub start_keys: Vec<String>,
    pub moments: Vec<Saved<Machine>>,
    /// The contour of each channel.
    pub contours: Vec<Contour>,
    /// What leads each of them.
    pub led: Vec<Led>,
    /// What the undisturbed run says.
    pub usual: Vec<Message>,
    /// The program of each channel, where it has one.
    pub programs: Vec<Option<String>>,
}

impl TncBench {
    /// Runs a program of the machine to its end, the other channels those of their own.
    ///
    /// # Errors
    /// When it does not come to its end by itself.
    pub fn new(machine: &LoadedMachine, program: &str) -> Result<TncBench, Refused> {
        let mut host = host(machine, program)?;
        host.keep_path();
        let mut bench = TncBench {
            start_keys: start_keys(machine),
            contours: (0..host.control().channels())
                .map(|_| Contour::default())
                .collect(),
            led: vec![Led::default(); host.control().channels()],
            host,
            moments: Vec::new(),
            usual: Vec::new(),
            programs: std::iter::once(Some(program.to_owned()))
                .chain(
                    (1..=machine.channels.len())
                        .map(|number| machine.usual_program(number).map(str::to_owned)),
                )
                .collect(),
        };
        let mut notices = bench.host.notices();
        let (mut every_us, mut due_us) = (EVERY_US, 0);
        let mut waits_from_us = 0;
        while !bench.has_ended() {
            let now = bench.host.control().time_us();
            if now >= LONGEST_US {
                break;
            }
            if bench.is_stuck() {
                let shown = bench.host.control().shown().first();
                let why = shown.map_or_else(String::new, |shown| bench.host.control().shown_text(shown));
                return Err(Refused::Fails(HostError::File(format!(
                    "{program} does not come to its end undisturbed: {why}"
                ))));
            }
            match bench.host.control().waiting() {
                Some(waiting) if now >= waits_from_us + PATIENCE_US => {
                    return Err(Refused::Waits(format!("waits for {waiting}")));
                }
                Some(_) => {}
                None => waits_from_us = now,
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
            bench.learn();
            for next in notices.by_ref() {
                if let Next::Item(Stamped {
                    notice: Notice::Shown(shown),
                    ..
                }) = next
                {
                    bench.usual.push(shown.message);
                }
            }
        }
        if bench.contours.iter().all(Contour::is_empty) {
            return Err(Refused::Fails(HostError::File(format!(
                "{program} moves no axis"
            ))));
        }
        Ok(bench)
    }

    fn take_path(&mut self) {
        for (channel, contour) in self.contours.iter_mut().enumerate() {
            for element in self.host.take_prepared(channel).elements {
                contour.add(element);
            }
        }
    }

    fn learn(&mut self) {
        for (number, led) in self.led.iter_mut().enumerate() {
            if let Some(channel) = self.host.control().channel(number) {
                led.learn(&channel, self.host.plant());
            }
        }
    }

    fn has_ended(&self) -> bool {
        let control = self.host.control();
        let mut jobs = self.host.operator().channels_with_job();
        jobs.all(|number| control.channel(number).is_some_and(|channel| channel.has_ended()))
    }

    fn is_stuck(&self) -> bool {
        let control = self.host.control();
        let broken = |number| control.channel(number).is_some_and(|channel| channel.is_broken());
        control.shown().iter().any(|shown| shown.flashing) || (0..control.channels()).any(broken)
    }
}

/// The programs of a folder, to which nothing is added: what a trial digitizes is of no use to the next one.
struct ReadOnly(FolderPrograms);

impl Programs for ReadOnly {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.0.open(name, caller)
    }

    fn reader(&self, name: &str, start: &Start) -> Result<Option<Box<dyn Reader>>, String> {
        self.0.reader(name, start)
    }

    fn open_in_eprom(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.0.open_in_eprom(name, caller)
    }

    fn name_here(&self, name: &str) -> String {
        self.0.name_here(name)
    }

    fn store(&self, _name: &str, _pieces: &[Arc<[u8]>]) -> Result<(), String> {
        Ok(())
    }
}

/// A machine that is switched on for a program, with an operator who stands by.
fn host(machine: &LoadedMachine, program: &str) -> Result<Host, HostError> {
    let mut power_on = PowerOn::fresh(machine);
    for (number, channel) in (1..).zip(&mut power_on.channels) {
        channel.programs = Arc::new(ReadOnly(FolderPrograms::of_folder(&machine.programs(number))));
    }
    let programs: Arc<dyn Programs> = Arc::new(ReadOnly(FolderPrograms::of_folder(&machine.programs(0))));
    let operator = Operator::new(
        Attendance::Full,
        machine.folder.operator.clone(),
        Some(Job::whole(program)),
    );
    let operator = (1..)
        .zip(&machine.channels)
        .fold(operator, |operator, (number, channel)| {
            let job = machine.usual_program(number).map(Job::whole);
            operator.with_channel(channel.folder.operator.clone(), job)
        });
    Host::new(machine, power_on, programs, operator)
}
