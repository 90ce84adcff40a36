//! The graphics of a station: what is looked at, and how.

use std::sync::Arc;

use bahn_dialogue::Key;
use bahn_host::{Host, LoadedMachine, Operable};
use bahn_parameters::ParameterList;
use bahn_screen::colours::colour;
use bahn_screen::programs::ProgramMemory;
use bahn_screen::{GraphicsLine, GraphicsView};
use bahn_tnc::Control;
use bahn_workpiece::Scheme;

use crate::being_cut::BeingCut;
use crate::contour::Wish;
use crate::drawing;
use crate::follow::Follower;
use crate::part_view::PartView;
use crate::picture::{Picture, Sight};
use crate::programmed::{Asked, Programmed};
use crate::scope::Scope;
use crate::trial::Trial;

/// Between two pictures of a part that is being cut, µs (inferred).
const EVERY_US: u64 = 500_000;
/// A section moves by this part of the blank with each arrow key (inferred).
const SECTION_STEP: f64 = 0.05;
/// Magnifications that MAGN goes through (inferred) [003:940-945].
const MAGNIFICATIONS: [u8; 3] = [1, 2, 4];

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The part of TEST RUN.
    Test,
    /// The part of the program run.
    Run,
    /// What is being written.
    Programmed,
    /// The curves of the oscilloscope.
    Oscilloscope,
}

impl From<PartView> for GraphicsView {
    fn from(view: PartView) -> GraphicsView {
        match view {
            PartView::Plan => GraphicsView::Plan,
            PartView::ThreePlanes => GraphicsView::ThreePlanes,
            PartView::Solid => GraphicsView::Solid,
        }
    }
}

/// The graphics of a station.
pub struct Graphics {
    trial: Option<Trial>,
    programmed: Programmed,
    follower: Follower,
    /// How it is looked at; `None` shows the program alone.
    view: Option<PartView>,
    sight: Sight,
    /// Threads cut, not the machine's own one.
    beside: bool,
    /// The control has graphics: a TNC 151 has a screen for characters.
    there: bool,
    /// What is set and recorded of the oscilloscope.
    pub scope: Scope,
    serial: u64,
    /// What the last picture showed, and when it was made.
    shown: (u64, u64),
}

