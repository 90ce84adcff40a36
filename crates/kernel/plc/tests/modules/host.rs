use bahn_plc::{HostLink, HostMessage};

use crate::desk::{Desk, code};

#[test]
fn m9110_sends() {
    let mut desk = Desk::new();
    desk.set("D100", -7).set_text(2, b"PART 5");
    assert_eq!(desk.cyclic(9110, &[0, 100], 1), code(1), "no connection");
    desk.nc.host = Some(HostLink::default());
    assert_eq!(desk.cyclic(9110, &[0, 100], 1), code(0));
    assert_eq!(desk.submit(9110, &[1, 2], 1), code(0));
    let sent = desk.nc.host.as_ref().unwrap().outgoing.clone();
    assert_eq!(
        sent,
        [HostMessage::Double(-7), HostMessage::Text(b"PART 5".to_vec())]
    );
    assert_eq!(desk.cyclic(9110, &[2, 0], 1), code(3));
    for wrong in [[0, 102], [0, 1024], [0, -4], [1, 4], [1, -1]] {
        assert_eq!(desk.cyclic(9110, &wrong, 1), code(4), "{wrong:?}");
    }
    for _ in sent.len()..HostLink::CAPACITY {
        assert_eq!(desk.cyclic(9110, &[0, 100], 1), code(0));
    }
    assert_eq!(desk.cyclic(9110, &[0, 100], 1), code(2), "buffer full");
}

#[test]
fn m9111_receives_by_type() {
    let mut desk = Desk::new();
    assert_eq!(desk.cyclic(9111, &[0, 100], 1), code(1));
    let mut host = HostLink::default();
    host.incoming.push_back(HostMessage::Text(b"GO".to_vec()));
    host.incoming.push_back(HostMessage::Double(100_000));
    desk.nc.host = Some(host);
    assert_eq!(desk.cyclic(9111, &[0, 1020], 1), code(0));
    assert_eq!(desk.get("D1020"), 100_000);
    assert_eq!(desk.cyclic(9111, &[0, 1020], 1), code(2), "no other doubleword");
    assert_eq!(desk.cyclic(9111, &[1, 3], 1), code(0));
    assert_eq!(desk.text(3), "GO");
    assert_eq!(desk.cyclic(9111, &[1, 3], 1), code(2));
    assert_eq!(desk.cyclic(9111, &[-1, 0], 1), code(3));
    for wrong in [[0, 101], [0, 1024], [1, 4]] {
        assert_eq!(desk.cyclic(9111, &wrong, 1), code(4), "{wrong:?}");
    }
}
