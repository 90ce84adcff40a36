use bahn_plc::InterfaceUser;

use crate::desk::{Desk, done, failed, value};

const RS232: i32 = 0;
const RS422: i32 = 1;

/// The PLC has RS-422, and the other side is ready.
fn assigned() -> Desk {
    let mut desk = Desk::new();
    desk.parameter("5040=7");
    assert_eq!(desk.submit(9100, &[RS422, 0], 0), done());
    desk.nc.interfaces[1].ready = true;
    desk
}

fn receive(desk: &mut Desk, text: &[u8]) {
    desk.nc.interfaces[1].receive = text.to_vec();
    desk.nc.interfaces[1].received = true;
}

#[test]
fn m9100_assigns() {
    let mut desk = Desk::new();
    desk.parameter("5040=9");
    desk.nc.interfaces[0].transmit_error = true;
    assert_eq!(desk.submit(9100, &[RS232, 0], 0), done());
    let interface = &desk.nc.interfaces[0];
    assert_eq!(
        (interface.user, interface.baud),
        (Some(InterfaceUser::Plc), 38_400)
    );
    assert!(interface.receiving && !interface.transmit_error);
    // 19 200 and 38 400 exclude each other.
    desk.nc.interfaces[1].mode_baud = 19_200;
    assert_eq!(desk.submit(9100, &[RS422, 1], 0), failed());
    desk.nc.interfaces[1].mode_baud = 9600;
    assert_eq!(desk.submit(9100, &[RS422, 1], 0), done());
    assert_eq!(desk.nc.interfaces[1].baud, 9600);
    assert_eq!(desk.cyclic(9100, &[RS232, 0], 0), failed());
    for wrong in [[2, 0], [-1, 0], [0, 2], [0, -1]] {
        assert_eq!(desk.submit(9100, &wrong, 0), failed(), "{wrong:?}");
    }
    desk.nc.interfaces[0].user = Some(InterfaceUser::Nc);
    assert_eq!(desk.submit(9100, &[RS232, 0], 0), failed());
}

/// The operator transfers at 38 400 baud: the PLC gets no other interface at 19 200 [000:15617].
#[test]
fn m9100_and_the_rate_of_the_operator() {
    let mut desk = Desk::new();
    desk.parameter("5040=8");
    desk.nc.interfaces[0].mode_baud = 38_400;
    desk.nc.interfaces[0].assign_to_nc();
    assert_eq!(desk.submit(9100, &[RS422, 0], 0), failed());
    desk.nc.interfaces[0].mode_baud = 9600;
    desk.nc.interfaces[0].assign_to_nc();
    assert_eq!(desk.submit(9100, &[RS422, 0], 0), done());
}

/// MP5000 inhibits one of both [000:16984-16989].
#[test]
fn m9100_finds_an_inhibited_interface() {
    for (mp5000, free) in [
        (0, [done(), done()]),
        (1, [failed(), done()]),
        (2, [done(), failed()]),
    ] {
        let mut desk = Desk::new();
        desk.parameter("5040=7").parameter(&format!("5000={mp5000}"));
        for (interface, answer) in [RS232, RS422].into_iter().zip(free) {
            assert_eq!(desk.submit(9100, &[interface, 0], 0), answer, "MP5000 = {mp5000}");
        }
    }
}

#[test]
fn m9101_releases() {
    let mut desk = assigned();
    assert_eq!(desk.cyclic(9101, &[RS422], 0), failed());
    assert_eq!(desk.submit(9101, &[RS232], 0), failed(), "not the PLC's");
    assert_eq!(desk.submit(9101, &[2], 0), failed());
    assert_eq!(desk.submit(9101, &[RS422], 0), done());
    assert_eq!(desk.nc.interfaces[1].user, None);
    assert!(!desk.nc.interfaces[1].receiving);
}

#[test]
fn m9102_tells_the_status() {
    let mut desk = assigned();
    // Assigned, to the PLC, ready, transmit buffer empty.
    assert_eq!(desk.cyclic(9102, &[RS422], 1), value(0b0000_1111));
    let interface = &mut desk.nc.interfaces[1];
    interface.transmit = b"X".to_vec();
    interface.transmit_error = true;
    interface.received = true;
    interface.receive_error = true;
    interface.end_of_text = true;
    assert_eq!(desk.submit(9102, &[RS422], 1), value(0b1111_0111));
    desk.nc.interfaces[0].user = Some(InterfaceUser::Nc);
    assert_eq!(desk.cyclic(9102, &[RS232], 1), value(0b0000_1001));
    // What was ready when the PLC gave it back stays so until somebody has it again [000:15665].
    for ready in [true, false] {
        let mut desk = assigned();
        desk.nc.interfaces[1].ready = ready;
        assert_eq!(desk.submit(9101, &[RS422], 0), done());
        desk.nc.interfaces[1].ready = !ready;
        let released = 0b0000_1000 | i32::from(ready) << 2;
        assert_eq!(desk.cyclic(9102, &[RS422], 1), value(released));
        assert_eq!(desk.submit(9100, &[RS422, 0], 0), done());
        let again = 0b0000_1011 | i32::from(!ready) << 2;
        assert_eq!(desk.cyclic(9102, &[RS422], 1), value(again));
    }
    for wrong in [-1, 2] {
        assert_eq!(desk.cyclic(9102, &[wrong], 1), (vec![0], true));
    }
}

