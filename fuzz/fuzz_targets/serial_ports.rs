//! Whatever arrives at a serial port, as control and as device, by both protocols: nobody panics, nothing grows without bound,
//! and behind silence and a pulled cable the port is idle.
#![no_main]

use std::time::Duration;

use bahn_link::blockwise::{self, DirectoryRequest, Rights, Want};
use bahn_link::{Event, FileType, Memory, Mode, Protocol, Settings, standard};
use bahn_parameters::{ControlModel, ParameterList};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&which, noise)) = data.split_first() else {
        return;
    };
    let Some(kind) = FileType::of_code('H') else {
        return;
    };
    let list = ParameterList::reference(ControlModel::Tnc415b);
    let fe = Settings::of(&list, Mode::Fe1);
    let me = Settings::of(&list, Mode::Me);
    let memory = Memory::default();
    memory.put("1.H", "0 BEGIN PGM 1 MM\n1 L X+1\n2 END PGM 1 MM\n");
    let files = || Box::new(memory.clone());
    let selected = || Want::Selected("9.H".to_owned());
    let names = || vec!["1.H".to_owned()];
    let mut protocol: Box<dyn Protocol> = match which % 9 {
        0 => Box::new(blockwise::Peripheral::new(fe, files(), Rights::ALL)),
        1 => Box::new(blockwise::Reading::new(fe, files(), selected(), kind)),
        2 => Box::new(blockwise::Reading::new(fe, files(), Want::All, kind)),
        3 => Box::new(blockwise::Reading::new(fe, files(), Want::Offered, kind)),
        4 => Box::new(blockwise::Writing::new(fe, files(), names(), false)),
        5 => Box::new(DirectoryRequest::new(fe)),
        6 => Box::new(standard::Peripheral::new(me, files(), Rights::ALL)),
        7 => Box::new(standard::Reading::new(me, files(), Want::All, kind)),
        _ => Box::new(standard::Writing::new(me, files(), names(), false)),
    };
    let mut now = Duration::from_secs(1);
    let mut out = Vec::new();
    for byte in noise {
        // 255 is a second of silence.
        if *byte == 255 {
            now += Duration::from_secs(1);
        } else {
            protocol.receive(*byte, now);
        }
        protocol.clock(now);
        out.clear();
        protocol.send(64, now, &mut out);
        assert!(out.len() <= 64);
        while let Some(event) = protocol.event() {
            if matches!(event, Event::Question(_)) {
                protocol.answer(byte & 1 == 0, now);
            }
        }
    }
    protocol.end(now);
    protocol.unplugged(now);
    assert!(protocol.is_idle());
});
