//! Whatever is pressed: nothing panics, every screen is whole, and the machine can be switched on again.

use crate::support::Trainee;
use bahn_panel::{Key, Screen, Star};
use bahn_tnc::RunState;

/// Random numbers that are the same on every run.
struct Dice(u64);

impl Dice {
    fn next(&mut self, below: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % below
    }
}

/// Marks stand within their lines, the window shows no more than there is.
fn is_whole(screen: &Screen) {
    let window = &screen.program;
    for line in &window.lines {
        let length = line.text.chars().count();
        for (from, to, _) in &line.marks {
            assert!(from <= to && *from <= length, "{window:?}");
        }
    }
    assert!(
        window.lines.iter().filter(|line| line.current).count() <= 1,
        "{window:?}"
    );
    assert!(screen.soft_keys.keys.len() <= 8, "{:?}", screen.soft_keys);
}

/// Presses keys from where the operator has got to; then the machine is switched off and on.
fn hammer(begin: &str, seed: u64, count: usize) {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press(begin);
    let mut dice = Dice(seed);
    // Keys of a page are likelier than those that leave it.
    let keys: Vec<Key> = Key::ALL
        .iter()
        .copied()
        .filter(|key| key.group() != bahn_panel::KeyGroup::Mode)
        .collect();
    for _ in 0..count {
        let all = if dice.next(20) == 0 {
            Key::ALL
        } else {
            keys.as_slice()
        };
        let key = all[dice.next(all.len())];
        trainee.give(&format!("{{\"key\":\"{}\"}}", key.name()));
        trainee.wait(0.01);
        is_whole(trainee.station.screen());
    }
    let mut trainee = trainee.killed();
    trainee.until(10.0, |screen| {
        !screen.messages.is_empty() || !screen.mode.is_empty()
    });
}

#[test]
fn any_keys_by_hand() {
    for seed in 1..=3 {
        hammer("", seed, 1000);
    }
}

#[test]
fn any_keys_in_program_management() {
    hammer("PROGRAM PGM_NR", 11, 1500);
    hammer("PROGRAM PGM_NR A ENT ENT", 12, 1500);
}

#[test]
fn any_keys_in_tables() {
    for seed in 21..=25 {
        hammer("PROGRAM PGM_NR 0 ENT", seed, 1000);
    }
}

#[test]
fn any_keys_in_the_parameter_editor() {
    for seed in 31..=33 {
        hammer("PROGRAM MOD ENT 9 5 1 4 8 ENT", seed, 1000);
    }
}

/// The number of the block that the window shows as the current one.
fn current_block(screen: &Screen) -> Option<u32> {
    let line = screen.program.lines.iter().find(|line| line.current)?;
    line.text.split_whitespace().next()?.parse().ok()
}

/// The screen says with which block NC START begins or goes on, whatever was pressed before: of a program without jumps,
/// each of whose blocks moves, the first one that is executed is the one that was shown, or the one behind BEGIN.
#[test]
fn the_screen_shows_with_which_block_the_run_goes_on() {
    const KEYS: [&str; 12] = [
        "NC_START",
        "NC_START",
        "NC_START",
        "NC_STOP",
        "NC_STOP",
        "STOP",
        "STOP",
        "UP",
        "DOWN",
        "SINGLE",
        "FULL",
        "GOTO 3 ENT",
    ];
    let mut starts = 0;
    for seed in 51..=54 {
        let mut trainee = Trainee::at("mill");
        let blocks = (1..=12).map(|number| format!("L IX{:+} R0 F600\n", number % 2 * 10 - 5));
        let blocks: String = blocks.collect();
        trainee.write(
            "programs/LAW.H",
            &format!("BEGIN PGM LAW MM\n{blocks}END PGM LAW MM\n"),
        );
        trainee.ready();
        trainee.press("FULL PGM_NR L A W ENT");
        let mut dice = Dice(seed);
        for _ in 0..150 {
            let keys = KEYS[dice.next(KEYS.len())];
            if keys == "NC_START" {
                // NC stop is no longer pressed.
                trainee.wait(0.3);
            }
            let rested = trainee.station.control().run_state() == RunState::Idle;
            let shown = current_block(trainee.station.screen());
            trainee.press(keys);
            if keys == "NC_START" && rested {
                trainee.until(3.0, |screen| screen.status.star != Star::Off);
                let element = trainee.station.control().element().unwrap();
                assert_eq!(
                    Some(element.block.block),
                    shown.map(|block| block.max(1)),
                    "seed {seed}"
                );
                starts += 1;
            }
            trainee.wait(0.1 * dice.next(6) as f64);
            is_whole(trainee.station.screen());
        }
    }
    assert!(starts > 20, "{starts}");
}

/// Blocks of DIN/ISO are typed, changed and thrown away: 10,000 keys.
#[test]
fn any_keys_in_a_program_in_din_iso() {
    for seed in 41..=45 {
        hammer(
            "PROGRAM PGM_NR 7 POINT I ENT ENT M 3 END X 5 END G 8 3 END DEL",
            seed,
            2000,
        );
    }
}
