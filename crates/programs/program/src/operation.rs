//! The canonical operations that every part-program language lowers to.

use bahn_parameters::InchFeed;
use bahn_path::{Axis, AxisSet, Direction, PerAxis, Sense};

use crate::{BlockError, Modality};

/// One block of a part program.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Optional block (`/`): passed over when block skip is on.
    pub skip: bool,
    /// What the block does.
    pub operation: Operation,
    /// Text after `;`, without the semicolon and surrounding blanks.
    pub comment: Option<Box<str>>,
}

impl Block {
    /// A block to be overwritten.
    pub const EMPTY: Block = Block {
        skip: false,
        operation: Operation::Label(0),
        comment: None,
    };
}

/// What a block does. Blocks that cannot be read are [`Operation::Invalid`]: an error when executed,
/// not a refusal to load.
#[derive(Clone, Debug, PartialEq)]
pub enum Operation {
    /// `BEGIN PGM name MM|INCH` [003:2093-2101].
    Begin(Box<Header>),
    /// `END PGM name MM|INCH`.
    End(Box<Header>),
    /// `BLK FORM 0.1 axis X Y Z`: least corner, tool axis [003:2638].
    BlankMin(Coordinates, Option<Axis>),
    /// `BLK FORM 0.2 X Y Z`: greatest corner, absolute or incremental [003:2639].
    BlankMax(Coordinates),
    /// `TOOL DEF n [L R]`; without data it announces the next tool [003:1875] [003:1931].
    ToolDefinition {
        /// Number of the tool that is defined.
        tool: Value,
        /// Length compensation value, program units.
        length: Option<Value>,
        /// Tool radius, program units.
        radius: Option<Value>,
    },
    /// `TOOL CALL [n] [axis] [S]` [003:1929] [003:2188].
    ToolCall {
        /// Tool number; absent keeps the tool.
        tool: Option<Value>,
        /// Tool axis; absent keeps the axis.
        axis: Option<Axis>,
        /// Spindle speed, rpm; absent keeps the speed.
        speed: Option<Value>,
        /// Oversize in length DL, program units.
        delta_length: Option<Value>,
        /// Oversize in radius DR, program units.
        delta_radius: Option<Value>,
    },
    /// A positioning block: L, C, CR, CT, LP, CP, CTP or paraxial.
    Motion(Motion),
    /// `CC` circle centre or pole; without coordinates the last programmed position [003:2754].
    CircleCentre(Coordinates),
    /// `RND R F` [003:3042].
    Rounding {
        /// Rounding radius, program units.
        radius: Value,
        /// Feed of the rounding only.
        feed: Option<Value>,
    },
    /// Chamfer `L length` or `CHF length` [003:2685].
    Chamfer {
        /// Length cut off each side, program units.
        length: Value,
        /// Feed of the chamfer only (later controls).
        feed: Option<Value>,
    },
    /// `STOP [M]`: the run stops until NC START [003:2226].
    Stop(MFunctions),
    /// A block of M functions only (`M8`).
    Miscellaneous(MFunctions),
    /// `LBL n`; 0 ends a subprogram [003:3662-3670].
    Label(u16),
    /// `CALL LBL n [REP r/r]`; `repeats` is `None` for a subprogram call or an empty REP
    /// [003:3678] [003:3782] [003:4648].
    CallLabel {
        /// Label that begins the section.
        label: u16,
        /// How often the section is repeated.
        repeats: Option<Value>,
    },
    /// `CALL PGM name` [003:3898].
    CallProgram(Box<str>),
    /// FN 0-8 and 13: `target = a op b`; one-operand functions leave `b` at zero [003:4149-4276].
    Calculate {
        /// What is calculated of the operands.
        function: Calculation,
        /// Number of the Q parameter that takes the result.
        target: u16,
        /// First operand, before the operator.
        a: Value,
        /// Second operand, after the operator.
        b: Value,
    },
    /// FN 9-12: jump to a label if the condition holds [003:4301-4315].
    Jump {
        /// What must hold between the operands.
        condition: Condition,
        /// First operand, after `IF`.
        a: Value,
        /// Second operand, before `GOTO`.
        b: Value,
        /// Label to go to.
        label: u16,
    },
    /// FN 14: ERROR = number [003:4352-4362].
    ErrorNumber(Value),
    /// FN 15: PRINT, at most six items [003:4371-4385].
    Print(Box<[Value]>),
    /// FN 19: PLC = a [/ b] [003:4387-4395].
    Plc {
        /// First value for the PLC.
        a: Value,
        /// Second value, after `/`.
        b: Option<Value>,
    },
    /// `Q1 = formula` (TNC 415) [000:744].
    Formula {
        /// Number of the Q parameter that takes the result.
        target: u16,
        /// What stands right of `=`.
        expression: Box<Expression>,
    },
    /// `CYCL DEF n.m ...`: one block of a cycle definition.
    Cycle(Box<CycleBlock>),
    /// `CYCL CALL [M]`: executes the cycle that was defined last.
    CycleCall(MFunctions),
    /// `TCH PROBE n.m ...`: one block of a probe function.
    Probe(Box<CycleBlock>),
    /// `DLG-DEF n/...` or `DLG-CALL n/...`: first block of an OEM cycle [000:17732-17744].
    Dialog(Box<Dialog>),
    /// A block of a language with G functions that does several things, or leaves something to those in force.
    Modal(Box<ModalBlock>),
    /// A block of comment (`; text`) or structuring (`* - text`) only. The text of a structuring block
    /// begins with its `*`.
    Comment(Box<str>),
    /// Something that no control here knows or that is written wrongly.
    Invalid(Box<InvalidBlock>),
}

