//! A tap with a floating holder: what cycle 2 does, gathered from its elements to be written as the cycle again.
//!
//! The plunge on which the spindle is stopped before its end, the turning back, a dwell, the retraction, and the spindle as it turned
//! before [003:5005-5035]. The wait before the turning back belongs to the machine (MP7120.0), not to the cycle.

use bahn_path::{At, Curve, FeedRate, Function, OverrideLaw, PathElement};

/// What an element is to a tap.
pub(crate) enum Part {
    /// It belongs to none.
    None,
    /// It is in one.
    Inside,
    /// It is the retraction.
    Whole(Box<Tap>),
}

/// A whole tap with a floating holder.
pub(crate) struct Tap {
    pub plunge: PathElement,
    /// Between turning back and the retraction, s.
    pub dwell_s: f64,
    /// Feed of the plunge, mm/min.
    pub feed_mm_min: f64,
}

/// Recognises taps in the elements of a run.
#[derive(Default)]
pub(crate) struct FloatingTaps {
    open: Option<Open>,
    /// Orders to the spindle that still belong to the last tap.
    orders_after: u8,
}

struct Open {
    plunge: PathElement,
    dwell_s: f64,
    turns_back: bool,
}

/// After the retraction the spindle stops and turns as before.
const ORDERS_AFTER: u8 = 2;

impl FloatingTaps {
    /// Takes the next element of a run.
    ///
    /// # Errors
    /// What of a tap no cycle 2 does.
    pub fn take(&mut self, element: &PathElement) -> Result<Part, String> {
        let taps = matches!(element.override_law, OverrideLaw::Tapping { .. });
        let ordered =
            element.curve == Curve::Hold && matches!(element.functions(), [of] if is_order(&of.function));
        if self.orders_after > 0 {
            if !ordered || element.dwell_s > 0.0 {
                return Err("a tap that ends otherwise than cycle 2".to_owned());
            }
            self.orders_after -= 1;
            return Ok(Part::Inside);
        }
        match (&mut self.open, taps) {
            (None, false) => return Ok(Part::None),
            (Some(_), false) => return Err("a movement between plunge and retraction of a tap".to_owned()),
            (None, true) => {
                let early = |of: &bahn_path::TechnologyFunction| !matches!(of.at, At::BeforeEnd(_));
                if element.curve != Curve::Line || element.functions().iter().any(early) {
                    return Err("a tap that begins otherwise than cycle 2".to_owned());
                }
                self.open = Some(Open {
                    plunge: element.clone(),
                    dwell_s: 0.0,
                    turns_back: false,
                });
            }
            (Some(open), true) if element.curve == Curve::Hold => {
                open.turns_back |= ordered;
                if open.turns_back {
                    open.dwell_s += element.dwell_s;
                }
            }
            (Some(_), true) => return self.whole(element),
        }
        Ok(Part::Inside)
    }

    /// The element is the retraction.
    fn whole(&mut self, out: &PathElement) -> Result<Part, String> {
        let same = |open: &Open| {
            open.turns_back
                && open.plunge.start == out.end
                && open.plunge.end == out.start
                && open.plunge.feed == out.feed
        };
        match (self.open.take().filter(same), out.feed) {
            (Some(open), FeedRate::Programmed(feed_mm_min)) => {
                self.orders_after = ORDERS_AFTER;
                Ok(Part::Whole(Box::new(Tap {
                    plunge: open.plunge,
                    dwell_s: open.dwell_s,
                    feed_mm_min,
                })))
            }
            _ => Err("the retraction of a tap is not its plunge".to_owned()),
        }
    }
}

fn is_order(function: &Function) -> bool {
    matches!(function, Function::M(3..=5))
}
