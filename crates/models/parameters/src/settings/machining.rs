//! Settings of cycles, M functions, probing, tools, display and program end.

use super::bit_of;
use crate::{ControlModel, ParameterList};

/// How cycles 6, 14, 15, 16 machine contour pockets: MP7420 (old MP241) [000:6712-6749]
/// [001:1414-1439].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContourPocket {
    /// Bit 0: the channel runs clockwise in pockets and counter-clockwise around islands, not reverse.
    pub pocket_clockwise: bool,
    /// Bit 1: clear out first, then mill the channel, not reverse.
    pub clear_out_first: bool,
    /// Bit 2: merge contours that overlap as programmed, not only where tool-centre paths intersect.
    pub merge_programmed: bool,
    /// Bit 3: channel and clearing alternate at each infeed, instead of each going over all depths. The
    /// TNC 151/155 have no choice; over all depths (inferred).
    pub each_infeed: bool,
    /// Bit 4: the cycle ends at clearance height, not at the position before the call. The TNC 151/155/360
    /// have no choice; they end at clearance height [003:5497].
    pub end_at_clearance: bool,
}

/// What M functions do: MP7440 (old MP214) [000:7251-7305] [001:1650-1652].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MFunctions {
    /// M06 stops the program run.
    pub m6_stops: bool,
    /// M89 is the modal cycle call, not a free function at the start of the block.
    pub m89_calls_cycle: bool,
    /// The axes wait for the acknowledgement of an M function.
    pub axes_wait: bool,
    /// The axes wait when TOOL CALL gives a spindle speed only: MP3030 = 0 [000:5645-5651].
    pub axes_wait_for_speed: bool,
    /// M105 and M106 change to the second and first set of kv factors and reversal peaks: bit 3.
    pub m105_works: bool,
    /// M103 F reduces the feed of plunging: bit 4.
    pub m103_works: bool,
}

/// Which axes cycle 11 scales: MP7410 (old MP213) [000:6751-6757] [001:1649].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaledAxes {
    /// All three main axes.
    All,
    /// The working plane only.
    WorkingPlane,
}

/// What is cleared when a program is selected, and perhaps at its end: MP7300 (old MP173)
/// [000:6589-6601] [003:7337-7343] [001:1643-1646].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramEndClearing {
    /// Status: coordinate transformations and the like.
    pub status: bool,
    /// Q parameters, to 0.
    pub q_parameters: bool,
    /// Data of the last tool.
    pub tool: bool,
    /// Also at M02, M30 and END PGM, not only when a program is selected.
    pub at_program_end: bool,
}

/// Settings of the touch probe: MP6120, MP6130, MP6140, MP6150 (old MP215, MP216, MP235, MP251)
/// [003:7246-7252] [000:7634-7648] [001:2234-2252].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeSettings {
    /// Probing feed rate, mm/min.
    pub feed_mm_min: f64,
    /// Longest way to the contact, mm.
    pub range_mm: f64,
    /// Clearance before the point to probe, up to which the probe runs in rapid traverse, mm.
    pub clearance_mm: f64,
    /// Rapid traverse of probing, mm/min.
    pub rapid_mm_min: f64,
    /// The data of the last tool stay in use, the calibrated data of the probe do not replace them: MP7411
    /// [003:7365-7369]. TNC 151/155: replaced (inferred).
    pub keeps_tool_data: bool,
    /// The probe sends without a cable and is on standby between probings, a TS 511: MP6010 = 1 [000:7654]; old MP171 = 0 or
    /// 1, a TS 510 [001:2208-2221].
    pub on_standby: bool,
    /// How the spindle turns the probe by 180°: MP6160.
    pub turn: ProbeTurn,
    /// A measuring probe (MP6200 = 1) is turned by itself when its radius is calibrated, so that its centre offset is found,
    /// too: MP6321 = 0 [000:7654].
    pub turns_itself: bool,
}

