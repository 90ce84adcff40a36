//! Cycles 1, 2 and 17: pecking, tapping, rigid tapping.

use bahn_parameters::MessageId;
use bahn_path::{Function, OverrideLaw};

use super::Definition;
use super::machining::{Heights, Tracer, infeeds};
use crate::error::Fault;
use crate::modal::Spindle;
use crate::run::Run;
use crate::settings::Settings;

/// Advanced stop distance of pecking, mm: 0.6 up to a depth of 30 mm, then depth/50, at most 7
/// [003:4943-4948].
fn advanced_stop(depth: f64) -> f64 {
    if depth <= 30.0 {
        0.6
    } else {
        (depth / 50.0).min(7.0)
    }
}

/// Pecks a hole where the tool stands.
pub(super) fn peck(trace: &mut Tracer<'_>, heights: &Heights, depths: &[f64], feed: f64, dwell: f64) {
    let stop = advanced_stop(heights.depth);
    let mut reached: Option<f64> = None;
    for depth in depths {
        if trace.is_full() {
            return;
        }
        if let Some(before) = reached {
            trace.rapid_height(heights.clearance);
            // Never above the start: a short first infeed leaves no room for the whole distance.
            let down = heights.at_depth(before - stop);
            let above_start = (down - heights.clearance) * heights.direction < 0.0;
            trace.rapid_height(if above_start { heights.clearance } else { down });
        }
        trace.feed_height(heights.at_depth(*depth), feed);
        reached = Some(*depth);
    }
    trace.dwell(dwell);
    trace.rapid_height(heights.clearance);
}

impl Run {
    /// Cycle 1 PECKING: feed to the first infeed, rapid back to the start, rapid down to the advanced stop
    /// distance, feed to the next infeed ..., dwell at the bottom, rapid back [003:4918-4948].
    pub(super) fn pecking(&mut self, definition: &Definition, settings: &Settings) -> Result<(), Fault> {
        let setup = definition.length(1, 0, "SETUP")?;
        let depth = definition.length(2, 0, "DEPTH")?;
        let pecking = definition.length(3, 0, "PECKG")?;
        let dwell = definition.dwell(4, settings)?;
        let feed = definition.feed(5, 0, "F")?;
        let heights = self.heights(definition, [setup, depth], Some(pecking), settings)?;
        let scale = heights.depth / depth.abs();
        let mut trace = self.tracer();
        peck(
            &mut trace,
            &heights,
            &infeeds(heights.depth, pecking * scale),
            feed,
            dwell,
        );
        trace.finish()
    }

    /// Cycle 2 TAPPING with floating holder: down in one pass, the spindle reverses at the bottom, dwell,
    /// back with the same feed (inferred), the spindle reverses again [003:4994-5062].
    pub(super) fn tapping(&mut self, definition: &Definition, settings: &Settings) -> Result<(), Fault> {
        let setup = definition.length(1, 0, "SETUP")?;
        let depth = definition.length(2, 0, "DEPTH")?;
        let dwell = definition.dwell(3, settings)?;
        let feed = definition.feed(4, 0, "F")?;
        let heights = self.heights(definition, [setup, depth], None, settings)?;
        let clockwise = !matches!(self.modal.spindle, Spindle::CounterClockwise);
        let (forward, back) = if clockwise { (3, 4) } else { (4, 3) };
        let (from_percent, to_percent) = settings.rules.tapping_override_percent;
        let mut trace = self.tracer();
        trace.set_override_law(OverrideLaw::Limited {
            from_percent,
            to_percent,
        });
        trace.feed_height(heights.at_depth(heights.depth), feed);
        trace.function(Function::M(back));
        trace.dwell(dwell);
        trace.feed_height(heights.clearance, feed);
        trace.function(Function::M(forward));
        trace.finish()
    }

    /// Cycle 17 RIGID TAPPING: the feed follows the spindle, F = S · pitch; the spindle is oriented first so
    /// that a thread can be cut again (MP7160) [003:5071-5106].
    pub(super) fn rigid_tapping(
        &mut self,
        definition: &Definition,
        settings: &Settings,
    ) -> Result<(), Fault> {
        let setup = definition.length(1, 0, "SETUP")?;
        let depth = definition.length(2, 0, "DEPTH")?;
        let pitch = definition.length(3, 0, "PITCH")?;
        let heights = self.heights(definition, [setup, depth], None, settings)?;
        let feed = self.modal.speed_rpm * pitch.abs();
        if feed <= 0.0 {
            return Err(Fault::new(
                MessageId::WrongRpm,
                "rigid tapping needs a spindle speed and a pitch",
            ));
        }
        let orient = settings.rules.orient_before_rigid_tapping;
        let mut trace = self.tracer();
        if orient {
            trace.function(Function::SpindleOrientation(0.0));
        }
        trace.set_override_law(OverrideLaw::Disabled);
        trace.feed_height(heights.at_depth(heights.depth), feed);
        trace.feed_height(heights.clearance, feed);
        trace.finish()
    }
}
