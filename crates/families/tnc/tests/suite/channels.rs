//! Two channels on one machine: one clock, one PLC, one EMERGENCY STOP; each with its axes, its panel, its program.

use std::sync::Arc;

use crate::support::bench::{bench, close, fourth};
use crate::support::{Build, Rig, Shelf};
use bahn_machine::Machine;
use bahn_parameters::{ParameterList, PerPlcAxis};
use bahn_path::{Axis, Curve, PerAxis, Position};
use bahn_tnc::{
    AxisId, Cartesian, ChannelError, ChannelSetup, Command, Control, HandOver, Kinematics, Mode, Offsets,
    Remembered, RunState, Setup, Shares, Snapshot, SpindleWiring, Window,
};

/// Panel, transfers and cam of the second channel: its window lies from M300 on. M50 is a wait mark: it is
/// acknowledged in both channels when both have come to it. At M60 of both, or with I30, Z goes to the second channel, at
/// M61 of both it comes back.
const SECOND: &str = "
       L     I20
       = M300
       =N M316
       L     I21
       = M340
       LN    I151
       = M303
       =N M319
       L     I4
       = M370
       L     W260
       == K+50
       = M390
       L     M390
       A     M2045
       = M390
       L     W128
       == K+50
       = M391
       L     M391
       A     M380
       = M391
       L     M390
       A     M391
       = M392
       L     W260
       == K+60
       = M393
       L     M393
       A     M2045
       = M393
       L     W260
       == K+61
       A     M2045
       = M396
       L     W128
       == K+61
       A     M380
       = M397
       L     M396
       A     M397
       = M502
       L     W128
       == K+60
       = M394
       L     M394
       A     M380
       = M394
       L     M393
       A     M394
       O     I30
       = M500
       L     M500
       A     M501
       = M395
       L     M502
       A     M503
       O     M395
       = M395
       L     M2045
       AN    M390
       AN    M393
       AN    M396
       O     M392
       O     M395
       = M2482
       L     M380
       AN    M391
       AN    M394
       AN    M397
       O     M392
       O     M395
       = M334
       L     M381
       = M335
       L     M382
       = M336
";

/// The window of the second channel.
fn window() -> Window {
    let bit = |name: &str| name.parse().unwrap();
    Window::default()
        // Panel M2448-M2479, acknowledgements from M2480 on, NC stop M2488.
        .markers(bit("M2448"), bit("M300"), 64)
        .markers(bit("M2556"), bit("M370"), 1)
        .markers(bit("M2045"), bit("M380"), 3)
        .number("W260".parse().unwrap(), "W128".parse().unwrap())
}

/// The machine with a second panel, and the programs 1.H and 2.H.
fn machine(first: &str) -> Build {
    bench(SECOND)
        .with(&fourth('C', ""))
        .plant(
            "NO_FEED = \"I151\"",
            "NO_FEED = \"I151\"\nSTART2 = \"I20\"\nSTOP2 = \"not I21\"",
        )
        .program("1.H", first)
}

/// X, Y, Z of the first channel at outputs 1 to 3; the second has one axis at output 4, which it calls X, too.
fn setups(first: &str, second: &str) -> (Setup, ChannelSetup, Machine) {
    let (setup, machine) = machine(first).setup();
    let mut parameters = setup.parameters.clone();
    for assignment in ["10=%00001", "50=%00001", "110.0=3", "120.0=3", "3010=0"] {
        parameters.assign(assignment).unwrap();
    }
    let axes = PerPlcAxis([AxisId::new(3), None, None, None, None]);
    (setup, channel(parameters, axes, second), machine)
}

/// A channel with the program 2.H.
fn channel(parameters: ParameterList, axes: PerPlcAxis<Option<AxisId>>, blocks: &str) -> ChannelSetup {
    let mut programs = Shelf::default();
    let text = format!("BEGIN PGM 2 MM\n{blocks}\nEND PGM 2 MM\n");
    programs.0.insert("2.H".to_owned(), text);
    ChannelSetup {
        parameters,
        axes,
        connectors: 0,
        spindle: SpindleWiring { output: 6, input: 6 },
        programs: Arc::new(programs),
        kinematics: Arc::new(Cartesian),
        window: window(),
        remembered: Remembered::default(),
    }
}

