//! Code number 857 282: how long the control was on, a program ran and the spindle turned [003:7030].

use bahn_dialogue::Key;
use bahn_screen::{Line, Window, WindowKind};

use crate::page::{Page, Turn, View};
use crate::site::Site;

pub(super) struct Timers;

/// Minutes as hours and minutes.
fn time(minutes: u64) -> String {
    format!("{:>6}:{:02}", minutes / 60, minutes % 60)
}

impl Page for Timers {
    fn key(&mut self, key: Key, _site: &mut Site) -> Turn {
        match key {
            Key::End | Key::Del | Key::NoEnt | Key::Ent => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, _place: usize, _site: &mut Site) -> Turn {
        Turn::Close
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        let minutes = site.settings.timers_min;
        let names = [
            site.words("CONTROL ON"),
            site.words("PROGRAM RUN"),
            site.words("SPINDLE ON"),
        ];
        let lines = names.iter().zip(minutes).map(|(name, minutes)| Line {
            text: format!("{name:<24} {}", time(minutes)),
            ..Line::default()
        });
        let lines: Vec<Line> = lines.collect();
        View::of(Window {
            title: site.words("MACHINE TIME"),
            kind: WindowKind::List,
            total: lines.len(),
            lines,
            first: 0,
        })
    }
}
