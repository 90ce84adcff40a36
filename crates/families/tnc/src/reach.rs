//! What the operator's hands reach.

use bahn_exchange::Image;
use bahn_kernel::OwnAxes;
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