fn state(rig: &Rig, channel: usize) -> Snapshot {
    rig.control.snapshot_of(channel).unwrap()
}

fn nominal(rig: &Rig, channel: usize, letter: char) -> f64 {
    let axes = state(rig, channel).axes;
    axes.iter().find(|axis| axis.letter == letter).unwrap().nominal
}

fn tell(rig: &mut Rig, channel: usize, text: &str) {
    let command: Command = text.parse().unwrap();
    assert!(
        rig.control.command_to(channel, command),
        "{text}: {:?}",
        rig.messages()
    );
}

/// Both channels after the reference run, program 1 selected in the first, 2 in the second.
fn twin(first: &str, second: &str) -> Rig {
    let (setup, other, machine) = setups(first, second);
    ready(setup, other, machine)
}

fn ready(setup: Setup, other: ChannelSetup, machine: Machine) -> Rig {
    let mut control = Control::with_channels(setup, vec![other]).unwrap();
    let z = |to: usize, order: &str, done: &str| HandOver {
        axis: AxisId::new(2).unwrap(),
        to,
        letter: Axis::Z,
        index: 2,
        order: order.parse().unwrap(),
        done: done.parse().unwrap(),
    };
    control.hand_over_by(vec![z(1, "M500", "M501"), z(0, "M502", "M503")]);
    let mut rig = Rig { control, machine };
    if rig.messages() == ["POWER INTERRUPTED"] {
        rig.command("ce");
    }
    for mode in [Mode::Reference, Mode::Manual] {
        rig.until(60.0, "both channels are in a mode", |rig| {
            [0, 1].iter().all(|channel| state(rig, *channel).mode == mode)
        });
        if mode == Mode::Reference {
            start(&mut rig);
        }
    }
    for channel in [0, 1] {
        tell(&mut rig, channel, "mode full");
        tell(&mut rig, channel, &format!("select {}.H", channel + 1));
    }
    rig
}

/// NC start in both channels.
fn start(rig: &mut Rig) {
    for event in ["press", "release"] {
        rig.event(&format!("key NC_START {event}"));
        rig.event(&format!("key START2 {event}"));
        rig.seconds(0.1);
    }
}

fn until_ended(rig: &mut Rig) {
    rig.until(60.0, "both programs end", |rig| {
        [0, 1].iter().all(|channel| state(rig, *channel).ended)
    });
}

/// 60 mm at 600 mm/min take 6 s, 30 mm at 1200 mm/min 1.5 s: the second program ends while the first runs.
#[test]
fn two_programs_run_at_once() {
    let mut rig = twin(
        "L X+100 R0 FMAX\nL X+160 R0 F600",
        "L X+100 R0 FMAX\nL X+130 R0 F1200",
    );
    start(&mut rig);
    rig.until(20.0, "both cut", |rig| {
        [600.0, 1200.0]
            .iter()
            .enumerate()
            .all(|(channel, feed)| (state(rig, channel).feed_mm_min - feed).abs() < 1.0)
    });
    rig.until(5.0, "the second ends", |rig| state(rig, 1).ended);
    assert_eq!(state(&rig, 0).run, RunState::Running);
    assert!(!state(&rig, 0).ended);
    until_ended(&mut rig);
    assert_eq!((nominal(&rig, 0, 'X'), nominal(&rig, 1, 'X')), (160.0, 130.0));
}

/// NC stop in the window of the second channel stops its axis; the first goes on to its end.
#[test]
fn stopping_one_channel_leaves_the_other_running() {
    let blocks = "L X+100 R0 FMAX\nL X+160 R0 F600";
    let mut rig = twin(blocks, blocks);
    start(&mut rig);
    rig.until(20.0, "both cut", |rig| {
        (0..2).all(|channel| (state(rig, channel).feed_mm_min - 600.0).abs() < 1.0)
    });
    rig.event("key STOP2 press");
    rig.seconds(0.5);
    assert_eq!(state(&rig, 1).run, RunState::Interrupted);
    let stopped = nominal(&rig, 1, 'X');
    rig.until(20.0, "the first ends", |rig| state(rig, 0).ended);
    assert_eq!((nominal(&rig, 0, 'X'), nominal(&rig, 1, 'X')), (160.0, stopped));
    assert!(stopped < 160.0);
    rig.event("key STOP2 release");
    rig.seconds(0.1);
    start(&mut rig);
    until_ended(&mut rig);
    assert_eq!(nominal(&rig, 1, 'X'), 160.0);
}

