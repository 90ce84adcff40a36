//! The spindle as the kernel sees it: speed and gear towards the PLC, the PLC's markers towards the servo
//! [000:5438-5945].
//!
//! Decision: The PL 410 has analogue inputs only; the one analogue voltage that a PLC program gives is output S, by
//! module 9130
//!
//! Decision: On TNC 151/155 M2504 compares with the speed that the voltage stands for. Code 31 of the orientation, the
//! reference mark [001:1834], is the angle of the orientation cycle, and MP240 where none was executed
//!
//! Decision: What the PLC asks of a spindle in a thread waits for the end of the thread; an EMERGENCY STOP ends its
//! orientation and resets M2712

use bahn_exchange::{Bit, Exchange, Image, signal};
use bahn_kernel::{Along, SpindleLoop, SpindleWiring, VoltageOutput};
use bahn_parameters::plc::PlcParameters;
use bahn_parameters::spindle::{FreeOutput, GearSignal, SpindleOutput, SpindleParameters};
use bahn_path::Voltage;
use bahn_plc::{ControlledSpindle, OrientationDirection, SpindleOrientation, SpindlePosition};
use bahn_servo::{AxisCommand, Commands, Rotation, SpeedCode, Timing, Way};

use crate::handshake::Transfer;
use crate::marker_codes;
use crate::panel::PlcFaultCode;
use crate::plc_link::Requests;
use crate::strobe_form::{Form, ORIENTATION};

/// Range of the analogue outputs, V.
const OUTPUT_VOLTS: f64 = 10.0;
/// D356, D756 and module 9171 count in 1/1000 rpm.
const PER_RPM: f64 = 1000.0;
/// D592 counts in 1/10 000 degree (inferred).
const PER_DEGREE: f64 = 10_000.0;
/// D592 with bit 31 alone: the angle of cycle 13.
const ANGLE_OF_CYCLE: i32 = i32::MIN;
/// The code of the marker form that is the reference mark on the TNC 151/155 [001:1834] [001:3117-3137].
const REFERENCE_MARK: u32 = 31;
/// M2504 of the TNC 151/155: the comparator speed is not reached [001:1516-1536]. The TNC 355 has another use for it.
const BELOW_COMPARATOR: Bit = signal::AXIS_CLAMPING_AFTER_CONSTANT_CONTOUR_TRANSITION_TNC355;

/// The state of the spindle for displays and reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleState {
    /// Speed of the S word, rpm.
    pub programmed_rpm: f64,
    /// Nominal speed with override and limits, rpm.
    pub nominal_rpm: f64,
    /// Actual speed, rpm, negative as M04.
    pub actual_rpm: f64,
    /// Nominal voltage at the output, V.
    pub volts: f64,
    /// Gear range, 1 to 8.
    pub gear: u8,
    /// M03, M04 or M05 as shown.
    pub rotation: Rotation,
    /// Its angle, degrees, once its reference mark was crossed.
    pub angle_deg: Option<f64>,
}

/// A spindle with what program, operator and PLC want of it.
#[derive(Clone, Debug)]
pub(crate) struct SpindleUnit {
    pub drive: SpindleLoop,
    rotation: Rotation,
    programmed_rpm: f64,
    code: Option<u8>,
    /// Gear and speed that are on their way to the PLC.
    pending: Option<(u8, f64)>,
    /// Angle of cycle 13, degrees, once it was executed.
    cycle_deg: Option<f64>,
    /// A speed was refused since somebody asked.
    wrong_speed: bool,
    /// The speed was refused (M2092).
    wrong: bool,
    /// Markers as of the last scan, for their edges.
    shown: [bool; 3],
    jogging: bool,
    turning: bool,
    orienting: bool,
    /// What module 9171 asked for.
    asked: Option<SpindleOrientation>,
    /// The orientation was ordered by M2527: its strobe and complement are as at rest at the end.
    by_markers: bool,
    /// M2527 was set in the last scan.
    ordered: bool,
    plc_volts: f64,
    feed_volts: f64,
    by_program: VoltageOutput,
    cycle_s: f64,
}

impl SpindleUnit {
    pub fn new(wiring: SpindleWiring, parameters: SpindleParameters, timing: Timing) -> SpindleUnit {
        SpindleUnit {
            drive: SpindleLoop::new(wiring, parameters, timing),
            rotation: Rotation::M5,
            programmed_rpm: 0.0,
            code: None,
            pending: None,
            cycle_deg: None,
            wrong_speed: false,
            wrong: false,
            shown: [false; 3],
            jogging: false,
            turning: false,
            orienting: false,
            asked: None,
            by_markers: false,
            ordered: false,
            plc_volts: 0.0,
            feed_volts: 0.0,
            by_program: VoltageOutput::default(),
            cycle_s: f64::from(timing.contour_us()) * 1e-6,
        }
    }

