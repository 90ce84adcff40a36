//! Faults: what the control does about each, how far an axis still travels, and what clears it.
//!
//! The kernel, the loops and the messages act by this table, `bahn faults` prints it, and `bahn torture` holds
//! the running control to it.
//!
//! ```
//! use bahn_parameters::fault::{Clearing, FaultId, Reaction};
//!
//! let lag = FaultId::Positioning.row();
//! assert_eq!((lag.reaction, lag.clearing), (Reaction::Ramp, Clearing::Ce));
//! assert!(FaultId::GrossDeviation.row().flashes());
//! ```
//!
//! Decision: Flashing messages of any kind switch "control is ready" off and stop the PLC
//!
//! Decision: STYLUS DEFLECTION EXCEEDS MAX flashes, and so switches "control is ready" off

use bahn_servo::{EncoderFault, Fault as AxisFault, GrossFault};

use crate::MessageId;

/// What the control does about a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// What was asked for is not done; everything else stays as it is.
    Refusal,
    /// The path waits until it is over.
    PathHeld,
    /// It is said, and nothing else happens.
    Said,
    /// NC stop: the path comes to a standstill with MP1060, the loops stay closed.
    Ramp,
    /// As [`Reaction::Ramp`]; when the axes stand, all loops are opened.
    RampThenOpen,
    /// The nominal value of the axis is 0 V at once, without a ramp.
    ZeroVolts,
    /// The loop of the axis is opened: 0 V, the drive may be clamped or switched off.
    LoopOpen,
    /// NC stop, and all loops are opened at once.
    AllLoopsOpen,
    /// The loops stay open and the PLC does not run.
    NotStarted,
    /// "Control is ready" (X41/34) goes off, all loops are opened at once, the PLC stops.
    ControlReadyOff,
}

impl Reaction {
    /// The word of reports.
    pub fn word(self) -> &'static str {
        match self {
            Reaction::Refusal => "refused",
            Reaction::PathHeld => "path held",
            Reaction::Said => "said only",
            Reaction::Ramp => "ramp (MP1060)",
            Reaction::RampThenOpen => "ramp (MP1060), then loops open",
            Reaction::ZeroVolts => "0 V at once",
            Reaction::LoopOpen => "loop open",
            Reaction::AllLoopsOpen => "all loops open",
            Reaction::NotStarted => "loops stay open, PLC off",
            Reaction::ControlReadyOff => "control is ready off, loops open, PLC off",
        }
    }

    /// The run of the programs stops.
    pub fn stops(self) -> bool {
        matches!(
            self,
            Reaction::Ramp | Reaction::RampThenOpen | Reaction::AllLoopsOpen | Reaction::ControlReadyOff
        )
    }
}

/// What ends a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clearing {
    /// The key CE, whatever the state of the machine.
    Ce,
    /// CE, but not before the control voltage is back.
    CeWithVoltage,
    /// CE, or the PLC, which resets its marker.
    CeOrPlc,
    /// It is over when its cause is.
    Itself,
    /// Switching the control off and on: its message flashes.
    PowerOff,
}

impl Clearing {
    /// The word of reports.
    pub fn word(self) -> &'static str {
        match self {
            Clearing::Ce => "CE",
            Clearing::CeWithVoltage => "CE, when the voltage is back",
            Clearing::CeOrPlc => "CE or the PLC",
            Clearing::Itself => "by itself",
            Clearing::PowerOff => "power off",
        }
    }
}

/// How far an axis still travels after the reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Travel {
    /// Nothing moves by it.
    None,
    /// The nominal position as the ramp says, v²/(2·MP1060) and a contour cycle more; the axis behind it by its lag.
    Ramp,
    /// The drive brakes with all it has: v · its time constant + v²/(2·its acceleration).
    Drive,
    /// Nothing but friction and brake of the machine: v²/(2·(friction + brake)).
    Brake,
}

impl Travel {
    /// The formula of reports.
    pub fn word(self) -> &'static str {
        match self {
            Travel::None => "-",
            Travel::Ramp => "v²/(2·MP1060) + v·T, and the lag",
            Travel::Drive => "v²/(2·a of the drive) + v·its time constant",
            Travel::Brake => "v²/(2·a of friction and brake)",
        }
    }
}

