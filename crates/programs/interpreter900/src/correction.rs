//! Radius correction G41, G42: the path of the tool centre beside the contour.
//!
//! Decision: The first line with G41 or G42 leads to the point beside the start of the element after it, the first line with
//! G40 back to the contour; both are straight lines. G41 and G42 follow each other with G40 between them, and in one plane
//!
//! Decision: Above P8845 a circle about the corner is inserted, as the drawing of the manual has it. Where intersections are to
//! be calculated and there is none, too
//!
//! Decision: M1154 is an inside arc or corner that is smaller than the tool, M1155 an element that vanishes under the
//! correction. With P8844 such an element is left out, and the path goes on at the intersection of its neighbours; where
//! these do not meet the message comes all the same

use std::collections::VecDeque;

use bahn_path::parallel::flat::{self, Flat, SAME_POINT_MM};
use bahn_path::parallel::{Ending, Joint, Round, Side, joint, meeting, turn_deg, what_is_left};
use bahn_path::{Curve, PathElement, Plane, Point2};

use crate::correction_rules::{Arcs, CorrectionRules};
use crate::item::{Item, WAITING_MAX};
use crate::refusal::{Refusal, wrong};

/// A movement on the programmed contour.
#[derive(Clone, Debug)]
pub(crate) struct Move {
    pub element: PathElement,
    pub plane: Plane,
    pub side: Side,
    /// Of the tool with its correction, mm.
    pub radius: f64,
}

/// An element beside which the tool runs.
#[derive(Clone, Debug)]
struct Beside {
    item: Move,
    contour: Flat,
    parallel: Flat,
    /// The way to it from the element before; `None` for the first one.
    joint: Option<Joint>,
    /// What comes after it and moves nothing in the plane.
    after: Vec<Item>,
    /// What comes next is not its neighbour: elements between them were left out.
    leaps: bool,
}

impl Beside {
    fn start(&self) -> (Point2, f64) {
        let joint = self.joint.as_ref();
        joint.map_or((self.parallel.start(), 0.0), |joint| {
            (joint.start, joint.start_cut)
        })
    }
}

/// Holds the first line of a correction, then up to two elements.
#[derive(Clone, Debug, Default)]
pub(crate) struct Correction {
    side: Side,
    /// The first line, and what comes after it.
    first: Option<Box<(Move, Vec<Item>)>>,
    chain: VecDeque<Beside>,
    /// Where the tool stands in the plane while that is beside the programmed position.
    at: Option<(Plane, Point2)>,
}

impl Correction {
    /// Whether movements without correction pass as they are.
    pub fn is_idle(&self) -> bool {
        self.side == Side::Off && self.at.is_none()
    }

    /// Whether elements wait for what comes after them.
    pub fn holds(&self) -> bool {
        self.first.is_some() || !self.chain.is_empty()
    }

    pub fn push(
        &mut self,
        item: Move,
        rules: &CorrectionRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        if item.side == Side::Off && self.is_idle() {
            out.push_back(Item::Element(item.element));
            return Ok(());
        }
        let is_line = item.element.curve == Curve::Line;
        match (Flat::of(&item.element, item.plane), item.side) {
            (None, _) if !is_line && item.element.curve != Curve::Hold => {
                wrong("a circle outside of the plane has no radius correction")
            }
            (None, _) => self.beside(Item::Element(item.element), rules, out),
            (Some(_), Side::Off) => self.leave(item, is_line, rules, out),
            (Some(_), side) if self.side == Side::Off => match is_line {
                true => {
                    self.side = side;
                    self.first = Some(Box::new((item, Vec::new())));
                    Ok(())
                }
                false => wrong("G41 and G42 begin on a straight line"),
            },
            (Some(contour), _) => self.follow(item, contour, rules, out),
        }
    }

    /// A movement beside the plane, or a stop: the tool stays beside the contour.
    pub fn beside(
        &mut self,
        item: Item,
        rules: &CorrectionRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        let waiting = match (self.chain.back_mut(), &mut self.first) {
            (Some(last), _) => &mut last.after,
            (None, Some(first)) => &mut first.1,
            (None, None) => {
                self.put(item, out);
                return Ok(());
            }
        };
        waiting.push(item);
        match waiting.len() > WAITING_MAX {
            true => self.flush(rules, out),
            false => Ok(()),
        }
    }

