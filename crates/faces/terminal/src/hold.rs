//! Keys of the machine that are held down.
//!
//! Most terminals report that a key was pressed, and repeat that while it stays down, but not that it was let
//! go. A key counts as held as long as it is repeated; one that is tapped is down for [`RENEWED`]. Terminals with the
//! keyboard protocol of kitty report when a key was let go, but not of one that writes a letter.
//!
//! Decision: In the terminal a key of the machine is held as long as the terminal repeats it, at most 200 ms after
//! the last time; one that is tapped is down so long. Where the keyboard protocol of kitty tells releases, they count

use std::time::{Duration, Instant};

/// A key that is not repeated for so long was let go: keys repeat every 30 to 50 ms (inferred).
pub(crate) const RENEWED: Duration = Duration::from_millis(200);
/// The same where the terminal reports when a key is let go; until keys begin to repeat 660 ms may pass (inferred).
const REPORTED: Duration = Duration::from_millis(1000);
/// A switch that turns over is not turned over again by a key that repeats (inferred).
const STROKE: Duration = Duration::from_millis(700);

/// Who holds a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hand {
    /// A key of the keyboard, while it is repeated.
    Keyboard,
    /// The same of a letter: no terminal reports when it is let go.
    Letter,
    /// The mouse, until its button is let go.
    Mouse,
    /// It stays down until it is let go by an order.
    Latch,
}

/// What is to be done with a key of the machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// The key is pressed.
    Press(String),
    /// The key is released.
    Release(String),
}

#[derive(Debug)]
struct Held {
    name: String,
    hand: Hand,
    /// When it was reported last.
    reported: Instant,
}

/// The keys that are held.
#[derive(Debug, Default)]
pub(crate) struct Holds {
    held: Vec<Held>,
    /// The terminal reports when a key was let go.
    pub reports_releases: bool,
    /// A switch that was turned over, and when it was reported last.
    stroke: Option<(String, Instant)>,
}

impl Holds {
    /// A key is held, or held on.
    pub fn press(&mut self, name: &str, hand: Hand, now: Instant) -> Option<Change> {
        // A keyboard repeats only the key that was pressed last.
        let all = hand == Hand::Keyboard && self.reports_releases;
        let keys = self.held.iter_mut().filter(|held| held.hand == hand);
        let renewed = keys.filter(|held| all || held.name == name);
        renewed.for_each(|held| held.reported = now);
        if self.held.iter().any(|held| held.name == name) {
            return None;
        }
        self.held.push(Held {
            name: name.to_owned(),
            hand,
            reported: now,
        });
        Some(Change::Press(name.to_owned()))
    }

    /// A key is let go.
    pub fn release(&mut self, name: &str) -> Option<Change> {
        let place = self.held.iter().position(|held| held.name == name)?;
        Some(Change::Release(self.held.remove(place).name))
    }

    /// A key that is down comes up, one that is up stays down.
    pub fn latch(&mut self, name: &str, now: Instant) -> Option<Change> {
        if !self.strikes(name, now) {
            return None;
        }
        self.release(name).or_else(|| self.press(name, Hand::Latch, now))
    }

    /// Whether a key that turns something over is struck anew, and does not merely repeat.
    pub fn strikes(&mut self, name: &str, now: Instant) -> bool {
        let repeats =
            matches!(&self.stroke, Some((last, reported)) if last == name && now - *reported < STROKE);
        self.stroke = Some((name.to_owned(), now));
        !repeats
    }

    /// What the mouse holds is let go.
    pub fn release_mouse(&mut self) -> Vec<Change> {
        self.release_where(|held| held.hand == Hand::Mouse)
    }

    /// Keys of the keyboard that were let go, as far as time tells.
    pub fn tick(&mut self, now: Instant) -> Vec<Change> {
        let reported = self.reports_releases;
        self.release_where(|held| match held.hand {
            Hand::Keyboard if reported => now - held.reported >= REPORTED,
            Hand::Keyboard | Hand::Letter => now - held.reported >= RENEWED,
            Hand::Mouse | Hand::Latch => false,
        })
    }

