//! Technology functions: when they go out, to whom, where the path waits for them, and what the control itself does.
//!
//! The table stands in `data/technology-functions.tsv`, a line for each function or group of like functions of the
//! models that have it. Interpreter and kernel act by it; whether a model's function acts at all is said by
//! [`conformance`](crate::conformance). Functions of a model that stand nowhere in it do nothing.
//!
//! ```
//! use bahn_parameters::ControlModel::Tnc415b;
//! use bahn_parameters::technology::{ControlAction, Output, Technology, Wait};
//! use bahn_path::{At, SpindleOrder};
//!
//! let m5 = Technology::of_m(Tnc415b, 5).unwrap();
//! assert_eq!((m5.at, m5.output, m5.waits), (At::End, Output::Plc, Wait::AxisHalt));
//! assert!(m5.does(ControlAction::Spindle(SpindleOrder::Stop)));
//! ```

use std::sync::LazyLock;

use bahn_path::{At, ControlFunction, SpindleOrder, Switch, Synchronisation};

use crate::ControlModel;
use crate::conformance::{bit, models};

/// A function that goes out with the path, as a table has it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Technology {
    /// At the start or the end of its block.
    pub at: At,
    /// To whom it goes.
    pub output: Output,
    /// Whether the path waits for it there.
    pub waits: Wait,
    /// Where the manuals say it, as `[000:7081]`.
    pub source: &'static str,
    does: Vec<ControlAction>,
    name: Name,
    models: u8,
}

/// To whom a function goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// To the PLC, with its strobe.
    Plc,
    /// To the kernel, when the path comes to it.
    Path,
    /// To nobody: it acts on its block and on those that follow.
    Block,
}

/// Whether the path waits for the acknowledgement of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// Always: the run stops there anyway, or the path cannot go on.
    Always,
    /// Unless axes may run on at M functions (MP7440 bit 2) [000:7298-7305] [001:1652].
    AxisHalt,
    /// Unless axes may run on at the output of a speed (MP3030) [000:5645-5651].
    AxisHaltAtSpeed,
    /// Never: nobody acknowledges it.
    Never,
}

/// What the control itself does with an M function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlAction {
    /// M0: the run stops.
    ProgramStop,
    /// M2, M30: the run ends.
    ProgramEnd,
    /// M6: the run stops, unless MP7440 bit 0 is set.
    ToolChange,
    /// It starts the spindle, stops it, or stops it as the run stops.
    Spindle(SpindleOrder),
    /// M19: the spindle is to be oriented.
    SpindleOrientation,
    /// Coolant, on or off, as Q111 has it.
    Coolant(Switch),
    /// M89: calls the cycle in every block, where MP7440 bit 1 is set; it is not output then.
    ModalCycleCall,
    /// M99: calls the cycle once.
    CycleCall,
    /// M90: constant speed in corners, with servo lag only [000:5112-5114].
    ConstantSpeed,
    /// M91: the block counts from machine zero [003:3533-3545].
    MachineZero,
    /// M92: the block counts from the machine builder's datum [003:3547-3553].
    MachineDatum,
    /// M93: the block counts from where the tool is [003:7481].
    ToolPosition,
    /// M94: rotary axes are displayed below 360 degrees [003:7482].
    ReduceRotaryAxes,
    /// M97: the path goes to the intersection, without a transition arc [003:7485].
    Intersection,
    /// M98: an open corner is machined to the end of its element [003:7486].
    OpenContour,
    /// M103: the feed is reduced as the tool plunges.
    PlungingFeed,
    /// M109: on arcs, F is the feed of the cutting edge [000:5120-5126].
    FeedAtEdge,
    /// M110: as M109, but only where this lowers the feed [000:5120-5126].
    FeedAtEdgeReduced,
    /// M111: F is the feed of the tool's centre again [000:5120-5126].
    FeedAtCentre,
    /// M112: rounds corners between uncompensated lines [000:5128-5158].
    CornerArcs,
    /// M113: ends M112.
    SharpCorners,
    /// M124: points nearer to each other than T are left out [000:5128-5158].
    LeaveOutPoints,
    /// M118: the handwheel moves axes beside the path [000:742].
    Superimpose,
    /// M200 to M204: output S gives a voltage.
    Voltage,
    /// M114, M115: the offsets of swivel axes are compensated, or no more.
    CompensateSwivels(Switch),
    /// M116, M117: feeds of rotary axes are those of the tool, or of the axes.
    SurfaceFeed(Switch),
    /// M126, M127: rotary axes take the shortest way, or the one that does not cross 0.
    ShortestWay(Switch),
    /// It acts in the kernel.
    Control(ControlFunction),
}

