//! The kernel of the control.
mod handshake;
mod markers;
mod panel;