/// The dialog block of an OEM cycle: which dialog texts name the cycle and its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dialog {
    /// `DLG-CALL` (acts at the cycle call) instead of `DLG-DEF` (acts at its definition).
    pub call: bool,
    /// Numbers of the dialog texts: the cycle's name, then its parameters.
    pub texts: Box<[u16]>,
}

/// A block that could not be read.
#[derive(Clone, Debug, PartialEq)]
pub struct InvalidBlock {
    /// The block as it stands in the file, with its comment, without block number and `/`. Lines that
    /// `~` joins stay lines.
    pub text: Box<str>,
    /// What is wrong with it.
    pub error: BlockError,
}

/// Name and unit of BEGIN PGM and END PGM.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Program name as written; may be empty.
    pub name: Box<str>,
    /// Unit; `None` when the block does not say.
    pub unit: Option<Unit>,
    /// Erase and edit protection (`P`) [003:1019].
    pub protected: bool,
}

impl Header {
    /// What stands where the unit should, if no control knows it as one: `CM` of `BEGIN PGM 7 CM`.
    pub fn unknown_unit(&self) -> Option<&str> {
        let (_, last) = self.name.rsplit_once(' ')?;
        self.unit.is_none().then_some(last)
    }
}

/// Unit of measure of a program [003:2101].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Words are in mm.
    Mm,
    /// Words are in inches, 25.4 mm each.
    Inch,
}

impl Unit {
    /// Millimetres of a length.
    pub const fn mm(self) -> f64 {
        match self {
            Unit::Mm => 1.0,
            Unit::Inch => 25.4,
        }
    }

    /// mm/min of F1, with what F counts in a program in inches.
    pub const fn feed_mm_min(self, inch_feed: InchFeed) -> f64 {
        match self {
            Unit::Mm => 1.0,
            Unit::Inch => inch_feed.mm_min(),
        }
    }

    /// Greatest F for a greatest feed in mm/min: the control shows it as a whole number, so that the
    /// 15 999 mm/min of rapid traverse are F6299 [001:471] and 29 999 mm/min are F1181 [003:2144].
    pub fn feed_max(self, inch_feed: InchFeed, max_mm_min: f64) -> f64 {
        (max_mm_min / self.feed_mm_min(inch_feed)).round()
    }
}

/// A number or a signed Q parameter [003:4066].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A literal number in program units.
    Number(f64),
    /// The value of a Q parameter, with its sign turned when `negative`.
    Q {
        /// Number of the Q parameter.
        number: u16,
        /// Written as `-Qn`: the value counts with the other sign.
        negative: bool,
    },
}

