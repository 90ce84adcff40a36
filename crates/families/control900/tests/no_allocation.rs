//! An interpolation cycle allocates nothing: not while axes move, functions go to the PLC and blocks change.

#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod support;

use bahn_path::{At, Axis, Synchronisation};
use support::Rig;
use support::list::Line;

#[test]
fn cycles_allocate_nothing() {
    let mut rig = Rig::on("P11051: $10050601\n");
    let lines: Vec<Line> = (0..40)
        .map(|at| {
            let to = [
                (Axis::X, f64::from(at % 3) * 10.0),
                (Axis::Y, f64::from(at) * 2.0),
            ];
            let line = Line::to(&to, 5000.0);
            match at % 4 {
                0 => line.with(4, At::Start, Synchronisation::Mos),
                1 => line.with(6, At::Start, Synchronisation::MvsSvs),
                2 => line.with(5, At::End, Synchronisation::MnsSns),
                _ => line,
            }
        })
        .collect();
    rig.start(1, &lines);
    rig.start(2, &lines);
    let mut moved = 0;
    while !(rig.control.run(1).1 && rig.control.run(2).1) {
        rig.control.prepare();
        let (control, plant) = (&mut rig.control, &mut rig.plant);
        let allocated = allocation_counter::measure(|| control.cycle(plant));
        assert_eq!(allocated.count_total, 0, "at {} us", rig.control.now_us());
        moved += usize::from(rig.read("P8938") > 0.0);
    }
    assert!(moved > 500, "{moved}");
    assert_eq!(rig.control.transfers().count(), 60);
}
