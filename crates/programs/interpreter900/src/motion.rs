//! Movements of a block.
//!
//! Decision: An exact stop is an element in which nothing moves. G0 ends with it where P8858 is not 2
//!
//! Decision: G10 counts radius and angle about the zero of the program

use bahn_path::{Axis, Curve, FeedRate, Position, Sense};

use crate::arc::{self, By};
use crate::g_functions::Once;
use crate::modal::{FeedKind, Modal};
use crate::refusal::{Refusal, wrong};
use crate::words::Words;

/// A movement that a block programs.
pub(crate) struct Movement {
    pub curve: Curve,
    pub end: Position,
    pub feed: FeedRate,
    /// The path comes to rest at its end.
    pub stops: bool,
}

/// Where the words of a block lead.
fn end(words: &Words, modal: &mut Modal, here: &Position) -> Position {
    if modal.rotation.is_none() && !modal.is_polar {
        let mut end = *here;
        for axis in Axis::ALL {
            if let Some(value) = words.axes[axis] {
                end[axis] = modal.axis_end(axis, value, here[axis]);
            }
        }
        return end;
    }
    let mut program = modal.to_program(here);
    for axis in Axis::ALL {
        if let Some(value) = words.axes[axis] {
            program[axis] = match modal.is_absolute {
                true => value,
                false => program[axis] + value,
            };
        }
    }
    let moves_in_plane = words.polar.iter().any(Option::is_some);
    if moves_in_plane {
        for (kept, said) in modal.polar.iter_mut().zip(words.polar) {
            *kept = match (said, modal.is_absolute) {
                (Some(value), true) => value,
                (Some(value), false) => *kept + value,
                (None, _) => *kept,
            };
        }
        let [radius, angle] = modal.polar;
        let (sin, cos) = angle.to_radians().sin_cos();
        modal.plane.set(&mut program, [radius * cos, radius * sin]);
    }
    let mut end = modal.to_machine(&program);
    let plane = modal.plane;
    let moves_in_plane = moves_in_plane
        || [plane.first, plane.second]
            .iter()
            .any(|axis| words.axes[*axis].is_some());
    for axis in Axis::ALL {
        let stays = words.axes[axis].is_none() && !(moves_in_plane && plane.contains(axis));
        if stays {
            end[axis] = here[axis];
        } else if modal.is_absolute && words.axes[axis].is_some() {
            end[axis] = modal.turned(axis, end[axis], here[axis]);
        }
    }
    end
}

/// The movement of a block; `None` where it names no axis and no circle.
pub(crate) fn of(
    words: &Words,
    modal: &mut Modal,
    once: Once,
    here: &Position,
) -> Result<Option<Movement>, Refusal> {
    let has_centre = words.centre.iter().any(Option::is_some);
    let is_circle = matches!(modal.motion, 2 | 3);
    let moves = words.has_axes || words.polar.iter().any(Option::is_some);
    if !(moves || is_circle && has_centre) {
        return match has_centre || words.radius.is_some() {
            true => wrong("I, J, K and R belong to a circle with G2 or G3"),
            false => Ok(None),
        };
    }
    if !is_circle && (has_centre || words.radius.is_some()) {
        return wrong("I, J, K and R belong to a circle with G2 or G3");
    }
    let end = end(words, modal, here);
    let curve = match is_circle {
        false => Curve::Line,
        true => circle(words, modal, here, &end)?,
    };
    let is_rapid = modal.motion == 0;
    let mut feed = match is_rapid {
        true => modal.feeds.of_rapid(),
        false => FeedRate::Programmed(programmed(modal, &curve, here, &end)?),
    };
    if let Curve::Arc(arc) = &curve {
        let (radius, _) = arc.radii(here, &end);
        feed = modal.feeds.on_circle(feed, radius)?;
    }
    let exact = once.exact_stop.unwrap_or(modal.exact_stop);
    Ok(Some(Movement {
        curve,
        end,
        feed,
        stops: exact || is_rapid && !modal.feeds.rapid_goes_on,
    }))
}

fn circle(words: &Words, modal: &Modal, here: &Position, end: &Position) -> Result<Curve, Refusal> {
    // I, J; K, I; J, K by the plane [002:897-934].
    let (first, second) = match modal.plane_word {
        18 | 118 => (2, 0),
        19 | 119 => (1, 2),
        _ => (0, 1),
    };
    let centre = |index: usize| words.centre.get(index).copied().flatten();
    let third = 3 - first - second;
    if centre(third).is_some() {
        let letter = ["I", "J", "K"].get(third).copied().unwrap_or_default();
        return wrong(format!(
            "{letter} is no centre in the plane of G{}",
            modal.plane_word
        ));
    }
    let by = match words.radius {
        Some(radius) => By::Radius(radius),
        None if centre(first).is_none() && centre(second).is_none() => {
            return wrong("a circle needs its centre or its radius");
        }
        None => By::Centre(modal.vector([centre(first).unwrap_or(0.0), centre(second).unwrap_or(0.0)])),
    };
    let sense = match (modal.motion == 2) ^ modal.is_turned_over() {
        true => Sense::Clockwise,
        false => Sense::CounterClockwise,
    };
    arc::circle(modal.plane, [here, end], by, sense, modal.feeds.radius_error_max)
}

/// The feed of G1, G2, G3, mm/min.
fn programmed(modal: &Modal, curve: &Curve, here: &Position, end: &Position) -> Result<f64, Refusal> {
    if let Some(test) = modal.feeds.test() {
        return Ok(test);
    }
    let feed = match modal.feed_kind {
        FeedKind::Time if modal.feed > 0.0 => curve.length(here, end) / modal.feed * 60.0,
        FeedKind::PerMinute | FeedKind::Time => modal.feed,
        FeedKind::PerTurn if modal.cuts => {
            return wrong("a feed per revolution needs a speed in revolutions: G97");
        }
        FeedKind::PerTurn => {
            let spindle = usize::from(modal.feeds.spindle.max(1) - 1);
            let rpm = modal.speeds.get(spindle).copied().unwrap_or(0.0);
            if rpm <= 0.0 {
                return wrong("a feed per revolution needs the speed of its spindle");
            }
            modal.feed * rpm
        }
    };
    // A path without length takes no time.
    let feed = if feed > 0.0 { feed } else { modal.feed };
    let acting = modal.feeds.acting(feed);
    acting.ok_or_else(|| Refusal::Wrong("no feed is programmed: F is 0".to_owned()))
}
