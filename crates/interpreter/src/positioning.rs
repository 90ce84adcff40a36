//! Positioning blocks: from words to a movement in workpiece coordinates.

use bahn_parameters::MessageId;
use bahn_path::{Arc, Axis, AxisSet, Curve, FeedRate, Position};
use bahn_program::{Compensation, Coordinates, Feed, Motion, MotionKind};

use crate::block_functions::{BlockFunctions, Reference};
use crate::error::{Cause, Fault, WarningKind};
use crate::flow::Flow;
use crate::modal::LastMove;
use crate::numbers::known;
use crate::q_parameters::preassigned;
use crate::run::Run;
use crate::settings::Settings;

/// A movement in programmed coordinates.
pub(crate) struct Programmed {
    pub from: Position,
    pub to: Position,
    /// Axes that the block moves.
    pub axes: AxisSet,
    pub curve: Curve,
}

impl Run {
    /// L, C, CR, CT, LP, CP, CTP and paraxial blocks; with it whether the block calls the cycle behind its movement.
    #[inline]
    pub(crate) fn positioning(
        &mut self,
        motion: &Motion,
        settings: &Settings,
    ) -> Result<(Flow, bool), Fault> {
        if self.is_short_way(motion) {
            return Ok((self.short_line(motion, settings)?, false));
        }
        self.any_positioning(motion, settings)
    }

    fn any_positioning(&mut self, motion: &Motion, settings: &Settings) -> Result<(Flow, bool), Fault> {
        if motion.kind == MotionKind::Paraxial && settings.rules.paraxial_inhibited {
            let detail = "MP7246 disables paraxial positioning blocks";
            return Err(Fault::new(MessageId::BlockNotKnown, detail));
        }
        self.take_compensation(motion)?;
        if self.pen.recording.is_some() {
            return Ok((self.record(motion, settings)?, false));
        }
        let functions = if motion.m.is_empty() && !self.modal.cycle_after_each_block {
            BlockFunctions::default()
        } else {
            self.take_m_functions(&motion.m, settings)?
        };
        let feed = self.take_feed(motion.feed, settings)?;
        let cycle_call = functions.cycle_call;
        let flow = self.movement(motion, functions, feed, settings)?;
        Ok((flow, cycle_call))
    }

    /// Whether a block is a straight line in absolute numbers that nothing in force changes and nothing
    /// that follows refers to: the most frequent block by far, and worth a way of its own.
    #[inline]
    fn is_short_way(&self, motion: &Motion) -> bool {
        let coordinates = &motion.coordinates;
        motion.kind == MotionKind::Line
            && self.pen.line_follows
            && self.modal.corner_arcs.is_none()
            && motion.m.is_empty()
            && matches!(motion.compensation, None | Some(Compensation::Off))
            && self.modal.compensation == Compensation::Off
            && self.modal.paraxial == Compensation::Off
            && coordinates.incremental().is_empty()
            && coordinates.parameters().is_empty()
            && !coordinates.is_empty()
            && !self.modal.cycle_after_each_block
            && self.modal.plunge_factor.is_none()
            && self.pen.recording.is_none()
            && self.modal.frame.is_identity()
            && self.pen.contour.is_idle()
    }

    /// The short way of [`Run::is_short_way`]: same result as the long one.
    #[inline]
    fn short_line(&mut self, motion: &Motion, settings: &Settings) -> Result<Flow, Fault> {
        let Some(feed) = self.take_feed(motion.feed, settings)? else {
            return Err(MessageId::FeedRateIsMissing.into());
        };
        let start = self.modal.actual;
        let numbers = motion.coordinates.numbers();
        let axes = motion.coordinates.axes();
        for axis in axes.iter() {
            let value = numbers[axis.index()] * self.numbers.axis_unit(axis);
            self.modal.nominal[axis] = value;
            self.modal.actual[axis] = value;
        }
        self.check_count(axes, settings)?;
        self.check_range(&self.modal.actual, axes, settings)?;
        if self.modal.contour_plane != self.modal.plane || !axes.intersection(PARALLEL_AXES).is_empty() {
            self.modal.take_contour_axes(axes);
        }
        self.modal.last_move = None;
        self.modal.increments_from = None;
        self.pen.contour.release(&mut self.pen.out);
        let end = self.modal.actual;
        self.pen.note_motion(Curve::Line, &start, &end);
        let element = self.pen.element(Curve::Line, start, self.modal.actual, feed);
        self.pen.out.push(element, None);
        Ok(Flow::Next)
    }

