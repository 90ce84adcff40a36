//! The 200 parameters of a physical axis, in physical units as they act: what is cleared has its default
//! [002:6893-8640].
//!
//! Decision: An axis without a greatest speed stands still at 1 mm/min: nothing divides by 0

use crate::memory::Memory;
use crate::numbered::parameters;

parameters! {
/// A parameter of a physical axis, by its place in the block.
AxisParameter {
    /// P12000: there is an axis.
    Connection = 0,
    /// P12001: it turns.
    Rotary = 1,
    /// P12004: greatest speed.
    MaxSpeed = 4,
    /// P12005: speed of slope 1; slope 2 follows.
    Slope = 5,
    /// P12008: time to the greatest speed; that of paths follows.
    Ramp = 8,
    /// P12012: increments in P12013 mm.
    Increments = 12,
    /// P12013: mm that have P12012 increments.
    IncrementsPer = 13,
    /// P12014: direction of counting.
    Counting = 14,
    /// P12015: absolute encoder.
    Absolute = 15,
    /// P12016: exact stop, fine; coarse follows.
    ExactStop = 16,
    /// P12018: time to come to a standstill.
    Standstill = 18,
    /// P12020: gain of the position loop.
    Gain = 20,
    /// P12024: lag above the computed one, %.
    LagLimit = 24,
    /// P12025: how long it may last.
    LagTime = 25,
    /// P12026: admissible voltage.
    VoltageLimit = 26,
    /// P12027: voltage at the greatest speed.
    MaxVoltage = 27,
    /// P12028: the voltage is inverted.
    Inverted = 28,
    /// P12029: the axis at whose output it is.
    Output = 29,
    /// P12030: software limit, positive; negative follows.
    Limits = 30,
    /// P12032: emergency position, absolute and relative; basic position, absolute and relative; fixed position.
    EmergencyPosition = 32,
    /// P12040: position of the reference point.
    ReferenceOffset = 40,
    /// P12041: one turn.
    Modulo = 41,
    /// P12044: logic of the reference drive.
    ReferenceLogic = 44,
    /// P12047: axes that stop when this one goes to its emergency position.
    StopsAxes = 47,
    /// P12050: feed forward, %.
    FeedForward = 50,
    /// P12052: backlash.
    Backlash = 52,
    /// P12100: channel of area 1; its reference, control and ranges follow, then those of area 2.
    Areas = 100,
    /// P12110: sets the position.
    SetPosition = 110,
    /// P12111: goes so far.
    GoRelative = 111,
    /// P12112: goes there.
    GoAbsolute = 112,
    /// P12119: speed of the handwheel.
    WheelSpeed = 119,
    /// P12120: greatest speed on paths.
    PathSpeed = 120,
    /// P12121: speed of P12111; that of P12112 follows.
    RelativeSpeed = 121,
    /// P12126: override of P12111; that of P12112 follows.
    RelativeOverride = 126,
    /// P12129: override of P12134.
    TurnOverride = 129,
    /// P12130: seeks the reference point.
    Reference = 130,
    /// P12134: turns as a spindle.
    Turn = 134,
    /// P12123: speed to the fixed position.
    FixedSpeed = 123,
    /// P12128: override of basic and fixed position.
    FixedOverride = 128,
    /// P12132: goes to the emergency position, or to the basic one.
    GoEmergency = 132,
    /// P12133: goes to the fixed position.
    GoFixed = 133,
    /// P12124: speed as a spindle.
    TurnSpeed = 124,
    /// P12136: slopes act.
    SlopeActs = 136,
    /// P12137: locks of directions.
    DirectionLock = 137,
    /// P12140: target = actual position.
    FollowsActual = 140,
    /// P12141: clamped.
    Clamped = 141,
    /// P12142: the voltage is monitored.
    VoltageMonitored = 142,
    /// P12150: machine position.
    MachinePosition = 150,
    /// P12151: nominal position.
    NominalPosition = 151,
    /// P12152: actual position.
    ActualPosition = 152,
    /// P12153: measured position.
    MeasuredPosition = 153,
    /// P12154: display position.
    DisplayPosition = 154,
    /// P12155: programmed position.
    ProgrammedPosition = 155,
    /// P12156: programmed less display position.
    DeltaPosition = 156,
    /// P12157: sum of the shifts.
    DisplayShift = 157,
    /// P12160: lag.
    Lag = 160,
    /// P12163: backlash as it acts.
    BacklashActual = 163,
    /// P12167: nominal speed.
    NominalSpeed = 167,
    /// P12168: actual speed.
    ActualSpeed = 168,
    /// P12169: voltage.
    Voltage = 169,
    /// P12170: speed of the axis.
    AxisSpeed = 170,
    /// P12171: speed to a relative position, actual; absolute and fixed follow.
    RelativeSpeedActual = 171,
    /// P12174: speed as a spindle, actual.
    TurnSpeedActual = 174,
    /// P12180: reference point.
    ReferenceState = 180,
    /// P12181: a measured position was taken.
    Measured = 181,
    /// P12182: the emergency position is reached, or the basic one.
    EmergencyReached = 182,
    /// P12183: the fixed position is reached.
    FixedReached = 183,
    /// P12184: the speed as a spindle is reached.
    TurnReached = 184,
    /// P12185: at a software limit.
    AtLimit = 185,
    /// P12186: a nominal value is given.
    Driven = 186,
    /// P12187: driving instruction.
    Driving = 187,
    /// P12188: result of area 1; that of area 2 follows.
    AreaResult = 188,
    /// P12191: the relative position is reached; the absolute one follows.
    Reached = 191,
    /// P12197: number of a message; its channel and logical axis follow.
    Message = 197,
}
}

