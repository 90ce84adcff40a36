//! Any moment of a run is reached again, to the bit.

use crate::support::*;
use bahn_host::{Action, Answer, Host, HostError, Log, Next, Notice, PowerOn, Sink, Source, Timeline, When};
use bahn_tnc::{Command, Signal};

const BLOCKS: &str = "TOOL CALL 1 Z S1000\nL Z+50 R0 FMAX M3\nL X+20 Y+10 R0 FMAX\nLBL 1\nL IX+10 F3000 M8\nCC IX+0 IY+5\n\
    C IX+0 IY+10 DR+\nL IX-5 IY-8 M9\nQ1=Q1+1\nCALL LBL 1 REP 6\nL Z+100 R0 FMAX M5";

const SIGNALS: &str = "path.speed path.block S.rpm S.volts S.angle X.actual X.nominal X.lag X.volts Y.actual Y.nominal \
    Y.volts Z.actual Z.nominal Z.volts W256 W258 W260 W262 D356 D596 M2045 M2046 M2095 M2482 M2485 O8 O13";

/// What is compared: the bits of all signals.
fn bits(host: &Host) -> Vec<u64> {
    let signals = SIGNALS.split_whitespace();
    let mut bits: Vec<u64> = signals
        .map(|signal| {
            host.control()
                .observe(&signal.parse::<Signal>().unwrap())
                .to_bits()
        })
        .collect();
    let axes = host.plant().axes();
    bits.extend(axes.flat_map(|axis| [axis.position.to_bits(), axis.speed_per_min.to_bits()]));
    bits
}

/// xorshift.
fn random(seed: &mut u64) -> u64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    *seed >> 11
}

fn action(text: &str) -> Action {
    Action::parse(text).unwrap()
}

/// What is done at once at its cycle; what is ordered was ordered at the beginning.
fn act(host: &mut Host, cycle: usize) {
    let texts = [
        (3500, "override feed 40"),
        (4100, "override feed 130"),
        (5200, "mode single"),
        (6100, "mode full"),
    ];
    for (_, text) in texts.iter().filter(|(at, _)| *at == cycle) {
        host.act(Source::Client("test".to_owned()), action(text)).unwrap();
    }
}

#[test]
fn a_moment_is_reached_again_to_the_bit() {
    const CYCLES: usize = 7000;
    let mut host = mill(BLOCKS);
    let cycle_us = u64::from(host.control().cycle_us());
    for (cycle, text) in [
        (3000, "key NC_STOP tap"),
        (3300, "key NC_START tap"),
        (4700, "key X+ tap"),
    ] {
        let when = When::At(cycle * cycle_us);
        host.order(Source::Script, when, action(text)).unwrap();
    }
    let mut timeline = Timeline::new(2_000_000, 16);
    let mut trail = Vec::new();
    for cycle in 0..CYCLES {
        trail.push(bits(&host));
        act(&mut host, cycle);
        host.step().unwrap();
        timeline.follow(&mut host);
    }
    // It is a run in which much happens.
    let speeds = trail.iter().filter(|bits| f64::from_bits(bits[0]) > 0.0).count();
    assert!(speeds > 1500, "{speeds} cycles with movement");
    let mut seed = 0x9e37_79b9;
    // From the latest moment to the earliest: what is later is forgotten with each.
    let mut moments: Vec<usize> = (0..6)
        .map(|_| random(&mut seed) as usize % (CYCLES - 400))
        .collect();
    moments.extend([3050, 3501, 4711]);
    moments.sort_unstable();
    for moment in moments.into_iter().rev() {
        let time_us = moment as u64 * cycle_us;
        let Some(saved) = timeline.nearest(time_us).cloned() else {
            continue;
        };
        host.replay(&saved, time_us).unwrap();
        assert_eq!(host.control().time_us(), time_us);
        for (cycle, expected) in trail.iter().enumerate().skip(moment).take(400) {
            assert_eq!(bits(&host), *expected, "cycle {cycle} from {moment}");
            act(&mut host, cycle);
            host.step().unwrap();
        }
    }
}

