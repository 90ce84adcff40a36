//! Networks of channels and messages: where parameters hold them.

use std::collections::BTreeSet;

use bahn_system900::{
    Channels, Message, MessageKind, MessageWord, Name, Pending, Together, acknowledges_with_mode,
    named_message, named_messages, network, together,
};
use proptest::prelude::*;

use crate::memory::{memory, name};

fn numbers(channels: Channels) -> Vec<u8> {
    channels.iter().collect()
}

/// q903, q904, q905 of the first network, q913 and so on of the second [002:1272-1298]; a mask acts as soon as it is
/// written.
#[test]
fn channels_act_together() {
    let memory = memory(&[
        ("q903", "$00000003"),
        ("q904", "$00000006"),
        ("q915", "$81"),
        ("q933", "$0A"),
    ]);
    assert_eq!(numbers(network(&memory, 1, Together::Mode)), [1, 2]);
    assert_eq!(numbers(network(&memory, 4, Together::Mode)), [2, 4]);
    for none in [0, 2, 3, 5] {
        assert!(network(&memory, none, Together::Mode).is_empty(), "{none}");
    }
    // Channel 2 stands in two networks.
    assert_eq!(numbers(together(&memory, 2, Together::Mode)), [1, 2, 4]);
    assert_eq!(numbers(together(&memory, 1, Together::Mode)), [1, 2]);
    assert_eq!(numbers(together(&memory, 3, Together::Mode)), [3]);
    assert_eq!(numbers(together(&memory, 3, Together::Stop)), [2, 3]);
    assert_eq!(numbers(together(&memory, 8, Together::Abort)), [1, 8]);
    assert_eq!(numbers(together(&memory, 1, Together::Stop)), [1]);
    assert_eq!(together(&memory, 2, Together::Mode).to_string(), "1, 2, 4");
    assert_eq!(Channels::NONE.to_string(), "none");
}

/// q908 = $00030303 shows all messages of channels 1 and 2 in both, but those for display, which are shown in their own
/// channel alone; q909 says it of the PLC [002:1300-1344].
#[test]
fn messages_are_shown_together() {
    let memory = memory(&[("q908", "$00030303"), ("q909", "$0305")]);
    for kind in MessageKind::ALL {
        let wanted: &[u8] = if kind == MessageKind::Display {
            &[2]
        } else {
            &[1, 2]
        };
        assert_eq!(
            numbers(together(&memory, 2, Together::Message(kind))),
            wanted,
            "{kind:?}"
        );
    }
    assert_eq!(
        numbers(together(&memory, 1, Together::OfPlc { high: true })),
        [1, 3]
    );
    assert_eq!(
        numbers(together(&memory, 1, Together::OfPlc { high: false })),
        [1, 2]
    );
}

/// q98 has a byte for each of the channels 1 to 4, q99 for 5 to 8; bits 0 to 3 are the kinds, 4 and 5 those of the PLC
/// [002:609-628].
#[test]
fn pending_messages_have_a_byte() {
    let mut memory = memory(&[]);
    Pending::default()
        .with(MessageKind::High)
        .with_plc(false)
        .enter(&mut memory, 1);
    Pending::default().with(MessageKind::System).enter(&mut memory, 4);
    Pending::default()
        .with(MessageKind::Display)
        .with_plc(true)
        .enter(&mut memory, 6);
    let bits = |q| memory.cell(Name::Q(q)).unwrap().bits();
    // Bits 1 and 5 are $22; bit 0 of byte 4; bits 3 and 4 are $18, in byte 2.
    assert_eq!((bits(98), bits(99)), (Some(0x0100_0022), Some(0x1800)));
    let first = Pending::of(&memory, 1);
    assert!(first.has(MessageKind::High) && first.has_plc(false));
    assert!(!first.has(MessageKind::Low) && !first.has_plc(true));
    assert_eq!(Pending::of(&memory, 2), Pending::default());
    let before = memory.clone();
    Pending::default().with(MessageKind::Low).enter(&mut memory, 9);
    assert_eq!(memory, before, "there is no channel 9");
}

