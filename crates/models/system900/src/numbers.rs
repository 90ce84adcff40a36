//! Numbers of parameters with a meaning of their own. Everything else asks the [table](crate::row); nobody outside this
//! room needs a bare number.

/// Number of valid channel descriptors [002:381-382].
pub const CHANNELS: u32 = 2;
/// Number of system parameters [002:384-385].
pub const PARAMETERS: u32 = 3;
/// FLASH and special functions [002:403-534].
pub const FUNCTION: u32 = 10;
/// The function of [`FUNCTION`] that data files may call: the channel descriptors become active [002:409-430].
pub const ACTIVATE: i64 = 99;
/// Channels, each with a descriptor of its own [002:629-661].
pub const CHANNELS_MAX: u8 = 8;
/// Axes of a channel, and physical ones [002:718-825].
pub const AXES: u8 = 32;

/// Parameters of a descriptor: the first is 100 times the channel [002:629-661].
pub const DESCRIPTOR: u32 = 100;
/// In it: the word of the first logical axis [002:718-855].
pub const AXIS_WORDS: u32 = 10;
/// In it: the spindle blocks of the words S, S2 to S8 [002:858-881].
pub const SPINDLE_WORDS: u32 = 42;
/// In it: the planes of G17, G18, G19 [002:887-934].
pub const PLANES: u32 = 52;
/// In it: which block defines M0 to M199 [002:950-953].
pub const M_BLOCK: u32 = 58;
/// In it: first zero point, then areas, groups, axes, points [002:978-1022].
pub const ZERO_POINTS: u32 = 70;
/// In it: first tool, then records, sub records, length, places [002:1149-1158].
pub const TOOLS: u32 = 75;

/// The fixed parameters of a channel, after its user block 1 [002:61] [002:693-694].
pub const FIXED: u32 = 7000;
/// How many there are.
pub const FIXED_COUNT: u32 = 3000;
/// Parameters that all channels share: the first, and its system parameter [002:61] [002:145-147].
pub const SHARED: (u32, u32) = (11_000, 1000);
/// How many there are.
pub const SHARED_COUNT: u32 = 1000;
/// Parameters of axes: the first of logical axis 1, and the system parameter of physical axis 1 [002:68-111].
pub const AXIS: (u32, u32) = (12_000, 2000);
/// Parameters of each axis.
pub const AXIS_BLOCK: u32 = 200;
/// Parameters of an axis that each channel has for itself, from its first one [002:8350-8360].
pub const AXIS_OWN: std::ops::Range<u32> = 153..158;
/// Below it no user block may lie: system, descriptors, shared and axis parameters.
pub const BLOCKS_FROM: u32 = 8400;

/// Planes of G117, G118, G119 [002:4319-4366].
pub const FURTHER_PLANES: u32 = 8840;
/// Definitions of the M functions of a channel, four in each parameter [002:2088-2100].
pub const M_OF_CHANNEL: u32 = 8250;
/// Definitions of the M functions of the system, four in each parameter [002:5503-5530].
pub const M_OF_SYSTEM: u32 = 11_050;
/// A P number that is written here is looked for, and the next parameter holds its q number [002:3453-3457].
pub const MAPPING_TEST: u32 = 8553;
/// Couplings: master and slave of the first [002:6293-6360].
pub const COUPLINGS: u32 = 11_480;
/// Spindles: the axis of the first.
pub const SPINDLES: u32 = 11_640;
/// Parameters of each coupling, and of each spindle.
pub const COUPLING_BLOCK: u32 = 20;
/// Couplings, and spindles.
pub const COUPLINGS_MAX: u32 = 8;