#[test]
fn emergency_stop_stops_both() {
    let blocks = "L X+100 R0 FMAX\nL X+160 R0 F600";
    let mut rig = twin(blocks, blocks);
    start(&mut rig);
    rig.until(20.0, "both cut", |rig| {
        (0..2).all(|channel| (state(rig, channel).feed_mm_min - 600.0).abs() < 1.0)
    });
    rig.event("emergency press");
    rig.seconds(1.0);
    for channel in [0, 1] {
        let state = state(&rig, channel);
        assert_eq!(state.run, RunState::Interrupted, "channel {channel}");
        assert!(state.axes.iter().all(|axis| !axis.closed), "channel {channel}");
    }
    assert_eq!(rig.messages(), ["EXTERNAL EMERGENCY STOP"]);
}

/// M50 holds the first channel at 120 until the second one comes to its M50: 60 mm at 600 mm/min later.
#[test]
fn programs_wait_for_each_other() {
    let mut rig = twin(
        "L X+120 R0 FMAX\nM50\nL X+150 R0 F3000",
        "L X+100 R0 FMAX\nL X+160 R0 F600\nM50\nL X+100 R0 F3000",
    );
    start(&mut rig);
    rig.until(20.0, "the second cuts", |rig| {
        (state(rig, 1).feed_mm_min - 600.0).abs() < 1.0
    });
    rig.until(20.0, "the second is there", |rig| nominal(rig, 1, 'X') == 160.0);
    assert_eq!(nominal(&rig, 0, 'X'), 120.0, "the first waits");
    rig.until(1.0, "the first goes on", |rig| nominal(rig, 0, 'X') != 120.0);
    // Both strobes fall with the same scan; the second has still to come into position.
    rig.seconds(0.1);
    assert!(nominal(&rig, 1, 'X') < 160.0);
    until_ended(&mut rig);
    assert_eq!((nominal(&rig, 0, 'X'), nominal(&rig, 1, 'X')), (150.0, 100.0));
}

fn letters(rig: &Rig, channel: usize) -> String {
    let view = rig.control.channel(channel).unwrap();
    view.axis_letters().collect()
}

/// Z goes from the first channel to the second between their programs, and a program of the second one moves it.
#[test]
fn an_axis_is_handed_over_between_programs() {
    let mut rig = twin("L Z+100 R0 FMAX", "L X+90 R0 FMAX\nL Z+140 R0 FMAX");
    rig.event("key NC_START press");
    rig.until(2.0, "the first runs", |rig| {
        state(rig, 0).run == RunState::Running
    });
    rig.input("I30", true);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["AXIS Z NOT HANDED OVER: A PROGRAM IS RUNNING"]);
    assert_eq!((rig.bit("M501"), letters(&rig, 0)), (false, "XYZ".to_owned()));
    rig.command("ce");
    rig.input("I30", false);
    rig.event("key NC_START release");
    rig.until(20.0, "the first ends", |rig| state(rig, 0).ended);
    rig.seconds(0.2);
    assert!(
        rig.bit("M2002") && !rig.bit("M501"),
        "Z is held in its loop, says the window of the first"
    );
    rig.input("I30", true);
    rig.seconds(0.1);
    assert!(rig.bit("M501") && !rig.bit("M2002"), "it has no Z any more");
    assert_eq!(
        (letters(&rig, 0), letters(&rig, 1)),
        ("XY".to_owned(), "ZX".to_owned())
    );
    rig.input("I30", false);
    rig.seconds(0.1);
    assert!(!rig.bit("M501"), "done falls with the order");
    rig.event("key START2 press");
    rig.until(20.0, "the second ends", |rig| state(rig, 1).ended);
    assert_eq!((nominal(&rig, 1, 'X'), nominal(&rig, 1, 'Z')), (90.0, 140.0));
    close(rig.table('Z'), 140.0, 0.1);
    assert!(rig.messages().is_empty());
}