/// How the probe is turned by 180° when its centre offset is calibrated: MP6160 [000:7654] [000:10311].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeTurn {
    /// Neither the control nor the PLC turns it.
    Off,
    /// The control orients the spindle.
    ByControl,
    /// The PLC orients it with this M function.
    ByPlc(u8),
}

/// Digitizing with a triggering probe: MP6200 to MP6270 [000:7734-7799].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DigitizingSettings {
    /// Oscillations of the stylus, 1/s: MP6210.
    pub oscillations_hz: f64,
    /// Traverse that lubricates the axis of the probe at the end of a line, mm: MP6220.
    pub lubrication_mm: f64,
    /// Time after which it is lubricated, min: MP6221.
    pub lubrication_min: f64,
    /// Feed in the normal direction, mm/min: MP6230.
    pub normal_mm_min: f64,
    /// How far the stylus may be deflected, mm: MP6240.
    pub deflection_mm: f64,
    /// M90 in every block: MP6260.
    pub m90: bool,
    /// Step of the coordinates, mm: MP6270.
    pub step_mm: f64,
    /// The probe is a measuring one, a TM 110: MP6200.
    pub measuring: bool,
}

/// A measuring probe, TM 110: MP6310 to MP6390 [000:7882-7958].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuringProbe {
    /// How far it is deflected while it scans, mm: MP6310.
    pub depth_mm: f64,
    /// Whether it counts against the machine axes X, Y, Z: MP6320.
    pub reversed: [bool; 3],
    /// Which of its axes belongs to the machine axes X, Y, Z, from 0: MP6322.
    pub axes: [usize; 3],
    /// How far it may be deflected, mm: MP6330.
    pub limit_mm: f64,
    /// To the MIN point and to the contour, mm/min: MP6350.
    pub approach_mm_min: f64,
    /// Probing feed, mm/min: MP6360.
    pub feed_mm_min: f64,
    /// Rapid traverse, mm/min: MP6361.
    pub rapid_mm_min: f64,
    /// The feed falls where the ball leaves its path: MP6362.
    pub slows: bool,
    /// Half of the side of the window in which a contour line ends, mm: MP6390.
    pub window_mm: f64,
}

/// Settings of the graphics: MP7310 (old MP236) [000:6368-6409] [001:1654].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GraphicsSettings {
    /// Three-plane view in third-angle projection (American), not first-angle.
    pub third_angle: bool,
    /// The working plane is drawn rotated by +90 degrees.
    pub plane_rotated: bool,
    /// A datum shift moves the blank.
    pub blank_follows_datum: bool,
    /// The three-plane view shows the cursor.
    pub cursor_shown: bool,
}

/// The decimal sign: MP7280 (old MP92 bit 0) [003:7317-7323] [001:1923].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// Numbers are shown as `0,5`.
    Comma,
    /// Numbers are shown as `0.5`.
    Point,
}

/// The coarser of both resolutions of a TNC 151/155, mm [001:1612-1614].
const FIVE_MICROMETRES_MM: f64 = 0.005;
/// Tolerance of controls that have no MP7431, mm [003:2801]; TNC 151/155 (inferred).
const ARC_TOLERANCE_MM: f64 = 0.016;

impl ParameterList {
    /// How contour pockets are machined.
    pub fn contour_pocket(&self) -> ContourPocket {
        let value = self.value((7420, 0), (241, 0));
        let bit3_and_4 = !self.has_old_numbers();
        let has_bit_4 = bit3_and_4 && self.model() != ControlModel::Tnc360;
        ContourPocket {
            pocket_clockwise: bit_of(value, 0),
            clear_out_first: bit_of(value, 1),
            merge_programmed: bit_of(value, 2),
            each_infeed: bit3_and_4 && bit_of(value, 3),
            end_at_clearance: !has_bit_4 || bit_of(value, 4),
        }
    }

    /// Overlap factor of pocket milling: MP7430 (old MP93); stepover = factor times tool radius
    /// [000:6701-6710] [001:1819-1824].
    pub fn pocket_overlap(&self) -> f64 {
        self.value((7430, 0), (93, 0))
    }

