//! Any bytes on a TCP connection and on a serial line of LSV/2: telegrams are answered, nothing outside the folder is
//! touched, and behind a pause the line answers again.
//!
//! ```text
//! cargo +nightly fuzz run read_lsv2
//! ```

#![no_main]

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use bahn_fuzz as _;
use bahn_link::lsv2::{DATA_MAX, Device, Passwords, SerialServer, Session, Site, StillDevice, TcpReader};
use libfuzzer_sys::fuzz_target;

/// One device for all inputs; what they write stays in its folder.
fn site() -> &'static Arc<Site> {
    static SITE: OnceLock<Arc<Site>> = OnceLock::new();
    SITE.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("bahn-fuzz-lsv2-{}", std::process::id()));
        let device = StillDevice::new(&folder).expect("a folder for temporary files");
        Arc::new(Site::new(
            Arc::new(device) as Arc<dyn Device>,
            Passwords::default(),
        ))
    })
}

fuzz_target!(|bytes: &[u8]| {
    let mut session = Session::new(site());
    let mut reader = TcpReader::default();
    // In pieces, as a network delivers them.
    for piece in bytes.chunks(7) {
        reader.push(piece);
        while let Ok(Some(telegram)) = reader.telegram() {
            let answer = session.take(&telegram);
            assert!(answer.is_none_or(|answer| answer.data.len() <= DATA_MAX));
        }
    }
    let mut line = SerialServer::new(site());
    for byte in bytes {
        line.byte(*byte, Duration::ZERO);
    }
    for second in 1..100 {
        line.tick(Duration::from_secs(second));
        line.take_output();
    }
    line.byte(0x05, Duration::from_secs(100));
    assert_eq!(line.take_output(), b"\x100");
});