/// An absolute or incremental value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// The number or Q parameter after the letter, program units or degrees.
    pub value: Value,
    /// Written with `I` [003:767-777].
    pub incremental: bool,
}

/// Coordinate words of a block, at most one for each axis.
///
/// ```
/// use bahn_path::Axis;
/// use bahn_program::{Coordinates, Value, Word};
/// let mut c = Coordinates::default();
/// c.set(Axis::X, Word { value: Value::Number(10.0), incremental: true });
/// assert!(c.get(Axis::X).is_some_and(|w| w.incremental));
/// assert_eq!(c.get(Axis::Y), None);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Coordinates {
    present: AxisSet,
    incremental: AxisSet,
    /// Axes whose value is a Q parameter: `values` then holds its number, negative zero and below for `-Q`.
    parameters: AxisSet,
    values: PerAxis<f64>,
}

impl Coordinates {
    /// The axes that have a word.
    #[inline]
    pub fn axes(&self) -> AxisSet {
        self.present
    }

    /// The axes whose word is incremental.
    #[inline]
    pub fn incremental(&self) -> AxisSet {
        self.incremental
    }

    /// The axes whose value is a Q parameter.
    #[inline]
    pub fn parameters(&self) -> AxisSet {
        self.parameters
    }

    /// Whether there is no word.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.present.is_empty()
    }

    /// The literal numbers, for axes that are neither absent nor a Q parameter.
    #[inline]
    pub fn numbers(&self) -> &PerAxis<f64> {
        &self.values
    }

    /// What the block says of an axis; `None` where it names it not.
    #[inline]
    pub fn get(&self, axis: Axis) -> Option<Word> {
        if !self.present.contains(axis) {
            return None;
        }
        let raw = self.values[axis];
        let value = if self.parameters.contains(axis) {
            Value::Q {
                number: raw.abs() as u16,
                negative: raw.is_sign_negative(),
            }
        } else {
            Value::Number(raw)
        };
        Some(Word {
            value,
            incremental: self.incremental.contains(axis),
        })
    }

    /// Lets the block say this of an axis, in place of what it said.
    #[inline]
    pub fn set(&mut self, axis: Axis, word: Word) {
        self.present.insert(axis);
        if word.incremental {
            self.incremental.insert(axis);
        } else {
            self.incremental.remove(axis);
        }
        match word.value {
            Value::Number(number) => {
                self.parameters.remove(axis);
                self.values[axis] = number;
            }
            Value::Q { number, negative } => {
                self.parameters.insert(axis);
                let magnitude = f64::from(number);
                self.values[axis] = if negative { -magnitude } else { magnitude };
            }
        }
    }

    /// Makes the words of axes incremental.
    #[inline]
    pub fn make_incremental(&mut self, axes: AxisSet) {
        self.incremental = self.incremental.union(axes.intersection(self.present));
    }

    /// All words in the order X Y Z A B C U V W.
    pub fn iter(&self) -> impl Iterator<Item = (Axis, Word)> {
        Axis::ALL
            .into_iter()
            .filter_map(|axis| self.get(axis).map(|word| (axis, word)))
    }
}

impl PartialEq for Coordinates {
    fn eq(&self, other: &Self) -> bool {
        self.present == other.present && self.iter().eq(other.iter())
    }
}

/// A positioning block: how the tool goes where.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Line or arc, Cartesian or polar.
    pub kind: MotionKind,
    /// Words of the axes, program units or degrees.
    pub coordinates: Coordinates,
    /// `PR` of the polar forms.
    pub polar_radius: Option<Word>,
    /// `PA` of the polar forms, degrees.
    pub polar_angle: Option<Word>,
    /// `R` of CR with its sign [003:2861-2869].
    pub radius: Option<Value>,
    /// `DR+` or `DR-`, where the block has an arc that says it.
    pub direction: Option<Sense>,
    /// `RL`, `RR`, `R0`, `R+` or `R-`; absent keeps what is in force.
    pub compensation: Option<Compensation>,
    /// `F` or `FMAX`; absent keeps the feed in force.
    pub feed: Option<Feed>,
    /// `NX NY NZ` of LN: components of the normal of the surface.
    pub normal: Option<Box<[Value; 3]>>,
    /// Its M functions, at most [`MFunctions::MAX`].
    pub m: MFunctions,
    /// What it leaves to the G functions in force; `None` where the block says all itself.
    pub modal: Option<Modality>,
}

