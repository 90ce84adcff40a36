//! Code number 688 379: the oscilloscope [000:18671-18790]. The main display says what is recorded; OSZI shows the curves, in
//! the window of the graphics.
//!
//! Decision: The record of the oscilloscope and the part of the graphics have memories of their own: neither deletes
//! the other; the optimal scale is the finest of 1, 2, 5 with which a curve fits; soft keys whose pictures are lost
//! have words (also `graphics/src/scope/curves.rs`)

use bahn_dialogue::Key;
use bahn_graphics::Subject;
use bahn_graphics::scope::{Content, Scope, TriggerOn, signal_name};
use bahn_host::oscilloscope::SAMPLE_TIME_US;
use bahn_path::{Direction, Switch};
use bahn_screen::{Line, Window, WindowKind};
use bahn_tnc::{Command, Mode, ServoSignal};

use crate::page::{Page, Turn, View};
use crate::pages::list;
use crate::pages::number::Number;
use crate::site::Site;

use super::parameters;

/// What PRE-TRIGGER can be set to, % [000:18728-18729].
const PRE_TRIGGERS: [u8; 5] = [0, 25, 50, 75, 100];
/// Greatest NOML. FEED RATE, mm/min: that of MP1010.
const MOST_FEED: f64 = 300_000.0;
/// Greatest trigger threshold (inferred).
const MOST_THRESHOLD: f64 = 999_999.0;

/// A line of the main display, in the order of the manual [000:18682-18694].
#[derive(Clone, Copy, PartialEq, Eq)]
enum Item {
    Output,
    Feed,
    SampleTime,
    /// The axis of a channel, and what it shows of it.
    Axis(usize),
    Content(usize),
    Trigger,
    Threshold,
    Slope,
    PreTrigger,
}

use Item::{Axis, Content as Shows, Feed, Output, PreTrigger, SampleTime, Slope, Threshold, Trigger};

const ITEMS: [Item; 15] = [
    Output,
    Feed,
    SampleTime,
    Axis(0),
    Shows(0),
    Axis(1),
    Shows(1),
    Axis(2),
    Shows(2),
    Axis(3),
    Shows(3),
    Trigger,
    Threshold,
    Slope,
    PreTrigger,
];

/// Opens the main display.
pub(super) fn open() -> Turn {
    Turn::Open(Box::new(MainDisplay::default()))
}

/// What is recorded and triggered, a line each.
#[derive(Default)]
struct MainDisplay {
    current: usize,
}

impl MainDisplay {
    fn item(&self) -> Item {
        ITEMS.get(self.current).copied().unwrap_or(Output)
    }

    fn begin_number(&self, key: Key, site: &Site) -> Turn {
        let number = self.item().number(site);
        number.map_or(Turn::Refused, |number| Turn::Open(number.beginning(key)))
    }

    fn go(&mut self, direction: Direction) -> Turn {
        let count = ITEMS.len();
        self.current = beside(self.current, direction, count);
        Turn::Done
    }
}

impl Item {
    /// Digits enter the feed and the threshold, which everything else is not [000:18733-18734].
    fn number(self, site: &Site) -> Option<Box<Number>> {
        match self {
            Feed => Some(ask_feed(site)),
            Threshold => Some(ask_threshold(site)),
            _ => None,
        }
    }

