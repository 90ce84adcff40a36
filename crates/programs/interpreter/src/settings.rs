//! What a run is set up with: control model, machine parameters, tools, options.
//!
//! Decision: A machine parameter of digitizing that is 0 has the value with which optimizing begins

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_parameters::equipment::Equipment;
use bahn_parameters::machining::ScaledAxes;
use bahn_parameters::own_functions::OwnFunctions;
use bahn_parameters::spindle::{Characteristics, FreeOutput, SpindleParameters};
use bahn_parameters::technology::AxisHalts;
use bahn_parameters::{ControlModel, InchFeed, ParameterList};
use bahn_path::{Axis, MeasuringRules, PerAxis, Plane, Position, ScanRules, Swivels, ToolShape};
use bahn_reader::MachineRules;

use crate::absent::AbsentAxes;
use crate::status::Status;

/// Everything a run depends on beside the program.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Control model whose limits, texts and rules apply.
    pub model: ControlModel,
    /// Rules set by machine parameters.
    pub rules: Rules,
    /// Tool table; `None` when tools are defined in the programs [003:1803-1806].
    pub tools: Option<ToolTable>,
    /// Angles of the points of drills that the programs define, degrees, by tool number: TOOL DEF has none.
    pub point_angles_deg: BTreeMap<u32, f64>,
    /// Tools of the table that must not be called.
    pub barred_tools: BTreeMap<u32, ToolState>,
    /// Cycles of the machine builder in the EPROM that the PLC inhibits: bit n is cycle 68 + n [000:17812-17821].
    pub inhibited_oem_cycles: u32,
    /// The datum table of `CYCL DEF 7.1 #n`, or why there is none.
    pub datum_table: Result<Arc<DatumTable>, String>,
    /// The M functions that the machine builder synchronises otherwise than the model.
    pub functions: OwnFunctions,
    /// Texts of the machine for FN14 and FN15.
    pub texts: MachineTexts,
    /// Q parameters set before the start: number, value.
    pub q_values: Vec<(u16, f64)>,
    /// Where the axes stand before the start, mm and degrees; axes without a position stay unknown.
    pub start: Position,
    /// Length of the tool that is in the spindle before the start, mm. `None` when nobody knows: the first
    /// TOOL CALL then leaves the position as it is.
    pub tool_length_mm: Option<f64>,
    /// What the run before has left in force.
    pub status: Status,
    /// Basic rotation of the workpiece about its datum [003:1282-1304].
    pub basic_rotation: BasicRotation,
    /// Where the tip stands after the change to another tool, workpiece coordinates, mm; axes that are not
    /// given stay where they are, the tool axis at least on the upper face of the blank. On a machine the
    /// axes stand where they stand.
    pub tool_change: Position,
    /// Pass over blocks with `/`.
    pub skip_blocks: bool,
    /// What F counts in a program in inches; `None` for what it counts on the model.
    pub inch_feed: Option<InchFeed>,
    /// Refuse what is otherwise accepted with a warning (sign of cycle parameters, tools without data).
    pub strict: bool,
    /// Pass over words and blocks that nothing here knows, and functions without which the control would move
    /// differently, each with a warning, instead of refusing them.
    pub skip_unknown: bool,
    /// Axes that the machine does not have for programs. A control that runs one on a machine knows that itself.
    pub absent: AbsentAxes,
    /// Compensated blocks lead along the contour they name, as if the tool had no radius: a program is drawn, not
    /// tested. What a cycle makes is the path of the tool all the same.
    pub as_programmed: bool,
    /// A control runs the program on a machine: it waits for the PLC, which may write what the next block
    /// reads, and probing movements are executed outside.
    pub machine: bool,
    /// The main program is transferred while it runs, and its executed blocks are erased: labels stand ahead only
    /// [003:1661-1674].
    pub transferred: bool,
    /// Blocks that may be executed without a movement before the run is taken for an endless loop.
    pub max_blocks_without_motion: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            model: ControlModel::default(),
            rules: Rules::default(),
            tools: None,
            point_angles_deg: BTreeMap::new(),
            barred_tools: BTreeMap::new(),
            inhibited_oem_cycles: 0,
            datum_table: Err(NO_DATUM_TABLE.to_owned()),
            functions: OwnFunctions::default(),
            texts: MachineTexts::default(),
            q_values: Vec::new(),
            start: Position::UNKNOWN,
            tool_length_mm: None,
            status: Status::default(),
            basic_rotation: BasicRotation::default(),
            tool_change: Position::UNKNOWN,
            skip_blocks: false,
            inch_feed: None,
            strict: false,
            skip_unknown: false,
            absent: AbsentAxes::default(),
            as_programmed: false,
            machine: false,
            transferred: false,
            max_blocks_without_motion: 10_000_000,
        }
    }
}

