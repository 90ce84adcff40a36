//! Everything that servo, reference run and monitoring need of one axis.
//!
//! Decision: MP7470 = 0 of a TNC 360 lets a rotary axis count to 359.999 degrees on both sides of 0, with its sign,
//! as its manual says; that of the controls before MP810, from 0 to 359.9999, is none of the models here

use bahn_path::{Axis, Direction};
use bahn_servo::settings::{
    AxisSettings, CompensationSettings, CouplingSettings, EncoderSettings, LagSettings, MarkKind,
    MarkSettings, MonitoringSettings, MotionSettings, OutputSettings, PrecontrolSettings, SpeedLoopSettings,
};

use super::axis_reader::AxisReader;
use crate::{ControlModel, ParameterList};

/// The parameters of one axis. mm stands for mm or degrees, mm/min for mm/min or degrees/min, as the
/// letter of the axis says.
///
/// After each MP number stands the number of the TNC 151/155 as "old". Index 0 to 4 is X, Y, Z, 4th, 5th
/// axis [000:3232-3236]; "old MP20+" counts X, Y, Z, IV upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisParameters {
    /// Index in the list, 0 to 4.
    pub index: u8,
    /// Letter of the axis: X, Y, Z; 4th and 5th by MP410.3 and .4 (old MP90 for IV) [000:3350-3370]. `None`
    /// for an axis that the model does not have.
    pub letter: Option<Axis>,
    /// The axis exists for control, display and reference run: MP10 (old: controlled, or MP76 bit 0)
    /// [000:3174-3182] [001:1338-1380].
    pub active: bool,
    /// The loop of the axis is closed, it is not for display only: MP50 (old: not in MP72) [000:5326-5333].
    pub controlled: bool,
    /// The position is shown in the status window: MP40 [000:3420-3432]; old: every active axis.
    pub shown: bool,
    /// The axis belongs to the PLC: MP60 [000:4094-4109]; not on the TNC 151/155.
    pub plc_axis: bool,
    /// Where encoder and drive are connected.
    pub wiring: WiringParameters,
    /// Signal period and checks of the encoder.
    pub encoder: EncoderSettings,
    /// Sign and scale of the voltage to the drive.
    pub output: OutputSettings,
    /// Interval of the automatic offset adjustment, s, 0 without: MP1220 (old MP252, 20 ms)
    /// [000:5022-5037] [001:2591-2606].
    pub offset_interval_s: f64,
    /// So long stands the nominal value of an axis at its target before it is adjusted outside its positioning window, s;
    /// the axes are adjusted at once when they have passed their marks: old; `None`: neither [001:2600-2606].
    pub offset_patience_s: Option<f64>,
    /// Feed rates and acceleration.
    pub motion: MotionParameters,
    /// Operation with servo lag.
    pub lag: LagSettings,
    /// Operation with feed pre-control.
    pub precontrol: PrecontrolSettings,
    /// MDI, single block and full sequence run with pre-control, not with lag: MP1390 = 0 (old MP60 = 0)
    /// [000:4721-4724] [001:1105-1121].
    pub precontrol_in_automatic: bool,
    /// Manual and Handwheel run with pre-control: MP1391; old: never [000:4726-4733] [001:1105-1121].
    pub precontrol_in_manual: bool,
    /// Monitoring that both kinds of operation share.
    pub monitoring: MonitoringSettings,
    /// Compensation of the mechanics' errors.
    pub compensation: CompensationSettings,
    /// Direction, feeds and sequence of the reference run.
    pub reference: ReferenceParameters,
    /// Software limits and datums.
    pub travel: TravelParameters,
    /// Which axis it follows, and how closely: MP850 to MP860.
    pub synchronization: Synchronization,
    /// Digital speed controller, TNC 425 with MP1900 only.
    pub digital: Option<SpeedLoopSettings>,
}

