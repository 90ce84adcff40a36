//! Settings of the operating modes: switch-on, overrides, handwheel, tools, restart, display.

use bahn_path::Direction;

use super::{ToolProbeParameters, bit_of};
use crate::{ControlModel, ParameterId, ParameterList, PerPlcAxis};

/// Settings of the operating modes. "old" are the numbers of the TNC 151/155.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OperationParameters {
    /// Whether there is a machine: MP7210 (old MP170) [000:6949-6954] [001:1637-1641].
    pub station: Station,
    /// A programming station moves its axes in their nominal positions and needs neither voltage nor encoders: old: yes
    /// [001:1637-1641]. Else it has PROGRAMMING AND EDITING and TEST RUN alone [000:6949].
    pub moves_without_machine: bool,
    /// POWER INTERRUPTED waits for CE after switch-on: MP7212 = 0; old: always [000:7033-7040].
    pub power_interrupted: bool,
    /// The dialogue is English: MP7230 = 1 (old MP92 + 2) [000:6956-6966] [001:3277-3281].
    pub english: bool,
    /// The RAM is tested at switch-on: MP7690 bit 0 = 0 (old MP92 without + 4) [000:6978-6986].
    pub ram_test: bool,
    /// The EPROM is tested at switch-on: MP7690 bit 1 = 0 (old MP92 without + 8) [000:6978-6986].
    pub eprom_test: bool,
    /// START while an axis direction key is held keeps the axis moving: MP7680 bit 0 (old MP68)
    /// [000:7545-7552].
    pub keys_latched: bool,
    /// Direction keys lead the axes over their reference marks after code number 84 159 alone; old: yes [001:955].
    pub marks_by_code: bool,
    /// The axes wait for the acknowledgement of an M function: MP7440 bit 2 = 0 [000:7255].
    pub axes_wait_at_m: bool,
    /// Manual modes always show the smallest manual feed: MP7270 = 1 (old MP167) [000:6536].
    pub manual_feed_shown: bool,
    /// S and M are no longer active after NC stop in manual modes: MP7270 + 2 of the TNC 360 [003:7307-7315].
    pub stop_ends_m: bool,
    /// Where the overrides act, and in which steps.
    pub overrides: OverrideParameters,
    /// Return to the contour and block scan.
    pub restart: RestartParameters,
    /// Tool table, magazine and what TOOL CALL and TOOL DEF hand to the PLC.
    pub tools: ToolParameters,
    /// Datums and traverse ranges.
    pub datums: DatumParameters,
    /// Which handwheel there is, and how it moves the axes.
    pub handwheel: HandwheelParameters,
    /// The length of the tool counts in the display of the tool axis: MP7285 = 1; old: no
    /// [000:6428-6434].
    pub tool_length_shown: bool,
    /// The programmed speed is shown before the spindle runs: old MP191; else yes [001:1577].
    pub speed_shown_at_rest: bool,
    /// How the angle of the spindle is shown.
    pub spindle_display: SpindleDisplay,
    /// Characters of a file name without its type: MP7222 [000:6847-6852], not more than the model has.
    pub file_name_max: u8,
    /// The working plane can be tilted: MP7500 = 1, TNC 415/425 only [000:4264-4400].
    pub tilting: bool,
    /// Length for blocks with surface normals includes DR2: MP7680 bit 6 [000:9179-9192].
    pub normal_length_with_dr2: bool,
    /// Cycles of the machine builder.
    pub oem_cycles: OemCycleParameters,
    /// Step of the block numbers of ISO programs: MP7220; 1 where there is none [000:6885].
    pub iso_step: u8,
    /// Whether programs are written in DIN/ISO: old MP217 [001:1653]; `None` where the operator chooses, by PROGRAM INPUT.
    pub iso_programs: Option<bool>,
}

