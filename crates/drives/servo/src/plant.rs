//! The seam between control and machine.
//!
//! Decision: The fault word of a drive is GROSS POSITIONING ERROR C: the axis does not move as it is told; status
//! words are not judged
//!
//! Decision: What a square-wave input counts begins with a whole measuring step where the encoder stands at power-on;
//! inputs of models whose manuals name none are for sine signals (also `parameters/src/limits.rs`)

use crate::handwheel::HandwheelInputs;

/// PLC inputs that a plant may have: I0 to I383.
pub const INPUTS: usize = 384;
/// PLC outputs that a plant may have: O0 to O191.
pub const OUTPUTS: usize = 192;
/// Nominal value outputs: 0 to 4 are outputs 1 to 5 of MP120, 5 is output S [000:3374-3406]; the others are those of
/// machines with several channels, up to 32 axes and 8 spindles.
pub const NOMINALS: usize = 40;
/// Encoder inputs: 0 to 5 are X1 to X6 [000:3374-3406]; the others as the outputs.
pub const ENCODERS: usize = 40;
/// Analogue inputs of PLC input boards: 0 to 3 of the first, 4 to 7 of the second [000:8449-8484].
pub const ANALOGUE_INPUTS: usize = 8;

/// A machine as the logic unit sees it through its connectors: nominal value outputs, encoder inputs, PLC
/// inputs and outputs, override potentiometers, handwheel, touch probe.
///
/// `docs/plant.md` tells how one is written for real drives; [`IdealAxes`](crate::IdealAxes) is the shortest one.
pub trait Plant {
    /// Lets the time of a servo step pass under the commands and tells what is measured at its end.
    ///
    /// A step without length asks what is there now: at power-on, and before each contour cycle, since somebody
    /// may have touched the machine. Then encoders answer as before but for their faults: the marks of
    /// the step before are still there.
    ///
    /// A plant fills in all that it has; the rest stays as it is in [`Measured::default`]. It does not allocate
    /// here, and a simulated one gives the same answers to the same calls.
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured);
}

/// A piece of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Step {
    /// Its beginning from power-on, µs.
    pub from_us: u64,
    /// Its length, µs.
    pub length_us: u32,
}

/// What the control wants of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Commands {
    /// By the number of the nominal value output.
    pub axes: [AxisCommand; NOMINALS],
    /// The PLC outputs by their numbers, as the last scan left them.
    pub outputs: [bool; OUTPUTS],
    /// The output X41/34 "control is ready" [000:6151].
    pub control_ready: bool,
    /// The PLC inputs are looked at after this step; else a plant may leave them as they were.
    pub reads_inputs: bool,
}

impl Default for Commands {
    fn default() -> Commands {
        Commands {
            axes: [AxisCommand::default(); NOMINALS],
            outputs: [false; OUTPUTS],
            control_ready: false,
            reads_inputs: true,
        }
    }
}

/// What one drive is to do in a step: it takes of voltage, speed, position and torque what it follows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisCommand {
    /// The loop is closed and the axis has its feed enable: the drive holds torque. An output that is no axis
    /// under control is not enabled, whatever its voltage.
    pub enabled: bool,
    /// The analogue output, -10 V to +10 V: the speed with the polarity of MP1040, or where the control closes the speed
    /// loop the torque with that of MP1950 [000:18329-18333].
    pub volts: f64,
    /// The speed that the voltage stands for, mm/min, degrees/min or rpm, in the sense of the axis: position
    /// loop and pre-control.
    pub speed_per_min: f64,
    /// The torque as part of what the drive gives at 10 V, -1 to +1, in the counting sense of the motor's encoder with the
    /// polarity of MP1950. `None` where the drive closes the speed loop, which is everywhere but on axes with MP1900
    /// whose motor's encoder is read ([`Measured::motors`]).
    pub torque: Option<f64>,
    /// Where the encoder is to stand at the end of the step, counting steps since power-on. `None` where the
    /// control closes no position loop.
    pub position_steps: Option<f64>,
}