/// Inputs and outputs of the control that belong to an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WiringParameters {
    /// Encoder input, 0 to 5 for X1 to X6: MP110 (old: MP253-257, 0 = own input) [000:3374-3391]
    /// [001:2434-2454].
    pub input: u8,
    /// Nominal value output, 0 to 4 for 1 to 5, 5 for S: MP120; old: its own [000:3393-3406].
    pub output: u8,
}

/// Feed rates and acceleration of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionParameters {
    /// Rapid traverse, mm/min: MP1010, 10 to 300 000 (old MP0+) [000:4836-4841].
    pub rapid_mm_min: f64,
    /// Manual feed, mm/min: MP1020, 10 to 300 000 (old MP4+, with MP167 = 1 the smallest of all) [000:4848-4853]
    /// [001:1020-1024].
    pub manual_mm_min: f64,
    /// Acceleration, m/s², for a rotary axis 1000 degrees/s²: MP1060, 0.001 to 5 (old MP54)
    /// [000:4790-4797].
    pub acceleration_m_s2: f64,
    /// Feed in which the PLC positions the axis and the contour is returned to, mm/min: MP4220, 10 to
    /// 30 000 (old MP163+) [000:11720-11724] [001:3144-3369].
    pub plc_mm_min: f64,
    /// Without feed enable it comes down on the ramp of MP54 and goes on when the enable is back; old: yes
    /// [001:509-516]. Else its voltage is 0 at once [000:5352].
    pub ramps_without_enable: bool,
}

/// Reference run of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceParameters {
    /// Where the marks are looked for: MP1320 (old MP16+) [000:4631-4636].
    pub direction: Direction,
    /// Feed, mm/min: MP1330, 80 to 300 000 (old MP8+) [000:4637-4642].
    pub feed_mm_min: f64,
    /// Feed for leaving the cam, [`MarkKind::RotaryEncoder`] only, mm/min: MP1331, 80 to 500; old: the
    /// feed of the run, at most 500 (inferred) [000:4643-4648].
    pub leaving_mm_min: f64,
    /// Place in the automatic sequence, 0 for the first axis: MP1340; `None` for an axis that is not named
    /// (old: MP59, one of 24 sequences) [000:4649-4654] [001:1443-1478].
    pub place: Option<u8>,
    /// How the axis finds its reference mark: MP1350 (old MP242+) [000:4656-4667].
    pub kind: MarkKind,
    /// An axis that stands on its cam is first backed off it: old MP69 [001:989-995]. Not a rotary one, whose cam is
    /// bridged for good [001:957].
    pub backs_off: bool,
    /// What an axis that is not controlled has of its mark.
    pub inhibited: InhibitedMark,
    /// Spacing of distance-coded marks, mm: old MP242+ times 20 µm [001:977-987] [001:1480]; 20 mm where the
    /// list has no such parameter (inferred: the spacing of the LS scales).
    pub mark_spacing_mm: f64,
}

/// What the reference mark is to an axis that is not controlled: old MP75 [001:3266].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InhibitedMark {
    /// It counts from power-on; its counter is 0 on the mark [000:4573]. The controls with MP50.
    Zeroes,
    /// It counts from its mark on.
    Needed {
        /// The prompt of the reference run names it: MP75 = 1, not 0.
        asked: bool,
    },
    /// MP75 = 2: its position is 0 at power-on, and counts at once.
    Preset,
}

/// How far a rotary axis counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modulo {
    /// One turn of the display, degrees.
    pub deg: f64,
    /// Positions on the negative side of 0 keep their sign: a TNC 360, whose display goes up to ±359.999 degrees
    /// [003:7424-7430].
    pub signed: bool,
}

impl Modulo {
    /// So near before a whole turn a position counts as it, degrees (inferred).
    const TOLERANCE_DEG: f64 = 1e-3;

    /// Whole turns that a position in degrees is beyond what is displayed.
    pub fn turns(&self, position_deg: f64) -> f64 {
        match self.signed && position_deg < 0.0 {
            true => ((position_deg - Self::TOLERANCE_DEG) / self.deg).ceil(),
            false => ((position_deg + Self::TOLERANCE_DEG) / self.deg).floor(),
        }
    }

