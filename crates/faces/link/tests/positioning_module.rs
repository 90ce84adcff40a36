//! A positioning module: a second control that moves axes for the PLC of the first one, over RS-422 with modules 9100 to 9106
//! [000:17986-18115]. What the two say to each other is the machine builder's; here it is a byte, in both directions.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

#[path = "../../../machine/host/tests/support/copy.rs"]
mod copy;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use bahn_exchange::{Bit, Number};
use bahn_host::{
    Action, Attendance, Host, LoadedMachine, Next, Notice, Operator, PowerOn, Reader, Source, Stamped,
};
use bahn_link::{PlcLine, Settings};
use bahn_program::Program;
use bahn_tnc::{Command, DataLineEvent, DataLineOrder, LineEvent, Programs, Switch};
use copy::copy;

const RS_422: usize = 1;

struct NoPrograms;

impl Programs for NoPrograms {
    fn open(&self, _: &str, _: &str) -> Result<Option<Arc<Program>>, String> {
        Ok(None)
    }
}

struct Folder(PathBuf);

impl Folder {
    /// A copy of a shipped machine with a module of its own in the PLC program.
    fn of(machine: &str, lines: &str, edits: &[(&str, &str)]) -> Folder {
        let from = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../../machines")
            .join(machine);
        let folder = std::env::temp_dir().join(format!("bahn-module-{machine}-{}", std::process::id()));
        copy(&from, &folder);
        let path = folder.join("plc/MAIN.PLC");
        let mut text = std::fs::read_to_string(&path).unwrap();
        for (from, to) in edits {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        std::fs::write(path, text + lines).unwrap();
        Folder(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A machine that is on, its PLC at RS-422.
struct Side {
    _folder: Folder,
    host: Host,
    notices: Reader<Stamped>,
    line: PlcLine,
}

impl Side {
    fn on(folder: Folder) -> Side {
        let machine = LoadedMachine::load(&folder.0).unwrap().unwrap();
        let operator = Operator::new(Attendance::Full, machine.folder.operator.clone(), None);
        let host = Host::new(&machine, PowerOn::fresh(&machine), Arc::new(NoPrograms), operator).unwrap();
        Side {
            _folder: folder,
            notices: host.notices(),
            host,
            line: PlcLine::default(),
        }
    }

    fn command(&mut self, text: &str) {
        let command: Command = text.parse().unwrap();
        let _ = self
            .host
            .act(Source::Script, Action::Command(0, command))
            .unwrap();
    }

    fn tell(&mut self, event: LineEvent) {
        self.command(&DataLineEvent::Line(RS_422, event).to_string());
    }

    /// A contour cycle, and what it sends.
    fn cycle(&mut self) -> Vec<u8> {
        self.host.step().unwrap();
        for next in self.notices.by_ref() {
            let Next::Item(Stamped {
                notice: Notice::Line(order),
                ..
            }) = next
            else {
                continue;
            };
            match order {
                DataLineOrder::Assigned { setup, .. } => {
                    let list = self.host.control().first().edited_list();
                    self.line.assign(setup.map(|_| Settings::of_plc(list)));
                }
                DataLineOrder::Send { text, .. } => self.line.transmit(&text),
                DataLineOrder::Taken { .. } => self.line.taken(),
            }
        }
        let now = Duration::from_micros(self.host.control().time_us());
        self.line.clock(now);
        let mut sent = Vec::new();
        if self.line.has_output() {
            // 9600 baud: about three characters in a contour cycle of 3 ms.
            self.line.send(3, now, &mut sent);
        }
        sent
    }

    fn receive(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.line.receive(*byte));
        while let Some(event) = self.line.event() {
            self.tell(event);
        }
    }

    fn bit(&self, name: &str) -> bool {
        let bit: Bit = name.parse().unwrap();
        self.host.control().exchange().plc().bit(bit)
    }

    fn number(&self, name: &str) -> i32 {
        let number: Number = name.parse().unwrap();
        self.host.control().exchange().plc().number(number)
    }
}

/// Both run until something is so.
fn until(master: &mut Side, module: &mut Side, seconds: f64, so: impl Fn(&Side, &Side) -> bool) {
    let begin = master.host.control().time_us();
    while !so(master, module) {
        let took = (master.host.control().time_us() - begin) as f64 * 1e-6;
        assert!(took < seconds, "{:?}", module.host.control().snapshot());
        let sent = master.cycle();
        module.receive(&sent);
        let sent = module.cycle();
        master.receive(&sent);
    }
}

/// The master orders a pallet, and its PLC has seen so.
fn order(master: &mut Side, module: &mut Side, pallet: u8) {
    for command in [format!("B600={pallet}"), "M971=0".to_owned(), "M970=1".to_owned()] {
        master.command(&command);
    }
    until(master, module, 1.0, |master, _| {
        !master.bit("M971") && master.bit("M970")
    });
}

/// The pallets stand in front of the machine where MP4210.2 and MP4210.3 of the module say.
#[test]
fn a_second_control_moves_the_pallets() {
    let module = Folder::of(
        "dig425",
        include_str!("positioning_module/module.plc"),
        &[
            (
                "       CM    SHUTTLE\n",
                "       CM    SHUTTLE\n       CM    LINE_WATCH\n",
            ),
            (
                "       A     M2045\n       = M36",
                "       A     M2045\n       O     M960\n       = M36",
            ),
            (
                "       L     M1962\n       IFT",
                "       L     M1962\n       O     M961\n       IFT",
            ),
        ],
    );
    let master = Folder::of(
        "mill",
        include_str!("positioning_module/master.plc"),
        &[(
            "       CM    MESSAGES\n",
            "       CM    MESSAGES\n       CM    LINE_WATCH\n",
        )],
    );
    let (mut master, mut module) = (Side::on(master), Side::on(module));
    for side in [&mut master, &mut module] {
        side.tell(LineEvent::Ready(Switch::On));
    }
    // The module has its reference before anything is ordered: before, no positioning is possible.
    until(&mut master, &mut module, 60.0, |_, module| {
        module.bit("M30") && !module.bit("M32")
    });
    let places = [1, 2].map(|pallet| {
        let place = module
            .host
            .control()
            .first()
            .edited_list()
            .get(4210, pallet + 1)
            .unwrap();
        (pallet, place)
    });
    for (pallet, place) in [places[1], places[0], places[1]] {
        order(&mut master, &mut module, pallet);
        until(&mut master, &mut module, 30.0, |master, _| master.bit("M971"));
        assert_eq!(master.number("B610"), i32::from(pallet));
        let axes = module.host.control().snapshot().axes;
        let shuttle = axes.iter().find(|axis| axis.letter == 'W').unwrap();
        assert!(
            (shuttle.machine - place).abs() < 0.05,
            "{pallet}: {}",
            shuttle.machine
        );
    }
    // The cable is pulled while an order is in transit: it is not answered, and comes through when it is plugged in.
    for side in [&mut master, &mut module] {
        side.line.unplugged();
        side.tell(LineEvent::Ready(Switch::Off));
    }
    order(&mut master, &mut module, 1);
    for _ in 0..2000 {
        assert_eq!((master.cycle(), module.cycle()), (vec![], vec![]));
    }
    assert!(!master.bit("M971") && master.bit("M970"));
    for side in [&mut master, &mut module] {
        side.tell(LineEvent::Ready(Switch::On));
    }
    until(&mut master, &mut module, 30.0, |master, _| master.bit("M971"));
    assert_eq!(master.number("B610"), 1);
}
