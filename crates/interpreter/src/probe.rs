//! Touch probe blocks: measuring in the program.

use bahn_parameters::MessageId;
use bahn_path::{Axis, Barrier, Curve, FeedRate, LiveData, Position};
use bahn_program::{CycleBlock, Direction};

use crate::availability::Feature;
use crate::definition::{Resolved, resolve};
use crate::error::Fault;
use crate::modal::ReferencePlane;
use crate::q_parameters::preassigned;
use crate::run::{Probing, Run};
use crate::settings::{ProbeRules, Settings};

impl Run {
    /// TCH PROBE 0.0 and 0.1, the measuring function.
    pub(crate) fn probe(&mut self, block: &CycleBlock, settings: &Settings) -> Result<(), Fault> {
        if !self.executes(Feature::Probe(block.number), settings)? {
            return Ok(());
        }
        let words = resolve(block, &self.numbers, settings)?;
        match block.sub {
            0 => self.reference_plane(&words),
            1 => self.start_probing(&words, settings),
            _ => Err(Fault::new(
                MessageId::CyclIncomplete,
                "TCH PROBE 0 has two blocks",
            )),
        }
    }

    fn reference_plane(&mut self, words: &[Resolved]) -> Result<(), Fault> {
        let target = words.iter().find_map(|word| match word {
            Resolved::Target(number) => Some(*number),
            _ => None,
        });
        let direction = words.iter().find_map(|word| match word {
            Resolved::AxisDirection(axis, Direction::Clockwise) => Some((*axis, -1.0)),
            Resolved::AxisDirection(axis, _) => Some((*axis, 1.0)),
            _ => None,
        });
        let (Some(target), Some((axis, direction))) = (target, direction) else {
            let detail = "TCH PROBE 0.0 needs a Q parameter and an axis with direction";
            return Err(Fault::new(MessageId::CyclIncomplete, detail));
        };
        self.numbers.q.get(target)?;
        self.modal.probe = Some(ReferencePlane {
            target,
            axis,
            direction,
        });
        Ok(())
    }

    /// TCH PROBE 0.1: in rapid to a point MP6140 before the nominal point, then with probing feed until
    /// the stylus is deflected (inferred from MP6120-MP6150) [003:4401-4432].
    fn start_probing(&mut self, words: &[Resolved], settings: &Settings) -> Result<(), Fault> {
        let Some(plane) = self.modal.probe.take() else {
            return Err(Fault::new(MessageId::CyclIncomplete, "TCH PROBE 0.0 is missing"));
        };
        let rules = &settings.rules.probe;
        self.pen.finish_contour()?;
        if !settings.rules.probe_keeps_tool {
            self.take_probe_as_tool(rules);
        }
        let frame = self.modal.frame;
        let mut nominal = frame.to_programmed(&self.modal.nominal);
        for word in words {
            if let Resolved::Coordinate {
                axis,
                value,
                incremental,
            } = word
            {
                let value = value * self.numbers.axis_unit(*axis);
                nominal[*axis] = if *incremental {
                    crate::numbers::known(nominal[*axis]) + value
                } else {
                    value
                };
            }
        }
        if nominal.get(plane.axis).is_none() {
            let detail = format!("the position to probe has no {}", plane.axis);
            return Err(Fault::new(MessageId::CyclIncomplete, detail));
        }
        let mut before = nominal;
        before[plane.axis] -= plane.direction * rules.clearance_mm;
        let mut farthest = before;
        farthest[plane.axis] += plane.direction * rules.range_mm.max(rules.clearance_mm);
        let (before, farthest) = (frame.to_outer(&before), frame.to_outer(&farthest));
        self.approach_probe_point(&before, settings);
        self.modal.feed_mm_min.get_or_insert(rules.feed_mm_min);
        self.modal.actual = before;
        self.modal.nominal = before;
        self.modal.last_move = None;
        self.probing = Some(Probing {
            axis: plane.axis,
            target: plane.target,
            direction: plane.direction,
            radius: rules.radius_mm,
            before,
        });
        self.pen.out.barrier(Barrier::Probe {
            block: self.pen.block,
            from: before,
            to: farthest,
            feed_mm_min: rules.feed_mm_min,
            stylus_radius: rules.radius_mm,
        });
        Ok(())
    }

    /// MP7411 = 0: the tool data are overwritten with those of the calibrated probe [003:7365-7369].
    fn take_probe_as_tool(&mut self, rules: &ProbeRules) {
        if let Some(tool) = &mut self.modal.tool {
            tool.radius = rules.radius_mm;
            tool.shape.radius = rules.radius_mm;
            tool.shape.length = rules.length_mm;
        }
        self.numbers.q.preassign(
            preassigned::TOOL_RADIUS,
            rules.radius_mm / self.numbers.main_unit_mm(),
        );
        self.numbers.q.preassign(
            preassigned::TOOL_LENGTH,
            rules.length_mm / self.numbers.main_unit_mm(),
        );
    }

    /// In the working plane first when the tool axis goes down, the tool axis first when it goes up, so
    /// that the stylus does not meet the workpiece on its way.
    fn approach_probe_point(&mut self, before: &Position, settings: &Settings) {
        let normal = self.modal.plane.normal;
        let from = self.modal.actual;
        let up = before[normal] > from[normal];
        let mut corner = *before;
        if up {
            corner = from;
            corner[normal] = before[normal];
        } else if !from[normal].is_nan() {
            corner[normal] = from[normal];
        }
        let feed = FeedRate::Programmed(settings.rules.probe.rapid_mm_min);
        for (start, end) in [(from, corner), (corner, *before)] {
            if start != end {
                let element = self.pen.element(Curve::Line, start, end, feed);
                self.pen.out.push(element, None);
            }
        }
        self.pen.since_motion = 0;
    }

    /// Takes the touch: the measured coordinate goes to the Q parameter, the position to Q115-Q118.
    pub(crate) fn finish_probing(&mut self, live: &LiveData, settings: &Settings) -> Result<(), Fault> {
        let Some(probing) = self.probing.take() else {
            return Ok(());
        };
        let Some(touch) = live.touch else {
            return Err(MessageId::TouchPointInaccessible.into());
        };
        if touch.position == probing.before {
            return Err(MessageId::StylusAlreadyInContact.into());
        }
        let unit = self.numbers.unit_mm;
        let position = self.modal.frame.to_programmed(&touch.position);
        let along_tool_axis = probing.axis == self.modal.plane.normal;
        // In the tool axis the tip itself touches, in the plane the ball touches beside its centre.
        let surface = if along_tool_axis {
            0.0
        } else {
            probing.direction * probing.radius
        };
        self.numbers
            .q
            .set(probing.target, (position[probing.axis] + surface) / unit)?;
        for (number, axis) in (preassigned::TOUCH..).zip([Axis::X, Axis::Y, Axis::Z, Axis::C]) {
            if let Some(value) = position.get(axis) {
                self.numbers
                    .q
                    .preassign(number, value / self.numbers.axis_unit(axis));
            }
        }
        // To the surface and back to the pre-position.
        let feed = FeedRate::Programmed(settings.rules.probe.feed_mm_min);
        let back = FeedRate::Programmed(settings.rules.probe.rapid_mm_min);
        let ways = [
            (probing.before, touch.position, feed),
            (touch.position, probing.before, back),
        ];
        // On a machine the axes stand at the touch already.
        for (start, end, feed) in ways.into_iter().skip(usize::from(settings.machine)) {
            let element = self.pen.element(Curve::Line, start, end, feed);
            self.pen.out.push(element, None);
        }
        Ok(())
    }
}
