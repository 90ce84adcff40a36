//! The control models as constants: what is not named is that of the model before. Citations and what is inferred stand
//! at the fields of [`Limits`].

use super::{Blockwise, EmergencyStopTest, InchFeed, Limits, MachineZero, Numbering, OemTexts};
use crate::ControlModel;

impl ControlModel {
    /// Limits and functions of the model.
    pub const fn limits(self) -> &'static Limits {
        use ControlModel::*;
        match self {
            Tnc151 | Tnc151q => &TNC151,
            Tnc151b => &TNC151B,
            Tnc151br => &TNC151BR,
            Tnc151qr => &TNC151QR,
            Tnc151f => &TNC151F,
            Tnc151fr => &TNC151FR,
            Tnc151w => &TNC151W,
            Tnc151wr => &TNC151WR,
            Tnc155 | Tnc155q => &TNC155,
            Tnc155b => &TNC155B,
            Tnc155br => &TNC155BR,
            Tnc155qr => &TNC155QR,
            Tnc155f => &TNC155F,
            Tnc155fr => &TNC155FR,
            Tnc155w => &TNC155W,
            Tnc155wr => &TNC155WR,
            Tnc360 => &TNC360,
            Tnc407 => &TNC407,
            Tnc415b => &TNC415B,
            Tnc415f => &TNC415F,
            Tnc425 => &TNC425,
            Tnc425e => &TNC425E,
        }
    }
}

/// The first one: all others say what they have otherwise.
const TNC151: Limits = Limits {
    program_name_max: 8,
    files_max: 0,
    label_max: 254,
    repeat_max: 65_534,
    subprogram_nesting_max: 8,
    program_nesting_max: 4,
    program_memory_bytes: 4000 * 22,
    blockwise: FREE,
    q_max: 113,
    fn_functions: FN_151,
    formulas: false,
    fn19_per_mm: None,
    fn14_max: 499,
    print_items_max: 6,
    iso_characters_max: 64,
    tool_max: 254,
    tool_table_max: 99,
    spindle_speed_max_rpm: 99_999.0,
    feed_max_mm_min: 15_999.0,
    rapid_feed_mm_min: Some(15_999.0),
    inch_feed: InchFeed::Tenths,
    coordinate_max: 30_000.0,
    circle_radius_max_mm: 30_000.0,
    polar_angle_max_deg: 360.0,
    circle_angle_max_deg: 5400.0,
    resolution_mm: 1e-3,
    resolution_deg: 1e-3,
    orientation_step_deg: 0.1,
    axes_max: 4,
    line_axes_max: 3,
    circle_axes_max: 2,
    helix_axes_max: 3,
    machine_zero: MachineZero::ScaleDatum,
    blank_side_max_mm: 30_000.0,
    blank_ratio_limit: 84.0,
    cycles: CYCLES_151,
    contour_labels_max: 12,
    dwell_max_s: 30_000.0,
    rotation_max_deg: 360.0,
    scaling_range: [0.000_001, 99.999_999],
    block_time_ms: 40.0,
    contour_cycle_us: 6000,
    fine_cycle_us: None,
    output_bits: 12,
    plc_cycle_us: 20_000,
    plc_code_max_bytes: 131_072,
    plc_positioning_axes_max: 5,
    emergency_stop_test: STOP_TEST_151,
    numbering: Numbering::Old,
    inputs: INPUTS_151,
    outputs: OUTPUTS_151,
    plc_mode: false,
    rs_422: false,
    baud_rate_max: 9600,
    transfer_codes: false,
    windows: false,
    measuring_probe: false,
    transfers_blockwise: true,
    graphics: false,
    draws_what_runs: false,
    simulates_in_program_run: false,
    one_axis_by_mdi: false,
    shows_feed_of_keys: true,
    oscilloscope: false,
    erases_its_list: true,
    approach_functions: true,
    square_wave_input: 4,
    spindle_input: 4,
    unit: "Q",
    soft_keys: false,
    oem_texts: OEM_TEXTS_151,
};

/// TNC 151 with graphics [001:186].
const TNC155: Limits = Limits {
    graphics: true,
    draws_what_runs: true,
    simulates_in_program_run: true,
    ..TNC151
};

const TNC151B: Limits = with_standard_interface(TNC151);
const TNC151BR: Limits = with_square_waves(TNC151B);
const TNC151QR: Limits = with_square_waves(TNC151);
const TNC151F: Limits = for_export(TNC151B);
const TNC151FR: Limits = for_export(TNC151BR);
const TNC151W: Limits = for_export(TNC151);
const TNC151WR: Limits = for_export(TNC151QR);
const TNC155B: Limits = with_standard_interface(TNC155);
const TNC155BR: Limits = with_square_waves(TNC155B);
const TNC155QR: Limits = with_square_waves(TNC155);
const TNC155F: Limits = for_export(TNC155B);
const TNC155FR: Limits = for_export(TNC155BR);
const TNC155W: Limits = for_export(TNC155);
const TNC155WR: Limits = for_export(TNC155QR);

