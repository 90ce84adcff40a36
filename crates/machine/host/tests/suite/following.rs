//! Orders, notices and snapshots of a machine that is on.

use crate::support::*;
use bahn_host::{
    Action, Answer, Attendance, Clock, Job, LoadedMachine, Next, Notice, Operator, PowerOn, Source, When,
};
use bahn_tnc::{Mode, RunState};

fn action(text: &str) -> Action {
    Action::parse(text).unwrap()
}

/// What a reader has not read, without its times.
fn reported(reader: &mut bahn_host::Reader<bahn_host::Stamped>) -> Vec<Notice> {
    reader
        .filter_map(|next| match next {
            Next::Item(stamped) => Some(stamped.notice),
            Next::Missed(_) => None,
        })
        .collect()
}

#[test]
fn a_run_is_reported_from_its_start_to_its_end() {
    let mut host = mill("L X+10 R0 F2000\nSTOP M0\nL X+20");
    let mut reader = host.notices();
    seconds(&mut host, 60.0);
    let reported = reported(&mut reader);
    let place = |wanted: &dyn Fn(&Notice) -> bool| reported.iter().position(wanted).unwrap();
    let messages = |notice: &Notice| matches!(notice, Notice::Shown(_));
    let cleared = |notice: &Notice| matches!(notice, Notice::Cleared(_));
    let order = [
        place(&messages),
        place(&cleared),
        place(&|notice| *notice == Notice::Mode(Mode::Reference)),
        place(&|notice| *notice == Notice::Run(RunState::Running)),
        place(&|notice| matches!(notice, Notice::Block(Some(block)) if block.block == 1)),
        place(&|notice| *notice == Notice::Run(RunState::Stopped)),
        place(&|notice| matches!(notice, Notice::Confirmed { key, .. } if key == "NC_START")),
        place(&|notice| matches!(notice, Notice::Block(Some(block)) if block.block == 3)),
        place(&|notice| *notice == Notice::Ended),
    ];
    assert!(order.is_sorted(), "{order:?}: {reported:#?}");
}

/// Orders from another thread at a time are done before the cycle that begins then.
#[test]
fn orders_are_done_at_their_times() {
    let mut host = mill("L X+10 R0 F2000");
    let mut reader = host.notices();
    let cycle_us = u64::from(host.control().cycle_us());
    let desk = host.desk();
    std::thread::spawn(move || {
        let me = || Source::Client("other".to_owned());
        desk.give(me(), When::At(1_000_000), action("override feed 50"))
            .unwrap();
        desk.give(me(), When::At(500_000), action("key NO_SUCH_KEY tap"))
            .unwrap();
        desk.give(me(), When::Now, action("override spindle 70")).unwrap();
    })
    .join()
    .unwrap();
    seconds(&mut host, 2.0);
    let mine: Vec<_> = reader
        .by_ref()
        .filter_map(|next| match next {
            Next::Item(stamped) => match stamped.notice {
                Notice::Given(Source::Client(_), action, answer) => {
                    Some((stamped.time_us, action.to_string(), answer))
                }
                _ => None,
            },
            Next::Missed(_) => None,
        })
        .collect();
    let at = |time_us: u64| time_us.next_multiple_of(cycle_us);
    let [spindle, key, feed] = mine.as_slice() else {
        unreachable!("{mine:?}")
    };
    assert_eq!(*spindle, (0, "override spindle 70".to_owned(), Answer::Done));
    assert_eq!((key.0, key.1.as_str()), (at(500_000), "key NO_SUCH_KEY tap"));
    assert!(
        matches!(&key.2, Answer::Impossible(what) if what.contains("NO_SUCH_KEY")),
        "{:?}",
        key.2
    );
    assert_eq!(
        *feed,
        (at(1_000_000), "override feed 50".to_owned(), Answer::Done)
    );
}

/// A command that is not possible now is answered so, and the control says KEY NON-FUNCTIONAL.
#[test]
fn refused_commands_are_answered_so() {
    let mut host = mill("L X+10 R0 F2000");
    let answer = host.act(Source::Script, action("restore-position")).unwrap();
    assert_eq!(answer, Answer::Refused);
}

