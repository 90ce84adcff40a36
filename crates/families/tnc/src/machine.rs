//! The machine side: axes, spindles, PLC and its memory, EMERGENCY STOP, messages, inputs and outputs, and what
//! survives power-off.
//!
//! Decision: A cell of a table that is edited is on the medium and counts at once, as what module 9094 writes; a new
//! line counts from power-on. The file of a pocket table takes over where the tools are (also
//! `panel/src/pages/table/editor.rs`)

use bahn_exchange::{Bit, BitArea, Exchange, signal};
use bahn_kernel::{Axes, AxisId, Circuit, CircuitOrder, Core, DriveOffsets, EmergencyStop, PerChannel};
use bahn_parameters::fault::{FaultId, Reaction};
use bahn_parameters::operation::{HandwheelParameters, Station};
use bahn_parameters::plc::PlcParameters;
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_path::BlockRef;
use bahn_plc::{Machine, PlcProgram, Start, TableKind, Tracer, mirror_parameters};
use bahn_servo::{Commands, Measured};

use crate::command::Command;
use crate::compensation::Compensation;
use crate::datum_tables::LoadedDatums;
use crate::handwheel;
use crate::life;
use crate::magazine::Magazine;
use crate::message::{Message, Messages};
use crate::oscilloscope::OscilloscopeKeys;
use crate::plc_link::PlcLink;
use crate::spindle::SpindleUnit;
use crate::status;
use crate::tables::{self, LoadedTables};
use crate::upkeep::{self, BufferBattery, MemoryTest};
use crate::window::Window;
use crate::without_plc;

const VOLTAGE_MISSING: Message = Message::Plain(MessageId::RelayExtDcVoltageMissing);
const EMERGENCY_STOP: Message = Message::Plain(MessageId::ExternalEmergencyStop);

/// What the machine side says of now.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    /// The contour cycle, s.
    pub time_s: f64,
    /// Time since power-on, µs.
    pub us: u64,
    /// The control voltage is on.
    pub ready: bool,
    /// The loops were closed since it came on.
    pub loops_closed: bool,
    /// A flashing message is shown, or a loop of the channel has a fault.
    pub fault: bool,
}

/// What all channels share.
#[derive(Clone)]
pub(crate) struct MachineSide {
    pub model: ControlModel,
    /// Axes and EMERGENCY STOP, which the kernel moves and watches.
    pub core: Core,
    station: Station,
    /// A programming station moves its axes in their nominal positions.
    moves_without_machine: bool,
    pub plc_parameters: PlcParameters,
    handwheel: HandwheelParameters,
    /// The memory of the PLC as each channel sees it; the first channel's is the memory itself.
    pub memory: PerChannel<Exchange>,
    /// Those of the channels beside the first one.
    pub windows: Vec<Window>,
    pub link: PlcLink,
    pub plc: PlcUnit,
    pub messages: Messages,
    pub spindles: PerChannel<SpindleUnit>,
    pub magazine: Magazine,
    pub offsets: DriveOffsets,
    pub oscilloscope: OscilloscopeKeys,
    pub compensation: Compensation,
    battery: BufferBattery,
    memory_test: MemoryTest,
    pub loaded_tables: LoadedTables,
    pub loaded_datums: LoadedDatums,
    /// What is to be stored has changed since it was stored.
    pub unsaved: bool,
    /// The control is to be reset (module 9033).
    pub reset_wanted: bool,
    wiring: Wiring,
}

/// What a machine side is made of.
pub(crate) struct MachineParts {
    pub plc: PlcUnit,
    pub link: PlcLink,
    /// The memory of the PLC, and the windows of the channels beside the first one.
    pub exchange: Exchange,
    pub windows: Vec<Window>,
    pub axes: Axes,
    pub compensation: Compensation,
    /// Of the first channel.
    pub spindle: SpindleUnit,
    pub magazine: Magazine,
    pub loaded_tables: LoadedTables,
    pub loaded_datums: LoadedDatums,
}

/// The PLC and its clock.
#[derive(Clone)]
pub(crate) struct PlcUnit {
    pub machine: Machine,
    due_us: u64,
    period_us: u64,
    /// Scans that were started.
    pub scans: u64,
    /// Its program calls modules 9040 or 9041: few do, and to find all coordinates before each scan is long.
    pub reads_coordinates: bool,
}

/// The inputs and outputs of the PLC with their operands.
#[derive(Clone)]
struct Wiring {
    /// First and last number of the inputs on each board.
    input_boards: &'static [(u16, u16)],
    /// I160 to I175, where a handwheel has its keys.
    handwheel_bits: Vec<(usize, Bit)>,
    output_bits: Vec<(usize, Bit)>,
}

