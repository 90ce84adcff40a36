//! Conversations.

use super::*;

#[test]
fn logins_say_what_is_allowed() {
    let mut passwords = Passwords::default();
    passwords.set("dnc=steel").unwrap();
    let desk = Desk::named("logins", "BAHN TNC 415", passwords);
    let mut session = desk.session();
    converse(
        &mut session,
        &[
            // Without any login, and with another one.
            (b"R_VR", b"T_ER\x01\x31"),
            (b"A_LO", b"T_ER\x01\x31"),
            (b"C_ZZ", b"T_ER\x01\x16"),
            (b"A_LGINSPECT\0", b"T_OK"),
            (
                b"R_VR",
                b"S_VRBAHN TNC 415\x00123456 07\0MAIN.PLC\0%0000000000000000\0",
            ),
            (b"R_VR\x02", b"S_VR123456 07\0"),
            (b"R_VR\x05", b"S_VRBahn\0"),
            (b"R_VR\x06", b"T_ER\x01\x18"),
            (b"R_DR", b"T_ER\x01\x17"),
            (b"R_RI\x00\x17", b"T_ER\x01\x17"),
            // Passwords.
            (b"A_LGDNC\0", b"T_ER\x01\x1e"),
            (b"A_LGDNC\0steal\0", b"T_ER\x01\x1e"),
            (b"A_LGDNC\0steel\0", b"T_OK"),
            (b"R_RI\x00\x17", b"S_RI\x00\x03"),
            (b"A_LGFILEPLC\0", b"T_ER\x01\x1e"),
            (b"A_LGFILEPLC\x00807667\0", b"T_OK"),
            (b"A_LGKITCHEN\0", b"T_ER\x01\x18"),
            (b"A_LG", b"T_ER\x01\x14"),
            // A logout takes one login, or all.
            (b"A_LODNC\0", b"T_OK"),
            (b"R_RI\x00\x17", b"T_ER\x01\x17"),
            (b"A_LO", b"T_OK"),
            (b"R_VR", b"T_ER\x01\x31"),
        ],
    );
    // The PLC gets a signal when somebody takes its messages, and when nobody does any more.
    assert_eq!(desk.device.take_calls(), ["host true", "host false"]);
    let one = logged_in(&desk, &[Level::Inspect]);
    assert!(
        one.is_logged_in() && !session.is_logged_in(),
        "rights belong to one connection"
    );
    assert_eq!((session.wrong_passwords(), session.is_over()), (3, false));
    for _ in 0..2 {
        converse(&mut session, &[(b"A_LGDNC\0steal\0", b"T_ER\x01\x1e")]);
    }
    assert!(session.is_over());
}

#[test]
fn the_run_is_reported() {
    let desk = Desk::new("run");
    let mut session = logged_in(&desk, &[Level::Dnc, Level::Inspect]);
    let tool = [
        b"S_RI\0\0\0\x07\0\0\0\x02".as_slice(),
        &80.5_f64.to_le_bytes(),
        &4.0_f64.to_le_bytes(),
    ]
    .concat();
    converse(
        &mut session,
        &[
            (b"R_RI\x00\x16", b"S_RI\x00\x0212.5000\0-0.0003\0X\0C\0"),
            (b"R_RI\x00\x17", b"S_RI\x00\x03"),
            (b"R_RI\x00\x18", b"S_RI\0\0\0\x0cTNC:\\MAIN.H\0TNC:\\SUB.H\0"),
            (b"R_RI\x00\x19", b"S_RI\0\0\x1f\x40\0\0\x2b\xf2\0\0\x1f\x40"),
            (b"R_RI\x00\x1a", b"S_RI\x00\x01"),
            (b"R_RI\x00\x1b", b"S_RI\0\x02\0\0\0\0\0\x03POWER INTERRUPTED\0"),
            (b"R_RI\x00\x1c", b"S_RI\0\x02\0\0\0\0\0\x09PROTECTED PGM\0"),
            (b"R_RI\x00\x1c", b"T_ER\x01\x39"),
            (b"R_RI\x00\x33", &tool),
            (b"R_RI\x01\x00", b"T_ER\x01\x18"),
            (b"R_RI\x00", b"T_ER\x01\x14"),
            (b"R_CI\0\0\0\x01", b"S_CI\0\0\0\x01\0\0\0\0"),
            (b"R_CI\0\0\0\x02", b"S_CI\0\0\0\x01\0\0\0\x01"),
            (b"R_CI\0\0\0\x03", b"T_ER\x01\x18"),
            (b"R_ST", b"S_ST\0\0\0\0\0\0\0\0\0\0\0\0"),
            (b"C_ST\x01\x02\x03", b"T_OK"),
            (b"R_ST", b"S_ST\x01\x02\x03\0\0\0\0\0\0\0\0\0"),
        ],
    );
}

