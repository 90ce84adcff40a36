//! Numbers of machine parameters that a PLC program of a TNC 151 or 155 reads [001:1826-1841].

use crate::terminals::terminals;

/// MP158, MP249 and MP250 are the markers M2192 to M2239, MP209 to MP212 words with M3200 to M3263; MP126 to MP156 are the positions
/// 0 to 30, in 1/10 000 mm from D768 on. A program of one's own moves X to position 0 at MP163.
#[test]
fn numbers_for_the_plc() {
    /// MP126 to MP156, mm.
    const POSITIONS: [&str; 31] = [
        "126=60", "127=1.75", "128=2", "129=2.25", "130=2.5", "131=2.75", "132=3", "133=3.25", "134=3.5",
        "135=3.75", "136=4", "137=4.25", "138=4.5", "139=4.75", "140=5", "141=5.25", "142=5.5", "143=5.75",
        "144=6", "145=6.25", "146=6.5", "147=6.75", "148=7", "149=7.25", "150=7.5", "151=7.75", "152=8",
        "153=8.25", "154=8.5", "155=8.75", "156=9",
    ];
    let further = [
        "158=1",
        "249=2",
        "250=32772",
        "209=5",
        "210=7",
        "211=8",
        "212=32769",
        "163=6000",
    ];
    let mut build = terminals().program("1.H", "L M8");
    let values = further.into_iter().chain(POSITIONS);
    build.parameters.extend(values.map(str::to_owned));
    build.plc.push_str("       U     E40\n       UN    M90\n       S     M2452\n       R     M2468\n       U     E40\n       =     M90\n");
    let mut rig = build.rig();
    rig.power_on();
    let words = ["W982", "W984", "W986", "W988"].map(|word| rig.number(word));
    assert_eq!(words, [5, 7, 8, 32769 - 65536]);
    let set: Vec<u16> = (2192..2240)
        .filter(|number| rig.bit(&format!("M{number}")))
        .collect();
    assert_eq!(set, [2192, 2209, 2226, 2239]);
    assert!(rig.bit("M3200") && rig.bit("M3202") && rig.bit("M3263"));
    for (place, position) in POSITIONS.iter().enumerate() {
        let mm: f64 = position.split('=').nth(1).unwrap().parse().unwrap();
        let found = rig.number(&format!("D{}", 768 + 4 * place));
        assert_eq!(found, (mm * 10_000.0).round() as i32, "MP{position}");
    }
    rig.event("fault input E40 1");
    rig.seconds(3.0);
    assert!(
        (rig.machine_position('X') - 60.0).abs() < 0.05,
        "{}",
        rig.machine_position('X')
    );
}