/// Why a tool of the table must not be called [000:9135-9137] [000:9168-9172].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToolState {
    /// It may be called.
    #[default]
    Usable,
    /// Column TL: it is locked.
    Locked,
    /// CUR.TIME is greater than TIME2, and no replacement tool is named.
    Expired,
    /// CUR.TIME is greater than TIME2: the control takes this replacement tool, that of column RT.
    Replaced(u32),
}

impl Settings {
    /// What F counts in a program in inches.
    pub fn inch_feed(&self) -> InchFeed {
        self.inch_feed.unwrap_or(self.model.limits().inch_feed)
    }
}

/// The texts that belong to the machine: those of its PLC program.
#[derive(Clone, Debug, Default)]
pub struct MachineTexts {
    /// PLC messages 0 to 99: FN14 300 to 399.
    pub messages: Arc<[String]>,
    /// PLC dialogues 0 to 83: FN14 400 to 483.
    pub dialogues: Arc<[String]>,
}

impl MachineTexts {
    /// The text of a number of FN14 [003:4352-4367]: that of the machine, or where it has none that of the
    /// control. `None` for a number that does not exist.
    pub fn text(&self, number: u16, model: ControlModel) -> Option<String> {
        let of_the_machine = match number {
            300..=399 => self.messages.get(usize::from(number - 300)),
            400..=483 => self.dialogues.get(usize::from(number - 400)),
            _ => None,
        };
        let given = of_the_machine.filter(|text| !text.is_empty()).cloned();
        given.or_else(|| bahn_parameters::error_text(number, model))
    }
}

/// How a workpiece lies that is not aligned: the control turns the programs with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasicRotation {
    /// Degrees, counter-clockwise positive; 0 for none.
    pub angle_deg: f64,
    /// The working plane in which it was measured.
    pub plane: Plane,
}

impl Default for BasicRotation {
    fn default() -> BasicRotation {
        BasicRotation {
            angle_deg: 0.0,
            plane: Plane::XY,
        }
    }
}

/// Why there is no datum table where nobody has selected one.
pub const NO_DATUM_TABLE: &str = "no datum table is selected (`datum_table` in machine.toml, or module 9090)";

/// Datums by their line, mm and degrees; axes without a position are not shifted.
pub type DatumTable = BTreeMap<i32, Position>;

/// Tools by their [`tool_key`].
pub type ToolTable = BTreeMap<u32, ToolShape>;

/// Key of a tool: its number; a tool with an index, 253.1 in the tables of later controls, stands far after.
pub const fn tool_key(number: u32, index: u8) -> u32 {
    const INDEX_SHIFT: u32 = 16;
    number | (index as u32) << INDEX_SHIFT
}