#[test]
fn memory_lies_where_the_system_parameters_say() {
    let desk = Desk::new("memory");
    let mut session = logged_in(&desk, &[Level::PlcDebug, Level::Data]);
    let parameters = session.take(&Telegram::new(Command(*b"R_PR"))).unwrap();
    assert_eq!(
        (parameters.command, parameters.data.len()),
        (Command(*b"S_PR"), 120)
    );
    let long = |place: usize| {
        let bytes = parameters.data[4 * place..4 * place + 4].try_into().unwrap();
        u32::from_be_bytes(bytes)
    };
    let [markers, words, strings] = [long(0), long(10), long(12)];
    assert_eq!([long(1), long(11), long(13)], [3264, 512, 4]);
    let input_words = u32::from_be_bytes(parameters.data[64..68].try_into().unwrap());
    assert_eq!(parameters.data[98..100], 4096_u16.to_be_bytes());
    let mut read = |address: u32, count: u8| {
        let request = Telegram::new(Command(*b"R_MB")).long(address).byte(count);
        let answer = session.take(&request).unwrap();
        ErrorNumber::of(&answer).map_or(Ok(answer.data), Err)
    };
    // Each third marker is set, byte n is n.
    assert_eq!(read(markers + 3, 4), Ok(vec![1, 0, 0, 1]));
    assert_eq!(read(words + 8, 1), Ok(vec![8]));
    // W8 is 0809 hexadecimal here, D8 08090a0b; the lowest byte comes first.
    assert_eq!(read(words + 8, 2), Ok(0x0809_u16.to_le_bytes().to_vec()));
    assert_eq!(read(words + 8, 4), Ok(0x0809_0a0b_u32.to_le_bytes().to_vec()));
    assert_eq!(read(words + 8, 6), Ok(vec![9, 8, 11, 10, 13, 12]));
    assert_eq!(read(words + 9, 2), Ok(vec![9, 10]));
    assert_eq!(read(strings + 128, 128).unwrap()[..9], *b"STRING 1\0");
    assert_eq!(read(strings + 128 + 7, 1), Ok(vec![b'1']));
    // I0, I3, I6, I9, I12 and I15 are set.
    assert_eq!(
        read(input_words, 2),
        Ok(0b1001_0010_0100_1001_u16.to_le_bytes().to_vec())
    );
    for (address, count) in [
        (markers + 3264, 1),
        (words + 1023, 2),
        (strings + 512, 1),
        (0x7fff_ffff, 1),
        (u32::MAX, 255),
    ] {
        assert_eq!(read(address, count), Err(ErrorNumber::BAD_ADDRESS), "{address:x}");
    }
    converse(
        &mut session,
        &[
            (b"R_DP\0\0\0\0\\PLC\\memory\\W\\8\0", b"S_DP\0\0\0\x02\x08\x09"),
            (
                b"R_DP\0\0\0\0\\PLC\\memory\\D\\8\0",
                b"S_DP\0\0\0\x03\x08\x09\x0a\x0b",
            ),
            (b"R_DP\0\0\0\0\\PLC\\memory\\M\\3\0", b"S_DP\0\0\0\x0b\x01"),
            (b"R_DP\0\0\0\0\\PLC\\memory\\B\\8\0", b"S_DP\0\0\0\x10\x08"),
            (b"R_DP\0\0\0\0\\PLC\\memory\\S\\1\0", b"S_DP\0\0\0\x08STRING 1\0"),
            (b"R_DP\0\0\0\0\\PLC\\memory\\K\\1\0", b"S_DP\0\0\0\x03\0\0\0\x01"),
            (b"R_DP\0\0\0\0\\PLC\\memory\\W\\9\0", b"T_ER\x01\x34"),
            (
                b"R_DP\0\0\0\0\\TABLE\\TOOL\\T\\1\\L\0",
                &[b"S_DP\0\0\0\x05".as_slice(), &80.5_f64.to_le_bytes()].concat(),
            ),
            (
                b"R_DP\0\0\0\0\\TABLE\\TOOL\\T\\1\\name\0",
                b"S_DP\0\0\0\x08END MILL\0",
            ),
            (b"R_DP\0\0\0\0\\TABLE\\TOOL\\T\\9\\L\0", b"T_ER\x01\x18"),
            (b"R_DP\0\0\0\0\\NC\\kitchen\0", b"T_ER\x01\x18"),
        ],
    );
}