/// Both programs come to M60, the second one 6 s later; there Z goes over, and the blocks after it move what each
/// channel has then. Nobody has begun them before.
#[test]
fn an_axis_is_handed_over_while_programs_run() {
    let mut rig = twin(
        "L Z+100 R0 FMAX\nM60\nL X+150 R0 F3000",
        "L X+100 R0 FMAX\nL X+160 R0 F600\nM60\nL Z+140 X+120 R0 F3000\nL IZ+5 R0 F3000",
    );
    let stood = nominal(&rig, 0, 'X');
    start(&mut rig);
    rig.until(20.0, "the second cuts", |rig| {
        (state(rig, 1).feed_mm_min - 600.0).abs() < 1.0
    });
    rig.until(10.0, "Z goes over", |rig| letters(rig, 1) == "ZX");
    assert_eq!(
        (
            nominal(&rig, 0, 'X'),
            nominal(&rig, 1, 'X'),
            nominal(&rig, 1, 'Z')
        ),
        (stood, 160.0, 100.0)
    );
    close(rig.table('Z'), 100.0, 0.1);
    until_ended(&mut rig);
    assert_eq!(letters(&rig, 0), "XY");
    assert_eq!(nominal(&rig, 0, 'X'), 150.0);
    assert_eq!((nominal(&rig, 1, 'X'), nominal(&rig, 1, 'Z')), (120.0, 145.0));
    close(rig.table('Z'), 145.0, 0.1);
    assert!(!rig.bit("M500") && !rig.bit("M501") && rig.messages().is_empty());
}

/// A block that moves an axis which the channel has given away, or has not got yet, is refused where it stands.
#[test]
fn an_axis_of_the_other_channel_is_not_moved() {
    let mut rig = twin(
        "L Z+100 R0 FMAX\nM60\nL X+60 R0 F3000\nL Z+90 R0 FMAX",
        "L X+100 R0 FMAX\nL Z+120 R0 FMAX\nM60\nL X+90 R0 FMAX",
    );
    start(&mut rig);
    rig.until(20.0, "the second is refused", |rig| !rig.messages().is_empty());
    let refused = |channel: usize, block: u32| {
        format!("{channel}: WRONG AXIS PROGRAMMED program {channel}.H block {block}: there is no axis Z here")
    };
    let shown = |rig: &Rig| -> Vec<String> {
        let shown = state(rig, 0).messages;
        let text = |shown: &bahn_tnc::Shown| rig.control.shown_text(shown);
        shown
            .iter()
            .map(|shown| format!("{} {}", text(shown), shown.message.place().unwrap()))
            .collect()
    };
    assert_eq!(shown(&rig), [refused(2, 2)]);
    assert_eq!(nominal(&rig, 1, 'X'), 100.0, "the block before it was executed");
    rig.command("ce");
    // From block 3 on it goes: Z goes over, and the first channel cannot move it any more.
    tell(&mut rig, 1, "goto 3");
    rig.event("key START2 press");
    rig.until(20.0, "the first is refused", |rig| !rig.messages().is_empty());
    assert_eq!(shown(&rig), [refused(1, 4)]);
    assert_eq!((nominal(&rig, 0, 'X'), letters(&rig, 0)), (60.0, "XY".to_owned()));
    rig.until(20.0, "the second ends", |rig| state(rig, 1).ended);
}

