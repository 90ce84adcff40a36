//! Lists in all the spellings of the manual [004:57] [004:111-126] [004:162-174] [004:192-234].

use bahn_technology::{ChannelList, ChannelSettings, Synch, Synchronisation};

fn settings(text: &str) -> ChannelSettings {
    let list = ChannelList::from_bytes(text.as_bytes());
    assert_eq!(list.errors(), [], "{text}");
    list.settings().clone()
}

/// The kind of synchronisation of an M function.
fn m(settings: &ChannelSettings, number: u32) -> Synchronisation {
    settings.m.get(number).unwrap().synch.unwrap().kind
}

#[test]
fn values_with_remarks_and_elisions() {
    let read = settings(
        "# Types\n#======\nm_synch[0]   0x00000002   MVS_SVS\nm_synch[8] 0x00000008 MNS_SNS\n:\n\
         m_synch[96] 0x01000000 MEP_SVS\nm_pre_outp[96] 100000 in 0.1µm (10 mm)\n...\n\
         m_synch[97] MET_SVS 0x02000000\nm_pre_outp[97] 40000 in µs\n\
         m_pre_outp[100] 500 ;in 0.1 um\nm_synch[100] MOS_TS ; laser\n",
    );
    assert_eq!(m(&read, 0), Synchronisation::MvsSvs);
    assert_eq!(m(&read, 8), Synchronisation::MnsSns);
    assert_eq!(
        (m(&read, 96), read.m.get(96).unwrap().lead),
        (Synchronisation::MepSvs, 100_000)
    );
    assert_eq!(
        (m(&read, 97), read.m.get(97).unwrap().lead),
        (Synchronisation::MetSvs, 40_000)
    );
    assert_eq!(
        (m(&read, 100), read.m.get(100).unwrap().lead),
        (Synchronisation::MosTs, 500)
    );
}

/// The spindle of the parameter descriptions, in German and English by turns [004:210-213] [004:228].
#[test]
fn spindles_in_both_languages() {
    let read = settings(
        "spindel[0].bezeichnung S1\nspindle[0].log_achs_no 6\nspindel[0].s_synch MOS 0x00000001\n\
         spindel[0].m3_synch PLC_INFO | MVS_SVS 0x00020002\nspindle[0].m4_synch PLC_INFO|MVS_SNS 0x00020004\n\
         spindle[0].m19_synch MNS_SNS 0x00000008\nspindel[0].m5_prozess_zeit 1500000\n",
    );
    let spindle = &read.spindles[&0];
    assert_eq!((spindle.name(0).as_str(), spindle.log_axis), ("S1", Some(6)));
    assert_eq!(spindle.m3.synch, Synch::from_bits(0x2_0002).ok());
    assert_eq!(spindle.m4.synch, Synch::from_bits(0x2_0004).ok());
    assert_eq!(spindle.m5.synch, None);
    assert_eq!(spindle.m5.process_time_us, 1_500_000);
    assert_eq!(spindle.m19.synch, Some(Synchronisation::MnsSns.into()));
    for name in ["S", "s1"] {
        assert_eq!(
            read.spindle_called(name).map(|(index, _)| index),
            Some(0),
            "{name}"
        );
    }
    assert_eq!(read.spindle_called("S2"), None);
}

/// Lines of the axis list after `spindel[i].`, and without it, where they say nothing [004:162-171].
#[test]
fn lines_of_the_axis_list() {
    let read = settings(
        "spindel[0].kenngr.achstyp 0x00000004 # spindle\nspindel[0].achs_mode 0x00040000\n\
         spindel[0].antr_typ 0x4\nspindel[1].kenngr.achtstyp 0x4\nspindel[1].plc_control 1\n",
    );
    assert!(read.spindles[&0].plc_spindle && !read.spindles[&0].plc_control);
    assert!(!read.spindles[&1].plc_spindle && read.spindles[&1].plc_control);
    let alone = ChannelList::from_bytes(b"achs_mode 0x00040000\nkenngr.achtstyp 0x4\n");
    assert_eq!((alone.errors().len(), alone.warnings().len()), (0, 2));
    assert!(alone.settings().spindles.is_empty());
}

