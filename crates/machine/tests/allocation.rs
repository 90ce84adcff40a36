//! A machine does not allocate while it runs.
#![allow(clippy::unwrap_used, reason = "a test that panics fails")]
#![allow(unsafe_code, reason = "counting allocations takes an allocator")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use bahn_machine::Machine;
use bahn_servo::{INPUTS, OUTPUTS, Plant};

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: everything is handed on to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller keeps the rules of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the rules of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn a_second_of_the_mill_allocates_nothing() {
    let mut machine = Machine::from_toml(include_str!("../../../machines/mill/plant.toml")).unwrap();
    machine.set_control_ready(true);
    let mut inputs = [false; INPUTS];
    let mut outputs = [false; OUTPUTS];
    outputs.fill(true);
    machine.advance(100_000);
    let before = ALLOCATIONS.with(Cell::get);
    assert!(before > 0, "the allocator counts");
    for cycle in 0..1000u32 {
        for output in 0..6 {
            machine.set_nominal(output, f64::from(cycle % 19) - 9.0);
        }
        machine.advance(1000);
        for input in 0..6 {
            machine.encoder(input);
        }
        machine.inputs(&mut inputs);
        machine.set_outputs(&outputs);
        machine.probe_deflected();
        machine.operator();
    }
    assert_eq!(ALLOCATIONS.with(Cell::get) - before, 0);
}