/// To and fro, again and again: each time the axis goes on from where the other channel has left it, and never faster
/// than its rapid traverse of 6 m/min: 0.3 mm in a cycle of 3 ms.
#[test]
fn an_axis_goes_to_and_fro_without_a_jump() {
    let mut rig = twin(
        "L Z+100 R0 FMAX\nLBL 1\nM60\nL IX+5 R0 F3000\nM61\nL IZ-4 R0 F3000\nCALL LBL 1 REP 2/2",
        "L X+100 R0 FMAX\nLBL 1\nM60\nL IZ+14 R0 F3000\nL IX+3 R0 F3000\nM61\nCALL LBL 1 REP 2/2\nL X+90 R0 FMAX",
    );
    start(&mut rig);
    let (mut before, mut gone, mut own) = (rig.machine.axis('Z').unwrap().motor_position, 0, "X".to_owned());
    let end = rig.control.time_us() + 40_000_000;
    while !(0..2).all(|channel| state(&rig, channel).ended) {
        assert!(
            rig.control.time_us() < end,
            "{:?} {:?}",
            rig.messages(),
            state(&rig, 0)
        );
        rig.cycle();
        let now = rig.machine.axis('Z').unwrap().motor_position;
        assert!((now - before).abs() < 0.301, "a jump of {} mm", now - before);
        before = now;
        let letters = letters(&rig, 1);
        gone += usize::from(letters == "ZX" && own == "X");
        own = letters;
    }
    assert_eq!(gone, 3);
    // Three rounds of +14 and -4 from 100.
    assert_eq!(nominal(&rig, 0, 'Z'), 130.0);
    close(rig.table('Z'), 130.0, 0.1);
    assert!(rig.messages().is_empty());
}

/// A programmed stop is a place, too; an axis that moves for somebody stays, and so does one whose letter is taken there.
#[test]
fn an_axis_is_handed_over_at_a_programmed_stop() {
    let mut rig = twin(
        "L Z+100 R0 FMAX\nSTOP\nL X+60 R0 FMAX",
        "L X+100 R0 FMAX\nSTOP\nL Z+110 R0 FMAX",
    );
    start(&mut rig);
    rig.until(20.0, "both have stopped", |rig| {
        (0..2).all(|channel| state(rig, channel).run == RunState::Stopped)
    });
    rig.input("I30", true);
    rig.until(1.0, "it goes over", |rig| letters(rig, 1) == "ZX");
    rig.input("I30", false);
    rig.seconds(0.1);
    start(&mut rig);
    until_ended(&mut rig);
    assert_eq!((nominal(&rig, 0, 'X'), nominal(&rig, 1, 'Z')), (60.0, 110.0));
    assert!(rig.messages().is_empty());
    // By hand in the second channel: it moves there, and does not come back meanwhile.
    tell(&mut rig, 0, "mode manual");
    rig.event("key Z+ press");
    rig.seconds(0.5);
    assert_eq!(
        nominal(&rig, 1, 'Z'),
        110.0,
        "the keys of the first channel have no Z"
    );
    rig.event("key Z+ release");
}

#[test]
fn an_axis_that_moves_or_finds_no_place_stays() {
    let (setup, other, machine) = setups("L Z+100 R0 FMAX", "L X+90 R0 FMAX");
    let mut rig = ready(setup, other, machine);
    // As X at index 0, which the second channel has.
    let taken = HandOver {
        axis: AxisId::new(2).unwrap(),
        to: 1,
        letter: Axis::X,
        index: 2,
        order: "M500".parse().unwrap(),
        done: "M501".parse().unwrap(),
    };
    rig.control.hand_over_by(vec![taken]);
    rig.input("I30", true);
    rig.seconds(0.1);
    assert_eq!(
        rig.messages(),
        ["AXIS Z NOT HANDED OVER: LETTER OR INDEX IS TAKEN"]
    );
    rig.command("ce");
    rig.seconds(0.1);
    assert!(rig.messages().is_empty(), "said once for an order");
    rig.input("I30", false);
    rig.seconds(0.1);
    rig.control.hand_over_by(vec![HandOver {
        letter: Axis::Z,
        ..taken
    }]);
    tell(&mut rig, 0, "mode manual");
    rig.event("key Z+ press");
    rig.seconds(0.5);
    rig.input("I30", true);
    rig.seconds(0.1);
    assert_eq!(rig.messages(), ["AXIS Z NOT HANDED OVER: THE AXIS MOVES"]);
    assert_eq!(letters(&rig, 0), "XYZ");
    rig.event("key Z+ release");
    rig.until(2.0, "it goes when it stands", |rig| letters(rig, 1) == "ZX");
}

