//! What parameters say of the radius correction.
//!
//! Decision: P8848 counts where the tool runs round the outside of an arc, P8849 where it runs inside. Both need G41 or G42: without,
//! an arc has no side

use bahn_path::FeedRate;
use bahn_system900::PathData;

use crate::refusal::{Refusal, wrong};

/// The angle of P8845 where it is 0, degrees [002:4388-4390].
const USUAL_INSERTION_DEG: f64 = 120.0;

/// Taken when the parameters were written.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CorrectionRules {
    /// P8845: the change of direction above which blocks are inserted; `None` inserts them at all outer corners.
    insertion_deg: Option<f64>,
    /// P8844 bit 0: what M1154 says is left out.
    pub leaves_out_small: bool,
    /// P8844 bit 1: what M1155 says is left out.
    pub leaves_out_vanished: bool,
    /// P8850, mm, or 1.
    reference: f64,
    /// P8848, P8849 in percent.
    convex: f64,
    concave: f64,
}

/// The radii of an arc beside the contour, mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arcs {
    pub contour: f64,
    /// Of the tool centre.
    pub centre: f64,
    pub tool: f64,
}

impl CorrectionRules {
    pub fn of(data: &PathData) -> CorrectionRules {
        let [convex, concave, reference] = data.feed_dynamics();
        CorrectionRules {
            insertion_deg: data.insertion_deg().map(|angle| match angle == 0.0 {
                true => USUAL_INSERTION_DEG,
                false => angle,
            }),
            leaves_out_small: data.suppressed() & 1 != 0,
            leaves_out_vanished: data.suppressed() & 2 != 0,
            reference,
            convex,
            concave,
        }
    }

    /// Whether a block is inserted at an outer corner with this change of direction, degrees.
    pub fn inserts(&self, turn_deg: f64) -> bool {
        self.insertion_deg.is_none_or(|angle| turn_deg > angle)
    }

    /// The feed of the tool centre on an arc [002:4437-4470].
    pub fn feed(&self, feed: FeedRate, arcs: Arcs) -> Result<FeedRate, Refusal> {
        let Arcs {
            contour,
            centre,
            tool,
        } = arcs;
        let FeedRate::Programmed(feed) = feed else {
            return Ok(feed);
        };
        if self.reference == 1.0 {
            // The programmed feed is that of the cutting edge.
            let edge = if contour > 0.0 { centre / contour } else { 1.0 };
            return Ok(FeedRate::Programmed(if edge > 0.0 { feed * edge } else { feed }));
        }
        if self.reference <= 1.0 || contour >= self.reference {
            return Ok(FeedRate::Programmed(feed));
        }
        if self.reference <= tool {
            return wrong("P8850 is not greater than the radius of the tool");
        }
        let percent = if centre > contour {
            self.convex
        } else {
            self.concave
        };
        let factor = 1.0 + percent / 100.0 * (self.reference - contour) / (self.reference - tool);
        match factor > 0.0 {
            true => Ok(FeedRate::Programmed(feed * factor)),
            false => wrong("P8848 or P8849 leaves no feed on this arc"),
        }
    }
}
