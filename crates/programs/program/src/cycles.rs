//! The table of cycles and probe functions: what stands in which block of them. Reading, writing, checking and
//! executing derive from it what they have to know of one.

use crate::assigned_parameters;
use CycleFunction::{Definition, Probe};
use Sign::{NotNegative, PlusOmitted, Signed, Unsigned, Working};

/// Cycles from this number on are written in one block with `Qn=value` words; blocks of later controls.
pub(crate) const FIRST_PARAMETER_CYCLE: u16 = 200;

/// Whether `Qn=value` words may stand in block n.0, after the name; the cycles that the table gives assignments have
/// them in as many blocks as are written.
pub(crate) fn takes_assignments(number: u16) -> bool {
    number >= FIRST_PARAMETER_CYCLE || !assigned_parameters(number).is_empty()
}

/// Which blocks a cycle is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleFunction {
    /// Cycles, in blocks `CYCL DEF n.m`.
    Definition,
    /// Probe functions, in blocks `TCH PROBE n.m`.
    Probe,
}

/// What a parameter is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A length, program units.
    Length,
    /// Coordinates, program units or degrees.
    Coordinates,
    /// An axis with the length along it, program units.
    Side,
    /// A datum shift: coordinates only, or the line of a datum table after `#`.
    Shift,
    /// Letters of axes, which may touch each other.
    Axes,
    /// Axes with their directions.
    Directions,
    /// A dwell time, s.
    Dwell,
    /// A time, ms.
    Milliseconds,
    /// Degrees of a rotation.
    Rotation,
    /// An angle, degrees.
    Angle,
    /// Degrees of the spindle.
    Orientation,
    /// The factor of a scaling, without unit.
    Factor,
    /// Factors of single axes, and a centre after `CC`, program units.
    AxisFactors,
    /// Feed, mm/min or what F counts in inches.
    Feed,
    /// Sense of rotation, `DR+` or `DR-`.
    Turn,
    /// A choice, 0 or 1.
    Choice,
    /// The Q parameter that takes a result.
    Target,
    /// Numbers of labels, `1/2/3`.
    Labels,
    /// The name of a program.
    Program,
}

impl Quantity {
    /// Whether it is written as a number without an address.
    pub fn is_number(self) -> bool {
        use Quantity::{Angle, Choice, Dwell, Factor, Length, Milliseconds, Orientation, Rotation};
        matches!(
            self,
            Length | Dwell | Milliseconds | Rotation | Angle | Orientation | Factor | Choice
        )
    }
}

/// The sign of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Any, and it is always printed.
    Signed,
    /// The sign of the working direction, the same for all such parameters of a cycle [003:4902].
    Working,
    /// `+` alone, and it is printed.
    NotNegative,
    /// None; `+` is not printed.
    Unsigned,
    /// Any; `+` is not printed.
    PlusOmitted,
}

impl Sign {
    /// Whether `+` is printed before a number.
    pub(crate) fn prints_plus(self) -> bool {
        !matches!(self, Sign::Unsigned | Sign::PlusOmitted)
    }

    /// Whether a number may be negative.
    pub fn may_be_negative(self) -> bool {
        !matches!(self, Sign::NotNegative | Sign::Unsigned)
    }
}

/// A parameter of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CycleParameter {
    /// The word before it in listings of the TNC 360, which also names it in dialogues.
    pub name: &'static str,
    /// What it is given in.
    pub quantity: Quantity,
    /// Which signs it may have, and whether `+` is printed.
    pub sign: Sign,
    /// Whether the block may stand without it.
    pub optional: bool,
}

/// A cycle or probe function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// What opens its blocks.
    pub function: CycleFunction,
    /// Its number n, which all its blocks n.m have.
    pub number: u16,
    /// Its name, as block n.0 shows it.
    pub name: &'static str,
    /// Whether it acts when it is defined instead of when it is called [003:4849-4857].
    pub acts_at_definition: bool,
    /// The parameters of the blocks n.1, n.2, ...; none where they are not known here.
    pub blocks: &'static [&'static [CycleParameter]],
}

impl Cycle {
    /// The parameters of a block n.1, n.2, ...; blocks after the last one repeat it.
    pub fn block(&self, sub: u16) -> &'static [CycleParameter] {
        let index = usize::from(sub).checked_sub(1);
        let block = index.and_then(|index| self.blocks.get(index).or(self.blocks.last()));
        block.copied().unwrap_or_default()
    }

    /// Number of the last block that the cycle needs; `None` where its blocks are not known here.
    pub fn last_block(&self) -> Option<u16> {
        (!self.blocks.is_empty()).then_some(self.blocks.len() as u16)
    }
}