/// What is connected [002:6893-6903].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connection {
    /// Nothing.
    None,
    /// An axis.
    Axis,
    /// An axis that must not move.
    Barred,
    /// An axis without a machine.
    Simulated,
}

/// The settings of a physical axis as they act. mm stands for mm or degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBlock {
    /// What is there.
    pub connection: Connection,
    /// It turns: degrees.
    pub is_rotary: bool,
    /// It counts within one turn of so many degrees.
    pub turn_deg: Option<f64>,
    /// Greatest speed, mm/min.
    pub max_mm_min: f64,
    /// Greatest speed on paths, mm/min.
    pub path_mm_min: f64,
    /// Speeds of the slopes, mm/min.
    pub slopes_mm_min: [f64; 2],
    /// Time from 0 to the greatest speed, by hand and on paths, s.
    pub ramps_s: [f64; 2],
    /// Increments of the encoder in a mm.
    pub increments_mm: f64,
    /// The encoder counts the other way round.
    pub counts_negative: bool,
    /// Its position is kept over power-off: it is referenced at once.
    pub is_absolute: bool,
    /// Exact stop, fine and coarse, mm.
    pub exact_stop_mm: [f64; 2],
    /// So long it may take to come into the exact stop, s.
    pub standstill_s: f64,
    /// Gain of the position loop, 1/s.
    pub gain_s: f64,
    /// So much of the computed lag is allowed above it.
    pub lag_part: f64,
    /// So long the lag may be greater, s; `None` without monitoring.
    pub lag_s: Option<f64>,
    /// The voltage from which the axis is stopped, V; `None` without.
    pub volts_limit: Option<f64>,
    /// Voltage at the greatest speed, V.
    pub max_volts: f64,
    /// The voltage is inverted.
    pub is_inverted: bool,
    /// The physical axis at whose output it is.
    pub output: u8,
    /// Software limits, negative and positive, mm.
    pub limits_mm: [Option<f64>; 2],
    /// Position of the reference point, mm.
    pub reference_mm: f64,
    /// The reference point is taken in positive direction, in negative direction; both where nothing is said (inferred).
    pub reference_directions: [bool; 2],
    /// Part of the speed that is put out in advance.
    pub feed_forward: f64,
    /// Backlash, mm.
    pub backlash_mm: f64,
}

/// Defaults of the chapter.
const RAMP_MS: f64 = 250.0;
const STANDSTILL_MS: f64 = 3000.0;
const GAIN_S: f64 = 16.0;
const LAG_PERCENT: f64 = 50.0;
const LAG_MS: f64 = 50.0;
const MAX_VOLTS: f64 = 9.5;
const TURN_DEG: f64 = 360.0;
/// Resolution where none is given, increments in a mm (inferred).
const INCREMENTS_MM: f64 = 1000.0;
/// The least greatest speed, mm/min.
const LEAST_SPEED: f64 = 1.0;
/// Coarse is so many times fine [002:7034-7040].
const COARSE: f64 = 8.0;
/// Speeds of the slopes as parts of the greatest one [002:6955-6961].
const SLOPES: [f64; 2] = [0.1, 0.2];

