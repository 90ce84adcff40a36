//! The fast form does what the reference interpreter does: random programs, random inputs, the whole memory.

use std::fmt::Write;
use std::sync::Arc;

use crate::common::Bench;
use bahn_exchange::{Bit, BitArea, Exchange, Number, Size};
use bahn_plc::{Compilation, Machine, Op, Options, PlcError, RuntimeError, Start, Target, TraceStep, Tracer};
use proptest::prelude::*;

/// Kinds of statements that [`statement`] writes.
const KINDS: u8 = 26;

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn both_forms_agree(
        main in prop::collection::vec((0..KINDS, any::<u32>()), 1..25),
        subroutines in prop::collection::vec((0..KINDS, any::<u32>()), 2..12),
        inputs in prop::collection::vec(any::<u32>(), 1..6),
    ) {
        compare(&program(&main, &subroutines), &inputs);
    }
}

#[test]
fn errors_stop_both_forms_at_the_same_line() {
    let programs = [
        (50, "CM A\nEM\nLBL A\nCM A\nEM\n"),
        (52, "LBL A\nPS D8\nJP A\nEM\n"),
        (51, "PLW\n= W10\nEM\n"),
        (53, "REPEAT\nINC W10\nL W10\n== W10\nUNTILF\nEM\n"),
        (53, "LBL A\nJP A\nEM\n"),
        (53, "LBL B\nCM A\nJP B\nEM\nLBL A\nL S0\n= S1\nEM\n"),
        (54, "L K+3\n= B20\nCASE B20\nCM A\nCM A\nENDC\nEM\nLBL A\nEM\n"),
        (56, "L M1\n= M7\nL K+9000\n=X\nL M1\n= M5[X]\nEM\n"),
        (56, "LN M1\nL K-4\n=X\nL K+1\n= W6[X]\nEM\n"),
        (56, "L K+9000\n=X\nLN M1\nSN M2\nS M5[X]\nEM\n"),
        (51, "PS M1\nPL W10\nEM\n"),
        (
            56,
            "L KF F[X]\n= W10\nINCX\nINCX\nL KF F[X]\n= W12\nEM\nKFIELD F\nK+1\nK+2\nENDK\n",
        ),
    ];
    for (number, program) in programs {
        let stopped = compare(program, &[1, 2, 3]).map(|error| error.error.number());
        assert_eq!(stopped, Some(number), "{program}");
    }
}

#[test]
fn a_module_that_does_not_exist_stops_both_forms() {
    // The compiler refuses such a number; a program that was made otherwise may have it.
    let source = "INC W10\nL M1\nCMT 9071\nCM 9071\nEM\n";
    let mut program = crate::common::compile(source).program.unwrap();
    for instruction in &mut program.code {
        if let Op::Call { target, .. } = &mut instruction.op {
            *target = Target::Module(9199);
        }
    }
    let program = Arc::new(program);
    let bench = || Bench {
        machine: Machine::new(Arc::clone(&program), Start::PowerOn),
        ..Bench::new("EM\n")
    };
    let stopped = compare_benches([bench(), bench()], source, &[1]).unwrap();
    assert_eq!(
        (stopped.error, stopped.error.number(), stopped.line),
        (PlcError::ModuleNotDefined, 55, 4)
    );
}

#[test]
fn a_run_that_ends_too_late_is_an_error_in_both_forms() {
    // 130 strings at 80 us are 10.4 ms without any jump: found at the end.
    let program = |pairs| format!("{}EM\n", "L S0\n= S1\n".repeat(pairs));
    let stopped = compare(&program(65), &[1]).map(|error| error.error);
    assert_eq!(stopped, Some(PlcError::TimeOut));
    assert_eq!(compare(&program(60), &[1]), None);
}

