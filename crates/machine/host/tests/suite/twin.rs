//! The twin: two channels on one machine, loaded from its folder, driven, stopped, handed an axis, kept over power-off.

use std::sync::{Arc, Mutex};

use crate::support::*;
use bahn_host::{
    Action, Answer, Attendance, FolderPrograms, Host, HostError, Job, LoadedMachine, Next, Notice, Observed,
    Operator, PowerOn, Sink, Source, Stage, Timeline,
};
use bahn_tnc::{AxisId, ChannelError, ChannelView, RunState, Shown};

fn twin() -> Host {
    let machine = machine("twin");
    switched_on(&machine, PowerOn::fresh(&machine), Attendance::Full)
}

/// Both channels with the programs of machine.toml.
fn switched_on(machine: &LoadedMachine, power_on: PowerOn, attendance: Attendance) -> Host {
    let job = |channel| machine.usual_program(channel).map(Job::whole);
    let operator = Operator::new(attendance, machine.folder.operator.clone(), job(0));
    let operator = operator.with_channel(machine.channels[0].folder.operator.clone(), job(1));
    let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
    Host::new(machine, power_on, programs, operator).unwrap()
}

/// Channels that cannot be put together are no machine, and never another one with fewer of them.
#[test]
fn channels_that_do_not_fit_are_an_error() {
    let on = |machine: &LoadedMachine, power_on| {
        let operator = Operator::new(Attendance::Absent, machine.folder.operator.clone(), None);
        let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
        Host::new(machine, power_on, programs, operator).err()
    };
    let mut twin = machine("twin");
    assert_eq!(on(&twin, PowerOn::fresh(&twin)), None);
    let mut power_on = PowerOn::fresh(&twin);
    power_on.channels.clear();
    assert_eq!(on(&twin, power_on), Some(HostError::ChannelsMissing(1, 0)));
    // X of the first channel is taken by X of the second.
    twin.channels[0].axes[0] = Some(AxisId::FIRST);
    let twice = ChannelError::AxisTwice(AxisId::FIRST);
    assert_eq!(on(&twin, PowerOn::fresh(&twin)), Some(HostError::Channels(twice)));
}

fn channel(host: &Host, number: usize) -> ChannelView<'_> {
    host.control().channel(number).unwrap()
}

fn see(host: &Host, signal: &str) -> f64 {
    let observed: Observed = signal.parse().unwrap();
    observed.value(host.control(), host.plant())
}

fn letters(host: &Host, number: usize) -> String {
    channel(host, number).axis_letters().collect()
}

fn action(host: &mut Host, text: &str) {
    let done = host.act(Source::Script, Action::parse(text).unwrap()).unwrap();
    assert_eq!(done, Answer::Done, "{text}");
}

fn shown(host: &Host) -> Vec<String> {
    let shown = host.control().shown();
    shown
        .iter()
        .map(|shown| host.control().shown_text(shown))
        .collect()
}

#[track_caller]
fn until(host: &mut Host, seconds: f64, what: &str, so: impl Fn(&Host) -> bool) {
    let end_us = host.control().time_us() + (seconds * 1e6) as u64;
    while !so(host) {
        let time_us = host.control().time_us();
        assert!(
            time_us < end_us,
            "not within {seconds} s: {what}; {:?}",
            shown(host)
        );
        host.step().unwrap();
    }
}

fn cuts(host: &Host, number: usize, feed: f64) -> bool {
    (channel(host, number).snapshot().feed_mm_min - feed).abs() < 1.0
}

