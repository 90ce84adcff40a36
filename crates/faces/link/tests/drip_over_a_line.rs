//! The drip feed over real sockets with the faults of a seed, by every protocol, against the peripheral: whatever the line does, the
//! machine gets every block once, or the control says that it has not.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use bahn_link::blockwise::{self, Rights};
use bahn_link::dnc::{BlockLine, Drip, DripState, Machine, ProtocolLine, Spool};
use bahn_link::{Attendant, Channel, Event, Line, Memory, Mode, Protocol, Settings, Spec, drive, standard};
use bahn_parameters::{ControlModel, ParameterList};

/// Nobody: the peripheral goes on until it is stopped.
struct Nobody;

impl Attendant for Nobody {
    fn event(&mut self, _: Event) -> Option<bool> {
        None
    }

    fn is_over(&mut self, _: bool, _: Duration) -> bool {
        false
    }
}

/// A machine with room for a little, which executes a line with every turn.
#[derive(Default)]
struct Model {
    text: Vec<u8>,
    waiting: usize,
    complete: bool,
}

impl Machine for Model {
    fn wants_more(&self) -> bool {
        self.waiting < 3
    }

    fn has_ended(&self) -> bool {
        false
    }

    fn take(&mut self, text: &[u8]) -> bool {
        self.text.extend_from_slice(text);
        self.waiting += 1;
        true
    }

    fn complete(&mut self) {
        self.complete = true;
    }

    fn broken(&mut self) {}
}

fn settings(spec: &Spec) -> Settings {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    // EXT2 speaks the standard protocol.
    list.set(5030, 1, 0.0).unwrap();
    Settings::of(&list, spec.mode).on(spec.baud, spec.timeout)
}

fn spec(line: Line, mode: Mode, fault: Option<u64>) -> Spec {
    Spec {
        mode,
        timeout: Duration::from_millis(300),
        fault,
        ..Spec::of(line)
    }
}

/// Transfers a program of so many blocks; how often START was pressed again.
fn transfer(blocks: usize, mode: Mode, fault: Option<u64>) -> u32 {
    let lines: String = (1..blocks)
        .map(|at| format!("{at} L X+{} Y+{}\r\n", at % 89, at % 13))
        .collect();
    let text = format!("0 BEGIN PGM 15 MM\r\n{lines}{blocks} END PGM 15 MM\r\n");
    let memory = Memory::default();
    memory.put("15.H", &text);
    let listening = spec(Line::Listen("127.0.0.1:0".into()), mode, fault);
    let mut channel = Channel::open(&listening, settings(&listening).characters).unwrap();
    let connecting = spec(Line::Connect(channel.place()), mode, None);
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&stop);
    let peripheral = std::thread::spawn(move || {
        let (settings, files) = (
            settings(&listening),
            Box::new(Spool::new(Box::new(memory), false)),
        );
        let rights = Rights {
            takes: false,
            ..Rights::ALL
        };
        let mut protocol: Box<dyn Protocol> = match settings.blockwise {
            true => Box::new(blockwise::Peripheral::new(settings, files, rights)),
            false => Box::new(standard::Peripheral::new(settings, files, rights)),
        };
        drive(
            &mut channel,
            &mut *protocol,
            &mut Nobody,
            &stopped,
            &mut |_, _, _| {},
        )
        .unwrap();
    });
    let channel = Channel::open(&connecting, settings(&connecting).characters).unwrap();
    let mut line = ProtocolLine::new(channel, settings(&connecting));
    let mut machine = Model::default();
    let mut drip = Drip::start("15.H", &mut line);
    let mut again = 0;
    let end = Instant::now() + Duration::from_secs(60);
    while *drip.state() != DripState::Over {
        assert!(
            Instant::now() < end,
            "{mode} {fault:?}: {} blocks, {:?}",
            drip.blocks(),
            drip.state()
        );
        drip.turn(&mut line, &mut machine, Duration::from_millis(5));
        machine.waiting = machine.waiting.saturating_sub(1);
        if let DripState::Broken(message) = drip.state() {
            assert!(!message.is_empty());
            again += 1;
            drip.start_again(&mut line);
        }
    }
    line.give_up();
    stop.store(true, Ordering::Relaxed);
    peripheral.join().unwrap();
    assert!(
        machine.text == text.as_bytes(),
        "{mode} {fault:?}: {} of {}",
        machine.text.len(),
        text.len()
    );
    assert!(machine.complete);
    assert_eq!(drip.blocks(), blocks as u64 + 1);
    again
}

#[test]
fn every_protocol_over_a_good_line() {
    for mode in [Mode::Fe1, Mode::Fe2, Mode::Ext1, Mode::Ext2, Mode::Me] {
        assert_eq!(transfer(3000, mode, None), 0, "{mode}");
    }
}

/// Bytes are lost, doubled and flipped, in both directions; START begins anew until everything is there.
#[test]
fn blocks_with_check_characters_over_bad_lines() {
    let again: u32 = (0..12).map(|seed| transfer(400, Mode::Fe2, Some(seed))).sum();
    assert!(again > 0, "{again}");
}