#[test]
fn snapshots_are_taken_at_their_times() {
    let mut host = mill("L X+10 R0 F2000");
    host.take_snapshots(100_000);
    let mut reader = host.snapshots();
    seconds(&mut host, 10.0);
    let times: Vec<u64> = reader
        .by_ref()
        .map(|next| match next {
            Next::Item(snapshot) => snapshot.time_us,
            Next::Missed(_) => unreachable!(),
        })
        .collect();
    assert!((95..=100).contains(&times.len()), "{}", times.len());
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] >= 100_000));
    seconds(&mut host, 60.0);
    // 600 were taken, 256 wait.
    assert!(matches!(reader.next(), Some(Next::Missed(missed)) if (330..=344).contains(&missed)));
    let latest = reader.latest().unwrap();
    assert!(host.control().time_us() - latest.time_us < 100_000 + u64::from(host.control().cycle_us()));
    assert_eq!((latest.run, latest.ended), (RunState::Idle, true));
    assert_eq!((reader.latest(), reader.next()), (None, None));
}

#[test]
fn a_factor_of_real_time_is_kept() {
    let mut host = mill("L X+10 R0 F2000");
    let begun = std::time::Instant::now();
    host.set_clock(Clock::Wall(20.0));
    seconds(&mut host, 6.0);
    let passed_s = begun.elapsed().as_secs_f64();
    // 6 s of the machine at 20 times the speed of the wall are 0.3 s; it is never ahead.
    assert!(passed_s >= 0.299, "{passed_s}");
    let lateness = host.lateness().unwrap();
    assert_eq!(lateness.cycles, 6_000_000 / u64::from(host.control().cycle_us()));
    host.set_clock(Clock::Free);
    assert!(host.lateness().is_none());
}

/// A host can live on a thread of its own.
#[test]
fn a_host_is_sent_to_a_thread() {
    let mut host = mill("L X+10 R0 F2000");
    let mut reader = host.notices();
    let driven = std::thread::spawn(move || seconds(&mut host, 30.0));
    driven.join().unwrap();
    assert!(reported(&mut reader).contains(&Notice::Ended));
}

/// The interface function PRINT belongs to the interfaces, not to the machine: another machine that takes the place of this
/// one prints what it digitizes, too, block by block [003:6554-6557].
#[test]
fn another_machine_prints_what_it_digitizes() {
    let copy = Copy::of("mill", "printing");
    // The end of the ball is the reference point of the spindle, so that no tool has a length.
    let plant = std::fs::read_to_string(copy.path().join("plant.toml")).unwrap();
    let probe = plant.replace("length = 120 ", "inserted = true\nlength = 0 ");
    assert_ne!(plant, probe);
    std::fs::write(copy.path().join("plant.toml"), probe).unwrap();
    let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
    // The face of the block on the table is at Z 40 of the machine; the datum is at Z 120.
    let scan = "TOOL CALL 0 Z S0\nL X+10 Y+10 R0 FMAX\nL Z-60 FMAX\nTCH PROBE 5.0 RANGE\nTCH PROBE 5.1 PGM NAME: FACE\n\
                TCH PROBE 5.2 Z X+10 Y+10 Z-85\nTCH PROBE 5.3 X+14 Y+12 Z-75\nTCH PROBE 5.4 HEIGHT: -70\n\
                TCH PROBE 6.0 MEANDER\nTCH PROBE 6.1 DIRECTN: X\nTCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 1 P.P. INT: 1\nL Z+0 FMAX";
    let mut host = host(&machine, PowerOn::fresh(&machine), scan);
    host.print_digitized(true);
    let operator = Operator::new(
        Attendance::Full,
        machine.folder.operator.clone(),
        Some(Job::whole("1.H")),
    );
    host.replace(
        &machine,
        PowerOn::fresh(&machine),
        Texts::new(&[("1.H", scan)]),
        operator,
    )
    .unwrap();
    let mut reader = host.notices();
    let (mut printed, mut ended) = (Vec::new(), false);
    while !ended {
        assert!(
            host.control().time_us() < 300_000_000,
            "{:?}",
            host.control().snapshot()
        );
        host.step().unwrap();
        for notice in reported(&mut reader) {
            match notice {
                Notice::Printed(block) => printed.push(block),
                Notice::Ended => ended = true,
                _ => {}
            }
        }
    }
    let (first, last) = (printed.first().unwrap(), printed.last().unwrap());
    assert!(
        first.contains("BEGIN PGM FACE MM") && last.contains("END PGM FACE MM"),
        "{printed:?}"
    );
    // Three lines of 4 mm with a point each millimetre.
    assert!(printed.len() > 3 * 4, "{printed:?}");
}