    /// A position in degrees as it is displayed.
    pub fn shown(&self, position_deg: f64) -> f64 {
        match self.signed {
            true => position_deg % self.deg,
            false => position_deg.rem_euclid(self.deg),
        }
    }
}

/// Limits and datums of an axis, from machine zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TravelParameters {
    /// Software limits of the traverse ranges 1 to 3, mm, least first: MP920/910, MP921/911, MP922/912, -99
    /// 999.9999 to 99 999.9999; old: MP44-51, three times the same [000:3438-3497] [001:3188-3195].
    pub ranges_mm: [[f64; 2]; 3],
    /// How far the display of a rotary axis counts; with it the software limits are off: MP810 [000:6470-6478]. The TNC
    /// 360 has MP7470 = 0 for 359.999 degrees to both sides of 0; TNC 151/155: none.
    pub modulo: Option<Modulo>,
    /// Distance from the scale datum to the machine datum, mm: MP960; 0 on the TNC 151/155/360, which have
    /// none [000:6264-6269].
    pub machine_datum_mm: f64,
    /// Datum of M92, mm: MP950 (old MP186+) [000:6242-6263].
    pub m92_mm: f64,
    /// Where TOOL CALL in a block scan puts the axis, mm: MP951 where MP7450 asks for it
    /// [000:10494] [000:6810-6819].
    pub tool_change_mm: Option<f64>,
    /// Grid of the Hirth coupling, degrees: MP430 with MP420 = 1, 4th and 5th axis [000:8564-8681].
    pub hirth_deg: Option<f64>,
    /// The datum must not be set: MP7295 [000:6270-6275].
    pub datum_inhibited: bool,
    /// Way after which the axis asks for lubrication, mm, `None` for never: MP4060, 0 to 65 535 times 65.536
    /// mm, 0 for never (inferred) (old MP159+) [000:3567-3586] [001:3144-3369].
    pub lubrication_mm: Option<f64>,
    /// Display step, mm: MP7290 (old MP65) [000:6436-6457] [001:1612-1614].
    pub display_step_mm: f64,
}

/// Synchronized axes, TNC 407 and later [000:4455-4535].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Synchronization {
    /// Index of the axis that this one follows: MP850, 0 for none.
    pub master: Option<u8>,
    /// How it follows it.
    pub coupling: CouplingSettings,
}

impl AxisParameters {
    /// What the loop of the axis is told of them.
    pub fn settings(&self) -> AxisSettings {
        AxisSettings {
            encoder: self.encoder,
            marks: MarkSettings {
                kind: self.reference.kind,
                spacing_mm: self.reference.mark_spacing_mm,
            },
            output: self.output,
            motion: MotionSettings {
                rapid_mm_min: self.motion.rapid_mm_min,
                acceleration_m_s2: self.motion.acceleration_m_s2,
            },
            lag: self.lag,
            precontrol: self.precontrol,
            monitoring: self.monitoring,
            compensation: self.compensation,
            digital: self.digital,
        }
    }

    /// Those that it works with as the slave of a master: feeds and acceleration, limits and datums are the master's
    /// [000:4535].
    pub fn as_slave_of(&self, master: &AxisParameters) -> AxisParameters {
        let mut slave = *self;
        slave.motion = master.motion;
        slave.travel.ranges_mm = master.travel.ranges_mm;
        slave.reference.feed_mm_min = master.reference.feed_mm_min;
        slave
    }
}

