//! The same run twice, and a run that is disturbed at random.

use crate::stand::*;
use crate::support::*;
use bahn_tnc::{Command, RunState};
use proptest::prelude::*;

const PROGRAM: &str = "TOOL CALL 0 Z S1000\nL X+60 Y+55 R0 F6000 M3\nCC X+60 Y+75\nC X+80 Y+75 DR+\nRND R3\nL X+80 Y+100 M8\nL IX+25 IY-10 FMAX\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.1\nL X+70 Y+60 Z+40 F9000 M9\nL IY-7 M5";

/// Where the program ends.
const END: [f64; 3] = [70.0, 53.0, 40.0];

#[derive(Clone, Debug)]
enum Action {
    Stop,
    InternalStop,
    Start,
    Override(u8),
    Single,
    Full,
}

fn action() -> impl Strategy<Value = Action> {
    prop_oneof![
        3 => Just(Action::Stop),
        1 => Just(Action::InternalStop),
        4 => Just(Action::Start),
        2 => (0u8..=150).prop_map(Action::Override),
        1 => Just(Action::Single),
        1 => Just(Action::Full),
    ]
}

/// What a run leaves: nominal positions and voltages of all cycles, bit by bit, hashed.
struct Trace {
    hash: u64,
    before: [f64; 3],
    speed: [f64; 3],
    worst: f64,
}

impl Trace {
    fn new(rig: &Rig) -> Trace {
        Trace {
            hash: 0xcbf2_9ce4_8422_2325,
            before: ['X', 'Y', 'Z'].map(|axis| nominal(rig, axis)),
            speed: [0.0; 3],
            worst: 0.0,
        }
    }

    fn note(&mut self, rig: &Rig) {
        let at = ['X', 'Y', 'Z'].map(|axis| nominal(rig, axis));
        for (place, now) in at.iter().enumerate() {
            let speed = (now - self.before[place]) / 0.003;
            self.worst = self.worst.max((speed - self.speed[place]).abs() / 0.003);
            self.speed[place] = speed;
            self.before[place] = *now;
            let actual = rig.control.snapshot().axes[place].machine;
            for bits in [now.to_bits(), actual.to_bits()] {
                self.hash = (self.hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
    }
}

fn disturbed(actions: &[(u16, Action)]) -> (Rig, Trace) {
    let mut rig = bench_with(ACKNOWLEDGE, PROGRAM);
    let mut trace = Trace::new(&rig);
    rig.start();
    for (cycles, action) in actions {
        for _ in 0..*cycles {
            rig.cycle();
            trace.note(&rig);
        }
        match action {
            Action::Stop => rig.event("key NC_STOP tap"),
            Action::InternalStop => {
                rig.control.command(Command::InternalStop);
                rig.control.command(Command::Ce);
            }
            Action::Start => rig.start(),
            Action::Override(percent) => rig.event(&format!("override feed {percent}")),
            Action::Single => rig.command("mode single"),
            Action::Full => rig.command("mode full"),
        }
    }
    rig.command("mode full");
    rig.event("override feed 100");
    let begin = rig.control.time_us();
    while !rig.control.snapshot().ended && rig.control.time_us() < begin + 60_000_000 {
        if rig.control.snapshot().run != RunState::Running {
            rig.start();
        }
        for _ in 0..100 {
            rig.cycle();
            trace.note(&rig);
        }
    }
    (rig, trace)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Whatever the operator does, the program ends where it says; no axis exceeds sqrt(MP1060² + MP1070²) =
    /// 1414 mm/s²; and the same again gives the same bits.
    #[test]
    fn disturbed_runs(actions in prop::collection::vec((1u16..300, action()), 0..12)) {
        let (rig, trace) = disturbed(&actions);
        prop_assert!(rig.control.snapshot().ended, "{:?}", rig.messages());
        for (axis, end) in ['X', 'Y', 'Z'].into_iter().zip(END) {
            prop_assert!((nominal(&rig, axis) - end).abs() < 1e-6, "{} {}", axis, nominal(&rig, axis));
        }
        prop_assert!(trace.worst < 1415.0, "{}", trace.worst);
        let (_, again) = disturbed(&actions);
        prop_assert_eq!(trace.hash, again.hash);
    }
}

/// The commands of the log, given again at their times with the same events, repeat the run.
#[test]
fn the_command_log_replays() {
    let script: [(u64, &str); 5] = [
        (5_000_000, "key NC_START tap"),
        (5_400_000, "key NC_STOP tap"),
        (6_000_000, "override feed 70"),
        (6_300_000, "key NC_START tap"),
        (9_000_000, "key NC_START tap"),
    ];
    let drive = |commands: &[(u64, usize, Command)]| {
        let mut rig = bench(ACKNOWLEDGE).program("1.H", PROGRAM).rig();
        rig.control.keep_command_log();
        let mut trace = Trace::new(&rig);
        let (mut events, mut commands) = (script.iter().peekable(), commands.iter().peekable());
        let mut reference = false;
        while rig.control.time_us() < 15_000_000 {
            let now = rig.control.time_us();
            if !reference && now > 2_000_000 {
                reference = true;
                rig.start();
            }
            while let Some((_, text)) = events.next_if(|(time, _)| *time <= now) {
                rig.event(text);
            }
            while let Some((_, channel, command)) = commands.next_if(|(time, ..)| *time <= now) {
                rig.control.command_to(*channel, command.clone());
            }
            rig.cycle();
            trace.note(&rig);
        }
        (rig, trace)
    };
    let given: Vec<(u64, usize, Command)> = [
        (4_600_000, "mode full"),
        (4_700_000, "select 1.H"),
        (6_200_000, "stop"),
        (7_000_000, "mode single"),
        (8_900_000, "mode full"),
    ]
    .into_iter()
    .map(|(time, text)| (time, 0, text.parse().unwrap()))
    .collect();
    let (mut first, trace) = drive(&given);
    assert!(
        first.control.snapshot().ended,
        "{:?} {:?}",
        first.messages(),
        first.control.snapshot().run
    );
    let log = first.control.take_command_log().unwrap();
    assert_eq!(log.len(), given.len());
    let (_, replayed) = drive(&log);
    assert_eq!(trace.hash, replayed.hash);
}