    fn is_analogue(&self) -> bool {
        matches!(self.drive.parameters.output, SpindleOutput::Analogue { .. })
    }

    /// Markers and words at power-on.
    pub fn preset(&self, exchange: &mut Exchange) {
        exchange.nc_set(signal::SPINDLE_IS_ANALOGUE, self.is_analogue());
        let codes = self.drive.parameters.codes;
        exchange.nc_set_number(signal::MINIMUM_S_CODE, codes.min.into());
        marker_codes::LOWEST_SPEED.put(codes.min.into(), exchange);
        marker_codes::SPEED_STEP.put(codes.step.into(), exchange);
    }

    /// Gives the voltage of a servo step, and the enable, to the drive.
    pub fn output(&mut self, commands: &mut Commands) {
        let volts = self.drive.servo.step();
        let (enabled, volts, speed) = if self.is_analogue() {
            (
                self.drive.servo.is_enabled(),
                volts,
                self.drive.servo.output_rpm(),
            )
        } else {
            match self.drive.parameters.free_output {
                FreeOutput::Plc => (false, self.plc_volts, 0.0),
                FreeOutput::Feed { .. } => (false, self.feed_volts, 0.0),
                FreeOutput::MFunctions => (false, self.by_program.volts(), 0.0),
                FreeOutput::None => return,
            }
        };
        if let Some(output) = commands.axes.get_mut(self.drive.wiring.output) {
            *output = AxisCommand {
                enabled,
                volts,
                speed_per_min: speed,
                torque: None,
                position_steps: None,
            };
        }
    }

    /// Where output S follows the path: in proportion to its feed, 10 V at MP3012 [000:9835-9839], or as M200 to
    /// M204 say.
    pub fn follow(&mut self, along: Along) {
        match self.drive.parameters.free_output {
            FreeOutput::Feed { full_mm_min } => {
                let volts = along.mm_min / full_mm_min * OUTPUT_VOLTS;
                self.feed_volts = if volts.is_finite() {
                    volts.clamp(0.0, OUTPUT_VOLTS)
                } else {
                    0.0
                };
            }
            FreeOutput::MFunctions => self.by_program.cycle(along, self.cycle_s),
            FreeOutput::None | FreeOutput::Plc => {}
        }
    }

    /// M200 to M204 of the block with a sequence.
    pub fn set_voltage(&mut self, order: Voltage, sequence: u64) {
        self.by_program.order(order, sequence);
    }

    /// Module 9130: a voltage at output S, where the spindle does not use it.
    pub fn set_plc_volts(&mut self, volts: f64) {
        self.plc_volts = volts;
    }

    /// Whether the spindle has a speed.
    pub fn has_speed(&self, rpm: f64) -> bool {
        match self.drive.parameters.output {
            SpindleOutput::None => true,
            SpindleOutput::Coded { .. } => self.speed_code(rpm).is_some(),
            SpindleOutput::Analogue { .. } => self.drive.servo.gear_for(rpm).is_some(),
        }
    }

    /// A speed that the spindle does not have is refused: M2092 [000:5653-5656].
    pub fn judge(&mut self, rpm: f64, exchange: &mut Exchange) -> bool {
        let has = self.has_speed(rpm);
        self.wrong = !has;
        self.wrong_speed |= !has;
        exchange.nc_set(signal::ILLEGAL_SPINDLE_SPEED, self.wrong);
        has
    }

    /// The S code of a speed, where MP3020 permits it.
    fn speed_code(&self, rpm: f64) -> Option<SpeedCode> {
        SpeedCode::nearest(rpm).filter(|code| code.permitted(&self.drive.parameters.codes))
    }

    /// A programmed speed that the spindle [has](SpindleUnit::judge): the gear range or the S code that goes to the PLC, when
    /// one does.
    pub fn program(&mut self, rpm: f64, tool_call: bool, exchange: &mut Exchange) -> Option<Transfer> {
        self.programmed_rpm = rpm;
        match self.drive.parameters.output {
            SpindleOutput::None => None,
            SpindleOutput::Coded { always } => {
                let code = self.speed_code(rpm)?.number();
                let changed = self.code.replace(code) != Some(code);
                (changed || always && tool_call).then_some(Transfer::SCode(code))
            }
            SpindleOutput::Analogue { gear: when } => {
                let gear = self.drive.servo.gear_for(rpm)?;
                self.choose_gear(rpm, gear, when, tool_call, exchange)
            }
        }
    }

