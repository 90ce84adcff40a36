//! Machine side and channels under the clock of the kernel: how they are put together, and what is asked of both.

use bahn_kernel::{Axes, AxisUnit, Cartesian, Clock, PerChannel, ServoSampler, first_ids, units};
use bahn_parameters::{MessageId, ParameterList};
use bahn_plc::{Tracer, mirror_parameters};
use bahn_servo::{IdealAxes, Plant, Timing};

use crate::axis_switchover::AxisSwitchover;
use crate::channel::{Channel, Parts};
use crate::command::Command;
use crate::compensation::Compensation;
use crate::cycle::Cycle;
use crate::datum_tables::LoadedDatums;
use crate::hand_over::Ordered;
use crate::machine::{MachineParts, MachineSide, PlcUnit};
use crate::magazine::Magazine;
use crate::message::Message;
use crate::plc_link::{PalletSelection, PlcLink};
use crate::setup::{ChannelError, ChannelSetup, Remembered, Setup};
use crate::source::Reading;
use crate::spindle::SpindleUnit;
use crate::tables::LoadedTables;
use bahn_kernel::SpindleWiring;

/// What runs while the supply is on.
#[derive(Clone)]
pub(crate) struct Tnc {
    pub clock: Clock,
    pub machine: MachineSide,
    pub channels: PerChannel<Channel>,
    /// Tool changes and datums must be stored before their strobe is reset.
    pub keeps: bool,
    /// The axes that the PLC may hand over.
    pub ordered: Vec<Ordered>,
    /// Axis IV in the place of another one.
    switchover: AxisSwitchover,
    /// The axes of a programming station.
    ideal: IdealAxes,
}

/// The spindle of the first channel.
fn first_spindle(list: &ParameterList, timing: Timing) -> SpindleUnit {
    let parameters = list.spindle_parameters();
    let wiring = SpindleWiring {
        input: parameters.input.into(),
        ..SpindleWiring::default()
    };
    SpindleUnit::new(wiring, parameters, timing)
}

fn take_offsets(axes: &mut Axes, channel: usize, remembered: &Remembered) {
    for unit in axes.of(channel).iter_mut() {
        let volts = remembered.offsets_volts.get(unit.index).copied();
        unit.servo.set_offset_compensation(volts.unwrap_or(0.0));
    }
}

/// The line of the pallet table and the datum table that were selected.
fn pallet(remembered: &Remembered) -> PalletSelection {
    PalletSelection {
        line: remembered.pallet_line,
        datum_table: remembered.datum_table.clone(),
    }
}

impl Tnc {
    /// A TNC of one channel at power-on.
    pub fn new(setup: Setup) -> Tnc {
        let axes = units(&setup.parameters, (0, 0), first_ids());
        Tnc::build(setup, Vec::new(), axes)
    }

    /// A TNC of one channel or several at power-on.
    ///
    /// # Errors
    /// Why the channels cannot be put together.
    pub fn with_channels(setup: Setup, others: Vec<ChannelSetup>) -> Result<Tnc, ChannelError> {
        if others.len() >= ChannelError::CHANNELS_MAX {
            return Err(ChannelError::TooMany);
        }
        let mut axes = units(&setup.parameters, (0, 0), first_ids());
        for (channel, other) in (1..).zip(&others) {
            let of = (channel, other.connectors.into());
            axes.extend(units(&other.parameters, of, other.axes));
        }
        let mut ids = std::collections::BTreeSet::new();
        match axes.iter().find(|unit| !ids.insert(unit.id)) {
            Some(twice) => Err(ChannelError::AxisTwice(twice.id)),
            None => Ok(Tnc::build(setup, others, axes)),
        }
    }

