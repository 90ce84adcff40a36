//! The seam between control and machine.

/// PLC inputs that a plant may have: I0 to I383.
pub const INPUTS: usize = 384;
/// PLC outputs that a plant may have: O0 to O191.
pub const OUTPUTS: usize = 192;

/// A machine as the logic unit sees it through its connectors: nominal value outputs, encoder inputs, PLC
/// inputs and outputs, override potentiometers, handwheel.
///
/// Time passes only in [`Plant::advance`]; everything read is the state at the end of it. A plant does not
/// allocate in these calls, and the same calls give the same answers.
pub trait Plant {
    /// Lets time pass with everything as last set, in µs.
    fn advance(&mut self, micros: u32);

    /// Sets an analogue output, -10 V to +10 V: 0 to 4 are outputs 1 to 5 of MP120, 5 is output S
    /// [000:3374-3406]. Outputs that do not exist are ignored.
    fn set_nominal(&mut self, output: usize, volts: f64);

    /// Reads an encoder input, 0 to 5 for X1 to X6 [000:3374-3406]. An input without encoder reads as one
    /// that stands still.
    fn encoder(&mut self, input: usize) -> Encoder;

    /// Reads the PLC inputs; the index is the number of the input.
    fn inputs(&mut self, inputs: &mut [bool; INPUTS]);

    /// Sets the PLC outputs; the index is the number of the output. Called at the end of each PLC scan.
    fn set_outputs(&mut self, outputs: &[bool; OUTPUTS]);

    /// Switches the output X41/34 "control is ready" [000:6151].
    fn set_control_ready(&mut self, on: bool);

    /// The acknowledgement "control is ready" at X42/4, input I3 [000:6151].
    fn control_ready(&mut self) -> bool;

    /// The controls of the operating panel that the NC reads itself.
    fn operator(&mut self) -> OperatorInputs;

    /// Whether the touch probe is deflected.
    fn probe_deflected(&mut self) -> bool {
        false
    }

    /// Whether the touch probe is there and ready (X12/3) [000:1694-1765].
    fn probe_ready(&mut self) -> bool {
        true
    }

    /// Whether the battery of the touch probe is low (X12/7).
    fn probe_battery_low(&mut self) -> bool {
        false
    }

    /// Analogue input of a PLC input board, V: 0 to 3 of the first, 4 to 7 of the second
    /// [000:8449-8484].
    fn analogue_input(&mut self, input: usize) -> f64 {
        let _ = input;
        0.0
    }

    /// Temperature at a Pt 100 input, degrees Celsius: 0 to 3 of the first board, 4 to 7 of the second
    /// [000:8449-8484].
    fn temperature_input(&mut self, input: usize) -> f64 {
        let _ = input;
        0.0
    }

    /// Sets an analogue output of the PLC (module 9130), V [000:8486-8490].
    fn set_plc_analogue(&mut self, output: usize, volts: f64) {
        let _ = (output, volts);
    }
}

/// What an encoder input has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Encoder {
    /// Steps counted since power-on, [`Encoder::STEPS`] to a signal period (after interpolation, before
    /// the counting direction MP210).
    pub count: i64,
    /// The count latched when a reference mark was last crossed since the last reading.
    pub mark: Option<i64>,
    /// The signal amplitude is too small (monitoring A) [000:3294].
    pub amplitude_low: bool,
    /// The signal edges follow each other too closely (monitoring B) [000:3295].
    pub edges_too_close: bool,
}

impl Encoder {
    /// Counting steps of a signal period.
    pub const STEPS: i64 = 1024;
}

/// The state of the controls that the NC reads without the PLC.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OperatorInputs {
    /// Feed-rate override potentiometer, 0 to 150 %.
    pub feed_override_percent: f64,
    /// Spindle-speed override potentiometer, 0 to 150 %.
    pub spindle_override_percent: f64,
    /// Counting steps of the handwheel since power-on.
    pub handwheel_count: i64,
}
