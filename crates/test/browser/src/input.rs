//! Mouse, touch and keys.

use std::time::Duration;

use serde_json::json;

use crate::error::BrowserError;
use crate::keys::Key;
use crate::page::Page;

/// Pause between the steps of a movement, so that the page sees each.
const STEP: Duration = Duration::from_millis(4);

impl Page {
    /// Clicks with the left button on the middle of an element, which is scrolled into the window first.
    ///
    /// # Errors
    /// When there is no such element.
    pub fn click(&mut self, selector: &str) -> Result<(), BrowserError> {
        let at = self.middle(selector)?;
        self.click_at(at)
    }

    /// Clicks with the left button at a place.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn click_at(&mut self, at: [f64; 2]) -> Result<(), BrowserError> {
        self.mouse_move(at)?;
        self.mouse_down(at)?;
        self.mouse_up(at)
    }

    /// Moves the mouse without a button.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn mouse_move(&mut self, at: [f64; 2]) -> Result<(), BrowserError> {
        self.mouse("mouseMoved", at, "none", 0)
    }

    /// Presses the left button; it stays down.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn mouse_down(&mut self, at: [f64; 2]) -> Result<(), BrowserError> {
        self.mouse("mousePressed", at, "left", 1)
    }

    /// Releases the left button.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn mouse_up(&mut self, at: [f64; 2]) -> Result<(), BrowserError> {
        self.mouse("mouseReleased", at, "left", 0)
    }

    /// Drags with the left button from one place to another.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) -> Result<(), BrowserError> {
        self.mouse_move(from)?;
        self.mouse_down(from)?;
        for at in steps(from, to) {
            self.mouse("mouseMoved", at, "left", 1)?;
            std::thread::sleep(STEP);
        }
        self.mouse_up(to)
    }

    /// Turns the wheel; down is positive.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn wheel(&mut self, at: [f64; 2], down: f64) -> Result<(), BrowserError> {
        self.call(
            "Input.dispatchMouseEvent",
            json!({ "type": "mouseWheel", "x": at[0], "y": at[1], "deltaX": 0, "deltaY": down,
                    "modifiers": self.held }),
        )?;
        Ok(())
    }

    fn mouse(&mut self, kind: &str, at: [f64; 2], button: &str, buttons: u32) -> Result<(), BrowserError> {
        let clicks = u32::from(kind != "mouseMoved");
        self.call(
            "Input.dispatchMouseEvent",
            json!({ "type": kind, "x": at[0], "y": at[1], "button": button, "buttons": buttons,
                    "clickCount": clicks, "modifiers": self.held }),
        )?;
        Ok(())
    }

    /// Taps with a finger on the middle of an element.
    ///
    /// # Errors
    /// When there is no such element.
    pub fn tap(&mut self, selector: &str) -> Result<(), BrowserError> {
        let at = self.middle(selector)?;
        self.touch("touchStart", &[at])?;
        self.touch("touchEnd", &[])
    }

    /// Moves fingers over the page at the same time: each from one place to another.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn swipe(&mut self, fingers: &[[[f64; 2]; 2]]) -> Result<(), BrowserError> {
        let starts: Vec<[f64; 2]> = fingers.iter().map(|[from, _]| *from).collect();
        self.touch("touchStart", &starts)?;
        let paths: Vec<Vec<[f64; 2]>> = fingers
            .iter()
            .map(|[from, to]| steps(*from, *to).collect())
            .collect();
        for step in 0..STEPS {
            let now: Vec<[f64; 2]> = paths
                .iter()
                .filter_map(|steps| steps.get(step).copied())
                .collect();
            self.touch("touchMove", &now)?;
            std::thread::sleep(STEP);
        }
        self.touch("touchEnd", &[])
    }

    /// Puts fingers down (`touchStart`), moves them (`touchMove`) or lifts all (`touchEnd`).
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn touch(&mut self, kind: &str, at: &[[f64; 2]]) -> Result<(), BrowserError> {
        let points: Vec<_> = (0..)
            .zip(at)
            .map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id }))
            .collect();
        self.call(
            "Input.dispatchTouchEvent",
            json!({ "type": kind, "touchPoints": points }),
        )?;
        Ok(())
    }

    /// Presses a key and releases it, by its name in the browser (`Enter`, `ArrowLeft`, `a`); with others held down
    /// before it, as `Shift+Tab`.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn press(&mut self, keys: &str) -> Result<(), BrowserError> {
        // `+` alone is a key, too.
        let (held, key) = match keys.rsplit_once('+') {
            Some((held, key)) if !key.is_empty() => (held.split('+').collect(), key),
            _ => (Vec::new(), keys),
        };
        for held in &held {
            self.key_down(held)?;
        }
        self.key_down(key)?;
        self.key_up(key)?;
        for held in held.iter().rev() {
            self.key_up(held)?;
        }
        Ok(())
    }

    /// Presses a key, which stays down.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn key_down(&mut self, name: &str) -> Result<(), BrowserError> {
        let key = Key::named(name);
        self.held |= key.modifier();
        // With Control or Alt held a key types nothing.
        let types = !key.text.is_empty() && self.held & !8 == 0;
        self.call(
            "Input.dispatchKeyEvent",
            json!({ "type": if types { "keyDown" } else { "rawKeyDown" }, "key": key.key, "code": key.code,
                    "windowsVirtualKeyCode": key.number, "modifiers": self.held,
                    "text": if types { key.text.as_str() } else { "" } }),
        )?;
        Ok(())
    }

    /// Releases a key.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn key_up(&mut self, name: &str) -> Result<(), BrowserError> {
        let key = Key::named(name);
        self.held &= !key.modifier();
        self.call(
            "Input.dispatchKeyEvent",
            json!({ "type": "keyUp", "key": key.key, "code": key.code,
                    "windowsVirtualKeyCode": key.number, "modifiers": self.held }),
        )?;
        Ok(())
    }

    /// Types a text key by key.
    ///
    /// # Errors
    /// When the browser does not answer.
    pub fn type_text(&mut self, text: &str) -> Result<(), BrowserError> {
        for character in text.chars() {
            let name = match character {
                '\n' => "Enter".to_owned(),
                '\t' => "Tab".to_owned(),
                other => other.to_string(),
            };
            self.key_down(&name)?;
            self.key_up(&name)?;
        }
        Ok(())
    }
}

const STEPS: usize = 12;

/// The places of a straight movement after its first.
fn steps(from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    (1..=STEPS).map(move |step| {
        let t = step as f64 / STEPS as f64;
        [from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t]
    })
}
