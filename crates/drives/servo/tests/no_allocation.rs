//! Nothing is allocated in the servo cycle.

mod common;

use allocation_counter::measure;
use bahn_parameters::{ControlModel::Tnc415b, ParameterList};
use bahn_servo::{Encoder, Method, Rotation, Spindle, Way};
use common::Bench;

#[test]
fn the_cycle_of_an_axis_does_not_allocate() {
    let mut bench = Bench::new(
        Tnc415b,
        &["711.0=0.003", "712.0=0.001", "1511.0=6000", "1350.0=3"],
    );
    let counts = measure(|| drop(std::hint::black_box(Box::new(1))));
    assert_eq!(counts.count_total, 1, "the allocator counts");
    let allocated = measure(|| {
        bench.axis.set_circular(true);
        for method in [Method::Lag, Method::Precontrol] {
            bench.axis.set_method(method);
            for feed in [3000.0, -5000.0, 0.0] {
                bench.run(feed, 0.3);
                bench.encoder.mark = Some(bench.encoder.count);
                bench.axis.compensate_offset();
                bench.axis.adjust_offset();
            }
        }
        // Into a fault and out of it.
        bench.blocked = true;
        bench.run(9000.0, 0.2);
        bench.axis.acknowledge();
        bench.run(9000.0, 1.0);
    });
    assert!(bench.axis.fault().is_some());
    assert_eq!(allocated.count_total, 0);
}

#[test]
fn the_cycle_of_the_spindle_does_not_allocate() {
    let settings = ParameterList::reference(Tnc415b).spindle_parameters().settings;
    let mut spindle = Spindle::new(settings, Tnc415b.timing());
    let mut encoder = Encoder::default();
    let allocated = measure(|| {
        for round in 0..4 {
            let gear = spindle.gear_for(1000.0).unwrap();
            spindle.set_speed(1000.0, gear);
            spindle.rotate(Rotation::M3);
            for step in 0..2000 {
                if step == 1000 {
                    spindle.orient(f64::from(round), 0.0, Way::Shortest);
                }
                encoder.count += (spindle.step() * 1000.0) as i64;
                encoder.mark = (step % 100 == 0).then_some(encoder.count);
                spindle.measure(encoder);
            }
        }
    });
    assert_eq!(allocated.count_total, 0);
}