    /// ENT goes to the next value, NO ENT to the one before; numbers are asked for.
    fn change(self, direction: Direction, site: &mut Site) -> Turn {
        let setup = &mut site.graphics.scope.setup;
        match self {
            Output => return set_output(!setup.step, setup.feed_mm_min, site),
            Feed => return Turn::Open(ask_feed(site)),
            Threshold => return Turn::Open(ask_threshold(site)),
            SampleTime => {
                let times = sample_times(site);
                let setup = &mut site.graphics.scope.setup;
                setup.sample_us = next(&times, setup.sample_us, direction);
            }
            Axis(number) => {
                let axes: Vec<char> = site.control().axis_letters().collect();
                let setup = &mut site.graphics.scope.setup;
                let Some(channel) = setup.channels.get_mut(number) else {
                    return Turn::Refused;
                };
                channel.axis = next(&axes, channel.axis, direction);
                channel.content = Content::Off;
                channel.curve = None;
            }
            Shows(number) => {
                let Some(channel) = setup.channels.get(number).cloned() else {
                    return Turn::Refused;
                };
                let mut contents = vec![Content::Off];
                let digital = site.control().servo_view().is_digital(channel.axis);
                let signals = ServoSignal::all().filter(|signal| digital || !signal.is_digital());
                contents.extend(signals.map(Content::Signal));
                if channel.curve.is_some() {
                    contents.push(Content::Saved);
                }
                let setup = &mut site.graphics.scope.setup;
                if let Some(own) = setup.channels.get_mut(number) {
                    own.content = next(&contents, own.content, direction);
                }
            }
            Trigger => {
                let mut triggers = vec![TriggerOn::FreeRun, TriggerOn::SingleShot];
                let recorded = |number: &usize| {
                    let channel = setup.channels.get(*number);
                    channel.is_some_and(|channel| matches!(channel.content, Content::Signal(_)))
                };
                triggers.extend((0..setup.channels.len()).filter(recorded).map(TriggerOn::Channel));
                setup.trigger = next(&triggers, setup.trigger, direction);
            }
            Slope => setup.rising = !setup.rising,
            PreTrigger => {
                setup.pre_trigger_percent = next(&PRE_TRIGGERS, setup.pre_trigger_percent, direction)
            }
        }
        Turn::Done
    }

    fn line(self, site: &Site) -> String {
        let setup = &site.graphics.scope.setup;
        let words = |english: &'static str| site.words(english);
        let (name, value) = match self {
            Output if setup.step => (words("OUTPUT"), words("STEP")),
            Output => (words("OUTPUT"), words("RAMP")),
            Feed => (words("NOML. FEED RATE"), format!("{:.0}", setup.feed_mm_min)),
            SampleTime => (
                words("SAMPLE TIME"),
                format!("{:.1} MS", f64::from(setup.sample_us) * 1e-3),
            ),
            Axis(number) => {
                let axis = setup.channels.get(number).map_or(' ', |channel| channel.axis);
                (format!("{} {}", words("CHANNEL"), number + 1), axis.to_string())
            }
            Shows(number) => {
                let content = setup.channels.get(number).map(|channel| channel.content);
                let value = match content.unwrap_or_default() {
                    Content::Off => words("OFF"),
                    Content::Saved => words("SAVED"),
                    Content::Signal(signal) => format!("{} [{}]", signal_name(signal), signal.unit()),
                };
                (String::new(), value)
            }
            Trigger => {
                let value = match setup.trigger {
                    TriggerOn::FreeRun => words("FREE RUN"),
                    TriggerOn::SingleShot => words("SINGLE SHOT"),
                    TriggerOn::Channel(number) => format!("{} {}", words("CHANNEL"), number + 1),
                };
                (words("TRIGGER"), value)
            }
            Threshold => (
                words("TRIGGER THRESHOLD"),
                format!("{:+}{}", setup.threshold, threshold_unit(site)),
            ),
            Slope => (words("SLOPE"), if setup.rising { "+" } else { "-" }.to_owned()),
            PreTrigger => (words("PRE-TRIGGER"), format!("{} %", setup.pre_trigger_percent)),
        };
        format!("{name:<22}{value}")
    }
}

/// The unit of the channel that triggers [000:18717-18725].
fn threshold_unit(site: &Site) -> String {
    let setup = &site.graphics.scope.setup;
    let TriggerOn::Channel(number) = setup.trigger else {
        return String::new();
    };
    match setup.channels.get(number).map(|channel| channel.content) {
        Some(Content::Signal(ServoSignal::Lag)) => " µm".to_owned(),
        Some(Content::Signal(signal)) => format!(" {}", signal.unit()),
        _ => String::new(),
    }
}

/// The place after another one of so many, or before it, round.
fn beside(place: usize, direction: Direction, count: usize) -> usize {
    match direction {
        Direction::Plus => (place + 1) % count,
        Direction::Minus => (place + count - 1) % count,
    }
}

/// The value after another one, or before it, round.
fn next<T: Copy + PartialEq>(values: &[T], value: T, direction: Direction) -> T {
    let at = values.iter().position(|own| *own == value);
    let place = at.map_or(0, |at| beside(at, direction, values.len()));
    values.get(place).copied().unwrap_or(value)
}