    /// A block of a contour subprogram: only its geometry counts.
    fn record(&mut self, motion: &Motion, settings: &Settings) -> Result<Flow, Fault> {
        /// Stands for the feed that is ignored.
        const ANY_FEED: FeedRate = FeedRate::Programmed(1.0);
        if let Some(axes) = &mut self.pen.recording
            && axes.is_empty()
        {
            *axes = motion.coordinates.axes();
        }
        self.movement(motion, BlockFunctions::default(), Some(ANY_FEED), settings)
    }

    fn movement(
        &mut self,
        motion: &Motion,
        functions: BlockFunctions,
        feed: Option<FeedRate>,
        settings: &Settings,
    ) -> Result<Flow, Fault> {
        let plain = motion.kind == MotionKind::Line
            && functions.reference == Reference::Datum
            && motion.coordinates.parameters().is_empty()
            && self.modal.frame.is_identity();
        let programmed = if plain {
            self.plain_line(&motion.coordinates)
        } else if functions.reference != Reference::Datum {
            return self.referenced_line(motion, functions, feed, settings);
        } else {
            self.programmed(motion, settings)?
        };
        if programmed.axes.is_empty() {
            return self.pen.hold(&self.modal, functions);
        }
        self.modal.increments_from = None;
        let Some(feed) = feed else {
            return Err(MessageId::FeedRateIsMissing.into());
        };
        self.check_count(programmed.axes, settings)?;
        self.check_range(&programmed.to, programmed.axes, settings)?;
        self.modal.last_move = Some(LastMove {
            curve: programmed.curve,
            start: programmed.from,
            end: programmed.to,
        });
        let (axes, nominal, curve) = if plain {
            (programmed.axes, programmed.to, programmed.curve)
        } else {
            self.to_workpiece(&programmed)?
        };
        let paraxial = if motion.kind == MotionKind::Paraxial {
            self.modal.paraxial
        } else {
            Compensation::Off
        };
        self.emit_movement(curve, nominal, axes, paraxial, feed, functions)
    }

    /// The fast way of most blocks: a straight line in plain numbers without transformations.
    #[inline]
    fn plain_line(&self, coordinates: &Coordinates) -> Programmed {
        let from = self.modal.nominal;
        let mut to = from;
        let axes = coordinates.axes();
        let numbers = coordinates.numbers();
        for axis in axes.iter() {
            let value = numbers[axis.index()] * self.numbers.axis_unit(axis);
            to[axis] = if coordinates.incremental().contains(axis) {
                known(self.modal.increments_from.unwrap_or(from)[axis]) + value
            } else {
                value
            };
        }
        Programmed {
            from,
            to,
            axes,
            curve: Curve::Line,
        }
    }

    fn programmed(&mut self, motion: &Motion, settings: &Settings) -> Result<Programmed, Fault> {
        let from = self.modal.frame.to_programmed(&self.modal.nominal);
        let mut p = Programmed {
            from,
            to: from,
            axes: AxisSet::EMPTY,
            curve: Curve::Line,
        };
        self.coordinates(&motion.coordinates, &mut p)?;
        match motion.kind {
            MotionKind::Line | MotionKind::Paraxial => {}
            MotionKind::LinePolar => self.line_polar(motion, &mut p, settings)?,
            MotionKind::Circle => self.circle(motion, &mut p, settings)?,
            MotionKind::CircleRadius => self.circle_radius(motion, &mut p, settings)?,
            MotionKind::CircleTangential => {
                let plane = self.plane_of(&motion.coordinates)?;
                p.curve = self.tangential(plane, &p)?;
            }
            MotionKind::CirclePolar => self.circle_polar(motion, &mut p, settings)?,
            MotionKind::CircleTangentialPolar => {
                let plane = self.polar_point(motion, &mut p, settings)?;
                p.curve = self.tangential(plane, &p)?;
            }
        }
        Ok(p)
    }

