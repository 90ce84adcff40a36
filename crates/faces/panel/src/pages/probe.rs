//! TOUCH PROBE by hand: calibration, basic rotation, datums in a surface, a corner, the centre of a circle [003:1217-1405].

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_path::{Axis, Direction};
use bahn_screen::{Dialogue, Line, Mark, Window, WindowKind};
use bahn_tnc::{Command, ProbeCommand, ProbeFunction, Signal};

use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::pages::ask::Choice;
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::number::Number;
use crate::site::Site;

/// The menu of the key TOUCH PROBE.
pub(crate) fn menu() -> Turn {
    Turn::Open(Box::new(Menu::new(Functions)))
}

struct Functions;

impl Items for Functions {
    fn title(&self, site: &Site) -> String {
        site.words("TOUCH PROBE")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let names = [
            site.words("CALIBRATION EFFECTIVE LENGTH"),
            site.words("CALIBRATION EFFECTIVE RADIUS"),
            site.words("BASIC ROTATION"),
            site.words("SURFACE = DATUM"),
            site.words("CORNER = DATUM"),
            site.words("CIRCLE CENTER = DATUM"),
        ];
        names.into_iter().map(|name| Item::new(name, "")).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => measured(site.words("DATUM ="), ProbeFunction::Length),
            1 => measured(site.words("RADIUS RING GAUGE ="), ProbeFunction::Radius),
            2 => begin(ProbeFunction::Rotation, site),
            3 => begin(ProbeFunction::Surface, site),
            4 => Turn::Open(Choice::ask(
                site.words("TOUCH POINTS OF BASIC ROTATION? YES = ENT / NO = NO ENT"),
                [site.words("YES"), site.words("NO")],
                |reuse, site| match begin(ProbeFunction::Corner { reuse }, site) {
                    Turn::Open(page) => Turn::Replace(page),
                    other => other,
                },
            )),
            _ => begin(ProbeFunction::Circle, site),
        }
    }
}

/// Calibration: the height of the face, the radius of the ring gauge.
fn measured(prompt: String, function: fn(f64) -> ProbeFunction) -> Turn {
    Turn::Open(Number::turning(prompt, move |value, site| {
        match begin(function(value), site) {
            Turn::Open(page) => Turn::Replace(page),
            other => other,
        }
    }))
}

fn begin(function: ProbeFunction, site: &mut Site) -> Turn {
    let wrong = match function {
        ProbeFunction::Radius(radius) => radius <= 0.0,
        _ => false,
    };
    if wrong || !site.command(Command::Probe(ProbeCommand::Choose(function))) {
        return Turn::Say(site.message(MessageId::EntryValueIncorrect));
    }
    Turn::Open(Box::new(Probing::new(function, site)))
}

/// A direction that the next start probes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    One(Axis, Direction),
    All,
}

impl Way {
    fn name(self, site: &Site) -> String {
        match self {
            Way::One(axis, direction) => format!("{}{direction}", axis.letter()),
            Way::All => site.words("ALL"),
        }
    }
}

/// A function that is chosen: NC start probes, then its result is answered.
struct Probing {
    function: ProbeFunction,
    ways: Vec<Way>,
    way: Option<usize>,
    entry: Entry,
    /// Touches as they were seen last.
    touches: f64,
    /// Axes whose datum was answered since.
    answered: Vec<Axis>,
}

impl Probing {
    fn new(function: ProbeFunction, site: &Site) -> Probing {
        let tool_axis = site
            .control()
            .first()
            .in_force()
            .map_or(Axis::Z, |own| own.tool_axis);
        let fits = |axis: &Axis| match function {
            ProbeFunction::Surface => true,
            ProbeFunction::Length(_) => *axis == tool_axis,
            _ => *axis != tool_axis,
        };
        let axes = [Axis::X, Axis::Y, Axis::Z].into_iter().filter(fits);
        let all = matches!(function, ProbeFunction::Radius(_) | ProbeFunction::Circle);
        let mut ways: Vec<Way> = axes
            .flat_map(|axis| Direction::BOTH.map(|direction| Way::One(axis, direction)))
            .collect();
        let mut way = None;
        if all {
            ways.push(Way::All);
            way = Some(ways.len() - 1);
        }
        if matches!(function, ProbeFunction::Length(_)) {
            way = ways
                .iter()
                .position(|way| *way == Way::One(tool_axis, Direction::Minus));
        }
        Probing {
            function,
            ways,
            way,
            entry: Entry::default(),
            touches: 0.0,
            answered: Vec::new(),
        }
    }

    fn name(&self, site: &Site) -> String {
        let place = match self.function {
            ProbeFunction::Length(_) => 0,
            ProbeFunction::Radius(_) => 1,
            ProbeFunction::Rotation => 2,
            ProbeFunction::Surface => 3,
            ProbeFunction::Corner { .. } => 4,
            ProbeFunction::Circle => 5,
        };
        let items = Functions.items(site).into_iter().nth(place);
        items.map_or_else(String::new, |item| item.name)
    }

    fn aim(&mut self, place: usize, site: &mut Site) -> Turn {
        let command = match self.ways.get(place) {
            Some(Way::One(axis, direction)) => ProbeCommand::Direction(*axis, *direction),
            Some(Way::All) => ProbeCommand::AllDirections,
            None => return Turn::Refused,
        };
        if !site.command(Command::Probe(command)) {
            return Turn::Refused;
        }
        self.way = Some(place);
        Turn::Done
    }