/// The machine parameters that change how a program runs.
#[derive(Clone, Debug)]
pub struct Rules {
    /// MP7431: tolerance between start and end radius of an arc, mm [000:7012-7014].
    pub arc_tolerance_mm: f64,
    /// MP7410: scaling acts in the working plane only [003:7357-7363].
    pub scaling_in_plane_only: bool,
    /// MP7411: the probe block keeps the tool data instead of taking the probe's [003:7365-7369].
    pub probe_keeps_tool: bool,
    /// MP7420: bits of the contour-pocket cycles [000:6739-6753].
    pub contour_pocket: ContourPocketRules,
    /// MP7430: stepover of pocket milling is this times the tool radius [003:7385-7394].
    pub overlap: f64,
    /// What they rule in programs of any language.
    pub machine: MachineRules,
    /// MP7440: bits of the M functions [000:7298-7305].
    pub m_functions: MFunctionRules,
    /// Override, dwell and spindle in cycles 2 and 17.
    pub tapping: TappingRules,
    /// Angle of M19 without cycle 13, degrees [000:5867].
    pub spindle_orientation_deg: f64,
    /// MP950: machine datum of M92 from machine zero, mm or degrees [000:6248-6258].
    pub machine_datum: Position,
    /// MP960: machine zero of M91 from the workpiece datum of the run, mm or degrees [000:6244]. An axis
    /// whose machine zero is not known leaves the workpiece with M91 and M92 and has no position then.
    pub machine_zero: Position,
    /// MP920 and MP910: the least and greatest machine positions of traverse range 1, mm or degrees.
    pub traverse: [Position; 2],
    /// MP7475 = 1: datum tables count from the machine datum, not from the workpiece datum [000:6900-6902].
    pub datums_from_machine: bool,
    /// MP1060: acceleration of each axis, m/s²: limits the rounding arcs of M112 [000:5140-5152].
    pub acceleration_m_s2: PerAxis<f64>,
    /// MP1070: radial acceleration, m/s².
    pub radial_acceleration_m_s2: f64,
    /// Touch probe: feeds, distances and calibration.
    pub probe: ProbeRules,
    /// Digitizing: MP6120 to MP6270.
    pub scan: ScanRules,
    /// MP7245: bit n inhibits cycle n [000:6655-6698].
    pub inhibited_cycles: u32,
    /// MP3011 = 3: M200 to M204 set output S, M202 by these characteristics [000:9841-9898].
    pub voltages: Option<Characteristics>,
    /// MP7246: paraxial positioning blocks are disabled [000:7022-7029].
    pub paraxial_inhibited: bool,
    /// MP7240, MP7250, MP7251: cycles of the machine builder.
    pub oem_cycles: OemCycleRules,
    /// Step of lengths in programs, mm, where it is coarser than that of the model: MP65 of a TNC 151/155 [001:1612-1614].
    pub input_step_mm: Option<f64>,
    /// Options and software of the control.
    pub equipment: Equipment,
    /// MP7680 bit 6: in LN blocks the length contains DR2 [000:9179-9192].
    pub normal_length_with_dr2: bool,
    /// MP7510 to MP7592: the swivel axes; `None` when there are none [000:4258-4301].
    pub swivels: Option<Arc<Swivels>>,
    /// MP7500: the working plane can be tilted [000:4273-4276].
    pub tilting: bool,
    /// MP810: the modulo values of rotary axes, degrees [000:6468-6484].
    pub modulo_deg: PerAxis<Option<f64>>,
    /// MP410.4: the 5th axis of the machine, which is never the tool axis [000:3410-3416].
    pub fifth_axis: Option<Axis>,
}

impl Rules {
    /// What a list of machine parameters says. Machine zero is that of the workpiece: the caller knows where
    /// the workpiece lies.
    pub fn of(list: &ParameterList) -> Rules {
        let pocket = list.contour_pocket();
        let m = list.m_functions();
        let tapping = list.tapping();
        let probe = list.probe();
        let spindle = list.spindle_parameters();
        Rules {
            arc_tolerance_mm: list.arc_tolerance_mm(),
            scaling_in_plane_only: list.scaled_axes() == ScaledAxes::WorkingPlane,
            probe_keeps_tool: probe.keeps_tool_data,
            contour_pocket: ContourPocketRules {
                channel_clockwise: pocket.pocket_clockwise,
                clear_first: pocket.clear_out_first,
                merge_programmed: pocket.merge_programmed,
                per_infeed: pocket.each_infeed,
                stay_at_clearance: pocket.end_at_clearance,
            },
            overlap: list.pocket_overlap(),
            machine: MachineRules::of(list),
            m_functions: MFunctionRules {
                m89_calls_cycle: m.m89_calls_cycle,
                m105_enabled: m.m105_works,
                m103_enabled: m.m103_works,
            },
            tapping: TappingRules {
                override_percent: tapping.override_percent,
                reversal_dwell_s: tapping.reversal_dwell_s,
                spindle: Some(spindle),
                orients: tapping.orientation,
            },
            datums_from_machine: list.operation_parameters().datums.table_from_machine,
            acceleration_m_s2: PerAxis::from_fn(|axis| list.acceleration_m_s2(axis)),
            radial_acceleration_m_s2: list.radial_acceleration_m_s2(),
            machine_datum: PerAxis::from_fn(|axis| list.m92_datum(axis)).into(),
            traverse: [0, 1].map(|end: usize| PerAxis::from_fn(|axis| list.traverse_range(axis)[end]).into()),
            probe: ProbeRules {
                feed_mm_min: probe.feed_mm_min,
                range_mm: probe.range_mm,
                clearance_mm: probe.clearance_mm,
                rapid_mm_min: probe.rapid_mm_min,
                ..ProbeRules::default()
            },
            scan: scan_rules(list),
            inhibited_cycles: (1..=31)
                .filter(|cycle| list.cycle_inhibited(*cycle))
                .fold(0, |bits, cycle| bits | 1 << cycle),
            voltages: match spindle.free_output {
                FreeOutput::MFunctions => Some(list.characteristics()),
                _ => None,
            },
            paraxial_inhibited: list.paraxial_inhibited(),
            normal_length_with_dr2: list.operation_parameters().normal_length_with_dr2,
            swivels: list.swivels().map(Arc::new),
            tilting: list.operation_parameters().tilting,
            modulo_deg: PerAxis::from_fn(|axis| {
                let index = list.axis_index(axis)?;
                list.axis_parameters(index).travel.modulo.map(|modulo| modulo.deg)
            }),
            fifth_axis: Axis::ALL
                .into_iter()
                .find(|axis| list.axis_index(*axis) == Some(4)),
            oem_cycles: OemCycleRules::of(list),
            equipment: list.equipment(),
            input_step_mm: list.input_step_mm(),
            ..Rules::default()
        }
    }
}

