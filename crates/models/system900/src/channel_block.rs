//! The fixed parameters of a channel by which it runs: commands, answers, states [002:3606-5270].

use crate::numbered::parameters;

parameters! {
/// A fixed parameter of a channel.
ChannelParameter {
    /// P7000: positions by logical axes, at the measuring signal [002:1543-1547].
    MeasuredPositions = 7000,
    /// P7032: display positions.
    DisplayPositions = 7032,
    /// P7064: programmed positions.
    ProgrammedPositions = 7064,
    /// P7096: programmed less display positions.
    DeltaPositions = 7096,
    /// P7128: display shifts.
    DisplayShifts = 7128,
    /// P8040: T is not read.
    ToolLock = 8040,
    /// P8045: a tool is taken into the spindle.
    TakeTool = 8045,
    /// P8046: the offset block is loaded.
    OffsetCommand = 8046,
    /// P8047: the spindle block goes back to the array.
    StoreTool = 8047,
    /// P8050: the tool for the PLC, its parameters follow.
    PlcTool = 8050,
    /// P8100: the tool in the spindle.
    SpindleTool = 8100,
    /// P8150: the tool that the path is computed with.
    OffsetTool = 8150,
    /// P8200: the tool of the block that is executed.
    RealTimeTool = 8200,
    /// P8500: message of the system, ends all channels.
    SystemMessage = 8500,
    /// P8501: message of high priority, ends the channel.
    HighMessage = 8501,
    /// P8502: message of low priority, stops the channel.
    LowMessage = 8502,
    /// P8503: message that is only shown.
    DisplayMessage = 8503,
    /// P8504: the axis that a message is about.
    MessageAxis = 8504,
    /// P8508: acknowledges the messages of the control [002:939-948].
    Acknowledge = 8508,
    /// P8510: locks in AUTO.
    AutomaticLocks = 8510,
    /// P8550: number of the channel.
    ChannelNumber = 8550,
    /// P8551: number of its axes.
    AxisCount = 8551,
    /// P8552: its highest logical axis.
    LastAxis = 8552,
    /// P8555: the work area [002:3432].
    WorkArea = 8555,
    /// P8559: the block waits for an M function with stop.
    WaitsForM = 8559,
    /// P8579: all reference points are taken.
    AllReferenced = 8579,
    /// P8681: the key MANUAL.
    ManualKey = 8681,
    /// P8682: the keys START and STOP [002:3613-3619].
    StartKey = 8682,
    /// P8683: the mode that is asked for [002:3621-3629].
    ModeRequest = 8683,
    /// P8684: start that is asked for [002:3636-3667].
    StartRequest = 8684,
    /// P8685: state of the program [002:3669-3680].
    ProgramState = 8685,
    /// P8686: how far a restart is [002:3697-3705].
    RestartInfo = 8686,
    /// P8690: an M function by hand.
    ManualM = 8690,
    /// P8695: block whose way was ended by M26.
    ResidualBlock = 8695,
    /// P8696: block in which a position was measured [002:3724-3729].
    MeasuredBlock = 8696,
    /// P8700: the loops are enabled [002:3752-3756].
    LoopsEnabled = 8700,
    /// P8701: the axes are enabled [002:3758-3762].
    AxesEnabled = 8701,
    /// P8702: the axes stop on their ramps [002:3764-3767].
    SafetyStop = 8702,
    /// P8703: the mode [002:3773-3787].
    Mode = 8703,
    /// P8704: start as the PLC gives it [002:3789-3797].
    Start = 8704,
    /// P8705: the program is broken off [002:3799-3803].
    Abort = 8705,
    /// P8706: the block is released [002:3801-3808].
    BlockRelease = 8706,
    /// P8709: the PLC says that all reference points are taken [002:3810-3816].
    Referenced = 8709,
    /// P8710: calls emergency program 1; those of the others follow [002:3856-3882].
    Emergency = 8710,
    /// P8711: calls emergency program 2.
    Emergency2 = 8711,
    /// P8712: calls emergency program 3.
    Emergency3 = 8712,
    /// P8713: calls emergency program 4.
    Emergency4 = 8713,
    /// P8715: the way of a block with M26 ends [002:3889-3890].
    EndWay = 8715,
    /// P8716: the measuring key of the software [002:3892-3894].
    MeasuringKey = 8716,
    /// P8717: a measured position may be taken, once 1, always 2 [002:3896-3901].
    MeasuringRelease = 8717,
    /// P8750: how axes are moved by hand [002:3983-3993].
    ManualMode = 8750,
    /// P8751: the logical axis that is moved by hand.
    ManualAxis = 8751,
    /// P8752: plus and minus by hand [002:3997-4009].
    ManualMove = 8752,
    /// P8754: greatest feed by hand.
    ManualFeedMax = 8754,
    /// P8755: feed by hand.
    ManualFeed = 8755,
    /// P8756: feed by hand as it acts.
    ManualFeedActual = 8756,
    /// P8760: the step as it acts.
    StepWidth = 8760,
    /// P8761: the next step.
    NextStep = 8761,
    /// P8762: which step of the table.
    StepPointer = 8762,
    /// P8763: the first of seven steps.
    StepTable = 8763,
    /// P8800: the program.
    Program = 8800,
    /// P8801: the block with which it starts.
    StartBlock = 8801,
    /// P8802: the program that was broken off.
    AbortProgram = 8802,
    /// P8803: the block that was broken off.
    AbortBlock = 8803,
    /// P8804: the next start is a restart at the contour [002:4165-4193].
    Restart = 8804,
    /// P8807: the place that was broken off in the order of execution.
    AbortPlace = 8807,
    /// P8813: no M function goes out [002:4268-4273].
    WithoutM = 8813,
    /// P8814: where single blocks stop.
    SingleRule = 8814,
    /// P8815: feed of a test.
    TestFeed = 8815,
    /// P8816: rapid traverse.
    RapidFeed = 8816,
    /// P8817: feed of the block that is executed.
    BlockFeed = 8817,
    /// P8818: programmed feeds, %.
    FeedPercent = 8818,
    /// P8820: emergency program 1 and its block; those of the others follow [002:4303-4314].
    EmergencyProgram = 8820,
    /// P8855: what a measured position is: as displayed, or that of the machine 1 [002:4629-4632].
    MeasuringReference = 8855,
    /// P8865: the override of the path.
    PathOverride = 8865,
    /// P8866: the override of relative positions.
    RelativeOverride = 8866,
    /// P8867: the override of absolute positions.
    AbsoluteOverride = 8867,
    /// P8891: axes whose moves hold the execution.
    AxisLock = 8891,
    /// P8892: mirrored axes [002:4762-4782].
    AxisMirror = 8892,
    /// P8900: the program that is executed.
    ActualProgram = 8900,
    /// P8901: the block that is executed.
    ActualBlock = 8901,
    /// P8906: the program that was broken off; 0 at M30.
    BrokenProgram = 8906,
    /// P8907: the block that was broken off; 0 at M30.
    BrokenBlock = 8907,
    /// P8910: the program with a fault.
    FaultProgram = 8910,
    /// P8911: the block with a fault.
    FaultBlock = 8911,
    /// P8936: the programmed feed.
    ProgrammedFeed = 8936,
    /// P8938: the feed.
    ActualFeed = 8938,
    /// P8940: rapid, line, circle.
    Interpolation = 8940,
    /// P9369: the zero point that acts [002:5116-5118].
    ZeroPoint = 9369,
}
}