    /// An axis key chooses its direction, the second time the other one.
    fn axis(&mut self, place: usize, site: &mut Site) -> Turn {
        let Some(axis) = site.axis_of_key(place) else {
            return Turn::Refused;
        };
        let chosen = self.way.and_then(|way| self.ways.get(way)).copied();
        let wanted = match chosen {
            Some(Way::One(of, Direction::Plus)) if of == axis => Direction::Minus,
            _ => Direction::Plus,
        };
        let wanted = Way::One(axis, wanted);
        let place = self.ways.iter().position(|way| *way == wanted);
        place.map_or(Turn::Refused, |place| self.aim(place, site))
    }

    /// The axis whose datum is asked for, and what it was probed at.
    fn asked(&self, site: &Site) -> Option<(Axis, f64)> {
        let axes = [Axis::X, Axis::Y, Axis::Z].into_iter();
        let value = |axis: Axis| observe(&format!("{}.probed", axis.letter()), site);
        axes.filter(|axis| !self.answered.contains(axis))
            .map(|axis| (axis, value(axis)))
            .find(|(_, value)| value.is_finite())
    }

    /// ENT: the value becomes ROTATION ANGLE or the datum; without one what was found stays.
    fn enter(&mut self, site: &mut Site) -> Turn {
        let value = self.entry.value();
        let done = match (self.function, self.asked(site), value) {
            (ProbeFunction::Rotation, _, Some(angle)) => {
                site.command(Command::Probe(ProbeCommand::Angle(angle)))
            }
            (_, Some((axis, _)), None) => {
                self.answered.push(axis);
                true
            }
            (_, Some((axis, _)), Some(value)) => {
                let done = site.command(Command::Probe(ProbeCommand::Datum(axis, value)));
                if done {
                    self.answered.push(axis);
                }
                done
            }
            _ => return Turn::Refused,
        };
        self.entry = Entry::default();
        match done {
            true => Turn::Done,
            false => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }

    fn close(site: &mut Site) -> Turn {
        match site.command(Command::Probe(ProbeCommand::End)) {
            true => Turn::Close,
            // It is on its way to the surface, or the function is left already.
            false if site.control().first().probe_is_chosen() => Turn::Refused,
            false => Turn::Close,
        }
    }

    /// What was found, line by line.
    fn results(&self, site: &Site) -> Vec<(String, f64)> {
        let mut results = Vec::new();
        match self.function {
            ProbeFunction::Length(_) => {
                results.push((site.words("EFFECTIVE LENGTH"), observe("probe.length", site)));
            }
            ProbeFunction::Radius(_) => {
                results.push((site.words("EFFECTIVE RADIUS"), observe("probe.radius", site)));
            }
            ProbeFunction::Rotation => {
                results.push((site.words("ROTATION ANGLE"), observe("probe.angle", site)));
            }
            _ => {}
        }
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let value = observe(&format!("{}.probed", axis.letter()), site);
            if value.is_finite() {
                results.push((format!("{} {}", site.words("DATUM"), axis.letter()), value));
            }
        }
        if self.function == ProbeFunction::Circle {
            results.push(("PR".to_owned(), observe("probe.circle", site)));
        }
        results
    }
}

fn observe(signal: &str, site: &Site) -> f64 {
    let signal = signal.parse::<Signal>().ok();
    signal.map_or(f64::NAN, |signal| site.control().observe(&signal))
}

impl Page for Probing {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        let last = self.ways.len().saturating_sub(1);
        match key {
            Key::X => self.axis(0, site),
            Key::Y => self.axis(1, site),
            Key::Z => self.axis(2, site),
            Key::Right => self.aim(
                self.way.map_or(0, |way| if way == last { 0 } else { way + 1 }),
                site,
            ),
            Key::Left => self.aim(
                self.way.map_or(last, |way| way.checked_sub(1).unwrap_or(last)),
                site,
            ),
            Key::Ent => self.enter(site),
            Key::NoEnt if self.asked(site).is_some() => {
                self.entry = Entry::default();
                self.enter(site)
            }
            Key::End | Key::Del | Key::NoEnt | Key::TouchProbe => Probing::close(site),
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let mut keys: Vec<String> = self.ways.iter().map(|way| way.name(site)).collect();
        keys.resize(6, String::new());
        let turns = matches!(self.function, ProbeFunction::Radius(_));
        keys.push(if turns { "180°".to_owned() } else { String::new() });
        keys.push(site.words("END"));
        vec![keys]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            6 => match site.command(Command::Probe(ProbeCommand::Turn)) {
                true => Turn::Done,
                false => Turn::Refused,
            },
            7 => Probing::close(site),
            place => self.aim(place, site),
        }
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        let mut ways = Line::default();
        for (place, way) in self.ways.iter().enumerate() {
            let from = ways.text.chars().count();
            ways.text += &format!("{} ", way.name(site));
            if self.way == Some(place) {
                ways.marks
                    .push((from, ways.text.chars().count() - 1, Mark::Cursor));
            }
        }
        let results = self.results(site).into_iter().map(|(name, value)| Line {
            text: format!("{name:<20} = {value:+.3}"),
            ..Line::default()
        });
        let lines: Vec<Line> = [ways].into_iter().chain(results).collect();
        let prompt = match (self.function, self.asked(site)) {
            (ProbeFunction::Rotation, _) => format!("{} =", site.words("ROTATION ANGLE")),
            (_, Some((axis, _))) => format!("{} {} =", site.words("DATUM"), axis.letter()),
            _ => String::new(),
        };
        View {
            window: Some(Window {
                title: self.name(site),
                kind: WindowKind::Text,
                total: lines.len(),
                lines,
                first: 0,
            }),
            dialogue: Dialogue {
                open: !prompt.is_empty(),
                prompt,
                entry: self.entry.text(),
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let touches = observe("probe.touches", site);
        if touches != self.touches {
            self.touches = touches;
            self.answered.clear();
        }
        match site.control().first().probe_is_chosen() {
            true => Turn::Done,
            false => Turn::Close,
        }
    }
}
