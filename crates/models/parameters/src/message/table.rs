//! The table of messages. Order and texts follow the printed list of the TNC 360 [003:7866-8101]; where
//! another manual prints a different text for the same fault, it stands beside it. The manuals print
//! some texts in small letters inside a sentence; screens show capitals (inferred).

use super::Message;
use crate::ControlModel::{self, Tnc151, Tnc155, Tnc407, Tnc415b, Tnc425};

/// The models of manual 000.
const TNC_4XX: &[ControlModel] = &[Tnc407, Tnc415b, Tnc425];
/// The models of manual 001.
const TNC_15X: &[ControlModel] = &[Tnc151, Tnc155];

macro_rules! messages {
    ($($id:ident: $text:literal $(, on $models:ident $variant:literal)*;
        cause $cause:literal; remedy $remedy:literal; source $source:literal;)+) => {
        /// A message of the control. Its text, cause, remedy and source are in the table of this file.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum MessageId {
            $(
                #[doc = concat!("`", $text, "`: ", $cause, " ", $source)]
                $id,
            )+
        }

        impl MessageId {
            /// All messages in the order of the table.
            pub const ALL: &[MessageId] = &[$(MessageId::$id),+];

            pub(super) fn message(self) -> &'static Message {
                match self {
                    $(MessageId::$id => &Message {
                        name: stringify!($id),
                        text: $text,
                        variants: &[$(($models, $variant)),*],
                        cause: $cause,
                        remedy: $remedy,
                        source: $source,
                    },)+
                }
            }
        }
    };
}