impl ControlAction {
    /// All actions with their names in the table.
    const NAMES: [(&'static str, ControlAction); 40] = [
        ("program-stop", ControlAction::ProgramStop),
        ("program-end", ControlAction::ProgramEnd),
        ("tool-change", ControlAction::ToolChange),
        (
            "spindle-clockwise",
            ControlAction::Spindle(SpindleOrder::Clockwise),
        ),
        (
            "spindle-counter-clockwise",
            ControlAction::Spindle(SpindleOrder::CounterClockwise),
        ),
        ("spindle-stop", ControlAction::Spindle(SpindleOrder::Stop)),
        (
            "spindle-stop-with-run",
            ControlAction::Spindle(SpindleOrder::StopWithRun),
        ),
        ("spindle-orientation", ControlAction::SpindleOrientation),
        ("coolant-on", ControlAction::Coolant(Switch::On)),
        ("coolant-off", ControlAction::Coolant(Switch::Off)),
        ("modal-cycle-call", ControlAction::ModalCycleCall),
        ("cycle-call", ControlAction::CycleCall),
        ("constant-speed", ControlAction::ConstantSpeed),
        ("machine-zero", ControlAction::MachineZero),
        ("machine-datum", ControlAction::MachineDatum),
        ("tool-position", ControlAction::ToolPosition),
        ("reduce-rotary-axes", ControlAction::ReduceRotaryAxes),
        ("intersection", ControlAction::Intersection),
        ("open-contour", ControlAction::OpenContour),
        ("plunging-feed", ControlAction::PlungingFeed),
        ("feed-at-edge", ControlAction::FeedAtEdge),
        ("feed-at-edge-reduced", ControlAction::FeedAtEdgeReduced),
        ("feed-at-centre", ControlAction::FeedAtCentre),
        ("compensate-swivels", ControlAction::CompensateSwivels(Switch::On)),
        ("leave-swivels", ControlAction::CompensateSwivels(Switch::Off)),
        ("surface-feed", ControlAction::SurfaceFeed(Switch::On)),
        ("axis-feed", ControlAction::SurfaceFeed(Switch::Off)),
        ("shortest-way", ControlAction::ShortestWay(Switch::On)),
        ("way-beside-0", ControlAction::ShortestWay(Switch::Off)),
        ("corner-arcs", ControlAction::CornerArcs),
        ("sharp-corners", ControlAction::SharpCorners),
        ("leave-out-points", ControlAction::LeaveOutPoints),
        ("voltage", ControlAction::Voltage),
        ("superimpose", ControlAction::Superimpose),
        (
            "replace-worn-tools",
            ControlAction::Control(ControlFunction::ReplaceWornTools(Switch::On)),
        ),
        (
            "keep-worn-tools",
            ControlAction::Control(ControlFunction::ReplaceWornTools(Switch::Off)),
        ),
        (
            "first-servo-set",
            ControlAction::Control(ControlFunction::SecondServoSet(Switch::Off)),
        ),
        (
            "second-servo-set",
            ControlAction::Control(ControlFunction::SecondServoSet(Switch::On)),
        ),
        (
            "take-larger-tools",
            ControlAction::Control(ControlFunction::TakeLargerTools(Switch::On)),
        ),
        (
            "refuse-larger-tools",
            ControlAction::Control(ControlFunction::TakeLargerTools(Switch::Off)),
        ),
    ];
}

/// Functions that are no M functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// `TOOL CALL` with a tool.
    ToolCall,
    /// `TOOL DEF` without data: the next tool.
    ToolDef,
    /// `TOOL CALL S`: the spindle speed alone.
    SpindleSpeed,
    /// `CYCL DEF 13`: the angle of orientation.
    OrientationAngle,
    /// `FN15: PRINT`: a line for the data interface.
    Print,
    /// `FN19: PLC`: one or two numbers for the PLC.
    Plc,
    /// `BLK FORM`: the blank of the graphics.
    Blank,
}

impl Block {
    /// All of them with their names in the table.
    const NAMES: [(&'static str, Block); 7] = [
        ("TOOL CALL", Block::ToolCall),
        ("TOOL DEF", Block::ToolDef),
        ("S", Block::SpindleSpeed),
        ("CYCL DEF 13", Block::OrientationAngle),
        ("FN15", Block::Print),
        ("FN19", Block::Plc),
        ("BLK FORM", Block::Blank),
    ];
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Name {
    /// The first and last of a group of M functions.
    M(u16, u16),
    Block(Block),
}

impl Technology {
    /// An M function of a model; `None` when it does nothing there.
    pub fn of_m(model: ControlModel, code: u16) -> Option<&'static Technology> {
        let is_it =
            |row: &Technology| matches!(row.name, Name::M(first, last) if (first..=last).contains(&code));
        find(model, is_it)
    }

    /// A function of another block; `None` when the model does not have it.
    pub fn of_block(model: ControlModel, block: Block) -> Option<&'static Technology> {
        find(model, |row| row.name == Name::Block(block))
    }