/// 0.6 to 6 ms in servo steps of the control [000:18748].
fn sample_times(site: &Site) -> Vec<u32> {
    let step_us = site.control().model().timing().step_us();
    let times = (1..).map(|steps| steps * step_us);
    times
        .take_while(|time| time <= SAMPLE_TIME_US.end())
        .filter(|time| SAMPLE_TIME_US.contains(time))
        .collect()
}

/// RAMP, or STEP in MANUAL OPERATION on axes with digital speed controller only [000:18735-18739].
fn set_output(step: bool, feed_mm_min: f64, site: &mut Site) -> Turn {
    let possible = !step || site.mode() == Mode::Manual;
    if !possible || !site.command(Command::Output(step.then_some(feed_mm_min))) {
        return Turn::Refused;
    }
    let setup = &mut site.graphics.scope.setup;
    (setup.step, setup.feed_mm_min) = (step, feed_mm_min);
    Turn::Done
}

fn ask_feed(site: &Site) -> Box<Number> {
    let prompt = format!("{} =", site.words("NOML. FEED RATE"));
    Number::ask(prompt, |feed, site| {
        let fits = (0.0..=MOST_FEED).contains(&feed);
        if fits && site.graphics.scope.setup.step {
            return matches!(set_output(true, feed, site), Turn::Done);
        }
        if fits {
            site.graphics.scope.setup.feed_mm_min = feed;
        }
        fits
    })
}

fn ask_threshold(site: &Site) -> Box<Number> {
    let prompt = format!("{} =", site.words("TRIGGER THRESHOLD"));
    Number::ask(prompt, |threshold, site| {
        let fits = threshold.abs() <= MOST_THRESHOLD;
        if fits {
            site.graphics.scope.setup.threshold = threshold;
        }
        fits
    })
}

impl Page for MainDisplay {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Up => self.go(Direction::Minus),
            Key::Down => self.go(Direction::Plus),
            Key::Ent | Key::Right => self.item().change(Direction::Plus, site),
            Key::NoEnt | Key::Left => self.item().change(Direction::Minus, site),
            Key::Start => Display::open(site),
            Key::End | Key::Del => Turn::Close,
            Key::Sign | Key::Point => self.begin_number(key, site),
            key if key.character().is_some_and(|digit| digit.is_ascii_digit()) => {
                self.begin_number(key, site)
            }
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let none = String::new;
        vec![vec![
            site.words("OSZI"),
            none(),
            none(),
            none(),
            none(),
            none(),
            site.words("MP EDIT"),
            site.words("END"),
        ]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => Display::open(site),
            6 => parameters::all(site),
            _ => Turn::Close,
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let line = |place: usize| Line {
            text: ITEMS.get(place).map_or_else(String::new, |item| item.line(site)),
            current: place == self.current,
            ..Line::default()
        };
        let (title, cursor) = (site.words("OSCILLOSCOPE"), (self.current, ITEMS.len()));
        View::of(list::window(title, WindowKind::List, cursor, lines, line))
    }
}

/// Curves of the last recording.
struct Display;

/// What a soft key of the curves does, row by row as the manual has them [000:18675-18680]; its pictures are lost, so that
/// words stand for them (inferred).
#[derive(Clone, Copy)]
enum Act {
    None,
    Select(usize),
    SetUp,
    /// START, and STOP while it records.
    Record,
    /// Half the time is seen, or twice as much.
    Closer,
    Wider,
    Go(Direction),
    Invert,
    /// Vertical zoom: a coarser scale, or a finer one.
    Scale(i32),
    Centre,
    Cursor,
    SecondCursor,
    End,
}

const ROWS: [[(&str, Act); 8]; 3] = [
    [
        ("CH 1", Act::Select(0)),
        ("CH 2", Act::Select(1)),
        ("CH 3", Act::Select(2)),
        ("CH 4", Act::Select(3)),
        ("", Act::None),
        ("SET UP", Act::SetUp),
        ("START", Act::Record),
        ("END", Act::End),
    ],
    [
        ("TIME -", Act::Closer),
        ("TIME +", Act::Wider),
        ("<-", Act::Go(Direction::Minus)),
        ("->", Act::Go(Direction::Plus)),
        ("", Act::None),
        ("", Act::None),
        ("", Act::None),
        ("END", Act::End),
    ],
    [
        ("INVERT", Act::Invert),
        ("SCALE -", Act::Scale(1)),
        ("SCALE +", Act::Scale(-1)),
        ("CENTRE", Act::Centre),
        ("CURSOR", Act::Cursor),
        ("CURSOR 1/2", Act::SecondCursor),
        ("", Act::None),
        ("END", Act::End),
    ],
];