/// Cycles of the machine builder [000:17757-17810] [001:2784-2823].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OemCycleParameters {
    /// Programs in the memory may have the names of cycles in the EPROM, and go before them: MP7240 = 1; old: they do [001:3009].
    pub names_free: bool,
    /// By how much the Q parameters of DLG-DEF cycles lie above those of DLG-CALL cycles: MP7250 (old MP263).
    pub definition_offset: u8,
    /// How many Q parameters below Q100 a cycle shares with who calls it: MP7251; old: all, since nothing
    /// makes any of them local (inferred).
    pub global_parameters: u8,
    /// By how much the numbers of the dialogue texts in force lie above those of the program: old MP259 in the English
    /// dialogue [001:2801-2823].
    pub text_offset: u8,
}

/// How the angle of the spindle is shown among the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleDisplay {
    /// Not at all.
    None,
    /// As S while it stands: MP40 bit 5 [000:3418-3432].
    Standing,
    /// In place of axis IV, whether it stands or turns, with this letter: MP237 = 2 as V, 3 to 5 as A, B, C [001:3109].
    AsFourth(char),
}

/// Whether there is a machine [000:6949-6954].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Station {
    /// Control of a machine.
    Machine,
    /// Programming station, the PLC runs.
    WithPlc,
    /// Programming station, no PLC.
    WithoutPlc,
}

/// In which steps an override acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OverrideSteps {
    /// Steps of 2 % [001:3262-3265] [003:7434-7443].
    TwoPercent,
    /// Steps of 1 % [000:5583] [003:7434-7443], called continuous on the TNC 151/155.
    OnePercent,
    /// 0.01 % up to 2.5 %, 0.75 % above [000:5583].
    NonLinear,
}

/// Overrides: MP7620 (old MP74) [000:10512] [000:6527-6543] [001:3262-3265] [003:7434-7443].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverrideParameters {
    /// The feed override acts on rapid traverse by key in program run: bit 0.
    pub on_rapid_key: bool,
    /// The rapid key moves programs, too, whatever their feed: TNC 151/155 [001:465-469].
    pub rapid_key_in_programs: bool,
    /// It acts on rapid key with direction keys in manual operation: bit 2.
    pub on_manual_rapid: bool,
    /// Steps of the feed override.
    pub feed_steps: OverrideSteps,
    /// Steps of the spindle override.
    pub spindle_steps: OverrideSteps,
    /// Where the feed potentiometer is, in automatic operation and by hand: old MP66; else in the control.
    pub external: [bool; 2],
}

/// Return to the contour and block scan: MP7680 bits 1 to 5; old: neither [000:6785-6812].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestartParameters {
    /// Return to the contour works.
    pub return_to_contour: bool,
    /// The operator may begin within a program: MP7680 bit 2.
    pub block_scan: bool,
    /// The scan passes over programmed stops and M06.
    pub passes_stops: bool,
    /// The scan ignores dwell times.
    pub ignores_dwell: bool,
    /// The scan starts at the begin of the program, not at the cursor.
    pub from_start: bool,
    /// Where a tool change leaves the axes whose movement by the scan is calculated, machine coordinates, mm or
    /// degrees: MP7450, MP951 [000:6783-6832].
    pub tool_change: PerPlcAxis<Option<f64>>,
}

/// When and how a tool is handed to the PLC: MP7480 (old MP61, MP157) [000:9231-9283].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToolOutput {
    /// What is put out.
    pub what: ToolOutputKind,
    /// At every block, not only when the number changes.
    pub always: bool,
}

/// What of a tool is handed to the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolOutputKind {
    /// Nothing is handed over.
    None,
    /// The number of the tool.
    Tool,
    /// Pocket and tool; the tool returns to any pocket.
    Pocket,
    /// Pocket and tool; the tool returns to its own pocket, the pocket table does not change.
    FixedPocket,
}

/// Tool table, magazine and tool output to the PLC [000:8994-9283].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolParameters {
    /// Lines of the tool table, 0 without one: MP7260 (old MP225) [000:9103-9111].
    pub table_size: u32,
    /// Pockets of the magazine, 0 without pocket table: MP7261 (old MP225, the same) [000:9103-9111].
    pub pockets: u32,
    /// Pockets kept free on each side of a special tool: MP7264, dropped later; 0 without it
    /// [000:9162-9164].
    pub reserved_pockets: u8,
    /// TOOL CALL: MP7480.0 (old MP61).
    pub call: ToolOutput,
    /// TOOL DEF: MP7480.1 (old MP157).
    pub definition: ToolOutput,
    /// The probe that measures tools.
    pub probe: ToolProbeParameters,
}