/// The cycle of a number.
///
/// ```
/// use bahn_program::{CycleFunction, cycle};
///
/// let pecking = cycle(CycleFunction::Definition, 1).unwrap();
/// let names: Vec<_> = pecking.blocks.iter().map(|block| block[0].name).collect();
/// assert_eq!(names, ["SET UP", "DEPTH", "PECKG", "DWELL", "F"]);
/// ```
pub fn cycle(function: CycleFunction, number: u16) -> Option<&'static Cycle> {
    CYCLES
        .iter()
        .find(|cycle| cycle.function == function && cycle.number == number)
}

/// The parameters of a block `number.sub`; none where they are not known here.
pub fn cycle_parameters(function: CycleFunction, number: u16, sub: u16) -> &'static [CycleParameter] {
    cycle(function, number).map_or(&[], |cycle| cycle.block(sub))
}

const fn parameter(name: &'static str, quantity: Quantity, sign: Sign) -> CycleParameter {
    CycleParameter {
        name,
        quantity,
        sign,
        optional: false,
    }
}

const SET_UP: CycleParameter = parameter("SET UP", Quantity::Length, Working);
const DEPTH: CycleParameter = parameter("DEPTH", Quantity::Length, Working);
const PECKG: CycleParameter = parameter("PECKG", Quantity::Length, Working);
const DWELL: CycleParameter = parameter("DWELL", Quantity::Dwell, Unsigned);
const FEED: CycleParameter = parameter("F", Quantity::Feed, Unsigned);
const SIDE: CycleParameter = parameter("", Quantity::Side, Signed);
/// Side of a pocket, whose length cannot be negative [003:5250].
const POCKET_SIDE: CycleParameter = parameter("", Quantity::Side, NotNegative);
const TURN: CycleParameter = optional(parameter("DR", Quantity::Turn, Signed));
/// Finishing allowance, which cannot be negative [003:5510].
const ALLOW: CycleParameter = parameter("ALLOW", Quantity::Length, NotNegative);
const RADIUS: CycleParameter = parameter("RADIUS", Quantity::Length, Unsigned);
const TRAVEL: CycleParameter = parameter("TRAVEL:", Quantity::Length, Unsigned);
/// From line to line in the positive direction [003:6667].
const SPACING: CycleParameter = parameter("L.SPAC:", Quantity::Length, Unsigned);
/// From contour line to contour line, up or down [003:6758-6761] [003:6802].
const SIGNED_SPACING: CycleParameter = CycleParameter {
    sign: PlusOmitted,
    ..SPACING
};
const INTERVAL: CycleParameter = parameter("P.P. INT:", Quantity::Length, Unsigned);
const HEIGHT: CycleParameter = parameter("HEIGHT:", Quantity::Length, Signed);
const CHECK: CycleParameter = parameter("CHECK:", Quantity::Choice, Unsigned);
const TEETH: CycleParameter = parameter("PROBING THE TEETH:", Quantity::Choice, Unsigned);
const RESULT: CycleParameter = optional(parameter("", Quantity::Target, Unsigned));
const POINT: CycleParameter = parameter("", Quantity::Coordinates, Signed);

const fn optional(parameter: CycleParameter) -> CycleParameter {
    CycleParameter {
        optional: true,
        ..parameter
    }
}

const fn row(
    function: CycleFunction,
    number: u16,
    name: &'static str,
    acts_at_definition: bool,
    blocks: &'static [&'static [CycleParameter]],
) -> Cycle {
    Cycle {
        function,
        number,
        name,
        acts_at_definition,
        blocks,
    }
}

