//! A contour cycle allocates nothing by hand either: reference run, keys, handwheel, PLC positioning, a
//! slave, clamping, EMERGENCY STOP; only messages take memory.

mod support;

use support::bench::*;
use support::*;

/// Runs for a time and counts the allocations of the cycles.
fn allocations(rig: &mut Rig, seconds: f64) -> u64 {
    let end = rig.control.time_us() + (seconds * 1e6) as u64;
    let mut count = 0;
    while rig.control.time_us() < end {
        rig.control.prepare();
        count += allocation_counter::measure(|| rig.control.cycle(&mut rig.machine)).count_total;
    }
    count
}

#[test]
fn cycles_allocate_nothing() {
    let program = "
       L K+1200000
       = D528
       L K+1500
       = W560
       L I28
       AN M90
       S M2704
       L I28
       = M90
       L I29
       = M2545
";
    let mut rig = bench(program)
        .with(&fourth('V', ""))
        .mps(
            "10=15 50=15 410.3=4 960.3=-100 850.3=1 855.3=0.5 860.3=1 1340.3=0 1220=1 7640=2 4060.0=1 4410=3",
        )
        .rig();
    rig.until(5.0, "the reference run is asked for", |rig| {
        rig.control.snapshot().mode == bahn_tnc::Mode::Reference
    });
    rig.seconds(0.5);
    rig.start();
    assert_eq!(allocations(&mut rig, 10.0), 0, "reference run");
    assert_eq!(rig.control.snapshot().mode, bahn_tnc::Mode::Manual);
    for key in ["RAPID press", "X- press", "Y+ press"] {
        rig.event(&format!("key {key}"));
    }
    assert_eq!(allocations(&mut rig, 0.4), 0, "keys");
    for key in ["RAPID release", "X- release", "Y+ release"] {
        rig.event(&format!("key {key}"));
    }
    assert_eq!(allocations(&mut rig, 0.5), 0);
    rig.input("I28", true);
    assert_eq!(allocations(&mut rig, 5.0), 0, "PLC positioning");
    close(rig.table('X'), 120.0, 0.01);
    rig.input("I29", true);
    assert_eq!(allocations(&mut rig, 0.5), 0, "an open loop");
    rig.input("I29", false);
    rig.command("mode handwheel");
    rig.command("handwheel X 2");
    rig.event("handwheel 2000");
    assert_eq!(allocations(&mut rig, 2.0), 0, "handwheel");
    assert!(rig.table('X') > 125.0, "{}", rig.table('X'));
    assert_eq!(rig.messages(), [""; 0]);
}
