//! Functions through the ranges of the PLC. Run with `cargo bench -p bahn-technology`; divan reports functions per second.
#![allow(clippy::unwrap_used, reason = "a bench may fail")]

use std::sync::Arc;

use bahn_din::{Function, Kind, Motion, Place, Target, Unit, Variables};
use bahn_motion::Limits;
use bahn_path::{Axis, Curve, PerAxis, Position};
use bahn_technology::{Blocks, ChannelSettings, Fault, Run, Script, Sequence, Synchronisation};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

/// Blocks of a run, and functions of each.
const BLOCKS: u32 = 2_500;
const EACH: u16 = 8;

/// Every block moves by 1 mm, or not at all, and has its functions for the channel and for X in turn.
struct Functions {
    moves: bool,
}

struct Decoded {
    moves: bool,
    block: u32,
    place: Place,
}

impl Sequence for Functions {
    fn count(&self) -> usize {
        1
    }

    fn name(&self, _: usize) -> String {
        "bench".to_owned()
    }

    fn open(&self, _: usize, _: &Position) -> Result<Box<dyn Blocks + '_>, Fault> {
        Ok(Box::new(Decoded {
            moves: self.moves,
            block: 0,
            place: Place {
                program: "bench".into(),
                block: "N10".into(),
                line: 1,
            },
        }))
    }
}

impl Blocks for Decoded {
    fn next(&mut self, _: &mut dyn Variables) -> Result<Option<Unit>, Fault> {
        if self.block == BLOCKS {
            return Ok(None);
        }
        self.block += 1;
        let target = self.block.is_multiple_of(2).then_some(Target::Axis(Axis::X));
        let functions = (0..EACH).map(|number| Function {
            kind: Kind::H(number),
            value: Some(i32::from(number)),
            target: target.clone(),
            column: 1,
        });
        let at = |x: u32| {
            let mut position = Position::ZERO;
            position[Axis::X] = f64::from(x);
            position
        };
        let motion = Motion {
            curve: Curve::Line,
            begin: at(self.block - 1),
            start: at(self.block - 1),
            end: at(self.block),
            rapid: false,
            feed_mm_min: 10_000.0,
        };
        Ok(Some(Unit {
            place: self.place.clone(),
            motion: self.moves.then_some(motion),
            functions: functions.collect(),
            commands: Vec::new(),
            dwell_s: 0.0,
            ends: false,
        }))
    }

    fn next_is(&mut self, _: &str) -> bool {
        false
    }

    fn position(&self) -> Position {
        Position::UNKNOWN
    }

    fn not_found(&self, _: &str) -> Fault {
        unreachable!("it begins at its first block")
    }
}

fn run(bencher: Bencher<'_, '_>, moves: bool, kind: Synchronisation) {
    let mut settings = ChannelSettings::default();
    for number in 0..u32::from(EACH) {
        settings.h.get_mut(number).unwrap().synch = Some(kind.into());
    }
    let limits = Limits {
        max_feed_mm_min: PerAxis::splat(10_000.0),
        acceleration_m_s2: PerAxis::splat(1.0),
        radial_acceleration_m_s2: 0.5,
        corner_angle_deg: 10.0,
        servo_lag: true,
        cycle_s: 0.003,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: Default::default(),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    };
    let script: Arc<Script> = Arc::new("default ack 0".parse().unwrap());
    let count = u64::from(BLOCKS) * u64::from(EACH);
    bencher.counter(ItemsCount::new(count)).bench(|| {
        let run = Run {
            programs: &Functions { moves },
            settings: &settings,
            limits: &limits,
            start: Position::ZERO,
            from: None,
            bounds: Default::default(),
            script: Some(&script),
        };
        let report = run.execute();
        assert!(report.completed);
        black_box(report.events.len())
    });
}

/// Blocks without a motion, which is what the ranges take at most.
#[divan::bench(args = [Synchronisation::Mos, Synchronisation::MvsSvs])]
fn without_motion(bencher: Bencher<'_, '_>, kind: Synchronisation) {
    run(bencher, false, kind);
}

/// Blocks of 1 mm.
#[divan::bench(args = [Synchronisation::Mos, Synchronisation::MvsSns])]
fn along_a_path(bencher: Bencher<'_, '_>, kind: Synchronisation) {
    run(bencher, true, kind);
}
