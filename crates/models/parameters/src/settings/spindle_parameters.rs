//! Everything that spindle, gear change, orientation and tapping need.

use bahn_servo::spindle_settings::{
    GEARS, Gear, LeadSettings, OrientationSettings, SpeedCodes, SpindlePolarity, SpindleRamps,
    SpindleSettings,
};

use super::bit_of;
use crate::ParameterList;

/// Bit of the spindle in MP31 and MP32, and of axis V in MP76.
const ENCODER_BIT: u32 = 5;
/// Gear ranges that the TNC 151/155 have beside comparator speeds [001:1514-1536].
const OLD_GEARS: usize = 4;
/// One increment of the spindle encoder, degrees: 1024 lines, 4-fold [000:5901-5907].
const INCREMENT_DEG: f64 = 360.0 / 4096.0;
/// Shortest lead of the spindle's switching off before the depth, s [000:6072-6077].
const TAPPING_LEAD_MIN_S: f64 = 0.030;
/// Greatest voltage of the output, V.
const OUTPUT_VOLTS: f64 = 10.0;

/// The parameters of the spindle. "old" are the numbers of the TNC 151/155.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleParameters {
    /// How the speed is put out: MP3010, 0 to 8 (old MP62, 0 to 5) [000:5444-5472] [001:1488-1490].
    pub output: SpindleOutput,
    /// The spindle can be position controlled, for orientation and rigid tapping: MP3010 of 6 to 8 (old
    /// MP237 = 1, 2) [000:5444-5472] [001:3082-3115].
    pub controlled: bool,
    /// Its encoder input, from 0: X6; TNC 151/155 the one that MP253 to MP257 = 5 give to axis V, else X5
    /// [001:2434-2454].
    pub input: u8,
    /// What output S is for when the spindle does not use it: MP3011 [000:9819-9860]; old: nothing.
    pub free_output: FreeOutput,
    /// Limits of the coded speed: MP3020 (old MP63) [000:5718-5745] [001:1497-1499].
    pub codes: SpeedCodes,
    /// The axes do not halt when TOOL CALL gives a speed only: MP3030 = 1 (old MP214 + 4)
    /// [000:5645-5651] [001:1650-1652].
    pub axes_run_on: bool,
    /// Speeds that M2504 compares with, rpm; TNC 151/155 only, when MP78 to MP85 do not ascend
    /// [001:1514-1536].
    pub comparator_rpm: Option<[f64; OLD_GEARS]>,
    /// What its loop is told.
    pub settings: SpindleSettings,
    /// Tapping with a floating holder and rigid tapping.
    pub tapping: TappingParameters,
}

/// How the speed of the spindle is put out [000:5444-5472].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleOutput {
    /// No speed is put out.
    None,
    /// As S code of DIN 66025 with strobe.
    Coded {
        /// At every TOOL CALL, not only when the speed changes.
        always: bool,
    },
    /// As voltage of output S.
    Analogue {
        /// When the gear range is put out.
        gear: GearSignal,
    },
}

/// When the gear range is put out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GearSignal {
    /// When the range changes: MP3010 = 3 or 6.
    OnChange,
    /// At every TOOL CALL: MP3010 = 4 or 7.
    Always,
    /// Never: MP3010 = 5 or 8.
    Never,
}

/// What output S is for when the spindle does not use it, MP3010 less than 3 [000:9819-9860].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FreeOutput {
    /// It stays at 0 V.
    None,
    /// A voltage proportional to the contour feed, 10 V at the feed of MP3012, mm/min.
    Feed {
        /// Feed for 10 V, mm/min.
        full_mm_min: f64,
    },
    /// The PLC sets it with module 9130.
    Plc,
    /// M200 to M204 set it.
    MFunctions,
}

/// How cycles 2, 17 and 18 drive the spindle [000:6060-6141] [001:1804-1812].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TappingParameters {
    /// Least and greatest feed override in cycle 2, %: MP7110.0 and .1 (old MP182, MP183).
    pub override_percent: [f64; 2],
    /// Dwell before the spindle reverses, s: MP7120.0, 0 to 65.535 (old MP67).
    pub reversal_dwell_s: f64,
    /// Time before the end at which the spindle is switched off, coded speed only, s: MP7120.1 (old MP73).
    pub coded_lead_s: f64,
    /// Time that the spindle runs on after the depth, s: MP7120.2; old: 0.
    pub run_on_s: f64,
    /// Rigid tapping: positioning window of the tool axis, mm: MP7150, 0.0001 to 2; old: none, 0.
    pub window_mm: f64,
    /// The spindle is oriented before cycle 17: MP7160 = 0; old: never.
    pub orientation: bool,
}