impl Graphics {
    /// Those of a machine that was switched on.
    pub fn new<P: Operable>(host: &mut Host<P>) -> Graphics {
        host.keep_path();
        Graphics {
            trial: None,
            programmed: Programmed::default(),
            follower: Follower::default(),
            view: None,
            sight: Sight::default(),
            beside: false,
            there: host.control().model().has_graphics(),
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
    pub fn cycle<P: Operable>(&mut self, host: &mut Host<P>) {
        self.follower.cycle(host, self.beside);
        if let Some(trial) = &mut self.trial {
            trial.cycle();
        }
        let now_us = host.control().time_us();
        self.scope.cycle(now_us);
        self.serial += u64::from(self.programmed.cycle(now_us));
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

    /// The test that is cut, as long as it is not through.
    pub fn tested(&mut self) -> Option<&mut Trial> {
        self.trial.as_mut().filter(|trial| !trial.progress().ended)
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

    /// Draws a program that is being written.
    pub fn draw(
        &mut self,
        wish: Wish,
        control: &Control,
        machine: &LoadedMachine,
        programs: &Arc<ProgramMemory>,
    ) {
        self.programmed
            .draw(wish, control, machine, programs, self.beside);
    }

    /// Shows what is being written beside the program, or no more.
    pub fn show_programmed(&mut self, on: bool) {
        self.programmed.show(on);
        self.serial += 1;
    }

    /// Shows the drawing of a cycle instead, or no more.
    pub fn show_cycle(&mut self, asked: Option<Asked>) {
        self.serial += u64::from(self.programmed.ask(asked));
    }

    /// Whether it is shown.
    pub fn shows_programmed(&self) -> bool {
        self.programmed.is_on()
    }

    /// Takes a key; `false` when it is not for the graphics.
    pub fn key(&mut self, subject: Subject, key: Key) -> bool {
        if !self.there {
            return false;
        }
        if subject == Subject::Programmed {
            let taken = key == Key::Magn && self.programmed.is_on() && self.magnify();
            self.serial += u64::from(taken);
            return taken;
        }
        if key == Key::Graphics {
            self.view = match self.view {
                None => Some(PartView::Plan),
                Some(PartView::Plan) => Some(PartView::ThreePlanes),
                Some(PartView::ThreePlanes) => Some(PartView::Solid),
                Some(PartView::Solid) => None,
            };
            self.serial += 1;
            return true;
        }
        let Some(view) = self.view else { return false };
        let taken = match (key, view) {
            // Magnified it shows the workpiece in its programmed size again [003:943].
            (Key::BlkForm, _) if self.sight.magn != 1 => {
                self.sight.magn = 1;
                true
            }
            (Key::BlkForm, _) => self.restore(subject),
            (Key::Magn, _) => self.magnify(),
            (Key::Left, PartView::Solid) => self.turn(-1),
            (Key::Right, PartView::Solid) => self.turn(1),
            (Key::Up, PartView::Solid) => self.stretch(true),
            (Key::Down, PartView::Solid) => self.stretch(false),
            (Key::Left, PartView::ThreePlanes) => self.shift(0, -SECTION_STEP),
            (Key::Right, PartView::ThreePlanes) => self.shift(0, SECTION_STEP),
            (Key::Down, PartView::ThreePlanes) => self.shift(1, -SECTION_STEP),
            (Key::Up, PartView::ThreePlanes) => self.shift(1, SECTION_STEP),
            _ => false,
        };
        self.serial += u64::from(taken);
        taken
    }

    /// GRAPHICS and BLK FORM: the programmed blank is whole again [003:931-935].
    fn restore(&mut self, subject: Subject) -> bool {
        match subject {
            Subject::Test => {
                self.stop();
                if let Some(trial) = &self.trial {
                    trial.stock().restore();
                }
            }
            Subject::Run => self.follower.restore(),
            Subject::Oscilloscope | Subject::Programmed => {}
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
    pub fn line(&self, subject: Subject) -> Option<GraphicsLine> {
        let still = |view, running| GraphicsLine {
            view,
            running,
            progress: 0.0,
            machining_time_s: None,
            magn: self.sight.magn,
            azimuth_deg: self.sight.azimuth_deg(),
            sections: self.sight.sections,
            serial: self.serial,
        };
        match subject {
            Subject::Oscilloscope => Some(self.scope.line()),
            Subject::Programmed => Some(still(self.programmed.view()?, self.programmed.is_drawing())),
            Subject::Run => Some(still(self.view?.into(), false)),
            Subject::Test => {
                let progress = self.trial.as_ref().map(Trial::progress).unwrap_or_default();
                Some(GraphicsLine {
                    progress: progress.part,
                    machining_time_s: Some(progress.machining_time_s),
                    ..still(self.view?.into(), self.trial.is_some() && !progress.ended)
                })
            }
        }
    }

    /// The part itself, whatever the graphics show of it; `None` before there is one.
    pub fn being_cut(&self, subject: Subject, control: &Control) -> Option<BeingCut> {
        match subject {
            Subject::Test => {
                let trial = self.trial.as_ref()?;
                Some(BeingCut::new(trial.stock(), trial.program()))
            }
            Subject::Run => {
                let cut = BeingCut::new(self.follower.stock()?, self.follower.program());
                Some(cut.on_the_way(control))
            }
            Subject::Oscilloscope | Subject::Programmed => None,
        }
    }

    /// What is to be seen, to be drawn by whoever wants it; `None` as with [`Graphics::line`], and without a part.
    pub fn picture(&self, subject: Subject, list: &ParameterList) -> Option<Picture> {
        let settings = list.graphics();
        let of_part = |stock, program, time_s| {
            let view = self.view?;
            let picture = Picture::of_part(stock, program, time_s, view, self.sight, settings);
            Some(picture.in_colours(part_colours(list, view)))
        };
        match subject {
            Subject::Oscilloscope => {
                let colours = [0, 1, 2, 3, 4].map(|index| colour(list, 7361, index).unwrap_or_default());
                Some(Picture::of_curves(self.scope.curves(), colours))
            }
            Subject::Programmed => {
                let [background, contour, called] = drawing::STANDARD;
                let colours = [(0, background), (1, contour), (2, called)];
                let colours = colours.map(|(index, standard)| colour(list, 7363, index).unwrap_or(standard));
                self.programmed
                    .picture(self.sight.magn, settings.plane_rotated, colours)
            }
            Subject::Run => of_part(self.follower.stock()?, self.follower.program(), None),
            Subject::Test => {
                let trial = self.trial.as_ref()?;
                let time_s = trial.progress().machining_time_s;
                of_part(trial.stock(), trial.program(), Some(time_s))
            }
        }
    }
}

/// The colours of a part: MP7360 those of the 3D view, MP7361 those of the views along the axes, MP7362 those of the
/// line that says what is drawn and how long it takes [000:6344-6360]. The plan view alone has the colours that it has
/// among the three planes (inferred). None on a control without them.
fn part_colours(list: &ParameterList, view: PartView) -> Option<Scheme> {
    if !list.model().has_windows() {
        return None;
    }
    let own = |number| move |index| colour(list, number, index);
    let (drawn, title) = (own(if view == PartView::Solid { 7360 } else { 7361 }), own(7362));
    let faces = match view {
        PartView::Solid => [drawn(1)?, drawn(2)?, drawn(4)?],
        PartView::Plan | PartView::ThreePlanes => [drawn(1)?, drawn(2)?, drawn(2)?],
    };
    Some(Scheme {
        background: drawn(0)?,
        text: drawn(3)?,
        faces,
        title: [title(1)?, title(2)?, title(3)?],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_parameters::ControlModel;

    #[test]
    fn a_control_without_colours_draws_with_ours() {
        let of = |model| part_colours(&ParameterList::smallest(model), PartView::Solid);
        assert!(of(ControlModel::Tnc360).is_none());
        // The standard values of MP7360.0 and .1.
        let scheme = of(ControlModel::Tnc415b).unwrap();
        assert_eq!((scheme.background, scheme.faces[0]), ([0, 0, 0], [129, 194, 226]));
    }
}