#[test]
fn both_forms_agree_on_a_large_program() {
    let compilation = Compilation::compile(&crate::programs::mill(), "MILL.PLC", Options::default());
    assert_eq!(compilation.errors, []);
    let program = Arc::new(compilation.program.unwrap());
    assert!(program.code.len() > 8000);
    let bench = || Bench {
        machine: Machine::new(Arc::clone(&program), Start::PowerOn),
        ..Bench::new("EM\n")
    };
    let inputs: Vec<u32> = (0..50).collect();
    assert_eq!(compare_benches([bench(), bench()], "MILL.PLC", &inputs), None);
}

/// Runs a program in both forms and compares everything after every cycle; gives the error that
/// stopped them.
fn compare(program: &str, inputs: &[u32]) -> Option<RuntimeError> {
    compare_benches([Bench::new(program), Bench::new(program)], program, inputs)
}

fn compare_benches(benches: [Bench; 2], program: &str, inputs: &[u32]) -> Option<RuntimeError> {
    let [mut fast, mut reference] = benches;
    for (cycle, seed) in inputs.iter().enumerate() {
        for exchange in [&mut fast.exchange, &mut reference.exchange] {
            stimulate(exchange, *seed);
        }
        let found = fast.machine.scan(&mut fast.exchange, &mut fast.nc);
        let expected = reference
            .machine
            .scan_traced(&mut reference.exchange, &mut reference.nc, &mut Nobody);
        assert_eq!(found, expected, "cycle {cycle} of\n{program}");
        assert_eq!(
            state(&fast.machine),
            state(&reference.machine),
            "cycle {cycle} of\n{program}"
        );
        assert_eq!(
            fast.exchange.plc(),
            reference.exchange.plc(),
            "cycle {cycle} of\n{program}"
        );
        assert_eq!(
            fast.exchange.nc(),
            reference.exchange.nc(),
            "cycle {cycle} of\n{program}"
        );
    }
    fast.machine.stopped().cloned()
}

struct Nobody;