impl SpindleParameters {
    /// The gear range for a programmed speed, rpm: the smallest that reaches it.
    fn gear_for(&self, rpm: f64) -> Option<&Gear> {
        self.settings
            .gears
            .iter()
            .find(|gear| gear.rated_rpm > 0.0 && rpm <= gear.rated_rpm)
    }

    /// For each gear range its rated speed, rpm, and how fast the spindle changes its speed in rigid tapping,
    /// rpm/s: MP3410.3 in the voltage of the gear; 0 where there is no ramp or no gear.
    pub fn rigid_ramps(&self) -> [[f64; 2]; GEARS] {
        self.settings.gears.map(|gear| {
            let rpm_v = if gear.rated_volts > 0.0 {
                gear.rated_rpm / gear.rated_volts
            } else {
                0.0
            };
            [gear.rated_rpm, self.settings.ramps.rigid_v_ms * 1000.0 * rpm_v]
        })
    }

    /// How long before the depth cycle 2 switches the spindle off, s. With analogue output it is the time of the
    /// ramp MP3410.2 from the voltage of the speed, less the run-on MP7120.2, but 30 ms where the ramp lasts
    /// longer than that [000:6072-6077]; with coded output MP7120.1 [000:6111-6116].
    pub fn tapping_lead_s(&self, rpm: f64) -> f64 {
        match self.output {
            SpindleOutput::None => 0.0,
            SpindleOutput::Coded { .. } => self.tapping.coded_lead_s,
            SpindleOutput::Analogue { .. } => {
                let volts = self
                    .gear_for(rpm)
                    .map_or(0.0, |gear| rpm * gear.rated_volts / gear.rated_rpm);
                lead_s(volts, self.settings.ramps.tapping_v_ms, self.tapping.run_on_s)
            }
        }
    }
}

/// The time of a ramp (V/ms) from a voltage less the run-on, see [`SpindleParameters::tapping_lead_s`].
fn lead_s(volts: f64, ramp_v_ms: f64, run_on_s: f64) -> f64 {
    if ramp_v_ms <= 0.0 {
        return 0.0;
    }
    let ramp_s = volts.abs() / ramp_v_ms * 1e-3;
    ramp_s - run_on_s.min(ramp_s - TAPPING_LEAD_MIN_S).max(0.0)
}

impl ParameterList {
    /// What the list says of the spindle, in physical units.
    pub fn spindle_parameters(&self) -> SpindleParameters {
        let kind = self.value((3010, 0), (62, 0)) as u8;
        let (gears, comparator_rpm) = self.gears();
        let old = self.has_old_numbers();
        let rigid = |number| self.get_new(number, 0).unwrap_or_default();
        let controlled = if old {
            matches!(self.old(237) as u8, 1 | 2)
        } else {
            kind >= 6
        };
        // Where axis V is active its encoder is checked unless MP76 says otherwise [001:1366-1375].
        let encoder_bit = |number| match old {
            true => controlled && !self.old_bit(76, ENCODER_BIT),
            false => bit_of(self.get_new(number, 0).unwrap_or_default(), ENCODER_BIT),
        };
        SpindleParameters {
            output: output(kind),
            controlled,
            input: self.spindle_input(),
            free_output: self.free_output(kind),
            codes: codes(self.value((3020, 0), (63, 0))),
            axes_run_on: !self.m_functions().axes_wait_for_speed,
            comparator_rpm,
            settings: SpindleSettings {
                zero_permitted: self.spindle_zero_permitted(),
                polarity: polarity(self.value((3130, 0), (172, 0))),
                counts_negative: self.value((3140, 0), (239, 0)) == 1.0,
                check_amplitude: encoder_bit(31),
                check_edges: encoder_bit(32),
                gears,
                min_volts: self.value((3240, 1), (184, 0)),
                max_volts: if old { self.old(87) } else { OUTPUT_VOLTS },
                jog_volts: self.value((3240, 2), (70, 0)),
                override_percent: self.spindle_override_percent(),
                ramps: SpindleRamps {
                    normal_v_ms: self.value((3410, 0), (168, 0)),
                    orientation_v_ms: self.value((3410, 1), (168, 0)),
                    tapping_v_ms: self.value((3410, 2), (168, 0)),
                    rigid_v_ms: self.value((3410, 3), (168, 0)),
                },
                orientation: OrientationSettings {
                    window_deg: self.value((3420, 0), (246, 0)) * INCREMENT_DEG,
                    reference_deg: self.value((3430, 0), (240, 0)),
                    jog_rpm: self.value((3520, 0), (258, 0)),
                    speed_rpm: self.value((3520, 1), (248, 0)),
                },
                lead: LeadSettings {
                    run_in_deg_min: rigid(7130),
                    transient: rigid(7140),
                },
            },
            tapping: self.tapping_parameters(),
        }
    }

