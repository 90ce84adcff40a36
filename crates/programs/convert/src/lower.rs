//! A block of a language with G functions as the operations of one that says all itself, in the order in which a run
//! executes them.

use bahn_path::Axis;
use bahn_program::{
    Compensation, Distance, Feed, InForce, Modality, Motion, MotionKind, Operation, PathFunction,
};

/// What is in force before a block, with the tool axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct State {
    pub in_force: InForce,
    pub plane: Axis,
}

impl Default for State {
    fn default() -> State {
        State {
            in_force: InForce::default(),
            plane: Axis::Z,
        }
    }
}

/// Why a block has no operations of its own.
pub(crate) type Reason = &'static str;

/// Takes what a block says into `state` and adds what it does.
pub(crate) fn lower(
    operation: &Operation,
    state: &mut State,
    done: &mut Vec<Operation>,
) -> Result<(), Reason> {
    match operation {
        Operation::Motion(motion) => match &motion.modal {
            Some(modality) => movement(motion, modality, state, done)?,
            None => done.push(operation.clone()),
        },
        Operation::Modal(block) => {
            take_plane(&block.modality, state)?;
            let before = state.in_force.distance;
            if let Some(distance) = block.modality.distance {
                state.in_force.distance = distance;
            }
            for part in block.resolved(before) {
                lower(&part, state, done)?;
            }
        }
        Operation::ToolCall { axis: Some(axis), .. } => {
            state.plane = *axis;
            done.push(operation.clone());
        }
        other => done.push(other.clone()),
    }
    Ok(())
}

fn take_plane(modality: &Modality, state: &State) -> Result<(), Reason> {
    match modality.plane {
        Some(axis) if axis != state.plane => Err("plain language chooses the tool axis with a tool only"),
        _ => Ok(()),
    }
}

/// As a run executes it: F of a block in rapid traverse counts from the next movement with a feed on; a block that only
/// sets functions is no movement.
fn movement(
    motion: &Motion,
    modality: &Modality,
    state: &mut State,
    done: &mut Vec<Operation>,
) -> Result<(), Reason> {
    take_plane(modality, state)?;
    let mut motion = state.in_force.resolve(motion, modality)?;
    let rapid = state.in_force.function.is_rapid();
    let stands =
        motion.coordinates.is_empty() && motion.polar_radius.is_none() && motion.polar_angle.is_none();
    if stands && motion.m.is_empty() {
        let paraxial = matches!(
            motion.compensation,
            Some(Compensation::Lengthen | Compensation::Shorten)
        );
        if paraxial || state.in_force.function == PathFunction::Paraxial {
            motion.kind = MotionKind::Paraxial;
        }
        if motion.compensation.is_some() || motion.feed.is_some() {
            done.push(Operation::Motion(motion));
        }
        return Ok(());
    }
    if rapid {
        if let Some(feed @ Feed::Value(_)) = motion.feed {
            done.push(Operation::Motion(Motion {
                feed: Some(feed),
                ..bare()
            }));
        }
        motion.feed = Some(Feed::Max);
    }
    done.push(Operation::Motion(motion));
    Ok(())
}

/// A line without words.
pub(crate) fn bare() -> Motion {
    Motion {
        kind: MotionKind::Line,
        coordinates: Default::default(),
        polar_radius: None,
        polar_angle: None,
        radius: None,
        direction: None,
        compensation: None,
        feed: None,
        normal: None,
        m: Default::default(),
        modal: None,
    }
}

/// What a block without functions in force counts from.
pub(crate) const ABSOLUTE: Modality = Modality {
    function: None,
    distance: Some(Distance::Absolute),
    plane: None,
    open: bahn_path::AxisSet::EMPTY,
    open_radius: false,
    open_angle: false,
};