impl ParameterList {
    /// The parameters of the axis of an index, 0 to 4 for X, Y, Z, 4th and 5th axis. An axis that the model
    /// does not have is not active, and answers like the 4th axis otherwise.
    pub fn axis_parameters(&self, index: u8) -> AxisParameters {
        let axis = AxisReader::new(self, index);
        let controlled = axis.exists() && self.is_controlled(&axis);
        let active = axis.exists() && axis.bit_or(10, || controlled || self.old_bit(76, 0));
        let wiring = wiring(&axis);
        AxisParameters {
            index,
            letter: self.axis_letter(index),
            active,
            controlled: active && controlled,
            shown: active && axis.bit_or(40, || true),
            plc_axis: active && axis.bit_or(60, || false),
            wiring,
            encoder: encoder(&axis, wiring.input),
            output: output(&axis),
            offset_interval_s: self.get(1220, 0).unwrap_or_else(|| self.old(252) * 0.02),
            offset_patience_s: self.has_old_numbers().then_some(OFFSET_PATIENCE_S),
            motion: motion(&axis),
            lag: lag(&axis),
            precontrol: precontrol(&axis),
            precontrol_in_automatic: self.feed_precontrol(),
            precontrol_in_manual: axis.bit_or(1391, || false),
            monitoring: monitoring(&axis),
            compensation: compensation(&axis),
            reference: reference(&axis),
            travel: travel(&axis),
            synchronization: synchronization(&axis),
            digital: (self.model().family() == ControlModel::Tnc425 && axis.bit_or(1900, || false))
                .then(|| digital(&axis)),
        }
    }

    fn is_controlled(&self, axis: &AxisReader) -> bool {
        axis.bit_or(50, || !self.old_bit(72, axis.index().into()))
    }
}

fn wiring(axis: &AxisReader) -> WiringParameters {
    WiringParameters {
        input: axis.new_or(110, || f64::from(old_input(axis))) as u8,
        output: axis.new_or(120, || f64::from(axis.index())) as u8,
    }
}

/// Signal periods that an EXE makes of one of the encoder [001:416].
const EXE_DIVISION: f64 = 5.0;

fn encoder(axis: &AxisReader, input: u8) -> EncoderSettings {
    // MP76: bit 0 concerns inhibited axes, bits 1 to 4 switch X to IV off.
    let checked = || !axis.list().old_bit(76, u32::from(axis.index()) + 1);
    let limits = axis.list().model().limits();
    let square_wave = input >= limits.square_wave_input;
    // The EXE in front of a TNC 151/155 R always divides by 5 [001:416-444].
    let exe = if square_wave { EXE_DIVISION } else { 1.0 };
    EncoderSettings {
        square_wave,
        // 20-fold and 10-fold evaluation both make counting steps of 1 µm.
        signal_period_um: axis.new_or(330, || if axis.old(12) == 2.0 { 10.0 } else { 20.0 } / exe),
        interpolation: axis.new_or(340, || exe).max(1.0) as u8,
        counts_negative: axis.flag(210, 20),
        check_distance_code: axis.bit_or(30, || false),
        check_amplitude: axis.bit_or(31, checked),
        check_edges: axis.bit_or(32, checked),
    }
}

/// MP4 to MP7; with MP167 = 1 the smallest of them for all axes [001:1020-1024].
fn old_manual_mm_min(axis: &AxisReader) -> f64 {
    let list = axis.list();
    match list.old(167) == 1.0 {
        true => (4..8)
            .map(|number| list.old(number))
            .fold(f64::INFINITY, f64::min),
        false => axis.old(4),
    }
}

/// Offsets are adjusted when the nominal value is at its target so long, s [001:2604].
const OFFSET_PATIENCE_S: f64 = 5.0;

/// The encoder input whose MP253 to MP257 names the axis, otherwise its own [001:2434-2454]; its own, too, of a programming
/// station, which has no encoders.
fn old_input(axis: &AxisReader) -> u8 {
    if axis.list().old(170) != 0.0 {
        return axis.index();
    }
    let names_axis =
        |input: &u8| axis.list().get(253 + u16::from(*input), 0) == Some(f64::from(axis.index() + 1));
    (0..5).find(names_axis).unwrap_or(axis.index())
}

fn output(axis: &AxisReader) -> OutputSettings {
    OutputSettings {
        polarity_negative: axis.flag(1040, 24),
        rapid_volts: axis.old_common(1050, 52),
        integral_factor: axis.value(1080, 28),
    }
}

