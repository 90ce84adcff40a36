//! What the monitoring of an axis finds.

/// A fault of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// POSITIONING ERROR: the lag exceeds MP1710, with pre-control MP1410 [000:5192-5198] [000:5230-5234].
    Positioning,
    /// GROSS POSITIONING ERROR with its letter.
    Gross(GrossFault),
    /// MEASURING SYSTEM DEFECTIVE with its letter.
    MeasuringSystem(EncoderFault),
}

/// The causes of GROSS POSITIONING ERROR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrossFault {
    /// A: the lag exceeds MP1720, with pre-control MP1420; a slave is farther from its master than MP855
    /// [000:5200-5206] [000:4490].
    Deviation,
    /// B: more than 10 V with pre-control [000:5258-5264].
    Voltage,
    /// C: the axis does not move as its voltage says [000:5266-5287]; position and speed encoder differ by more than
    /// MP1970 [000:18485-18506].
    Movement,
    /// D: the axis moves at standstill, over its target or backwards [000:5289-5300].
    Standstill,
    /// E: the offset is 100 mV or more [000:5006-5010].
    Offset,
    /// 3F: the digital speed controller calculates a greater voltage than MP1910 permits [000:18387-18391].
    SpeedController,
}

/// The causes of MEASURING SYSTEM DEFECTIVE [000:3290-3297].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncoderFault {
    /// A: the signal amplitude is too small.
    Amplitude,
    /// B: the signal edges follow each other too closely.
    Edges,
    /// C: distance-coded marks contradict the position.
    Position,
}

impl Fault {
    /// The loop opens for good; with the others it stays closed, and they can be acknowledged.
    pub fn opens_loop(self) -> bool {
        self != Fault::Positioning
    }
}