impl Display {
    fn open(site: &mut Site) -> Turn {
        site.graphics.scope.changed();
        Turn::Open(Box::new(Display))
    }

    fn record(record: Switch, site: &mut Site) -> Turn {
        let possible = record == Switch::Off || site.graphics.scope.can_record();
        match possible && site.command(Command::Oscilloscope(record)) {
            true => Turn::Done,
            false => Turn::Refused,
        }
    }
}

impl Act {
    fn done(self, site: &mut Site) -> Turn {
        let records = site.control().oscilloscope().records;
        let scope: &mut Scope = &mut site.graphics.scope;
        let selected = scope.sight.selected;
        match self {
            Act::None => return Turn::Refused,
            Act::Record => return Display::record(Switch::from(!records), site),
            // While it records only STOP is possible [000:18770-18774].
            _ if records => return Turn::Refused,
            Act::End | Act::SetUp => return Turn::Close,
            Act::Select(channel) => scope.sight.selected = channel,
            Act::Closer => scope.sight.stretch(true),
            Act::Wider => scope.sight.stretch(false),
            Act::Go(direction) => scope.sight.go(direction),
            Act::Invert => scope.sight.inverted[selected] ^= true,
            Act::Scale(by) => {
                let curves = scope.curves();
                let mut lanes = curves.lanes.iter();
                let lane = lanes.find(|lane| lane.number == selected);
                let Some(zoom) = lane.and_then(|lane| lane.zoomed(by)) else {
                    return Turn::Refused;
                };
                scope.sight.zoom[selected] = zoom;
            }
            Act::Centre => scope.sight.zoom[selected] = 0,
            Act::Cursor => scope.sight.cursor(),
            Act::SecondCursor => scope.sight.second_cursor(),
        }
        scope.changed();
        Turn::Done
    }
}

impl Page for Display {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        let act = match key {
            Key::Left => Act::Go(Direction::Minus),
            Key::Right => Act::Go(Direction::Plus),
            Key::Up => Act::Scale(-1),
            Key::Down => Act::Scale(1),
            // The original deflection [000:18783-18784].
            Key::NoEnt => Act::Centre,
            Key::Start => return Display::record(Switch::On, site),
            Key::Stop => return Display::record(Switch::Off, site),
            Key::End | Key::Del => Act::End,
            _ => return Turn::Refused,
        };
        act.done(site)
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        if site.control().oscilloscope().records {
            let mut row = vec![String::new(); 8];
            row[6] = site.words("STOP");
            return vec![row];
        }
        let text = |(english, _): &(&'static str, Act)| match *english {
            "" => String::new(),
            english => site.words(english),
        };
        ROWS.iter().map(|row| row.iter().map(text).collect()).collect()
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        let act = ROWS.get(row).and_then(|row| row.get(place));
        act.map_or(Turn::Refused, |(_, act)| act.done(site))
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let scope = &site.graphics.scope;
        let curves = scope.curves();
        let text = |text: String, current: bool| Line {
            text,
            current,
            ..Line::default()
        };
        let mut shown: Vec<Line> = curves
            .lanes
            .iter()
            .map(|lane| text(lane.title(), lane.number == scope.sight.selected))
            .collect();
        shown.push(text(
            format!("{:.1} MS", curves.time_of_division_s() * 1e3),
            false,
        ));
        shown.extend(curves.cursors().into_iter().map(|line| text(line, false)));
        shown.truncate(lines);
        View::of(Window {
            title: site.words("OSCILLOSCOPE"),
            kind: WindowKind::Text,
            total: shown.len(),
            lines: shown,
            first: 0,
        })
    }

    fn subject(&self) -> Option<Subject> {
        Some(Subject::Oscilloscope)
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        // The memory is full: it stops by itself.
        if site.graphics.scope.records() && site.graphics.scope.is_complete() {
            site.command(Command::Oscilloscope(Switch::Off));
        }
        Turn::Done
    }
}
