//! Code number 688 379: the oscilloscope [000:18737-18790]. Its curves are recorded by the host; this page tells which signals
//! there are, and has START and STOP.

use bahn_control::{Command, ServoSignal};
use bahn_dialogue::Key;

use crate::page::{Page, Turn, View};
use crate::screen::{Line, Window, WindowKind};
use crate::site::Site;

/// The signals.
pub(super) struct Signals;

impl Signals {
    fn press(start: bool, site: &mut Site) -> Turn {
        match site.command(Command::Oscilloscope(start)) {
            true => Turn::Done,
            false => Turn::Refused,
        }
    }
}

impl Page for Signals {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Start => Signals::press(true, site),
            Key::Stop => Signals::press(false, site),
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![site.words("START"), site.words("STOP"), site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => Signals::press(true, site),
            1 => Signals::press(false, site),
            _ => Turn::Close,
        }
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        let line = |signal: ServoSignal| Line {
            text: format!("{:<12} {}", signal.to_string().to_uppercase(), signal.unit()),
            ..Line::default()
        };
        let lines: Vec<Line> = ServoSignal::all().map(line).collect();
        View::of(Window {
            title: site.words("OSCILLOSCOPE: SIGNALS"),
            kind: WindowKind::Text,
            total: lines.len(),
            lines,
            first: 0,
        })
    }
}
