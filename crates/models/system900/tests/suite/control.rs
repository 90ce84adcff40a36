//! What a running control reads of its parameters, with the defaults of the chapter.

use bahn_path::Axis;
use bahn_system900::{AxisBlock, Connection, DataFile, Memory, Together, slots, together};

fn memory(text: &str) -> Memory {
    let file = DataFile::read(text.as_bytes());
    assert!(file.is_readable(), "{:?}", file.faults());
    file.memory().clone()
}

/// Kv 16, 250 ms, 9.5 V, lag limit 50 % for 50 ms, standstill 3 s; exact stop sqrt(1/1000) = 0.0316 mm and eight times of it.
#[test]
fn what_is_cleared_has_its_default() {
    let block = AxisBlock::of(&memory("q2000: 1\nq2004: 6000\nq2012: 1000\nq2013: 1\n"), 1);
    assert_eq!(block.connection, Connection::Axis);
    assert_eq!(
        (block.gain_s, block.ramps_s, block.max_volts),
        (16.0, [0.25, 0.25], 9.5)
    );
    assert_eq!(
        (block.lag_part, block.lag_s, block.standstill_s),
        (0.5, Some(0.05), 3.0)
    );
    let [fine, coarse] = block.exact_stop_mm;
    assert!((fine - 0.0316).abs() < 5e-5 && coarse == 8.0 * fine);
    assert_eq!(block.slopes_mm_min, [600.0, 1200.0]);
    assert_eq!((block.limits_mm, block.output), ([None, None], 1));
    // 6000 / (60 * 16) [002:7085-7091].
    assert_eq!(block.lag_mm(6000.0), 6.25);
}

/// -1 switches the lag off; dynamics 2 counts where it is larger [002:6974-6978].
#[test]
fn settings_act_as_they_are_written() {
    let block = AxisBlock::of(
        &memory("q2008: 100\nq2009: 50\nq2025: -1\nq2050: 50\nq2004: 6000\n"),
        1,
    );
    assert_eq!((block.ramps_s, block.lag_s), ([0.1, 0.1], None));
    assert_eq!(block.lag_mm(6000.0), 3.125);
    let block = AxisBlock::of(&memory("q2008: 100\nq2009: 400\n"), 1);
    assert_eq!(block.ramps_s, [0.1, 0.4]);
}

/// Override 1: 255 is P11313; of the table floor(255 * 27 / 256) = 26 is 120 %, limited to 110; 5 to 8 are fixed.
#[test]
fn overrides_go_through_their_table() {
    let percent = |text: &str, number| memory(text).override_percent(number);
    assert_eq!(percent("", 1), 100.0);
    assert_eq!(percent("q1311: 255\nq1313: 110\n", 1), 110.0);
    assert_eq!(percent("q1311: 128\n", 1), 128.0 * 100.0 / 255.0);
    assert_eq!(percent("q1311: 255\nq1313: 110\nq1314: 11370\n", 1), 110.0);
    assert_eq!(percent("q1311: 255\nq1314: 11370\n", 1), 120.0);
    assert_eq!(
        [5, 6, 7, 8].map(|number| percent("", number)),
        [0.0, 10.0, 50.0, 100.0]
    );
}

/// Network 2 holds channels 1 and 3; channel 2 is alone.
#[test]
fn networks_say_who_is_together() {
    let memory = memory("q2: 3\nq10: 99\nq914: $5\n");
    assert_eq!(
        [1, 2, 3].map(|channel| together(&memory, channel, Together::Stop).bits()),
        [5, 2, 5]
    );
    assert_eq!(together(&memory, 1, Together::Mode).bits(), 1);
}

/// X and Z have their letters, Y3 and Q what is left.
#[test]
fn axes_have_their_places() {
    let memory =
        memory("q110: $01010058\nq111: $02023359\nq112: $0303005A\nq113: $04040051\nq114: $00050000\n");
    let slots = slots(&memory, 1);
    let first: Vec<_> = slots.iter().take(5).copied().collect();
    assert_eq!(
        first,
        [Some(Axis::X), Some(Axis::U), Some(Axis::Z), Some(Axis::V), None]
    );
}
