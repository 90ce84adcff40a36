//! A program that leads nowhere ends as such, in bounded memory and with the control free for other things.

use crate::support::*;
use bahn_tnc::RunState;

/// Memory that a run may take beyond that of its start, bytes.
const MEMORY: u64 = 4_000_000;

/// A loop without movement ends with a message; it takes no more memory however long it runs, and no
/// preparation takes more than its share of it: the loop of 100 000 blocks needs more than a hundred.
#[test]
fn a_loop_without_movement_ends_in_constant_memory() {
    for body in [
        "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +0",
        "L IX+0 R0 F100",
        "TOOL DEF 7 L+0 R+5",
    ] {
        let program = format!("LBL 1\n{body}\nFN 9: IF +0 EQU +0 GOTO LBL 1");
        let mut build = Build::mill().program("1.H", &program);
        build.tools = None;
        let mut rig = build.rig();
        rig.power_on();
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        rig.until(1.0, "the run begins", |rig| {
            rig.control.run_state() == RunState::Running
        });
        let mut cycles = 0;
        let memory = allocation_counter::measure(|| {
            while rig.control.run_state() == RunState::Running {
                rig.cycle();
                cycles += 1;
                assert!(cycles < 20_000, "{body}: it does not end");
            }
        });
        assert!(memory.bytes_max < MEMORY, "{body}: {} bytes", memory.bytes_max);
        assert!(cycles > 100, "{body}: {cycles} cycles");
        let messages = rig.messages();
        assert!(
            messages[0].starts_with("ENDLESS LOOP program 1.H block"),
            "{body}: {messages:?}"
        );
    }
}
