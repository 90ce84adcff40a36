//! The part that is being cut, for whoever looks at it from every side.
//!
//! Decision: The tool stands in the view where the element that is executed has brought it; the element itself is cut
//! at its end

use std::sync::Arc;

use bahn_tnc::Control;
use bahn_viewer::Trail;
use bahn_workpiece::Part;

use crate::stock::Stock;

/// The part of a test or a run while it is being cut; it can be looked at from any thread.
#[derive(Clone)]
pub struct BeingCut {
    stock: Arc<Stock>,
    program: String,
    tool_at: Option<[f64; 3]>,
}

impl BeingCut {
    pub(crate) fn new(stock: Arc<Stock>, program: &str) -> BeingCut {
        BeingCut {
            stock,
            program: program.to_owned(),
            tool_at: None,
        }
    }

    /// The same with the tool where it stands in the element that is executed, which is cut at its end.
    pub(crate) fn on_the_way(mut self, control: &Control) -> BeingCut {
        let element = control.element().filter(|element| element.placement.is_none());
        self.tool_at = element.and_then(|element| {
            let length = element.length();
            let t = match length > 0.0 {
                true => (1.0 - control.rest_mm() / length).clamp(0.0, 1.0),
                false => 1.0,
            };
            Trail::place(&element.curve.position(&element.start, &element.end, t))
        });
        self
    }

    /// Name of the program.
    pub fn program(&self) -> &str {
        &self.program
    }

    /// It is the same one, not only a like one: what was cut of the other was cut of this.
    pub fn is(&self, other: &BeingCut) -> bool {
        Arc::ptr_eq(&self.stock, &other.stock)
    }

    /// Counts what was done to it.
    pub fn version(&self) -> u64 {
        self.stock.version()
    }

    /// As it is now; `None` before a BLK FORM was executed.
    pub fn part(&self) -> Option<Part> {
        self.stock.part()
    }

    /// Looks at the way of the tool; whoever cuts waits meanwhile.
    pub fn with_trail<T>(&self, look: impl FnOnce(&Trail) -> T) -> T {
        look(&self.stock.trail())
    }

    /// Where the tool is on its way, X, Y, Z; `None` when that is the end of the way so far.
    pub fn tool_at(&self) -> Option<[f64; 3]> {
        self.tool_at
    }
}
