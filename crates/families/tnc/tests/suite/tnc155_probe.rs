//! The markers of the touch probe of a TNC 155 [001:2258-2286].

use crate::support::knee::*;
use crate::support::*;

const PROBE: &str = "
[probe]
length = 100
radius = 2
[[probe.solid]]
min = [0, 0, -200]
max = [88, 200, 200]
";

/// M2024 as M2022 where the probe is not ready when it is to probe.
#[test]
fn m2024_says_that_the_probe_is_not_ready() {
    let program = "TCH PROBE 0.0 REF. PLANE Q10 X-\nTCH PROBE 0.1 X-60 Y+0 Z+0";
    let build = knee("       L     M2503\n       R     M2503").with(PROBE);
    let mut rig = asked(build.program("1", program).mps("44=300 45=-300 46=300 47=-300"));
    reference(&mut rig);
    rig.command("mode full");
    rig.command("select 1");
    let markers = |rig: &Rig| ["M2022", "M2024"].map(|marker| rig.bit(marker));
    assert_eq!(markers(&rig), [false; 2]);
    rig.event("fault probe not-ready");
    rig.start();
    rig.until(10.0, "the message", |rig| !rig.messages().is_empty());
    rig.seconds(0.1);
    assert_eq!(markers(&rig), [true; 2]);
    assert_eq!(rig.messages(), ["PROBE SYSTEM NOT READY"]);
}
