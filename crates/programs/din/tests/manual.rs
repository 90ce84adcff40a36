//! The programs of the manual: what each block orders.

mod support;

use bahn_din::{Command, Independent, SpindleOrder};
use bahn_path::{Axis, Switch};
use bahn_text::MemoryFiles;
use support::{Bench, reported, reported_all, run, run_with, variable};

#[test]
fn functions_stand_in_their_block_with_its_motion() {
    // [004:60] and what its neighbours vary.
    let units = run("N20 G00 X25\nN30 X50\nN40 X75 M25\nN50 G01 X100 F2000\nN60 X125 Z100\nM30\n");
    assert_eq!(
        reported_all(&units),
        [
            "N20 to X25 Y0 rapid",
            "N30 to X50 Y0 rapid",
            "N40 M25 to X75 Y0 rapid",
            "N50 to X100 Y0 F2000",
            "N60 to X125 Y0 F2000",
            "#6 M30 end",
        ]
    );
    let last = units[4].motion.as_ref().expect("a motion");
    assert_eq!((last.start[Axis::Z], last.end[Axis::Z]), (0.0, 100.0));
}

#[test]
fn edge_banding_begins_and_ends() {
    // [004:69]
    let units =
        run("N05 X0 Y0\nN10 G108 (start)\nN20 G01 X90 Y90 F20\nN30 G01 X150 Y150 M33 F8\nN40 G107\nM30");
    assert_eq!(units[1].commands, [Command::EdgeBanding(Switch::On)]);
    assert_eq!(units[4].commands, [Command::EdgeBanding(Switch::Off)]);
    assert_eq!(reported(&units[3]), "N30 M33 to X150 Y150 F8");
    assert_eq!(units[0].motion, None, "the path stands there already");
}

#[test]
fn late_functions_and_their_explicit_gate() {
    // [004:72] [004:75] [004:78]
    let units = run("N05 M26 G00 X25\nN10 M27\nN50 G01 X125 F2000\nN60 #EXPL SYN (trigger)\nN80 X0 Y0\nM30");
    assert_eq!(reported_all(&units[..2]), ["N5 M26 to X25 Y0 rapid", "N10 M27"]);
    assert_eq!(units[3].commands, [Command::ExplicitSynchronisation]);
    assert_eq!(units[3].motion, None);
}

#[test]
fn additive_values_of_the_whole_list() {
    // [004:105-108], with other numbers.
    let text = "\
N15 M61=-418
N25 M15=77
N40 P1=250 P2=418
N45 X[M66=P1]
N55 S[REV 1200 M03 M71=-903]
N65 M15=77 M18=86 M61=-418 X[M66=250] S[REV 1200 M03 M71=-903]
N75 M71=-903 M61=-P2 M66=250
N85 X[M61=-418 M66=250] Y[M71=-903] S[M05 M71=903 M66=-250] M66 M71
N140 P3=250 P4=-418
N145 X[H24=P3]
N155 S[REV 900 M04 H27=-903]
N175 H27=-903 H21=P4 H24=250
N185 X[H27=-903 H30 H21=-418] Y[H24=250] S[M05 H21=418 H24=250] H33 H27
N205 X[M61=-418 H30 H27=-903 M66=250 H21=418] H33=38 M66=41 H24=250 M71
N1004 M30=5
";
    assert_eq!(
        reported_all(&run(text)),
        [
            "N15 M61=-418",
            "N25 M15=77",
            "N40",
            "N45 X[M66=250]",
            "N55 S[S1200] S[M3] S[M71=-903]",
            "N65 M15=77 M18=86 M61=-418 X[M66=250] S[S1200] S[M3] S[M71=-903]",
            "N75 M71=-903 M61=-418 M66=250",
            "N85 X[M61=-418] X[M66=250] Y[M71=-903] S[M5] S[M71=903] S[M66=-250] M66 M71",
            "N140",
            "N145 X[H24=250]",
            "N155 S[S900] S[M4] S[H27=-903]",
            "N175 H27=-903 H21=-418 H24=250",
            "N185 X[H27=-903] X[H30] X[H21=-418] Y[H24=250] S[M5] S[H21=418] S[H24=250] H33 H27",
            "N205 X[M61=-418] X[H30] X[H27=-903] X[M66=250] X[H21=418] H33=38 M66=41 H24=250 M71",
            "N1004 M30=5 end",
        ]
    );
}

