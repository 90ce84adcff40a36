//! The PLC at its data interfaces: modules 9100 to 9107 with a line, 9110 and 9111 with a host [000:15587-15905].

use crate::stand::*;
use crate::support::*;
use bahn_plc::HostMessage;
use bahn_tnc::{DataLineOrder, LineSetup, OrderedLines};

/// A machine whose key A lets the PLC do the first job, and key B the second one. B410 is what was pulled.
struct Bench {
    rig: Rig,
    ordered: OrderedLines,
}

impl Bench {
    fn new(first: &str, second: &str) -> Bench {
        let plc = format!(
            "       L     I20\n       AN    M1500\n       CMT   50\n       L     I20\n       = M1500\n\
             \x20      L     I21\n       AN    M1501\n       CMT   51\n       L     I21\n       = M1501\n       EM\n\
             \x20      LBL   50\n       SUBM  60\n       = B400\n       EM\n\
             \x20      LBL   51\n       SUBM  61\n       = B401\n       EM\n\
             \x20      LBL   60\n{first}       L     M3171\n       = M1502\n       EM\n\
             \x20      LBL   61\n{second}       L     M3171\n       = M1502\n       EM\n"
        );
        Bench {
            rig: ready(bench(&plc).mp("5040=7").program("1.H", "L X+0")),
            ordered: OrderedLines::default(),
        }
    }

    /// The job of a key, done: what is ordered, and whether the module had an error.
    fn job(&mut self, key: &str) -> (Vec<DataLineOrder>, bool) {
        self.rig.command("M1502=0");
        self.rig.event(&format!("key {key} press"));
        self.rig.seconds(0.2);
        self.rig.event(&format!("key {key} release"));
        self.rig.seconds(0.1);
        (self.orders(), self.rig.bit("M1502"))
    }

    fn orders(&mut self) -> Vec<DataLineOrder> {
        let mut orders = Vec::new();
        self.rig
            .control
            .line_orders(&mut self.ordered, |order| orders.push(order));
        orders
    }
}

const RS422: &str = "K+1";

fn assign() -> String {
    call(&[RS422, "K+0"], 9100, &[])
}

/// The string goes out when the other side is there, and the next one when it is sent.
#[test]
fn a_string_goes_out() {
    let mut bench = Bench::new(&assign(), &call(&[RS422, "K+0"], 9103, &[]));
    let setup = LineSetup {
        baud: 9600,
        of_mode: false,
    };
    let assigned = DataLineOrder::Assigned {
        line: 1,
        setup: Some(setup),
    };
    assert_eq!(bench.job("A"), (vec![assigned], false));
    bench.rig.command("S0=\"PALLET 7\"");
    assert_eq!(bench.job("B"), (vec![], true), "nobody is there");
    bench.rig.command("rs422 ready on");
    let send = |text: &str| {
        let text = text.as_bytes().to_vec();
        vec![DataLineOrder::Send { line: 1, text }]
    };
    assert_eq!(bench.job("B"), (send("PALLET 7"), false));
    bench.rig.command("S0=\"PALLET 8\"");
    assert_eq!(bench.job("B"), (vec![], true), "the first one is not sent yet");
    bench.rig.command("rs422 sent");
    assert_eq!(bench.job("B"), (send("PALLET 8"), false));
}

/// FA 81 hexadecimal, the bytes of the manual's example [000:15595-15599], come and go.
#[test]
fn bytes_come_and_go() {
    let receive = call(&[RS422, "K+126"], 9106, &["B410"]);
    let send = call(&[RS422, "K+126", "K+2"], 9105, &[]);
    let mut bench = Bench::new(&format!("{}{send}", assign()), &receive);
    bench.rig.command("rs422 ready on");
    bench.rig.command("W126=$FA81");
    let (orders, _) = bench.job("A");
    let text = b"FA81".to_vec();
    assert_eq!(orders.last(), Some(&DataLineOrder::Send { line: 1, text }));
    bench.rig.command("W126=0");
    assert!(bench.job("B").1, "nothing has come");
    bench.rig.command("rs422 received \"FA81\"");
    let taken = DataLineOrder::Taken { line: 1 };
    assert_eq!(bench.job("B"), (vec![taken], false));
    assert_eq!(bench.rig.number("B410"), 2);
    // A word has its high byte first.
    assert_eq!(bench.rig.number("W126"), i32::from(0xFA81_u16 as i16));
    bench.rig.command("rs422 received \"FA8\"");
    assert!(bench.job("B").1, "an uneven number of characters");
}

