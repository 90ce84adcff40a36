//! The code numbers that the operator enters by MOD [000:6928-6947] [003:7023-7031]. Each stands in D276 then; the PLC may
//! have numbers of its own.

/// User parameters.
pub const USER_PARAMETERS: u32 = 123;
/// Takes the protection of programs away [003:7028].
pub const CANCEL_PROTECTION: u32 = 86_357;
/// Offsets of the analogue outputs are adjusted.
pub const OFFSET_ADJUSTMENT: u32 = 75_368;
/// All machine parameters.
pub const MACHINE_PARAMETERS: u32 = 95_148;
/// Tables of axis errors [000:3781-3877].
pub const CORRECTION_TABLES: u32 = 105_296;
/// Erases the retained memory of the PLC.
pub const ERASE_MEMORY: u32 = 531_210;
/// The oscilloscope, on controls that have one.
pub const OSCILLOSCOPE: u32 = 688_379;
/// Files of the PLC; over LSV/2 the password of their level [000:16915].
pub const PLC_MODE: u32 = 807_667;
/// Times of operation [003:7030].
pub const TIMERS: u32 = 857_282;
