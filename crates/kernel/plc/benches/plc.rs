//! A program of 8000 instructions: cycle time of both forms, time to compile and to be ready, and the
//! instruction kinds one by one.
//!
//! ```text
//! cargo bench -p bahn-plc
//! ```

#![expect(clippy::unwrap_used, reason = "the programs compile and run")]

mod programs;

use std::sync::Arc;
use std::time::Instant;

use bahn_exchange::Exchange;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Compilation, Machine, MemoryFiles, Options, PlcProgram, Start, TestNc, TraceStep, Tracer};
use divan::Bencher;

fn main() {
    figures();
    kinds();
    divan::main();
}

/// A program with its surroundings.
struct Desk {
    machine: Machine,
    exchange: Exchange,
    nc: TestNc,
    inputs: u16,
}

impl Desk {
    fn new(program: Arc<PlcProgram>) -> Desk {
        Desk {
            machine: Machine::new(program, Start::PowerOn),
            exchange: Exchange::default(),
            nc: TestNc::new(ParameterList::reference(ControlModel::Tnc415b)),
            inputs: 0,
        }
    }

    /// An input changes every other cycle, as on a machine that works.
    fn change_inputs(&mut self) {
        self.inputs = self.inputs.wrapping_add(1);
        let number = (self.inputs / 4) % 32;
        let bit = bahn_exchange::Bit::new(bahn_exchange::BitArea::I, number).unwrap();
        self.exchange.nc_set(bit, self.inputs % 4 < 2);
    }

    fn scan(&mut self) {
        self.machine.scan(&mut self.exchange, &mut self.nc).unwrap();
    }

    fn scan_traced(&mut self, tracer: &mut dyn Tracer) {
        self.machine
            .scan_traced(&mut self.exchange, &mut self.nc, tracer)
            .unwrap();
    }

    /// Time of a scan in ns: the best of some series.
    fn scan_time(&mut self, fast: bool) -> f64 {
        let mut best = f64::INFINITY;
        for _ in 0..20 {
            let start = Instant::now();
            for _ in 0..100 {
                self.change_inputs();
                if fast {
                    self.scan();
                } else {
                    self.scan_traced(&mut Nothing);
                }
            }
            best = best.min(start.elapsed().as_nanos() as f64 / 100.0);
        }
        best
    }
}

struct Nothing;

impl Tracer for Nothing {
    fn executed(&mut self, _: &TraceStep<'_>) {}
}

#[derive(Default)]
struct Count(usize);

impl Tracer for Count {
    fn executed(&mut self, _: &TraceStep<'_>) {
        self.0 += 1;
    }
}

fn program(files: &MemoryFiles, main: &str) -> Arc<PlcProgram> {
    let compilation = Compilation::compile(files, main, Options::default());
    assert_eq!(compilation.errors, []);
    compilation.program.unwrap().into()
}

/// What the program is and how it compares with the original.
fn figures() {
    let program = program(&programs::mill(), "MILL.PLC");
    let mut desk = Desk::new(Arc::clone(&program));
    let mut count = Count::default();
    desk.scan_traced(&mut count);
    let memory = memory();
    let nominal = desk.machine.time().current as f64;
    let time = desk.scan_time(true);
    println!(
        "{} instructions, {} executed in a cycle; {:.1} us = {:.2} ns each; nominal {:.0} us, {:.0} times as long",
        program.code.len(),
        count.0,
        time / 1e3,
        time / count.0 as f64,
        nominal / 1e3,
        nominal / time
    );
    if let Some(memory) = memory {
        println!("memory of the whole process, with sources, both forms and images: {memory}");
    }
}

/// The largest memory that the process has had, as Linux tells it.
fn memory() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(line.trim_start_matches("VmHWM:").trim().to_owned())
}

/// Copies of an instruction kind in a program: few enough that the slowest stay within 10 ms of nominal time.
const REPEATED: u32 = 60;

/// Instruction kinds in ns, in the fast form: many of a kind less an empty program.
fn kinds() {
    let kinds = [
        ("A M", "L M1", "A M#"),
        ("= M", "L M1", "= M#"),
        ("S M", "L M1", "S M#"),
        ("L W, = W", "", "L W10\n= W12"),
        ("L, +, = W", "", "L W10\n+ W12\n= W14"),
        ("+ W", "L W10", "+ W12"),
        ("X W", "L W10", "X W12"),
        ("/ W", "L W10", "/ W12"),
        ("== K, = M", "", "L W10\n== K+5\n= M#"),
        ("INC W", "", "INC W10"),
        ("A M[X]", "L M1", "A M1[X]"),
        ("+ W[X]", "L W10", "+ W10[X]"),
        ("PS, PL W", "", "PS W10\nPL W12"),
        ("LB, B= M", "", "LB M100\nB= M200"),
        ("LD, D= M", "", "LD M100\nD= M200"),
        ("L S, = S", "", "L S0\n= S1"),
        ("PS,CM 9010,PL", "", "PS B10\nCM 9010\nPL B11"),
        ("CM, EM", "", "CM SUB"),
        ("JP", "", "JP @\nLBL @"),
    ];
    let cycle = |text: &str| {
        let files = MemoryFiles::from([("A.PLC", text)]);
        Desk::new(program(&files, "A.PLC")).scan_time(true)
    };
    let empty = cycle("EM\n");
    println!("an empty cycle: {empty:.0} ns");
    for (name, before, lines) in kinds {
        let repeated: String = (0..REPEATED)
            .map(|n| {
                format!(
                    "{}\n",
                    lines.replace('@', &format!("N{n}")).replace('#', &n.to_string())
                )
            })
            .collect();
        let text = format!("{before}\n{repeated}EM\nLBL SUB\nEM\n");
        let text = text.trim_start();
        println!(
            "{name:>14}: {:.2} ns",
            (cycle(text) - empty) / f64::from(REPEATED)
        );
    }
}

#[divan::bench]
fn cycle(bencher: Bencher) {
    let mut desk = Desk::new(program(&programs::mill(), "MILL.PLC"));
    bencher.bench_local(|| {
        desk.change_inputs();
        desk.scan();
    });
}

#[divan::bench]
fn cycle_of_the_reference(bencher: Bencher) {
    let mut desk = Desk::new(program(&programs::mill(), "MILL.PLC"));
    bencher.bench_local(|| {
        desk.change_inputs();
        desk.scan_traced(&mut Nothing);
    });
}

/// Reading and checking.
#[divan::bench]
fn compile(bencher: Bencher) {
    let files = programs::mill();
    bencher.bench_local(|| Compilation::compile(&files, "MILL.PLC", Options::default()));
}

/// From the source to a machine that runs at full speed.
#[divan::bench]
fn ready(bencher: Bencher) {
    let files = programs::mill();
    bencher.bench_local(|| Machine::new(program(&files, "MILL.PLC"), Start::PowerOn));
}
