//! The kernel of the control.
mod emergency;
mod handshake;
mod markers;
mod message;
mod panel;
mod plc_link;
