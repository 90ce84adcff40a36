//! What a block orders, from its words and what is in force.
//!
//! Decision: A `.nc` program begins with G00, G90, G17 and without feed, so that all programs of the manual run; a G
//! function counts in its whole block, one of each group
//!
//! Decision: G41 and G42 of `.nc` programs change no path, since no tool has a radius there

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_path::{Axis, Curve, PerAxis, Plane, Position, Sense, Switch};

use crate::block::{Block, Word, WordKind};
use crate::circle::{self, Centre};
use crate::expression::{Expression, Values, function_number, whole};
use crate::line::{LineFault, Macros, fault_at};
use crate::unit::{
    Command, Function, FunctionLetter, Independent, Kind, Motion, SpindleOrder, Target, Unit, Variables,
};

/// What blocks change and find again.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub modal: Modal,
    /// Where the axes stand after the blocks that were executed.
    pub position: Position,
    /// Where the path would stand, when the axes were moved since: incremental coordinates and arcs of the next motion
    /// count from there.
    pub increments_from: Option<Position>,
    pub parameters: BTreeMap<u32, f64>,
    pub macros: Macros,
}

impl State {
    /// At the beginning of a program.
    pub fn at(position: Position) -> State {
        State {
            modal: Modal::default(),
            position,
            increments_from: None,
            parameters: BTreeMap::new(),
            macros: Macros::default(),
        }
    }

    /// Where the next motion would begin, had nobody moved the axes.
    pub fn begin(&self) -> Position {
        self.increments_from.unwrap_or(self.position)
    }
}

/// What is in force until another block changes it. A program begins with G00, G90, G17 and without feed (inferred: so
/// that all programs of the manual run).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modal {
    path: Path,
    is_incremental: bool,
    plane: Plane,
    feed_mm_min: Option<f64>,
}

impl Default for Modal {
    fn default() -> Modal {
        Modal {
            path: Path::Rapid,
            is_incremental: false,
            plane: Plane::XY,
            feed_mm_min: None,
        }
    }
}

/// G00 to G03, of which one is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Path {
    Rapid,
    Line,
    Circle(Sense),
}

/// What a block does beside its unit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Done {
    /// M17 or M29: a subroutine is over.
    pub returns: bool,
}

/// Most P parameters of a program (inferred).
const MAX_PARAMETERS: usize = 10_000;

/// What of a block is collected before it moves.
#[derive(Default)]
struct Draft {
    axes: PerAxis<Option<(f64, u32)>>,
    centre: Option<[f64; 3]>,
    radius: Option<f64>,
    dwell: Option<Dwell>,
    done: Done,
}

/// G04: its time may stand after X or alone (public).
#[derive(Clone, Copy)]
struct Dwell {
    column: u32,
    length: u32,
    seconds: Option<f64>,
}

/// Executes a block: G functions first, since they count in the whole block, everything else in the order of the text
/// (inferred).
pub(crate) fn block(
    block: &Block,
    state: &mut State,
    unit: &mut Unit,
    variables: &mut dyn Variables,
) -> Result<Done, LineFault> {
    let mut draft = Draft::default();
    for word in &block.words {
        if let WordKind::G(g) = word.kind {
            g_function(g, word, state, unit, &mut draft);
        }
    }
    for word in &block.words {
        execute(word, state, unit, &mut draft, variables).map_err(|fault| fault.at(word))?;
    }
    if let Some(dwell) = draft.dwell {
        dwells(dwell, &draft, block, unit)?;
    } else {
        unit.motion = motion(state, &draft, block)?;
    }
    Ok(draft.done)
}

/// What is wrong with a word: the word itself, or a place within it.
enum Wrong {
    Word(String),
    Place(LineFault),
}

impl Wrong {
    fn at(self, word: &Word) -> LineFault {
        match self {
            Wrong::Word(message) => fault_at(word.column, word.length, message),
            Wrong::Place(fault) => fault,
        }
    }
}

impl From<String> for Wrong {
    fn from(message: String) -> Wrong {
        Wrong::Word(message)
    }
}

impl From<&str> for Wrong {
    fn from(message: &str) -> Wrong {
        Wrong::Word(message.into())
    }
}

