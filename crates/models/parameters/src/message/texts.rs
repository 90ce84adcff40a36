//! A message with its texts.

use crate::ControlModel;

/// One message of the table.
pub(super) struct Message {
    pub(super) name: &'static str,
    pub(super) text: &'static str,
    pub(super) variants: &'static [(&'static [ControlModel], &'static str)],
    pub(super) cause: &'static str,
    pub(super) remedy: &'static str,
    pub(super) source: &'static str,
}