/// Seven axes, all referenced; datum of the left table X 200 Y 120 Z 120, of the right one X 220 Y 130 Z 110.
#[test]
fn both_programs_run_and_the_arm_goes_to_the_other_channel_and_comes_back() {
    let mut host = twin();
    let notices = host.notices();
    until(&mut host, 30.0, "both cut", |host| {
        cuts(host, 0, 1500.0) && cuts(host, 1, 800.0)
    });
    for number in [0, 1] {
        assert!(
            channel(&host, number)
                .snapshot()
                .axes
                .iter()
                .all(|axis| axis.referenced && axis.closed)
        );
    }
    assert_eq!(host.plant().axes().count(), 7);
    // The left one comes to M60 first and waits there.
    until(&mut host, 10.0, "the left waits", |host| {
        see(host, "M2045") == 1.0
    });
    seconds(&mut host, 1.0);
    assert_eq!((see(&host, "W260"), see(&host, "X.nominal")), (60.0, 280.0));
    assert!(cuts(&host, 1, 800.0));
    assert_eq!(
        (letters(&host, 0), letters(&host, 1)),
        ("XYZC".to_owned(), "XYZ".to_owned())
    );
    until(&mut host, 10.0, "the arm goes over", |host| {
        letters(host, 1) == "XYZC" || letters(host, 1) == "CXYZ"
    });
    assert_eq!(
        (see(&host, "2:X.nominal"), see(&host, "2:C.nominal")),
        (290.0, 0.0)
    );
    // Both go on at the same time: the right one turns the arm, the left one goes to its next slot.
    until(&mut host, 1.0, "both move", |host| {
        see(host, "path.speed") > 1000.0 && see(host, "2:path.speed") > 1000.0
    });
    until(&mut host, 5.0, "the arm is over the right table", |host| {
        see(host, "2:C.nominal") == 180.0
    });
    let arm = |host: &Host| host.plant().axis('C').unwrap().position;
    seconds(&mut host, 0.2);
    assert!((arm(&host) - 180.0).abs() < 0.01, "{}", arm(&host));
    until(&mut host, 20.0, "the arm comes back", |host| {
        letters(host, 0).contains('C')
    });
    until(&mut host, 20.0, "both end", |host| {
        (0..2).all(|number| channel(host, number).has_ended())
    });
    let ends = ["X", "Y", "Z", "C", "2:X", "2:Y", "2:Z"].map(|axis| see(&host, &format!("{axis}.nominal")));
    // Z+100 above the datum with the tools 95 and 85 mm long: 120 + 100 + 95 and 110 + 100 + 85.
    assert_eq!(ends, [280.0, 140.0, 315.0, 90.0, 250.0, 130.0, 295.0]);
    seconds(&mut host, 0.5);
    assert!((arm(&host) - 90.0).abs() < 0.01, "{}", arm(&host));
    let mut ended = Vec::new();
    for next in notices {
        if let Next::Item(stamped) = next
            && stamped.notice == Notice::Ended
        {
            ended.push(stamped.channel);
        }
    }
    ended.sort_unstable();
    assert_eq!(ended, [0, 1], "each channel tells its end");
}

#[test]
fn stopping_one_channel_leaves_the_other_running() {
    for (key, stopped, other) in [("STOP2", 1, 0), ("NC_STOP", 0, 1)] {
        let mut host = twin();
        until(&mut host, 30.0, "both cut", |host| {
            cuts(host, 0, 1500.0) && cuts(host, 1, 800.0)
        });
        action(&mut host, &format!("key {key} press"));
        seconds(&mut host, 0.5);
        let states = [stopped, other].map(|number| channel(&host, number).run_state());
        assert_eq!(states, [RunState::Interrupted, RunState::Running], "{key}");
        assert_eq!(channel(&host, stopped).snapshot().feed_mm_min, 0.0);
        assert!(channel(&host, other).snapshot().feed_mm_min > 700.0);
        action(&mut host, &format!("key {key} release"));
        seconds(&mut host, 0.1);
        action(&mut host, &format!("key {} tap", ["NC_START", "START2"][stopped]));
        until(&mut host, 60.0, "both end", |host| {
            (0..2).all(|number| channel(host, number).has_ended())
        });
    }
}

