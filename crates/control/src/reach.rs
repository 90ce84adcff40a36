//! What the operator's hands reach, and how far they lead an axis.

use bahn_exchange::Image;
use bahn_kernel::{AxisUnit, Direction, OwnAxes};
use bahn_parameters::operation::OperationParameters;
use bahn_path::BlockRef;

use crate::command::Mode;
use crate::message::Messages;
use crate::panel::Panel;

/// What the operator's hands reach.
pub(crate) struct Reach<'a, 'b> {
    pub axes: &'a mut OwnAxes<'b>,
    pub mode: Mode,
    pub panel: &'a mut Panel,
    pub rules: &'a OperationParameters,
    pub nc: &'a Image,
    pub messages: &'a mut Messages,
    /// The block whose run is interrupted.
    pub block: Option<BlockRef>,
}

/// A target inside the software limits, from outside only towards them; and the limit beyond which it was.
pub(crate) fn within(unit: &AxisUnit, target: f64) -> (f64, Option<Direction>) {
    let Some([least, greatest]) = unit.limited() else {
        return (target, None);
    };
    let (least, greatest) = (least.min(unit.nominal), greatest.max(unit.nominal));
    if target > greatest {
        (greatest, Some(Direction::Plus))
    } else if target < least {
        (least, Some(Direction::Minus))
    } else {
        (target, None)
    }
}