fn g_function(g: u16, word: &Word, state: &mut State, unit: &mut Unit, draft: &mut Draft) {
    let modal = &mut state.modal;
    match g {
        0 => modal.path = Path::Rapid,
        1 => modal.path = Path::Line,
        2 | 3 => {
            modal.path = Path::Circle(if g == 3 {
                Sense::CounterClockwise
            } else {
                Sense::Clockwise
            })
        }
        4 => {
            let (column, length) = (word.column, word.length);
            draft.dwell = Some(Dwell {
                column,
                length,
                seconds: None,
            });
        }
        17 => modal.plane = Plane::XY,
        18 => modal.plane = Plane::ZX,
        19 => modal.plane = Plane::YZ,
        40..=42 => unit
            .commands
            .push(Command::RadiusCompensation(Switch::from(g != 40))),
        90 | 91 => modal.is_incremental = g == 91,
        107 | 108 => unit.commands.push(Command::EdgeBanding(Switch::from(g == 108))),
        _ => {}
    }
}

fn execute(
    word: &Word,
    state: &mut State,
    unit: &mut Unit,
    draft: &mut Draft,
    variables: &mut dyn Variables,
) -> Result<(), Wrong> {
    let mut values = Values {
        parameters: &state.parameters,
        variables,
    };
    match &word.kind {
        WordKind::G(_) | WordKind::Call { .. } | WordKind::Independent => {}
        WordKind::Axis(axis, value) => {
            let value = value.value(&mut values)?;
            once(&mut draft.axes[*axis], (value, word.column), &axis.to_string())?;
        }
        WordKind::Feed(value) => state.modal.feed_mm_min = Some(feed(value, &mut values)?),
        WordKind::Centre(index, value) => {
            let value = value.value(&mut values)?;
            let centre = draft.centre.get_or_insert([0.0; 3]);
            if let Some(slot) = centre.get_mut(*index) {
                *slot = value;
            }
        }
        WordKind::Radius(value) => {
            let value = value.value(&mut values)?;
            once(&mut draft.radius, value, "R")?;
        }
        WordKind::Bare(value) => {
            let value = value.value(&mut values)?;
            if let Some(dwell) = &mut draft.dwell {
                once(&mut dwell.seconds, value, "the time of G04")?;
            }
        }
        WordKind::Speed(_) | WordKind::Function(..) | WordKind::Place(_) => {
            let function = function(word, None, &mut values)?;
            end(&function, unit, draft);
            unit.functions.push(function);
        }
        WordKind::AxisBracket(axis, words) => axis_bracket(*axis, words, state, unit, draft, variables)?,
        WordKind::SpindleBracket(name, words) => {
            let target = Target::Spindle(Arc::clone(name));
            let mut order = None;
            for word in words {
                if let WordKind::Place(place) = &word.kind {
                    order = Some(place.value(&mut values)?);
                    continue;
                }
                let function = function(word, Some(&target), &mut values)
                    .map_err(|wrong| Wrong::Place(wrong.at(word)))?;
                unit.functions.push(function);
            }
            if let Some(position_deg) = order {
                let spindle = Arc::clone(name);
                let position_deg = Some(position_deg);
                unit.commands.push(Command::Spindle(SpindleOrder {
                    spindle,
                    position_deg,
                }));
            }
        }
        WordKind::SetParameter(number, value) => {
            let value = value.value(&mut values)?;
            let number = whole(number.value(&mut values)?, "number of P")?;
            if state.parameters.len() >= MAX_PARAMETERS && !state.parameters.contains_key(&number) {
                return Err(
                    format!("P{number} is more than the {MAX_PARAMETERS} parameters of a program").into(),
                );
            }
            state.parameters.insert(number, value);
        }
        WordKind::SetVariable(variable, value) => {
            let value = value.value(&mut values)?;
            let variable = variable.variable(&mut values)?;
            variables.write(&variable, value)?;
        }
        WordKind::Define(name, text) => state.macros.define(name, text)?,
        WordKind::Command(order) => {
            let command = order.command(&mut values)?;
            unit.commands.push(command);
        }
    }
    Ok(())
}

/// A word that stands once in a block.
fn once<T>(slot: &mut Option<T>, value: T, name: &str) -> Result<(), Wrong> {
    match slot.replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{name} stands twice in the block").into()),
    }
}