/// Datums and traverse ranges: MP7490, MP7295, MP7296, MP7475 [000:3499-3508].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DatumParameters {
    /// Traverse ranges that the MOD function sets: 3 or 1; old: 1.
    pub ranges: u8,
    /// Each traverse range has a datum of its own; old: no.
    pub datum_for_each_range: bool,
    /// The datum is set with the soft key only, not with the axis keys: MP7296 = 1 [000:6277-6285].
    pub soft_key_only: bool,
    /// Datum tables count from the machine datum, not from the workpiece datum: MP7475 = 1
    /// [000:6900-6902].
    pub table_from_machine: bool,
}

/// The handwheel and its inputs [000:8060-8446].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandwheelParameters {
    /// Which one: MP7640 (old MP171) [000:8096-8106] [001:2208-2226].
    pub kind: Handwheel,
    /// The interpolation factor comes from module 9036, not from the panel: MP7641 = 1.
    pub factor_from_plc: bool,
    /// Initialization: MP7645.0 to .7; their meaning depends on the handwheel [000:8112-8351].
    pub initialization: [u8; 8],
    /// Where turning right moves: MP7650 = 1 plus; old: plus [000:8117].
    pub direction: Direction,
    /// Increments below which a movement is a vibration: MP7660 (old MP247) [000:8122].
    pub threshold: u16,
    /// Least interpolation factor, 0 to 10; slow, medium, fast with the HR 410: MP7670
    /// [000:8125-8132].
    pub factor_min: [u8; 3],
    /// Feed of the direction keys of the HR 410, slow, medium, fast, % of the manual feed: MP7671
    /// [000:8300-8304].
    pub jog_percent: [f64; 3],
}

/// The handwheels that can be connected, by the number of MP7640.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handwheel {
    /// MP7640 = 0: there is no handwheel.
    None,
    /// MP7640 = 1: HR 330, all keys to the NC.
    Hr330,
    /// 2: HR 130 or HR 330; old: HR 150 or HR 250.
    Hr130,
    /// 3: HR 330, direction and rapid keys to the PLC.
    Hr330Plc,
    /// 4: HR 332, keys to the PLC.
    Hr332,
    /// 5: up to three HR 150 with HRA 110.
    Hra110,
    /// MP7640 = 6: HR 410.
    Hr410,
    /// HE 310, two axes at once; TNC 151/155 only.
    He310,
}

/// A parameter that the operator may change under USER PARAMETERS: MP7330 and MP7340
/// [000:6907-6926]; TNC 151/155: by the letter P in the list [001:1299-1334].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UserParameter {
    /// The parameter that may be changed.
    pub id: ParameterId,
    /// What names it.
    pub text: UserText,
}

/// What names a parameter that the operator may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UserText {
    /// A line of the PLC dialogue file: MP7340.
    Dialogue(u16),
    /// The text of a PLC error message, TNC 151/155: 99 of the first parameter down to 84 of the 16th; without one
    /// `USER PAR.` with the place [001:1315-1332].
    PlcError {
        /// Number of the error message.
        number: u16,
        /// Its place among the user parameters, from 1.
        place: u16,
    },
}