    /// Greatest difference of the radii at start and end of an arc, mm: MP7431 [000:7010-7014].
    pub fn arc_tolerance_mm(&self) -> f64 {
        self.get(7431, 0).unwrap_or(ARC_TOLERANCE_MM)
    }

    /// What M functions do.
    pub fn m_functions(&self) -> MFunctions {
        let (number, old) = ((7440, 0), (214, 0));
        let axes_wait_for_speed = if self.has_old_numbers() {
            !self.bit(number, old, 2)
        } else {
            self.get(3030, 0) == Some(0.0)
        };
        let wait_bit = if self.has_old_numbers() { 3 } else { 2 };
        MFunctions {
            m6_stops: !self.bit(number, old, 0),
            m89_calls_cycle: self.bit(number, old, 1),
            axes_wait: !self.bit(number, old, wait_bit),
            axes_wait_for_speed,
            m105_works: !self.has_old_numbers() && self.bit(number, old, 3),
            m103_works: !self.has_old_numbers() && self.bit(number, old, 4),
        }
    }

    /// Which axes cycle 11 scales.
    pub fn scaled_axes(&self) -> ScaledAxes {
        if self.value((7410, 0), (213, 0)) == 0.0 {
            ScaledAxes::All
        } else {
            ScaledAxes::WorkingPlane
        }
    }

    /// Whether the machine builder has inhibited a standard cycle: MP7245.0 bit n for cycles 1 to 15,
    /// MP7245.1 bit n for cycle 16 + n [000:6655-6699].
    pub fn cycle_inhibited(&self, cycle: u32) -> bool {
        let (index, bit) = match cycle {
            1..=15 => (0, cycle),
            16..=31 => (1, cycle - 16),
            _ => return false,
        };
        self.get(7245, index).is_some_and(|value| bit_of(value, bit))
    }

    /// Whether positioning blocks with R+ and R- are inhibited: MP7246 [000:7026-7028].
    pub fn paraxial_inhibited(&self) -> bool {
        self.get(7246, 0) == Some(1.0)
    }

    /// Tools in the central tool table, 0 without one: MP7260 (old MP225) [000:9103-9111] [003:7294-7301]
    /// [001:1600-1607].
    pub fn tool_table_size(&self) -> u32 {
        self.value((7260, 0), (225, 0)) as u32
    }

    /// What is cleared at program selection and program end. The TNC 360 clears status and Q parameters
    /// when a program is selected (inferred from [003:6199-6205]) and, with MP7300 bit 0, at its end; so
    /// does the TNC 151/155 with the status alone.
    pub fn program_end_clearing(&self) -> ProgramEndClearing {
        let value = self.value((7300, 0), (173, 0));
        let at_program_end = bit_of(value, 0);
        match self.model().family() {
            ControlModel::Tnc151 | ControlModel::Tnc155 => ProgramEndClearing {
                status: true,
                q_parameters: false,
                tool: false,
                at_program_end,
            },
            ControlModel::Tnc360 => ProgramEndClearing {
                status: true,
                q_parameters: true,
                tool: false,
                at_program_end,
            },
            _ => ProgramEndClearing {
                status: true,
                q_parameters: matches!(value as u8, 0 | 1 | 4 | 5),
                tool: value < 4.0,
                at_program_end,
            },
        }
    }

    /// Settings of the touch probe.
    pub fn probe(&self) -> ProbeSettings {
        // A measuring probe has feeds of its own [000:7640].
        let measuring = self.measuring_probe();
        ProbeSettings {
            feed_mm_min: measuring.map_or_else(|| self.value((6120, 0), (215, 0)), |of| of.feed_mm_min),
            range_mm: self.value((6130, 0), (216, 0)),
            clearance_mm: self.value((6140, 0), (235, 0)),
            rapid_mm_min: measuring.map_or_else(|| self.value((6150, 0), (251, 0)), |of| of.rapid_mm_min),
            keeps_tool_data: self.get(7411, 0) == Some(1.0),
            on_standby: match self.has_old_numbers() {
                true => self.old(171) < 2.0,
                false => self.get_new(6010, 0) == Some(1.0),
            },
            turn: match self.get_new(6160, 0) {
                Some(-1.0) => ProbeTurn::ByControl,
                Some(code) if code >= 1.0 => ProbeTurn::ByPlc(code as u8),
                _ => ProbeTurn::Off,
            },
            turns_itself: measuring.is_some() && self.get_new(6321, 0) != Some(1.0),
        }
    }

