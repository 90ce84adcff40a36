//! Corners of G12: a chamfer or a radius between a movement and the next one.
//!
//! Decision: P70 is the length that the chamfer takes off each of two lines, P71 the radius. One of them is set, the other 0 or
//! cleared; the next block that moves in the plane ends the corner

use bahn_path::parallel::{self, Flat, TooLarge};
use bahn_path::{Curve, PathElement, Point2};
use bahn_system900::PathData;

use crate::correction::Move;
use crate::item::WAITING_MAX;
use crate::refusal::{Refusal, wrong};

/// What is put into a corner, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Insert {
    Chamfer(f64),
    Radius(f64),
}

impl Insert {
    /// What P70 and P71 say.
    pub fn of(data: &PathData) -> Result<Insert, Refusal> {
        let said = |value: Option<f64>| value.filter(|value| *value != 0.0);
        match (said(data.chamfer()), said(data.rounding())) {
            (Some(length), None) if length > 0.0 => Ok(Insert::Chamfer(length)),
            (None, Some(radius)) if radius > 0.0 => Ok(Insert::Radius(radius)),
            (None, None) => wrong("G12 needs the chamfer P70 or the radius P71"),
            (Some(_), Some(_)) => wrong("G12 takes the chamfer P70 or the radius P71, not both"),
            _ => wrong("G12: P70 and P71 are not negative"),
        }
    }
}

/// Holds the movement before a corner of G12.
#[derive(Clone, Debug, Default)]
pub(crate) struct Corners {
    held: Option<Box<Held>>,
}

#[derive(Clone, Debug)]
struct Held {
    item: Move,
    insert: Insert,
    /// Holds that came after it.
    after: Vec<Move>,
}

impl Corners {
    pub fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// Takes a movement or a hold and gives on what is complete.
    pub fn push(
        &mut self,
        mut item: Move,
        insert: Option<Insert>,
        next: &mut dyn FnMut(Move) -> Result<(), Refusal>,
    ) -> Result<(), Refusal> {
        if let Some(mut held) = self.held.take() {
            if item.element.curve == Curve::Hold && held.after.len() < WAITING_MAX {
                held.after.push(item);
                self.held = Some(held);
                return Ok(());
            }
            let inserted = put_between(&mut held.item, &mut item, held.insert)
                .map_err(|refusal| refusal.of(held.item.element.block))?;
            next(held.item)?;
            if let Some(inserted) = inserted {
                next(inserted)?;
            }
            held.after.into_iter().try_for_each(&mut *next)?;
        }
        match insert {
            None => next(item),
            Some(insert) => {
                self.held = Some(Box::new(Held {
                    item,
                    insert,
                    after: Vec::new(),
                }));
                Ok(())
            }
        }
    }

    /// Nothing follows.
    pub fn end(&mut self) -> Result<(), Refusal> {
        match self.held.take() {
            None => Ok(()),
            Some(held) => Err(nothing_follows().of(held.item.element.block)),
        }
    }
}

fn nothing_follows() -> Refusal {
    Refusal::Wrong("G12: no movement in its plane follows".to_owned())
}

/// Shortens both movements and makes what lies between them; `None` where there is no corner.
fn put_between(held: &mut Move, item: &mut Move, insert: Insert) -> Result<Option<Move>, Refusal> {
    let plane = held.plane;
    let flat = |item: &Move| Flat::of(&item.element, plane);
    let (Some(a), Some(b)) = (flat(held), flat(item)) else {
        return Err(nothing_follows());
    };
    let (ends, curve): ([Point2; 2], Curve) = match insert {
        Insert::Radius(radius) => {
            let rounded = parallel::rounding(plane, [a, b], radius);
            let rounded =
                rounded.map_err(|TooLarge| Refusal::Wrong("G12: the radius P71 is too large".to_owned()))?;
            match rounded {
                Some(rounded) => ([rounded.from, rounded.to], Curve::Arc(rounded.arc)),
                None => return Ok(None),
            }
        }
        Insert::Chamfer(length) => match (a, b) {
            (Flat::Line { .. }, Flat::Line { .. }) => {
                let ends = parallel::chamfer([a, b], length);
                let ends = ends.map_err(|TooLarge| {
                    Refusal::Wrong("G12: the chamfer P70 is longer than a line".to_owned())
                })?;
                (ends, Curve::Line)
            }
            _ => return wrong("G12: a chamfer P70 stands between two straight lines"),
        },
    };
    let corner = held.element.end;
    parallel::cut(plane, [&mut held.element, &mut item.element], [a, b], ends);
    let mut element = PathElement {
        curve,
        functions: None,
        dwell_s: 0.0,
        start: corner,
        end: corner,
        ..held.element.clone()
    };
    let [from, to] = ends;
    plane.set(&mut element.start, from);
    plane.set(&mut element.end, to);
    let touches = curve != Curve::Line;
    (held.element.tangential_end, element.tangential_end) = (touches, touches);
    Ok(Some(Move {
        element,
        ..held.clone()
    }))
}