/// q157: cleared or 0 acknowledges with the change to HAND, too, 1 by P8508 alone [002:939-948].
#[test]
fn who_acknowledges() {
    for (value, with_mode) in [("0", true), ("--", true), ("1", false)] {
        let memory = memory(&[("q157", value), ("q257", "1")]);
        assert_eq!(acknowledges_with_mode(&memory, 1), with_mode);
        assert!(!acknowledges_with_mode(&memory, 2));
    }
}

/// P8500 to P8503 by the kind, P8504 the axis, P8505 to P8507 what is shown beside it [002:3368-3375].
#[test]
fn a_message_has_parameters() {
    let blocks = [
        ("q102", "10000"),
        ("q103", "100"),
        ("q2", "2"),
        ("q202", "20000"),
        ("q203", "100"),
    ];
    for (kind, at) in MessageKind::ALL.into_iter().zip(8500..) {
        let mut memory = memory(&blocks);
        let message = Message {
            number: 2001,
            kind,
            axis: Some(3),
            information: [Some(-7), None, Some(0)],
        };
        message.enter(&mut memory, 2);
        let shown = |number| memory.cell(Name::P(2, number)).unwrap().written();
        assert_eq!(
            [at, 8504, 8505, 8506, 8507].map(shown),
            ["2001", "3", "-7", "--", "0"]
        );
        assert_eq!(Message::of(&memory, 2, kind), Some(message));
        assert_eq!(Message::of(&memory, 1, kind), None);
        Message::acknowledge(&mut memory, 2);
        assert_eq!(Message::of(&memory, 2, kind), None);
    }
    let none = memory(&[blocks[0], blocks[1], ("P8501", "0")]);
    assert_eq!(Message::of(&none, 1, MessageKind::High), None);
}

/// Every message that the chapter names has its row: where it says `M` and four digits.
#[test]
fn named_messages_are_known() {
    let lines = include_str!("../../data/messages.tsv").lines().count() - 1;
    let numbers: BTreeSet<u16> = named_messages().iter().map(|message| message.number).collect();
    assert_eq!((lines, named_messages().len(), numbers.len()), (15, 15, 15));
    let named = [
        1114, 1115, 1154, 1155, 1237, 1238, 1320, 1800, 2000, 2001, 2002, 2020, 2022, 2110, 3498,
    ];
    assert_eq!(numbers.into_iter().collect::<Vec<_>>(), named);
    for message in named_messages() {
        assert!(
            message.source.starts_with("[002:") && message.source.ends_with(']'),
            "{}",
            message.number
        );
        for text in [message.title, message.cause, message.remedy] {
            assert!(!text.is_empty() && !text.ends_with('.'), "{text}");
        }
    }
    for word in ["M1237", "m 1237", " 1237"] {
        assert_eq!(
            named_message(word).map(|message| message.number),
            Some(1237),
            "{word}"
        );
    }
    for word in ["M1239", "M", "", "M-1", "MM1237", "M1237x"] {
        assert!(named_message(word).is_none(), "{word}");
    }
}

proptest! {
    /// Bytes 1 and 2 are the number, 3 the channel, 4 the axis [002:3379-3384]; nothing of them is lost.
    #[test]
    fn the_word_of_a_message(number: u16, channel: u8, axis: u8) {
        let word = MessageWord { number, channel, axis };
        let bits = u32::from(axis) << 24 | u32::from(channel) << 16 | u32::from(number);
        prop_assert_eq!(word.bits().cast_unsigned(), bits);
        prop_assert_eq!(MessageWord::from_bits(word.bits()), word);
    }

    /// Whoever goes with a channel has it with itself.
    #[test]
    fn together_is_mutual(masks in proptest::array::uniform4(any::<u8>())) {
        let mut memory = memory(&[]);
        for (network, mask) in (0..).zip(masks) {
            memory.write(Name::Q(904 + 10 * network), format!("${mask:X}").parse().unwrap()).unwrap();
        }
        for channel in 1..=8 {
            let with = together(&memory, channel, Together::Stop);
            prop_assert!(with.contains(channel));
            for other in with.iter() {
                prop_assert!(together(&memory, other, Together::Stop).contains(channel));
            }
        }
        prop_assert_eq!(name("q904"), Name::Q(904));
    }
}
