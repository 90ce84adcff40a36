//! Cycles with contour data: 20 names what 21 to 24 have in common, 25 and 27 bring their own. Their parameters are the Q
//! parameters Q1 to Q18 themselves, which the definition assigns and the call reads (later controls; the manuals here
//! name the cycles only [000:847] [000:652]).
//!
//! Decision: The parameters of cycles 20 to 25 are the Q parameters that the definition assigns; they have the values
//! of the call (later controls)

use bahn_parameters::MessageId;
use bahn_path::Position;
use bahn_program::{AssignedParameter, assigned_parameters};

use super::machining::Heights;
use crate::definition::{Definition, Resolved};
use crate::error::Fault;
use crate::modal::Modal;
use crate::numbers::Numbers;
use crate::settings::Settings;

/// The cycle whose data 21 to 24 share.
pub(super) const CONTOUR_DATA: u16 = 20;
/// The cycle with a contour on a cylinder.
pub(crate) const CYLINDER_SURFACE: u16 = 27;

/// Whether the cycle takes its parameters from assignments to Q parameters.
pub(super) fn is_assigned(number: u16) -> bool {
    !assigned_parameters(number).is_empty()
}

/// Whether the tool is to reach the floor to and fro, with the feed Q19: not here.
pub(super) fn reciprocates(definition: &Definition) -> bool {
    matches!(definition.number, 22 | 23) && definition.assigned(19).is_some_and(|feed| feed != 0.0)
}

/// Refuses a cycle without one of its parameters, and 21 to 24 without cycle 20.
pub(super) fn check(modal: &Modal, definition: &Definition) -> Result<(), Fault> {
    if !is_assigned(definition.number) {
        return Ok(());
    }
    if !matches!(definition.number, 25 | CYLINDER_SURFACE) {
        let data = modal.cycle.contour_data.ready();
        let data = data.ok_or_else(|| {
            let detail = "cycle 20 CONTOUR DATA is not defined, or not completely";
            Fault::new(MessageId::CyclIncomplete, detail)
        })?;
        is_complete(data)?;
    }
    is_complete(definition)
}

fn is_complete(definition: &Definition) -> Result<(), Fault> {
    let mut wanted = assigned_parameters(definition.number).iter();
    match wanted.find(|parameter| definition.assigned(parameter.number).is_none()) {
        Some(AssignedParameter { number, name }) => {
            let detail = format!("CYCL DEF {}: Q{number} {name} is missing", definition.number);
            Err(Fault::new(MessageId::CyclIncomplete, detail))
        }
        None => Ok(()),
    }
}

/// The definition sets the Q parameters.
pub(crate) fn assign(numbers: &mut Numbers, words: &[Resolved]) -> Result<(), Fault> {
    for word in words {
        if let Resolved::Assignment(number, value) = word {
            numbers.q.set(*number, *value)?;
        }
    }
    Ok(())
}

/// The parameters of a cycle at its call.
pub(super) struct Values<'a> {
    pub numbers: &'a Numbers,
    pub settings: &'a Settings,
}

impl Values<'_> {
    pub fn number(&self, q: u16) -> Result<f64, Fault> {
        self.numbers.q.get(q)
    }

    /// Value of a Q parameter as a length, mm.
    pub fn length(&self, q: u16) -> Result<f64, Fault> {
        Ok(self.number(q)? * self.numbers.unit_mm)
    }

    /// The plunging depth Q10, mm.
    pub fn plunging(&self) -> Result<f64, Fault> {
        match self.length(10)? {
            0.0 => Err(Fault::new(
                MessageId::CyclIncomplete,
                "the plunging depth Q10 is 0",
            )),
            plunging => Ok(plunging),
        }
    }

    /// Value of a Q parameter as a feed, mm/min.
    pub fn feed(&self, q: u16) -> Result<f64, Fault> {
        let value = bahn_program::Value::Q {
            number: q,
            negative: false,
        };
        let feed = self.numbers.feed(value, self.settings)?;
        if feed <= 0.0 {
            let detail = format!("the feed Q{q} is 0");
            return Err(Fault::new(MessageId::FeedRateIsMissing, detail));
        }
        Ok(feed)
    }

    /// The tool that came, or comes, before this one: that of the roughing in cycle 21, the coarse one in cycle 22
    /// (0: none).
    pub fn other_tool(&self, definition: &Definition) -> Result<Option<f64>, Fault> {
        match definition.number {
            21 => self.number(13).map(Some),
            22 if definition.assigned(18).is_some() => Ok(Some(self.number(18)?).filter(|tool| *tool != 0.0)),
            _ => Ok(None),
        }
    }

    /// Q1, Q5 and Q7, with the set-up clearance above the surface, mm.
    pub fn heights(&self, modal: &Modal, setup: f64) -> Result<Heights, Fault> {
        let normal = modal.plane.normal;
        let depth = self.length(1)?;
        if depth == 0.0 {
            return Err(Fault::new(MessageId::CyclIncomplete, "the milling depth Q1 is 0"));
        }
        let height = |coordinate: f64| {
            let mut at = Position::ZERO;
            at[normal] = coordinate;
            modal.frame.to_outer(&at)[normal]
        };
        let (surface, clearance) = (height(self.length(5)?), height(self.length(7)?));
        let direction = depth.signum();
        let scale = modal.frame.scale(normal);
        let approach = surface - direction * setup.abs() * scale;
        if (clearance - approach) * direction > 0.0 {
            let detail = "the clearance height Q7 lies below the set-up clearance";
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        Ok(Heights {
            clearance,
            direction,
            surface,
            depth: depth.abs() * scale,
            approach: Some(approach),
        })
    }
}