/// A spindle that is not the first may be the main one (public).
#[test]
fn the_main_spindle_is_named_by_its_axis() {
    let text = "spindel[0].bezeichnung S1\nspindel[0].log_achs_nr 6\nspindel[1].bezeichnung S2\n\
                spindel[1].log_achs_nr 11\n";
    assert_eq!(settings(text).main_spindle().map(|(index, _)| index), Some(0));
    let other = settings(&format!("{text}main_spindle_ax_nr 11\n"));
    assert_eq!(other.main_spindle().map(|(index, _)| index), Some(1));
    assert_eq!(other.spindle_called("S").map(|(index, _)| index), Some(1));
}

/// The forms of channel list and start-up list [004:111] [004:222-234].
#[test]
fn configuration_of_the_channel() {
    let enabled = "FCT_DEFAULT | FCT_M_PRE_OUTPUT";
    let read = settings(&format!(
        "configuration.channel[0].path_preparation.function {enabled}\nlate_sync_ready 1\n\
         configuration.channel[0].path_preparation.m_pre_output_lookahead 30\nm_h_pre_outp_nbr_block 100\n\
         configuration.channel[0].interpolator.parameter 100\npre_output_tolerance 10\n"
    ));
    assert!(read.micro_joint.enabled && read.late_sync_ready);
    assert_eq!((read.micro_joint.blocks, read.micro_joint.tolerance), (30, 10));
    assert_eq!(read.pre_output.blocks, 100);
    let other_way = settings(&format!(
        "configuration.path_preparation.fct_enable[0] {enabled}\n"
    ));
    assert!(other_way.micro_joint.enabled);
    for other in [
        "path_preparation.fct_enable[1]",
        "channel[1].path_preparation.function",
    ] {
        let list = ChannelList::from_bytes(format!("configuration.{other} {enabled}\n").as_bytes());
        assert!(!list.settings().micro_joint.enabled, "{other}");
        assert_eq!((list.errors().len(), list.warnings().len()), (0, 1), "{other}");
    }
}

/// Of two lines for the same the later one counts, and is reported.
#[test]
fn the_later_line_counts() {
    let list = ChannelList::from_bytes(
        b"m_synch[5] MOS\n\nspindel[0].m3_sync 2\nm_synch[5] 2\nspindle[0].m3_synch 4\n",
    );
    let warnings = list.warnings().iter();
    let reported: Vec<(u32, &str)> = warnings
        .map(|fault| (fault.span.line, fault.message.as_str()))
        .collect();
    assert_eq!(
        reported,
        [
            (4, "m_synch[5] stands in line 1, too: this line counts"),
            (5, "spindel[0].m3_synch stands in line 3, too: this line counts"),
        ]
    );
    assert_eq!(m(list.settings(), 5), Synchronisation::MvsSvs);
}

/// Other ends of lines and other bytes than UTF-8.
#[test]
fn lists_of_other_systems() {
    let list = ChannelList::from_bytes(b"\xEF\xBB\xBFm_synch[1] 2\r\nm_pre_outp[1] 5 in \xB5m\r\n");
    assert_eq!((list.errors().len(), list.entries()), (0, 2));
    let latin = ChannelList::from_bytes(b"m_pre_outp[1] 5 in \xB5m\r\n\xB5m_xx[\xB5] 1\r\n");
    assert_eq!(
        (latin.errors().len(), latin.settings().m.get(1).unwrap().lead),
        (1, 5)
    );
    assert_eq!(
        (latin.errors()[0].span.line, latin.errors()[0].span.column),
        (2, 7)
    );
}

/// Every fault stands at its line and column, and does not keep the others from being found.
#[test]
fn faults_have_their_places() {
    let list = ChannelList::from_bytes(
        b"m_synch[5] MVS_SVX\n  h_synch[3] MVS_SLM\nm_synch[1000] MOS\nm_synk[4] 1\nm_pre_outp[4] 12,5\n\
          m_synch[7]   0x6 ; two\nspindel[0].m3_synch 0x01000000\nm_h_pre_outp_nbr_block 20\nm_synch[9]\n\
          m_synch[40] MOS\nmain_spindle_gear_change 1\n",
    );
    let errors = list.errors().iter();
    let places: Vec<(u32, u32)> = errors.map(|fault| (fault.span.line, fault.span.column)).collect();
    let expected = [
        (1, 12),
        (2, 14),
        (3, 9),
        (4, 1),
        (5, 15),
        (6, 14),
        (7, 21),
        (8, 24),
        (9, 11),
        (10, 13),
    ];
    assert_eq!(places, expected);
}