/// A course that was kept is gone through again, to any moment and to its end, whatever was done instead.
#[test]
fn a_course_that_was_left_is_reached_again() {
    let mut host = mill(BLOCKS);
    seconds(&mut host, 5.0);
    let saved = host.save().unwrap();
    let actions = |host: &mut Host, percents: [u8; 2]| {
        for percent in percents {
            let text = format!("override feed {percent}");
            host.act(Source::Script, action(&text)).unwrap();
            seconds(host, 1.0);
        }
    };
    actions(&mut host, [30, 120]);
    let middle_us = host.control().time_us() - 500_000;
    // Something that is given at the very end belongs to it.
    host.act(Source::Script, action("override feed 77")).unwrap();
    let (first, course) = (bits(&host), host.course());
    host.restore(&saved).unwrap();
    actions(&mut host, [60, 10]);
    let (second, other) = (bits(&host), host.course());
    assert_ne!(first, second);
    for _ in 0..2 {
        host.replay_course(&course, &saved, middle_us).unwrap();
        let given: Vec<String> = host.given().map(|(_, _, action)| action.to_string()).collect();
        assert_eq!(
            given[given.len() - 2..],
            ["override feed 30", "override feed 120"]
        );
        host.replay_course(&course, &saved, u64::MAX).unwrap();
        assert_eq!(bits(&host), first);
        assert_eq!(host.plant().knobs()[0], 77.0);
        assert_eq!(host.given_count(), host.given().count() as u64);
        host.replay_course(&other, &saved, other.end_us()).unwrap();
        assert_eq!(bits(&host), second);
    }
}

/// A save takes no part in the run, and a run from it is another one than the first when something else is done.
#[test]
fn a_saved_moment_is_the_beginning_of_another_run() {
    let mut host = mill(BLOCKS);
    while host
        .control()
        .element()
        .is_none_or(|element| element.block.block < 5)
    {
        host.step().unwrap();
    }
    let saved = host.save().unwrap();
    let at = bits(&host);
    host.act(Source::Script, action("override feed 20")).unwrap();
    seconds(&mut host, 2.0);
    let slow = bits(&host);
    host.restore(&saved).unwrap();
    assert_eq!(bits(&host), at);
    seconds(&mut host, 2.0);
    let fast = bits(&host);
    assert_ne!(fast, slow);
    host.restore(&saved).unwrap();
    host.act(Source::Script, action("override feed 20")).unwrap();
    seconds(&mut host, 2.0);
    assert_eq!(bits(&host), slow);
}

#[test]
fn readers_get_the_way_back_and_nothing_that_is_repeated() {
    let mut host = mill(BLOCKS);
    seconds(&mut host, 5.0);
    let saved = host.save().unwrap();
    seconds(&mut host, 5.0);
    let now = host.control().time_us();
    let mut notices = host.notices();
    host.replay(&saved, now - 1_000_000).unwrap();
    let reported: Vec<_> = notices
        .by_ref()
        .map(|next| match next {
            Next::Item(stamped) => (stamped.time_us, stamped.notice),
            Next::Missed(_) => unreachable!(),
        })
        .collect();
    // The cycle is 3 ms: a moment is that of the first cycle that ends after it.
    let cycle_us = u64::from(host.control().cycle_us());
    assert_eq!(reported.len(), 1, "{reported:?}");
    assert_eq!(
        reported[0],
        ((now - 1_000_000).next_multiple_of(cycle_us), Notice::Restored)
    );
}

/// What survives power-off is that of the moment that was gone back to.
#[test]
fn what_is_kept_goes_back_too() {
    let folder = Copy::of("mill", "back");
    let machine = bahn_host::LoadedMachine::load(folder.path()).unwrap().unwrap();
    let mut host = host(&machine, PowerOn::kept(&machine).unwrap(), "L X+1 R0 F100");
    seconds(&mut host, 30.0);
    host.act(Source::Operator, action("mode manual")).unwrap();
    host.step().unwrap();
    host.store().unwrap();
    let file = folder.path().join("state/control.toml");
    let before = std::fs::read_to_string(&file).unwrap();
    let saved = host.save().unwrap();
    let datum = Command::Datum(bahn_path::Axis::X, 12.5);
    let answer = host.act(Source::Operator, Action::Command(0, datum)).unwrap();
    assert_eq!(answer, Answer::Done);
    seconds(&mut host, 0.1);
    let after = std::fs::read_to_string(&file).unwrap();
    assert_ne!(before, after);
    host.restore(&saved).unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), before);
}

/// Who is told of every action would be told of times that come twice.
#[test]
fn a_run_that_is_logged_goes_forward_only() {
    struct Lines(Log<Vec<u8>>);
    impl Sink for Lines {
        fn note(&mut self, time_us: u64, _: &Source, what: &str) -> Result<(), HostError> {
            self.0
                .note(time_us, what)
                .map_err(|error| HostError::Impossible(error.to_string()))
        }
        fn finish(&mut self) -> Result<(), HostError> {
            Ok(())
        }
    }
    let mut host = mill("L X+1 R0 F100");
    host.set_log(Box::new(Lines(Log::new(Vec::new(), "a run").unwrap())));
    let saved = host.save().unwrap();
    seconds(&mut host, 0.1);
    let time_us = host.control().time_us();
    assert_eq!(host.restore(&saved), Err(HostError::Logged));
    assert_eq!(host.control().time_us(), time_us);
}
