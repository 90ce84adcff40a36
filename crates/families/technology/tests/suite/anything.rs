//! Whatever a program says: its run ends, with a report that holds together.

use crate::common::{Asked, Bench};
use bahn_technology::EventKind;
use proptest::prelude::*;

const WORDS: [&str; 56] = [
    "G00",
    "G01",
    "G02",
    "G03",
    "G90",
    "G91",
    "G04 X0.2",
    "X10",
    "X20",
    "X-5",
    "Y3",
    "Y-7.5",
    "Z1",
    "I5",
    "J0",
    "F1000",
    "F6000",
    "M7",
    "M8",
    "M9",
    "M3",
    "M4",
    "M5",
    "M19",
    "M40",
    "M25=7",
    "H5",
    "H6",
    "X[M7]",
    "Y[H5 H6]",
    "S1000",
    "S[M3 REV500]",
    "S2[M5]",
    "X[INDP G90 G01 FEED=2000 POS=5 M7]",
    "#EXPL SYN",
    "#FLUSH",
    "#FLUSH WAIT",
    "#CHANNEL SET [M_PRE_OUTPUT E=20 F=5000]",
    "#CHANNEL SET [M_PRE_OUTPUT E=50 VECTOR_LIMIT_OFF]",
    "#VECTOR LIMIT ON[VEL=500 ACC=200]",
    "#VECTOR LIMIT OFF",
    "G108",
    "G107",
    "M33",
    "V.G.RW = 2",
    "V.G.M_FCT[7].SYNCH = 8",
    "V.G.M_FCT[7].PRE_OUTP_PATH = 4",
    "V.G.M_FCT[8].PRE_OUTP_PATH = 0",
    "V.G.H_FCT[5].SYNCH = 16777216",
    "V.SPDL.M_FCT_FREE = 1",
    "P1=V.G.RW",
    "M30",
    "M17",
    "M99",
    "M26",
    "M27",
];

const LIST: &str = "m_synch[7] MOS\nm_synch[8] MVS_SNS\nm_pre_outp[8] 30000\nm_synch[9] MET_SVS\nm_pre_outp[9] 100000\n\
    m_synch[25] MVS_SVS\nm_synch[26] MVS_SLM\nm_synch[27] MVS_SLP\nm_synch[33] MNE_SNS\nh_synch[5] MNS_SNS\n\
    h_synch[6] MEP_MOS\nh_pre_outp[6] 80000\nm_synch[3] MVS_SVS\nm_synch[4] MOS\nm_synch[5] MOS\nm_synch[19] MOS\n\
    m_synch[40] MVS_SVS\nmain_spindle_gear_change 1\nspindel[0].bezeichnung S1\nspindel[0].m3_synch PLC_INFO | MVS_SVS\n\
    spindel[0].m4_synch MVS_SNS\nspindel[0].s_synch MOS\nspindel[1].bezeichnung S2\nspindel[1].plc_control 1\n";

const SCRIPTS: [&str; 7] = [
    "",
    "default ack 0.05\nprobe X7\n",
    "M7 nofetch\nspindle S1 ready 0.2\n",
    "default ack never\nreset 0.5\n",
    "probe X15\nhold 0.1..0.3\nbackward 0.4..0.9\noverride 20 at 0.2\n",
    "single 0..3\nstart 0.2\nstart 0.5\nstart 0.9\nbackward 1.0..1.5\ndefault ack 0.1\nreset 4\n",
    "simulated 0..1\nbackward 0.2..0.7\nspindle S1 ready never\n",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_program_ends(
        lines in prop::collection::vec(prop::collection::vec(0..WORDS.len(), 1..4), 1..12),
        script in 0..SCRIPTS.len(),
        joints in any::<bool>(),
        late in any::<bool>(),
    ) {
        let text = lines.iter().map(|line| {
            let words: Vec<_> = line.iter().map(|word| WORDS[*word]).collect();
            format!("{}\n", words.join(" "))
        });
        let program = format!("%ANY\nF3000\n{}M30\n", text.collect::<String>());
        let mut list = LIST.to_owned();
        if joints {
            list += "configuration.path_preparation.function FCT_DEFAULT | FCT_M_PRE_OUTPUT\n";
        }
        if late {
            list += "prog_start.late_sync_ready 1\n";
        }
        let report = Bench::new(&program, &list).and("%NEXT\nG01 X3 F1000 M7\nM30\n").script(SCRIPTS[script]).run();
        prop_assert!(!report.completed || report.error.is_none());
        prop_assert!(report.events.windows(2).all(|pair| pair[0].t <= pair[1].t), "{program}");
        let open = report.waits.iter().filter(|wait| wait.to_s.is_none()).count();
        prop_assert!(open == 0 || !report.completed, "{program} {:?}", report.waits);
        for event in report.of(EventKind::Output) {
            let position = event.position.0;
            prop_assert!(!position[bahn_path::Axis::X].is_nan(), "{program} {event:?}");
        }
        // The same again is the same.
        let again = Bench::new(&program, &list).and("%NEXT\nG01 X3 F1000 M7\nM30\n").script(SCRIPTS[script]).run();
        prop_assert!(again.events == report.events && again.time_s == report.time_s);
    }
}