    /// Everything is let go but what is latched.
    pub fn release_hands(&mut self) -> Vec<Change> {
        self.release_where(|held| held.hand != Hand::Latch)
    }

    /// Everything is let go.
    pub fn release_all(&mut self) -> Vec<Change> {
        self.release_where(|_| true)
    }

    fn release_where(&mut self, which: impl Fn(&Held) -> bool) -> Vec<Change> {
        let released = self.held.extract_if(.., |held| which(held));
        released.map(|held| Change::Release(held.name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_is_let_go_by_time_even_where_releases_are_reported() {
        let mut holds = Holds {
            reports_releases: true,
            ..Holds::default()
        };
        let begun = Instant::now();
        let at = |ms| begun + Duration::from_millis(ms);
        holds.press("X+", Hand::Letter, at(0));
        holds.press("Y+", Hand::Keyboard, at(0));
        assert_eq!(holds.tick(at(150)), []);
        assert_eq!(holds.tick(at(250)), [Change::Release("X+".to_owned())]);
        assert_eq!(holds.tick(at(900)), []);
        assert_eq!(holds.tick(at(1000)), [Change::Release("Y+".to_owned())]);
    }

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn press(name: &str) -> Option<Change> {
        Some(Change::Press(name.to_owned()))
    }

    fn release(name: &str) -> Vec<Change> {
        vec![Change::Release(name.to_owned())]
    }

    #[test]
    fn a_key_that_repeats_is_held_and_one_that_does_not_is_let_go() {
        let (mut holds, start) = (Holds::default(), Instant::now());
        assert_eq!(holds.press("X+", Hand::Keyboard, start), press("X+"));
        assert_eq!(holds.tick(start + RENEWED - ms(1)), []);
        assert_eq!(holds.tick(start + RENEWED), release("X+"));
        // The keyboard begins to repeat after half a second.
        let mut now = start + ms(500);
        assert_eq!(holds.press("X+", Hand::Keyboard, now), press("X+"));
        for _ in 0..50 {
            now += ms(40);
            assert_eq!(holds.tick(now), []);
            assert_eq!(holds.press("X+", Hand::Keyboard, now), None);
        }
        assert_eq!(holds.tick(now + RENEWED), release("X+"));
        assert_eq!(holds.release_all(), []);
    }

    #[test]
    fn a_terminal_that_tells_of_releases_holds_two_keys() {
        let (mut holds, start) = (Holds::default(), Instant::now());
        holds.reports_releases = true;
        holds.press("RAPID", Hand::Keyboard, start);
        holds.press("X+", Hand::Keyboard, start + ms(300));
        let mut now = start + ms(900);
        for _ in 0..20 {
            now += ms(40);
            assert_eq!(holds.press("X+", Hand::Keyboard, now), None);
            assert_eq!(holds.tick(now), []);
        }
        assert_eq!(holds.release("X+"), release("X+").pop());
        // A release that was lost is made up for.
        assert_eq!(holds.tick(now + REPORTED), release("RAPID"));
    }

    #[test]
    fn what_the_mouse_holds_and_what_is_latched_stays() {
        let (mut holds, start) = (Holds::default(), Instant::now());
        holds.press("Z-", Hand::Mouse, start);
        assert_eq!(holds.latch("RAPID", start), press("RAPID"));
        let late = start + Duration::from_secs(60);
        assert_eq!(holds.tick(late), []);
        assert_eq!(holds.release_mouse(), release("Z-"));
        // The latch turns over once for each stroke, however often its key repeats.
        assert_eq!(holds.latch("RAPID", late), release("RAPID").pop());
        assert_eq!(holds.latch("RAPID", late + ms(500)), None);
        assert_eq!(holds.latch("RAPID", late + ms(540)), None);
        assert_eq!(holds.latch("RAPID", late + ms(540) + STROKE), press("RAPID"));
        assert_eq!(holds.release_hands(), []);
        assert_eq!(holds.release_all(), release("RAPID"));
    }
}
