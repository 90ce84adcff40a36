//! Long programs that are executed while they are transferred: constant memory, and no marks where the line is slow.
//!
//! `cargo test --release -p bahn-tnc --test drip_feed_long -- --ignored --nocapture` runs 2,000,000 blocks of each kind and prints what
//! was measured.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "what fails here fails the test"
)]

mod support;

use bahn_tnc::{Command, Dnc};
use support::*;

/// Characters of the blockwise protocol around a block: STX, ETB, check character, DC1, and the acknowledgement.
const AROUND: f64 = 5.0;
/// Start, seven data bits, parity and stop bit.
const BITS: f64 = 10.0;

/// A smooth closed curve in small steps, as a sculptured surface has it.
fn block(at: u32) -> String {
    let angle = f64::from(at) * 0.003;
    let (x, y) = (150.0 + 60.0 * angle.cos(), 150.0 + 40.0 * (2.0 * angle).sin());
    format!("L X{x:+.3} Y{y:+.3}\r\n")
}

/// What a run has come to.
struct Measured {
    machine_s: f64,
    starved_s: f64,
    /// Peak of the memory that the run allocated, bytes.
    peak_bytes: u64,
    /// Most program text that waited, bytes.
    text_bytes: u64,
    /// The greatest step of velocity in a contour cycle as an acceleration, mm/s².
    acceleration: f64,
    blocks: u32,
}

/// Nominal positions of the cycle before, and the speeds that led there.
#[derive(Default)]
struct Speeds {
    at: Option<[f64; 2]>,
    speed: Option<[f64; 2]>,
}

impl Speeds {
    /// Takes a cycle; the greatest step of a speed so far as an acceleration.
    fn look(&mut self, rig: &Rig, greatest: &mut f64) {
        let cycle_s = f64::from(rig.control.cycle_us()) * 1e-6;
        let at = ["X.nominal", "Y.nominal"].map(|name| rig.control.observe(&name.parse().unwrap()));
        let speed = self
            .at
            .map(|was| [0, 1].map(|axis: usize| (at[axis] - was[axis]) / cycle_s));
        if let (Some(slower), Some(speed)) = (self.speed, speed) {
            for axis in 0..2 {
                *greatest = greatest.max((speed[axis] - slower[axis]).abs() / cycle_s);
            }
        }
        (self.at, self.speed) = (Some(at), speed.or(self.speed));
    }
}

/// Runs a program over a line of so many baud, or one that is as fast as the control takes it.
fn run(blocks: u32, baud: Option<f64>) -> Measured {
    // Corners up to 10 degrees are passed; 100 kByte wait at most.
    let mut build = Build::mill().mp("MP7228.1=100").mp("MP7460=10");
    build.tools = None;
    let mut rig = build.rig();
    rig.power_on();
    rig.command("mode full");
    rig.command("dnc begin LONG.H");
    rig.start();
    let begin = rig.control.time_us();
    let mut measured = Measured {
        machine_s: 0.0,
        starved_s: 0.0,
        peak_bytes: 0,
        text_bytes: 0,
        acceleration: 0.0,
        blocks: 0,
    };
    let mut next = 0;
    let mut paid_s = 0.0;
    let mut speeds = Speeds::default();
    let cycle_s = f64::from(rig.control.cycle_us()) * 1e-6;
    let info = allocation_counter::measure(|| {
        while !rig.control.has_ended() {
            let now_s = (rig.control.time_us() - begin) as f64 * 1e-6;
            while next <= blocks + 2
                && rig
                    .control
                    .first()
                    .drip_feed()
                    .is_some_and(|feed| feed.wants_more)
                && (baud.is_none() || paid_s <= now_s)
            {
                let text = match next {
                    0 => "BEGIN PGM LONG MM\r\n".to_owned(),
                    1 => format!("L X+210 Y+150 Z+200 R0 FMAX\r\n{}", "L Z+190 F6000\r\n"),
                    at if at <= blocks + 1 => block(at - 2),
                    _ => "END PGM LONG MM\r\n".to_owned(),
                };
                if let Some(baud) = baud {
                    paid_s =
                        f64::max(paid_s, now_s - cycle_s) + (text.len() as f64 - 2.0 + AROUND) * BITS / baud;
                }
                assert!(
                    rig.control
                        .command(Command::Dnc(Dnc::Text(text.as_bytes().into())))
                );
                next += 1;
                if next == blocks + 3 {
                    rig.command("dnc end");
                }
            }
            rig.cycle();
            let view = rig.control.first();
            if let Some(feed) = view.drip_feed() {
                measured.text_bytes = measured.text_bytes.max(feed.bytes);
                measured.starved_s += if feed.starved { cycle_s } else { 0.0 };
            }
            let number = view.element().map_or(0, |element| element.block.block);
            if number > 5 && number < blocks {
                speeds.look(&rig, &mut measured.acceleration);
            }
            measured.blocks = measured.blocks.max(number);
            assert!(rig.messages_are_none(), "{:?}", rig.messages());
        }
    });
    measured.peak_bytes = info.bytes_max;
    measured.machine_s = (rig.control.time_us() - begin) as f64 * 1e-6;
    measured
}

impl Rig {
    fn messages_are_none(&self) -> bool {
        self.control.shown().is_empty()
    }
}

/// What must hold of every run.
fn check(measured: &Measured, blocks: u32) {
    let Measured {
        machine_s,
        starved_s,
        peak_bytes,
        text_bytes,
        acceleration,
        blocks: executed,
    } = measured;
    println!(
        "{blocks} blocks: {machine_s:.0} s, starved {starved_s:.1} s, memory {:.2} MB, text {text_bytes} bytes, {acceleration:.0} mm/s²",
        *peak_bytes as f64 / 1e6
    );
    assert!(*executed >= blocks, "{executed}");
    // The text is bounded by MP7228.1 and one piece, the rest by look-ahead and decoded blocks.
    assert!(*text_bytes < 100 * 1024 + 64, "{text_bytes}");
    assert!(*peak_bytes < 64 << 20, "{peak_bytes}");
}

/// At 38,400 baud a line brings some 140 blocks a second, less than the feed wants: the path waits for it again and again and leaves
/// no jump of the speed; as fast as the control takes them, blocks are always there.
#[test]
fn twenty_thousand_blocks() {
    let slow = run(3000, Some(38_400.0));
    check(&slow, 3000);
    assert!(slow.starved_s > 1.0, "{}", slow.starved_s);
    let fast = run(17_000, None);
    check(&fast, 17_000);
    assert_eq!(fast.starved_s, 0.0);
    // Steps of the speed at corners that are passed, and ramps of MP1060.
    assert!(
        slow.acceleration <= fast.acceleration * 1.5,
        "{} {}",
        slow.acceleration,
        fast.acceleration
    );
}

#[test]
#[ignore = "takes minutes"]
fn two_million_blocks() {
    for baud in [None, Some(38_400.0)] {
        let start = std::time::Instant::now();
        let measured = run(2_000_000, baud);
        check(&measured, 2_000_000);
        println!(
            "{baud:?} baud: {:.0} s on this computer",
            start.elapsed().as_secs_f64()
        );
    }
}