impl ParameterList {
    /// The settings of the operating modes.
    pub fn operation_parameters(&self) -> OperationParameters {
        let old = self.has_old_numbers();
        // Tests are on unless their bit is set; the bits stand elsewhere in the old list.
        let test = |bit: u32| !self.bit((7690, 0), (92, 0), if old { bit + 2 } else { bit });
        let multi = |bit| bit_of(self.get_new(7680, 0).unwrap_or_default(), bit);
        let is_one = |number| self.get_new(number, 0) == Some(1.0);
        let english = if old { self.old_bit(92, 1) } else { is_one(7230) };
        OperationParameters {
            station: match self.value((7210, 0), (170, 0)) as u8 {
                0 => Station::Machine,
                1 => Station::WithPlc,
                _ => Station::WithoutPlc,
            },
            moves_without_machine: old && self.old(170) != 0.0,
            power_interrupted: !is_one(7212),
            english,
            ram_test: test(0),
            eprom_test: test(1),
            keys_latched: if old { self.old(68) == 1.0 } else { multi(0) },
            marks_by_code: old,
            axes_wait_at_m: self.m_functions().axes_wait,
            manual_feed_shown: self.bit((7270, 0), (167, 0), 0),
            stop_ends_m: self.model() == ControlModel::Tnc360
                && self.get(7270, 0).is_some_and(|sum| sum >= 2.0),
            overrides: self.override_parameters(),
            restart: RestartParameters {
                return_to_contour: multi(1),
                block_scan: multi(2),
                passes_stops: multi(3),
                ignores_dwell: multi(4),
                from_start: multi(5),
                tool_change: PerPlcAxis::from_fn(|axis| {
                    let calculated = bit_of(self.get_new(7450, 0).unwrap_or_default(), axis.into());
                    self.get_new(951, axis).filter(|_| calculated)
                }),
            },
            tools: self.tool_parameters(),
            datums: self.datum_parameters(),
            handwheel: self.handwheel_parameters(),
            tool_length_shown: is_one(7285),
            speed_shown_at_rest: !old || self.old(191) == 1.0,
            spindle_display: self.spindle_display(),
            file_name_max: match self.get_new(7222, 0) {
                Some(0.0) => 8,
                Some(1.0) => 12,
                _ => u8::MAX,
            }
            .min(self.model().limits().program_name_max),
            tilting: is_one(7500),
            normal_length_with_dr2: multi(6),
            oem_cycles: self.oem_cycle_parameters(english),
            iso_step: self.get_new(7220, 0).map_or(1, |step| step as u8),
            iso_programs: old.then(|| self.old(217) == 1.0),
        }
    }

    fn oem_cycle_parameters(&self, english: bool) -> OemCycleParameters {
        if self.has_old_numbers() {
            return OemCycleParameters {
                names_free: true,
                definition_offset: self.old(263) as u8,
                global_parameters: 100,
                text_offset: if english { self.old(259) as u8 } else { 0 },
            };
        }
        OemCycleParameters {
            names_free: self.get_new(7240, 0) == Some(1.0),
            definition_offset: self.get_new(7250, 0).unwrap_or_default() as u8,
            global_parameters: self.get_new(7251, 0).unwrap_or_default() as u8,
            text_offset: 0,
        }
    }

    /// The parameters that the operator may change under USER PARAMETERS; an entry of 0 is none. MP7330
    /// holds the number with a two-digit index: 5030.01 is MP5030.1 [000:6911-6919].
    pub fn user_parameters(&self) -> Vec<UserParameter> {
        if self.has_old_numbers() {
            let of = |(place, id): (u16, &ParameterId)| UserParameter {
                id: *id,
                text: UserText::PlcError {
                    number: 100 - place,
                    place,
                },
            };
            return (1..).zip(self.given()).map(of).collect();
        }
        let entry = |place: u8| {
            let hundredths = (self.get_new(7330, place)? * 100.0).round() as u32;
            let (number, index) = ((hundredths / 100) as u16, (hundredths % 100) as u8);
            Some(UserParameter {
                id: crate::Definition::find(self.model(), number, index)?.id,
                text: UserText::Dialogue(self.get(7340, place)? as u16),
            })
        };
        (0..16).filter_map(entry).collect()
    }

    fn override_parameters(&self) -> OverrideParameters {
        let value = self.value((7620, 0), (74, 0));
        let continuous = |bit| {
            if bit_of(value, bit) {
                OverrideSteps::OnePercent
            } else {
                OverrideSteps::TwoPercent
            }
        };
        let [feed_steps, spindle_steps] = match self.model().family() {
            ControlModel::Tnc151 | ControlModel::Tnc155 => [continuous(1), continuous(3)],
            ControlModel::Tnc360 => [continuous(1); 2],
            _ if bit_of(value, 3) => [OverrideSteps::NonLinear; 2],
            _ => [OverrideSteps::OnePercent; 2],
        };
        OverrideParameters {
            on_rapid_key: bit_of(value, 0),
            rapid_key_in_programs: self.has_old_numbers(),
            on_manual_rapid: bit_of(value, 2),
            external: match self.old(66) as u8 {
                0 => [false; 2],
                1 => [true; 2],
                _ => [false, true],
            },
            feed_steps,
            spindle_steps,
        }
    }