    fn choose_gear(
        &mut self,
        rpm: f64,
        gear: u8,
        when: GearSignal,
        tool_call: bool,
        exchange: &mut Exchange,
    ) -> Option<Transfer> {
        let speed = (rpm * PER_RPM).round() as i32;
        let signal = match when {
            GearSignal::OnChange => gear != self.drive.servo.gear_range(),
            GearSignal::Always => tool_call || gear != self.drive.servo.gear_range(),
            GearSignal::Never => false,
        };
        if signal {
            self.pending = Some((gear, rpm));
            return Some(Transfer::Gear { code: gear, speed });
        }
        self.drive.servo.set_speed(rpm, gear);
        exchange.nc_set_number(signal::PROGRAMMED_SPINDLE_SPEED, speed);
        exchange.nc_set_number(signal::SPINDLE_SPEED_FROM_PLC, speed);
        None
    }

    /// The PLC acknowledged the gear: from now on the speed is that of it.
    pub fn gear_changed(&mut self) {
        if let Some((gear, rpm)) = self.pending.take() {
            self.drive.servo.set_speed(rpm, gear);
        }
    }

    /// A speed was refused since the last call.
    pub fn take_wrong_speed(&mut self) -> bool {
        std::mem::take(&mut self.wrong_speed)
    }

    /// Cycle 13: the angle that D592 = $80000000 stands for; M2408 tells the PLC [000:5853-5865].
    pub fn set_cycle_angle(&mut self, angle_deg: f64, exchange: &mut Exchange) {
        self.cycle_deg = Some(angle_deg);
        exchange.nc_set(signal::CYCLE_13_EXECUTED, true);
    }

    /// Module 9171, which has set M2712.
    fn orient(&mut self, orientation: SpindleOrientation) {
        let added = if orientation.added_to_cycle {
            self.cycle_angle_deg()
        } else {
            0.0
        };
        let way = match orientation.direction {
            OrientationDirection::Negative => Way::In(Rotation::M4),
            OrientationDirection::Shortest => Way::Shortest,
            OrientationDirection::Positive => Way::In(Rotation::M3),
        };
        self.drive
            .servo
            .orient(orientation.angle + added, orientation.speed, way);
        self.orienting = true;
    }

    /// What modules ask of it, before its markers are taken: an orientation with its own parameters comes before that of
    /// M2712, which it sets [000:16126].
    pub fn take_requests(&mut self, requests: &mut Requests) {
        self.asked = requests.orientation.take().or(self.asked.take());
        if let Some(volts) = requests.spindle_volts.take() {
            self.set_plc_volts(volts);
        }
    }

    /// Opens the loop and takes the voltage away: EMERGENCY STOP, M2830. An orientation ends as what the PLC positions does
    /// [000:4013-4019]: the spindle does not go on with it by itself when the voltage is back (inferred).
    pub fn open(&mut self, exchange: &mut Exchange) {
        self.drive.lead(None);
        self.asked = None;
        if std::mem::take(&mut self.orienting) {
            self.end_orientation(exchange);
        }
        self.drive.servo.rotate(Rotation::M5);
        self.drive.servo.set_enabled(false);
        self.by_program.switch_off();
    }

    /// The angle that D592 = $80000000 stands for, degrees.
    pub fn cycle_angle_deg(&self) -> f64 {
        self.cycle_deg.unwrap_or_default()
    }

    /// Turns it from where it stands by a distance, degrees: M2712 until it is there. `false` when it cannot be.
    pub fn turn_by(&mut self, turn_deg: f64, exchange: &mut Exchange) -> bool {
        let turns = self.drive.can_be_led() && self.drive.servo.turn_by(turn_deg);
        if turns {
            self.orienting = true;
            exchange.nc_set(signal::ORIENT_SPINDLE, true);
        }
        turns
    }

