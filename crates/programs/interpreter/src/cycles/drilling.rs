//! Cycles 1, 2, 17 and 18: pecking, tapping, rigid tapping, thread cutting.
//!
//! Decision: The spindle is stopped and oriented before cycle 18 as before cycle 17, so that cuts follow each other
//! in one groove

use bahn_parameters::MessageId;
use bahn_path::{OverrideLaw, Sense, SpindleOrder, Thread};

use super::machining::{Heights, Machining, Tracer, infeeds};
use crate::definition::Definition;
use crate::error::Fault;
use crate::settings::Settings;
use crate::status::Spindle;

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

/// Cycle 1 PECKING: feed to the first infeed, rapid back to the start, rapid down to the advanced stop
/// distance, feed to the next infeed ..., dwell at the bottom, rapid back [003:4918-4948].
pub(super) fn pecking(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let setup = definition.length(1, 0)?;
    let depth = definition.length(2, 0)?;
    let pecking = definition.length(3, 0)?;
    let dwell = definition.dwell(4, m.settings)?;
    let feed = definition.feed(5, 0)?;
    let heights = m.heights(definition, [setup, depth], Some(pecking))?;
    let scale = heights.depth / depth.abs();
    let mut trace = m.tracer();
    peck(
        &mut trace,
        &heights,
        &infeeds(heights.depth, pecking * scale),
        feed,
        dwell,
    );
    trace.finish()
}

/// Cycle 2 TAPPING with floating holder: down in one pass; M05 so early that the spindle stands at the
/// bottom, dwell (MP7120.0), M04, the programmed dwell, back with the same feed (inferred); above M05 and M03
/// again. With M04 the other way round [003:4994-5062] [000:6060-6116].
pub(super) fn tapping(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let setup = definition.length(1, 0)?;
    let depth = definition.length(2, 0)?;
    let dwell = definition.dwell(3, m.settings)?;
    let feed = definition.feed(4, 0)?;
    let heights = m.heights(definition, [setup, depth], None)?;
    let clockwise = !matches!(m.modal.spindle, Spindle::CounterClockwise);
    let mut orders = [SpindleOrder::Clockwise, SpindleOrder::CounterClockwise];
    if !clockwise {
        orders.reverse();
    }
    let [forward, back] = orders;
    let rules = &m.settings.rules.tapping;
    let lead_s = rules
        .spindle
        .map_or(0.0, |spindle| spindle.tapping_lead_s(m.modal.speed_rpm));
    let [from_percent, to_percent] = rules.override_percent;
    let mut trace = m.tracer();
    trace.set_override_law(OverrideLaw::Tapping {
        from_percent,
        to_percent,
    });
    trace.order_before_end(SpindleOrder::Stop, lead_s);
    trace.feed_height(heights.at_depth(heights.depth), feed);
    trace.dwell(rules.reversal_dwell_s);
    trace.order(back);
    trace.dwell(dwell);
    trace.feed_height(heights.clearance, feed);
    trace.set_override_law(OverrideLaw::Free);
    trace.order(SpindleOrder::Stop);
    trace.order(forward);
    trace.finish()
}

/// How the spindle turns into the workpiece: a right-hand thread has a positive pitch.
fn into_workpiece(pitch: f64) -> Sense {
    if pitch > 0.0 {
        Sense::Clockwise
    } else {
        Sense::CounterClockwise
    }
}

/// Cycle 17 RIGID TAPPING: the tool axis follows the spindle down and up, F = S · pitch. The spindle stops
/// (M05, inferred: it turns by the cycle alone) and is oriented first, so that a thread can be cut again
/// (MP7160). It stands after the cycle, until M03 or M04 (inferred) [003:5071-5106] [000:6118-6141].
pub(super) fn rigid_tapping(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let setup = definition.length(1, 0)?;
    let depth = definition.length(2, 0)?;
    let pitch = definition.length(3, 0)?;
    let heights = m.heights(definition, [setup, depth], None)?;
    let feed = thread_feed(m, pitch)?;
    let spindle = into_workpiece(pitch);
    let thread = Thread {
        pitch_mm: pitch.abs(),
        spindle,
        orientation_deg: orientation_deg(m.settings),
        retracts: true,
    };
    let mut trace = begin_thread(m);
    trace.set_override_law(OverrideLaw::Spindle(thread));
    trace.feed_height(heights.at_depth(heights.depth), feed);
    trace.set_override_law(OverrideLaw::Spindle(Thread {
        spindle: spindle.opposite(),
        orientation_deg: None,
        ..thread
    }));
    trace.feed_height(heights.clearance, feed);
    trace.finish()
}

/// Cycle 18 THREAD CUTTING: from where the tool stands to DEPTH from there the tool axis follows the spindle, which
/// then stands. Tool and spindle stay there: the way to the next cut is programmed [000:6143-6145]. Spindle and angle
/// before it are those of cycle 17 (inferred), so that one cut follows the other in the same groove.
pub(super) fn thread_cutting(m: &mut Machining<'_>, definition: &Definition) -> Result<(), Fault> {
    let depth = definition.length(1, 0)?;
    let pitch = definition.length(2, 0)?;
    let heights = m.heights(definition, [0.0, depth], None)?;
    let feed = thread_feed(m, pitch)?;
    let into = into_workpiece(pitch);
    let thread = Thread {
        pitch_mm: pitch.abs(),
        // M03 into the workpiece cuts a right-hand thread, and M04 away from it (later controls).
        spindle: if heights.direction < 0.0 {
            into
        } else {
            into.opposite()
        },
        orientation_deg: orientation_deg(m.settings),
        retracts: false,
    };
    let mut trace = begin_thread(m);
    trace.set_override_law(OverrideLaw::Spindle(thread));
    trace.feed_height(heights.at_depth(heights.depth), feed);
    trace.finish()
}

/// F = S · pitch.
fn thread_feed(m: &Machining<'_>, pitch: f64) -> Result<f64, Fault> {
    let feed = m.modal.speed_rpm * pitch.abs();
    if feed <= 0.0 {
        let detail = "a thread needs a spindle speed and a pitch";
        return Err(Fault::new(MessageId::WrongRpm, detail));
    }
    Ok(feed)
}

/// MP7160: the spindle is oriented before the thread.
fn orientation_deg(settings: &Settings) -> Option<f64> {
    settings.rules.tapping.orients.then_some(0.0)
}

/// A spindle that turns is stopped before the thread.
fn begin_thread<'a>(m: &'a mut Machining<'_>) -> Tracer<'a> {
    let turns = matches!(m.modal.spindle, Spindle::Clockwise | Spindle::CounterClockwise);
    if turns {
        m.modal.stop_spindle(m.q);
    }
    let mut trace = m.tracer();
    if turns {
        trace.order(SpindleOrder::Stop);
    }
    trace
}
