//! PLC programs in the form of the TNC 355: M2719 = 0, numbers in markers [000:16162-16293].

use std::collections::BTreeMap;

use crate::stand::*;
use crate::support::{Build, Rig};
use bahn_tnc::{RunState, Tool};

/// The bench with M2719 = 0.
fn old_form(plc: &str) -> Build {
    let mut build = bench(plc);
    let words = "       SN    M2719\n       L     M2719\n";
    assert!(build.plc.contains(words));
    build.plc = build
        .plc
        .replacen(words, "       R     M2719\n       LN    M2719\n", 1);
    build
}

/// Lines that act once when key A (I20) is pressed: M1 is its edge.
const EDGE_OF_A: &str = "
       L     I20
       AN    M0
       = M1
       L     I20
       = M0
";

/// Consecutive markers, lowest first.
fn markers(rig: &Rig, first: u16, count: u16) -> String {
    let marker = |number| if rig.bit(&format!("M{number}")) { '1' } else { '0' };
    (first..first + count).map(marker).collect()
}

/// `S` or `R` for each marker: the bits of a number, lowest first.
fn write(first: u16, bits: &str) -> String {
    let line = |(number, bit)| {
        let command = if bit == '1' { 'S' } else { 'R' };
        format!("       {command}     M{number}\n")
    };
    (first..).zip(bits.chars()).map(line).collect()
}

fn tap(rig: &mut Rig) {
    rig.event("key A press");
    rig.seconds(0.1);
    rig.event("key A release");
    rig.seconds(0.1);
}

/// The codes come with their strobes: M19 in M2072 to M2079 (9 and 1), T25 in M2032 to M2039 (binary with M2597 = 0, 5
/// and 2 with M2597 = 1) and in decades in M2112 to M2119, S2000 = S86 in M2064 to M2071 (6 and 8) [000:5831].
#[test]
fn codes_of_t_s_and_m_functions() {
    for (mode, tool) in [("R", "10011000"), ("S", "10100100")] {
        let plc = format!("       LN    M2719\n       {mode}     M2597\n{ACKNOWLEDGE}");
        let mut build = old_form(&plc).mp("3010=1").mp("3020=991");
        build.tools = Some(BTreeMap::from([(25, Tool::default())]));
        let mut rig = ready(build.program("1.H", "TOOL CALL 25 Z S2000\nM19"));
        rig.start();
        rig.until(2.0, "T", |rig| rig.bit("M2046"));
        assert_eq!(rig.number("W262"), 25);
        assert_eq!(
            (markers(&rig, 2032, 8), markers(&rig, 2112, 8)),
            (tool.into(), "10100100".into())
        );
        rig.until(2.0, "M", |rig| rig.bit("M2045"));
        assert_eq!(markers(&rig, 2072, 8), "10011000");
        assert_eq!(
            (rig.number("W258"), markers(&rig, 2064, 8)),
            (86, "01100001".into())
        );
        rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
        assert_eq!(markers(&rig, 2072, 8), "10011000", "codes are static");
    }
}

/// M2104 to M2106: the gear code of W256, 3 for 2500 rpm in the fourth gear.
#[test]
fn gear_code() {
    let mut build = old_form(ACKNOWLEDGE).mp("3010=4");
    for (gear, rpm) in (0..8).zip(["500", "1000", "2000", "3000", "4000", "5000", "6000", "7000"]) {
        build = build.mp(&format!("3510.{gear}={rpm}"));
        build = build.mp(&format!("3515.{gear}={rpm}"));
        build = build.mp(&format!("3210.{gear}=9"));
    }
    let mut rig = ready(build.program("1.H", "TOOL CALL 0 Z S2500"));
    rig.start();
    rig.until(2.0, "the gear", |rig| rig.bit("M2043"));
    assert_eq!((rig.number("W256"), markers(&rig, 2104, 3)), (3, "110".into()));
}

/// MP3020 = 20 80 2: the lowest code 20 in M2080 to M2087 (0 and 2) as in W1008, the step 2 in M2088 to M2091.
#[test]
fn lowest_speed_and_step() {
    let rig = ready(old_form("").mp("3020=20802").program("1.H", "M0"));
    assert_eq!(
        (rig.number("W1008"), markers(&rig, 2080, 8)),
        (20, "00000100".into())
    );
    assert_eq!(markers(&rig, 2088, 4), "0100");
}

