//! Limits and functions of the control models: the table that programs are checked against.
//!
//! The columns are, in this order: TNC 151, TNC 155, TNC 360, TNC 407, TNC 415 B, TNC 425. A value
//! that no manual prints for a model is taken from its nearest sister and marked (inferred).

use crate::ControlModel::{self, Tnc151, Tnc155, Tnc360, Tnc407, Tnc415b, Tnc425};

macro_rules! limits {
    ($($(#[$doc:meta])* $field:ident: $kind:ty =
        $tnc151:expr, $tnc155:expr, $tnc360:expr, $tnc407:expr, $tnc415b:expr, $tnc425:expr;)+) => {
        /// What a control model can do and between which limits.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub struct Limits {
            $($(#[$doc])* pub $field: $kind,)+
        }

        impl ControlModel {
            /// Limits and functions of the model.
            pub const fn limits(self) -> &'static Limits {
                match self {
                    Tnc151 => &Limits { $($field: $tnc151),+ },
                    Tnc155 => &Limits { $($field: $tnc155),+ },
                    Tnc360 => &Limits { $($field: $tnc360),+ },
                    Tnc407 => &Limits { $($field: $tnc407),+ },
                    Tnc415b => &Limits { $($field: $tnc415b),+ },
                    Tnc425 => &Limits { $($field: $tnc425),+ },
                }
            }
        }
    };
}

limits! {
    // Programs.

    /// Longest program name, characters [001:2142] [003:979] [000:6847].
    program_name_max: u8 = 8, 8, 8, 16, 16, 16;
    /// Programs of a TNC 360 [003:977], files of a TNC 407 and later [000:171] that the memory holds; 0: no number is given.
    files_max: u32 = 0, 0, 32, 100, 100, 100;
    /// Highest label number; label 0 ends subprograms [003:3623-3629]; others than TNC 360 (inferred).
    label_max: u32 = 254, 254, 254, 254, 254, 254;
    /// Highest count behind REP [003:3747-3763]; others than TNC 360 (inferred).
    repeat_max: u32 = 65_534, 65_534, 65_534, 65_534, 65_534, 65_534;
    /// Levels of nested subprograms [003:3915-3921]; others than TNC 360 (inferred).
    subprogram_nesting_max: u8 = 8, 8, 8, 8, 8, 8;
    /// Levels of nested program calls [003:3915-3921] [001:2829-2833] [000:17711].
    program_nesting_max: u8 = 4, 4, 4, 4, 4, 4;

    /// Memory for part programs, bytes: 6000 blocks on the TNC 407, 12 000 on the TNC 415/425 [000:135], 4000 on the TNC 360
    /// [003:7780-7781]; a block taken as 22 bytes, and TNC 151/155 as TNC 360 (inferred).
    program_memory_bytes: u32 = 4000 * 22, 4000 * 22, 4000 * 22, 6000 * 22, 12_000 * 22, 12_000 * 22;
    /// What a program that is transferred blockwise must not have beside subprograms and repeats.
    blockwise: Blockwise = FREE, FREE, BLOCKWISE_360, FREE, FREE, FREE;

    // Q parameters.

    /// Highest Q parameter. TNC 151/155: Q113 is the last one named [001:2931-2960]; TNC 360: Q123
    /// [003:7653-7662]; TNC 407/415/425: Q299 (inferred, the technical manual names Q119 at most).
    q_max: u16 = 113, 113, 123, 299, 299, 299;
    /// FN functions that exist [003:4147-4395] [000:17842-17846]; TNC 151/155 (inferred from FN0, FN1,
    /// FN4, FN12 in [001:2857-2866]).
    fn_functions: &'static [u8] = FN_151, FN_151, FN_360, FN_360, FN_360, FN_360;
    /// Formulas with brackets, `Q1 = SIN 30 + SQRT Q2` [000:151-159].
    formulas: bool = false, false, false, true, true, true;
    /// What FN19 hands to the PLC for 1 mm or 1 degree: TNC 360 counts in 1 µm [003:4391-4395],
    /// TNC 407/415/425 in 1/10 000 mm [000:11597-11655].
    fn19_per_mm: Option<f64> = None, None, Some(1e3), Some(1e4), Some(1e4), Some(1e4);
    /// Highest number of FN14 [003:4364-4367]; others than TNC 360 (inferred).
    fn14_max: u16 = 499, 499, 499, 499, 499, 499;
    /// Items of one FN15 PRINT block [003:4371-4385]; others than TNC 360 (inferred).
    print_items_max: u8 = 6, 6, 6, 6, 6, 6;

    // Programs.

    /// Most characters of a block in DIN/ISO: 150 [000:615]; TNC 151/155 64, TNC 360 as the TNC 407 (public).
    iso_characters_max: u32 = 64, 64, 150, 150, 150, 150;

    // Tools, spindle, feed.

    /// Highest tool number; tool 0 has length and radius 0 [001:736] [003:1814] [000:180].
    tool_max: u32 = 254, 254, 254, 254, 254, 254;
    /// Most tools of the central tool table [001:1600] [003:7299] [000:10397].
    tool_table_max: u16 = 99, 99, 99, 254, 254, 254;
    /// Highest spindle speed, rpm [001:1502] [003:2180-2182] [000:5478-5480].
    spindle_speed_max_rpm: f64 = 99_999.0, 99_999.0, 99_999.0, 99999.999, 99999.999, 99999.999;
    /// Highest feed rate, mm/min [001:471] [003:2142-2144] [000:264-266].
    feed_max_mm_min: f64 = 15_999.0, 15_999.0, 29_999.0, 300_000.0, 300_000.0, 300_000.0;
    /// Feed rate that means rapid traverse where FMAX is not a word of its own [001:471].
    rapid_feed_mm_min: Option<f64> = Some(15_999.0), Some(15_999.0), None, None, None, None;

    /// What F counts in a program in inches [001:471] [003:2140]; TNC 407/415/425 as the TNC 151/155, whose
    /// programs they run (inferred).
    inch_feed: InchFeed = TENTHS, TENTHS, WHOLE, TENTHS, TENTHS, TENTHS;

    // Positions.

    /// Greatest coordinate, mm or degrees, either sign [001:3188-3195] [003:7821] [000:577-589].
    coordinate_max: f64 = 30_000.0, 30_000.0, 30_000.0, 99999.9999, 99999.9999, 99999.9999;
    /// Greatest radius of a CR block, mm [003:2853-2855]; others than TNC 360 by their coordinates
    /// (inferred).
    circle_radius_max_mm: f64 = 30_000.0, 30_000.0, 30_000.0, 99999.9999, 99999.9999, 99999.9999;
    /// Greatest polar angle PA of LP, degrees, either sign [003:3089]; others than TNC 360 (inferred).
    polar_angle_max_deg: f64 = 360.0, 360.0, 360.0, 360.0, 360.0, 360.0;
    /// Greatest polar angle PA of CP, helix included, degrees, either sign: 15 turns [003:3173-3183];
    /// others than TNC 360 (inferred).
    circle_angle_max_deg: f64 = 5400.0, 5400.0, 5400.0, 5400.0, 5400.0, 5400.0;
    /// Input step of lengths, mm [001:1612-1614] [003:7825] [000:6419-6424].
    resolution_mm: f64 = 1e-3, 1e-3, 1e-3, 1e-3, 1e-4, 1e-4;
    /// Input step of angles, degrees [003:7825] [000:6419-6424]; TNC 151/155 (inferred).
    resolution_deg: f64 = 1e-3, 1e-3, 1e-3, 1e-3, 1e-4, 1e-4;
    /// Input step of cycle 13, degrees [003:6528]; TNC 151/155 and 407/415/425 (inferred).
    orientation_step_deg: f64 = 0.1, 0.1, 0.1, 1e-3, 1e-4, 1e-4;
    /// Axes that a machine can have [001:1089-1103] [003:7751] [000:133].
    axes_max: u8 = 4, 4, 4, 5, 5, 5;
    /// Axes that move together on a straight line [001:167-173] [003:7761-7763] [000:139].
    line_axes_max: u8 = 3, 3, 3, 3, 5, 5;
    /// Axes that move together on a circle [003:7761-7763] [000:140]; TNC 151/155 (inferred).
    circle_axes_max: u8 = 2, 2, 2, 2, 3, 3;
    /// Axes that move together on a helix [003:7761-7763] [000:141]; others than TNC 360 (inferred).
    helix_axes_max: u8 = 3, 3, 3, 3, 3, 3;
    /// Zero of M91.
    machine_zero: MachineZero = SCALE, SCALE, SCALE, MP960, MP960, MP960;
    /// Longest side of the blank, mm [003:2105]; TNC 407/415/425 [000:704-708]; TNC 151/155 (inferred).
    blank_side_max_mm: f64 = 30_000.0, 30_000.0, 30_000.0, 30_000.0, 30_000.0, 30_000.0;
    /// The ratio of the blank's sides must stay below it [003:2121]; others than TNC 360 (inferred).
    blank_ratio_limit: f64 = 84.0, 84.0, 84.0, 84.0, 84.0, 84.0;

    // Cycles and miscellaneous functions.

    /// Standard cycles that exist [003:4811-4816] [000:6655-6699] [000:6143] [000:836]; TNC 151/155
    /// (inferred: those of the TNC 360 without rigid tapping, which they lack).
    cycles: &'static [u8] = CYCLES_151, CYCLES_151, CYCLES_360, CYCLES_407, CYCLES_415, CYCLES_415;
    /// Most subcontours of cycle 14 [003:5466]; others than TNC 360 (inferred).
    contour_labels_max: u8 = 12, 12, 12, 12, 12, 12;
    /// Longest dwell of cycle 9, s [003:6462-6474]; others than TNC 360 (inferred).
    dwell_max_s: f64 = 30_000.0, 30_000.0, 30_000.0, 30_000.0, 30_000.0, 30_000.0;
    /// Greatest rotation of cycle 10, degrees, either sign [003:6313-6333]; others than TNC 360 (inferred).
    rotation_max_deg: f64 = 360.0, 360.0, 360.0, 360.0, 360.0, 360.0;
    /// Least and greatest factor of cycle 11 [003:6385-6412]; others than TNC 360 (inferred).
    scaling_range: [f64; 2] = SCALING, SCALING, SCALING, SCALING, SCALING, SCALING;

    // Time.

    /// Block processing time of a straight line in space, ms [003:7815] [000:143]; TNC 151/155 (inferred).
    block_time_ms: f64 = 40.0, 40.0, 40.0, 25.0, 4.0, 4.0;
    /// Contour cycle: period of the interpolated nominal positions, µs [003:7817] [000:212-222];
    /// TNC 151/155 (inferred).
    contour_cycle_us: u32 = 6000, 6000, 6000, 6000, 3000, 3000;
    /// Period of the fine interpolation between them, µs: TNC 415 B of the contour, TNC 425 of the
    /// speed loop [000:212-224].
    fine_cycle_us: Option<u32> = None, None, None, None, Some(600), Some(600);
    /// Bits of the converter behind a nominal value output, for 10 V of either sign: 16 [000:4863], 14
    /// [000:4863], TNC 151/155 steps of 2.44 mV [001:2573-2585]; TNC 360 as TNC 407 (inferred).
    output_bits: u8 = 12, 12, 14, 14, 16, 16;

    // PLC, EMERGENCY STOP.

    /// Period of the PLC, µs [000:239] [000:10260] [000:11185] [001:3283]; TNC 360 (inferred).
    plc_cycle_us: u32 = 20_000, 20_000, 20_000, 24_000, 20_000, 20_000;
    /// Code of all files of a PLC program together, bytes: 128 KB, 64 KB on the TNC 407 [000:14606]; TNC 151/155/360
    /// (inferred).
    plc_code_max_bytes: u32 = 131_072, 131_072, 131_072, 65_536, 131_072, 131_072;
    /// Axes that the PLC positions at once [000:4011]; others than TNC 407 (inferred).
    plc_positioning_axes_max: u8 = 5, 5, 5, 3, 5, 5;
    /// The test of the EMERGENCY STOP circuit at power-on.
    emergency_stop_test: EmergencyStopTest = STOP_TEST_151, STOP_TEST_151, STOP_TEST_407, STOP_TEST_407, STOP_TEST_415,
        STOP_TEST_415;
    /// How the machine parameters are numbered.
    numbering: Numbering = OLD, OLD, NEW, NEW, NEW, NEW;

    // Terminals.

    /// First encoder input with square-wave signals, counted from 0: X5 of the TNC 407, X6 of the TNC 415/425 [000:1503-1505]
    /// [000:18201]; none on the others (inferred).
    square_wave_input: u8 = 6, 6, 6, 4, 5, 5;
    /// Inputs that machines are wired to, first and last of each board: TNC 151/155 E0-E62, E64-E126
    /// [001:297]; [000:11556-11567] and those of the handwheel [000:8276-8281]; TNC 360 as these (inferred).
    inputs: &'static [(u16, u16)] = INPUTS_151, INPUTS_151, INPUTS, INPUTS, INPUTS, INPUTS;
    /// Outputs in the same way: TNC 151/155 A0-A30, A32-A62 [001:311].
    outputs: &'static [(u16, u16)] = OUTPUTS_151, OUTPUTS_151, OUTPUTS, OUTPUTS, OUTPUTS, OUTPUTS;
}

/// Limits of programs that are executed while they are transferred [003:1661-1674]; subprograms and repeats, whose blocks are
/// erased when they are called, are in none of them (others than TNC 360 inferred).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blockwise {
    /// Highest block number that may stand in the text; numbers may repeat.
    pub block_number_max: Option<u32>,
    /// TOOL DEF blocks that the control can hold.
    pub tool_definitions_max: Option<u8>,
    /// Digitizing cycles and FN15 may be there.
    pub digitizes_and_prints: bool,
}

