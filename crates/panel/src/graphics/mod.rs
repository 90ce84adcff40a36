//! Graphics of TEST RUN and program run [003:854-945]: a part that is cut while a program is tested, another one that is
//! cut while it runs, and how the operator looks at them.
//!
//! - `stock` is the part that is being cut, which pictures are made of meanwhile;
//! - `trial` tests a program with it, `follow` cuts what the machine has executed;
//! - `scope` is the oscilloscope, whose curves stand in the same window.
//!
//! By the clock on the wall both cut on threads of their own; by the free clock with the machine, so that the same
//! inputs give the same screens.

mod being_cut;
mod follow;
mod picture;
mod scope;
mod stock;
mod trial;

use bahn_control::Control;
use bahn_dialogue::Key;
use bahn_host::Host;
use bahn_parameters::ParameterList;

use crate::colours::colour;
use crate::screen::{GraphicsLine, GraphicsView};
pub use being_cut::BeingCut;
pub(crate) use picture::Sight;
pub use picture::{Picture, PictureError};
pub(crate) use scope::{Content, Scope, TriggerOn, signal_name};

use follow::Follower;
use trial::Trial;

/// Between two pictures of a part that is being cut, µs (inferred).
const EVERY_US: u64 = 500_000;
/// A section moves by this part of the blank with each arrow key (inferred).
const SECTION_STEP: f64 = 0.05;
/// Magnifications that MAGN goes through (inferred) [003:940-945].
const MAGNIFICATIONS: [u8; 3] = [1, 2, 4];

/// Which part is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// That of TEST RUN.
    Test,
    /// That of the program run.
    Run,
    /// None: the curves of the oscilloscope.
    Oscilloscope,
}

/// The graphics of a station.
pub(crate) struct Graphics {
    trial: Option<Trial>,
    follower: Follower,
    /// How it is looked at; `None` shows the program alone.
    view: Option<GraphicsView>,
    sight: Sight,
    /// Threads cut, not the machine's own one.
    beside: bool,
    /// The oscilloscope.
    pub scope: Scope,
    serial: u64,
    /// What the last picture showed, and when it was made.
    shown: (u64, u64),
}

impl Graphics {
    /// Those of a machine that was switched on.
    pub fn new(host: &mut Host) -> Graphics {
        host.keep_path();
        Graphics {
            trial: None,
            follower: Follower::default(),
            view: None,
            sight: Sight::default(),
            beside: false,
            scope: Scope::new(host.control()),
            serial: 0,
            shown: (0, 0),
        }
    }

    /// Cuts on threads from now on.
    pub fn run_beside(&mut self) {
        self.beside = true;
    }

    /// Once in every contour cycle.
    pub fn cycle(&mut self, host: &mut Host) {
        self.follower.cycle(host, self.beside);
        if let Some(trial) = &mut self.trial {
            trial.cycle();
        }
        let now_us = host.control().time_us();
        self.scope.cycle(now_us);
        let progress = self.trial.as_ref().map(Trial::progress).unwrap_or_default();
        let cut = progress.elements + self.follower.elements();
        let (seen, then_us) = self.shown;
        if cut != seen && (progress.ended || now_us.abs_diff(then_us) >= EVERY_US) {
            self.shown = (cut, now_us);
            self.serial += 1;
        }
    }

    /// Begins the test of a program that the control has just begun to test, with the whole blank.
    pub fn test(&mut self, control: &Control) {
        self.stop();
        self.trial = Trial::begin(control, self.beside);
        self.serial += 1;
    }

    /// Breaks the test off; what was cut stays to be seen.
    pub fn stop(&mut self) {
        if let Some(trial) = &mut self.trial {
            trial.stop();
        }
    }

    /// A test that came upon something that cannot be shown, told once.
    pub fn cannot_be_shown(&mut self) -> bool {
        self.trial.as_mut().is_some_and(Trial::cannot_be_shown)
    }

    /// The machine was brought to another moment: what it had cut by then is not known.
    pub fn machine_is_elsewhere(&mut self) {
        self.follower = Follower::default();
        self.scope.break_off();
        self.serial += 1;
    }

