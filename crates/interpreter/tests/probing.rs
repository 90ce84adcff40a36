//! TCH PROBE 0: measuring in the program.

mod support;

use bahn_parameters::MessageId;
use bahn_path::{Axis, Barrier};
use support::*;

/// P17: the height of an island as the difference of two measured coordinates [003:4452-4487].
#[test]
fn p17_height_of_an_island() {
    let run = Job::new(manual("P17")).surfaces(&[10.0, 0.0]).run();
    run.assert_completed();
    assert_eq!((run.q[10], run.q[20]), (10.0, 0.0));
    assert_eq!(run.q[1], 0.0 - 10.0);
    // Both points are probed from above, at the place of the nominal point.
    let probes: Vec<_> = run
        .barriers
        .iter()
        .filter_map(|b| {
            if let Barrier::Probe { from, to, .. } = b {
                Some((*from, *to))
            } else {
                None
            }
        })
        .collect();
    assert_eq!(probes.len(), 2);
    for ((from, to), nominal) in probes.iter().zip([[20.0, 50.0, 10.0], [50.0, 10.0, 0.0]]) {
        close_points(
            &[[from[Axis::X], from[Axis::Y]]],
            &[[nominal[0], nominal[1]]],
            1e-9,
        );
        assert!(from[Axis::Z] > nominal[2] && to[Axis::Z] < nominal[2]);
    }
    // Q115 to Q117: the position at each touch [003:7643-7651].
    let touches: Vec<_> = run.touched_q.iter().filter(|q| q[115] != 0.0).collect();
    assert_eq!(touches[0][115..118], [20.0, 50.0, 10.0]);
    assert_eq!(run.q[115..118], [50.0, 10.0, 0.0]);
}

/// The surfaces of the test of the index: islands at Z = 4 and Z = -3.5 give -7.5.
#[test]
fn p17_other_surfaces() {
    let run = Job::new(manual("P17")).surfaces(&[4.0, -3.5]).run();
    run.assert_completed();
    assert_eq!((run.q[10], run.q[20], run.q[1]), (4.0, -3.5, -7.5));
}

/// The stylus meets nothing within the measuring range [003:4410].
#[test]
fn nothing_to_touch() {
    let run = Job::new(manual("P17")).surfaces(&[10.0]).run();
    assert_eq!(run.message(), Some((MessageId::TouchPointInaccessible, 13)));
}

/// In the plane the ball of the stylus touches beside its centre: the surface lies one radius further.
#[test]
fn probing_a_side() {
    let text = program(
        "TOOL CALL 0 Z
         L X-20 Y+0 Z+10 R0 FMAX
         TCH PROBE 0.0 REF. PLANE Q5 X+
         TCH PROBE 0.1 X+5 Y+0 Z-5",
    );
    // The centre of the ball of radius 2 stands at X = 2 when it touches the side X = 4.
    let run = Job::new(text).surfaces(&[4.0]).run();
    run.assert_completed();
    close(run.q[5], 4.0 + 2.0, 1e-9);
}