const FREE: Blockwise = Blockwise {
    block_number_max: None,
    tool_definitions_max: None,
    digitizes_and_prints: true,
};
const BLOCKWISE_360: Blockwise = Blockwise {
    block_number_max: Some(65_534),
    tool_definitions_max: Some(20),
    digitizes_and_prints: false,
};

/// Times and repetitions of the test of the EMERGENCY STOP circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmergencyStopTest {
    /// How often it is done: by each processor in turn, or by the only one again.
    pub times: u8,
    /// From the voltage to the output dropped: at most 66 or 70 ms, µs.
    pub recognise_us: u64,
    /// In which the acknowledgement must fall, µs.
    pub fall_us: u64,
    /// From the fallen acknowledgement to the output on again: at most 20 or 24 ms, µs.
    pub restore_us: u64,
}

/// How the machine parameters of a model are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbering {
    /// 0 to 263, without indices: TNC 151/155 [001:1580-1950].
    Old,
    /// 10 to 7690, with indices.
    New,
}

/// Zero of the coordinates in a block with M91.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MachineZero {
    /// The scale datum, that is the reference point of the scales [003:3533-3545] [001:704].
    ScaleDatum,
    /// The machine datum, which MP960 places away from the scale datum [000:6242-6269].
    Mp960,
}

