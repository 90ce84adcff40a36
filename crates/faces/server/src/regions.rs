//! A screen in regions, each encoded once, however many look at it.

use bahn_service::Screen;
use serde::Serialize;
use std::sync::Arc;

/// The regions of a screen, as MessagePack: an array of a name and a value each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Regions {
    serial: u64,
    /// Name and value, and the serial of the screen since which it is so.
    parts: Vec<(u64, Arc<[u8]>)>,
}

impl Regions {
    /// The serial of the screen.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// The regions of the next screen.
    pub fn next(&self, screen: &Screen) -> Regions {
        // What changes with every cycle stands apart from what does not.
        let line = &screen.timeline;
        let time = (screen.serial, screen.time_s, line.to_s);
        let encoded = [
            region("time", &time),
            region("header", &(&screen.mode, &screen.headings, &screen.messages)),
            region("dialogue", &screen.dialogue),
            region("program", &(&screen.program, &screen.beside)),
            region("status", &screen.status),
            region("softkeys", &screen.soft_keys),
            region("plc", &screen.plc_window),
            region("graphics", &screen.graphics),
            region("machine", &(&screen.machine, &screen.lamps)),
            region("timeline", &(&line.marks, &line.branches)),
            region("why", &screen.why),
            region("lesson", &screen.lesson),
            region("look", &screen.look),
        ];
        let parts = encoded
            .into_iter()
            .enumerate()
            .map(|(place, bytes)| match self.parts.get(place) {
                Some((since, before)) if **before == *bytes => (*since, Arc::clone(before)),
                _ => (screen.serial, Arc::from(bytes)),
            });
        Regions {
            serial: screen.serial,
            parts: parts.collect(),
        }
    }

    /// What has changed since a screen, as one message: an array of regions.
    pub fn since(&self, serial: u64) -> Vec<u8> {
        let news = self.parts.iter().filter(|(since, _)| *since > serial);
        let news: Vec<&[u8]> = news.map(|(_, bytes)| &**bytes).collect();
        message(&news)
    }
}

/// An array of regions that are encoded already; one that could not be is left out.
pub(crate) fn message(regions: &[&[u8]]) -> Vec<u8> {
    let mut message = Vec::new();
    let whole = || regions.iter().filter(|region| !region.is_empty());
    // Nothing but memory is written to.
    let _ = rmp::encode::write_array_len(&mut message, whole().count() as u32);
    whole().for_each(|region| message.extend_from_slice(region));
    message
}

/// A region: its name and its value, structures as maps by name. Empty when it cannot be encoded, which none of ours is.
pub(crate) fn region<T: Serialize>(name: &str, value: &T) -> Vec<u8> {
    rmp_serde::to_vec_named(&(name, value)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_are_sent_what_has_changed() {
        let mut screen = Screen {
            serial: 1,
            ..Screen::default()
        };
        let first = Regions::default().next(&screen);
        assert_eq!(first.since(0)[0], 0x9d, "all thirteen regions");
        assert_eq!(first.since(1), [0x90]);
        screen.serial = 2;
        screen.dialogue.prompt = "PROGRAM NUMBER =".to_owned();
        let second = first.next(&screen);
        // The time, which has the serial, and the dialogue.
        assert_eq!(second.since(1)[0], 0x92);
        assert_eq!(second.since(0)[0], 0x9d);
    }

    /// The head of an array has one byte up to 15 elements, three bytes from 16 on.
    #[test]
    fn any_number_of_regions_is_an_array() {
        // What could not be encoded does not count.
        assert_eq!(message(&[&[]]), [0x90]);
        for count in [0, 1, 15, 16, 17, 40, 70_000] {
            let regions: Vec<Vec<u8>> = (0..count).map(|k| region("region", &k)).collect();
            let regions: Vec<&[u8]> = regions.iter().map(Vec::as_slice).collect();
            let bytes = message(&regions);
            let read: Vec<(String, u32)> = rmp_serde::from_slice(&bytes).unwrap();
            assert_eq!(read.len(), count as usize);
            assert!(
                (0..)
                    .zip(&read)
                    .all(|(k, (name, value))| name == "region" && *value == k)
            );
        }
    }
}
