//! The drip feed over a line that breaks, repeats and falls silent: nothing is lost, nothing is doubled.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

use std::collections::VecDeque;
use std::io::Read;
use std::time::Duration;

use bahn_link::dnc::{Arrival, BlockLine, Drip, DripState, Machine, Spool};
use bahn_link::{Files, Memory};

/// Random numbers of a seed.
struct Random(u64);

impl Random {
    fn below(&mut self, below: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 33) % below
    }
}

/// A peripheral behind a line with faults: it sends its blocks from the first one whenever it is asked, and the next one
/// when the last was acknowledged.
struct BadLine {
    blocks: Vec<Vec<u8>>,
    random: Random,
    /// The block that is sent next, while a transfer is on.
    next: Option<usize>,
    /// The last one is not acknowledged.
    open: bool,
    given_up: bool,
    faults: bool,
}

impl BlockLine for BadLine {
    fn is_connected(&mut self) -> bool {
        true
    }

    fn ask_for(&mut self, name: &str) {
        assert_eq!(name, "15");
        (self.next, self.open) = (Some(0), false);
    }

    fn look(&mut self, _: Duration) -> Arrival {
        assert!(!self.open, "it is not acknowledged, and nothing else comes");
        let Some(next) = self.next else {
            return Arrival::Nothing;
        };
        match self.random.below(2000) {
            0 if self.faults => {
                self.next = None;
                return Arrival::Broken("PROGRAM INCOMPLETE".into());
            }
            1..100 if self.faults => return Arrival::Nothing,
            _ => {}
        }
        let Some(block) = self.blocks.get(next) else {
            self.next = None;
            return Arrival::End;
        };
        self.open = true;
        Arrival::Block(block.clone())
    }

    fn watch(&mut self, _: Duration) -> Option<String> {
        self.given_up.then(|| "PROGRAM INCOMPLETE".into())
    }

    fn acknowledge(&mut self) {
        assert!(self.open);
        self.open = false;
        if self.faults && self.random.below(3000) == 0 {
            // The acknowledgement was the last that the line carried, or not even that.
            self.next = None;
            return;
        }
        self.next = self.next.map(|next| next + 1);
    }

    fn give_up(&mut self) {
        (self.next, self.given_up) = (None, true);
    }
}

/// A machine that executes a block now and then, with room for some.
struct Model {
    waiting: VecDeque<Vec<u8>>,
    room: usize,
    executed: Vec<u8>,
    most: usize,
    complete: bool,
    ends_after: usize,
    blocks: usize,
    broken: u32,
}

impl Model {
    fn new(room: usize) -> Model {
        Model {
            waiting: VecDeque::new(),
            room,
            executed: Vec::new(),
            most: 0,
            complete: false,
            ends_after: usize::MAX,
            blocks: 0,
            broken: 0,
        }
    }

    fn execute(&mut self) {
        if let Some(block) = self.waiting.pop_front() {
            self.executed.extend(block);
            self.blocks += 1;
        }
    }
}

impl Machine for Model {
    fn wants_more(&self) -> bool {
        self.waiting.len() < self.room
    }

    fn has_ended(&self) -> bool {
        self.blocks >= self.ends_after
    }

    fn take(&mut self, text: &[u8]) -> bool {
        assert!(self.wants_more());
        self.waiting.push_back(text.to_vec());
        self.most = self.most.max(self.waiting.len());
        true
    }

    fn complete(&mut self) {
        self.complete = true;
    }

    fn broken(&mut self) {
        self.broken += 1;
    }
}

fn blocks(count: usize) -> Vec<Vec<u8>> {
    let block = |at: usize| format!("{at} L X+{} Y+{}", at % 97, at % 31).into_bytes();
    (0..count).map(block).collect()
}

fn bad_line(count: usize, seed: u64, faults: bool) -> BadLine {
    BadLine {
        blocks: blocks(count),
        random: Random(seed),
        next: None,
        open: false,
        given_up: false,
        faults,
    }
}