#[test]
fn an_axis_moves_on_its_own_with_functions() {
    // [004:108]
    let units = run("N05 X[INDP G90 G01 FEED=1500 POS=320 M66=17 H27=-18]\nN10 G91 G00 X5\nM30");
    assert_eq!(reported(&units[0]), "N5 X[M66=17] X[H27=-18]");
    let order = Independent {
        axis: Axis::X,
        end: 320.0,
        rapid: false,
        feed_mm_min: 1500.0,
    };
    assert_eq!(units[0].commands, [Command::Independent(order)]);
    assert_eq!(
        reported(&units[1]),
        "N10 to X325 Y0 rapid",
        "the path goes on where the axis stands"
    );
}

#[test]
fn hexadecimal_additive_value() {
    // [004:105]: M50='16#1F' is M50=31.
    assert_eq!(
        reported_all(&run("M50='16#1F' H44 = -256 M51=2*[3+4]**2")),
        ["#1 M50=31 H44=-256 M51=98", "#1 end"]
    );
}

#[test]
fn channel_axes_and_spindle_in_one_block() {
    // [004:105] [004:162] [004:189]
    let units =
        run("N10 X[M7] S[M7] M7\nN20 M83 X[M83]\nN30 S2[M3 REV1000] G01 F100 X100\nN40 M3 S1000\nM30");
    assert_eq!(
        reported_all(&units[..4]),
        [
            "N10 X[M7] S[M7] M7",
            "N20 M83 X[M83]",
            "N30 S2[M3] S2[S1000] to X100 Y0 F100",
            "N40 M3 S1000",
        ]
    );
}

#[test]
fn a_spindle_is_placed() {
    let units = run("N10 S2[M19 POS=90]\nM30");
    let order = SpindleOrder {
        spindle: "S2".into(),
        position_deg: Some(90.0),
    };
    assert_eq!(reported(&units[0]), "N10 S2[M19]");
    assert_eq!(units[0].commands, [Command::Spindle(order)]);
}

#[test]
fn types_and_leads_are_written_through_macros() {
    // [004:123]
    let text = "\
%MicroJoint
\"MOS_TS\" = \"262144\" ;0x40000
\"KIND\" = \"8\"   \"VIA\" = \"[\\\"KIND\\\" * 1]\"
V.G.M_FCT[11].SYNCH = \"MOS_TS\"
V.G.M_FCT[11].PRE_OUTP_PATH = 11 ;mm
V.G.M_FCT[13].SYNCH = \"VIA\"
V. G. H_FCT[10+2]. PRE_OUTP_PATH = 12
N20 X200 M11 H12 M13
M30
";
    let mut bench = Bench::default();
    let (units, fault) = run_with(text, &mut bench, MemoryFiles::default());
    assert_eq!(fault, None);
    assert_eq!(
        bench.log,
        [
            "write V.G.M_FCT[11].SYNCH 262144",
            "write V.G.M_FCT[11].PRE_OUTP_PATH 11",
            "write V.G.M_FCT[13].SYNCH 8",
            "write V.G.H_FCT[12].PRE_OUTP_PATH 12",
        ]
    );
    assert_eq!(bench.values[&variable("V.G.M_FCT[].SYNCH", Some(13))], 8.0);
    assert_eq!(reported(&units[6]), "N20 M11 H12 M13 to X200 Y0 rapid");
}

