//! The machine side: all axes, the circuit, the channels, and what the kernel's clock asks of them.

use bahn_kernel::{Axes, Circuit, Core, EmergencyStop, Feeder, Now, Run, RunFamily};
use bahn_parameters::{EmergencyStopTest, PerPlcAxis};
use bahn_path::BlockRef;
use bahn_system900::{ChannelParameter, Event, Memory, Place, ProgramName, Traffic, Writer};

use crate::answers::Answers;
use crate::axis_state::{AxisPlace, Hand, Watch};
use crate::channel::{Channel, Site, Written};
use crate::language::Language;
use crate::message::{Kind, Message, Messages};
use crate::plc_run::PlcRun;
use crate::setup::Setup;
use crate::transfer::Transfers;
use crate::{restart_place, units};

/// The circuit is not tested at power-on: the manual names no test (inferred).
const NO_TEST: EmergencyStopTest = EmergencyStopTest {
    times: 0,
    recognise_us: 0,
    fall_us: 100_000,
    restore_us: 0,
};

/// Everything but the clock.
#[derive(Clone)]
pub(crate) struct Machine {
    pub core: Core,
    pub memory: Memory,
    /// What goes between control, PLC and panel, as it is recorded.
    pub traffic: Traffic,
    /// The function of q10 that is to be executed.
    pub function: Option<i64>,
    pub channels: Vec<Channel>,
    /// What is known of the axes beside the kernel, in its order.
    pub places: Vec<AxisPlace>,
    pub watches: Vec<Watch>,
    pub hands: Vec<Hand>,
    pub messages: Messages,
    pub transfers: Transfers,
    pub written: Written,
    pub language: Option<Language>,
    pub answers: Answers,
    /// The PLC program; away while it scans.
    pub plc: Option<Box<PlcRun>>,
    pub now_us: u64,
    pub plc_us: u64,
    /// When the PLC is due.
    pub scan_us: u64,
    /// Positions at power-on were taken.
    pub begun: bool,
    /// What programs prepare is kept for those who follow.
    pub keeps_path: bool,
}

impl Machine {
    pub fn new(mut memory: Memory, setup: Setup) -> Machine {
        memory.start();
        let timing = units::timing(&memory);
        let (list, places) = units::build(&memory, timing);
        let mut axes = Axes::new(list, timing);
        let channels = (1..=memory.channels()).map(|number| {
            let limits = units::limits(&axes.of(usize::from(number) - 1), &places, timing);
            Channel::new(number, &limits, timing, &memory)
        });
        let channels: Vec<Channel> = channels.collect();
        let mut machine = Machine {
            watches: vec![Watch::default(); places.len()],
            hands: vec![Hand::default(); places.len()],
            core: Core {
                timing,
                axes,
                emergency: EmergencyStop::new(NO_TEST, false),
                loops_closed: false,
            },
            traffic: Traffic::new(),
            function: None,
            memory,
            channels,
            places,
            messages: Messages::default(),
            transfers: Transfers::default(),
            written: Written::default(),
            language: setup.language,
            answers: Answers::new(setup.answers),
            plc: setup.plc.map(|plc| Box::new(PlcRun::new(plc))),
            now_us: 0,
            plc_us: u64::from(setup.plc_us.max(1)),
            scan_us: 0,
            begun: false,
            keeps_path: false,
        };
        machine.messages.reserve();
        machine.transfers.reserve();
        machine.record(Event::Boot);
        machine
    }

    /// What holds for a channel in this cycle.
    fn now(&self, k: usize) -> Option<Now> {
        let channel = self.channels.get(k)?;
        Some(Now {
            time_s: f64::from(self.core.timing.contour_us()) * 1e-6,
            us: self.now_us,
            start: channel.wanted.start,
            stop: channel.wanted.stop,
            fault: false,
            stop_pressed: channel.wanted.stop,
            ready: self.core.emergency.circuit() == Circuit::Ready,
            loops_closed: self.core.loops_closed,
            feed_percent: 100.0,
            program_percent: channel.feed_percent(),
            program_rapid: false,
            axis_keys: PerPlcAxis::splat(None),
            wheel_mm: PerPlcAxis::splat(0.0),
            rapid_limit_mm_min: channel.slope_mm_min,
        })
    }

    /// The run of a channel, what it reads, and where it acts.
    pub fn parts(&mut self, k: usize) -> Option<(&mut Run, Option<&mut Feeder>, Site<'_>)> {
        let now = self.now(k)?;
        let channel = self.channels.get_mut(k)?;
        let site = Site {
            number: channel.number,
            axes: self.core.axes.of(k),
            chain: &mut channel.chain,
            spindle: &mut channel.spindle,
            m: &channel.m,
            waits_for_m: &mut channel.waits_for_m,
            changes_tool: &mut channel.changes_tool,
            branch: &mut channel.branch,
            residual: &mut channel.residual,
            transfers: &mut self.transfers,
            memory: &mut self.memory,
            written: &mut self.written,
            at: None,
            now,
        };
        Some((&mut channel.run, channel.feeder.as_mut(), site))
    }

    /// Number and block of what starts in a channel, or runs: P8800 and P8801, or those of an emergency program.
    pub fn start_of(&self, k: usize) -> [i64; 2] {
        let number = k as u8 + 1;
        let first = match self.channels.get(k).and_then(|channel| channel.runs) {
            Some(which) => (ChannelParameter::EmergencyProgram, 2 * which as u32),
            None => (ChannelParameter::Program, 0),
        };
        [0, 1].map(|at| {
            let place = self.memory.channel_place_at(number, first.0, first.1 + at);
            place.and_then(|place| self.memory.at(place).whole()).unwrap_or(0)
        })
    }