/// What was told to which channel is logged; given again it repeats the run to the bit.
#[test]
fn the_command_log_knows_the_channels() {
    let drive = |given: &[(u64, usize, Command)]| {
        let mut rig = twin(
            "L Z+100 R0 FMAX\nM60\nL X+150 R0 F3000",
            "L X+160 R0 F1200\nM60\nL Z+140 R0 F3000",
        );
        rig.control.keep_command_log();
        let (begin, mut seen, mut given) = (rig.control.time_us(), Vec::new(), given.iter().peekable());
        start(&mut rig);
        while rig.control.time_us() < begin + 12_000_000 {
            while let Some((_, channel, command)) = given.next_if(|(time, ..)| *time <= rig.control.time_us())
            {
                rig.control.command_to(*channel, command.clone());
            }
            rig.cycle();
            let both = [0, 1].map(|channel| format!("{:?}", state(&rig, channel)));
            seen.push(both);
        }
        assert!(state(&rig, 1).ended);
        (rig.control.take_command_log().unwrap(), seen)
    };
    let begin = twin("M8", "M8").control.time_us();
    let given: Vec<(u64, usize, Command)> = [
        (500_000, 1, "jog 2"),
        (900_000, 0, "ce"),
        (9_000_000, 1, "mode manual"),
        (9_600_000, 1, "datum X 12.5"),
    ]
    .map(|(time, channel, text)| (begin + time, channel, text.parse().unwrap()))
    .into();
    let (log, seen) = drive(&given);
    let reported: Vec<(usize, String)> = log
        .iter()
        .map(|(_, channel, command)| (*channel, command.to_string()))
        .collect();
    let expected = [(1, "jog 2"), (0, "ce"), (1, "mode manual"), (1, "datum X 12.5")];
    assert_eq!(
        reported,
        expected.map(|(channel, text)| (channel, text.to_owned()))
    );
    let (again, repeated) = drive(&log);
    assert_eq!((again, repeated == seen), (log, true));
    assert!(!seen.last().unwrap()[0].contains("12.5") && seen.last().unwrap()[1].contains("12.5"));
}

/// A clone goes on as the control does: the same bits.
#[test]
fn a_clone_goes_on_in_the_same_way() {
    let blocks = "L X+100 R0 FMAX\nL X+160 R0 F600 M8\nL X+90 F2000";
    let mut rig = twin(blocks, blocks);
    start(&mut rig);
    rig.seconds(2.0);
    let mut copy = Rig {
        control: rig.control.clone(),
        machine: rig.machine.clone(),
    };
    for _ in 0..2000 {
        rig.cycle();
        copy.cycle();
        for channel in [0, 1] {
            assert_eq!(state(&rig, channel), state(&copy, channel));
        }
    }
    assert!((0..2).all(|channel| state(&rig, channel).time_us > 2_000_000));
}

#[test]
fn channels_are_put_together_with_care() {
    let (setup, mut other, _) = setups("L X+1 R0 F100", "L X+1 R0 F100");
    let many = vec![other.clone(); 8];
    assert_eq!(
        Control::with_channels(setup.clone(), many).err(),
        Some(ChannelError::TooMany)
    );
    let x = AxisId::new(0).unwrap();
    other.axes = PerPlcAxis([Some(x), None, None, None, None]);
    assert_eq!(
        Control::with_channels(setup, vec![other]).err(),
        Some(ChannelError::AxisTwice(x))
    );
    assert_eq!(AxisId::new(5), None, "left to the spindle");
}

/// A portal that leans: its X axis goes half a millimetre with each millimetre in Y.
#[derive(Debug)]
struct Leaning;

impl Kinematics for Leaning {
    fn to_axes(&self, path: &Position, offsets: &Offsets) -> Position {
        let mut axes = Cartesian.to_axes(path, offsets);
        axes[Axis::X] += 0.5 * path[Axis::Y];
        axes
    }

    fn to_path(&self, axes: &Position, offsets: &Offsets) -> Position {
        let mut path = Cartesian.to_path(axes, offsets);
        path[Axis::X] -= 0.5 * path[Axis::Y];
        path
    }