impl PlcUnit {
    pub fn new(program: std::sync::Arc<PlcProgram>, model: ControlModel) -> PlcUnit {
        PlcUnit {
            reads_coordinates: program.calls_any(&[9040, 9041]),
            machine: Machine::new(program, Start::PowerOn),
            due_us: 0,
            period_us: model.limits().plc_cycle_us.into(),
            scans: 0,
        }
    }
}

impl Wiring {
    fn of(model: ControlModel) -> Wiring {
        let bits = |area: BitArea, boards: &[(u16, u16)]| {
            let numbers = boards.iter().flat_map(|(first, last)| *first..=*last);
            numbers
                .filter_map(|number| Some((usize::from(number), Bit::new(area, number)?)))
                .collect()
        };
        Wiring {
            input_boards: model.limits().inputs,
            handwheel_bits: bits(BitArea::I, &[(160, 175)]),
            output_bits: bits(BitArea::O, model.limits().outputs),
        }
    }
}

impl MachineSide {
    /// A command that is the same for all channels; `None` for any other.
    pub fn execute(&mut self, command: &Command) -> Option<bool> {
        Some(match command {
            Command::Ce => self.clear_message(),
            Command::ToolLife(tool, minutes) => self.set_tool_life(*tool, *minutes),
            Command::Table(kind, line, element, value) => self.take_element(*kind, *line, *element, *value),
            Command::Screen(screen) => self.link.show(*screen),
            Command::Oscilloscope(switch) => self.oscilloscope.press(switch.is_on()),
            Command::OffsetAdjustment(switch) => self.adjust_offsets(switch.is_on()),
            _ => return None,
        })
    }

    /// The file of a table says something else from now on: it counts with the next scan.
    fn take_element(&mut self, kind: TableKind, line: i32, element: usize, value: f64) -> bool {
        if !self.link.write_element(kind, line, element, value) {
            return false;
        }
        match kind {
            TableKind::Datum => self.loaded_datums.take(&self.link, line, element, value),
            _ => self.loaded_tables.take(kind, line, element, value),
        }
        if kind == TableKind::Pocket && element == tables::T {
            self.magazine.take_pocket(line, value);
        }
        self.unsaved = true;
        true
    }

    /// The current life of a tool, minutes; `false` for one that is not in the table.
    pub fn set_tool_life(&mut self, tool: u32, minutes: f64) -> bool {
        self.unsaved = true;
        life::set(&mut self.magazine, &mut self.link.files, tool, minutes)
    }

    /// The answer to the dialogue of the offset adjustment; `false` when it is not open.
    pub fn adjust_offsets(&mut self, adjust: bool) -> bool {
        let done = self.offsets.answer(adjust, &mut self.core.axes);
        self.unsaved |= done;
        done
    }

    /// A machine at power-on.
    pub fn new(parameters: &ParameterList, parts: MachineParts) -> MachineSide {
        let MachineParts {
            plc,
            link,
            exchange,
            windows,
            axes,
            compensation,
            spindle,
            magazine,
            loaded_tables,
            loaded_datums,
        } = parts;
        let model = parameters.model();
        let operation = parameters.operation_parameters();
        let memory = PerChannel::new(exchange, windows.iter().map(Window::memory).collect());
        let interval_s = axes
            .iter()
            .next()
            .map_or(0.0, |unit| unit.parameters.offset_interval_s);
        MachineSide {
            model,
            core: Core {
                timing: model.timing(),
                axes,
                emergency: EmergencyStop::new(
                    model.limits().emergency_stop_test,
                    operation.power_interrupted,
                ),
                loops_closed: false,
            },
            station: operation.station,
            moves_without_machine: operation.moves_without_machine,
            plc_parameters: parameters.plc_parameters(),
            handwheel: operation.handwheel,
            compensation,
            battery: BufferBattery::default(),
            memory_test: MemoryTest::new(&operation),
            memory,
            windows,
            link,
            plc,
            messages: Messages::default(),
            spindles: PerChannel::new(spindle, Vec::new()),
            magazine,
            offsets: DriveOffsets::new(interval_s),
            oscilloscope: OscilloscopeKeys::default(),
            loaded_tables,
            loaded_datums,
            unsaved: false,
            reset_wanted: false,
            wiring: Wiring::of(model),
        }
    }

    /// What holds now for a channel whose loops have a fault, or not.
    pub fn facts(&self, fault: bool) -> Facts {
        Facts {
            time_s: f64::from(self.core.timing.contour_us()) * 1e-6,
            us: self.messages.time_us(),
            ready: self.core.emergency.circuit() == Circuit::Ready,
            loops_closed: self.core.loops_closed,
            fault: fault || self.messages.is_fatal(),
        }
    }