impl Tracer for Nobody {
    fn executed(&mut self, _: &TraceStep<'_>) {}
}

fn state(machine: &Machine) -> impl PartialEq + std::fmt::Debug {
    let registers = machine.registers();
    (
        (registers.logic, registers.word, registers.index, registers.next),
        (
            registers.text().to_vec(),
            registers.call_depth(),
            registers.stack_bytes(),
        ),
        machine.time(),
    )
}

fn stimulate(exchange: &mut Exchange, seed: u32) {
    let mut dice = Dice(u64::from(seed));
    for _ in 0..20 {
        let area = [BitArea::I, BitArea::M][dice.below(2)];
        exchange.nc_set(Bit::new(area, dice.below(30) as u16).unwrap(), dice.below(2) == 1);
        let number = Number::new(Size::Word, dice.below(32) as u16 * 2).unwrap();
        let value = [0, 1, 2, 3, -1, 100, -32768, 32767][dice.below(8)];
        exchange.nc_set_number(number, value);
    }
}

/// A program of statements; the statements of subroutines go to two modules in turn.
fn program(main: &[(u8, u32)], subroutines: &[(u8, u32)]) -> String {
    let (first, second) = subroutines.split_at(subroutines.len() / 2);
    let mut text = String::new();
    for (head, name, part) in [
        ("", "A", main),
        ("LBL FIRST\n", "B", first),
        ("LBL SECOND\n", "C", second),
    ] {
        text.push_str(head);
        for (n, (kind, seed)) in part.iter().enumerate() {
            let mut dice = Dice(u64::from(*seed));
            statement(&mut text, *kind, &mut dice, &format!("{name}{n}"));
        }
        text.push_str("EM\n");
    }
    text.push_str("LBL JOB\nINC W60\nL W60\n/ B3\n= W62\nEM\n");
    text.push_str("KFIELD FIELD\nK+5\nK-70000\nK$FF\nENDK\n");
    text
}

/// Writes one statement: complete chains, so that all may stand one after the other.
#[expect(clippy::too_many_lines, reason = "one arm for each kind of statement")]
fn statement(text: &mut String, kind: u8, dice: &mut Dice, label: &str) {
    let lines = match kind {
        0..=3 => logic(dice),
        4 => {
            let inside = format!("{}\n{} {}", logic_open(dice), gate(dice), bit(dice));
            format!(
                "{}\n{}[\n{inside}\n]\n= {}",
                logic_open(dice),
                gate(dice),
                bit(dice)
            )
        }
        5..=7 => format!("{}\n{}", word_chain(dice), word_end(dice)),
        8 => format!(
            "{}\n{} {}\n= {}",
            word_chain(dice),
            comparison(dice),
            value(dice),
            bit(dice)
        ),
        9 => {
            let operation = ["+", "-", "X", "/", "MOD", "A", "ON"][dice.below(7)];
            let inside = word_chain(dice);
            format!(
                "{}\n{operation}[\n{inside}\n]\n{}",
                word_chain(dice),
                word_end(dice)
            )
        }
        10 => {
            let inside = word_chain(dice);
            format!(
                "{}\n{}[\n{inside}\n]\n= {}",
                word_chain(dice),
                comparison(dice),
                bit(dice)
            )
        }
        11 => format!("{}\nBT {}\n= {}", word_chain(dice), value(dice), bit(dice)),
        12 => {
            let load = ["LB", "LW", "LD"][dice.below(3)];
            let assign = ["B=", "W=", "D="][dice.below(3)];
            format!("{load} {}\n{assign} {}", bit(dice), bit(dice))
        }
        13 => format!("{} {}", ["INC", "DEC"][dice.below(2)], number(dice)),
        14 => ["INCX", "DECX", "L K+0\n=X", "L K+2\n=X", "LX\n= W40"][dice.below(5)].to_owned(),
        15 => format!(
            "{}\nL {}\nPSL\n{}\nPLL\n= {}\nPLW\n= {}",
            "L W10\nPSW",
            bit(dice),
            ["PS W12\nPL D16", "PSX\nPLX", "PS M5\nPL M6"][dice.below(3)],
            bit(dice),
            number(dice)
        ),
        16 => format!("PS {}\nPL {}", value(dice), number(dice)),
        17 => {
            let module = ["CM 9010", "CM 9011", "CM 9012"][dice.below(3)];
            format!("PS K+{}\n{module}\nPL {}", dice.below(80), number(dice))
        }
        18 => {
            let end = ["= S1", "= S2[X]", "OVWR S0", "== S\"AB\"\n= M9", "> S1\n= M9"][dice.below(5)];
            format!("L {}\n+ {}\n{end}", string(dice), string(dice))
        }
        19 => {
            let (mut yes, mut no) = (String::new(), String::new());
            inner(&mut yes, dice, label, "Y");
            inner(&mut no, dice, label, "N");
            let test = ["IFT", "IFF"][dice.below(2)];
            format!("{}\n{test}\n{yes}ELSE\n{no}ENDI", logic_open(dice))
        }
        20 => {
            // As often as W50 says, but at most until the time is over.
            let mut body = String::new();
            inner(&mut body, dice, label, "L");
            let times = dice.below(6);
            format!("L K+{times}\n= W50\nREPEAT\n{body}DEC W50\nL W50\n<= K+0\nUNTILT")
        }
        21 => {
            let mut body = String::new();
            inner(&mut body, dice, label, "W");
            format!("L W52\n< K+20\nWHILET\n{body}INC W52\nL W52\n< K+20\nENDW")
        }
        22 => {
            let mut skipped = String::new();
            inner(&mut skipped, dice, label, "J");
            let jump = ["JPT", "JPF"][dice.below(2)];
            format!("{}\n{jump} {label}\n{skipped}LBL {label}", logic_open(dice))
        }
        23 => {
            let call = ["CMT", "CMF"][dice.below(2)];
            let target = ["FIRST", "SECOND", "9010"][dice.below(3)];
            if dice.below(2) == 0 {
                format!("PS K+8\n{}\n{call} {target}", logic_open(dice))
            } else {
                format!("CM {}", ["FIRST", "SECOND"][dice.below(2)])
            }
        }
        24 => format!(
            "L K+{}\n= B30\nCASE B30\nCM FIRST\nCM 9012\nCM SECOND\nENDC",
            dice.below(4).min(2 + dice.below(2))
        ),
        _ => [
            "SUBM JOB\n= B31",
            "RPLY B31\n= B32",
            "CAN B31",
            "L KF FIELD[X]\n= D36",
            "L M20\nEMT",
        ][dice.below(5)]
        .to_owned(),
    };
    text.push_str(&lines);
    text.push('\n');
}

/// One or two statements without structure.
fn inner(text: &mut String, dice: &mut Dice, label: &str, suffix: &str) {
    for n in 0..=dice.below(2) {
        let kind = dice.below(19) as u8;
        statement(text, kind, dice, &format!("{label}{suffix}{n}"));
    }
}

fn logic(dice: &mut Dice) -> String {
    let mut text = logic_open(dice);
    for _ in 0..=dice.below(2) {
        let command = ["=", "=N", "S", "R", "SN", "RN"][dice.below(6)];
        write!(text, "\n{command} {}", bit(dice)).unwrap();
    }
    text
}

/// A logic chain whose result is still open.
fn logic_open(dice: &mut Dice) -> String {
    let mut text = format!("{} {}", ["L", "LN"][dice.below(2)], bit(dice));
    for _ in 0..dice.below(4) {
        write!(text, "\n{} {}", gate(dice), bit(dice)).unwrap();
    }
    text
}

/// A word chain whose result is still open.
fn word_chain(dice: &mut Dice) -> String {
    let mut text = format!("{} {}", ["L", "L", "LN", "L-"][dice.below(4)], value(dice));
    for _ in 0..dice.below(3) {
        let command = [
            "+", "-", "X", "/", "MOD", "A", "AN", "O", "ON", "XO", "XON", "<<", ">>", "BS", "BC", "INCW",
            "DECW",
        ][dice.below(17)];
        match command {
            "INCW" | "DECW" => write!(text, "\n{command}").unwrap(),
            _ => write!(text, "\n{command} {}", value(dice)).unwrap(),
        }
    }
    text
}

fn word_end(dice: &mut Dice) -> String {
    format!("{} {}", ["=", "=", "=N", "=-"][dice.below(4)], number(dice))
}

fn gate(dice: &mut Dice) -> &'static str {
    ["A", "AN", "O", "ON", "XO", "XON"][dice.below(6)]
}