    /// Ends what is held as if nothing followed: beside its last point.
    pub fn flush(&mut self, rules: &CorrectionRules, out: &mut VecDeque<Item>) -> Result<(), Refusal> {
        if let Some(first) = self.first.take() {
            let (item, after) = *first;
            let target = Flat::of(&item.element, item.plane).map(|flat| {
                let normal = flat::scale(flat::left(flat.end_tangent()), item.side.sign());
                flat::along(flat.end(), normal, item.radius)
            });
            self.approach(item, target, after, out);
        }
        while let Some(front) = self.chain.pop_front() {
            let joint = self.chain.front().and_then(|next| next.joint);
            let ending = joint.map_or(
                Ending {
                    end: front.parallel.end(),
                    end_cut: 0.0,
                },
                |joint| joint.ending,
            );
            self.hand_out(front, ending, joint, rules, out)?;
        }
        Ok(())
    }

    /// The straight line back to the contour.
    fn leave(
        &mut self,
        mut item: Move,
        is_line: bool,
        rules: &CorrectionRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        if !is_line {
            return wrong("G40 ends the correction on a straight line");
        }
        self.flush(rules, out)?;
        if let Some((plane, at)) = self.at.take() {
            plane.set(&mut item.element.start, at);
        }
        self.side = Side::Off;
        out.push_back(Item::Element(item.element));
        Ok(())
    }

    fn follow(
        &mut self,
        item: Move,
        contour: Flat,
        rules: &CorrectionRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        self.fits(&item)?;
        let Some(parallel) = contour.offset(item.side.sign() * item.radius) else {
            return match rules.leaves_out_small && self.leave_out_last(&item) {
                true => Ok(()),
                false => Err(Refusal::Numbered(1154, "the tool is larger than the inside arc")),
            };
        };
        let mut next = Beside {
            item,
            contour,
            parallel,
            joint: None,
            after: Vec::new(),
            leaps: false,
        };
        if let Some(first) = self.first.take() {
            let (first, after) = *first;
            self.approach(first, Some(parallel.start()), after, out);
        } else if self.chain.is_empty() {
            self.connect(&next.item, parallel.start(), out);
        } else if !self.join(&mut next, rules)? {
            return Ok(());
        }
        self.chain.push_back(next);
        if self.chain.len() > 2
            && let Some(front) = self.chain.pop_front()
            && let Some(joint) = self.chain.front().and_then(|next| next.joint)
        {
            self.hand_out(front, joint.ending, Some(joint), rules, out)?;
        }
        Ok(())
    }

    /// What must not change within a contour.
    fn fits(&self, item: &Move) -> Result<(), Refusal> {
        let first = self.first.as_ref().map(|first| &first.0);
        let before = self.chain.back().map(|last| &last.item).or(first);
        if self.side != item.side {
            return wrong("the side of the tool changes: G40 stands between G41 and G42");
        }
        match before {
            Some(before) if before.plane != item.plane => wrong("the plane changes within G41 or G42"),
            Some(before) if before.radius != item.radius => {
                wrong("the radius of the tool changes within G41 or G42")
            }
            _ => Ok(()),
        }
    }

    /// Finds the way to an element from those that are held; `false` where it is left out.
    fn join(&mut self, next: &mut Beside, rules: &CorrectionRules) -> Result<bool, Refusal> {
        let Some(last) = self.chain.back() else {
            return Ok(true);
        };
        let Some(way) = way(last, next, rules) else {
            return match rules.leaves_out_small && self.leave_out_last(&next.item) {
                true => Ok(false),
                false => Err(Refusal::Numbered(
                    1154,
                    "the tool is larger than the inside corner",
                )),
            };
        };
        if last.is_left(way.ending.end_cut) {
            next.joint = Some(way);
            return Ok(true);
        }
        let vanishes = Refusal::Numbered(1155, "the element vanishes under the radius correction")
            .of(last.item.element.block);
        if !rules.leaves_out_vanished || self.chain.len() < 2 {
            return Err(vanishes);
        }
        if let Some(mut gone) = self.chain.pop_back()
            && let Some(before) = self.chain.back_mut()
        {
            before.keep_functions(&gone.item.element);
            before.after.append(&mut gone.after);
            before.leaps = true;
            next.joint = meeting(&before.parallel, &next.parallel);
            if next
                .joint
                .is_some_and(|joint| before.is_left(joint.ending.end_cut))
            {
                return Ok(true);
            }
        }
        Err(vanishes)
    }

    /// Leaves out an element that comes after the last one; `false` where there is none to go on from.
    fn leave_out_last(&mut self, item: &Move) -> bool {
        let Some(last) = self.chain.back_mut() else {
            return false;
        };
        last.leaps = true;
        last.keep_functions(&item.element);
        true
    }