    /// After a PLC scan: direction, jog, orientation, gear and speed by the PLC. The code of the fault when
    /// more than one direction is set [000:5492-5518]. A tool in a thread is not left to turn by itself, whatever is
    /// asked: it waits for the end of the thread (inferred).
    pub fn take_markers(&mut self, exchange: &mut Exchange, numbers: &PlcParameters) -> Option<PlcFaultCode> {
        let nc = exchange.nc();
        let shown = [signal::M03_SHOWN, signal::M04_SHOWN, signal::M05_SHOWN].map(|marker| nc.bit(marker));
        if shown.iter().filter(|set| **set).count() > 1 {
            return Some(*b"1Q");
        }
        let rotations = [Rotation::M3, Rotation::M4, Rotation::M5];
        for ((now, before), rotation) in shown.iter().zip(self.shown).zip(rotations) {
            if *now && !before {
                self.rotation = rotation;
                if !self.drive.is_led() {
                    self.drive.servo.rotate(rotation);
                    self.orienting = false;
                }
            }
        }
        self.shown = shown;
        self.drive
            .servo
            .set_inverted(nc.bit(signal::INVERT_SPINDLE_DIRECTION));
        let closed = !nc.bit(signal::NC_STOP_AND_OPEN_LOOPS);
        self.drive
            .servo
            .set_enabled(closed && !nc.bit(signal::SPINDLE_DISPLAY_INVERSE));
        self.drive.servo.set_opens(nc.bit(signal::OPEN_SPINDLE_LOOP));
        if self.drive.is_led() {
            return None;
        }
        self.take_jog(
            nc.bit(signal::SPINDLE_JOG_LEFT),
            nc.bit(signal::SPINDLE_JOG_RIGHT),
        );
        self.take_turn(nc);
        let ordered = self.take_orientation(exchange, numbers);
        self.take_gear(exchange);
        ordered.err()
    }

    /// M2501: the spindle turns while it is set [000:5888-5895].
    fn take_turn(&mut self, nc: &Image) {
        let turn = nc.bit(signal::RUN_SPINDLE_AT_MP3520);
        if turn != self.turning {
            self.turning = turn;
            let direction = if nc.bit(signal::ORIENTATION_DIRECTION) {
                Rotation::M4
            } else {
                Rotation::M3
            };
            self.drive.servo.turn(if turn { direction } else { Rotation::M5 });
        }
    }

    /// M2490 and M2491: the spindle moves to and fro while the gear changes [000:5636-5641].
    fn take_jog(&mut self, left: bool, right: bool) {
        if left || right {
            self.jogging = true;
            self.drive.servo.jog(match (left, right) {
                (true, false) => Rotation::M4,
                (false, true) => Rotation::M3,
                _ => Rotation::M5,
            });
        } else if self.jogging {
            self.jogging = false;
            self.drive.servo.rotate(self.rotation);
        }
    }

    /// M2712 with D592, or M2527 with M2585 to M2589, and M2615 [000:5851-5881] [000:16183].
    fn take_orientation(
        &mut self,
        exchange: &mut Exchange,
        numbers: &PlcParameters,
    ) -> Result<(), PlcFaultCode> {
        if exchange.nc().bit(signal::EVALUATE_SPINDLE_REFERENCE_AGAIN) {
            self.drive.servo.forget_mark();
            exchange.nc_set(signal::EVALUATE_SPINDLE_REFERENCE_AGAIN, false);
        }
        if let Some(orientation) = self.asked.take() {
            self.orient(orientation);
        }
        let form = Form::of(exchange.nc());
        if form == Form::Markers {
            if self.ordered && ORIENTATION.is_taken_back(exchange.nc()) {
                // A spindle that is on its way goes on to its position, as when M2712 is reset.
                self.by_markers = false;
                ORIENTATION.end(exchange);
            }
            self.ordered = ORIENTATION.is_set(exchange.nc());
            ORIENTATION.check(exchange.nc())?;
        }
        let nc = exchange.nc();
        if self.orienting || !self.drive.parameters.controlled {
            return Ok(());
        }
        let Some(angle) = self.ordered_angle(form, nc, numbers) else {
            return Ok(());
        };
        let direction = if nc.bit(signal::ORIENTATION_DIRECTION) {
            Rotation::M4
        } else {
            Rotation::M3
        };
        self.drive.servo.orient(angle, 0.0, Way::In(direction));
        self.orienting = true;
        self.by_markers = form == Form::Markers;
        Ok(())
    }