#[test]
fn parameters_keys_and_messages() {
    let desk = Desk::new("keys");
    let mut session = logged_in(
        &desk,
        &[Level::PlcDebug, Level::Monitor, Level::Diagnostics, Level::Dnc],
    );
    converse(
        &mut session,
        &[
            (b"R_MC7230\0", b"S_MC1\0"),
            (b"R_MC7230.0\0", b"S_MC1\0"),
            (b"R_MPMP1010.2\0", b"S_MP3000\0"),
            (b"R_MC1010.9\0", b"T_ER\x01\x28"),
            (b"R_MCCfgKitchen\0", b"T_ER\x01\x28"),
            (b"C_MC\0\0\0\x017230.0\x000\0", b"T_OK"),
            (b"C_MC\0\0\0\x007230\x000\0", b"T_OK"),
            (b"C_MC\0\0\0\x00", b"T_ER\x01\x14"),
            (b"C_LK\x01", b"T_OK"),
            (b"C_EK\x01\xc0", b"T_OK"),
            (b"C_EK\x00\x35", b"T_OK"),
            (b"C_EK\x00\x62", b"T_OK"),
            (b"C_EK\x41\x50", b"T_OK"),
            (b"C_EK\x01\xff", b"T_ER\x01\x27"),
            (b"C_LK\x02", b"T_ER\x01\x18"),
            (b"M_PC\xff\xff\xff\xfe", b"T_OK"),
            (b"X_PCABC\0\0", b"X_OK"),
            (b"R_LB", b"S_LB\0\0\x03\xe8\0\x01POWER INTERRUPTED\0"),
            (b"T_OK", b"S_LB\0\0\x03\xe9\0\0CE\0"),
            (b"T_OK", b"T_FD"),
            (b"T_OK", b"T_ER\x01\x15"),
        ],
    );
    // While one connection has locked the keys no other one presses any.
    let mut other = logged_in(&desk, &[Level::Monitor]);
    let refused: &[(&[u8], &[u8])] = &[(b"C_EK\x01\xae", b"T_ER\x01\x27"), (b"C_LK\x00", b"T_ER\x01\x27")];
    converse(&mut other, refused);
    drop(session);
    converse(&mut other, &[(b"C_EK\x01\xae", b"T_OK")]);
    assert_eq!(
        desk.device.take_calls(),
        [
            "host true",
            "MP7230.0=0 false",
            "MP7230.0=0 true",
            "key MANUAL",
            "key 5",
            "key b",
            "key A",
            "message Double(-2)",
            "message Text([65, 66, 67])",
            "host false",
            "key CE",
        ]
    );
}

#[test]
fn a_message_of_the_plc_reads_back_as_itself() {
    let desk = Desk::new("messages");
    let mut session = logged_in(&desk, &[Level::Dnc]);
    desk.device.take_calls();
    let texts: [&[u8]; 4] = [b"", b"ABC", b"ABCD", b"A LONG MESSAGE"];
    for message in [PlcMessage::Double(-2), PlcMessage::Double(0x4142_4300)]
        .into_iter()
        .chain(texts.map(|text| PlcMessage::Text(text.to_vec())))
    {
        let telegram = super::super::machine_commands::from_plc(&message);
        session.take(&telegram);
        assert_eq!(desk.device.take_calls(), [format!("message {message:?}")]);
    }
}

