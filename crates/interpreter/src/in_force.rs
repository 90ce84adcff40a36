//! The functions in force of languages with G functions: what their blocks leave open is filled in here.

use bahn_parameters::MessageId;
use bahn_program::{
    Compensation, Direction, Distance, Feed, ModalBlock, Modality, Motion, MotionKind, Operation,
    PathFunction,
};

use crate::error::Fault;
use crate::execute::execute;
use crate::flow::Flow;
use crate::positioning::{take_compensation, take_feed};
use crate::run::Run;
use crate::settings::Settings;
use crate::tools::set_tool_axis;

/// The G functions in force. A run begins with G01 and G90 (inferred).
#[derive(Clone, Copy, Debug)]
pub(crate) struct InForce {
    pub function: PathFunction,
    pub distance: Distance,
    /// Of the last G02, G03, G12 or G13.
    pub direction: Option<Direction>,
}

impl Default for InForce {
    fn default() -> InForce {
        InForce {
            function: PathFunction::Line,
            distance: Distance::Absolute,
            direction: None,
        }
    }
}

impl InForce {
    /// Takes the path function of a block.
    fn take(&mut self, modality: &Modality) {
        let Some(function) = modality.function else {
            return;
        };
        self.function = function;
        match function {
            PathFunction::Clockwise | PathFunction::PolarClockwise => {
                self.direction = Some(Direction::Clockwise);
            }
            PathFunction::CounterClockwise | PathFunction::PolarCounterClockwise => {
                self.direction = Some(Direction::CounterClockwise);
            }
            _ => {}
        }
    }

    /// Whether a block that is executed next moves on a straight line of its own, when this one is executed now.
    #[inline]
    pub fn line_follows(&self, now: &Operation, next: &Motion) -> bool {
        let Some(next) = next.modal else {
            return next.kind == MotionKind::Line;
        };
        let function = next.function.or_else(|| {
            let parts = now.parts().iter().rev();
            parts.into_iter().find_map(|part| match part {
                Operation::Motion(motion) => motion.modal.and_then(|modal| modal.function),
                _ => None,
            })
        });
        matches!(
            function.unwrap_or(self.function),
            PathFunction::Rapid | PathFunction::Line
        )
    }
}

/// A positioning block with all that the functions in force say; they are those behind it then.
fn resolved(in_force: &mut InForce, motion: &Motion, modality: &Modality) -> Result<Motion, Fault> {
    in_force.take(modality);
    let function = in_force.function;
    let mut motion = motion.clone();
    motion.modal = None;
    if in_force.distance == Distance::Incremental {
        motion.coordinates.make_incremental(modality.open);
        let polar = [
            (&mut motion.polar_radius, modality.open_radius),
            (&mut motion.polar_angle, modality.open_angle),
        ];
        for (word, open) in polar {
            if let Some(word) = word.as_mut().filter(|_| open) {
                word.incremental = true;
            }
        }
    }
    if let Some(distance) = modality.distance {
        in_force.distance = distance;
    }
    let polar = motion.polar_radius.is_some() || motion.polar_angle.is_some();
    motion.kind = match function.kind() {
        // Without a word that belongs to it a block moves on a line, if at all.
        MotionKind::LinePolar if !polar => MotionKind::Line,
        _ if !polar && motion.coordinates.is_empty() => MotionKind::Line,
        MotionKind::Circle if motion.polar_radius.is_some() => MotionKind::CircleRadius,
        kind => kind,
    };
    match motion.kind {
        MotionKind::CircleRadius => motion.radius = motion.polar_radius.take().map(|word| word.value),
        MotionKind::Line | MotionKind::CircleTangential | MotionKind::Circle | MotionKind::Paraxial
            if polar =>
        {
            let detail = "R and H belong to polar functions, R to arcs as well";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        MotionKind::Paraxial if motion.coordinates.axes().len() > 1 => {
            return Err(Fault::new(MessageId::EntryValueIncorrect, "G07 moves one axis"));
        }
        _ => {}
    }
    if matches!(
        motion.kind,
        MotionKind::Circle | MotionKind::CircleRadius | MotionKind::CirclePolar
    ) {
        motion.direction = in_force.direction;
    }
    Ok(motion)
}

/// A positioning block of a language with G functions.
pub(crate) fn execute_motion(
    run: &mut Run,
    motion: &Motion,
    modality: &Modality,
    settings: &Settings,
) -> Result<Flow, Fault> {
    take_plane(run, modality)?;
    let mut motion = resolved(&mut run.modal.in_force, motion, modality)?;
    let rapid = run.modal.in_force.function.is_rapid();
    if rapid && matches!(motion.feed, Some(Feed::Value(_))) {
        // The feed counts from the next block on that is not in rapid traverse.
        take_feed(&mut run.modal, &run.numbers, settings, motion.feed)?;
    }
    let stands =
        motion.coordinates.is_empty() && motion.polar_radius.is_none() && motion.polar_angle.is_none();
    if stands && motion.m.is_empty() {
        // What only sets functions in force is no positioning block that M89 would call a cycle behind.
        if run.modal.in_force.function == PathFunction::Paraxial
            || matches!(
                motion.compensation,
                Some(Compensation::Lengthen | Compensation::Shorten)
            )
        {
            motion.kind = MotionKind::Paraxial;
        }
        take_compensation(&mut run.modal, &mut run.numbers.q, &motion)?;
        take_feed(&mut run.modal, &run.numbers, settings, motion.feed)?;
        return Ok(Flow::Next);
    }
    if rapid {
        motion.feed = Some(Feed::Max);
    }
    execute(run, &Operation::Motion(motion), settings)
}

/// A block that does several things; the first that leads elsewhere ends it.
pub(crate) fn execute_block(run: &mut Run, block: &ModalBlock, settings: &Settings) -> Result<Flow, Fault> {
    take_plane(run, &block.modality)?;
    let before = run.modal.in_force.distance;
    if let Some(distance) = block.modality.distance {
        run.modal.in_force.distance = distance;
    }
    for operation in block.resolved(before) {
        let flow = execute(run, &operation, settings)?;
        if flow != Flow::Next {
            return Ok(flow);
        }
    }
    Ok(Flow::Next)
}

/// G17 to G19 without a tool call choose the tool axis where it is another one (inferred).
fn take_plane(run: &mut Run, modality: &Modality) -> Result<(), Fault> {
    let Some(axis) = modality.plane else {
        return Ok(());
    };
    if axis == run.modal.plane.normal {
        return Ok(());
    }
    run.pen.finish_contour()?;
    set_tool_axis(&mut run.modal, &mut run.numbers, axis)
}