#[test]
fn the_figures_use_types_without_defining_them() {
    // [004:144]: SYNCH = "MOS" at the beginning of the listing.
    let mut bench = Bench::default();
    let text = "V.G.M_FCT[11].SYNCH = \"MOS\"\nV.G.M_FCT[12].SYNCH = \"MVS_SLP\"\n\"MOS\"=\"4\"\nV.G.M_FCT[11].SYNCH = \"MOS\"";
    assert_eq!(run_with(text, &mut bench, MemoryFiles::default()).1, None);
    assert_eq!(
        bench.log,
        [
            "write V.G.M_FCT[11].SYNCH 1",
            "write V.G.M_FCT[12].SYNCH 32768",
            "write V.G.M_FCT[11].SYNCH 4"
        ]
    );
}

#[test]
fn commands_of_micro_joints() {
    // [004:126] [004:138] [004:144]
    let units = run("\
%microjoint16
N300 #CHANNEL SET [M_PRE_OUTPUT E=250 F=1500]
N30 X200 M11 (125mm)
N32 #VECTOR LIMIT ON[VEL=500]
N35 #CHANNEL SET [M_PRE_OUTPUT F=750 VECTOR_LIMIT_OFF]
N36 #VECTOR LIMIT ON [VEL=6*100 ACC=900 DEC=800]
N37 #VECTOR LIMIT OFF
N400#FLUSH ; barrier
N401 #FLUSH WAIT
M30");
    let commands: Vec<&Command> = units.iter().flat_map(|unit| &unit.commands).collect();
    let limit = |velocity_mm_min, acceleration_mm_s2, deceleration_mm_s2| Command::VectorLimit {
        velocity_mm_min,
        acceleration_mm_s2,
        deceleration_mm_s2,
    };
    assert_eq!(
        commands,
        [
            &Command::MicroJoint {
                entry_mm_min: Some(250.0),
                feed_mm_min: Some(1500.0),
                vector_limit_off: false
            },
            &limit(Some(500.0), None, None),
            &Command::MicroJoint {
                entry_mm_min: None,
                feed_mm_min: Some(750.0),
                vector_limit_off: true
            },
            &limit(Some(600.0), Some(900.0), Some(800.0)),
            &limit(None, None, None),
            &Command::Flush { wait: false },
            &Command::Flush { wait: true },
        ]
    );
    assert_eq!(&*units[6].place.block, "N400");
}

#[test]
fn subroutines_of_other_files() {
    // [004:114]
    let beside = MemoryFiles::from([
        ("Laser_on.sub", "N1 M300\nN2 M17\nN3 M99\n"),
        ("Laser_off.sub", "(* no head, no end *)\nG91 X1 M500"),
    ]);
    let text = "N10 G00 G90 X0 Y0\nN15 L Laser_on.sub\nN20 G01 F5000\nN25 Y7\nN30 M500 M300 ;joint\nN55 L Laser_off.sub\nN99 M30";
    let (units, fault) = run_with(text, &mut Bench::default(), beside);
    assert_eq!(fault, None);
    assert_eq!(
        reported_all(&units),
        [
            "N10",
            "N15",
            "N1 M300",
            "N2 M17",
            "N20",
            "N25 to X0 Y7 F5000",
            "N30 M500 M300",
            "N55",
            "#2 M500 to X1 Y7 F5000",
            "N99 M30 end",
        ]
    );
    assert_eq!(&*units[2].place.program, "Laser_on.sub");
    assert_eq!(units[8].place.line, 2);
}

#[test]
fn comments_of_all_kinds() {
    // [004:60] [004:123] [004:129]
    let units =
        run("; a line\n(another)\n(* M100 - off, M26 - on *)\nN1 X1 (a) M5 (* b ) *) H2 ; c (\n\nM30");
    assert_eq!(reported_all(&units), ["N1 M5 H2 to X1 Y0 rapid", "#6 M30 end"]);
}

#[test]
fn blocks_are_named_by_number_or_line() {
    let units = run("n0040 x1\n\nX2\nN04 X3\nN04 X4\nN300 X5\nN01 X6\nN000\n");
    let blocks: Vec<&str> = units.iter().map(|unit| &*unit.place.block).collect();
    assert_eq!(blocks, ["N40", "#3", "N4", "N4", "N300", "N1", "N0", "N0"]);
}