#[test]
fn m9103_transmits_a_string() {
    let mut desk = assigned();
    desk.nc.dialogues = vec!["X".repeat(126), "READY".to_owned()];
    desk.set_text(0, b"NC \x1aD001")
        .set_text(1, b"A\x1aD000")
        .set_text(2, b"AB\x1aD000");
    assert_eq!(desk.submit(9103, &[RS422, 0], 0), done());
    assert_eq!(desk.nc.interfaces[1].transmit, b"NC READY");
    assert_eq!(
        desk.submit(9103, &[RS422, 0], 0),
        failed(),
        "the buffer is not empty"
    );
    desk.nc.interfaces[1].transmit.clear();
    assert_eq!(desk.submit(9103, &[RS422, 2], 0), failed(), "128 characters");
    assert_eq!(desk.submit(9103, &[RS422, 1], 0), done(), "127 characters");
    desk.nc.interfaces[1].transmit.clear();
    assert_eq!(desk.cyclic(9103, &[RS422, 0], 0), failed());
    for wrong in [[RS232, 0], [2, 0], [RS422, 4], [RS422, -1]] {
        assert_eq!(desk.submit(9103, &wrong, 0), failed(), "{wrong:?}");
    }
    desk.nc.interfaces[1].ready = false;
    assert_eq!(desk.submit(9103, &[RS422, 0], 0), failed());
    assert!(desk.nc.interfaces[1].transmit_error);
}

#[test]
fn m9104_receives_a_string() {
    let mut desk = assigned();
    assert_eq!(desk.submit(9104, &[RS422, 2], 0), failed(), "nothing came");
    desk.nc.interfaces[1].receive = b"HAL".to_vec();
    assert_eq!(desk.submit(9104, &[RS422, 2], 0), failed(), "not complete");
    receive(&mut desk, b"HALLO");
    assert_eq!(desk.cyclic(9104, &[RS422, 2], 0), failed());
    for wrong in [[RS232, 0], [2, 0], [RS422, 4]] {
        assert_eq!(desk.submit(9104, &wrong, 0), failed(), "{wrong:?}");
    }
    assert_eq!(desk.submit(9104, &[RS422, 2], 0), done());
    assert_eq!(desk.text(2), "HALLO");
    assert_eq!(
        desk.submit(9104, &[RS422, 2], 0),
        failed(),
        "the buffer was cleared"
    );
    receive(&mut desk, &[b'X'; 128]);
    assert_eq!(desk.submit(9104, &[RS422, 2], 0), failed());
}

/// The manual's example: B126 = FAh, B127 = 81h [000:15599-15603].
#[test]
fn m9105_transmits_bytes() {
    let mut desk = assigned();
    desk.set("B126", 0xfa - 0x100).set("B127", 0x81 - 0x100);
    assert_eq!(desk.submit(9105, &[RS422, 126, 2], 0), done());
    assert_eq!(desk.nc.interfaces[1].transmit, b"FA81");
    assert_eq!(
        desk.submit(9105, &[RS422, 126, 2], 0),
        failed(),
        "the buffer is not empty"
    );
    desk.nc.interfaces[1].transmit.clear();
    assert_eq!(desk.cyclic(9105, &[RS422, 126, 2], 0), failed());
    for wrong in [
        [RS232, 0, 1],
        [2, 0, 1],
        [RS422, -1, 1],
        [RS422, 1024, 0],
        [RS422, 1023, 2],
        [RS422, 0, 64],
        [RS422, 0, -1],
    ] {
        assert_eq!(desk.submit(9105, &wrong, 0), failed(), "{wrong:?}");
    }
    assert_eq!(
        desk.submit(9105, &[RS422, 961, 63], 0),
        done(),
        "the last 63 bytes"
    );
}

#[test]
fn m9106_receives_bytes() {
    let mut desk = assigned();
    assert_eq!(desk.submit(9106, &[RS422, 0], 1), (vec![0], true), "nothing came");
    receive(&mut desk, b"FA81");
    for wrong in [[RS232, 0], [2, 0], [RS422, -1], [RS422, 1024], [RS422, 1023]] {
        assert_eq!(desk.submit(9106, &wrong, 1), (vec![0], true), "{wrong:?}");
    }
    assert_eq!(desk.cyclic(9106, &[RS422, 200], 1), (vec![0], true));
    assert_eq!(desk.submit(9106, &[RS422, 200], 1), value(2));
    assert_eq!((desk.get("B200"), desk.get("B201")), (0xfa - 0x100, 0x81 - 0x100));
    assert_eq!(
        desk.submit(9106, &[RS422, 200], 1),
        (vec![0], true),
        "the buffer was cleared"
    );
    for text in [b"FA8".as_slice(), b"XY", &[b'1'; 130]] {
        receive(&mut desk, text);
        assert_eq!(desk.submit(9106, &[RS422, 200], 1), (vec![0], true));
    }
}

#[test]
fn m9107_reads_one_byte() {
    let mut desk = assigned();
    assert_eq!(desk.submit(9107, &[RS422, 0], 1), (vec![0], true), "nothing came");
    receive(&mut desk, b"FA81XX");
    assert_eq!(desk.submit(9107, &[RS422, 0], 1), value(0xfa));
    assert_eq!(desk.submit(9107, &[RS422, 1], 1), value(0x81));
    assert_eq!(
        desk.submit(9107, &[RS422, 2], 1),
        (vec![0], true),
        "not hexadecimal"
    );
    assert_eq!(
        desk.submit(9107, &[RS422, 63], 1),
        value(0),
        "after the text: no error"
    );
    for wrong in [[RS232, 0], [2, 0], [RS422, 64], [RS422, -1]] {
        assert_eq!(desk.submit(9107, &wrong, 1), (vec![0], true), "{wrong:?}");
    }
    assert_eq!(desk.cyclic(9107, &[RS422, 0], 1), (vec![0], true));
    assert_eq!(desk.submit(9104, &[RS422, 0], 0), done(), "the buffer is kept");
    assert_eq!(desk.text(0), "FA81XX");
}