/// The operating mode in M2051 to M2055 and M2057, one of them, and its code in M2176 to M2179 as in W272.
#[test]
fn operating_modes() {
    let mut rig = old_form("").program("1.H", "M0").rig();
    rig.until(10.0, "the reference run is asked for", |rig| rig.bit("M2057"));
    assert_eq!((rig.number("W272"), markers(&rig, 2176, 4)), (7, "1110".into()));
    let mut rig = ready(old_form("").program("1.H", "M0"));
    for (mode, marker, code) in [
        ("manual", "M2051", 1),
        ("handwheel", "M2052", 2),
        ("mdi", "M2053", 3),
        ("single", "M2054", 4),
        ("full", "M2055", 5),
    ] {
        rig.command(&format!("mode {mode}"));
        rig.seconds(0.1);
        let set: Vec<String> = (2049..=2057)
            .map(|number| format!("M{number}"))
            .filter(|marker| rig.bit(marker))
            .collect();
        assert_eq!(set, [marker]);
        let bits: String = (0..4)
            .map(|place| if code >> place & 1 == 1 { '1' } else { '0' })
            .collect();
        assert_eq!((rig.number("W272"), markers(&rig, 2176, 4)), (code, bits));
    }
}

/// M2832-M2839: the code 100 of an inhibited key, binary, as in W274.
#[test]
fn code_of_an_inhibited_key() {
    let mut rig = ready(old_form("       LN    M2719\n       S     M2896\n").program("1.H", "M0"));
    rig.seconds(0.1);
    rig.command("key 100");
    rig.seconds(0.1);
    assert_eq!(
        (rig.number("W274"), markers(&rig, 2832, 8)),
        (100, "00100110".into())
    );
}

/// Z to MP4210.2 by M70: the code 2 in M2570-M2574, the strobe M2454 with its complement M2470.
fn m70(more: &str) -> String {
    format!(
        "{ACKNOWLEDGE_BUT_M}
       L     M2045
       AN    M0
       = M1
       L     M2045
       = M0
       L     M1
{}       S     M2454
       R     M2470
{more}       L     M2045
       AN    M2454
       = M2482
",
        write(2570, "01000")
    )
}

/// The order of edges: with the M function strobe and complement change together; the NC changes both back
/// in position, and the M function is acknowledged. The position is MP4210.2 (code in M2570-M2574), the feed MP4220.2
/// [000:16177]: 1800 mm/min are 30 mm a second.
#[test]
fn positioning_in_markers() {
    let build = old_form(&m70("")).mp("4210.2=80").mp("4220.2=1800");
    let mut rig = ready(build.program("1.H", "M70\nL Z+40 R0 F6000"));
    assert_eq!((rig.bit("M2454"), rig.bit("M2470")), (false, true), "at rest");
    let way = (80.0 - rig.machine_position('Z')).abs();
    rig.start();
    rig.until(2.0, "M70", |rig| rig.bit("M2454"));
    let from_us = rig.control.time_us();
    rig.until(4.0, "the position", |rig| !rig.bit("M2454"));
    let seconds = (rig.control.time_us() - from_us) as f64 * 1e-6;
    assert!((seconds - way / 30.0).abs() < 0.3, "{seconds} s for {way} mm");
    near(rig.machine_position('Z'), 80.0);
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'Z'), 40.0);
    let build = old_form(&m70("")).mp("4210.2=80").mp("4220.2=1800");
    let mut rig = ready(build.program("1.H", "M70"));
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2045 M2454 M2470 M2482", 3.0),
        "M2045+ M2454+ M2470- M2454- M2470+ M2482+ M2045- M2482-"
    );
}