/// A cycle that acts at its call.
const fn called(number: u16, name: &'static str, blocks: &'static [&'static [CycleParameter]]) -> Cycle {
    row(Definition, number, name, false, blocks)
}

/// A cycle that acts at its definition.
const fn defined(number: u16, name: &'static str, blocks: &'static [&'static [CycleParameter]]) -> Cycle {
    row(Definition, number, name, true, blocks)
}

/// A row for a probe function, which no block calls.
const fn probe(number: u16, name: &'static str, blocks: &'static [&'static [CycleParameter]]) -> Cycle {
    row(Probe, number, name, false, blocks)
}

/// All cycles and probe functions, by what their blocks are made of.
#[rustfmt::skip]
pub const CYCLES: &[Cycle] = &[
    // [003:4929-4941] [003:4979-4983]
    called(1, "PECKING", &[&[SET_UP], &[DEPTH], &[PECKG], &[DWELL], &[FEED]]),
    // [003:5007-5016] [003:5057-5062]
    called(2, "TAPPING", &[&[SET_UP], &[DEPTH], &[DWELL], &[FEED]]),
    // [003:5134-5146] [003:5197-5202]
    called(3, "SLOT MILLING", &[&[SET_UP], &[DEPTH], &[PECKG, FEED], &[SIDE], &[SIDE], &[FEED]]),
    // [003:5234-5258] [003:5299-5304]
    called(4, "POCKET MILLING", &[
        &[SET_UP], &[DEPTH], &[PECKG, FEED], &[POCKET_SIDE], &[POCKET_SIDE],
        &[FEED, TURN, optional(RADIUS)],
    ]),
    // [003:5324-5336] [003:5377-5382]
    called(5, "CIRCULAR POCKET", &[&[SET_UP], &[DEPTH], &[PECKG, FEED], &[RADIUS], &[FEED, TURN]]),
    // [003:5503-5514] [003:5572-5575]
    called(6, "ROUGH-OUT", &[
        &[SET_UP, DEPTH], &[PECKG, FEED, ALLOW], &[parameter("ANGLE", Quantity::Angle, Signed), FEED],
    ]),
    // [003:6222]
    defined(7, "DATUM SHIFT", &[&[parameter("", Quantity::Shift, Signed)]]),
    // Without an axis it cancels the mirror image [003:6292-6294].
    defined(8, "MIRROR IMAGE", &[&[optional(parameter("", Quantity::Axes, Signed))]]),
    // [003:6462-6474]
    defined(9, "DWELL TIME", &[&[DWELL]]),
    // [003:6313-6333]
    defined(10, "ROTATION", &[&[parameter("ROT", Quantity::Rotation, Signed)]]),
    // [003:6385-6412]
    defined(11, "SCALING", &[&[parameter("SCL", Quantity::Factor, Unsigned)]]),
    // [003:6476-6490]
    called(12, "PGM CALL", &[&[parameter("PGM", Quantity::Program, Signed)]]),
    // [003:6500-6528]
    defined(13, "ORIENTATION", &[&[parameter("ANGLE", Quantity::Orientation, Unsigned)]]),
    // [003:5460-5470]
    defined(14, "CONTOUR GEOMETRY", &[&[parameter("CONTOUR LABEL", Quantity::Labels, Unsigned)]]),
    // [003:6001-6014] [003:6143-6148]
    called(15, "PILOT DRILLING", &[&[SET_UP, DEPTH], &[PECKG, FEED, ALLOW]]),
    // [003:6043-6066] [003:6167-6171]
    called(16, "CONTOUR MILLING", &[&[SET_UP, DEPTH], &[PECKG, FEED, TURN, FEED]]),
    // [003:5094-5099]
    called(17, "RIGID TAPPING", &[&[SET_UP], &[DEPTH], &[parameter("PITCH", Quantity::Length, Signed)]]),
    // [000:6143-6145]; words of later controls
    called(18, "THREAD CUTTING", &[&[DEPTH], &[parameter("PITCH", Quantity::Length, Signed)]]),
    // The positions of the swivel axes; without an axis it ends the tilting [000:4250-4254].
    defined(19, "WORKING PLANE", &[&[optional(POINT)]]),
    // [000:847] [000:652]; words of later controls
    defined(20, "CONTOUR DATA", &[]),
    called(21, "PILOT DRILLING", &[]),
    called(22, "ROUGH-OUT", &[]),
    called(23, "FLOOR FINISHING", &[]),
    called(24, "SIDE FINISHING", &[]),
    called(25, "CONTOUR TRAIN", &[]),
    // [000:6655-6699]
    defined(26, "AXIS-SPEC. SCALING", &[&[parameter("", Quantity::AxisFactors, Unsigned)]]),
    // [000:735] [000:6759-6763]; words of later controls
    called(27, "CYLINDER SURFACE", &[]),
    // [003:4414-4428]
    probe(0, "REF. PLANE", &[&[POINT]]),
    // [003:6617-6625]
    probe(5, "RANGE", &[
        &[parameter("PGM NAME:", Quantity::Program, Signed)],
        &[parameter("", Quantity::Axes, Signed), POINT],
        &[POINT],
        &[HEIGHT],
    ]),
    // [003:6690-6696] [000:7854]
    probe(6, "MEANDER", &[&[parameter("DIRECTN:", Quantity::Axes, Signed)], &[TRAVEL, SPACING, INTERVAL]]),
    // [003:6810-6818]
    probe(7, "CONTOUR LINES", &[
        &[parameter("TIME:", Quantity::Milliseconds, Unsigned), POINT],
        &[parameter("ORDER", Quantity::Directions, Signed)],
        &[TRAVEL, SIGNED_SPACING, INTERVAL],
    ]),
    // Tool measurement [000:7960-8058]; words of later controls
    probe(30, "TT CALIBRATION", &[&[HEIGHT]]),
    probe(31, "TOOL LENGTH", &[&[CHECK, RESULT], &[HEIGHT], &[TEETH]]),
    probe(32, "TOOL RADIUS", &[&[CHECK, RESULT], &[HEIGHT], &[TEETH]]),
];