    /// Cartesian words into the end point.
    pub(crate) fn coordinates(&self, coordinates: &Coordinates, p: &mut Programmed) -> Result<(), Fault> {
        let from = match &self.modal.increments_from {
            Some(nominal) => self.modal.frame.to_programmed(nominal),
            None => p.from,
        };
        for (axis, word) in coordinates.iter() {
            let value = self.numbers.q.value(word.value)? * self.numbers.axis_unit(axis);
            p.to[axis] = if word.incremental {
                known(from[axis]) + value
            } else {
                value
            };
            p.axes.insert(axis);
        }
        Ok(())
    }

    /// M91, M92, M93: the coordinates refer to machine zero, machine datum or current position, whatever
    /// transformations are active [003:3533-3553] [003:7479-7481].
    fn referenced_line(
        &mut self,
        motion: &Motion,
        functions: BlockFunctions,
        feed: Option<FeedRate>,
        settings: &Settings,
    ) -> Result<Flow, Fault> {
        if !matches!(motion.kind, MotionKind::Line | MotionKind::Paraxial) {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                "M91 to M93 act on straight lines",
            ));
        }
        let mut nominal = self.modal.nominal;
        for (axis, word) in motion.coordinates.iter() {
            let value = self.numbers.q.value(word.value)? * self.numbers.axis_unit(axis);
            // Machine coordinates are those of the spindle nose, not of the tool's tip (inferred: a position
            // for tool changes must not depend on the tool).
            let length = match self.modal.tool {
                Some(tool) if tool.axis == axis => tool.shape.length,
                _ => 0.0,
            };
            let zero = settings.rules.machine_zero[axis] - length;
            if settings.machine && zero.is_nan() && functions.reference != Reference::Position {
                // On a machine its coordinates are known only after the reference marks [000:4568-4576].
                return Err(Fault::new(
                    MessageId::ProgramStartUndefined,
                    format!("{axis} has not passed its reference mark"),
                ));
            }
            nominal[axis] = match functions.reference {
                _ if word.incremental => known(nominal[axis]) + value,
                Reference::MachineZero => zero + value,
                Reference::MachineDatum => zero + settings.rules.machine_datum[axis] + value,
                Reference::Position | Reference::Datum => known(self.modal.actual[axis]) + value,
            };
        }
        let axes = motion.coordinates.axes();
        if axes.is_empty() {
            return self.pen.hold(&self.modal, functions);
        }
        let Some(feed) = feed else {
            return Err(MessageId::FeedRateIsMissing.into());
        };
        self.check_count(axes, settings)?;
        self.modal.last_move = None;
        let placed = nominal.known().intersection(axes);
        self.check_range(&nominal, placed, settings)?;
        if placed != axes {
            return self.leave_workpiece(nominal, axes, feed, functions);
        }
        self.emit_movement(Curve::Line, nominal, axes, Compensation::Off, feed, functions)
    }

    /// A movement to a place of the machine when nobody has said where the workpiece lies in it: the axes have
    /// no position until they are programmed again (inferred).
    fn leave_workpiece(
        &mut self,
        nominal: Position,
        axes: AxisSet,
        feed: FeedRate,
        functions: BlockFunctions,
    ) -> Result<Flow, Fault> {
        if !std::mem::replace(&mut self.told.machine_zero, true) {
            self.warn(WarningKind::MachineZeroUnknown);
        }
        self.pen.finish_contour()?;
        let start = self.pen.tool_centre(&self.modal);
        let mut end = start;
        for axis in axes.iter() {
            end[axis] = nominal[axis];
        }
        (self.modal.nominal, self.modal.actual) = (nominal, end);
        let element = self.pen.element(Curve::Line, start, end, feed);
        self.pen.push(&self.modal, element, functions, false)
    }

    /// Transforms a movement into workpiece coordinates. Axes that are neither programmed nor turned by
    /// the rotation keep their number to the last bit.
    fn to_workpiece(&self, p: &Programmed) -> Result<(AxisSet, Position, Curve), Fault> {
        let frame = &self.modal.frame;
        let mut axes = p.axes;
        let mut to = p.to;
        let turned = AxisSet::EMPTY.with(frame.plane.first).with(frame.plane.second);
        if frame.rotation_deg != 0.0 && !axes.intersection(turned).is_empty() {
            axes = axes.union(turned);
            for axis in turned.iter() {
                to[axis] = known(to[axis]);
            }
        }
        let outer = frame.to_outer(&to);
        let mut nominal = self.modal.nominal;
        for axis in axes.iter() {
            nominal[axis] = outer[axis];
        }
        let curve = match p.curve {
            Curve::Arc(arc) => Curve::Arc(self.arc_to_workpiece(&arc)?),
            other => other,
        };
        Ok((axes, nominal, curve))
    }

    fn arc_to_workpiece(&self, arc: &Arc) -> Result<Arc, Fault> {
        let frame = &self.modal.frame;
        let plane = arc.plane;
        let same_plane = frame.plane.contains(plane.first) && frame.plane.contains(plane.second);
        if frame.rotation_deg != 0.0 && !same_plane {
            let detail = "an arc outside the working plane cannot be rotated";
            return Err(Fault::new(MessageId::PlaneWronglyDefined, detail));
        }
        if frame.factor[plane.first].abs() != frame.factor[plane.second].abs() {
            return Err(Fault::new(
                MessageId::PlaneWronglyDefined,
                "scaling would make an ellipse of the arc",
            ));
        }
        let mut centre = Position::ZERO;
        plane.set(&mut centre, arc.centre);
        let sign = if frame.reverses(plane) { -1.0 } else { 1.0 };
        Ok(Arc {
            plane,
            centre: plane.point(&frame.to_outer(&centre)),
            sweep_deg: sign * arc.sweep_deg,
        })
    }

    /// Makes the element, with R+ and R- applied, and hands it on.
    fn emit_movement(
        &mut self,
        curve: Curve,
        nominal: Position,
        axes: AxisSet,
        paraxial: Compensation,
        feed: FeedRate,
        functions: BlockFunctions,
    ) -> Result<Flow, Fault> {
        let start = self.modal.actual;
        let mut end = start;
        for axis in axes.iter() {
            end[axis] = nominal[axis];
        }
        if paraxial != Compensation::Off {
            self.lengthen(paraxial, axes, &start, &mut end);
        }
        self.modal.take_contour_axes(axes);
        let plane = self.modal.contour_plane;
        let in_plane = axes.contains(plane.first) || axes.contains(plane.second);
        let feed = self.plunge_feed(feed, &curve, &start, &end);
        self.modal.nominal = nominal;
        self.modal.actual = end;
        let element = self.pen.element(curve, start, end, feed);
        self.pen.push(&self.modal, element, functions, in_plane)
    }

    /// R+ lengthens and R- shortens a paraxial path in the working plane by the tool radius
    /// [003:2046-2057]: target' = target ± R · sign(target - start) (inferred).
    fn lengthen(&self, compensation: Compensation, axes: AxisSet, start: &Position, end: &mut Position) {
        let amount = match compensation {
            Compensation::Lengthen => self.modal.tool_radius(),
            _ => -self.modal.tool_radius(),
        };
        for axis in axes
            .iter()
            .filter(|axis| self.modal.contour_plane.contains(*axis))
        {
            let path = end[axis] - known(start[axis]);
            if path != 0.0 {
                end[axis] += amount * path.signum();
            }
        }
    }

    /// M103: the feed component of the tool axis in negative direction is limited to the factor of the
    /// programmed feed [000:7278-7292].
    fn plunge_feed(&self, feed: FeedRate, curve: &Curve, start: &Position, end: &Position) -> FeedRate {
        let (Some(factor), FeedRate::Programmed(programmed)) = (self.modal.plunge_factor, feed) else {
            return feed;
        };
        let down = start[self.modal.plane.normal] - end[self.modal.plane.normal];
        let length = curve.length(start, end);
        if down > 0.0 && length > 0.0 {
            return FeedRate::Programmed(programmed.min(programmed * factor * length / down));
        }
        feed
    }

    fn take_compensation(&mut self, motion: &Motion) -> Result<(), Fault> {
        let Some(word) = motion.compensation else {
            return Ok(());
        };
        let paraxial = matches!(word, Compensation::Lengthen | Compensation::Shorten);
        let contour = matches!(word, Compensation::Left | Compensation::Right);
        if paraxial && motion.kind != MotionKind::Paraxial {
            return Err(Fault::new(
                MessageId::EntryValueIncorrect,
                "R+ and R- belong to paraxial blocks",
            ));
        }
        // R+/R- and RL/RR must not follow each other [000:7016-7030].
        if (paraxial && self.modal.compensation != Compensation::Off)
            || (contour && self.modal.paraxial != Compensation::Off)
        {
            return Err(MessageId::PathOffsetWronglyStarted.into());
        }
        if contour && self.modal.tool.is_none() {
            // Without a tool in the spindle there is no radius to compensate [003:7984-7986] (inferred).
            return Err(
                Fault::new(MessageId::ProgramStartUndefined, "no tool is called before")
                    .because(Cause::NoTool),
            );
        }
        if contour || paraxial {
            self.used_radius()?;
        }
        self.modal.compensation = if contour { word } else { Compensation::Off };
        self.modal.paraxial = if paraxial { word } else { Compensation::Off };
        let q123 = match word {
            Compensation::Off => 0.0,
            Compensation::Left => 1.0,
            Compensation::Right => 2.0,
            Compensation::Lengthen => 3.0,
            Compensation::Shorten => 4.0,
        };
        self.numbers.q.preassign(preassigned::COMPENSATION, q123);
        Ok(())
    }

    /// The feed of the block: FMAX for this block only, else the last numeric feed [003:2160-2166].
    fn take_feed(&mut self, feed: Option<Feed>, settings: &Settings) -> Result<Option<FeedRate>, Fault> {
        match feed {
            Some(Feed::Max) => return Ok(Some(FeedRate::Rapid)),
            Some(Feed::Value(value)) => {
                let feed = self.numbers.feed(value, settings)?;
                self.modal.feed_mm_min = Some(feed);
            }
            None => {}
        }
        let rapid = settings.model.limits().rapid_feed_mm_min;
        Ok(self.modal.feed_mm_min.filter(|feed| *feed > 0.0).map(|feed| {
            // On the TNC 151/155 the highest feed is rapid traverse [001:471].
            if rapid.is_some_and(|rapid| feed >= rapid) {
                FeedRate::Rapid
            } else {
                FeedRate::Programmed(feed)
            }
        }))
    }

    /// Refuses more axes than the control moves together [001:167-173] [003:7761-7763] [000:139]. No manual
    /// prints the message *(inferred)*.
    #[inline]
    fn check_count(&mut self, axes: AxisSet, settings: &Settings) -> Result<(), Fault> {
        let max = usize::from(settings.model.limits().line_axes_max);
        if axes.len() <= max {
            return Ok(());
        }
        let detail = format!(
            "{} axes in a block: this control moves {max} together",
            axes.len()
        );
        if settings.skip_unknown {
            self.warn(WarningKind::Function { text: detail });
            return Ok(());
        }
        Err(Fault::new(MessageId::WrongAxisProgrammed, detail))
    }

    fn check_range(&self, to: &Position, axes: AxisSet, settings: &Settings) -> Result<(), Fault> {
        let max = settings.model.limits().coordinate_max;
        // Written so that a value that is no number is refused too.
        match axes.iter().find(|axis| !(-max..=max).contains(&to[*axis])) {
            Some(axis) => {
                let detail = format!("{axis} is beyond {max}");
                Err(Fault::new(MessageId::EntryValueIncorrect, detail))
            }
            None => Ok(()),
        }
    }
}

/// Axes that may stand for their main axis in the working plane [003:5397-5432].
const PARALLEL_AXES: AxisSet = AxisSet::EMPTY.with(Axis::U).with(Axis::V).with(Axis::W);