    /// The angle of an orientation that is ordered, degrees.
    fn ordered_angle(&self, form: Form, nc: &Image, numbers: &PlcParameters) -> Option<f64> {
        match form {
            Form::Words if nc.bit(signal::ORIENT_SPINDLE) => {
                Some(match nc.number(signal::NOMINAL_SPINDLE_POSITION) {
                    ANGLE_OF_CYCLE => self.cycle_angle_deg(),
                    target => f64::from(target) / PER_DEGREE,
                })
            }
            Form::Markers if ORIENTATION.is_set(nc) => match ORIENTATION.code.read(nc)? {
                REFERENCE_MARK if numbers.strobes.is_some() => {
                    let mark = self.drive.parameters.settings.orientation.reference_deg;
                    Some(self.cycle_deg.unwrap_or(mark))
                }
                code => numbers.coded_position_mm(code),
            },
            _ => None,
        }
    }

    /// M2814: gear range W256 and speed D756 of the PLC [000:5620-5624].
    fn take_gear(&mut self, exchange: &mut Exchange) {
        if !exchange.nc().bit(signal::GEAR_AND_SPEED_FROM_PLC) {
            return;
        }
        let gear = u8::try_from(exchange.nc().number(signal::GEAR_CODE)).unwrap_or(0);
        let rpm = f64::from(exchange.nc().number(signal::SPINDLE_SPEED_FROM_PLC)) / PER_RPM;
        self.drive.servo.set_speed(rpm, gear.min(7));
        exchange.nc_set(signal::GEAR_AND_SPEED_FROM_PLC, false);
    }

    /// Once in each contour cycle.
    pub fn cycle(&mut self, exchange: &mut Exchange, override_percent: f64) {
        self.drive.servo.set_override(override_percent);
        if self.orienting && self.drive.servo.in_position() {
            self.orienting = false;
            self.end_orientation(exchange);
        }
    }

    /// M2712 falls, or the strobe of the markers.
    fn end_orientation(&mut self, exchange: &mut Exchange) {
        exchange.nc_set(signal::ORIENT_SPINDLE, false);
        if std::mem::take(&mut self.by_markers) {
            ORIENTATION.end(exchange);
        }
    }

    /// Markers and words of the spindle. M2004 is 1 while the voltage is not on a ramp.
    pub fn publish(&self, exchange: &mut Exchange) {
        let mut put = |marker: Bit, value: bool| {
            if exchange.nc().bit(marker) != value {
                exchange.nc_set(marker, value);
            }
        };
        put(signal::SPINDLE_VOLTAGE_NOT_ON_RAMP, !self.drive.servo.on_ramp());
        put(signal::SPINDLE_VOLTAGE_ZERO, self.drive.servo.at_zero());
        put(signal::SPINDLE_IN_POSITION, self.drive.servo.in_position());
        put(signal::SPINDLE_IN_MOTION, self.drive.servo.orienting());
        if let Some(below) = self.is_below_comparator() {
            put(BELOW_COMPARATOR, below);
        }
        let words = [
            (signal::NOMINAL_SPINDLE_SPEED, self.drive.servo.nominal_rpm()),
            (signal::ACTUAL_SPINDLE_SPEED, self.drive.servo.actual_rpm().abs()),
        ];
        for (word, rpm) in words {
            let value = rpm.round().min(32_767.0) as i32;
            if exchange.nc().number(word) != value {
                exchange.nc_set_number(word, value);
            }
        }
    }

    /// Whether the speed of the voltage has not reached the comparator speed of the gear, MP82 to MP85; `None` where there is
    /// no comparator.
    fn is_below_comparator(&self) -> Option<bool> {
        let speeds = self.drive.parameters.comparator_rpm?;
        let speed = speeds.get(usize::from(self.drive.servo.gear_range()))?;
        Some(self.drive.servo.output_rpm().abs() < *speed)
    }

    /// What module 9042 reads, in degrees.
    pub fn position(&self) -> SpindlePosition {
        let angle = self.drive.servo.angle_deg().unwrap_or(0.0);
        SpindlePosition {
            actual: angle,
            reference: angle,
            closed_loop: self
                .drive
                .servo
                .lag_and_distance_deg()
                .map(|[lag, way]| ControlledSpindle {
                    nominal: angle + lag,
                    trailing_error: lag,
                    distance_to_go: way,
                }),
        }
    }

    /// An orientation is on its way.
    pub fn is_orienting(&self) -> bool {
        self.orienting || self.asked.is_some()
    }

    pub fn state(&self) -> SpindleState {
        SpindleState {
            programmed_rpm: self.programmed_rpm,
            nominal_rpm: self.drive.servo.nominal_rpm(),
            actual_rpm: self.drive.servo.actual_rpm(),
            volts: self.drive.servo.volts(),
            gear: self.drive.servo.gear_range() + 1,
            rotation: self.rotation,
            angle_deg: self.drive.servo.angle_deg(),
        }
    }
}