    fn gears(&self) -> ([Gear; GEARS], Option<[f64; OLD_GEARS]>) {
        let mut gears = [Gear::default(); GEARS];
        for (index, gear) in (0u8..).zip(&mut gears) {
            *gear = Gear {
                rated_rpm: self.value((3510, index), (78 + u16::from(index), 0)),
                rated_volts: self.value((3210, index), (86, 0)),
                max_rpm: self.get_new(3515, index).unwrap_or_default(),
                kv: self.value((3440, index), (238, 0)),
            };
        }
        let mut comparator = None;
        if self.has_old_numbers() {
            let used = gears.iter().filter(|gear| gear.rated_rpm > 0.0);
            if !used.is_sorted_by(|gear, next| gear.rated_rpm < next.rated_rpm) {
                let mut speeds = [0.0; OLD_GEARS];
                for (speed, gear) in speeds.iter_mut().zip(gears.iter_mut().skip(OLD_GEARS)) {
                    *speed = std::mem::take(gear).rated_rpm;
                }
                comparator = Some(speeds);
            }
        }
        let volts_max = self.old(87);
        for gear in gears.iter_mut().filter(|gear| gear.max_rpm == 0.0) {
            let limited = volts_max > 0.0 && gear.rated_volts > 0.0;
            let factor = if limited {
                volts_max / gear.rated_volts
            } else {
                1.0
            };
            gear.max_rpm = gear.rated_rpm * factor;
        }
        (gears, comparator)
    }

    fn spindle_input(&self) -> u8 {
        let axis_v = |input: &u8| self.old(253 + u16::from(*input)) == 5.0;
        (0..5).find(axis_v).unwrap_or(self.model().limits().spindle_input)
    }

    fn free_output(&self, kind: u8) -> FreeOutput {
        // Kinds from 3 need the output for the spindle.
        match self.get_new(3011, 0).filter(|_| kind < 3).unwrap_or_default() as u8 {
            1 => FreeOutput::Feed {
                full_mm_min: self.get(3012, 0).unwrap_or_default(),
            },
            2 => FreeOutput::Plc,
            3 => FreeOutput::MFunctions,
            _ => FreeOutput::None,
        }
    }

    fn tapping_parameters(&self) -> TappingParameters {
        let tapping = self.tapping();
        let rigid = |number| self.get_new(number, 0).unwrap_or_default();
        TappingParameters {
            override_percent: tapping.override_percent,
            reversal_dwell_s: tapping.reversal_dwell_s,
            coded_lead_s: self.value((7120, 1), (73, 0)),
            run_on_s: self.get_new(7120, 2).unwrap_or_default(),
            window_mm: rigid(7150),
            orientation: tapping.orientation,
        }
    }
}

fn output(kind: u8) -> SpindleOutput {
    match kind {
        1 => SpindleOutput::Coded { always: false },
        2 => SpindleOutput::Coded { always: true },
        3 | 6 => SpindleOutput::Analogue {
            gear: GearSignal::OnChange,
        },
        4 | 7 => SpindleOutput::Analogue {
            gear: GearSignal::Always,
        },
        5 | 8 => SpindleOutput::Analogue {
            gear: GearSignal::Never,
        },
        _ => SpindleOutput::None,
    }
}

fn polarity(value: f64) -> SpindlePolarity {
    match value as u8 {
        0 => SpindlePolarity::M3Positive,
        1 => SpindlePolarity::M3Negative,
        2 => SpindlePolarity::BothPositive,
        _ => SpindlePolarity::BothNegative,
    }
}