fn feed(value: &Expression, values: &mut Values) -> Result<f64, String> {
    match value.value(values)? {
        feed if feed > 0.0 => Ok(feed),
        feed => Err(format!("F{feed} is not greater than 0")),
    }
}

/// M, H or S of a word, for a range or, without one, where parameters send it.
fn function(word: &Word, target: Option<&Target>, values: &mut Values) -> Result<Function, Wrong> {
    let mut additive = None;
    let kind = match &word.kind {
        WordKind::Function(letter, number, value) => {
            if let Some(value) = value {
                additive = Some(additive_value(value.value(values)?));
            }
            let number = function_number(number.value(values)?)?;
            match letter {
                FunctionLetter::M => Kind::M(number),
                FunctionLetter::H => Kind::H(number),
            }
        }
        WordKind::Speed(speed) => match speed.value(values)? {
            speed if speed >= 0.0 => Kind::S(speed),
            speed => return Err(format!("S{speed} is less than 0").into()),
        },
        _ => return Err("a word that is no function".into()),
    };
    Ok(Function {
        kind,
        value: additive,
        target: target.cloned(),
        column: word.column,
    })
}

/// Additive values are whole numbers of 32 bits (inferred): rounded, and the nearest there is.
fn additive_value(value: f64) -> i32 {
    // The cast saturates.
    value.round() as i32
}

/// M02 and M30 end the program, M17 and M29 a subroutine [004:48].
fn end(function: &Function, unit: &mut Unit, draft: &mut Draft) {
    match function.kind {
        Kind::M(2 | 30) => unit.ends = true,
        Kind::M(17 | 29) => draft.done.returns = true,
        _ => {}
    }
}

/// Functions of an axis, or with INDP a motion of its own [004:102-108].
fn axis_bracket(
    axis: Axis,
    words: &[Word],
    state: &mut State,
    unit: &mut Unit,
    draft: &Draft,
    variables: &mut dyn Variables,
) -> Result<(), Wrong> {
    let mut values = Values {
        parameters: &state.parameters,
        variables,
    };
    let target = Target::Axis(axis);
    let mut is_independent = false;
    let mut rapid = false;
    let mut is_incremental = state.modal.is_incremental;
    let (mut feed_mm_min, mut place) = (None, None);
    for word in words {
        let at = |message: String| Wrong::Place(fault_at(word.column, word.length, message));
        match &word.kind {
            WordKind::Independent => is_independent = true,
            _ if !is_independent && !matches!(word.kind, WordKind::Function(..)) => {
                return Err(at(format!(
                    "in the brackets of {axis} INDP stands before this word"
                )));
            }
            WordKind::G(g @ (0 | 1)) => rapid = *g == 0,
            WordKind::G(g) => is_incremental = *g == 91,
            WordKind::Feed(value) => feed_mm_min = Some(feed(value, &mut values).map_err(at)?),
            WordKind::Place(value) => place = Some(value.value(&mut values).map_err(at)?),
            _ => {
                let function = function(word, Some(&target), &mut values);
                unit.functions
                    .push(function.map_err(|wrong| Wrong::Place(wrong.at(word)))?);
            }
        }
    }
    if !is_independent {
        return Ok(());
    }
    let Some(place) = place else {
        return Err(format!("{axis}[INDP] needs POS").into());
    };
    if draft.axes[axis].is_some() {
        return Err(format!("{axis} moves on its own and with the path in one block").into());
    }
    let feed_mm_min = match feed_mm_min.or(state.modal.feed_mm_min) {
        Some(feed) => feed,
        None if rapid => 0.0,
        None => return Err(format!("{axis}[INDP] needs FEED").into()),
    };
    let from = if is_incremental {
        known(&state.begin(), axis)
    } else {
        0.0
    };
    let end = from + place;
    state.position[axis] = end;
    if let Some(increments_from) = &mut state.increments_from {
        increments_from[axis] = end;
    }
    unit.commands.push(Command::Independent(Independent {
        axis,
        end,
        rapid,
        feed_mm_min,
    }));
    Ok(())
}

/// Where an axis stands; one that was never programmed stands at 0 (inferred).
fn known(position: &Position, axis: Axis) -> f64 {
    position.get(axis).unwrap_or_default()
}