/// What a machine answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// By the number of the encoder input. An input without encoder is one that stands still.
    pub encoders: [Encoder; ENCODERS],
    /// By the number of the nominal value output.
    pub drives: [Drive; NOMINALS],
    /// What the motor's encoder at X15 to X19 has counted since power-on, by the number of the nominal value output (X15
    /// belongs to output 1, inferred): [`Encoder::MOTOR_STEPS`] to a grating period [000:18345]. `None` where there is
    /// none: the drive controls its speed itself.
    pub motors: [Option<i64>; NOMINALS],
    /// The acknowledgement "control is ready" at X42/4, input I3 [000:6151].
    pub control_ready: bool,
    /// When that changed first in the step, µs from its beginning: the test of the EMERGENCY STOP circuit is finer than
    /// the servo steps of some controls [000:6175-6228].
    pub control_ready_changed_at: Option<u32>,
    /// The PLC inputs by their numbers.
    pub inputs: [bool; INPUTS],
    /// The controls of the operating panel that the NC reads itself.
    pub operator: OperatorInputs,
    /// What the touch probe in the spindle gives.
    pub probe: Probe,
    /// What the tool probe on the table gives.
    pub tool_probe: Probe,
    /// The buffer battery of the control's memory is low [000:1385-1400].
    pub buffer_battery_low: bool,
    /// The memory of the control does not pass its test at power-on: its RAM; its EPROMs and the checksum [001:2369-2371].
    pub memory_defective: [bool; 2],
    /// Analogue inputs of the PLC, V.
    pub volts: [f64; ANALOGUE_INPUTS],
    /// Pt 100 inputs of the PLC, degrees Celsius.
    pub temperatures: [f64; ANALOGUE_INPUTS],
}

impl Default for Measured {
    fn default() -> Measured {
        Measured {
            encoders: [Encoder::default(); ENCODERS],
            drives: [Drive::default(); NOMINALS],
            motors: [None; NOMINALS],
            control_ready: false,
            control_ready_changed_at: None,
            inputs: [false; INPUTS],
            operator: OperatorInputs::default(),
            probe: Probe::default(),
            tool_probe: Probe::default(),
            buffer_battery_low: false,
            memory_defective: [false; 2],
            volts: [0.0; ANALOGUE_INPUTS],
            temperatures: [0.0; ANALOGUE_INPUTS],
        }
    }
}

impl Measured {
    /// An encoder input; one that does not exist stands still.
    pub fn encoder(&self, input: usize) -> Encoder {
        self.encoders.get(input).copied().unwrap_or_default()
    }

    /// The motor's encoder of the drive at an output.
    pub fn motor(&self, output: usize) -> Option<i64> {
        self.motors.get(output).copied().flatten()
    }

    /// The drive at an output; one that does not exist says nothing.
    pub fn drive(&self, output: usize) -> Drive {
        self.drives.get(output).copied().unwrap_or_default()
    }
}

/// What an encoder input has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Encoder {
    /// Steps counted since power-on, [`Encoder::STEPS`] to a signal period (after interpolation, before
    /// the counting direction MP210).
    pub count: i64,
    /// The count latched when a reference mark was last crossed in the step.
    pub mark: Option<i64>,
    /// The signal amplitude is too small (monitoring A) [000:3294].
    pub amplitude_low: bool,
    /// The signal edges follow each other too closely (monitoring B) [000:3295].
    pub edges_too_close: bool,
}

impl Encoder {
    /// Counting steps of a signal period.
    pub const STEPS: i64 = 1024;
    /// Counting steps of a grating period of a motor's encoder at X15 to X19 [000:18299] [000:18345].
    pub const MOTOR_STEPS: i64 = 256;
    /// Counting steps of a measuring step at a square-wave input, which evaluates the signals fourfold [000:3214]: of some axes,
    /// and that of the spindle [000:18316].
    pub const SQUARE_WAVE_STEPS: i64 = Encoder::STEPS / 4;

    /// What a square-wave input sees of it: whole measuring steps.
    pub(crate) fn fourfold(self) -> Encoder {
        let whole = |count: i64| count.div_euclid(Self::SQUARE_WAVE_STEPS) * Self::SQUARE_WAVE_STEPS;
        Encoder {
            count: whole(self.count),
            mark: self.mark.map(whole),
            ..self
        }
    }
}

/// What a drive says of itself on a bus; an analogue drive says nothing, its contact is a PLC input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drive {
    /// Status word, as the drive has it: shown, not judged.
    pub status: u16,
    /// Fault word: 0 for none. With any other the axis is as one that does not move as it is told (inferred): GROSS
    /// POSITIONING ERROR C.
    pub fault: u16,
}

/// Signals of a touch probe or tool probe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Probe {
    /// The stylus is deflected.
    pub deflected: bool,
    /// It is there and ready (X12/3) [000:1694-1765].
    pub ready: bool,
    /// Its battery is low (X12/7).
    pub battery_low: bool,
    /// How far the stylus of a measuring probe (TM 110) is deflected along its own axes X, Y, Z, mm, as its measuring
    /// systems count [000:7895-7905]; a triggering one leaves 0.
    pub deflection_mm: [f64; 3],
}

/// The state of the controls that the NC reads without the PLC.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OperatorInputs {
    /// Feed-rate override potentiometer, 0 to 150 %.
    pub feed_override_percent: f64,
    /// Spindle-speed override potentiometer, 0 to 150 %.
    pub spindle_override_percent: f64,
    /// Counts and keys of the handwheel.
    pub handwheel: HandwheelInputs,
}