    /// Takes a key; `false` when it is not for the graphics.
    pub fn key(&mut self, cut: Cut, key: Key) -> bool {
        if key == Key::Graphics {
            self.view = match self.view {
                None => Some(GraphicsView::Plan),
                Some(GraphicsView::Plan) => Some(GraphicsView::ThreePlanes),
                Some(GraphicsView::ThreePlanes) => Some(GraphicsView::Solid),
                _ => None,
            };
            self.serial += 1;
            return true;
        }
        let Some(view) = self.view else { return false };
        let taken = match (key, view) {
            (Key::BlkForm, _) => self.restore(cut),
            (Key::Magn, _) => self.magnify(),
            (Key::Left, GraphicsView::Solid) => self.turn(-1),
            (Key::Right, GraphicsView::Solid) => self.turn(1),
            (Key::Up, GraphicsView::Solid) => self.stretch(true),
            (Key::Down, GraphicsView::Solid) => self.stretch(false),
            (Key::Left, GraphicsView::ThreePlanes) => self.shift(0, -SECTION_STEP),
            (Key::Right, GraphicsView::ThreePlanes) => self.shift(0, SECTION_STEP),
            (Key::Down, GraphicsView::ThreePlanes) => self.shift(1, -SECTION_STEP),
            (Key::Up, GraphicsView::ThreePlanes) => self.shift(1, SECTION_STEP),
            _ => false,
        };
        self.serial += u64::from(taken);
        taken
    }

    /// GRAPHICS and BLK FORM: the programmed blank is whole again [003:931-935].
    fn restore(&mut self, cut: Cut) -> bool {
        match cut {
            Cut::Test => {
                self.stop();
                if let Some(trial) = &self.trial {
                    trial.stock().restore();
                }
            }
            Cut::Run => self.follower.restore(),
            Cut::Oscilloscope => {}
        }
        true
    }

    fn magnify(&mut self) -> bool {
        let place = MAGNIFICATIONS.iter().position(|magn| *magn == self.sight.magn);
        let next = place.map_or(0, |place| (place + 1) % MAGNIFICATIONS.len());
        self.sight.magn = MAGNIFICATIONS.get(next).copied().unwrap_or(1);
        true
    }

    fn turn(&mut self, quarters: i8) -> bool {
        self.sight.quarter = (self.sight.quarter as i8 + quarters).rem_euclid(4) as u8;
        true
    }

    fn stretch(&mut self, stretched: bool) -> bool {
        self.sight.stretched = stretched;
        true
    }

    fn shift(&mut self, axis: usize, by: f64) -> bool {
        if let Some(section) = self.sight.sections.get_mut(axis) {
            // Whole steps: as many back lead to the same place.
            *section = (((*section + by) / SECTION_STEP).round() * SECTION_STEP).clamp(0.0, 1.0);
        }
        true
    }

    /// What the screen says of it; `None` while the operator looks at the program alone.
    pub fn line(&self, cut: Cut) -> Option<GraphicsLine> {
        if cut == Cut::Oscilloscope {
            return Some(self.scope.line());
        }
        let view = self.view?;
        let progress = self.trial.as_ref().map(Trial::progress).unwrap_or_default();
        let test = cut == Cut::Test;
        Some(GraphicsLine {
            view,
            running: test && self.trial.is_some() && !progress.ended,
            progress: if test { progress.part } else { 0.0 },
            machining_time_s: test.then_some(progress.machining_time_s),
            magn: self.sight.magn,
            azimuth_deg: self.sight.azimuth_deg(),
            sections: self.sight.sections,
            serial: self.serial,
        })
    }

    /// The part itself, whatever the graphics show of it; `None` before there is one.
    pub fn being_cut(&self, cut: Cut, control: &Control) -> Option<BeingCut> {
        match cut {
            Cut::Test => {
                let trial = self.trial.as_ref()?;
                Some(BeingCut::new(trial.stock(), trial.program()))
            }
            Cut::Run => {
                let cut = BeingCut::new(self.follower.stock()?, self.follower.program());
                Some(cut.on_the_way(control))
            }
            Cut::Oscilloscope => None,
        }
    }

    /// What is to be seen, to be drawn by whoever wants it; `None` as with [`Graphics::line`], and without a part.
    pub fn picture(&self, cut: Cut, list: &ParameterList) -> Option<Picture> {
        if cut == Cut::Oscilloscope {
            let colours = [0, 1, 2, 3, 4].map(|index| colour(list, 7361, index).unwrap_or_default());
            return Some(Picture::curves(self.scope.curves(), colours));
        }
        let view = self.view?;
        let (stock, program, time_s) = match cut {
            Cut::Test => {
                let trial = self.trial.as_ref()?;
                let time_s = trial.progress().machining_time_s;
                (trial.stock(), trial.program(), Some(time_s))
            }
            Cut::Run => (self.follower.stock()?, self.follower.program(), None),
            Cut::Oscilloscope => return None,
        };
        Some(Picture::new(
            stock,
            program,
            time_s,
            view,
            self.sight,
            list.graphics().third_angle,
        ))
    }
}