/// 1,000,000 blocks over lines that break some hundred times: START asks again each time, and the machine gets every block
/// once, in its order. No more waits than it has room for.
#[test]
fn a_million_blocks_over_bad_lines() {
    let mut restarts = 0;
    let (runs, count) = (500, 2000);
    for seed in 0..runs {
        let mut line = bad_line(count, seed, true);
        let with_end = |mut block: Vec<u8>| {
            block.extend(b"\r\n");
            block
        };
        let expected: Vec<u8> = blocks(count).into_iter().flat_map(with_end).collect();
        let mut machine = Model::new(1 + seed as usize % 50);
        let mut drip = Drip::start("15", &mut line);
        let mut idle = 0;
        while *drip.state() != DripState::Over {
            let went_on = drip.turn(&mut line, &mut machine, Duration::ZERO);
            idle = if went_on { 0 } else { idle + 1 };
            if line.random.below(3) > 0 {
                machine.execute();
            }
            // The line was cut off after an acknowledgement: the protocol's patience ends.
            let dead = line.next.is_none() && *drip.state() == DripState::Running;
            if matches!(drip.state(), DripState::Broken(_)) || dead {
                drip.start_again(&mut line);
                restarts += 1;
            }
            assert!(idle < 10_000, "{seed}: stuck");
        }
        while !machine.waiting.is_empty() {
            machine.execute();
        }
        let (found, whole) = (machine.executed.len(), expected.len());
        assert!(machine.executed == expected, "{seed}: {found} of {whole}");
        assert!(machine.complete && machine.most <= machine.room);
        assert_eq!(drip.blocks(), count as u64);
    }
    assert!(restarts > 500, "{restarts}");
}

/// Without room there is no acknowledgement, and when the run has ended the other side gets the end.
#[test]
fn a_full_machine_holds_the_line() {
    let mut line = bad_line(100, 1, false);
    let mut machine = Model::new(10);
    let mut drip = Drip::start("15", &mut line);
    for _ in 0..50 {
        drip.turn(&mut line, &mut machine, Duration::ZERO);
    }
    assert_eq!((drip.blocks(), drip.is_held(), line.open), (10, true, true));
    machine.execute();
    assert!(drip.turn(&mut line, &mut machine, Duration::ZERO));
    assert_eq!(drip.blocks(), 11);
    machine.ends_after = 1;
    // What stands after M30 is acknowledged, if it is no more than some blocks.
    for _ in 0..17 {
        assert_eq!((line.given_up, drip.state()), (false, &DripState::Running));
        drip.turn(&mut line, &mut machine, Duration::ZERO);
    }
    assert!(line.given_up && *drip.state() == DripState::Over && !machine.complete);
    assert_eq!(machine.waiting.len(), 10);
}

/// After a broken line the other side sends another program, or a shorter one: that is not executed.
#[test]
fn another_program_is_not_gone_on_with() {
    for other in [blocks(100).into_iter().rev().collect(), blocks(20)] {
        let mut line = bad_line(100, 1, false);
        let mut machine = Model::new(1000);
        let mut drip = Drip::start("15", &mut line);
        for _ in 0..40 {
            drip.turn(&mut line, &mut machine, Duration::ZERO);
        }
        line.blocks = other;
        drip.start_again(&mut line);
        for _ in 0..200 {
            drip.turn(&mut line, &mut machine, Duration::ZERO);
        }
        assert_eq!(*drip.state(), DripState::Broken("PROGRAM INCOMPLETE".into()));
        assert_eq!((machine.waiting.len(), machine.broken), (40, 1));
    }
}

/// A line is read when the one before it is acknowledged; after a broken transfer the program begins anew, or with its first
/// block and those that were not acknowledged.
#[test]
fn a_spool_knows_which_block_is_in_the_machine() {
    let text = "BEGIN PGM 1 MM\nL X+1\nL X+2\nL X+3\nEND PGM 1 MM\n";
    let memory = Memory::default();
    memory.put("1.H", text);
    let lines = |reader: &mut dyn Read, count: usize| {
        let mut found = String::new();
        for _ in 0..count {
            let mut buffer = [0; 1000];
            let count = reader.read(&mut buffer).unwrap();
            found += std::str::from_utf8(&buffer[..count]).unwrap();
        }
        found
    };
    for (resumes, again) in [
        (false, text),
        (true, "BEGIN PGM 1 MM\nL X+2\nL X+3\nEND PGM 1 MM\n"),
    ] {
        let mut spool = Spool::new(Box::new(memory.clone()), resumes);
        let spooled = spool.spooled();
        let mut reader = spool.open("1.H").unwrap();
        assert_eq!(lines(&mut *reader, 3), "BEGIN PGM 1 MM\nL X+1\nL X+2\n");
        let progress = spooled.progress();
        assert_eq!(
            (progress.name.as_str(), progress.blocks, progress.bytes),
            ("1.H", 2, 21)
        );
        spooled.broken_off();
        let mut reader = spool.open("1.H").unwrap();
        assert_eq!(lines(&mut *reader, 10), again);
        spooled.arrived("1.H");
        let progress = spooled.progress();
        assert_eq!((progress.blocks, progress.percent()), (5, 100.0));
        assert!(spool.create("2.H").is_err());
        // The next time it is whole again.
        assert_eq!(lines(&mut *spool.open("1.H").unwrap(), 10), text);
    }
}
