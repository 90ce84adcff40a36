//! Limits and functions of the control models: what programs are checked against, and what a model has.
//!
//! Each model is a constant of [`models`], beside the one it inherits from.
//!
//! Decision: Inputs and outputs of the TNC 360, which no manual names, are those of its successors
//!
//! Decision: F of programs in inches counts tenths of an inch/min on all models but the TNC 360 (inch/min);
//! `--inch-feed` overrides, a program whose feeds are all far off is warned of (also `program/src/inch_feed.rs`)

mod models;

use bahn_servo::Timing;

use crate::ControlModel;

/// What a control model can do and between which limits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    // Programs.
    /// Longest program name, characters [001:2142] [003:979] [000:6847].
    pub program_name_max: u8,
    /// Programs of a TNC 360 [003:977], files of a TNC 407 and later [000:171] that the memory holds; 0: no number is given.
    pub files_max: u32,
    /// Highest label number; label 0 ends subprograms [003:3623-3629]; others than TNC 360 (inferred).
    pub label_max: u32,
    /// Highest count after REP [003:3747-3763]; others than TNC 360 (inferred).
    pub repeat_max: u32,
    /// Levels of nested subprograms [003:3915-3921]; others than TNC 360 (inferred).
    pub subprogram_nesting_max: u8,
    /// Levels of nested program calls [003:3915-3921] [001:2829-2833] [000:17711].
    pub program_nesting_max: u8,

    /// Memory for part programs, bytes: 6000 blocks on the TNC 407, 12 000 on the TNC 415/425 [000:135], 4000 on the TNC 360
    /// [003:7780-7781]; a block taken as 22 bytes, and TNC 151/155 as TNC 360 (inferred).
    pub program_memory_bytes: u32,
    /// What a program that is transferred blockwise must not have beside subprograms and repeats.
    pub blockwise: Blockwise,

    // Q parameters.
    /// Highest Q parameter. TNC 151/155: Q113 is the last one named [001:2931-2960]; TNC 360: Q123
    /// [003:7653-7662]; TNC 407/415/425: Q299 (inferred, the technical manual names Q119 at most).
    pub q_max: u16,
    /// FN functions that exist [003:4147-4395] [000:17842-17846]; TNC 151/155 (inferred from FN0, FN1,
    /// FN4, FN12 in [001:2857-2866]).
    pub fn_functions: &'static [u8],
    /// Formulas with brackets, `Q1 = SIN 30 + SQRT Q2` [000:151-159].
    pub formulas: bool,
    /// What FN19 hands to the PLC for 1 mm or 1 degree: TNC 360 counts in 1 µm [003:4391-4395],
    /// TNC 407/415/425 in 1/10 000 mm [000:11597-11655].
    pub fn19_per_mm: Option<f64>,
    /// Highest number of FN14 [003:4364-4367]; others than TNC 360 (inferred).
    pub fn14_max: u16,
    /// Items of one FN15 PRINT block [003:4371-4385]; others than TNC 360 (inferred).
    pub print_items_max: u8,

    // Programs.
    /// Most characters of a block in DIN/ISO: 150 [000:615]; TNC 151/155 64, TNC 360 as the TNC 407 (public).
    pub iso_characters_max: u32,

    // Tools, spindle, feed.
    /// Highest tool number; tool 0 has length and radius 0 [001:736] [003:1814] [000:180].
    pub tool_max: u32,
    /// Most tools of the central tool table [001:1600] [003:7299] [000:10397].
    pub tool_table_max: u16,
    /// Highest spindle speed, rpm [001:1502] [003:2180-2182] [000:5478-5480].
    pub spindle_speed_max_rpm: f64,
    /// Highest feed rate, mm/min [001:471] [003:2142-2144] [000:264-266].
    pub feed_max_mm_min: f64,
    /// Feed rate that means rapid traverse where FMAX is not a word of its own [001:471].
    pub rapid_feed_mm_min: Option<f64>,

    /// What F counts in a program in inches [001:471] [003:2140]; TNC 407/415/425 as the TNC 151/155, whose
    /// programs they run (inferred).
    pub inch_feed: InchFeed,

    // Positions.
    /// Greatest coordinate, mm or degrees, either sign [001:3188-3195] [003:7821] [000:577-589].
    pub coordinate_max: f64,
    /// Greatest radius of a CR block, mm [003:2853-2855]; others than TNC 360 by their coordinates
    /// (inferred).
    pub circle_radius_max_mm: f64,
    /// Greatest polar angle PA of LP, degrees, either sign [003:3089]; others than TNC 360 (inferred).
    pub polar_angle_max_deg: f64,
    /// Greatest polar angle PA of CP, helix included, degrees, either sign: 15 turns [003:3173-3183];
    /// others than TNC 360 (inferred).
    pub circle_angle_max_deg: f64,
    /// Input step of lengths, mm [001:1612-1614] [003:7825] [000:6419-6424].
    pub resolution_mm: f64,
    /// Input step of angles, degrees [003:7825] [000:6419-6424]; TNC 151/155 (inferred).
    pub resolution_deg: f64,
    /// Input step of cycle 13, degrees [003:6528]; TNC 151/155 and 407/415/425 (inferred).
    pub orientation_step_deg: f64,
    /// Axes that a machine can have [001:1089-1103] [003:7751] [000:133].
    pub axes_max: u8,
    /// Axes that move together on a straight line [001:167-173] [003:7761-7763] [000:139].
    pub line_axes_max: u8,
    /// Axes that move together on a circle [003:7761-7763] [000:140]; TNC 151/155 (inferred).
    pub circle_axes_max: u8,
    /// Axes that move together on a helix [003:7761-7763] [000:141]; others than TNC 360 (inferred).
    pub helix_axes_max: u8,
    /// From where the coordinates of a block with M91 count.
    pub machine_zero: MachineZero,
    /// Longest side of the blank, mm [003:2105]; TNC 407/415/425 [000:704-708]; TNC 151/155 (inferred).
    pub blank_side_max_mm: f64,
    /// The ratio of the blank's sides must stay below it [003:2121]; others than TNC 360 (inferred).
    pub blank_ratio_limit: f64,

    // Cycles and miscellaneous functions.
    /// Standard cycles that exist [003:4811-4816] [000:6655-6699] [000:6143] [000:836]; TNC 151/155
    /// (inferred: those of the TNC 360 without rigid tapping, which they lack).
    pub cycles: &'static [u8],
    /// Most subcontours of cycle 14 [003:5466]; others than TNC 360 (inferred).
    pub contour_labels_max: u8,
    /// Longest dwell of cycle 9, s [003:6462-6474]; others than TNC 360 (inferred).
    pub dwell_max_s: f64,
    /// Greatest rotation of cycle 10, degrees, either sign [003:6313-6333]; others than TNC 360 (inferred).
    pub rotation_max_deg: f64,
    /// Least and greatest factor of cycle 11 [003:6385-6412]; others than TNC 360 (inferred).
    pub scaling_range: [f64; 2],

    // Time.
    /// Block processing time of a straight line in space, ms [003:7815] [000:143]; TNC 151/155 (inferred).
    pub block_time_ms: f64,
    /// Contour cycle: period of the interpolated nominal positions, µs [003:7817] [000:212-222];
    /// TNC 151/155 (inferred).
    pub contour_cycle_us: u32,
    /// Period of the fine interpolation between them, µs: TNC 415 B of the contour, TNC 425 of the
    /// speed loop [000:212-224].
    pub fine_cycle_us: Option<u32>,
    /// Bits of the converter after a nominal value output, for 10 V of either sign: 16 [000:4863], 14
    /// [000:4863], TNC 151/155 steps of 2.44 mV [001:2573-2585]; TNC 360 as TNC 407 (inferred).
    pub output_bits: u8,

    // PLC, EMERGENCY STOP.
    /// Period of the PLC, µs [000:239] [000:10260] [000:11185] [001:3283]; TNC 360 (inferred).
    pub plc_cycle_us: u32,
    /// Code of all files of a PLC program together, bytes: 128 KB, 64 KB on the TNC 407 [000:14606]; TNC 151/155/360
    /// (inferred).
    pub plc_code_max_bytes: u32,
    /// Axes that the PLC positions at once [000:4011]; others than TNC 407 (inferred).
    pub plc_positioning_axes_max: u8,
    /// The test of the EMERGENCY STOP circuit at power-on.
    pub emergency_stop_test: EmergencyStopTest,
    /// How the machine parameters are numbered.
    pub numbering: Numbering,

    // Terminals.
    /// First encoder input with square-wave signals, counted from 0: X5 of the TNC 151/155 [001:2434-2454] and of the TNC 407,
    /// X6 of the TNC 415/425 [000:1503-1505] [000:18201]; none on the TNC 360 (inferred).
    pub square_wave_input: u8,
    /// Encoder input of the spindle, counted from 0: X5, axis V, of the TNC 151/155 [001:2434-2454], X6 of the others.
    pub spindle_input: u8,
    /// The unit that its terminals belong to, as [`crate::terminals`] has them: `B` and `Q` are those of the TNC 151/155 without
    /// and with PLC boards [001:132-165], `LE` is the logic unit of the TNC 407/415/425; TNC 360 as these (inferred).
    pub unit: &'static str,
    /// Inputs that a PLC program may name, first and last of each board: TNC 151/155 E0-E62, E64-E126
    /// [001:297], version B E0-E23; [000:11556-11567] [000:2380-2496] and those of the handwheel [000:8276-8281]; TNC 360 as these
    /// (inferred).
    pub inputs: &'static [(u16, u16)],
    /// Outputs in the same way: TNC 151/155 A0-A30, A32-A62 [001:311].
    pub outputs: &'static [(u16, u16)],

    // What only some models have.
    /// The PLC mode after code number 807 667: editor, compiler, trace and tables [000:11187-11241].
    pub plc_mode: bool,
    /// A second data interface, RS-422/V.11, beside RS-232-C/V.24 [000:16712-16722].
    pub rs_422: bool,
    /// Fastest data interface, baud [001:1162] [003:7048] [000:17560-17566].
    pub baud_rate_max: u32,
    /// A letter after TRANSFERRED DATA INCORRECT; the TNC 151/155 has none, and calls what it could not send
    /// PROGRAM INCOMPLETE [000:17581-17601] [001:2036-2052].
    pub transfer_codes: bool,
    /// The screen of 14 inches: windows side by side, in colours [000:6289-6306] [000:2784-2833].
    pub windows: bool,
    /// An input for a measuring probe, X14 [000:18194-18228].
    pub measuring_probe: bool,
    /// Programs run while they are transferred; not on the export versions of the TNC 151/155 [001:136] [001:173].
    pub transfers_blockwise: bool,
    /// Graphics of programs and parts, hard copy: on the TNC 155, not on the TNC 151 [001:186] [001:2157].
    pub graphics: bool,
    /// Program run draws what runs; the graphics of a TNC 407 are those of TEST RUN [000:164-166] [000:6370].
    pub draws_what_runs: bool,
    /// The program run modes simulate the selected program before it runs [003:856-874].
    pub simulates_in_program_run: bool,
    /// Positioning blocks of MDI are those of a single axis [003:3566].
    pub one_axis_by_mdi: bool,
    /// By hand the feed of the axis is shown whose direction key is pressed [000:6529-6540]; a TNC 360 shows a feed with MP7270 + 1
    /// alone [003:7304-7309].
    pub shows_feed_of_keys: bool,
    /// An oscilloscope after code number 688 379 [000:18640].
    pub oscilloscope: bool,
    /// Code number 531 210 erases the machine parameters [001:1293-1297].
    pub erases_its_list: bool,
    /// M95 and M96 belong to the approach of a contour [001:707-708].
    pub approach_functions: bool,
    /// Soft keys below the screen; the TNC 151/155 has none, what its screen asks keys of the keyboard answer [001:2774-2780].
    pub soft_keys: bool,
    /// What the texts of cycles of the machine builder must keep to.
    pub oem_texts: OemTexts,
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