#[test]
fn files_travel_block_by_block() {
    let desk = Desk::new("files");
    let mut session = logged_in(&desk, &[Level::File]);
    converse(
        &mut session,
        &[
            (b"C_FL1.H\0\x00", b"T_OK"),
            (b"S_FL0 BEGIN PGM 1 MM\x001 END", b"T_OK"),
            (b"S_FL PGM 1 MM\0", b"T_OK"),
            // Without command 19 the end is not answered.
            (b"T_FD", b""),
            (b"R_FL1.h\0", b"S_FL0 BEGIN PGM 1 MM\x001 END PGM 1 MM\0"),
            (b"T_OK", b"T_FD"),
            (b"R_FL1.h\0\x01", b"S_FL0 BEGIN PGM 1 MM\n1 END PGM 1 MM\n"),
            (b"T_OK", b"T_FD"),
            (b"C_CC\x00\x13", b"T_OK"),
            (b"C_FL2.BIN\0\x01", b"T_OK"),
            (b"S_FL\0\r\n\x10", b"T_OK"),
        ],
    );
    assert_eq!(
        std::fs::read(desk.file("1.H")).unwrap(),
        b"0 BEGIN PGM 1 MM\n1 END PGM 1 MM\n"
    );
    assert!(!desk.file("2.BIN").exists(), "it has its name with T_FD");
    converse(
        &mut session,
        &[(b"T_FD", b"T_OK"), (b"R_FL2.BIN\0\x01", b"S_FL\0\r\n\x10")],
    );
    assert_eq!(std::fs::read(desk.file("2.BIN")).unwrap(), b"\0\r\n\x10");
    converse(
        &mut session,
        &[
            (b"T_ER\x01\x19", b""),
            (b"T_OK", b"T_ER\x01\x15"),
            (b"C_FL3.H\0", b"T_OK"),
            (b"S_FLhalf", b"T_OK"),
            (b"C_FD2.BIN\0", b"T_OK"),
            (b"S_FLmore", b"T_ER\x01\x15"),
            (b"T_FD", b"T_ER\x01\x15"),
            (b"C_FL1.H\0\x03", b"T_ER\x01\x18"),
            (b"C_FL..\\X.H\0", b"T_ER\x01\x1f"),
            (b"R_FLNONE.H\0", b"T_ER\x01\x20"),
        ],
    );
    assert_eq!(desk.on_medium(), ["1.H"], "what was broken off is gone");
}

#[test]
fn lines_end_alike_however_blocks_are_cut() {
    let desk = Desk::new("lines");
    // One byte is left in the first block: the end of its last line is cut there.
    let text = format!("{}\r\n\r\nB\nC\rD", "A".repeat(245));
    std::fs::write(desk.file("T.A"), &text).unwrap();
    std::fs::write(desk.file("E.A"), "").unwrap();
    let mut session = logged_in(&desk, &[Level::File]);
    let expected = format!("{}\0\0B\0C\0D", "A".repeat(245));
    let (first, rest) = expected.as_bytes().split_at(246);
    converse(
        &mut session,
        &[
            (b"R_FLT.A\0", &[b"S_FL", first].concat()),
            (b"T_OK", &[b"S_FL", rest].concat()),
            (b"T_OK", b"T_FD"),
            (b"R_FLE.A\0", b"S_FL"),
            (b"T_OK", b"T_FD"),
        ],
    );
}

/// Clients of today expect that an iTNC 530 removes a folder in which they are, and no other control (public); a path may
/// end in a doubled backslash.
#[test]
fn a_folder_in_which_somebody_is_goes_by_what_the_control_is() {
    for (identity, removed) in [
        ("iTNC530", b"T_OK".as_slice()),
        ("BAHN TNC 415 B", b"T_ER\x01\x36"),
    ] {
        let desk = Desk::named("own-folder", identity, Passwords::default());
        let mut session = logged_in(&desk, &[Level::File]);
        converse(
            &mut session,
            &[
                (b"C_DMTNC:\\PARTS\\\\\0", b"T_OK"),
                (b"C_DMTNC:\\PARTS\\\\T1\0", b"T_OK"),
                (b"C_DCTNC:\\parts\\t1\\\0", b"T_OK"),
                (b"C_DDTNC:\\PARTS\\T1\0", removed),
                (b"C_DCTNC:\\\0", b"T_OK"),
            ],
        );
    }
}