/// Each axis has its own markers: M2452 with M2468 and M2560-M2564 for X, M2453 with M2469 and M2565-M2569 for Y.
/// Both go at once, to MP4210.31 and MP4210.16.
#[test]
fn two_axes_at_once() {
    let plc = format!(
        "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n{}{}       S     M2452\n       R     M2468\n       S     M2453\n       R     M2469\n",
        write(2560, "11111"),
        write(2565, "00001"),
    );
    let mut rig = ready(
        old_form(&plc)
            .mp("4210.31=61")
            .mp("4210.16=-7")
            .mp("4220.0=6000")
            .mp("4220.1=6000")
            .program("1.H", "M0"),
    );
    rig.event("key A press");
    rig.until(1.0, "both", |rig| rig.bit("M2452") && rig.bit("M2453"));
    rig.until(5.0, "the positions", |rig| !rig.bit("M2452") && !rig.bit("M2453"));
    near(rig.machine_position('X'), 61.0);
    near(rig.machine_position('Y'), -7.0);
    assert!(rig.bit("M2468") && rig.bit("M2469"));
}

/// Axes 4 and 5 have M2455 with M2471 and M2575-M2579, M2522 with M2538 and M2580-M2584. Where there is no such
/// axis the strobe waits, as that of words does.
#[test]
fn strobes_of_axes_that_are_not_there() {
    for (strobe, complement) in [("M2455", "M2471"), ("M2522", "M2538")] {
        let plc = format!(
            "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n       S     {strobe}\n       R     {complement}\n"
        );
        let mut rig = ready(old_form(&plc).program("1.H", "M0"));
        assert!(rig.bit(complement));
        tap(&mut rig);
        assert!(rig.bit(strobe) && !rig.bit(complement));
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// The 4th axis of the mill goes to MP4210.5 by M2455 and the code in M2575-M2579.
#[test]
fn the_fourth_axis() {
    let mut build = Build::mill().mp("4210.5=90").mp("4220.3=3600");
    let order = format!(
        "       R     M2719\n       L     I140\n       AN    M198\n       = M199\n       L     I140\n       = M198\n       L     M199\n{}       S     M2455\n       R     M2471\n       EM",
        write(2575, "10100")
    );
    build.plc = build.plc.replacen(
        "\n       EM",
        &format!("\n       LN    M0\n       O     M0\n{order}"),
        1,
    );
    build.plc = build.plc.replacen("       SN    M2719\n", "", 1);
    let mut rig = build.rig();
    rig.power_on();
    rig.seconds(1.0);
    rig.event("key LUBRICATE press");
    rig.until(2.0, "the strobe", |rig| rig.bit("M2455"));
    rig.until(10.0, "the position", |rig| !rig.bit("M2455"));
    assert!(
        (rig.machine_position('C') - 90.0).abs() < 0.02,
        "{}",
        rig.machine_position('C')
    );
    assert!(rig.bit("M2471"));
}

/// The PLC aborts by resetting the strobe: the axis stops on its way, the NC sets the complement.
#[test]
fn the_plc_aborts() {
    let plc = m70("       L     I20\n       R     M2454\n");
    let mut rig = ready(
        old_form(&plc)
            .mp("4210.2=200")
            .mp("4220.2=600")
            .program("1.H", "M70"),
    );
    rig.start();
    rig.until(2.0, "M70", |rig| rig.bit("M2454"));
    rig.seconds(0.5);
    rig.event("key A press");
    assert_eq!(
        edges(&mut rig, "M2045 M2454 M2470 M2482", 0.5),
        "M2454- M2482+ M2045- M2470+ M2482-"
    );
    assert!(rig.machine_position('Z') < 150.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// A strobe that waits for its axis may be taken back, too: the NC sets the complement, and nothing is a fault.
#[test]
fn the_plc_takes_a_strobe_back() {
    for (strobe, complement) in [("M2455", "M2471"), ("M2527", "M2543")] {
        let plc = format!(
            "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n       S     {strobe}\n       R     {complement}\n       L     I21\n       R     {strobe}\n"
        );
        // Without MP3010 = 6 to 8 the spindle cannot be oriented, and there is no fourth axis.
        let mut rig = ready(old_form(&plc).mp("3010=3").program("1.H", "M0"));
        tap(&mut rig);
        assert!(rig.bit(strobe) && !rig.bit(complement));
        rig.event("key B press");
        rig.seconds(0.1);
        assert!(!rig.bit(strobe) && rig.bit(complement));
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// A strobe that agrees with its complement (M2452 with M2468 to M2455 with M2471, M2522 with M2538, M2527 with M2543)
/// is a fault of the PLC program, in M2719 = 0 only.
#[test]
fn strobes_need_their_complements() {
    for (strobe, code) in [
        ("M2452", "1E"),
        ("M2453", "1F"),
        ("M2454", "1G"),
        ("M2455", "1H"),
        ("M2522", "2K"),
        ("M2527", "2P"),
    ] {
        let plc = format!("{ACKNOWLEDGE}       L     I20\n       S     {strobe}\n");
        let mut rig = ready(old_form(&plc).program("1.H", "M0"));
        rig.event("key A press");
        rig.seconds(0.1);
        assert_eq!(rig.messages(), [format!("ERROR IN PLC-PROGRAM {code}")]);
        let mut rig = bench_with(&plc, "M0");
        rig.event("key A press");
        rig.seconds(0.1);
        assert_eq!(rig.messages(), [""; 0], "{strobe} with M2719 = 1");
    }
}

/// M2719 = 0: the strobes of words are not taken; M2719 = 1: those of markers are not.
#[test]
fn only_the_strobes_of_the_form_are_taken() {
    let order = |strobes: &str| {
        let set: String = strobes
            .split(' ')
            .map(|strobe| format!("       {strobe}\n"))
            .collect();
        format!("{ACKNOWLEDGE}       L     K+900000\n       = D528\n       L     K+6000\n       = W560\n       L     I20\n{}{set}", write(2560, "01000"))
            .replace("_", "     ")
    };
    let words = order("S_M2704 S_M2713 S_M2716 S_M2813 S_M2712");
    let mut rig = ready(old_form(&words).program("1.H", "M0"));
    let x = rig.machine_position('X');
    rig.event("key A press");
    rig.seconds(1.0);
    for strobe in ["M2704", "M2713", "M2716", "M2813", "M2712"] {
        assert!(rig.bit(strobe), "{strobe} waits");
    }
    near(rig.machine_position('X'), x);
    near(display(&rig, 'X'), 50.0);
    assert_eq!(rig.messages(), [""; 0]);
    let old = order("S_M2452 R_M2468 S_M2809 S_M2819 S_M2808 S_M2527 R_M2543");
    let mut rig = ready(bench(&old).mp("4210.2=90").mp("4210.32=20").program("1.H", "M0"));
    rig.event("key A press");
    rig.seconds(1.0);
    for strobe in ["M2452", "M2809", "M2819", "M2808", "M2527"] {
        assert!(rig.bit(strobe), "{strobe} waits");
    }
    near(rig.machine_position('X'), x);
    near(display(&rig, 'X'), 50.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The check of 1R runs on the strobes of the TNC 355: positioning, M2809 and M2819 are one each, several axes one
/// command [000:631-633].
#[test]
fn two_uses_of_the_same_markers() {
    let positioning = "       S     M2452\n       R     M2468\n       S     M2453\n       R     M2469\n";
    for (strobes, faulty) in [
        (format!("{positioning}       S     M2809\n"), true),
        (format!("{positioning}       S     M2819\n"), true),
        ("       S     M2809\n       S     M2819\n".to_owned(), true),
        (positioning.to_owned(), false),
    ] {
        let plc = format!("{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n{strobes}");
        let mut rig = ready(old_form(&plc).program("1.H", "M0"));
        tap(&mut rig);
        let expected: &[&str] = if faulty { &["ERROR IN PLC-PROGRAM 1R"] } else { &[] };
        assert_eq!(rig.messages(), expected, "{strobes}");
    }
}

/// M2522 with the code in M2580-M2584 positions the fifth axis, W, to MP4210.9.
#[test]
fn the_fifth_axis() {
    let plc = format!(
        "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n{}       S     M2522\n       R     M2538\n",
        write(2580, "10010")
    );
    let mut build = old_form(&plc).mp("4210.9=64");
    let list = "10=%10111 50=%10111 410.4=5 120.4=4 110.4=4 330.4=20 960.4=-52 910.4=500 920.4=-500 1010.4=15000 \
        1030.4=0.01 1050.4=9 1060.4=1 1110.4=0.5 1140.4=0.5 1330.4=3000 1340.4=5 1350.4=1 1410.4=0.5 1420.4=10 1510.4=4 \
        1710.4=9 1720.4=12 1810.4=2 1820.4=1 1830.4=100 4220.4=6000";
    for parameter in list.split_whitespace() {
        build = build.mp(parameter);
    }
    build.plant.push_str(
        "[axis.W]\noutput = \"5\"\nspeed = 15000\nvolts = 9\nstart = 50\n[axis.W.encoder]\ninput = \"X5\"\nperiod_um = 20\nmark = 52\n",
    );
    let mut rig = ready(build.program("1.H", "M0"));
    rig.event("key A press");
    rig.until(1.0, "the strobe", |rig| rig.bit("M2522"));
    rig.until(5.0, "the position", |rig| !rig.bit("M2522"));
    near(rig.machine_position('W'), 64.0);
    assert!(rig.bit("M2538"));
}

/// M2819: the datum is corrected by MP4210.32 (X) and .33 (Y) in the first traverse range, by .37 and .38 in the second,
/// .42 and .43 in the third [000:16182]; the NC resets the strobe.
#[test]
fn datum_correction_of_parameters() {
    let plc = format!(
        "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n       S     M2819\n       L     I21\n       AN    M2\n       = M3\n       L     I21\n       = M2\n       L     M3\n       S     M2816\n       S     M2824\n"
    );
    let mut build = old_form(&plc)
        .mp("4210.32=20")
        .mp("4210.33=-3")
        .mp("4210.37=7")
        .mp("4210.38=8");
    for parameter in ["911", "912"] {
        for axis in 0..3 {
            build = build.mp(&format!("{parameter}.{axis}=500"));
        }
    }
    for parameter in ["921", "922"] {
        for axis in 0..3 {
            build = build.mp(&format!("{parameter}.{axis}=-500"));
        }
    }
    let mut rig = ready(build.program("1.H", "M0"));
    rig.event("key A press");
    assert_eq!(edges(&mut rig, "M2819", 0.1), "M2819+ M2819-");
    rig.event("key A release");
    rig.seconds(0.1);
    near(display(&rig, 'X'), 70.0);
    near(display(&rig, 'Y'), 47.0);
    rig.event("key B press");
    rig.seconds(0.1);
    tap(&mut rig);
    // MP7490 of the mill: each range has its own datum, that of the second is the machine datum.
    near(display(&rig, 'X'), rig.machine_position('X') + 7.0);
    near(display(&rig, 'Y'), rig.machine_position('Y') + 8.0);
}

/// The PLC gives -12 to Q102 during M50 (M2818 = 1, M2817 = 0; M2560 to M2563 are 2, M2564 to M2567 are 1, M2576 is the
/// sign of M2560-M2576): it counts with the next strobe, as with words. The
/// PLC resets M2809 itself; while it is set, one number is taken [000:16179] [000:16286-16288].
#[test]
fn q_parameters_in_markers() {
    let value = format!(
        "       L     M1\n{}       R     M2817\n       S     M2818\n       S     M2809\n",
        write(2560, "01001000000000001")
    );
    let plc = format!(
        "{ACKNOWLEDGE_BUT_M}
       L     M2045
       A     M2076
       AN    M2072
       = M4
       L     M4
       AN    M0
       = M1
       L     M4
       = M0
{value}       LN    M2045
       R     M2809
       L     M2045
       = M2482
"
    );
    // M50 is 0 and 5: M2076 and M2078; M51 has M2072, too.
    let mut rig = ready(old_form(&plc).program("1.H", "M50\nL X+50 IY+Q102 R0 F6000\nM51\nL IY+Q102"));
    rig.start();
    assert_eq!(
        edges(&mut rig, "M2045 M2809 M2482", 0.2),
        "M2045+ M2809+ M2482+ M2045- M2809- M2482- M2045+ M2482+ M2045- M2482-"
    );
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'Y'), 50.0 - 12.0);
}

/// While M2809 stays set no second number is taken: Q100 is 7, not the 9 that stands there later.
#[test]
fn one_number_for_each_edge() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       = M2809\n       LN    I21\n{}       L     I21\n{}",
        write(2560, "1110"),
        write(2560, "1001")
    );
    let mut rig = ready(old_form(&plc).program("1.H", "M0"));
    rig.event("key A press");
    rig.seconds(0.1);
    rig.event("key B press");
    rig.seconds(0.1);
    let q = |rig: &Rig| {
        rig.control
            .remember()
            .q
            .iter()
            .find(|(number, _)| *number == 100)
            .map(|(_, value)| *value)
    };
    assert_eq!(q(&rig), Some(7.0));
    rig.event("key A release");
    rig.seconds(0.1);
    rig.event("key A press");
    rig.seconds(0.1);
    assert_eq!(q(&rig), Some(9.0));
}

/// M2808 presses the key whose code stands in M2800-M2807; the NC resets it. Soft keys have no code there: 0 is not
/// INTERNAL STOP but refused, M2187 = 1.
#[test]
fn simulated_keys_in_markers() {
    for (bits, refused) in [("00100110", false), ("00000000", true)] {
        let plc = format!(
            "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n{}       S     M2808\n",
            write(2800, bits)
        );
        let mut rig = ready(old_form(&plc).program("1.H", "M0"));
        rig.event("key A press");
        assert_eq!(edges(&mut rig, "M2808", 0.1), "M2808+ M2808-");
        assert_eq!(rig.bit("M2187"), refused, "{bits}");
    }
}

/// M2527 orients the spindle to MP4210.31, the code in M2585-M2589; strobe and complement M2543 are as at rest
/// when the spindle is in position [000:16183].
#[test]
fn orientation_in_markers() {
    let plc = format!(
        "{ACKNOWLEDGE}{EDGE_OF_A}       L     M1\n{}       S     M2527\n       R     M2543\n",
        write(2585, "11111")
    );
    let build = old_form(&plc)
        .mp("4210.31=120")
        .mp("3010=6")
        .mp("3440.0=5")
        .mp("3520.1=60")
        .mp("3410.1=0.05");
    let mut rig = ready(build.program("1.H", "M0"));
    rig.event("key A press");
    assert_eq!(
        edges(&mut rig, "M2527 M2543 M2127 M2007", 6.0),
        "M2527+ M2543- M2127+ M2527- M2543+ M2127- M2007+"
    );
    let angle = rig.machine.spindle().unwrap().angle_deg.rem_euclid(360.0);
    assert!((angle - 120.0).abs() < 1.0, "{angle}");
}

/// Markers that the manual says have no function on these controls [000:16442-16500]: a program runs as without them,
/// and the NC sets none of those that were its own.
#[test]
fn markers_without_a_function() {
    let of_the_plc: Vec<u16> = [2504, 2526, 2542]
        .into_iter()
        .chain(2509..=2511)
        .chain(2590..=2596)
        .chain(2598..=2599)
        .chain(2602..=2607)
        .chain(2664..=2668)
        .chain(2810..=2812)
        .chain(2820..=2823)
        .collect();
    let of_the_nc: Vec<u16> = [2020, 2021, 2024, 2049, 2050, 2056, 2060, 2062, 2063, 2188]
        .into_iter()
        .chain(2288..=2292)
        .collect();
    let program = "TOOL CALL 1 Z S1000\nM3\nL X+60 Y+55 R0 F1000\nM5\nL X+50 FMAX";
    let run_with = |set: bool| {
        let lines: String = of_the_plc
            .iter()
            .map(|marker| format!("       S     M{marker}\n"))
            .collect();
        let lines = if set { lines } else { String::new() };
        let plc = format!("{ACKNOWLEDGE}       LN    M2719\n       = M1\n{lines}");
        let mut rig = ready(old_form(&plc).program("1.H", program));
        let from_us = rig.control.time_us();
        rig.start();
        rig.until(20.0, "the end", |rig| {
            for marker in &of_the_nc {
                assert!(!rig.bit(&format!("M{marker}")), "M{marker}");
            }
            rig.control.snapshot().ended
        });
        assert_eq!(rig.control.snapshot().run, RunState::Idle);
        (
            rig.control.time_us() - from_us,
            rig.machine_position('X').to_bits(),
            rig.messages(),
        )
    };
    assert_eq!(run_with(true), run_with(false));
}