    /// The first line, to where the contour begins beside it.
    fn approach(&mut self, mut item: Move, to: Option<Point2>, after: Vec<Item>, out: &mut VecDeque<Item>) {
        if let Some((plane, at)) = self.at {
            plane.set(&mut item.element.start, at);
        }
        if let Some(to) = to {
            item.plane.set(&mut item.element.end, to);
            self.at = Some((item.plane, to));
        }
        out.push_back(Item::Element(item.element));
        for item in after {
            self.put(item, out);
        }
    }

    /// Straight to an element after a stop within the contour.
    fn connect(&mut self, item: &Move, to: Point2, out: &mut VecDeque<Item>) {
        let plane = item.plane;
        let from = self
            .at
            .map_or_else(|| plane.point(&item.element.start), |(_, at)| at);
        self.at = Some((plane, to));
        if flat::distance(from, to) > SAME_POINT_MM {
            let mut element = bare(&item.element, Curve::Line);
            element.end = element.start;
            plane.set(&mut element.start, from);
            plane.set(&mut element.end, to);
            out.push_back(Item::Element(element));
        }
    }

    /// An element beside the contour, and the corner after it.
    fn hand_out(
        &mut self,
        done: Beside,
        ending: Ending,
        corner: Option<Joint>,
        rules: &CorrectionRules,
        out: &mut VecDeque<Item>,
    ) -> Result<(), Refusal> {
        let (start, start_cut) = done.start();
        let plane = done.item.plane;
        let mut element = done.item.element;
        let block = element.block;
        let left = what_is_left(element.curve, &done.parallel, start_cut, ending.end_cut);
        let left = left.ok_or_else(|| {
            Refusal::Numbered(1155, "the element vanishes under the radius correction").of(block)
        })?;
        if let Curve::Arc(arc) = element.curve {
            let arcs = Arcs {
                contour: flat::distance(done.contour.start(), arc.centre),
                centre: flat::distance(done.parallel.start(), arc.centre),
                tool: done.item.radius,
            };
            element.feed = rules
                .feed(element.feed, arcs)
                .map_err(|refusal| refusal.of(block))?;
        }
        element.curve = left;
        plane.set(&mut element.start, start);
        plane.set(&mut element.end, ending.end);
        let round = corner.and_then(|joint| Some((joint, joint.transition?)));
        let round = round.map(|(joint, curve)| {
            let mut inserted = bare(&element, curve);
            (inserted.start, inserted.end) = (element.end, element.end);
            plane.set(&mut inserted.end, joint.start);
            inserted.tangential_end = curve != Curve::Line;
            (joint.start, inserted)
        });
        element.tangential_end |= round
            .as_ref()
            .is_some_and(|(_, inserted)| inserted.tangential_end);
        self.at = Some((plane, ending.end));
        out.push_back(Item::Element(element));
        if let Some((end, inserted)) = round {
            self.at = Some((plane, end));
            out.push_back(Item::Element(inserted));
        }
        for item in done.after {
            self.put(item, out);
        }
        Ok(())
    }

    /// Hands out what moves nothing in the plane, where the tool stands.
    fn put(&mut self, mut item: Item, out: &mut VecDeque<Item>) {
        if let (Item::Element(element), Some((plane, at))) = (&mut item, self.at) {
            plane.set(&mut element.start, at);
            plane.set(&mut element.end, at);
        }
        out.push_back(item);
    }
}

impl Beside {
    /// Whether something of it is left when so much is cut off its end.
    fn is_left(&self, end_cut: f64) -> bool {
        let (_, start_cut) = self.start();
        what_is_left(self.item.element.curve, &self.parallel, start_cut, end_cut).is_some()
    }

    /// The functions of an element that is left out still go out.
    fn keep_functions(&mut self, element: &PathElement) {
        if element.functions.is_some() {
            let mut hold = element.clone();
            (hold.curve, hold.start) = (Curve::Hold, hold.end);
            self.after.push(Item::Element(hold));
        }
    }
}

/// The way round the corner between two elements.
fn way(last: &Beside, next: &Beside, rules: &CorrectionRules) -> Option<Joint> {
    if last.leaps {
        return meeting(&last.parallel, &next.parallel);
    }
    let contour = [last.contour, next.contour];
    let parallels = [last.parallel, next.parallel];
    let go = |round| joint(next.item.plane, contour, parallels, next.item.side, round);
    match rules.inserts(turn_deg(contour).abs()) {
        true => go(Round::Arc),
        false => go(Round::Meet).or_else(|| go(Round::Arc)),
    }
}

/// A piece that the control puts in: without functions and dwell.
fn bare(element: &PathElement, curve: Curve) -> PathElement {
    PathElement {
        curve,
        functions: None,
        dwell_s: 0.0,
        tangential_end: false,
        end_feed: None,
        ..element.clone()
    }
}