#[test]
fn emergency_stop_stops_both() {
    let mut host = twin();
    until(&mut host, 30.0, "both cut", |host| {
        cuts(host, 0, 1500.0) && cuts(host, 1, 800.0)
    });
    action(&mut host, "emergency press");
    seconds(&mut host, 1.0);
    for number in [0, 1] {
        let state = channel(&host, number).snapshot();
        assert_eq!(
            (state.run, state.feed_mm_min),
            (RunState::Interrupted, 0.0),
            "channel {number}"
        );
        assert!(state.axes.iter().all(|axis| !axis.closed), "channel {number}");
    }
    assert_eq!(
        shown(&host),
        ["EXTERNAL EMERGENCY STOP"],
        "of the machine as a whole"
    );
    assert!(host.plant().axes().all(|axis| axis.speed_per_min.abs() < 1.0));
}

/// What a channel says has its number; a block beyond the limit of the right table stops the right channel only.
#[test]
fn messages_name_their_channel() {
    let machine = machine("twin");
    let mut power_on = PowerOn::fresh(&machine);
    power_on.channels[0].programs = Texts::new(&[("RIGHT.H", "L X+300 R0 FMAX\nL X+400 R0 FMAX")]);
    let mut host = switched_on(&machine, power_on, Attendance::Start);
    let notices = host.notices();
    until(&mut host, 30.0, "the limit is found", |host| {
        channel(host, 1).is_broken()
    });
    // 220 + 400 is beyond 610 mm.
    let own: Vec<String> = shown(&host)
        .into_iter()
        .filter(|text| text.contains("LIMIT"))
        .collect();
    assert_eq!(own, ["2: LIMIT SWITCH X+"]);
    assert_eq!(channel(&host, 0).run_state(), RunState::Running);
    let mut found: Option<Shown> = None;
    for next in notices {
        if let Next::Item(stamped) = next
            && let Notice::Shown(shown) = stamped.notice
            && stamped.channel == 1
        {
            found = Some(shown);
        }
    }
    assert_eq!(found.unwrap().channel, Some(1));
    action(&mut host, "2: mode manual");
    let no_channel = host.act(Source::Script, Action::parse("3: ce").unwrap()).unwrap();
    assert_eq!(
        no_channel,
        Answer::Impossible("the machine has no channel 3".to_owned())
    );
}

/// A tool change of the right channel is on the medium before its strobe falls; its datum, tool and Q parameters are there
/// after power-off, and those of the left one are others.
#[test]
fn each_channel_keeps_what_survives_power_off() {
    let copy = Copy::of("twin", "kept");
    let load = || LoadedMachine::load(copy.path()).unwrap().unwrap();
    let file = copy.path().join("state/control-2.toml");
    let machine = load();
    let mut power_on = PowerOn::kept(&machine).unwrap();
    let block = "FN 0: Q1 = +7\nTOOL CALL 3 Z S0\nL X+30 R0 FMAX";
    power_on.channels[0].programs = Texts::new(&[("RIGHT.H", block)]);
    let mut host = switched_on(&machine, power_on, Attendance::Full);
    until(&mut host, 30.0, "the tool is called", |host| {
        see(host, "M353") == 1.0
    });
    until(&mut host, 10.0, "the strobe falls", |host| {
        see(host, "M353") == 0.0
    });
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(
        text.contains("tool = 3\n") && text.contains("tool_length = 85.0\n"),
        "{text}"
    );
    until(&mut host, 10.0, "the right one ends", |host| {
        channel(host, 1).has_ended()
    });
    action(&mut host, "2: mode manual");
    action(&mut host, "2: datum Y 12.5");
    let datum = see(&host, "2:Y.actual") - 12.5;
    host.store().unwrap();
    let remembered = channel(&host, 1).remember();
    drop(host);
    let again = load();
    let power_on = PowerOn::kept(&again).unwrap();
    let found = &power_on.channels[0].remembered;
    assert_eq!(*found, remembered);
    assert_eq!((found.tool, found.q.contains(&(1, 7.0))), (3, true));
    assert!((found.datums[0].0[bahn_path::Axis::Y] - datum).abs() < 1e-9);
    assert_eq!(
        (
            power_on.remembered.tool,
            power_on.remembered.datums[0].0[bahn_path::Axis::Y]
        ),
        (2, 120.0)
    );
    drop(power_on);
    // A damaged file starts no machine.
    std::fs::write(&file, text.replace("tool = 3", "tool = 4")).unwrap();
    let error = PowerOn::kept(&again).err().unwrap().to_string();
    assert!(
        error.contains("control-2.toml: its check sum is wrong"),
        "{error}"
    );
}