/// Reads `20802`: codes 20 to 80, every second. A step of 0 counts as 1 (inferred).
fn codes(value: f64) -> SpeedCodes {
    let digits = value as u32;
    SpeedCodes {
        min: (digits / 1000 % 100) as u8,
        max: (digits / 10 % 100) as u8,
        step: (digits % 10).max(1) as u8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ControlModel;

    #[test]
    fn the_lead_of_tapping_is_at_least_30_ms() {
        // 1.8 V at 0.05 V/ms: 36 ms; a run-on of 6 ms or more leaves 30 ms [000:6072-6077].
        let lead_ms = |run_on| (lead_s(1.8, 0.05, run_on) * 1e6).round() / 1e3;
        assert_eq!(lead_ms(0.0), 36.0);
        assert_eq!(lead_ms(0.002), 34.0);
        assert_eq!(lead_ms(0.006), 30.0);
        assert_eq!(lead_ms(5.0), 30.0);
        // A ramp shorter than 30 ms is not delayed.
        assert_eq!((lead_s(1.0, 0.05, 1.0) * 1e6).round(), 20_000.0);
        assert_eq!(lead_s(1.8, 0.0, 0.0), 0.0);
    }

    #[test]
    fn the_code_range_reads_as_the_manual_says() {
        // 20802 = codes 20 to 80, every second; 991 = all [000:5718-5745].
        assert_eq!(
            codes(20802.0),
            SpeedCodes {
                min: 20,
                max: 80,
                step: 2
            }
        );
        assert_eq!(
            codes(991.0),
            SpeedCodes {
                min: 0,
                max: 99,
                step: 1
            }
        );
        // The TNC 155 prints 1991: codes 1 to 99 [001:1497-1499].
        assert_eq!(
            codes(1991.0),
            SpeedCodes {
                min: 1,
                max: 99,
                step: 1
            }
        );
    }

    #[test]
    fn mp3010_says_kind_gear_signal_and_control() {
        let mut list = ParameterList::reference(ControlModel::Tnc407);
        let table = [
            (0, SpindleOutput::None, false),
            (1, SpindleOutput::Coded { always: false }, false),
            (2, SpindleOutput::Coded { always: true }, false),
            (
                3,
                SpindleOutput::Analogue {
                    gear: GearSignal::OnChange,
                },
                false,
            ),
            (
                4,
                SpindleOutput::Analogue {
                    gear: GearSignal::Always,
                },
                false,
            ),
            (
                5,
                SpindleOutput::Analogue {
                    gear: GearSignal::Never,
                },
                false,
            ),
            (
                6,
                SpindleOutput::Analogue {
                    gear: GearSignal::OnChange,
                },
                true,
            ),
            (
                7,
                SpindleOutput::Analogue {
                    gear: GearSignal::Always,
                },
                true,
            ),
            (
                8,
                SpindleOutput::Analogue {
                    gear: GearSignal::Never,
                },
                true,
            ),
        ];
        for (value, output, controlled) in table {
            list.set(3010, 0, f64::from(value)).unwrap();
            let spindle = list.spindle_parameters();
            assert_eq!(
                (spindle.output, spindle.controlled),
                (output, controlled),
                "MP3010 = {value}"
            );
        }
    }

    #[test]
    fn old_speeds_that_do_not_ascend_are_four_gears_and_a_comparator() {
        let mut list = ParameterList::reference(ControlModel::Tnc155);
        for (number, rpm) in (78..).zip([500.0, 1000.0, 2000.0, 4000.0, 450.0, 900.0, 1800.0, 3600.0]) {
            list.set(number, 0, rpm).unwrap();
        }
        let spindle = list.spindle_parameters();
        assert_eq!(spindle.settings.gears[3].rated_rpm, 4000.0);
        assert_eq!(spindle.settings.gears[4].rated_rpm, 0.0);
        assert_eq!(spindle.comparator_rpm, Some([450.0, 900.0, 1800.0, 3600.0]));
        // 9 V at the rated speed, 9.999 V at most: 4000 / 9 * 9.999 = 4444 rpm.
        assert!((spindle.settings.gears[3].max_rpm - 4444.0).abs() < 1e-9);
    }
}
