//! What ends a run and what is only worth saying.

use bahn_parameters::{ControlModel, InchFeed, MessageId};
use bahn_path::BlockRef;

/// An error of the program, with the control's message and the block that causes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramError {
    /// What the control says.
    pub message: Message,
    /// Name of the program.
    pub program: String,
    /// The block that causes it.
    pub block: BlockRef,
    /// What exactly, in a few words; may be empty.
    pub detail: String,
    /// What it is about, where the message leaves that open.
    pub cause: Cause,
}

impl ProgramError {
    /// What the programmer can do about it; nothing is known of a text of FN14.
    pub fn remedy(&self) -> Option<&'static str> {
        self.cause.remedy().or(match self.message {
            Message::Control(id) => Some(id.remedy()),
            Message::Numbered(_) => None,
        })
    }
}

/// What a fault is about, where one message of the control stands for several things.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Cause {
    /// What the message says.
    #[default]
    Message,
    /// The block cannot be read; what to do about it.
    Written(&'static str),
    /// No tool is called before the block that needs its radius.
    NoTool,
    /// No CC is programmed before the block that needs it.
    NoPole,
    /// An axis has no position yet.
    NoPosition,
    /// A cycle is called, none is defined.
    NoCycle,
    /// BLK FORM 0.2 stands without 0.1.
    NoBlankMin,
    /// The arc has no sense of rotation.
    NoDirection,
    /// CR has no radius.
    NoRadius,
    /// The polar angle is missing.
    NoAngle,
    /// The subprogram does not end with LBL 0.
    NoReturn,
    /// A label after the block is called with REP.
    RepeatsAhead,
    /// A subprogram calls itself.
    CallsItself,
    /// The tool in use has no radius.
    NoToolRadius,
}

impl Cause {
    /// What the programmer can do about it, where the message's own remedy would mislead.
    pub fn remedy(self) -> Option<&'static str> {
        Some(match self {
            Cause::Message => return None,
            Cause::Written(help) => help,
            Cause::NoTool => "Call the tool before the block: TOOL CALL with number, tool axis and S.",
            Cause::NoPole => "Program CC with the circle centre or pole before this block.",
            Cause::NoPosition => {
                "Move the axes of the plane to a position with R0 before the contour begins."
            }
            Cause::NoCycle => "Define a cycle with CYCL DEF before it is called with CYCL CALL, M99 or M89.",
            Cause::NoBlankMin => "Program BLK FORM 0.1 with the MIN point before BLK FORM 0.2.",
            Cause::NoDirection => "Add DR+ (counter-clockwise) or DR- (clockwise) to the arc.",
            Cause::NoRadius => "Add the radius R to the arc.",
            Cause::NoAngle => "Add the polar angle PA.",
            Cause::NoReturn => "End the subprogram with LBL 0, and put it after the block with M2 or M30.",
            Cause::RepeatsAhead => {
                "Call a subprogram without REP; a section that is repeated begins before the call."
            }
            Cause::CallsItself => "Take the call out of the subprogram that it calls.",
            Cause::NoToolRadius => {
                "Give the tool its radius: TOOL DEF with L and R before the call, or a tool table."
            }
        })
    }
}

/// What the control shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// One of the control's own messages, by its number.
    Control(MessageId),
    /// A text that no list of messages has: that of an FN14 number, `ERROR 12`, `PLC ERROR 05` ... [003:4364-4367], or one of
    /// another family of controls.
    Numbered(String),
}

impl Message {
    /// The text on the screen of a model.
    pub fn text(&self, model: ControlModel) -> &str {
        match self {
            Message::Control(id) => id.text(model),
            Message::Numbered(text) => text,
        }
    }
}

/// Something that does not stop the run but that the user should know.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Warning {
    /// The block in which it came up.
    pub block: BlockRef,
    /// What the user should know.
    pub kind: WarningKind,
    /// How often it came up since it was last taken.
    pub count: u64,
}

/// What a warning is about.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum WarningKind {
    /// A cycle whose setup clearance or pecking depth has another sign than its depth [003:4902].
    CycleSign {
        /// Number of the cycle.
        cycle: u16,
    },
    /// A tool is called that is neither defined nor in a table; length and radius 0 are taken.
    ToolNotDefined {
        /// Number of the tool that is called.
        tool: u32,
    },
    /// BLK FORM 0.1 stands without 0.2: there is no blank.
    BlankIncomplete,
    /// All sides of BLK FORM are zero: there is no blank.
    BlankEmpty,
    /// A blank was given in a called program only [003:7908-7912].
    BlankInCalledProgram,
    /// M91 or M92 without the place of the workpiece in the machine: the axes leave the workpiece.
    MachineZeroUnknown,
    /// M2 or M30 stands in a called program, where it must not [003:3870-3902].
    EndInCalledProgram,
    /// A function that has no effect here, or only part of it.
    Function {
        /// Which, and what is missing.
        text: String,
    },
    /// What nothing here knows, or what would move differently on the control, was passed over as wanted.
    PassedOver {
        /// The words, or the function and why.
        what: String,
    },
    /// Numbers finer than the input step of the control are rounded in this block, and where others follow in its
    /// program.
    Rounded {
        /// The steps of lengths and angles.
        step: String,
    },
    /// The feeds of a program in inches look ten times too small or too great.
    InchFeed {
        /// What F is taken to count.
        reading: InchFeed,
        /// The greatest feed if all are too small, the least if all are too great, mm/min.
        feed_mm_min: u32,
    },
}

impl std::fmt::Display for WarningKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            WarningKind::CycleSign { cycle } => {
                write!(
                    f,
                    "cycle {cycle}: setup clearance or pecking depth has another sign than the depth"
                )
            }
            WarningKind::ToolNotDefined { tool } => {
                write!(f, "tool {tool} is not defined: length 0 and radius 0 are taken")
            }
            WarningKind::Function { text } => f.write_str(text),
            WarningKind::PassedOver { what } => write!(f, "passed over: {what}"),
            WarningKind::Rounded { step } => {
                write!(
                    f,
                    "numbers finer than the input step of this control, {step}, are rounded"
                )
            }
            WarningKind::BlankIncomplete => write!(f, "BLK FORM 0.2 is missing: there is no blank"),
            WarningKind::BlankEmpty => write!(f, "BLK FORM has no size: there is no blank"),
            WarningKind::BlankInCalledProgram => {
                write!(
                    f,
                    "BLK FORM stands in a called program only; give it in the main program"
                )
            }
            WarningKind::MachineZeroUnknown => {
                write!(
                    f,
                    "M91 and M92 lead away from the workpiece: where it lies in the machine is not known"
                )
            }
            WarningKind::EndInCalledProgram => {
                write!(
                    f,
                    "a called program must not contain M2 or M30: the whole run ends here"
                )
            }
            WarningKind::InchFeed {
                reading: InchFeed::Tenths,
                feed_mm_min,
            } => write!(
                f,
                "F counts tenths of an inch/min: no feed of the program is above {feed_mm_min} mm/min; \
                 --inch-feed whole if inch/min are meant"
            ),
            WarningKind::InchFeed {
                reading: InchFeed::Whole,
                feed_mm_min,
            } => write!(
                f,
                "F counts inch/min: no feed of the program is below {feed_mm_min} mm/min; \
                 --inch-feed tenths if tenths of an inch/min are meant"
            ),
        }
    }
}