    /// What the control itself does, in this order.
    pub fn actions(&self) -> impl Iterator<Item = ControlAction> {
        self.does.iter().copied()
    }

    /// Whether the control itself does something.
    pub fn does(&self, action: ControlAction) -> bool {
        self.does.contains(&action)
    }

    /// What it orders the spindle to do.
    pub fn spindle(&self) -> Option<SpindleOrder> {
        self.actions().find_map(|action| match action {
            ControlAction::Spindle(order) => Some(order),
            _ => None,
        })
    }

    /// How it is synchronised with the path, on a machine whose axes halt at M functions (MP7440 bit 2 clear) and at
    /// the output of a speed (MP3030 = 0).
    pub fn synchronisation(&self, halts: AxisHalts) -> Synchronisation {
        let waits = match self.waits {
            Wait::Always => true,
            Wait::AxisHalt => halts.at_m_functions,
            Wait::AxisHaltAtSpeed => halts.at_speeds,
            Wait::Never => false,
        };
        match (waits, self.at) {
            (false, _) => Synchronisation::Mos,
            (true, At::End) => Synchronisation::MnsSns,
            (true, _) => Synchronisation::MvsSvs,
        }
    }
}

/// At which functions the axes of a machine halt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisHalts {
    /// At M functions: MP7440 bit 2 is clear.
    pub at_m_functions: bool,
    /// At the output of a spindle speed without a tool: MP3030 = 0.
    pub at_speeds: bool,
}

/// Every line of the table.
fn rows() -> &'static [Technology] {
    static ROWS: LazyLock<Vec<Technology>> = LazyLock::new(|| {
        let table = include_str!("../data/technology-functions.tsv");
        table.lines().skip(1).filter_map(row).collect()
    });
    &ROWS
}

fn find(model: ControlModel, is_it: impl Fn(&Technology) -> bool) -> Option<&'static Technology> {
    rows()
        .iter()
        .find(|row| row.models & bit(model) != 0 && is_it(row))
}

/// Reads a line; a test proves that every line can be read.
fn row(line: &'static str) -> Option<Technology> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    Some(Technology {
        name: name(next()?)?,
        models: models(next()?)?,
        at: match next()? {
            "start" => At::Start,
            "end" => At::End,
            _ => return None,
        },
        output: match next()? {
            "plc" => Output::Plc,
            "path" => Output::Path,
            "block" => Output::Block,
            _ => return None,
        },
        waits: match next()? {
            "always" => Wait::Always,
            "axis-halt" => Wait::AxisHalt,
            "axis-halt-at-speed" => Wait::AxisHaltAtSpeed,
            "never" => Wait::Never,
            _ => return None,
        },
        does: next()?
            .split(' ')
            .filter(|action| !action.is_empty())
            .map(|action| named(&ControlAction::NAMES, action))
            .collect::<Option<_>>()?,
        source: next()?,
    })
}

/// Reads `M5`, `M15-M18` or `TOOL CALL`.
fn name(text: &str) -> Option<Name> {
    if let Some(block) = named(&Block::NAMES, text) {
        return Some(Name::Block(block));
    }
    let code = |text: &str| text.strip_prefix('M')?.parse().ok();
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    Some(Name::M(code(first)?, code(last)?))
}

fn named<T: Copy>(names: &[(&str, T)], name: &str) -> Option<T> {
    names
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, value)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_read() {
        let table = include_str!("../data/technology-functions.tsv");
        for line in table.lines().skip(1) {
            assert!(row(line).is_some(), "{line}");
            assert_eq!(line.split('\t').count(), 7, "{line}");
        }
    }

    /// Nothing is written in the table's language that no line says, and every block has its line.
    #[test]
    fn every_name_is_used() {
        for (name, action) in ControlAction::NAMES {
            assert!(rows().iter().any(|row| row.does(action)), "{name}");
        }
        for (name, block) in Block::NAMES {
            let of = |model: &ControlModel| Technology::of_block(*model, block).is_some();
            assert!(ControlModel::ALL.iter().all(of), "{name}");
        }
    }
}