#[test]
fn folders_files_and_attributes() {
    let desk = Desk::named("folders", "iTNC530", Passwords::default());
    let mut session = logged_in(&desk, &[Level::File]);
    let name = |telegram: &Telegram| {
        let mut fields = telegram.fields();
        let (size, _, bits) = (fields.long().unwrap(), fields.long(), fields.long().unwrap());
        (size, bits, fields.string().unwrap())
    };
    converse(
        &mut session,
        &[
            (b"C_DMPARTS\\\0", b"T_OK"),
            (b"C_DMPARTS\0", b"T_ER\x01\x22"),
            (b"C_DCTNC:\\parts\0", b"T_OK"),
            (b"C_DCNONE\0", b"T_ER\x01\x37"),
            (b"C_DC\0", b"T_OK"),
            (b"R_DR\0", b"T_FD"),
            (b"C_FLA.H\0", b"T_OK"),
            (b"S_FLabc", b"T_OK"),
            (b"T_FD", b""),
            (b"C_FCA.H\0TNC:\\B.H\0", b"T_OK"),
            (b"C_FCA.H\0TNC:\\B.H\0", b"T_ER\x01\x22"),
            (b"C_FRA.H\0C.H\0", b"T_OK"),
            (b"C_FRA.H\0D.H\0", b"T_ER\x01\x20"),
            (b"C_FA\0\0\0\x20C.H\0", b"T_OK"),
            (b"C_FDC.H\0", b"T_ER\x01\x24"),
            (b"C_FRC.H\0D.H\0", b"T_ER\x01\x30"),
            (b"C_FLC.H\0", b"T_ER\x01\x25"),
            (b"C_DDTNC:\\PARTS\0", b"T_ER\x01\x36"),
            (b"C_DCPLC:\\\0", b"T_ER\x01\x17"),
        ],
    );
    let info = session
        .take(&Telegram::new(Command(*b"R_FI")).string("c.h"))
        .unwrap();
    // Shown and protected, not changeable.
    assert_eq!(name(&info), (3, 0x21, "c.h".to_owned()));
    let folder = session.take(&Telegram::new(Command(*b"R_DI"))).unwrap();
    assert_eq!(folder.data[164..], *b"TNC:\\parts\\\0");
    let drives = session.take(&Telegram::new(Command(*b"R_DR")).byte(2)).unwrap();
    assert_eq!(
        (drives.data.len(), &drives.data[12..17], &drives.data[29..]),
        (34, b"TNC:\0".as_slice(), b"PLC:\0".as_slice())
    );
    converse(
        &mut session,
        &[
            (b"T_OK", b"T_FD"),
            (b"C_FA\0\0\0\0C.H\0", b"T_OK"),
            (b"C_FDC.H\0", b"T_OK"),
            (b"C_DDTNC:\\PARTS\0", b"T_OK"),
        ],
    );
    // Who was in the folder is in the one above.
    let listed = session.take(&Telegram::new(Command(*b"R_DR")).byte(0)).unwrap();
    assert_eq!(name(&listed), (3, 0x03, "B.H".to_owned()));
    let many = session.take(&Telegram::new(Command(*b"R_DR")).byte(1)).unwrap();
    assert_eq!(many.data.len(), 16);
    assert_eq!(desk.device.take_calls().len(), 8, "each change is reported once");
}

#[test]
fn the_screen_goes_by_way_of_a_file() {
    let desk = Desk::new("screen");
    let mut session = logged_in(&desk, &[Level::Monitor]);
    converse(&mut session, &[(b"C_CC\x00\x0cTNC:\\S.BMP\0", b"T_ER\x01\x17")]);
    let mut session = logged_in(&desk, &[Level::File]);
    converse(
        &mut session,
        &[
            (b"C_CC\x00\x0cTNC:\\S.BMP\0", b"T_OK"),
            (b"R_FLS.BMP\0\x01", b"S_FLBM the screen"),
            (b"T_OK", b"T_FD"),
            (b"C_CC\x00\x0cTNC:\\..\\S.BMP\0", b"T_ER\x01\x1f"),
            (b"C_CC\x00\x01", b"T_ER\x01\x18"),
            (b"C_CC\x00\x04", b"T_OK"),
        ],
    );
}