const SIGNALS: [&str; 12] = [
    "X.actual",
    "Y.actual",
    "Z.actual",
    "C.actual",
    "path.speed",
    "S.rpm",
    "2:X.actual",
    "2:Z.actual",
    "2:C.actual",
    "2:path.speed",
    "2:S.rpm",
    "M200",
];

fn bits(host: &Host) -> Vec<u64> {
    let signals = SIGNALS.iter().map(|signal| see(host, signal).to_bits());
    signals
        .chain(host.plant().axes().map(|axis| axis.position.to_bits()))
        .collect()
}

/// Moments before, while and after the arm changes hands are reached again to the bit, with a command to each channel.
#[test]
fn a_moment_of_two_channels_is_reached_again_to_the_bit() {
    let mut host = twin();
    let mut timeline = Timeline::new(3_000_000, 16);
    let mut trail = Vec::new();
    let cycle_us = u64::from(host.control().cycle_us());
    let act = |host: &mut Host, cycle: usize| match cycle {
        5000 => action(host, "2: jog 2"),
        6500 => action(host, "jog 3"),
        7000 => action(host, "key STOP2 tap"),
        7300 => action(host, "key START2 tap"),
        _ => {}
    };
    let mut gone = 0;
    for cycle in 0..14_000 {
        trail.push(bits(&host));
        act(&mut host, cycle);
        host.step().unwrap();
        timeline.follow(&mut host);
        if gone == 0 && letters(&host, 1).contains('C') {
            gone = cycle;
        }
    }
    assert!(
        gone > 7300 && letters(&host, 0).contains('C'),
        "it has gone and come back"
    );
    for moment in [13_000, gone + 1, gone - 2, 7001, 5001] {
        let time_us = moment as u64 * cycle_us;
        let saved = timeline.nearest(time_us).unwrap().clone();
        host.replay(&saved, time_us).unwrap();
        for (cycle, expected) in trail.iter().enumerate().skip(moment).take(300) {
            assert_eq!(bits(&host), *expected, "cycle {cycle} from {moment}");
            act(&mut host, cycle);
            host.step().unwrap();
        }
    }
}

#[derive(Clone, Default)]
struct Notes(Arc<Mutex<String>>);

impl Sink for Notes {
    fn note(&mut self, time_us: u64, _: &Source, what: &str) -> Result<(), HostError> {
        let line = format!("{:.6}: {what}\n", time_us as f64 * 1e-6);
        self.0.lock().unwrap().push_str(&line);
        Ok(())
    }

    fn finish(&mut self) -> Result<(), HostError> {
        Ok(())
    }
}

/// The log of a run has what was done to which channel; played to a machine on which nobody stands by it repeats the run.
#[test]
fn a_log_repeats_both_channels() {
    let notes = Notes::default();
    let mut host = twin();
    host.set_log(Box::new(notes.clone()));
    let mut trail = Vec::new();
    for cycle in 0..13_500 {
        if cycle == 6000 {
            action(&mut host, "2: jog 2.5");
        }
        trail.push(bits(&host));
        host.step().unwrap();
    }
    assert!((0..2).all(|number| channel(&host, number).has_ended()));
    let log = notes.0.lock().unwrap().clone();
    for line in [
        "2: mode full",
        "2: select RIGHT.H",
        "select LEFT.H",
        "key START2 tap",
        "2: jog 2.5",
    ] {
        assert!(
            log.lines().any(|own| own.ends_with(&format!(": {line}"))),
            "{line}\n{log}"
        );
    }
    let machine = machine("twin");
    let stage = Stage::machine(machine.simulated().unwrap(), &machine.parameters);
    let script = stage.script("log".as_ref(), log.as_bytes()).unwrap();
    let mut again = switched_on(&machine, PowerOn::fresh(&machine), Attendance::Absent);
    let mut play = bahn_host::Play::new(script);
    for (cycle, expected) in trail.iter().enumerate() {
        while let Some(line) = play.due(again.control().time_us(), |_| false) {
            let bahn_host::ScriptAction::Do(action) = line.action else {
                continue;
            };
            again.act(Source::Log, action).unwrap();
        }
        assert_eq!(bits(&again), *expected, "cycle {cycle}");
        again.step().unwrap();
    }
}