/// When a fault is seen at the latest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// In the servo step in which it is so; its message is there with the next contour cycle.
    ServoStep,
    /// In the contour cycle, where nominal positions are made.
    ContourCycle,
    /// In the PLC scan.
    Scan,
    /// When it is asked for.
    Asked,
}

impl Seen {
    /// The word of reports.
    pub fn word(self) -> &'static str {
        match self {
            Seen::ServoStep => "servo step",
            Seen::ContourCycle => "contour cycle",
            Seen::Scan => "PLC scan",
            Seen::Asked => "when asked",
        }
    }
}

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// The name under which monitors report it.
    pub id: FaultId,
    /// What is so, in words.
    pub cause: &'static str,
    /// The message; `None` where nothing is said, or where the text is not the control's.
    pub message: Option<MessageId>,
    /// The letters after the message.
    pub letter: &'static str,
    /// When it is seen.
    pub seen: Seen,
    /// What the control does.
    pub reaction: Reaction,
    /// How far an axis still travels.
    pub travel: Travel,
    /// What the operator must do to end it.
    pub clearing: Clearing,
    /// Where the manuals say it.
    pub source: &'static str,
}

impl Fault {
    /// Its message flashes: only power-off clears it.
    pub fn flashes(&self) -> bool {
        self.clearing == Clearing::PowerOff
    }
}

macro_rules! faults {
    ($($id:ident: $cause:literal, $message:expr, $letter:literal, $seen:ident, $reaction:ident, $travel:ident,
       $clearing:ident, $source:literal;)*) => {
        /// A fault of the table.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum FaultId {
            $(#[doc = $cause] $id,)*
        }

        impl FaultId {
            /// All rows, in the order of the table.
            pub const ALL: &[FaultId] = &[$(FaultId::$id),*];

            /// The row of the table that says message, reaction and clearing.
            pub const fn row(self) -> &'static Fault {
                match self {
                    $(FaultId::$id => &Fault {
                        id: FaultId::$id,
                        cause: $cause,
                        message: $message,
                        letter: $letter,
                        seen: Seen::$seen,
                        reaction: Reaction::$reaction,
                        travel: Travel::$travel,
                        clearing: Clearing::$clearing,
                        source: $source,
                    },)*
                }
            }

            /// Its name in reports.
            pub fn name(self) -> &'static str {
                match self {
                    $(FaultId::$id => stringify!($id),)*
                }
            }
        }
    };
}

/// The row of what the loop of an axis has found.
impl From<AxisFault> for FaultId {
    fn from(fault: AxisFault) -> FaultId {
        match fault {
            AxisFault::Positioning => FaultId::Positioning,
            AxisFault::Gross(GrossFault::Deviation) => FaultId::GrossDeviation,
            AxisFault::Gross(GrossFault::Voltage) => FaultId::GrossVoltage,
            AxisFault::Gross(GrossFault::Movement) => FaultId::GrossMovement,
            AxisFault::Gross(GrossFault::Standstill) => FaultId::GrossStandstill,
            AxisFault::Gross(GrossFault::Offset) => FaultId::GrossOffset,
            AxisFault::Gross(GrossFault::SpeedController) => FaultId::SpeedController,
            AxisFault::MeasuringSystem(EncoderFault::Amplitude) => FaultId::EncoderAmplitude,
            AxisFault::MeasuringSystem(EncoderFault::Edges) => FaultId::EncoderEdges,
            AxisFault::MeasuringSystem(EncoderFault::Position) => FaultId::EncoderMarks,
        }
    }
}

use MessageId as M;

