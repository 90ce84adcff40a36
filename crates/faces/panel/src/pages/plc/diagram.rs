//! LOGIC DIAGRAM: up to sixteen operands over 1024 scans, around an event [000:11439-11472].

use bahn_dialogue::Key;
use bahn_exchange::Operand;
use bahn_host::logic_diagram::{Diagram, OPERANDS_MAX};
use bahn_parameters::MessageId;
use bahn_screen::{Dialogue, Line, WindowKind};

use crate::page::{Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::site::Site;

/// Scans in a line.
const COLUMNS: usize = 64;
/// Characters of an operand at most.
const OPERAND_MAX: usize = 6;

/// LOGIC DIAGRAM: the operands that are recorded, and their curves.
#[derive(Default)]
pub(super) struct LogicDiagram {
    current: usize,
    /// The first scan that is shown; `None` follows the record.
    first: Option<usize>,
    operand: Later,
}

impl LogicDiagram {
    /// Sets the operand of the row under the cursor, or a new one.
    fn set(&mut self, text: &str, site: &mut Site) -> bool {
        let named = text.to_ascii_uppercase().parse::<Operand>();
        let Ok(operand @ Operand::Bit(bit)) = named else {
            return false;
        };
        if !bit.is_listed() || site.plc.rows.len() >= OPERANDS_MAX && self.current >= OPERANDS_MAX {
            return false;
        }
        match site.plc.rows.get_mut(self.current) {
            Some(row) => *row = (operand, None),
            None => site.plc.rows.push((operand, None)),
        }
        site.plc.forget_diagram();
        true
    }

    fn trigger(&mut self, edge: Option<bool>, site: &mut Site) -> Turn {
        let Some((_, own)) = site.plc.rows.get_mut(self.current) else {
            return Turn::Refused;
        };
        *own = edge;
        site.plc.forget_diagram();
        Turn::Done
    }

    fn erase(&mut self, site: &mut Site) -> Turn {
        if self.current >= site.plc.rows.len() {
            return Turn::Refused;
        }
        site.plc.rows.remove(self.current);
        site.plc.forget_diagram();
        Turn::Done
    }

    fn start(&mut self, site: &mut Site) -> Turn {
        if site.plc.rows.is_empty() {
            return Turn::Refused;
        }
        self.first = None;
        let control = site.host.control();
        site.plc.start(control);
        Turn::Done
    }

    fn count(site: &Site) -> usize {
        site.plc.diagram().map_or(0, |diagram| diagram.samples.len())
    }

    /// The first scan that is shown: the latest ones, or with an event those around it.
    fn begins(&self, site: &Site) -> usize {
        let last = LogicDiagram::count(site).saturating_sub(COLUMNS);
        let event = site.plc.diagram().and_then(trigger_sample);
        let wanted = self.first.or(event.map(|at| at.saturating_sub(COLUMNS / 2)));
        wanted.map_or(last, |first| first.min(last))
    }

    fn scroll(&mut self, scans: isize, site: &Site) -> Turn {
        let last = LogicDiagram::count(site).saturating_sub(COLUMNS);
        self.first = Some(self.begins(site).saturating_add_signed(scans).min(last));
        Turn::Done
    }

    fn row(&self, place: usize, site: &Site) -> Line {
        let text = match site.plc.rows.get(place) {
            None => String::new(),
            Some((operand, edge)) => {
                let edge = match edge {
                    Some(true) => "1",
                    Some(false) => "0",
                    None => "-",
                };
                let first = self.begins(site);
                let levels = site.plc.diagram();
                let levels = levels.map(|diagram| diagram.levels(place, first, first + COLUMNS));
                let name = operand.to_string();
                format!("{name:<7}{edge:<3}{}", levels.unwrap_or_default())
            }
        };
        Line {
            text: text.trim_end().to_owned(),
            current: place == self.current,
            ..Line::default()
        }
    }

    /// The scans that are shown, and where the event is.
    fn title(&self, site: &Site) -> String {
        let name = site.words("LOGIC DIAGRAM");
        let Some(diagram) = site.plc.diagram().filter(|diagram| !diagram.samples.is_empty()) else {
            return name;
        };
        let first = self.begins(site);
        let from = diagram.first + first as u64;
        let to = diagram.first + diagram.samples.len().min(first + COLUMNS) as u64 - 1;
        let event = diagram
            .trigger
            .map(|scan| format!("  {} {scan}", site.words("TRIGGER")));
        format!(
            "{name}  {} {from}-{to} / {}{}",
            site.words("SCANS"),
            diagram.samples.len(),
            event.unwrap_or_default()
        )
    }
}

/// The sample of the event.
fn trigger_sample(diagram: &Diagram) -> Option<usize> {
    usize::try_from(diagram.trigger?.checked_sub(diagram.first)?).ok()
}

impl Page for LogicDiagram {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Up => self.current = self.current.saturating_sub(1),
            Key::Down => {
                let last = site.plc.rows.len().min(OPERANDS_MAX - 1);
                self.current = (self.current + 1).min(last);
            }
            Key::Left => return self.scroll(-(COLUMNS as isize) / 4, site),
            Key::Right => return self.scroll(COLUMNS as isize / 4, site),
            Key::Ent | Key::Goto => return self.operand.ask(site.words("OPERAND ="), OPERAND_MAX),
            Key::Digit1 => return self.trigger(Some(true), site),
            Key::Digit0 => return self.trigger(Some(false), site),
            Key::NoEnt => return self.trigger(None, site),
            Key::Del => return self.erase(site),
            Key::End => return Turn::Close,
            _ => return Turn::Refused,
        }
        Turn::Done
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![
            site.words("TRACE IN CODE"),
            site.words("OPERAND"),
            site.words("START TRACE"),
            site.words("STOP TRACE"),
            "<".to_owned(),
            ">".to_owned(),
            String::new(),
            site.words("END"),
        ]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            1 => return self.operand.ask(site.words("OPERAND ="), OPERAND_MAX),
            2 => return self.start(site),
            3 => site.plc.stop(),
            4 => return self.scroll(-(COLUMNS as isize), site),
            5 => return self.scroll(COLUMNS as isize, site),
            // TRACE IN CODE and END: that page lies below.
            _ => return Turn::Close,
        }
        Turn::Done
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let total = (site.plc.rows.len() + 1).min(OPERANDS_MAX);
        let (cursor, line) = ((self.current, total), |place| self.row(place, site));
        View {
            window: Some(list::window(
                self.title(site),
                WindowKind::Table,
                cursor,
                lines,
                line,
            )),
            dialogue: Dialogue {
                prompt: site.words("OPERAND = ENT / TRIGGER = 1, 0, NO ENT"),
                ..Dialogue::default()
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        match self.operand.take() {
            Some(text) if !self.set(&text, site) => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
            _ => Turn::Done,
        }
    }
}
