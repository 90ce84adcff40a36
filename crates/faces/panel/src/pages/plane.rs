//! 3D ROT: the tilted working plane, for program run and for manual operation each for itself, and the positions of the swivel
//! axes in it [000:4256].
//!
//! Decision: In the menu of 3D ROT another position of an axis is that of each plane that is on, whose other axes
//! keep theirs; with none on it switches manual operation on, and a plane that is switched on has the positions that
//! are shown

use bahn_tnc::{Command, PlaneCommand};

use crate::page::Turn;
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::number::Number;
use crate::site::Site;

/// What is switched: program run, and not manual operation.
const SWITCHES: [(&str, bool); 2] = [("PROGRAM RUN", true), ("MANUAL OPERATION", false)];
/// The axes that may swivel.
const LETTERS: [char; 3] = ['A', 'B', 'C'];

/// 3D ROT: where a tilted plane is on, and its angles.
pub(super) fn menu() -> Turn {
    Turn::Open(Box::new(Menu::new(Plane)))
}

struct Plane;

/// The swivel axes of the machine, by their places in [`LETTERS`].
fn swivel_axes(site: &Site) -> Vec<usize> {
    let swivels = site.parameters().swivels();
    let free = swivels.iter().flat_map(|swivels| swivels.free_axes());
    free.filter_map(|axis| LETTERS.iter().position(|letter| *letter == axis.letter()))
        .collect()
}

/// The position of a swivel axis in a plane, or else where it stands, degrees.
fn angle_in(plane: Option<[f64; 3]>, place: usize, site: &Site) -> f64 {
    let of_plane = plane.and_then(|angles| angles.get(place).copied());
    let letter = LETTERS.get(place).copied().unwrap_or_default();
    of_plane
        .or_else(|| site.captured_reference(letter))
        .unwrap_or_default()
}

/// The plane that is shown: the one that is on, of manual operation first.
fn shown(site: &Site) -> Option<[f64; 3]> {
    let channel = site.control().first();
    channel.plane(false).or_else(|| channel.plane(true))
}

/// The positions of all swivel axes of the machine in a plane.
fn angles(plane: Option<[f64; 3]>, site: &Site) -> [Option<f64>; 3] {
    let axes = swivel_axes(site);
    [0, 1, 2].map(|place| axes.contains(&place).then(|| angle_in(plane, place, site)))
}

fn switch(run: bool, angles: Option<[Option<f64>; 3]>, site: &mut Site) -> bool {
    site.command(Command::WorkingPlane(PlaneCommand { run, angles }))
}

/// Another position of a swivel axis, in each plane that is on; where none is, manual operation is switched on with it.
fn edit(place: usize, value: f64, site: &mut Site) -> bool {
    let channel = site.control().first();
    let [by_hand, run] = [false, true].map(|run| channel.plane(run));
    let edited = [
        (false, by_hand, by_hand.is_some() || run.is_none()),
        (true, run, run.is_some()),
    ];
    let mut done = true;
    for (is_run, plane, _) in edited.into_iter().filter(|(.., is_edited)| *is_edited) {
        let mut wanted = angles(plane, site);
        if let Some(angle) = wanted.get_mut(place) {
            *angle = Some(value);
        }
        done &= switch(is_run, Some(wanted), site);
    }
    done
}

impl Items for Plane {
    fn title(&self, site: &Site) -> String {
        site.words("TILTED WORKING PLANE")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let channel = site.control().first();
        let switches = SWITCHES.map(|(name, run)| {
            let on = channel.plane(run).is_some();
            Item::new(
                site.words(name),
                site.words(if on { "ACTIVE" } else { "INACTIVE" }),
            )
        });
        let plane = shown(site);
        let axes = swivel_axes(site).into_iter().filter_map(|place| {
            let letter = LETTERS.get(place)?;
            Some(Item::new(
                letter.to_string(),
                format!("{:+.3}", angle_in(plane, place, site)),
            ))
        });
        switches.into_iter().chain(axes).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        if let Some((_, run)) = SWITCHES.get(place).copied() {
            let on = site.control().first().plane(run).is_none();
            let wanted = on.then(|| angles(shown(site), site));
            return match switch(run, wanted, site) {
                true => Turn::Done,
                false => Turn::Refused,
            };
        }
        let Some(axis) = swivel_axes(site).get(place - SWITCHES.len()).copied() else {
            return Turn::Refused;
        };
        let letter = LETTERS.get(axis).copied().unwrap_or_default();
        let ask = Number::ask(format!("{letter} ="), move |value, site| edit(axis, value, site));
        Turn::Open(ask.capturing(move |site| site.captured_reference(letter)))
    }
}