fn motion(axis: &AxisReader) -> MotionParameters {
    MotionParameters {
        rapid_mm_min: axis.value(1010, 0),
        manual_mm_min: axis.new_or(1020, || old_manual_mm_min(axis)),
        acceleration_m_s2: axis.old_common(1060, 54),
        plc_mm_min: axis.value(4220, 163),
        ramps_without_enable: axis.list().has_old_numbers(),
    }
}

fn lag(axis: &AxisReader) -> LagSettings {
    let kv = axis.value(1810, 177);
    LagSettings {
        kv,
        kv_m105: axis.new_or(1815, || kv),
        kink_factor: axis.old_common(1820, 176),
        kink_percent: axis.old_common(1830, 181),
        feed_forward: 0.0,
        monitoring_mm: axis.old_common(1710, 175),
        emergency_mm: axis.old_common(1720, 174),
    }
}

/// Speed at which the positioning window was checked before MP1525, mm/min [000:5306].
const WINDOW_MM_MIN: f64 = 0.5;
/// Output steps of the TNC 151/155 for each µm of lag, kv 1 and rapid traverse of 1 m/min (inferred from
/// the table [001:1746-1762]).
const STEPS_PER_KV: f64 = 3.6864;
/// The voltage at rapid traverse that the table is made for, V.
const TABLE_VOLTS: f64 = 9.0;

impl ParameterList {
    /// MP32 to MP35 for kv 1, at the rapid traverse and the voltage of the list of the TNC 151/155.
    pub(crate) fn old_steps_per_kv(&self, index: u8) -> f64 {
        let rapid_m_min = AxisReader::new(self, index).old(0) / 1000.0;
        STEPS_PER_KV / rapid_m_min.max(f64::MIN_POSITIVE) * self.old(52) / TABLE_VOLTS
    }
}

fn precontrol(axis: &AxisReader) -> PrecontrolSettings {
    let old_kv = || axis.old(32) / axis.list().old_steps_per_kv(axis.index());
    let kv = axis.new_or(1510, old_kv);
    PrecontrolSettings {
        kv,
        kv_m105: axis.new_or(1515, || kv),
        transient_m_min: axis.common(1520, 53),
        damping: axis.common(1530, 64),
        window_mm_min: axis
            .list()
            .get(1525, 0)
            .unwrap_or(match axis.list().model().family() {
                ControlModel::Tnc151 | ControlModel::Tnc155 => f64::INFINITY,
                _ => WINDOW_MM_MIN,
            }),
        monitoring_mm: axis.old_common(1410, 56),
        emergency_mm: axis.old_common(1420, 57),
    }
}

fn monitoring(axis: &AxisReader) -> MonitoringSettings {
    let old_window = || axis.list().old(if axis.index() < 3 { 58 } else { 192 });
    MonitoringSettings {
        window_mm: axis.new_or(1030, old_window),
        standstill_mm: axis.old_common(1110, 169),
        movement_volts: axis.old_common(1140, 234),
        residual_voltage_s: axis.common(1150, 185),
    }
}

fn compensation(axis: &AxisReader) -> CompensationSettings {
    let zero = |number| axis.new_or(number, || 0.0);
    CompensationSettings {
        backlash_mm: axis.value(710, 36),
        linear_mm_m: if axis.is_rotary() {
            0.0
        } else {
            axis.value(720, 40)
        },
        nonlinear: axis.bit_or(730, || false),
        reversal_mm: [zero(711), zero(715)],
        reversal_step_mm: [zero(712), zero(716)],
        stiction_us: zero(1511),
        stiction_limit_steps: zero(1512),
        stiction_feed_mm_min: zero(1513),
    }
}

/// The unit of the spacing of distance-coded marks, mm [001:1480].
const MARK_UNIT_MM: f64 = 0.02;
/// Spacing of the marks of LS scales, mm [001:977-987].
const MARK_SPACING_MM: f64 = 20.0;