impl AxisBlock {
    /// That of a physical axis, from 1 on.
    pub fn of(memory: &Memory, physical: u8) -> AxisBlock {
        let block = Block(memory, physical);
        let max_mm_min = block.positive(AxisParameter::MaxSpeed, 0).unwrap_or(LEAST_SPEED);
        let [of_slope_1, of_slope_2] = SLOPES;
        let increments = block.positive(AxisParameter::Increments, 0);
        let per = block.positive(AxisParameter::IncrementsPer, 0).unwrap_or(1.0);
        let increments_mm = increments.map_or(INCREMENTS_MM, |increments| increments / per);
        let fine = block.positive(AxisParameter::ExactStop, 0);
        let fine = fine.unwrap_or((1.0 / increments_mm).sqrt());
        let ramp_ms = block.positive(AxisParameter::Ramp, 0).unwrap_or(RAMP_MS);
        let path_ms = block
            .positive(AxisParameter::Ramp, 1)
            .unwrap_or(ramp_ms)
            .max(ramp_ms);
        let [direction, ..] = block.bytes(AxisParameter::Counting);
        let [.., absolute] = block.bytes(AxisParameter::Absolute);
        let [plus, minus, ..] = block.bytes(AxisParameter::ReferenceLogic);
        let rotary = block.whole(AxisParameter::Rotary).unwrap_or(0);
        let turn = block.positive(AxisParameter::Modulo, 0).unwrap_or(TURN_DEG);
        let connection = block.whole(AxisParameter::Connection);
        let lag_ms = block.number(AxisParameter::LagTime, 0).unwrap_or(0.0);
        let output = block
            .whole(AxisParameter::Output)
            .and_then(|axis| u8::try_from(axis).ok());
        let percent = block.positive(AxisParameter::LagLimit, 0).unwrap_or(LAG_PERCENT);
        let positive = |parameter, default| block.positive(parameter, 0).unwrap_or(default);
        AxisBlock {
            connection: match connection {
                Some(1) => Connection::Axis,
                Some(2) => Connection::Barred,
                Some(-1) => Connection::Simulated,
                _ => Connection::None,
            },
            is_rotary: rotary != 0,
            turn_deg: (rotary >= 2).then_some(turn),
            max_mm_min: max_mm_min.max(LEAST_SPEED),
            path_mm_min: positive(AxisParameter::PathSpeed, f64::INFINITY).min(max_mm_min.max(LEAST_SPEED)),
            slopes_mm_min: [
                positive(AxisParameter::Slope, of_slope_1 * max_mm_min),
                block
                    .positive(AxisParameter::Slope, 1)
                    .unwrap_or(of_slope_2 * max_mm_min),
            ],
            ramps_s: [ramp_ms * 1e-3, path_ms * 1e-3],
            increments_mm,
            counts_negative: direction == 1,
            is_absolute: absolute == 1,
            exact_stop_mm: [
                fine,
                block
                    .positive(AxisParameter::ExactStop, 1)
                    .unwrap_or(COARSE * fine),
            ],
            standstill_s: positive(AxisParameter::Standstill, STANDSTILL_MS) * 1e-3,
            gain_s: positive(AxisParameter::Gain, GAIN_S),
            lag_part: percent / 100.0,
            lag_s: match lag_ms {
                off if off < 0.0 => None,
                0.0 => Some(LAG_MS * 1e-3),
                ms => Some(ms * 1e-3),
            },
            volts_limit: block.positive(AxisParameter::VoltageLimit, 0),
            max_volts: positive(AxisParameter::MaxVoltage, MAX_VOLTS),
            is_inverted: block.whole(AxisParameter::Inverted) == Some(1),
            output: output.filter(|axis| *axis > 0).unwrap_or(physical),
            limits_mm: [
                block.number(AxisParameter::Limits, 1),
                block.number(AxisParameter::Limits, 0),
            ],
            reference_mm: block.number(AxisParameter::ReferenceOffset, 0).unwrap_or(0.0),
            reference_directions: match (plus == 1, minus == 1) {
                (false, false) => [true, true],
                (plus, minus) => [plus, minus],
            },
            feed_forward: (block.number(AxisParameter::FeedForward, 0).unwrap_or(0.0) / 100.0)
                .clamp(0.0, 1.0),
            backlash_mm: block.number(AxisParameter::Backlash, 0).unwrap_or(0.0),
        }
    }

    /// The lag at a speed, mm: speed / (60 * gain), less what is put out in advance [002:7085-7091].
    pub fn lag_mm(&self, mm_min: f64) -> f64 {
        mm_min / (60.0 * self.gain_s) * (1.0 - self.feed_forward)
    }
}

/// The parameters of an axis.
struct Block<'a>(&'a Memory, u8);

impl Block<'_> {
    fn number(&self, parameter: AxisParameter, after: u32) -> Option<f64> {
        let place = Memory::axis_place(self.1, parameter)?.q()?;
        self.0.system_cell(place + after).number()
    }

    /// 0 and less count as cleared.
    fn positive(&self, parameter: AxisParameter, after: u32) -> Option<f64> {
        self.number(parameter, after).filter(|number| *number > 0.0)
    }

    fn whole(&self, parameter: AxisParameter) -> Option<i64> {
        self.0.of_axis(self.1, parameter).whole()
    }

    fn bytes(&self, parameter: AxisParameter) -> [u8; 4] {
        let bits = self.0.of_axis(self.1, parameter).bits();
        bits.unwrap_or(0).to_le_bytes()
    }
}
