//! The short cut of plain lines, which most blocks of a long program are: G1 with axes and F as numbers, while nothing but the
//! shifts of the axes acts on them. All other blocks, and those that say something wrong, go the way of all.

use bahn_din::system900::{Block, Value, WordKind};
use bahn_path::{Curve, FeedRate};

use crate::axes::ChannelAxes;
use crate::refusal::Refusal;
use crate::run::{Extra, Run};

/// Executes a block that is a plain line; `false` leaves it, and the run as it was. Fails where a contour before it does not end.
pub(crate) fn execute(block: &Block, run: &mut Run, axes: &ChannelAxes) -> Result<bool, Refusal> {
    let modal = &run.modal;
    if !modal.is_straight() {
        return Ok(false);
    }
    let (mut motion, mut feed, mut end) = (modal.motion, modal.feed, run.here);
    for word in &block.words {
        match word.kind {
            WordKind::G(1) => motion = 1,
            WordKind::Axis(name, Value::Number(number)) => {
                let Some(axis) = axes.named(name) else {
                    return Ok(false);
                };
                end[axis.slot] = modal.axis_end(axis.slot, number.value(), run.here[axis.slot]);
            }
            WordKind::Feed(Value::Number(number)) => feed = number.value(),
            _ => return Ok(false),
        }
    }
    let Some(acting) = modal
        .feeds
        .acting(feed)
        .filter(|_| motion == 1 && end != run.here)
    else {
        return Ok(false);
    };
    (run.modal.motion, run.modal.feed) = (motion, feed);
    run.push(Curve::Line, end, FeedRate::Programmed(acting), Extra::default())?;
    Ok(true)
}