/// The status of 9102: assigned, to the PLC, ready, transmit buffer empty; then a text that cannot be read, and ETX.
#[test]
fn the_status_follows_the_line() {
    let mut bench = Bench::new(&assign(), &call(&[RS422], 9102, &["W410"]));
    let status = |bench: &mut Bench| {
        bench.job("B");
        bench.rig.number("W410")
    };
    assert_eq!(status(&mut bench), 0b0000_1000);
    bench.job("A");
    bench.rig.command("rs422 ready on");
    assert_eq!(status(&mut bench), 0b0000_1111);
    bench.rig.command("rs422 faulty");
    assert_eq!(status(&mut bench), 0b0100_1111);
    bench.rig.command("rs422 etx");
    assert_eq!(status(&mut bench), 0b1100_1111);
}

/// While a transfer of the operator has the line, the PLC does not get it (9100), and the other way round until 9101.
#[test]
fn one_line_has_one_user() {
    let mut bench = Bench::new(&assign(), &call(&[RS422], 9101, &[]));
    bench.rig.command("rs422 taken on");
    assert_eq!(bench.job("A"), (vec![], true));
    bench.rig.command("rs422 taken off");
    assert!(!bench.job("A").1);
    let taken = "rs422 taken on".parse().unwrap();
    assert!(!bench.rig.control.command(taken));
    let released = DataLineOrder::Assigned { line: 1, setup: None };
    assert_eq!(bench.job("B"), (vec![released], false));
    bench.rig.command("rs422 taken on");
}

/// 9110 and 9111: a doubleword to the host, a string from it, the codes where there is no host and no message.
#[test]
fn messages_go_to_a_host_and_come_from_it() {
    let mut bench = Bench::new(
        &call(&["K+0", "K+128"], 9110, &["B410"]),
        &call(&["K+1", "K+2"], 9111, &["B410"]),
    );
    bench.job("A");
    assert_eq!(bench.rig.number("B410"), 1, "no connection to host");
    bench.rig.command("lsv2 connected");
    bench.rig.command("D128=-42");
    bench.job("A");
    assert_eq!(bench.rig.number("B410"), 0);
    assert_eq!(
        bench.rig.control.message_to_host(),
        Some(&HostMessage::Double(-42))
    );
    bench.rig.command("lsv2 taken");
    assert_eq!(bench.rig.control.message_to_host(), None);

    bench.job("B");
    assert_eq!(bench.rig.number("B410"), 2, "no message of this type");
    bench.rig.command("lsv2 message 7");
    bench.rig.command("lsv2 message \"PALLET 7\"");
    bench.job("B");
    assert_eq!(bench.rig.number("B410"), 0);
    assert_eq!(bench.rig.control.exchange().plc().text(2), b"PALLET 7");
}

/// FN15 prints when the path comes to the block, not when it is read ahead.
#[test]
fn a_program_prints() {
    let mut rig = bench_with("", "L X+60 R0 F600\nQ1 = 20.25\nFN15: PRINT Q1\nL X+70");
    let mut printed = Vec::new();
    rig.start();
    rig.seconds(0.5);
    rig.control.take_printed(|line| printed.push(line));
    assert!(printed.is_empty(), "{printed:?}");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    let lost = rig.control.take_printed(|line| printed.push(line));
    assert_eq!((printed, lost), (vec![(0, "+20.25".into())], 0));
}