    /// Letters of the axes, by their numbers.
    pub fn letters(&self) -> Vec<char> {
        let mut letters = vec!['X', 'Y', 'Z', '4', '5', 'S'];
        for unit in self.core.axes.iter() {
            let place = usize::from(unit.id.number());
            if letters.len() <= place {
                letters.resize(place + 1, ' ');
            }
            if let Some(letter) = letters.get_mut(place) {
                *letter = unit.axis.letter();
            }
        }
        letters
    }

    /// The axes are moved in their nominal positions, whatever is connected: MP170 of a TNC 151/155.
    pub fn has_no_machine(&self) -> bool {
        self.moves_without_machine
    }

    /// Whether a PLC scan is due. The PLC runs from the end of `POWER INTERRUPTED` on [000:7033-7040].
    pub fn scan_is_due(&mut self, now_us: u64) -> bool {
        let scans = self.station != Station::WithoutPlc || self.moves_without_machine;
        if !scans || self.plc.machine.stopped().is_some() {
            return false;
        }
        let runs = !matches!(
            self.core.emergency.circuit(),
            Circuit::PowerInterrupted | Circuit::Defective
        );
        if runs && self.plc.scans == 0 && self.plc.due_us < now_us {
            self.plc.due_us = now_us;
        }
        let due = runs && now_us >= self.plc.due_us;
        if due {
            self.plc.due_us += self.plc.period_us;
        }
        due
    }

    /// Its PLC has the interface of the TNC 151 and 155.
    pub fn has_old_interface(&self) -> bool {
        self.model.limits().has_old_numbers()
    }

    /// Whether somebody may look at the inputs in the servo step that begins then: a scan, or what monitors them.
    pub fn looks_at_inputs(&self, at_us: u64) -> bool {
        at_us >= self.plc.due_us || self.may_suppress_monitoring()
    }

    /// Reads the inputs for a scan.
    pub fn read_inputs(&mut self, measured: &Measured) {
        let exchange = self.memory.first_mut();
        for (first, last) in self.wiring.input_boards {
            let cells =
                usize::from(BitArea::I.first_cell() + first)..=usize::from(BitArea::I.first_cell() + last);
            let known = exchange.nc().cells().get(cells).unwrap_or_default();
            let read = measured.inputs.get(usize::from(*first)..=usize::from(*last));
            let read = read.unwrap_or_default();
            // Most of the time no contact has moved; all are compared at once.
            let differ = |differs, (known, read): (&u8, &bool)| differs | (*known ^ u8::from(*read));
            if known.len() == read.len() && known.iter().zip(read).fold(0, differ) == 0 {
                continue;
            }
            for number in *first..=*last {
                if let Some(bit) = Bit::new(BitArea::I, number) {
                    let read = measured.inputs.get(usize::from(number));
                    exchange.nc_put(bit, read.copied().unwrap_or(false));
                }
            }
        }
        let keys = handwheel::plc_inputs(&self.handwheel, &measured.operator.handwheel);
        for ((number, bit), key) in self.wiring.handwheel_bits.iter().zip(keys) {
            let contact = measured.inputs.get(*number).copied().unwrap_or(false);
            exchange.nc_put(*bit, contact || key);
        }
        status::analogue(self.plc_parameters.analogue_inputs, measured, exchange);
        for (marker, value) in self.messages.markers() {
            exchange.nc_put(marker, value);
        }
    }