/// Digitizing; what the list leaves at 0 has the value with which optimizing begins (inferred) [000:7835-7839].
fn scan_rules(list: &ParameterList) -> ScanRules {
    let (probe, scan, initial) = (list.probe(), list.digitizing(), ScanRules::default());
    let measuring = list.measuring_probe();
    let or = |value: f64, initial: f64| if value > 0.0 { value } else { initial };
    ScanRules {
        probing_mm_min: measuring.map_or_else(
            || or(probe.feed_mm_min, initial.probing_mm_min),
            |probe| probe.approach_mm_min,
        ),
        rapid_mm_min: or(probe.rapid_mm_min, initial.rapid_mm_min),
        measuring: measuring.map(|probe| MeasuringRules {
            depth_mm: probe.depth_mm,
            reversed: probe.reversed,
            axes: probe.axes,
            limit_mm: probe.limit_mm,
            feed_mm_min: probe.feed_mm_min,
            slows: probe.slows,
            window_mm: probe.window_mm,
        }),
        oscillations_hz: or(scan.oscillations_hz, initial.oscillations_hz),
        lubrication_mm: scan.lubrication_mm,
        lubrication_min: scan.lubrication_min,
        normal_mm_min: or(scan.normal_mm_min, initial.normal_mm_min),
        deflection_mm: or(scan.deflection_mm, initial.deflection_mm),
        m90: scan.m90,
        step_mm: scan.step_mm,
    }
}

impl Default for Rules {
    fn default() -> Self {
        Rules {
            arc_tolerance_mm: 0.016,
            equipment: Equipment::default(),
            input_step_mm: None,
            scaling_in_plane_only: false,
            probe_keeps_tool: true,
            contour_pocket: ContourPocketRules::default(),
            overlap: 1.0,
            machine: MachineRules {
                halts: AxisHalts {
                    at_m_functions: true,
                    at_speeds: true,
                },
                m6_stops: true,
                speed_max_rpm: 99_999.0,
            },
            m_functions: MFunctionRules::default(),
            tapping: TappingRules::default(),
            spindle_orientation_deg: 0.0,
            machine_datum: Position::ZERO,
            machine_zero: Position::ZERO,
            datums_from_machine: false,
            acceleration_m_s2: PerAxis::splat(1.0),
            radial_acceleration_m_s2: 1.0,
            probe: ProbeRules::default(),
            scan: ScanRules::default(),
            inhibited_cycles: 0,
            voltages: None,
            paraxial_inhibited: false,
            normal_length_with_dr2: false,
            traverse: [f64::NEG_INFINITY, f64::INFINITY].map(|end| PerAxis::splat(end).into()),
            swivels: None,
            tilting: false,
            modulo_deg: PerAxis::splat(None),
            fifth_axis: None,
            oem_cycles: OemCycleRules::default(),
        }
    }
}

/// Cycles of the machine builder [000:17757-17810].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OemCycleRules {
    /// MP7240 = 1: programs in the memory may have their names, and go before those of the EPROM.
    pub names_free: bool,
    /// MP7250: by how much the Q parameters of DLG-DEF cycles lie above those of DLG-CALL cycles.
    pub definition_offset: u16,
    /// MP7251: how many Q parameters below Q100 a cycle shares with who calls it.
    pub global_parameters: u16,
}

impl OemCycleRules {
    fn of(list: &ParameterList) -> OemCycleRules {
        let cycles = list.operation_parameters().oem_cycles;
        OemCycleRules {
            names_free: cycles.names_free,
            definition_offset: cycles.definition_offset.into(),
            global_parameters: cycles.global_parameters.into(),
        }
    }
}

