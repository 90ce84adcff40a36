//! A host allocates nothing while nothing new happens, whoever follows it.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod support;

use support::*;

#[test]
fn steps_allocate_nothing_in_steady_state() {
    let mut host = mill("TOOL CALL 1 Z S1000\nL X+300 R0 F200");
    host.take_snapshots(0);
    let _slow = (host.snapshots(), host.notices());
    let mut moving = 0;
    seconds(&mut host, 40.0);
    for _ in 0..2000 {
        let allocated = allocation_counter::measure(|| host.step().unwrap());
        assert_eq!(allocated.count_total, 0, "{:?}", host.control().snapshot());
        moving += usize::from(!host.control().stands());
    }
    assert_eq!(moving, 2000);
}