/// What F counts in a program in inches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InchFeed {
    /// Inches per minute [003:2140].
    Whole,
    /// Tenths of an inch per minute [001:471].
    Tenths,
}

impl InchFeed {
    /// mm/min of F1.
    pub const fn mm_min(self) -> f64 {
        match self {
            InchFeed::Whole => 25.4,
            InchFeed::Tenths => 2.54,
        }
    }

    /// The other reading.
    pub const fn other(self) -> InchFeed {
        match self {
            InchFeed::Whole => InchFeed::Tenths,
            InchFeed::Tenths => InchFeed::Whole,
        }
    }
}

impl Limits {
    /// Whether the model has a standard cycle.
    pub fn has_cycle(&self, cycle: u32) -> bool {
        self.cycles.iter().any(|known| u32::from(*known) == cycle)
    }

    /// Whether the model has an FN function.
    pub fn has_fn(&self, function: u32) -> bool {
        self.fn_functions
            .iter()
            .any(|known| u32::from(*known) == function)
    }
}

const OLD: Numbering = Numbering::Old;
const NEW: Numbering = Numbering::New;
/// Twice within 200 ms [001:929-932]; the other times are not given (inferred).
const STOP_TEST_151: EmergencyStopTest = EmergencyStopTest {
    times: 2,
    recognise_us: 60_000,
    fall_us: 200_000,
    restore_us: 18_000,
};
/// The manual of the TNC 360 gives no times (inferred).
const STOP_TEST_407: EmergencyStopTest = EmergencyStopTest {
    times: 1,
    recognise_us: 60_000,
    fall_us: 146_000,
    restore_us: 18_000,
};
const STOP_TEST_415: EmergencyStopTest = EmergencyStopTest {
    times: 3,
    recognise_us: 60_000,
    fall_us: 114_000,
    restore_us: 18_000,
};
const INPUTS_151: &[(u16, u16)] = &[(0, 62), (64, 126)];
const INPUTS: &[(u16, u16)] = &[(0, 31), (64, 126), (128, 152), (160, 175), (192, 254)];
const OUTPUTS_151: &[(u16, u16)] = &[(0, 30), (32, 62)];
const OUTPUTS: &[(u16, u16)] = &[(0, 30), (32, 62), (64, 94), (96, 111)];
const TENTHS: InchFeed = InchFeed::Tenths;
const WHOLE: InchFeed = InchFeed::Whole;
const SCALE: MachineZero = MachineZero::ScaleDatum;
const MP960: MachineZero = MachineZero::Mp960;
const SCALING: [f64; 2] = [0.000_001, 99.999_999];
const FN_151: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14];
const FN_360: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 19];
const CYCLES_151: &[u8] = &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
const CYCLES_360: &[u8] = &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17];
/// Without cycle 19, tilting of the working plane [000:147].
const CYCLES_407: &[u8] = &[
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 20, 21, 22, 23, 24, 25, 26, 27, 31,
];
const CYCLES_415: &[u8] = &[
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 31,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_differ_where_the_manuals_say_so() {
        assert_eq!(Tnc360.limits().fn19_per_mm, Some(1000.0));
        assert_eq!(Tnc407.limits().fn19_per_mm, Some(10_000.0));
        assert!(!Tnc155.limits().has_cycle(17) && Tnc360.limits().has_cycle(17));
        assert!(!Tnc407.limits().has_cycle(19) && Tnc415b.limits().has_cycle(19));
        assert!(!Tnc151.limits().has_fn(19) && Tnc425.limits().has_fn(19));
        assert_eq!(Tnc360.limits().machine_zero, MachineZero::ScaleDatum);
        assert_eq!(Tnc415b.limits().machine_zero, MachineZero::Mp960);
    }

    #[test]
    fn fine_interpolation_divides_the_contour_cycle() {
        for model in ControlModel::ALL {
            let limits = model.limits();
            assert!(limits.line_axes_max <= limits.axes_max);
            if let Some(fine) = limits.fine_cycle_us {
                assert_eq!(limits.contour_cycle_us % fine, 0, "{model}");
            }
        }
    }
}