    /// Records an event that the parameters ask for.
    pub fn record(&mut self, event: Event) {
        let time_ms = self.now_us / 1000;
        self.traffic.record(&self.memory, time_ms, event);
    }

    /// A parameter of a channel gets another value, and who is told of it.
    pub fn send(&mut self, number: u8, parameter: ChannelParameter, value: i64, by: Writer) {
        self.memory.set_channel(number, parameter, value);
        if let Some(place) = self.memory.channel_place(number, parameter) {
            self.pass(place, by);
        }
    }

    /// Somebody has written a place.
    pub fn pass(&mut self, place: Place, by: Writer) {
        let time_ms = self.now_us / 1000;
        self.traffic.pass(&mut self.memory, time_ms, by, place);
    }

    /// The number of a block of the program of a channel, as programs write it.
    pub fn block_number(&self, k: usize, block: BlockRef) -> u32 {
        let feeder = self.channels.get(k).and_then(|channel| channel.feeder.as_ref());
        match (self.language, feeder) {
            (Some(language), Some(feeder)) => (language.number)(feeder.reader(), block),
            _ => block.block,
        }
    }

    /// The program or cycle in which a block of a channel stands.
    pub fn program_name(&self, k: usize, block: BlockRef) -> ProgramName {
        let feeder = self.channels.get(k).and_then(|channel| channel.feeder.as_ref());
        let program = feeder.and_then(|feeder| feeder.reader().program(block.program));
        let of_file = program.and_then(|program| ProgramName::of_file(program.name()));
        of_file.unwrap_or_else(|| {
            let [number, _] = self.start_of(k);
            ProgramName::Program(u32::try_from(number).unwrap_or(0))
        })
    }

    /// A program that is read has the parameters meanwhile.
    pub fn give_memory(&mut self, k: usize) {
        let reader = self
            .channels
            .get_mut(k)
            .and_then(|channel| channel.feeder.as_mut());
        if let (Some(language), Some(feeder)) = (self.language, reader) {
            let memory = std::mem::replace(&mut self.memory, Memory::none());
            if let Some(memory) = (language.give)(feeder.reader_mut(), memory) {
                self.memory = memory;
            }
        }
    }

    /// The parameters are back.
    pub fn take_memory(&mut self, k: usize) {
        let reader = self
            .channels
            .get_mut(k)
            .and_then(|channel| channel.feeder.as_mut());
        if let (Some(language), Some(feeder)) = (self.language, reader)
            && let Some(memory) = (language.take)(feeder.reader_mut())
        {
            self.memory = memory;
        }
    }

    /// A message comes, and does what its kind says.
    pub fn raise(&mut self, number: u32, channel: u8, axis: Option<u8>, kind: Kind) {
        self.say(
            number,
            channel,
            axis,
            kind,
            crate::message::text_of(number).into(),
        );
    }

    /// The same with a text of its own.
    pub fn say(
        &mut self,
        number: u32,
        channel: u8,
        axis: Option<u8>,
        kind: Kind,
        text: std::borrow::Cow<'static, str>,
    ) {
        let message = Message {
            time_us: self.now_us,
            number,
            channel,
            axis,
            kind,
            text,
            acknowledged_us: None,
        };
        if !self.messages.raise(message) {
            return;
        }
        if let Some(number) = u16::try_from(number).ok().filter(|number| *number > 0) {
            self.record(Event::Message(channel, number));
        }
        for other in &mut self.channels {
            let is_own = other.number == channel;
            match kind {
                Kind::System => other.wanted.abort = true,
                Kind::High => other.wanted.abort |= is_own,
                Kind::Low => other.wanted.stop |= is_own,
                Kind::Display => {}
            }
        }
    }

    /// The run of a channel is broken off where it is.
    pub fn break_off(&mut self, k: usize) {
        let Some(channel) = self.channels.get(k) else {
            return;
        };
        if channel.run.progress().is_active() {
            let (number, block) = (channel.number, i64::from(self.block_number(k, channel.block())));
            let [program, _] = self.start_of(k);
            if let Some(channel) = self.channels.get_mut(k) {
                restart_place::keep(channel, &mut self.memory, program, block);
            }
            for (parameter, value) in [
                (ChannelParameter::BrokenProgram, program),
                (ChannelParameter::BrokenBlock, block),
            ] {
                self.memory.set_channel(number, parameter, value);
            }
        }
        self.leave(k);
    }

    /// Nothing of a run is left; its axes come down on their ramps.
    pub fn leave(&mut self, k: usize) {
        let Some((run, _, mut site)) = self.parts(k) else {
            return;
        };
        run.stop();
        run.break_off(&mut site.acting());
        site.axes.forget_path();
        run.track.path.clear();
        *site.waits_for_m = false;
        (*site.branch, *site.residual) = (None, None);
        let number = site.number;
        site.memory.set_channel(number, ChannelParameter::WaitsForM, 0);
        if let Some(channel) = self.channels.get_mut(k) {
            channel.jump = None;
        }
    }

    /// All axes of a channel are referenced.
    pub(crate) fn is_referenced(&self, k: usize) -> bool {
        let own = self.places.iter().zip(self.core.axes.iter());
        let mut own = own.filter(|(place, _)| usize::from(place.channel) == k);
        own.all(|(_, unit)| unit.referenced)
    }
}