/// Every fault of the channels has its line, all of them at once.
#[test]
fn faults_of_channels_have_their_lines() {
    let copy = Copy::of("twin", "faults");
    let file = copy.path().join("machine.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let changes = [
        ("axes = [6, 7, 8]", "axes = [3, 7]"),
        ("\"M2184 = M364\"", "\"M2184 - M364\""),
        ("\"W260 = W128\"", "\"W260 = B128\""),
        ("start = \"START2\"", "start = \"START3\""),
        ("datum = { X = 220", "datum = { U = 220"),
        ("axis = 3\nto = 2", "axis = 4\nto = 3"),
        ("done = \"M203\"", "done = \"I203\""),
    ];
    let mut wrong = text.clone();
    for (from, to) in changes {
        assert!(wrong.contains(from), "{from}");
        wrong = wrong.replacen(from, to, 1);
    }
    std::fs::write(&file, &wrong).unwrap();
    let faults = LoadedMachine::load(copy.path()).unwrap().err().unwrap();
    let mut found: Vec<(String, String)> = faults
        .iter()
        .map(|fault| {
            (
                fault.source.trim().split("  ").next().unwrap().to_owned(),
                fault.detail.clone(),
            )
        })
        .collect();
    found.sort();
    let has = |line: &str, label: &str| {
        assert!(
            found
                .iter()
                .any(|(text, own)| text.starts_with(line) && own.contains(label)),
            "{line}: {label}\n{found:#?}"
        );
    };
    has(
        "axes = [3, 7]",
        "axes of further channels have numbers from 6 to 37, not 3",
    );
    has("axes = [3, 7]", "axis Z of its list (index 2) has no number");
    has("\"M2184 - M364\"", "is no part of a window");
    has("\"W260 = B128\"", "is no part of a window");
    has("operator =", "the machine has no key `START3`");
    has("datum = { U", "the channel has no axis U");
    has("axis = 4", "no channel has an axis 4");
    has("to = 3", "there is no channel 3");
    has("done = \"I203\"", "`I203` is no marker");
    for (line, wrong_key) in [
        ("axes = [6, 7, 8]", "axis = [6]"),
        ("parameters = \"right.mp\"", "parameters = \"none.mp\""),
    ] {
        std::fs::write(&file, text.replace(line, wrong_key)).unwrap();
        let faults = LoadedMachine::load(copy.path()).unwrap().err().unwrap();
        assert!(
            faults.iter().any(|fault| fault.source.contains(wrong_key)),
            "{wrong_key}"
        );
    }
}

/// An acknowledgement that comes too early lets the left program go past M60; it waits for the right one at the next place
/// then, which waits at M60: nobody goes on, and the PLC says so.
#[test]
fn programs_that_do_not_meet_are_reported() {
    let mut host = twin();
    until(&mut host, 60.0, "the left program waits alone", |host| {
        channel(host, 0).waiting().is_some() && see(host, "W260") == 60.0 && see(host, "M53") == 0.0
    });
    action(&mut host, "M2482=1");
    until(&mut host, 60.0, "the message", |host| {
        shown(host).contains(&"PROGRAMS DO NOT MEET".to_owned())
    });
    assert!(channel(&host, 0).waiting().is_some() && channel(&host, 1).waiting().is_some());
}