/// The networks of channels: the first, and its parameters [002:1272-1350].
pub const NETWORKS: u32 = 900;
/// Parameters of each.
pub const NETWORK: u32 = 10;
/// How many there are.
pub const NETWORKS_MAX: u32 = 4;
/// What of channels 1 to 4 is pending, then of 5 to 8 [002:609-628].
pub const PENDING: u32 = 98;
/// In a descriptor: who acknowledges messages [002:939-948].
pub const ACKNOWLEDGEMENT: u32 = 57;
/// Messages of a channel by their kinds, then axis and information [002:3368-3375].
pub const MESSAGES: u32 = 8500;
/// The locks of AUTO [002:3387-3411].
pub const AUTO_LOCKS: u32 = 8510;
/// Key switches 1 to 4, and software switch 1 at the eighth place after them [002:5235-5270].
pub const SWITCHES: u32 = 11_000;
/// What each of them locks, likewise [002:5318-5365].
pub const LOCK_DEFINITIONS: u32 = 11_010;
/// The locks that are active [002:5370-5417].
pub const ACTIVE_LOCKS: u32 = 11_020;
/// The unit of lengths [002:6324-6362].
pub const UNIT: u32 = 11_308;
/// Stops the event buffer [002:6074-6078].
pub const SAMPLING: u32 = 11_270;
/// What the event buffer records beside, of channel 1 [002:6169-6195].
pub const SAMPLING_OF_CHANNELS: u32 = 11_271;
/// How many axes the system has [002:376-379].
pub const AXES_OF_SYSTEM: u32 = 1;
/// The confirmation of a [`FUNCTION`] [002:503-521].
pub const CONFIRMATION: u32 = 11;
/// What the starting routine has cleared: parameters, the same until the user clears it, programs, likewise [002:580-595].
pub const START_INFO: u32 = 50;
/// Parameters below it are written back by themselves: q0 to q999 [002:480].
pub const FIRST_RESTORED: u32 = 1000;
/// In a descriptor: decimals of positions [002:954-965].
pub const DECIMALS: u32 = 59;
/// Number of a channel, then its axes and its last logical axis [002:3447-3451].
pub const CHANNEL: u32 = 8550;
/// Coordinate systems of HAND, axes without interpolation or reduction: reset at power-on [002:4020-4048] [002:4793-4828].
pub const RESET_AT_START: [u32; 5] = [8757, 8758, 8759, 8893, 8894];
/// Radius, length and offsets of the tool in the spindle, and of the one that is computed with [002:6342-6343].
pub const TOOL_LENGTHS: [std::ops::Range<u32>; 2] = [8110..8114, 8160..8164];
/// In the record of a tool: from here on it has the decimals of positions [002:961-963].
pub const TOOL_VALUES: u32 = 10;
/// In the parameters of an axis: whether it is a rotary one [002:6905-6916].
pub const KIND_OF_AXIS: u32 = 1;
/// In the parameters of an axis: those that are displayed, P12150 to P12169 [002:960].
pub const DISPLAYS: std::ops::Range<u32> = 150..170;
/// Key switch 1, P11000 [002:5252-5262].
pub const KEY_SWITCH: u32 = 11_000;
/// An entry in the event buffer [002:6197-6198].
pub const SAMPLE_ENTRY: u32 = 11_279;
/// Switches and what they lock.
pub const LOCK_SWITCHES: std::ops::Range<u32> = SWITCHES..ACTIVE_LOCKS;
/// In the parameters of an axis: it moves by so much [002:7799-7806].
pub const RELATIVE: u32 = 111;
/// In the parameters of an axis: it moves to there [002:7808-7815].
pub const ABSOLUTE: u32 = 112;
/// So far behind [`RELATIVE`] and [`ABSOLUTE`] it says that it is there [002:8572-8580].
pub const REACHED: u32 = 80;
/// The key that was pressed or released [002:6040-6056].
pub const KEY: u32 = 11_260;
/// The second half of the name of the picture; the first one stands before it [002:6059-6068].
pub const PICTURE: u32 = 11_262;
/// Counts what is exchanged with the PLC [002:6205-6247].
pub const DIAGNOSIS: u32 = 11_280;
/// How often something went to the PLC, then channel, number and content of the last one.
pub const TO_PLC: u32 = 11_281;
/// The same of what came from it.
pub const FROM_PLC: u32 = 11_291;
