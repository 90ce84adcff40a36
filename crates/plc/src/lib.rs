//! PLC.
