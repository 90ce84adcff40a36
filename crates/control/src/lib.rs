//! The kernel of the control.