    fn spindle_display(&self) -> SpindleDisplay {
        match self.old(237) as u8 {
            2 => SpindleDisplay::AsFourth('V'),
            3 => SpindleDisplay::AsFourth('A'),
            4 => SpindleDisplay::AsFourth('B'),
            5 => SpindleDisplay::AsFourth('C'),
            _ if bit_of(self.get_new(40, 0).unwrap_or_default(), 5) => SpindleDisplay::Standing,
            _ => SpindleDisplay::None,
        }
    }

    fn tool_parameters(&self) -> ToolParameters {
        // Without a central tool memory there are no pockets to put out [001:1605-1607].
        let without_pockets = self.has_old_numbers() && self.old(225) == 0.0;
        let put_out = |value: f64| match tool_output(value) {
            output if without_pockets && output.what == ToolOutputKind::Pocket => tool_output(0.0),
            output => output,
        };
        ToolParameters {
            table_size: self.tool_table_size(),
            pockets: self.value((7261, 0), (225, 0)) as u32,
            reserved_pockets: self.get_new(7264, 0).unwrap_or_default() as u8,
            call: put_out(self.value((7480, 0), (61, 0))),
            definition: put_out(self.value((7480, 1), (157, 0))),
            probe: self.tool_probe(),
        }
    }

    fn datum_parameters(&self) -> DatumParameters {
        // The TNC 151/155 have one range and one datum, as value 2 says.
        let kind = self.get_new(7490, 0).unwrap_or(2.0) as u8;
        DatumParameters {
            ranges: if matches!(kind, 1 | 3) { 3 } else { 1 },
            datum_for_each_range: kind < 2,
            soft_key_only: self.get_new(7296, 0) == Some(1.0),
            table_from_machine: self.get_new(7475, 0) == Some(1.0),
        }
    }

    fn handwheel_parameters(&self) -> HandwheelParameters {
        const KINDS: [Handwheel; 7] = [
            Handwheel::None,
            Handwheel::Hr330,
            Handwheel::Hr130,
            Handwheel::Hr330Plc,
            Handwheel::Hr332,
            Handwheel::Hra110,
            Handwheel::Hr410,
        ];
        let old = self.has_old_numbers();
        let value = |number, index| self.get_new(number, index).unwrap_or_default();
        let kind = match self.old(171) as u8 {
            _ if !old => KINDS
                .get(value(7640, 0) as usize)
                .copied()
                .unwrap_or(Handwheel::None),
            1 | 3 => Handwheel::He310,
            _ => Handwheel::Hr130,
        };
        HandwheelParameters {
            kind,
            factor_from_plc: value(7641, 0) == 1.0,
            initialization: [0, 1, 2, 3, 4, 5, 6, 7].map(|index| value(7645, index) as u8),
            direction: Direction::minus_if(!old && value(7650, 0) != 1.0),
            threshold: self.value((7660, 0), (247, 0)) as u16,
            factor_min: [0, 1, 2].map(|index| value(7670, index) as u8),
            jog_percent: [0, 1, 2].map(|index| value(7671, index)),
        }
    }
}

/// MP7480, and MP61 and MP157, which end at 3.
fn tool_output(value: f64) -> ToolOutput {
    let (what, always) = match value as u8 {
        1 => (ToolOutputKind::Tool, false),
        2 => (ToolOutputKind::Tool, true),
        3 => (ToolOutputKind::Pocket, false),
        4 => (ToolOutputKind::Pocket, true),
        5 => (ToolOutputKind::FixedPocket, false),
        6 => (ToolOutputKind::FixedPocket, true),
        _ => (ToolOutputKind::None, false),
    };
    ToolOutput { what, always }
}