messages! {
    // Messages while programs are written [003:7866-7887].

    EntryValueIncorrect: "ENTRY VALUE INCORRECT";
        cause "A number is outside its input limits, or a label number is not allowed.";
        remedy "Enter a value inside the limits of the control.";
        source "[003:7868-7871]";
    ExtInOutputNotReady: "EXT. IN-/OUTPUT NOT READY", on TNC_4XX "EXT. OUTPUT/INPUT NOT READY";
        cause "The external device does not answer.";
        remedy "Connect and switch on the device; check the data interface settings.";
        source "[003:7873-7875]";
    BaudRateNotPossible: "BAUD RATE NOT POSSIBLE";
        cause "One interface is at 19,200 baud and the other is to be at 38,400.";
        remedy "Choose another baud rate for one of both.";
        source "[000:17552-17576]";
    InterfaceAlreadyAssigned: "INTERFACE ALREADY ASSIGNED";
        cause "Something is being transferred by the interface already, or the PLC has it.";
        remedy "Wait for the end of the transfer, or take the other interface.";
        source "[000:17577-17578]";
    ProgramIncomplete: "PROGRAM INCOMPLETE", on TNC_15X "ME: PROGRAM INCOMPLETE";
        cause "A transfer was interrupted, or a program has no END block.";
        remedy "Transfer the file again; check line and device.";
        source "[000:17579] [000:17636] [003:1680]";
    TransferredDataIncorrect: "TRANSFERRED DATA INCORRECT";
        cause "Characters or blocks arrive damaged, or the device does not answer as the protocol wants.";
        remedy "Set the same baud rate, data format and protocol on both sides; check the cable.";
        source "[000:17581-17601] [000:17630]";
    EraseOverread: "ERASE/OVERREAD";
        cause "A file of this name is there already.";
        remedy "Confirm that it is replaced, or leave it.";
        source "[000:17233]";
    DataCarrierMissing: "DATA CARRIER MISSING";
        cause "There is no cassette in the magnetic tape unit.";
        remedy "Insert a cassette.";
        source "[000:17631]";
    DataCarrierWriteProtected: "DATA CARRIER WRITE-PROTECTED";
        cause "The cassette of the magnetic tape unit is protected.";
        remedy "Take the write protection away, or insert another cassette.";
        source "[000:17632]";
    WrongOperatingMode: "WRONG OPERATING MODE";
        cause "The magnetic tape unit is not set to what the control wants of it.";
        remedy "Set the operating mode at the magnetic tape unit.";
        source "[000:17633]";
    WrongProgramData: "WRONG PROGRAM DATA";
        cause "What the magnetic tape unit reads is no program.";
        remedy "Insert the right cassette.";
        source "[000:17634]";
    DataCarrierEmpty: "DATA CARRIER EMPTY";
        cause "Nothing is stored on the cassette.";
        remedy "Insert the right cassette.";
        source "[000:17635]";
    MeEndOfTape: "ME: END OF TAPE";
        cause "The tape of the magnetic tape unit is at its end.";
        remedy "Rewind it, or insert another cassette.";
        source "[000:17637]";
    FurtherProgramEntryImpossible: "FURTHER PROGRAM ENTRY IMPOSSIBLE";
        cause "The program memory is full, or a program is larger than the control can hold.";
        remedy "Erase programs that are no longer needed, or transfer the program blockwise.";
        source "[003:7877-7879]";
    ProgramMemoryOverflow: "Program Memory Overflow";
        cause "The memory for a program that is executed while it is transferred is not enough.";
        remedy "Lower MP7228.0 or raise MP7228.1; jump to labels that stand near.";
        source "[000:16959]";
    LabelNumberAllocated: "LABEL NUMBER ALLOCATED";
        cause "The same label number is set twice in one program.";
        remedy "Give each label of a program its own number; only label 0 may be repeated.";
        source "[003:7881-7883]";
    JumpToLabelZeroNotPermitted: "JUMP TO LABEL 0 NOT PERMITTED";
        cause "Label 0 is called or jumped to; it only ends subprograms.";
        remedy "Call a label from 1 to 254.";
        source "[003:7885-7887]";

    // Messages of the test run and the program run [003:7889-8033].

    AngleReferenceMissing: "ANGLE REFERENCE MISSING";
        cause "An arc is ambiguous, or a polar coordinate angle is missing.";
        remedy "Give arc, end point and polar angle completely.";
        source "[003:7891-7894]";
    ArithmeticalError: "ARITHMETICAL ERROR";
        cause "A calculation is mathematically impossible, or its values are out of range.";
        remedy "Check divisors, roots and value ranges; take probe points farther apart.";
        source "[003:7896-7902]";
    AxisDoubleProgrammed: "AXIS DOUBLE PROGRAMMED";
        cause "A block gives two values for the same axis.";
        remedy "Give each axis one value.";
        source "[003:7904-7906] [003:8039-8041]";
    BlkFormDefinitionIncorrect: "BLK FORM DEFINITION INCORRECT";
        cause "The blank's MIN and MAX points do not fit, a side is too long for the others, or the main program has no blank.";
        remedy "MIN must be below MAX in each axis, the ratio of sides below 84:1; copy BLK FORM into the main program.";
        source "[003:7908-7912]";
    ChamferNotPermitted: "CHAMFER NOT PERMITTED";
        cause "The chamfer is not between two straight lines.";
        remedy "Program the chamfer between two straight-line blocks of the working plane.";
        source "[003:7914-7916]";
    CircleEndPosIncorrect: "CIRCLE END POS. INCORRECT", on TNC_4XX "ARC END-POINT INCORRECT";
        cause "The end point does not lie on the circle within the tolerance, or a tangential arc is incomplete.";
        remedy "Enter an end point on the circle; give a tangential arc completely.";
        source "[003:7918-7921] [000:7012]";
    CyclIncomplete: "CYCL INCOMPLETE";
        cause "A cycle is called that is not defined, lacks data, has them in the wrong order, is a coordinate transformation, or pecks by 0.";
        remedy "Define the cycle completely before the call.";
        source "[003:7923-7928]";
    ExcessiveSubprogramming: "EXCESSIVE SUBPROGRAMMING";
        cause "Subprograms or programs are nested too deep or call themselves, LBL 0 is missing, or REP does not suit the call.";
        remedy "Nest at most 8 subprograms and 4 programs; end subprograms with LBL 0; use REP for repeats only.";
        source "[003:7930-7937]";
    FeedRateIsMissing: "FEED RATE IS MISSING";
        cause "A movement has no feed rate: none was programmed yet, and FMAX holds for one block only.";
        remedy "Enter a feed rate, or FMAX in each block.";
        source "[003:7939-7942]";
    GrossPositioningError: "GROSS POSITIONING ERROR";
        cause "The actual position is too far from the nominal position.";
        remedy "Switch off, find the fault of the drive, and start again.";
        source "[003:7946-7948] [000:5200-5234]";
    KeyNonFunctional: "KEY NON-FUNCTIONAL";
        cause "The key has no meaning in the present dialog.";
        remedy "Answer the dialog with one of its keys.";
        source "[003:7950-7952]";
    LabelNumberNotAllocated: "LABEL NUMBER NOT ALLOCATED";
        cause "A label is called or jumped to that the program does not set.";
        remedy "Set the label, or call one that exists.";
        source "[003:7954-7956]";
    PathOffsetWronglyEnded: "PATH OFFSET WRONGLY ENDED";
        cause "Radius compensation is cancelled in a circle block.";
        remedy "Cancel it in a straight-line block.";
        source "[003:7958-7960]";
    PathOffsetWronglyStarted: "PATH OFFSET WRONGLY STARTED";
        cause "Radius compensation begins in a circle block, or changes at a rounding or chamfer.";
        remedy "Begin it in a straight-line block; keep it the same before and after RND and chamfer.";
        source "[003:7962-7965]";
    PgmSectionCannotBeShown: "PGM SECTION CANNOT BE SHOWN";
        cause "The graphics cannot draw it: the tool is too large, a rotary axis moves, or the tool axis is not that of the blank.";
        remedy "Use a smaller tool and the tool axis of BLK FORM.";
        source "[003:7967-7971]";
    PlaneWronglyDefined: "PLANE WRONGLY DEFINED";
        cause "The axes of an arc or of CC do not make a plane, or the tool axis changed while a basic rotation is active.";
        remedy "Give both main axes of the plane; do not change the tool axis with a basic rotation.";
        source "[003:7973-7977] [003:8057-8059]";
    ProbeSystemNotReady: "PROBE SYSTEM NOT READY";
        cause "The touch probe does not report ready, or cannot be retracted from the workpiece.";
        remedy "Check the probe and its transmission; free the stylus.";
        source "[003:7979-7982] [003:8061-8065]";
    ProgramStartUndefined: "PROGRAM-START UNDEFINED";
        cause "The program starts where tool, position, tangent or pole are not known.";
        remedy "Start at a tool block, not at a tangential arc or a pole transfer.";
        source "[003:7984-7987]";
    RadiusCompensationUndefined: "RADIUS COMPENSATION UNDEFINED";
        cause "The first subcontour of cycle 14 has neither RL nor RR.";
        remedy "Program RL or RR in the first contour subprogram.";
        source "[003:7989-7991]";
    RoundingOffNotDefined: "ROUNDING OFF NOT DEFINED";
        cause "A rounding or a tangential arc lacks a neighbour that it can join.";
        remedy "Program positions in both axes of the plane before and after it.";
        source "[003:7993-7995]";
    RoundingRadiusTooLarge: "ROUNDING RADIUS TOO LARGE";
        cause "The rounding does not fit between its contour elements.";
        remedy "Enter a smaller rounding radius.";
        source "[003:7997-7999]";
    SelectedBlockNotAddressed: "SELECTED BLOCK NOT ADDRESSED";
        cause "The run was not started at the beginning of the program after it was changed or broken off.";
        remedy "Go to block 0 with GOTO 0 before the start.";
        source "[003:8001-8003]";
    StylusAlreadyInContact: "STYLUS ALREADY IN CONTACT", on TNC_15X "STYLUS DEFLECTED";
        cause "The stylus is deflected before probing begins.";
        remedy "Position the probe so that it touches nothing.";
        source "[003:8005-8007] [003:8083-8085] [001:2286]";
    ToolRadiusTooLarge: "TOOL RADIUS TOO LARGE";
        cause "With this tool radius the contour element cannot be calculated or machined.";
        remedy "Use a smaller tool; at small steps on outside corners M97 helps.";
        source "[003:8009-8014]";
    TouchPointInaccessible: "TOUCH POINT INACCESSIBLE";
        cause "The stylus was not deflected within the measuring range.";
        remedy "Position the probe nearer to the surface, or allow a longer way (MP6130).";
        source "[003:8016-8018] [003:8091-8094] [000:7648] [001:2247]";
    WrongAxisProgrammed: "WRONG AXIS PROGRAMMED";
        cause "The axis is not allowed here: locked or missing, mirrored though rotary, or a slot or pocket outside the working plane; or a chamfer is not positive.";
        remedy "Program an axis that the control has and the function allows.";
        source "[003:8020-8025] [003:8096-8098]";
    WrongRpm: "WRONG RPM", on TNC_4XX "WRONG SPINDLE SPEED";
        cause "The spindle speed is outside the permissible range.";
        remedy "Program a speed that the machine has.";
        source "[003:8027-8029] [000:5653]";
    WrongSignProgrammed: "WRONG SIGN PROGRAMMED";
        cause "The signs of a cycle's parameters disagree.";
        remedy "Give setup clearance, depth and pecking depth the sign of the working direction.";
        source "[003:8031-8033]";

    HandwheelMissing: "HANDWHEEL?";
        cause "MP7640 names a handwheel, and none is connected.";
        remedy "Plug it in, or enter MP7640 = 0.";
        source "[000:8069]";

    // Messages of digitizing [003:8037-8098].

    ExchangeTouchProbeBattery: "EXCHANGE TOUCH PROBE BATTERY";
        cause "The battery of the infra-red touch probe is low.";
        remedy "Exchange the battery.";
        source "[003:8043-8045]";
    FaultyRangeData: "FAULTY RANGE DATA";
        cause "The digitizing range is missing, outside the traverse limits, or MIN is not below MAX.";
        remedy "Define the range before MEANDER or CONTOUR LINES, MIN below MAX.";
        source "[003:8047-8051]";
    MirroringNotPermitted: "MIRRORING NOT PERMITTED";
        cause "A mirror image is active while digitizing.";
        remedy "Reset the coordinate transformations.";
        source "[003:8053-8055]";
    RangeExceeded: "RANGE EXCEEDED";
        cause "The surface reaches beyond the digitizing range.";
        remedy "Enter a range that contains the whole surface.";
        source "[003:8067-8069]";
    RotationNotPermitted: "ROTATION NOT PERMITTED";
        cause "A rotation is active while digitizing.";
        remedy "Reset the coordinate transformations.";
        source "[003:8071-8073]";
    ScalingFactorNotAllowed: "SCALING FACTOR NOT ALLOWED";
        cause "A scaling factor is active while digitizing.";
        remedy "Reset the coordinate transformations.";
        source "[003:8075-8077]";
    StartPositionIncorrect: "START POSITION INCORRECT";
        cause "The start point of CONTOUR LINES lies outside the range.";
        remedy "Program a start point inside the range.";
        source "[003:8079-8081]";
    StylusDeflectionExceedsMax: "STYLUS DEFLECTION EXCEEDS MAX";
        cause "The stylus of the measuring probe is deflected farther than MP6330.";
        remedy "Free the stylus; scan more slowly, or with a smaller depth (MP6310).";
        source "[000:7917]";
    TimeLimitExceeded: "TIME LIMIT EXCEEDED";
        cause "The orbit of a contour line took longer than its time limit.";
        remedy "Enter a longer time limit, or 0 for none.";
        source "[003:8087-8089]";

    // Messages of the machine: power-on, monitoring, PLC. Where an axis or a letter belongs to the text, `#`
    // stands for the axis.

    PowerInterrupted: "POWER INTERRUPTED";
        cause "The control voltage was off.";
        remedy "Clear the message with CE; the PLC program runs from then on.";
        source "[000:7033-7037]";
    ExchangeBufferBattery: "EXCHANGE BUFFER BATTERY";
        cause "The batteries that keep the memory while the control is off are low: part programs, PLC program, machine parameters.";
        remedy "Exchange the three batteries in the power supply of the logic unit; the memory is kept meanwhile, also with the mains off.";
        source "[000:1385-1400]";
    MemoryDefective: "MEMORY TEST: RAM DEFECTIVE";
        cause "The RAM did not pass the memory test at switch-on.";
        remedy "Switch off and have the control exchanged; machine parameters can leave the test out.";
        source "Bahn, after [001:906-908] [000:6976-6986]";
    MemoryChecksum: "MEMORY TEST: CHECKSUM ERROR";
        cause "The EPROMs or the checksum did not pass the memory test at switch-on.";
        remedy "Switch off and have the control exchanged; machine parameters can leave the test out.";
        source "Bahn, after [001:906-908] [000:6976-6986]";
    OperatingParametersErased: "OPERATING PARAMTERS ERASED";
        cause "The memory of the machine parameters is empty.";
        remedy "Clear the message with CE and enter the machine parameters, or read them in.";
        source "[001:2489-2493]";
    MachineParameterAsked: "MACHINE PARAMETER MP0 ?";
        cause "The memory of the machine parameters is empty: the control asks for the first one.";
        remedy "Enter the machine parameters, or read them in.";
        source "[001:2495-2497]";
    RelayExtDcVoltageMissing: "RELAY EXT. DC VOLTAGE MISSING", on TNC_15X "RELAY EXT-DC VOLTAGE MISSING";
        cause "The control waits for the control voltage of the machine.";
        remedy "Switch the control voltage on.";
        source "[000:6184] [001:927-933]";
    EmergencyStopDefective: "EMERGENCY STOP DEFECTIVE";
        cause "The acknowledgement 'control is ready' did not fall in time when the output was tested.";
        remedy "Switch off and check the EMERGENCY STOP circuit.";
        source "[000:6186]";
    ExternalEmergencyStop: "EXTERNAL EMERGENCY STOP", on TNC_15X "EMERGENCY STOP";
        cause "The acknowledgement 'control is ready' was lost.";
        remedy "Release the EMERGENCY STOP button, switch the control voltage on and clear the message with CE.";
        source "[000:6155] [000:6203-6204] [001:933]";
    EmergencyStopPlc: "EMERGENCY STOP PLC";
        cause "The PLC program asks for a flashing message and names none.";
        remedy "Switch off, find the cause in the machine, and start again.";
        source "[000:6633]";
    ErrorInPlcProgram: "ERROR IN PLC-PROGRAM";
        cause "Markers of the PLC program contradict each other, or the program stopped; the code says where.";
        remedy "Check the key or switch that belongs to the code, and the PLC program.";
        source "[000:7543-7585] [000:5496-5498] [000:631-633]";
    LimitSwitch: "LIMIT SWITCH #";
        cause "A software limit switch is reached, or the path would pass it.";
        remedy "Traverse away from the limit, or change the program.";
        source "[000:3522-3534]";
    PositioningError: "POSITIONING ERROR #";
        cause "The servo lag, or the deviation in operation with feed precontrol, is greater than its first limit.";
        remedy "Clear the message with CE; check drive, mechanics and machine parameters.";
        source "[000:5192-5198] [000:5228-5234]";
    MeasuringSystemDefective: "MEASURING SYSTEM # DEFECTIVE";
        cause "Monitoring of the encoder: A amplitude, B edge separation, C distance-coded marks.";
        remedy "Switch off, check encoder and cable.";
        source "[000:3290-3297]";
    MaxToolLifeExpired: "MAX. TOOL LIFE EXPIRED";
        cause "The tool was in use longer than TIME2 and has no replacement tool.";
        remedy "Change the tool and reset its time.";
        source "[000:9171]";

    ProtectedPgm: "PROTECTED PGM";
        cause "The program is protected against erasing and editing: P stands after its first and last block.";
        remedy "Take the protection away with code number 86357, or work on a copy.";
        source "[000:17235] [003:1015-1023] [003:7028]";

    // Messages that no manual prints: files and programs that a real control would never hold.

    BlockNotKnown: "FUNCTION NOT AVAILABLE ON THIS CONTROL";
        cause "The block or function belongs to another control model.";
        remedy "Choose the control model it was written for, or program it with the functions of this one.";
        source "(own message of Bahn)";
    BlockNotSupported: "FUNCTION NOT YET SUPPORTED";
        cause "The control knows the function, but Bahn does not execute it yet.";
        remedy "Write what it does with the functions that are supported, or take the block out.";
        source "(own message of Bahn)";
    ProgramNotFound: "PROGRAM NOT FOUND";
        cause "The called program does not exist.";
        remedy "Put the program beside the calling one, or correct the name.";
        source "(own message of Bahn)";
    ToolNotDefined: "TOOL NOT DEFINED";
        cause "The called tool is in no TOOL DEF block and not in the tool table.";
        remedy "Define the tool before its TOOL CALL, or give a tool table.";
        source "(own message of Bahn)";
    ToolLocked: "TOOL LOCKED";
        cause "The called tool is locked in column TL of the tool table.";
        remedy "Release the tool in the table, or call another one.";
        source "(own message of Bahn)";
    EndlessLoop: "ENDLESS LOOP";
        cause "A jump or call repeats blocks without any movement and comes to no end.";
        remedy "Check the condition of the jump.";
        source "(own message of Bahn)";
    NotInBlockwiseTransfer: "NOT IN BLOCKWISE TRANSFER";
        cause "The block cannot be executed in a program that is transferred while it runs.";
        remedy "Load the program into the memory first, or take the block out.";
        source "(own message of Bahn)";
    EndOfProgramMissing: "END PGM MISSING";
        cause "The file ends without END PGM, so a part of the program may be lost.";
        remedy "Transfer the program again, or add the END PGM block.";
        source "(own message of Bahn)";
    UnexpectedText: "UNEXPECTED TEXT IN BLOCK";
        cause "The block holds a word that has no place there.";
        remedy "Correct the word or delete it.";
        source "(own message of Bahn)";
    ErrorBlock: "ERROR BLOCK IN PROGRAM";
        cause "A control stored the block as ERROR = ... because it could not read it.";
        remedy "Replace the block by what was meant.";
        source "(own message of Bahn)";
}
