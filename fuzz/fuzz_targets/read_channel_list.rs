//! Any bytes are a channel parameter list: faults in their lines, and what it sets is written and read back.
#![no_main]

use bahn_fuzz as _;
use bahn_technology::ChannelList;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let list = ChannelList::from_bytes(bytes);
    for fault in list.errors().iter().chain(list.warnings()) {
        assert!(fault.span.line >= 1 && fault.span.column >= 1);
        assert!(fault.span.column as usize <= list.line(fault.span.line as usize).chars().count() + 1);
    }
    let written = list.settings().to_list();
    let again = ChannelList::from_bytes(written.as_bytes());
    assert_eq!(again.errors(), &[]);
    assert_eq!(again.settings(), list.settings());
});