faults! {
    // Loops of the axes.
    Positioning: "the lag exceeds MP1710, with pre-control MP1410", Some(M::PositioningError), "",
        ServoStep, Ramp, Ramp, Ce, "[000:5192-5249]";
    GrossDeviation: "the lag exceeds MP1720, with pre-control MP1420; a slave leaves its master by MP855",
        Some(M::GrossPositioningError), "A", ServoStep, ControlReadyOff, Brake, PowerOff, "[000:5200-5255] [000:4490]";
    GrossVoltage: "more than 10 V with pre-control", Some(M::GrossPositioningError), "B",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:5258-5264]";
    GrossMovement: "the axis does not move as its voltage says (MP1140), the spindle in a thread not as it is told", Some(M::GrossPositioningError), "C",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:5266-5287]";
    GrossStandstill: "the axis moves at standstill, over its target or backwards by MP1110",
        Some(M::GrossPositioningError), "D", ServoStep, ControlReadyOff, Brake, PowerOff, "[000:5289-5300]";
    GrossOffset: "the offset is 100 mV or more", Some(M::GrossPositioningError), "E",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:5006-5010]";
    SpeedController: "the speed of a digital axis leaves its nominal speed (MP1955)", Some(M::GrossPositioningError), "3F",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:18355] [000:18431-18437] (inferred)";
    EncoderAmplitude: "the signal of an encoder is too small (MP31)", Some(M::MeasuringSystemDefective), "A",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:3290-3318] (inferred)";
    EncoderEdges: "the edges of an encoder follow too closely (MP32)", Some(M::MeasuringSystemDefective), "B",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:3290-3328] (inferred)";
    EncoderMarks: "distance-coded marks contradict the position (MP30)", Some(M::MeasuringSystemDefective), "C",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:3290-3308] (inferred)";
    StylusDeflection: "the stylus of a measuring probe is deflected farther than MP6330",
        Some(M::StylusDeflectionExceedsMax), "", ContourCycle, ControlReadyOff, Brake, PowerOff, "[000:7917]";
    // The control voltage.
    PowerInterrupted: "the supply was off (MP7212 = 0)", Some(M::PowerInterrupted), "",
        Asked, NotStarted, None, Ce, "[000:7033-7040]";
    BufferBattery: "the buffer battery is low", Some(M::ExchangeBufferBattery), "",
        ContourCycle, Said, None, Ce, "[000:1385-1400] (inferred)";
    MemoryDefective: "the RAM of the control does not pass its test", Some(M::MemoryDefective), "",
        Asked, ControlReadyOff, Brake, PowerOff, "[001:906-908] [000:6976-6986] (inferred)";
    MemoryChecksum: "EPROMs or checksum of the control do not pass their test", Some(M::MemoryChecksum), "",
        Asked, ControlReadyOff, Brake, PowerOff, "[001:906-908] [000:6976-6986] (inferred)";
    VoltageMissing: "the control voltage does not come", Some(M::RelayExtDcVoltageMissing), "",
        ContourCycle, NotStarted, None, Itself, "[000:6184]";
    EmergencyStopDefective: "the acknowledgement X42/4 does not fall in the test", Some(M::EmergencyStopDefective), "",
        ServoStep, ControlReadyOff, Brake, PowerOff, "[000:6175-6228]";
    ExternalEmergencyStop: "the acknowledgement X42/4 is lost", Some(M::ExternalEmergencyStop), "",
        ContourCycle, RampThenOpen, Ramp, CeWithVoltage, "[000:6155-6157] [000:6203]";
    EmergencyStopAsNcStop: "the acknowledgement X42/4 is lost under M2827", None, "",
        ContourCycle, AllLoopsOpen, Brake, Itself, "[000:5403-5421]";
    // The PLC.
    PlcMarkers: "markers of the PLC contradict each other", Some(M::ErrorInPlcProgram), "1A to 2N",
        Scan, ControlReadyOff, Brake, PowerOff, "[000:5496-5498] [000:7543-7585] [000:631]";
    PlcStopped: "the PLC program has a run-time error or takes too long", Some(M::ErrorInPlcProgram), "50 to 56",
        Scan, ControlReadyOff, Brake, PowerOff, "[000:11919]";
    PlcMessage: "the PLC sets one of M2924 to M3023", None, "", Scan, Said, None, CeOrPlc, "[000:6619-6633]";
    PlcMessageFlashing: "the PLC sets one of M2924 to M3023 with M2815", None, "",
        Scan, ControlReadyOff, Brake, PowerOff, "[000:6625-6633]";
    EmergencyStopPlc: "the PLC sets M2815 alone", Some(M::EmergencyStopPlc), "",
        Scan, ControlReadyOff, Brake, PowerOff, "[000:6633]";
    // What withholds a movement.
    FeedEnable: "the feed enable M2451, B520 is withdrawn", None, "", Scan, ZeroVolts, Drive, Itself, "[000:5352-5369]";
    OpenLoop: "the PLC opens the loop of an axis, M2544 ff.", None, "", Scan, LoopOpen, Brake, Itself, "[000:5403-5421]";
    OpenAllLoops: "the PLC opens all loops, M2830", None, "", Scan, AllLoopsOpen, Brake, Itself, "[000:5403-5421]";
    NcStop: "NC stop", None, "", Scan, Ramp, Ramp, Itself, "[000:6581-6587]";
    Acknowledgement: "the PLC does not acknowledge a function", None, "", Scan, PathHeld, None, Itself, "[000:7188-7204]";
    // What is refused.
    Limit: "a movement would leave the traverse range", Some(M::LimitSwitch), "",
        Asked, Refusal, Ramp, Ce, "[000:3522]";
    Program: "a block cannot be executed", None, "", Asked, Ramp, Ramp, Ce, "[000:6619-6621]";
    Key: "a key has no function now", Some(M::KeyNonFunctional), "", Asked, Refusal, None, Ce, "[000:6619-6621]";
    SpindleSpeed: "the speed is not allowed", Some(M::WrongRpm), "", Asked, Ramp, Ramp, Ce, "[000:5653]";
    HandOver: "an axis cannot go to another channel", None, "", Asked, Refusal, None, Ce, "(inferred)";
    Other: "any other message of the control", None, "", Asked, Refusal, None, Ce, "[000:6619-6621]";
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Non-flashing messages are cleared with CE, flashing ones need switching off [000:6619-6621]; a flashing
    /// message switches "control is ready" off [000:6153].
    #[test]
    fn what_flashes_switches_control_is_ready_off() {
        for id in FaultId::ALL {
            let row = id.row();
            assert_eq!(row.id, *id);
            assert_eq!(row.flashes(), row.reaction == Reaction::ControlReadyOff, "{id:?}");
            assert!(row.source.contains('[') || row.source == "(inferred)", "{id:?}");
        }
    }

    /// What the loops of the axes open for, by themselves, is what the table says: "control is ready" goes off.
    #[test]
    fn a_loop_opens_by_itself_where_the_table_says_so() {
        let gross = [
            GrossFault::Deviation,
            GrossFault::Voltage,
            GrossFault::Movement,
            GrossFault::Standstill,
            GrossFault::Offset,
            GrossFault::SpeedController,
        ];
        let encoder = [
            EncoderFault::Amplitude,
            EncoderFault::Edges,
            EncoderFault::Position,
        ];
        let faults = std::iter::once(AxisFault::Positioning)
            .chain(gross.map(AxisFault::Gross))
            .chain(encoder.map(AxisFault::MeasuringSystem));
        for fault in faults {
            let row = FaultId::from(fault).row();
            assert_eq!(
                fault.opens_loop(),
                row.reaction == Reaction::ControlReadyOff,
                "{fault:?}"
            );
            assert_eq!(
                fault.opens_loop(),
                row.clearing == Clearing::PowerOff,
                "{fault:?}"
            );
        }
    }

    /// What stops an axis leaves it a way; what moves nothing leaves none.
    #[test]
    fn what_stops_an_axis_says_how_far_it_travels() {
        for id in FaultId::ALL {
            let row = id.row();
            let moves =
                row.reaction.stops() || matches!(row.reaction, Reaction::ZeroVolts | Reaction::LoopOpen);
            assert!(!moves || row.travel != Travel::None, "{id:?}");
            let ramps = matches!(row.reaction, Reaction::Ramp | Reaction::RampThenOpen);
            assert!(!ramps || row.travel == Travel::Ramp, "{id:?}");
        }
    }
}