fn reference(axis: &AxisReader) -> ReferenceParameters {
    let feed_mm_min = axis.value(1330, 8);
    let old_spacing = axis.old(242);
    let list = axis.list();
    let kind = match list.get_new(1350, axis.index()).map(|kind| kind as u8) {
        None if old_spacing > 0.0 => MarkKind::DistanceCodedBesideCam,
        None => MarkKind::UnderCam,
        Some(0) => MarkKind::DistanceCodedOld,
        Some(1) => MarkKind::OneMark,
        Some(2) => MarkKind::RotaryEncoder,
        Some(_) => MarkKind::DistanceCoded,
    };
    let inhibited = match list.old(75) as u8 {
        _ if !list.has_old_numbers() => InhibitedMark::Zeroes,
        2 => InhibitedMark::Preset,
        asked => InhibitedMark::Needed { asked: asked == 1 },
    };
    ReferenceParameters {
        direction: Direction::minus_if(axis.flag(1320, 16)),
        feed_mm_min,
        leaving_mm_min: axis.new_or(1331, || feed_mm_min.min(500.0)),
        place: axis
            .list()
            .reference_place(axis.index())
            .filter(|_| axis.exists()),
        kind,
        backs_off: list.old(69) == 1.0 && kind == MarkKind::UnderCam && !axis.is_rotary(),
        inhibited,
        mark_spacing_mm: if old_spacing > 0.0 {
            old_spacing * MARK_UNIT_MM
        } else {
            MARK_SPACING_MM
        },
    }
}

/// One unit of MP4060, mm [000:3567-3586].
const LUBRICATION_UNIT_MM: f64 = 65.536;

fn travel(axis: &AxisReader) -> TravelParameters {
    let positive = |value: f64| (value > 0.0).then_some(value);
    let old_limits = || [axis.old_pair(45), axis.old_pair(44)];
    let range = |plus: u16| {
        let old = old_limits();
        [axis.new_or(plus + 10, || old[0]), axis.new_or(plus, || old[1])]
    };
    let signed = axis.list().get(7470, 0) == Some(0.0) && axis.list().get(810, 0).is_none();
    let turn = || if signed { 360.0 } else { 0.0 };
    let has_hirth = axis.new_or(420, || 0.0) == 1.0;
    TravelParameters {
        ranges_mm: [range(910), range(911), range(912)],
        modulo: positive(axis.new_or(810, turn))
            .filter(|_| axis.is_rotary())
            .map(|deg| Modulo { deg, signed }),
        machine_datum_mm: axis.machine_datum(),
        m92_mm: axis.value(950, 186),
        tool_change_mm: axis.bit_or(7450, || false).then(|| axis.new_or(951, || 0.0)),
        hirth_deg: positive(axis.new_or(430, || 0.0)).filter(|_| has_hirth),
        datum_inhibited: axis.bit_or(7295, || false),
        lubrication_mm: positive(axis.value(4060, 159)).map(|units| units * LUBRICATION_UNIT_MM),
        display_step_mm: axis.display_step(),
    }
}

fn synchronization(axis: &AxisReader) -> Synchronization {
    let value = |number| axis.new_or(number, || 0.0);
    Synchronization {
        master: (value(850) as u8).checked_sub(1),
        coupling: CouplingSettings {
            difference_mm: Some(value(855)).filter(|difference| *difference > 0.0),
            from_reference_marks: value(860) == 1.0,
        },
    }
}

fn digital(axis: &AxisReader) -> SpeedLoopSettings {
    let value = |number| axis.new_or(number, || 0.0);
    SpeedLoopSettings {
        monitoring_steps: value(1910),
        integral: value(1920),
        integral_limit_s: value(1925),
        proportional: value(1940),
        acceleration_v_m_s2: value(1945),
        polarity_negative: axis.bit_or(1950, || false),
        motor_encoder: axis.bit_or(1951, || false),
        encoder_ratio: value(1955),
        reversal_mm: value(1960),
        difference_mm: Some(value(1970)).filter(|difference| *difference > 0.0),
        emergency_stop_s: axis.list().get(1980, 0).unwrap_or_default(),
    }
}