fn comparison(dice: &mut Dice) -> &'static str {
    ["==", "<", ">", "<=", ">=", "<>"][dice.below(6)]
}

fn bit(dice: &mut Dice) -> String {
    let index = if dice.below(8) == 0 { "[X]" } else { "" };
    let (area, count) = [("M", 30), ("I", 30), ("O", 30), ("T", 48), ("C", 30), ("M", 30)][dice.below(6)];
    // Places near the end of the area for commands that move many bits are left out: they stop the PLC.
    format!("{area}{}{index}", dice.below(count))
}

fn number(dice: &mut Dice) -> String {
    let index = if dice.below(8) == 0 { "[X]" } else { "" };
    let (letter, size) = [("B", 1), ("W", 2), ("D", 4)][dice.below(3)];
    format!("{letter}{}{index}", dice.below(48 / size) * size)
}

fn value(dice: &mut Dice) -> String {
    match dice.below(3) {
        0 => format!(
            "K{}",
            ["+0", "+1", "-1", "+7", "+32", "+32767", "-32768", "$FF"][dice.below(8)]
        ),
        _ => number(dice),
    }
}

fn string(dice: &mut Dice) -> String {
    ["S0", "S1", "S\"AB\"", "S#E10", "S1[X]", "S0", "S\"\""][dice.below(6)].to_owned()
}

/// Pseudo-random numbers of a seed (splitmix).
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut value = self.0;
        value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((value ^ (value >> 31)) % end as u64) as usize
    }
}