/// The time of G04, which stands alone in its block (public).
fn dwells(dwell: Dwell, draft: &Draft, block: &Block, unit: &mut Unit) -> Result<(), LineFault> {
    let lone = |word: &&Word| {
        !matches!(
            word.kind,
            WordKind::G(4) | WordKind::Bare(_) | WordKind::Axis(Axis::X, _)
        )
    };
    if let Some(word) = block.words.iter().find(lone) {
        return Err(fault_at(
            word.column,
            word.length,
            "G04 stands alone in its block".into(),
        ));
    }
    let wrong = |message: &str| Err(fault_at(dwell.column, dwell.length, message.into()));
    match (dwell.seconds, draft.axes[Axis::X].map(|(value, _)| value)) {
        (Some(_), Some(_)) => wrong("G04 has its time twice"),
        (None, None) => wrong("G04 needs its time"),
        (Some(seconds), None) | (None, Some(seconds)) if seconds >= 0.0 => {
            unit.dwell_s = seconds;
            Ok(())
        }
        _ => wrong("the time of G04 is less than 0"),
    }
}

/// The motion of a block; `None` where no axis moves.
fn motion(state: &mut State, draft: &Draft, block: &Block) -> Result<Option<Motion>, LineFault> {
    let modal = state.modal;
    let programmed: Vec<(Axis, f64)> = Axis::ALL
        .into_iter()
        .filter_map(|axis| draft.axes[axis].map(|(value, _)| (axis, value)))
        .collect();
    let of = |pleases: &dyn Fn(&WordKind) -> bool| block.words.iter().find(|word| pleases(&word.kind));
    let wrong = |word: Option<&Word>, message: String| {
        let (column, length) = word.map_or((1, 1), |word| (word.column, word.length));
        Err(fault_at(column, length, message))
    };
    let centre_word = of(&|kind| matches!(kind, WordKind::Centre(..) | WordKind::Radius(_)));
    let is_circle = matches!(modal.path, Path::Circle(_));
    if !is_circle && let Some(word) = centre_word {
        return wrong(Some(word), "I, J, K and R belong to G02 and G03".into());
    }
    if programmed.is_empty() && centre_word.is_none() {
        return Ok(None);
    }
    let first = of(&|kind| {
        matches!(
            kind,
            WordKind::Axis(..) | WordKind::Centre(..) | WordKind::Radius(_)
        )
    });
    let (mut begin, mut start) = (state.begin(), state.position);
    let mut end = start;
    for (axis, value) in programmed {
        start[axis] = known(&start, axis);
        end[axis] = if modal.is_incremental {
            known(&begin, axis) + value
        } else {
            value
        };
        if !end[axis].is_finite() {
            return wrong(first, format!("{axis} has no place"));
        }
    }
    let curve = match modal.path {
        Path::Rapid | Path::Line => Curve::Line,
        Path::Circle(sense) => {
            for axis in [modal.plane.first, modal.plane.second] {
                start[axis] = known(&start, axis);
                begin[axis] = known(&begin, axis);
                if draft.axes[axis].is_none() {
                    end[axis] = begin[axis];
                }
            }
            let centre = match (draft.centre, draft.radius) {
                (Some(ijk), None) => Centre::FromStart(ijk),
                (None, Some(radius)) => Centre::Radius(radius),
                (Some(_), Some(_)) => return wrong(centre_word, "R beside I, J, K".into()),
                (None, None) => return wrong(first, "G02 and G03 need I, J, K or R".into()),
            };
            let curve = circle::arc(modal.plane, &begin, &end, centre, sense);
            match curve {
                Ok(curve) => curve,
                Err(message) => return wrong(centre_word, message),
            }
        }
    };
    state.position = end;
    state.increments_from = None;
    let moves = curve.length(&start, &end) > 0.0 || curve.rotary_length(&start, &end) > 0.0;
    if !moves {
        return Ok(None);
    }
    let rapid = modal.path == Path::Rapid;
    let feed_mm_min = match modal.feed_mm_min {
        Some(feed) => feed,
        None if rapid => 0.0,
        None => return wrong(first, "no feed F is programmed".into()),
    };
    Ok(Some(Motion {
        curve,
        begin,
        start,
        end,
        rapid,
        feed_mm_min,
    }))
}