/// Numbers and lengths of the dialogue texts of cycles of the machine builder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OemTexts {
    /// Highest number of a text [001:2764] [000:17742].
    pub number_max: u16,
    /// Characters of the name of a cycle [000:17861-17866]; TNC 151/155 16, as the example BOLT HOLE CIRCLE has [001:2908], not
    /// the 14 of the rule that it breaks [001:2925].
    pub name_max: u8,
    /// Characters of the text of a parameter.
    pub parameter_max: u8,
    /// Texts that are there without any of the machine builder: that of the name, and of a parameter before its number
    /// [001:2913-2922].
    pub standard: Option<[&'static str; 2]>,
}

impl OemTexts {
    /// The text that a number has when the machine builder has written none: 0 the name, 1 to 14 the parameters.
    ///
    /// ```
    /// use bahn_parameters::ControlModel::{Tnc155, Tnc407};
    ///
    /// let texts = Tnc155.limits().oem_texts;
    /// assert_eq!(texts.standard(0), "User Cycl");
    /// assert_eq!(texts.standard(14), "Cycl parameter 14");
    /// assert_eq!((texts.standard(15), Tnc407.limits().oem_texts.standard(0)), (String::new(), String::new()));
    /// ```
    pub fn standard(&self, number: u16) -> String {
        match (self.standard, number) {
            (Some([name, _]), 0) => name.to_owned(),
            (Some([_, parameter]), 1..=14) => format!("{parameter} {number}"),
            _ => String::new(),
        }
    }
}

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
    /// Feed that F1 means in a program in inches, mm/min.
    pub const fn mm_min(self) -> f64 {
        match self {
            InchFeed::Whole => 25.4,
            InchFeed::Tenths => 2.54,
        }
    }

    /// The other reading, ten times this feed or a tenth of it.
    pub const fn other(self) -> InchFeed {
        match self {
            InchFeed::Whole => InchFeed::Tenths,
            InchFeed::Tenths => InchFeed::Whole,
        }
    }
}

impl ControlModel {
    /// Its contour cycle of 3 or 6 ms, in servo steps of 0.6 ms where it has fine interpolation [000:212-224], and the
    /// bits of its converter.
    pub fn timing(self) -> Timing {
        let limits = self.limits();
        let steps = limits
            .fine_cycle_us
            .map_or(1, |fine_us| limits.contour_cycle_us / fine_us);
        Timing::new(limits.contour_cycle_us, steps, limits.output_bits)
    }
}

impl Limits {
    /// Its machine parameters, inputs and outputs are numbered and lettered as on the TNC 151/155 [001:477-482]
    /// [001:1580-1950].
    pub fn has_old_numbers(&self) -> bool {
        self.numbering == Numbering::Old
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ControlModel::{Tnc151, Tnc155, Tnc360, Tnc407, Tnc415b, Tnc425};

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
