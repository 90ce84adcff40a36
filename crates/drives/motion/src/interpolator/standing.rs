//! Where the path is, and how it follows a spindle.

use std::sync::Arc;

use bahn_path::{PathElement, Placement, Position, Thread};

use super::master::Coupling;
use crate::drive::Lead;
use crate::item::Item;

/// Where the path is on the current element.
#[derive(Clone, Debug)]
pub(super) struct Standing {
    /// Path speed, mm/s.
    pub speed: f64,
    /// Distance to the end of the element, mm; negative where a path that follows the spindle stands beyond it.
    pub rest: f64,
    pub position: Position,
    /// The placement in which that is: that of the element that was begun last.
    pub placement: Option<Arc<Placement>>,
}

impl Default for Standing {
    fn default() -> Standing {
        Standing {
            speed: 0.0,
            rest: 0.0,
            position: Position::UNKNOWN,
            placement: None,
        }
    }
}

impl Standing {
    /// Nothing is left to go.
    pub fn stay(&mut self) {
        (self.speed, self.rest) = (0.0, 0.0);
    }

    /// An element begins.
    pub fn enter(&mut self, item: Option<&Item>) {
        self.rest = item.map_or(0.0, |item| item.length);
        if let Some(item) = item
            && !Placement::is_same(self.placement.as_ref(), item.element.placement.as_ref())
        {
            // Nothing moves: the same place has another name.
            self.placement.clone_from(&item.element.placement);
            for axis in item.element.start.known().iter() {
                self.position[axis] = item.element.start[axis];
            }
        }
    }

    /// Takes the position with so much of the element to go.
    pub fn go_along(&mut self, item: &Item) {
        let PathElement {
            curve, start, end, ..
        } = &item.element;
        let fraction = if item.length > 0.0 {
            (item.length - self.rest) / item.length
        } else {
            1.0
        };
        self.position = curve.position(start, end, fraction);
    }

    /// How much of the element is covered, 0 to 1.
    pub fn part_of(&self, item: Option<&Item>) -> f64 {
        match item {
            Some(item) if item.length > 0.0 => (1.0 - self.rest / item.length).clamp(0.0, 1.0),
            _ => 1.0,
        }
    }
}

/// How the current element follows the spindle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Led {
    /// It does.
    pub coupling: Option<Coupling>,
    /// It is run back.
    pub backward: bool,
}

impl Led {
    /// The next element begins, after one of a length in mm.
    pub fn go_on(&mut self, length: f64, thread: Option<&Thread>) {
        self.coupling = self.coupling.and_then(|coupling| coupling.go_on(length, thread));
        self.backward = false;
    }

    /// The command to the spindle.
    pub fn lead(&self, item: Option<&Item>, at: &Standing) -> Option<Lead> {
        let (item, coupling) = item.zip(self.coupling)?;
        let speed = if self.backward { -at.speed } else { at.speed };
        Some(coupling.lead(item.length - at.rest, speed))
    }
}