    /// Runs the PLC program. `false` when it has stopped.
    pub fn scan(&mut self, block: Option<BlockRef>, tracer: Option<&mut (dyn Tracer + '_)>) -> bool {
        self.plc.scans += 1;
        if self.station == Station::WithoutPlc {
            without_plc::scan(self.memory.first_mut());
            return true;
        }
        let (exchange, others) = self.memory.split_mut();
        for (window, own) in self.windows.iter().zip(others.iter_mut()) {
            window.publish(own, exchange);
        }
        let scanned = match tracer {
            Some(tracer) => self.plc.machine.scan_traced(exchange, &mut self.link, tracer),
            None => self.plc.machine.scan(exchange, &mut self.link),
        };
        for (window, own) in self.windows.iter().zip(others) {
            window.take(own, exchange);
        }
        let Err(error) = scanned else { return true };
        let message = Message::PlcStopped {
            number: error.error.number(),
            file: error.file,
            line: error.line,
        };
        self.messages.of_machine().show(message, block);
        false
    }

    /// Sets the outputs as a scan left them.
    pub fn write_outputs(&mut self, commands: &mut Commands) {
        let nc = self.memory.first().nc();
        for (number, bit) in &self.wiring.output_bits {
            if let Some(output) = commands.outputs.get_mut(*number) {
                *output = nc.bit(*bit);
            }
        }
    }

    /// What the "control is ready" circuit asks for, with its messages.
    pub fn circuit_order(&mut self, block: Option<BlockRef>) -> CircuitOrder {
        if self.station != Station::Machine && !self.moves_without_machine {
            // A programming station has no machine: its loops stay open [000:6951].
            return CircuitOrder::Nothing;
        }
        if self.messages.is_fatal() {
            self.core.emergency.fail();
        }
        let circuit = self.core.emergency.circuit();
        if circuit == Circuit::VoltageMissing {
            self.messages.of_machine().show(VOLTAGE_MISSING, block);
        } else if self.messages.contains(&VOLTAGE_MISSING) {
            self.messages.remove(&VOLTAGE_MISSING);
        }
        let fault = match circuit {
            Circuit::Ready if !self.core.loops_closed => {
                if self.moves_without_machine {
                    // It has no marks to pass.
                    self.core.axes.iter_mut().for_each(|unit| unit.referenced = true);
                }
                return CircuitOrder::CloseLoops;
            }
            Circuit::PowerInterrupted | Circuit::VoltageMissing | Circuit::Testing | Circuit::Ready => {
                return CircuitOrder::Nothing;
            }
            Circuit::Defective => {
                if !self.messages.is_fatal() {
                    let defective = Message::Plain(MessageId::EmergencyStopDefective);
                    self.messages.of_machine().show(defective, block);
                }
                FaultId::EmergencyStopDefective
            }
            Circuit::EmergencyStop | Circuit::VoltageBack => {
                let nc = self.memory.first().nc();
                match nc.bit(signal::EMERGENCY_STOP_AS_NC_STOP) {
                    true => FaultId::EmergencyStopAsNcStop,
                    false => FaultId::ExternalEmergencyStop,
                }
            }
        };
        match fault.row().reaction {
            Reaction::ControlReadyOff => CircuitOrder::OpenLoops,
            Reaction::AllLoopsOpen => CircuitOrder::StopSilently,
            Reaction::RampThenOpen => CircuitOrder::Stop,
            _ => CircuitOrder::Nothing,
        }
    }

    /// The stop of the circuit is reported.
    pub fn show_emergency_stop(&mut self, block: Option<BlockRef>) {
        self.messages.of_machine().show(EMERGENCY_STOP, block);
    }

    /// W522 bit 0 lets the input MP4130, sampled in each control cycle, switch the monitoring off
    /// [000:5178-5188].
    pub fn monitoring_is_off(&self, measured: &Measured) -> bool {
        let permitted = self.may_suppress_monitoring();
        let Some(input) = self.plc_parameters.monitoring_input.filter(|_| permitted) else {
            return false;
        };
        measured
            .inputs
            .get(usize::from(input.input))
            .is_some_and(|high| *high == input.active_high)
    }

    fn may_suppress_monitoring(&self) -> bool {
        self.memory.first().nc().number(signal::MONITORING_SUPPRESSION) & 1 != 0
    }

    /// CE: clears a message, and what it stands for.
    pub fn clear_message(&mut self) -> bool {
        // EMERGENCY STOP only when the control voltage is back [000:6203-6204].
        let back = matches!(
            self.core.emergency.circuit(),
            Circuit::VoltageBack | Circuit::Ready
        );
        let Some(message) = self.messages.clear(self.memory.first_mut(), back) else {
            return false;
        };
        match message {
            Message::Plain(MessageId::PowerInterrupted | MessageId::ExternalEmergencyStop) => {
                self.core.emergency.clear();
            }
            Message::Plain(MessageId::OperatingParametersErased) => {
                let asked = Message::Plain(MessageId::MachineParameterAsked);
                self.messages.of_machine().show(asked, None);
            }
            Message::Axis {
                id: MessageId::PositioningError,
                axis,
                ..
            } => {
                let unit = AxisId::new(axis).and_then(|id| self.core.axes.with_id_mut(id));
                // A reference run of the PLC may have cancelled it already.
                if let Some(unit) = unit.filter(|unit| unit.servo.fault().is_some()) {
                    unit.servo.acknowledge();
                    unit.transfer();
                }
            }
            _ => {}
        }
        true
    }

    /// Once in each contour cycle, after all movements.
    pub fn look_after(&mut self, measured: &Measured) {
        self.battery
            .watch(measured.buffer_battery_low, &mut self.messages);
        self.memory_test
            .follow(measured.memory_defective, &mut self.messages);
        let off = self.spindles.iter().all(|spindle| spindle.state().volts == 0.0);
        self.offsets
            .adjust_cyclically(self.core.timing.contour_us(), off, &mut self.core.axes);
        self.compensation.correct(&mut self.core.axes);
        upkeep::leave_limits(&mut self.core.axes, &self.messages);
    }

    /// Goes over to the machine parameters that module 9031 has changed.
    pub fn take_parameters(&mut self) {
        let list = self.link.list();
        mirror_parameters(list, self.memory.first_mut());
        self.plc_parameters = list.plc_parameters();
        self.handwheel = list.operation_parameters().handwheel;
    }
}