    fn build(setup: Setup, others: Vec<ChannelSetup>, units: Vec<AxisUnit>) -> Tnc {
        let Setup {
            parameters,
            plc,
            plc_messages,
            plc_dialogues,
            tools,
            checking,
            inch_feed,
            functions,
            programs,
            files,
            remembered,
            mut exchange,
        } = setup;
        let model = parameters.model();
        let timing = model.timing();
        let mut axes = Axes::new(units, timing);
        take_offsets(&mut axes, 0, &remembered);
        for (channel, other) in (1..).zip(&others) {
            take_offsets(&mut axes, channel, &other.remembered);
        }
        mirror_parameters(&parameters, &mut exchange);
        let spindle = first_spindle(&parameters, timing);
        let mut link = PlcLink::new(parameters.clone(), plc_messages, plc_dialogues, files);
        link.selected_list.clone_from(&remembered.parameter_list);
        link.pallet = pallet(&remembered);
        let loaded_datums = LoadedDatums::set_up(&mut link, &remembered.written_datums);
        let mut magazine = Magazine::new(tools, &remembered.pockets);
        let loaded_tables = LoadedTables::set_up(
            &mut magazine,
            &mut link.files,
            &remembered.written,
            parameters.operation_parameters().tools.pockets,
        );
        let compensation = Compensation::at_power_on(&link.files, remembered.compensation_line);
        let switchover = AxisSwitchover::new(model, &plc);
        let parts = MachineParts {
            plc: PlcUnit::new(plc, model),
            link,
            exchange,
            windows: others.iter().map(|other| other.window.clone()).collect(),
            axes,
            compensation,
            spindle,
            magazine,
            loaded_tables,
            loaded_datums,
        };
        let mut machine = MachineSide::new(&parameters, parts);
        let reading = Reading {
            model,
            checking,
            inch_feed,
            functions,
            programs,
        };
        let parts = Parts {
            number: 0,
            own_list: None,
            kinematics: std::sync::Arc::new(Cartesian),
            reading: reading.clone(),
        };
        let first = Channel::new(parts, &remembered, &mut machine);
        let mut channels = PerChannel::new(first, Vec::new());
        for other in others {
            let channel = beside(other, channels.count(), &reading, &mut machine);
            channels.push(channel);
        }
        let mut tnc = Tnc {
            clock: Clock::default(),
            machine,
            channels,
            keeps: false,
            ordered: Vec::new(),
            switchover,
            ideal: IdealAxes::default(),
        };
        tnc.show_power_interrupted();
        tnc
    }

    /// Spends a contour cycle on a machine, shows a tracer what the PLC executes in it, and a sampler the axes in each
    /// servo step. While the supply is off, time passes on the machine alone.
    pub fn cycle(
        &mut self,
        is_off: bool,
        plant: &mut dyn Plant,
        tracer: Option<&mut (dyn Tracer + '_)>,
        sampler: Option<&mut (dyn ServoSampler + '_)>,
    ) {
        let mut cycle = Cycle {
            machine: &mut self.machine,
            channels: &mut self.channels,
            keeps: self.keeps,
            tracer,
        };
        match cycle.machine.has_no_machine() {
            true => {
                let mut desktop = self.ideal.over(plant);
                self.clock.cycle(&mut cycle, is_off, &mut desktop, sampler);
            }
            false => self.clock.cycle(&mut cycle, is_off, plant, sampler),
        }
    }

    /// A command for a channel; `false` when it is not possible now.
    pub fn execute(&mut self, channel: usize, command: Command) -> bool {
        self.channels.of_mut(channel).execute(command, &mut self.machine)
    }

    /// After power-on, if the machine builder wants it so.
    pub fn show_power_interrupted(&mut self) {
        let operation = self.machine.link.list().operation_parameters();
        if operation.power_interrupted {
            let message = Message::Plain(MessageId::PowerInterrupted);
            self.machine.messages.of_machine().show(message, None);
        }
    }

    /// It is the same control that was on before: its time goes on, and whoever drives it does as before.
    pub fn follow_on(&mut self, before: &Tnc) {
        self.clock.follow_on(&before.clock);
        self.machine.messages.restart(before.machine.messages.time_us());
        self.machine.link.lines.follow_on(&before.machine.link.lines);
        self.keeps = before.keeps;
        self.ordered.clone_from(&before.ordered);
        for (new, old) in self.channels.iter_mut().zip(before.channels.iter()) {
            new.run.source.tap = old.run.source.tap;
            new.run.source.defers = old.run.source.defers;
            new.run.core.block_time.clone_from(&old.run.core.block_time);
        }
    }

    /// Interprets and plans ahead; may allocate.
    pub fn prepare(&mut self) {
        for ordered in &mut self.ordered {
            ordered.follow(&mut self.channels, &mut self.machine);
        }
        self.switchover.follow(&mut self.channels, &mut self.machine);
        let datums_changed = std::mem::take(&mut self.machine.loaded_datums.changed);
        for channel in self.channels.iter_mut() {
            channel.prepare(datums_changed, &mut self.machine);
        }
    }
}

/// A channel beside the first one, with its spindle.
fn beside(setup: ChannelSetup, number: usize, reading: &Reading, machine: &mut MachineSide) -> Channel {
    let parameters = setup.parameters.spindle_parameters();
    let spindle = SpindleUnit::new(setup.spindle, parameters, machine.core.timing);
    machine.spindles.push(spindle);
    let parts = Parts {
        number,
        own_list: Some(setup.parameters),
        kinematics: setup.kinematics,
        reading: Reading {
            programs: setup.programs,
            ..reading.clone()
        },
    };
    Channel::new(parts, &setup.remembered, machine)
}