/// MP7420: how contour pockets are machined [000:6739-6753].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContourPocketRules {
    /// Bit 0: channel clockwise for pockets and counter-clockwise for islands.
    pub channel_clockwise: bool,
    /// Bit 1: clear out first, then mill the channel.
    pub clear_first: bool,
    /// Bit 2: merge programmed contours; otherwise merge the compensated paths.
    pub merge_programmed: bool,
    /// Bit 3: channel and clearing for each infeed; otherwise each to full depth.
    pub per_infeed: bool,
    /// Bit 4: stay at the clearance height instead of returning to the position before the call.
    pub stay_at_clearance: bool,
}

impl ContourPocketRules {
    /// From the value of MP7420.
    pub fn from_bits(bits: u32) -> Self {
        ContourPocketRules {
            channel_clockwise: bits & 1 != 0,
            clear_first: bits & 2 != 0,
            merge_programmed: bits & 4 != 0,
            per_infeed: bits & 8 != 0,
            stay_at_clearance: bits & 16 != 0,
        }
    }
}

/// MP7440: which M functions work in programs of a TNC [000:7298-7305].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MFunctionRules {
    /// Bit 1: M89 is the modal cycle call.
    pub m89_calls_cycle: bool,
    /// Bit 3: M105 and M106 choose the second and first set of kv [000:7251-7305].
    pub m105_enabled: bool,
    /// Bit 4: M103 reduces the plunging feed.
    pub m103_enabled: bool,
}

impl Default for MFunctionRules {
    fn default() -> Self {
        MFunctionRules {
            m89_calls_cycle: true,
            m105_enabled: true,
            m103_enabled: true,
        }
    }
}

impl MFunctionRules {
    /// From the value of MP7440.
    pub fn from_bits(bits: u32) -> Self {
        MFunctionRules {
            m89_calls_cycle: bits & 2 != 0,
            m105_enabled: bits & 8 != 0,
            m103_enabled: bits & 16 != 0,
        }
    }
}

/// What cycles 2 and 17 need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TappingRules {
    /// MP7110.0 and .1: band of the feed override in cycle 2, % [000:6094-6098].
    pub override_percent: [f64; 2],
    /// MP7120.0: dwell before the spindle reverses in cycle 2, s [000:6079].
    pub reversal_dwell_s: f64,
    /// The spindle, for the time at which cycle 2 switches it off; without it that is at the depth.
    pub spindle: Option<SpindleParameters>,
    /// MP7160 = 0: cycle 17 orients the spindle before tapping [000:6141].
    pub orients: bool,
}

impl Default for TappingRules {
    fn default() -> Self {
        TappingRules {
            override_percent: [100.0; 2],
            reversal_dwell_s: 0.0,
            spindle: None,
            orients: true,
        }
    }
}

/// Touch probe parameters [003:7246-7252].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeRules {
    /// MP6120: probing feed, mm/min.
    pub feed_mm_min: f64,
    /// MP6130: farthest travel to the first contact, mm.
    pub range_mm: f64,
    /// MP6140: clearance before the nominal point, mm.
    pub clearance_mm: f64,
    /// MP6150: rapid traverse in the probe cycle, mm/min.
    pub rapid_mm_min: f64,
    /// Calibrated effective radius of the stylus ball, mm.
    pub radius_mm: f64,
    /// Calibrated effective length of the probe, mm.
    pub length_mm: f64,
    /// Calibrated centre offset: the ball stands so far beside the spindle in the first and second axis of the
    /// plane, mm [000:7654].
    pub offset_mm: [f64; 2],
}

impl Default for ProbeRules {
    fn default() -> Self {
        ProbeRules {
            feed_mm_min: 100.0,
            range_mm: 20.0,
            clearance_mm: 2.0,
            rapid_mm_min: 2000.0,
            radius_mm: 2.0,
            length_mm: 0.0,
            offset_mm: [0.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]
    use super::*;
    use bahn_path::Axis;

    #[test]
    fn rules_follow_the_list() {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for assignment in [
            "7420=%01101",
            "7430=0.9",
            "7410=1",
            "7440=%00001",
            "7110.0=80",
            "950.2=-7",
        ] {
            list.assign(assignment).unwrap();
        }
        let rules = Rules::of(&list);
        assert_eq!(rules.contour_pocket, ContourPocketRules::from_bits(0b01101));
        assert_eq!(rules.m_functions, MFunctionRules::from_bits(0b00001));
        assert!(!rules.machine.m6_stops && rules.machine.halts.at_m_functions);
        assert_eq!(rules.overlap, 0.9);
        assert!(rules.scaling_in_plane_only);
        assert_eq!(rules.tapping.override_percent[0], 80.0);
        assert_eq!(rules.machine_datum[Axis::Z], -7.0);
    }
}
