//! A System 900: its parameters, its channels, and the clock that moves them.

use bahn_exchange::Exchange;
use bahn_kernel::{Clock, Feeder, RunState};
use bahn_path::{BlockRef, PathElement};
use bahn_reader::{Reader, Warning};
use bahn_servo::{Commands, Plant};
use bahn_system900::{
    EventBuffer, Flash, FlashError, FlashScene, Memory, Name, Programs, SpaceError, Value, Writer,
};

use crate::channel::{Channel, Mode};
use crate::language::Language;
use crate::machine::Machine;
use crate::message::{Kind, Message};
use crate::plc_run::PlcRun;
use crate::setup::Setup;
use crate::transfer::Transfer;
use crate::{branch, command, monitor, preparing, status};

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

    /// There is a program that the next start of a channel, from 1 on, runs.
    pub fn has_program(&self, channel: u8) -> bool {
        self.channel(channel)
            .is_some_and(|channel| channel.program.is_some())
    }

    /// The language of its programs.
    pub fn language(&self) -> Option<Language> {
        self.machine.language
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
            preparing::prepare(&mut self.machine, k);
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

    /// The operator writes a parameter.
    ///
    /// # Errors
    /// When the name leads nowhere, the value does not go in, or a lock that is set locks the parameter: then nothing is
    /// written.
    pub fn write_operator(&mut self, name: Name, value: Value) -> Result<(), SpaceError> {
        self.write(Writer::Editor, name, value)
    }

    /// The same with keys, or at a page for axes, zero points or tools.
    ///
    /// # Errors
    /// As [`Control900::write_operator`]; the lock of the parameter editor holds nothing back.
    pub fn write_panel(&mut self, name: Name, value: Value) -> Result<(), SpaceError> {
        self.write(Writer::Page, name, value)
    }

    /// The PLC writes a parameter, past all locks.
    ///
    /// # Errors
    /// When the name leads nowhere, or the value does not go in.
    pub fn write_plc(&mut self, name: Name, value: Value) -> Result<(), SpaceError> {
        self.write(Writer::Plc, name, value)
    }

    fn write(&mut self, writer: Writer, name: Name, value: Value) -> Result<(), SpaceError> {
        let Machine {
            traffic,
            memory,
            now_us,
            function,
            ..
        } = &mut self.machine;
        let asked = traffic.write(memory, *now_us / 1000, writer, name, value)?;
        *function = asked.or(*function);
        let place = memory.place(name)?;
        command::notice(&mut self.machine, place);
        Ok(())
    }

    /// The function of q10 that somebody has asked for since the last call.
    pub fn take_function(&mut self) -> Option<i64> {
        self.machine.function.take()
    }

    /// Executes a function of q10 in HAND, outside the cycle: how many parameters or programs it was about [002:403-534].
    ///
    /// # Errors
    /// Why it is refused, which is shown as a message, too; then nothing has changed.
    pub fn execute(
        &mut self,
        number: i64,
        flash: &mut Flash,
        programs: &mut Programs,
    ) -> Result<usize, FlashError> {
        let is_in_hand = self
            .machine
            .channels
            .iter()
            .all(|channel| channel.mode == Mode::Hand);
        let scene = FlashScene {
            memory: &mut self.machine.memory,
            programs,
            is_in_hand,
            is_reading: false,
        };
        let done = flash.run(number, scene);
        match &done {
            Ok(_) => command::follow_locks(&mut self.machine),
            Err(error) => self
                .machine
                .say(0, 1, None, Kind::Display, error.to_string().into()),
        }
        done
    }

    /// What was recorded of keys, messages, transfers and blocks [002:6064-6198].
    pub fn events(&self) -> &EventBuffer {
        self.machine.traffic.events()
    }

    /// The memory of the PLC; `None` without a program.
    pub fn plc(&self) -> Option<&Exchange> {
        self.machine.plc.as_deref().map(PlcRun::exchange)
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

    /// Messages since power-on, the first one first: the last 256.
    pub fn messages(&self) -> &[Message] {
        self.machine.messages.all()
    }

    /// The messages of a channel that nobody has acknowledged.
    pub fn pending_messages(&self, channel: u8) -> impl Iterator<Item = &Message> {
        self.machine.messages.pending(channel)
    }

    /// Keeps the path elements of programs that begin from now on, for [`Control900::take_path`].
    pub fn keep_path(&mut self) {
        self.machine.keeps_path = true;
    }

    /// The path elements of a channel, from 1 on, that were prepared since the last call.
    pub fn take_path(&mut self, channel: u8) -> Vec<PathElement> {
        let feeder = self.feeder(channel);
        feeder.map(Feeder::take_tap).unwrap_or_default()
    }

    /// Of what [`Control900::take_path`] has handed out so far, the elements from a sequence on are not executed.
    pub fn take_dropped_path(&mut self, channel: u8) -> Option<u64> {
        self.feeder(channel).and_then(Feeder::take_dropped)
    }

    /// What is to be said of the program of a channel since the last call, and ends no run.
    pub fn take_warnings(&mut self, channel: u8) -> Vec<Warning> {
        let feeder = self.feeder(channel);
        feeder
            .map(|feeder| feeder.reader_mut().take_warnings())
            .unwrap_or_default()
    }

    fn feeder(&mut self, channel: u8) -> Option<&mut Feeder> {
        let index = usize::from(channel).checked_sub(1)?;
        self.machine.channels.get_mut(index)?.feeder.as_mut()
    }

    /// What a channel reads, as long as it runs and afterwards.
    pub fn reader(&self, channel: u8) -> Option<&dyn Reader> {
        Some(self.channel(channel)?.feeder.as_ref()?.reader())
    }

    /// The element that a channel executes, with the distance that is left of it, mm.
    pub fn executed(&self, channel: u8) -> Option<(&PathElement, f64)> {
        let run = &self.channel(channel)?.run;
        Some((run.element()?, run.track.path.rest_mm()))
    }

    /// A program of a channel, from 1 on, was started, and has neither ended nor been broken off.
    pub fn is_on_its_way(&self, channel: u8) -> bool {
        self.channel(channel)
            .is_some_and(|channel| channel.run.progress().is_on_its_way())
    }

    /// The block whose fault has broken the program of a channel, from 1 on, off.
    pub fn faulty_block(&self, channel: u8) -> Option<BlockRef> {
        self.channel(channel)?.faulty
    }

    pub(crate) fn machine(&self) -> &Machine {
        &self.machine
    }

    fn channel(&self, channel: u8) -> Option<&Channel> {
        let index = usize::from(channel).checked_sub(1)?;
        self.machine.channels.get(index)
    }

    /// Some axis moves, or is to move.
    pub fn moves(&self) -> bool {
        self.machine.core.axes.iter().any(|unit| !unit.stands())
    }

    /// How many messages came since power-on.
    pub fn message_count(&self) -> usize {
        self.machine.messages.count()
    }

    /// The mode of a channel, from 1 on; HAND where there is none.
    pub fn mode(&self, channel: u8) -> Mode {
        self.channel(channel).map_or(Mode::Hand, |channel| channel.mode)
    }

    /// What the run of a channel does, and whether its program came to its end.
    pub fn run(&self, channel: u8) -> (RunState, bool) {
        self.channel(channel).map_or((RunState::Idle, false), |channel| {
            let progress = channel.run.progress();
            (progress.state(), progress.has_ended())
        })
    }
}