/// The path function of a positioning block [003:2548-2560].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// `L`: line to a Cartesian position.
    Line,
    /// `C`: arc about CC.
    Circle,
    /// `CR`: arc with radius.
    CircleRadius,
    /// `CT`: arc tangential to the element before it.
    CircleTangential,
    /// `LP`: line to a polar position.
    LinePolar,
    /// `CP`, with a tool-axis word a helix.
    CirclePolar,
    /// `CTP`: tangential arc to a polar position.
    CircleTangentialPolar,
    /// `LN`: a line with the normal of the surface [000:175].
    LineNormal,
    /// Opened with an axis key, no `L` [003:2046-2057].
    Paraxial,
}

impl MotionKind {
    /// The word that opens its blocks; empty where the axis word does.
    ///
    /// ```
    /// use bahn_program::MotionKind;
    ///
    /// assert_eq!(MotionKind::CircleTangentialPolar.word(), "CTP");
    /// ```
    pub const fn word(self) -> &'static str {
        match self {
            MotionKind::Line => "L",
            MotionKind::Circle => "C",
            MotionKind::CircleRadius => "CR",
            MotionKind::CircleTangential => "CT",
            MotionKind::LinePolar => "LP",
            MotionKind::CirclePolar => "CP",
            MotionKind::CircleTangentialPolar => "CTP",
            MotionKind::LineNormal => "LN",
            MotionKind::Paraxial => "",
        }
    }
}

/// What the word of the radius compensation says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// `R0`: tool centre on the contour.
    Off,
    /// `RL`: tool to the left of the contour.
    Left,
    /// `RR`: tool to the right of the contour.
    Right,
    /// `R+`: paraxial path lengthened by the radius.
    Lengthen,
    /// `R-`: paraxial path shortened by the radius.
    Shorten,
}

/// What the feed word says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feed {
    /// `FMAX`: rapid traverse in this block.
    Max,
    /// `F value`, mm/min; in a program in inches what [`InchFeed`] says.
    Value(Value),
}

/// The M functions of a block in the order written. Controls here take one in a block; later ones two.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MFunctions {
    codes: [u16; MFunctions::MAX],
    count: u8,
    /// Arguments of M103 F, M112 T A, M120 LA and their like.
    pub arguments: Option<Box<[MArgument]>>,
}

impl MFunctions {
    /// Most M functions in one block.
    pub const MAX: usize = 3;

    /// The numbers after `M`, in their order.
    #[inline]
    pub fn codes(&self) -> &[u16] {
        self.codes.get(..usize::from(self.count)).unwrap_or_default()
    }

    /// Whether there is none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether a code is among them.
    #[inline]
    pub fn contains(&self, code: u16) -> bool {
        self.codes().contains(&code)
    }

    /// Adds a code; `false` when the block is full.
    pub fn push(&mut self, code: u16) -> bool {
        match self.codes.get_mut(usize::from(self.count)) {
            Some(slot) => {
                *slot = code;
                self.count += 1;
                true
            }
            None => false,
        }
    }

    /// The argument of an M function by its address letter.
    pub fn argument(&self, code: u16, letter: char) -> Option<Value> {
        let arguments = self.arguments.as_deref()?;
        arguments
            .iter()
            .find(|a| a.code == code && a.letter == letter)
            .map(|a| a.value)
    }
}

/// An argument of an M function, like the F of `M103 F25`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MArgument {
    /// The M function it belongs to.
    pub code: u16,
    /// The letter before the value: `F` of M103, `T` and `A` of M112.
    pub letter: char,
    /// What stands after the letter; the M function says its unit.
    pub value: Value,
}

