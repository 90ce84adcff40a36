//! A System 900: its parameters, its channels, and the clock that moves them.

use bahn_kernel::{Clock, RunState};
use bahn_reader::Reader;
use bahn_servo::{Commands, Plant};
use bahn_system900::{Memory, Name, Receivers, SpaceError, Value};

use crate::channel::Mode;
use crate::machine::Machine;
use crate::message::Message;
use crate::setup::Setup;
use crate::transfer::Transfer;
use crate::{branch, command, monitor, status};

/// A control. A clone goes on by itself, with the same bits.
#[derive(Clone)]
pub struct Control900 {
    machine: Machine,
    clock: Clock,
}

impl Control900 {
    /// A control at power-on with its parameters.
    pub fn new(memory: Memory, setup: Setup) -> Control900 {
        let mut machine = Machine::new(memory, setup);
        status::show_at_start(&mut machine);
        Control900 {
            machine,
            clock: Clock::default(),
        }
    }

    /// How many channels there are.
    pub fn channels(&self) -> u8 {
        self.machine.channels.len() as u8
    }

    /// The interpolation cycle, µs.
    pub fn cycle_us(&self) -> u32 {
        self.machine.core.timing.contour_us()
    }

    /// Time since power-on, µs.
    pub fn now_us(&self) -> u64 {
        self.clock.now_us()
    }

    /// The program that the next start of a channel, from 1 on, runs: that of P8800.
    pub fn set_program(&mut self, channel: u8, program: Option<Box<dyn Reader>>) {
        let index = usize::from(channel).checked_sub(1);
        if let Some(channel) = index.and_then(|k| self.machine.channels.get_mut(k)) {
            channel.program = program;
        }
    }

    /// An emergency program of a channel, 1 to 4: that of P8820, P8822, P8824, P8826.
    pub fn set_emergency_program(&mut self, channel: u8, which: u8, program: Option<Box<dyn Reader>>) {
        let index = usize::from(channel).checked_sub(1);
        let channel = index.and_then(|k| self.machine.channels.get_mut(k));
        let which = usize::from(which).checked_sub(1);
        if let (Some(channel), Some(which)) = (channel, which)
            && let Some(slot) = channel.emergency.get_mut(which)
        {
            *slot = program;
        }
    }

    /// Reads ahead, outside the cycle: to be called before each one; may allocate.
    pub fn prepare(&mut self) {
        self.machine.messages.reserve();
        self.machine.transfers.reserve();
        self.machine.written.reserve();
        for k in 0..self.machine.channels.len() {
            branch::jump(&mut self.machine, k);
            self.machine.prepare(k);
        }
    }

    /// An interpolation cycle on a machine. It allocates nothing but for messages.
    pub fn cycle(&mut self, plant: &mut dyn Plant) {
        self.clock.cycle(&mut self.machine, false, plant, None);
        // Nominal and actual positions are now of the same servo step.
        monitor::watch(&mut self.machine);
        status::show(&mut self.machine);
    }

    /// What the machine was told last.
    pub fn commands(&self) -> &Commands {
        &self.clock.commands
    }

    /// The operator writes a parameter; who takes notice of it.
    ///
    /// # Errors
    /// When the name leads nowhere, the value does not go in, or a lock that is set locks the parameter: then nothing is
    /// written.
    pub fn write_operator(&mut self, name: Name, value: Value) -> Result<Receivers, SpaceError> {
        let receivers = self.machine.memory.enter(name, value)?;
        let place = self.machine.memory.place(name)?;
        command::notice(&mut self.machine, place);
        Ok(receivers)
    }

    /// The PLC writes a parameter, past all locks; who takes notice of it.
    ///
    /// # Errors
    /// When the name leads nowhere, or the value does not go in.
    pub fn write_plc(&mut self, name: Name, value: Value) -> Result<Receivers, SpaceError> {
        let receivers = self.machine.memory.write(name, value)?;
        let place = self.machine.memory.place(name)?;
        command::notice(&mut self.machine, place);
        Ok(receivers)
    }

    /// All parameters as they are now.
    pub fn memory(&self) -> &Memory {
        &self.machine.memory
    }

    /// What a parameter holds, not rounded to its decimals where the control itself computes it; `None` when it is cleared.
    ///
    /// # Errors
    /// When the name leads nowhere.
    pub fn number(&self, name: Name) -> Result<Option<f64>, SpaceError> {
        Ok(status::exact(&self.machine, self.machine.memory.place(name)?))
    }

    /// Transfers of M functions to the PLC, the first one first: the last 4096.
    pub fn transfers(&self) -> impl Iterator<Item = &Transfer> {
        self.machine.transfers.iter()
    }

    /// All messages since power-on, the first one first.
    pub fn messages(&self) -> &[Message] {
        self.machine.messages.all()
    }

    /// The messages of a channel that nobody has acknowledged.
    pub fn pending_messages(&self, channel: u8) -> impl Iterator<Item = &Message> {
        self.machine.messages.pending(channel)
    }

    /// The mode of a channel, from 1 on; HAND where there is none.
    pub fn mode(&self, channel: u8) -> Mode {
        let index = usize::from(channel).checked_sub(1);
        let channel = index.and_then(|k| self.machine.channels.get(k));
        channel.map_or(Mode::Hand, |channel| channel.mode)
    }

    /// What the run of a channel does, and whether its program came to its end.
    pub fn run(&self, channel: u8) -> (RunState, bool) {
        let index = usize::from(channel).checked_sub(1);
        let channel = index.and_then(|k| self.machine.channels.get(k));
        channel.map_or((RunState::Idle, false), |channel| {
            let progress = channel.run.progress();
            (progress.state(), progress.has_ended())
        })
    }
}