    /// How surfaces are digitized with a triggering probe.
    pub fn digitizing(&self) -> DigitizingSettings {
        DigitizingSettings {
            oscillations_hz: self.get_new(6210, 0).unwrap_or(0.0),
            lubrication_mm: self.get_new(6220, 0).unwrap_or(0.0),
            lubrication_min: self.get_new(6221, 0).unwrap_or(0.0),
            normal_mm_min: self.get_new(6230, 0).unwrap_or(0.0),
            deflection_mm: self.get_new(6240, 0).unwrap_or(0.0),
            m90: self.get_new(6260, 0) == Some(1.0),
            step_mm: match self.get_new(6270, 0) {
                Some(1.0) => 0.01,
                Some(2.0) => 0.0001,
                _ => 0.001,
            },
            measuring: self.get_new(6200, 0) == Some(1.0),
        }
    }

    /// The measuring probe; `None` for a triggering one (MP6200 = 0). What the list leaves at 0 has the least value that
    /// may be entered, the depth 1 mm, which is usual; MP6322 that is 0 for all axes leaves each its own (inferred)
    /// [000:7907-7958].
    pub fn measuring_probe(&self) -> Option<MeasuringProbe> {
        if self.get_new(6200, 0) != Some(1.0) {
            return None;
        }
        let or = |number, otherwise: f64| {
            let value = self.get_new(number, 0).unwrap_or(0.0);
            if value > 0.0 { value } else { otherwise }
        };
        let reversed = self.get_new(6320, 0).unwrap_or(0.0) as u32;
        let axes = [0, 1, 2].map(|index| self.get_new(6322, index).unwrap_or(0.0) as usize);
        Some(MeasuringProbe {
            depth_mm: or(6310, 1.0),
            reversed: [0, 1, 2].map(|bit| reversed >> bit & 1 == 1),
            axes: if axes == [0; 3] { [0, 1, 2] } else { axes },
            limit_mm: or(6330, 4.0),
            approach_mm_min: or(6350, 10.0),
            feed_mm_min: or(6360, 10.0),
            rapid_mm_min: or(6361, 10.0),
            slows: self.get_new(6362, 0) == Some(1.0),
            window_mm: or(6390, 0.1),
        })
    }

    /// Settings of the graphics. Blank and cursor settings are those of the TNC 407/415/425; elsewhere the
    /// blank stays and the cursor is hidden (inferred).
    pub fn graphics(&self) -> GraphicsSettings {
        let (number, old) = ((7310, 0), (236, 0));
        let bits_2_and_3 = self.model() >= ControlModel::Tnc407;
        GraphicsSettings {
            third_angle: self.bit(number, old, 0),
            plane_rotated: self.bit(number, old, 1),
            blank_follows_datum: bits_2_and_3 && self.bit(number, old, 2),
            cursor_shown: bits_2_and_3 && self.bit(number, old, 3),
        }
    }

    /// The step of lengths that are entered or stand in programs, mm, where it is coarser than that of the model: old
    /// MP65 = 1 [001:1612-1614].
    pub fn input_step_mm(&self) -> Option<f64> {
        (self.old(65) == 1.0).then_some(FIVE_MICROMETRES_MM)
    }

    /// The decimal sign that listings show; both are read.
    pub fn decimal(&self) -> Decimal {
        if self.bit((7280, 0), (92, 0), 0) {
            Decimal::Point
        } else {
            Decimal::Comma
        }
    }
}