    fn bounds(&self, _: &Curve, start: &Position, end: &Position, offsets: &Offsets) -> [Position; 2] {
        // On a straight line the axes are farthest at its ends.
        let [a, b] = [start, end].map(|at| self.to_axes(at, offsets));
        [f64::min, f64::max].map(|bound| PerAxis::from_fn(|axis| bound(a[axis], b[axis])).into())
    }

    fn shares(&self) -> Shares {
        let mut shares = Cartesian.shares();
        shares[Axis::X][Axis::Y] = 0.5;
        shares
    }
}

/// The second channel has X and Y on the leaning portal, with these parameters beside its own.
fn leaning(program: &str, parameters_of_it: &[&str]) -> Rig {
    let build = machine("L Z+60 R0 FMAX").mps("10=%00100 50=%00100");
    let (setup, machine) = build.setup();
    let mut parameters = setup.parameters.clone();
    for assignment in ["10=%00011", "50=%00011", "3010=0"]
        .iter()
        .chain(parameters_of_it)
    {
        parameters.assign(assignment).unwrap();
    }
    let axes = PerPlcAxis([AxisId::new(6), AxisId::new(7), None, None, None]);
    let mut other = channel(parameters, axes, program);
    other.kinematics = Arc::new(Leaning);
    let cams = "M2556".parse().unwrap();
    other.window = other.window.markers(cams, cams, 2);
    ready(setup, other, machine)
}

/// X of the leaning portal takes 3000 mm/min and 0.5 m/s²; going at 45 degrees it moves one and a half times as fast as
/// the path does in X. It keeps to its limits, and comes near them.
#[test]
fn feed_and_acceleration_are_limited_after_the_kinematics() {
    let program = "L X+40 Y+40 R0 FMAX\nL X+60 Y+60 FMAX";
    let mut rig = leaning(program, &["1010.0=3000", "1050.0=4.5", "1060.0=0.5"]);
    rig.event("key START2 press");
    let cycle_s = 0.003;
    let place = |rig: &Rig| nominal(rig, 1, 'X') + 0.5 * nominal(rig, 1, 'Y');
    let (mut before, mut speed) = (place(&rig), 0.0);
    let (mut fastest, mut hardest) = (0.0f64, 0.0f64);
    for _ in 0..3000 {
        rig.cycle();
        let now = place(&rig);
        let next = (now - before) / cycle_s;
        (fastest, hardest) = (
            fastest.max(next.abs()),
            hardest.max((next - speed).abs() / cycle_s),
        );
        (before, speed) = (now, next);
    }
    assert!((nominal(&rig, 1, 'Y') - 60.0).abs() < 1e-9);
    assert!((49.0..=50.0 + 1e-6).contains(&fastest), "{fastest} mm/s");
    // The path has the acceleration of its weakest slot, 500 / 1.5; X gets 1.5 / √2 of it.
    let expected = 500.0 / 2.0f64.sqrt();
    assert!((hardest - expected).abs() < 1.0, "{hardest} mm/s²");
}

/// The second channel has X and Y on the leaning portal: X+60 Y+80 is X at 60 + 40 = 100 mm. X+120 Y+110 would be X at
/// 175 mm, beyond its limit of 170 mm, while X+110 Y+110 at 165 mm is not.
#[test]
fn limits_are_checked_after_the_kinematics() {
    let program = "L X+60 Y+80 R0 F3000\nL X+110 Y+110\nL X+120 Y+110";
    let mut rig = leaning(program, &[]);
    let machine_x = |rig: &Rig| {
        let axes = state(rig, 1).axes;
        axes.iter().find(|axis| axis.letter == 'X').unwrap().machine
    };
    rig.event("key START2 press");
    rig.until(20.0, "the first block ends", |rig| nominal(rig, 1, 'Y') == 80.0);
    rig.until(20.0, "the last block is refused", |rig| {
        !rig.messages().is_empty()
    });
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    assert!((nominal(&rig, 1, 'X') - 110.0).abs() < 1e-9 && nominal(&rig, 1, 'Y') == 110.0);
    let (x, table) = (machine_x(&rig), rig.table('X'));
    assert!((x - 165.0).abs() < 0.1, "X is at {x}");
    assert!((table - 165.0).abs() < 0.1, "the table is at {table}");
}