/// The calculations of FN 0-8 and 13.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calculation {
    /// FN0: assignment of one operand.
    Assign,
    /// FN1: sum of the operands.
    Add,
    /// FN2: first operand less the second.
    Subtract,
    /// FN3: product of the operands.
    Multiply,
    /// FN4: first operand divided by the second (DIV).
    Divide,
    /// FN5: square root (SQRT).
    SquareRoot,
    /// FN6: sine of degrees (SIN).
    Sine,
    /// FN7: cosine of degrees (COS).
    Cosine,
    /// FN8: root of the sum of squares (LEN).
    Length,
    /// FN13: angle from opposite and adjacent side (ANG), degrees.
    Angle,
}

/// The comparisons of FN 9-12.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// FN9, `EQU`: both are equal.
    Equal,
    /// FN10, `NE`: they are not equal.
    NotEqual,
    /// FN11, `GT`: the first is greater.
    Greater,
    /// FN12, `LT`: the first is less.
    Less,
}

/// A bracketed formula of the TNC 415.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number or Q parameter.
    Value(Value),
    /// A function of one operand.
    Unary(UnaryFunction, Box<Expression>),
    /// An operator between two operands.
    Binary(BinaryOperator, Box<Expression>, Box<Expression>),
}

/// Functions of one operand; angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryFunction {
    /// `NEG`, or a sign before a bracket.
    Negate,
    /// `SQ`: x².
    Square,
    /// `SQRT`, of a negative number an error.
    SquareRoot,
    /// `SIN` of degrees.
    Sine,
    /// `COS` of degrees.
    Cosine,
    /// `TAN` of degrees.
    Tangent,
    /// `ASIN`, in degrees.
    ArcSine,
    /// `ACOS`, in degrees.
    ArcCosine,
    /// `ATAN`, in degrees.
    ArcTangent,
    /// `LN`, to base e.
    NaturalLogarithm,
    /// `LOG`, to base 10.
    Logarithm,
    /// `EXP`: e to this power.
    Exponential,
    /// `ABS`: without its sign.
    Absolute,
    /// `INT`: decimals cut off.
    Integer,
    /// `FRAC`: decimals only.
    Fraction,
}

/// Operators between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOperator {
    /// `+`: sum.
    Add,
    /// `-`: first operand less the second.
    Subtract,
    /// `*`: product.
    Multiply,
    /// `/` or `DIV`: first operand divided by the second.
    Divide,
    /// `^`: first operand to the power of the second.
    Power,
}

/// One block of a cycle definition or a probe function.
#[derive(Clone, Debug, PartialEq)]
pub struct CycleBlock {
    /// Cycle number before the point.
    pub number: u16,
    /// Sub-block number after the point.
    pub sub: u16,
    /// Words in the order written.
    pub words: Vec<CycleWord>,
}

/// A word of a cycle block. Names are decoration and vary with the language; numbers and addresses
/// decide [003:3713-3714] [003:4979].
#[derive(Clone, Debug, PartialEq)]
pub enum CycleWord {
    /// Decoration, or a program name (cycle 12, RANGE).
    Text(Box<str>),
    /// A number without an address: the value of a named parameter like `SET UP -2`.
    Number(Value),
    /// An axis word `X+40`, `IX+40`.
    Coordinate(Axis, Word),
    /// The factor of an axis, `X1.4` (cycle 26).
    AxisFactor(Axis, Value),
    /// Coordinate of a centre, `CCX+15` (cycle 26).
    Centre(Axis, Value),
    /// An axis letter alone (mirror image, probe axis).
    Axis(Axis),
    /// An axis letter with a direction `X-` (probing).
    AxisDirection(Axis, Direction),
    /// `F value` or `FMAX`.
    Feed(Feed),
    /// `DR+` or `DR-`: sense of rotation.
    Sense(Sense),
    /// Label list `1/2/3` (cycle 14).
    Labels(Box<[u16]>),
    /// `Qn` alone: the parameter that takes a result (probing).
    Target(u16),
    /// `Qn = value` (OEM cycles).
    Assignment(u16, Value),
    /// `M` function, by its number.
    M(u16),
}

/// A block that does several things, or one whose words may be incremental by a function in force.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalBlock {
    /// The number of the G function that says what it does; `None` for a positioning block with more in it.
    pub code: Option<u16>,
    /// What it says of the functions in force; its open words are those of all operations but positioning.
    pub modality: Modality,
    /// What it does, in this order.
    pub operations: Box<[Operation]>,
}
