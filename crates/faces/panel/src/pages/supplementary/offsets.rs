//! Code number 75 368: the offsets of the axes are shown, and adjusted [000:5014-5020].

use bahn_dialogue::Key;
use bahn_path::Switch;
use bahn_screen::{Line, Window, WindowKind};
use bahn_tnc::Command;

use crate::page::{Page, Turn, View};
use crate::site::Site;

/// Opens the dialogue; refused while the control shows no offsets.
pub(super) fn open(site: &Site) -> Turn {
    match site.control().offsets_shown() {
        Some(_) => Turn::Open(Box::new(Offsets)),
        None => Turn::Refused,
    }
}

/// Offsets in steps of the converter.
struct Offsets;

impl Offsets {
    fn answer(adjust: Switch, site: &mut Site) -> Turn {
        match site.command(Command::OffsetAdjustment(adjust)) {
            true => Turn::Close,
            false => Turn::Refused,
        }
    }
}

impl Page for Offsets {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Ent => Offsets::answer(Switch::On, site),
            Key::NoEnt => Offsets::answer(Switch::Off, site),
            Key::End | Key::Del => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![
            site.words("CONTINUE"),
            site.words("QUIT"),
            site.words("END"),
        ]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => Offsets::answer(Switch::On, site),
            1 => Offsets::answer(Switch::Off, site),
            _ => Turn::Close,
        }
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        let snapshot = site.control().snapshot();
        let shown = site.control().offsets_shown();
        let lines = snapshot.axes.iter().filter_map(|axis| {
            let steps = shown.as_ref()?.get(axis.index)?;
            Some(Line {
                text: format!("{}  {steps:>6}", axis.letter),
                ..Line::default()
            })
        });
        let lines: Vec<Line> = lines.collect();
        let unit_mv = format!("{:.2}", site.control().offset_unit_volts() * 1e3);
        let mut view = View::of(Window {
            title: site
                .words("OFFSET ADJUSTMENT (1 = {} mV)")
                .replace("{}", &unit_mv),
            kind: WindowKind::List,
            total: lines.len(),
            lines,
            first: 0,
        });
        view.dialogue.prompt = site.words("ADJUST = ENT / AUTOMATIC OFF = NO ENT");
        view
    }
}
