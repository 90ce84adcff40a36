//! Any program that compiles runs with any inputs: no panic, no hang, and the fast form does what the
//! reference interpreter does. The first 16 bytes are inputs and words, the rest is the source.
//!
//! ```text
//! cargo +nightly fuzz run run_plc
//! ```

#![no_main]

use std::sync::Arc;

use bahn_exchange::{Bit, BitArea, Exchange, Number, Size};
use bahn_fuzz as _;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Compilation, Machine, MemoryFiles, Options, Start, TestNc, TraceStep, Tracer};
use libfuzzer_sys::fuzz_target;

const CYCLES: u16 = 4;

struct Nobody;

impl Tracer for Nobody {
    fn executed(&mut self, _: &TraceStep<'_>) {}
}

fuzz_target!(|bytes: &[u8]| {
    let Some((inputs, source)) = bytes.split_at_checked(16) else {
        return;
    };
    let files = MemoryFiles::from([("MAIN.PLC", source)]);
    let Some(program) = Compilation::compile(&files, "MAIN.PLC", Options::default()).program else {
        return;
    };
    let program = Arc::new(program);
    let nc = || TestNc::new(ParameterList::reference(ControlModel::Tnc415b));
    let machine = || Machine::new(Arc::clone(&program), Start::PowerOn);
    let (mut fast, mut reference) = (machine(), machine());
    let (mut fast_nc, mut reference_nc) = (nc(), nc());
    let (mut exchange, mut reference_exchange) = (Exchange::default(), Exchange::default());
    for cycle in 0..CYCLES {
        for exchange in [&mut exchange, &mut reference_exchange] {
            stimulate(exchange, inputs, cycle);
        }
        let found = fast.scan(&mut exchange, &mut fast_nc);
        let expected = reference.scan_traced(&mut reference_exchange, &mut reference_nc, &mut Nobody);
        assert_eq!(found, expected);
        assert_eq!(exchange.plc(), reference_exchange.plc());
        assert_eq!(exchange.nc(), reference_exchange.nc());
    }
});

/// Other operands in every cycle.
fn stimulate(exchange: &mut Exchange, inputs: &[u8], cycle: u16) {
    for (n, byte) in (0..).zip(inputs) {
        for place in 0..8 {
            if let Some(bit) = Bit::new(BitArea::I, n * 8 + place) {
                exchange.nc_set(bit, byte >> ((place + cycle) % 8) & 1 != 0);
            }
        }
        if let Some(number) = Number::new(Size::Byte, n) {
            exchange.nc_set_number(number, i32::from(*byte).wrapping_mul(i32::from(cycle)));
        }
    }
}