/// Version B: the terminals of the standard interface, without PLC boards [001:144-150].
const fn with_standard_interface(of: Limits) -> Limits {
    Limits {
        unit: "B",
        inputs: INPUTS_B,
        outputs: OUTPUTS_B,
        ..of
    }
}

/// Suffix R: encoder inputs for square-wave signals [001:175-177].
const fn with_square_waves(of: Limits) -> Limits {
    Limits {
        square_wave_input: 0,
        ..of
    }
}

/// Versions F and W: without movement in space and "transfer blockwise" [001:132-136] [001:167-173].
const fn for_export(of: Limits) -> Limits {
    Limits {
        line_axes_max: 2,
        helix_axes_max: 2,
        transfers_blockwise: false,
        ..of
    }
}

/// Numbers of machine parameters, terminals and interface as on the later models.
const TNC360: Limits = Limits {
    files_max: 32,
    blockwise: BLOCKWISE_360,
    q_max: 123,
    fn_functions: FN_360,
    fn19_per_mm: Some(1e3),
    iso_characters_max: 150,
    feed_max_mm_min: 29_999.0,
    rapid_feed_mm_min: None,
    inch_feed: InchFeed::Whole,
    cycles: CYCLES_360,
    output_bits: 14,
    emergency_stop_test: STOP_TEST_407,
    numbering: Numbering::New,
    unit: "LE",
    inputs: INPUTS,
    outputs: OUTPUTS,
    baud_rate_max: 38_400,
    transfer_codes: true,
    one_axis_by_mdi: true,
    shows_feed_of_keys: false,
    erases_its_list: false,
    approach_functions: false,
    square_wave_input: 6,
    spindle_input: 5,
    soft_keys: true,
    oem_texts: OEM_TEXTS,
    ..TNC155
};

/// The PLC of the machine builder, windows and five axes.
const TNC407: Limits = Limits {
    program_name_max: 16,
    files_max: 100,
    program_memory_bytes: 6000 * 22,
    blockwise: FREE,
    q_max: 299,
    formulas: true,
    fn19_per_mm: Some(1e4),
    tool_table_max: 254,
    spindle_speed_max_rpm: 99999.999,
    feed_max_mm_min: 300_000.0,
    inch_feed: InchFeed::Tenths,
    coordinate_max: 99999.9999,
    circle_radius_max_mm: 99999.9999,
    orientation_step_deg: 1e-3,
    axes_max: 5,
    machine_zero: MachineZero::Mp960,
    cycles: CYCLES_407,
    block_time_ms: 25.0,
    plc_cycle_us: 24_000,
    plc_code_max_bytes: 65_536,
    plc_positioning_axes_max: 3,
    plc_mode: true,
    rs_422: true,
    windows: true,
    draws_what_runs: false,
    simulates_in_program_run: false,
    one_axis_by_mdi: false,
    shows_feed_of_keys: true,
    oscilloscope: true,
    square_wave_input: 4,
    ..TNC360
};

/// Cycles of 3 ms, 0.1 µm, tilting of the working plane.
const TNC415B: Limits = Limits {
    program_memory_bytes: 12_000 * 22,
    resolution_mm: 1e-4,
    resolution_deg: 1e-4,
    orientation_step_deg: 1e-4,
    line_axes_max: 5,
    circle_axes_max: 3,
    cycles: CYCLES_415,
    block_time_ms: 4.0,
    contour_cycle_us: 3000,
    fine_cycle_us: Some(600),
    output_bits: 16,
    plc_cycle_us: 20_000,
    plc_code_max_bytes: 131_072,
    plc_positioning_axes_max: 5,
    emergency_stop_test: STOP_TEST_415,
    draws_what_runs: true,
    measuring_probe: true,
    square_wave_input: 5,
    ..TNC407
};

/// TNC 415 B with digital speed control, which is the matter of its parameters [000:18117-18152].
const TNC425: Limits = TNC415B;

/// TNC 415 B for export: four of five axes, 1 µm [000:339-355] [000:752-760].
const TNC415F: Limits = Limits {
    line_axes_max: 4,
    resolution_mm: 1e-3,
    resolution_deg: 1e-3,
    ..TNC415B
};

/// TNC 425 for export.
const TNC425E: Limits = TNC415F;

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
const OEM_TEXTS_151: OemTexts = OemTexts {
    number_max: 99,
    name_max: 16,
    parameter_max: 32,
    standard: Some(["User Cycl", "Cycl parameter"]),
};
const OEM_TEXTS: OemTexts = OemTexts {
    number_max: 127,
    name_max: 34,
    parameter_max: 34,
    standard: None,
};
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
const INPUTS_B: &[(u16, u16)] = &[(0, 23)];
const OUTPUTS_B: &[(u16, u16)] = &[(0, 22)];
const INPUTS: &[(u16, u16)] = &[(0, 31), (64, 127), (128, 152), (160, 175), (192, 255)];
const OUTPUTS_151: &[(u16, u16)] = &[(0, 30), (32, 62)];
const OUTPUTS: &[(u16, u16)] = &[(0, 30), (32, 62), (64, 94), (96, 111)];
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
