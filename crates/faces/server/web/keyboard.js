// The keyboard of the control, and the real one.

import { element } from "/web/screen.js";
import { say, words } from "/web/texts.js";

/** Captions that differ from the names. */
const CAPTIONS = {
  POINT: ".", SIGN: "+/-", UP: "▲", DOWN: "▼", LEFT: "◀", RIGHT: "▶", R_PLUS: "R+", R_MINUS: "R−",
  COLON: ":", DOLLAR: "$", CLEARED: "--", BACK: "⌫",
  MANUAL: "Manual", HANDWHEEL: "Wheel", MDI: "MDI", SINGLE: "Single", FULL: "Full", PROGRAM: "Program", TEST: "Test",
};

/** Groups in the order in which they stand, and what they are called. */
const GROUPS = [
  ["mode", "Operating modes"], ["files", "Programs"], ["contour", "Path"], ["tool", "Tools"], ["cycle", "Cycles"],
  ["graphics", "Graphics"], ["axis", "Axes"], ["number", "Numbers"], ["value", "Values"], ["entry", "Entry"],
  ["cursor", "Cursor"], ["letter", "Letters"],
];

export function build(station, press, hold) {
  const node = document.querySelector('[data-region="keyboard"]');
  for (const [group, title] of GROUPS) {
    const keys = station.keys.filter((key) => key.group === group);
    if (!keys.length) continue;
    const block = element("div", `group ${group}`);
    block.setAttribute("role", "group");
    say(block, title, "aria-label");
    for (const key of keys) {
      const button = element("button", "key");
      // What is engraved is the same in every language.
      const caption = () => (CAPTIONS[key.name] ? words(CAPTIONS[key.name]) : spaced(key.name));
      button.type = "button";
      say(button, caption);
      button.dataset.key = key.name;
      // What stands on a key belongs to its name: somebody may say it to press it.
      say(button, () => `${caption()}: ${words(key.label)}`, "aria-label");
      say(button, key.label, "title");
      if (HELD.includes(key.name)) holds(button, (down) => hold(key.name, down));
      // What a pointer holds was pressed already.
      button.addEventListener("click", (event) => {
        if (event.detail === 0 || !HELD.includes(key.name)) press(key.name);
      });
      block.append(button);
    }
    node.append(block);
  }
}

/** Keys that are held: END, for the warm start. */
const HELD = ["END"];

/** A key goes down and comes up with the pointer. */
function holds(button, set) {
  let held = false;
  const change = (down) => {
    if (held === down) return;
    held = down;
    set(down);
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    button.setPointerCapture(event.pointerId);
    change(true);
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(end, () => change(false));
}

/** Keys that only this page has, on real keys that the table leaves free. */
const OWN = [{ real: "9", alt: true, key: "3D_VIEW" }];

/** What a key of a real keyboard does: a line of the table of the station, or a letter or digit that is itself. */
function meant(station, event) {
  if (event.ctrlKey || event.metaKey) return null;
  const real = event.key.toLowerCase();
  const line = [...station.shortcuts, ...OWN].find((line) => line.alt === event.altKey && line.real.toLowerCase() === real);
  if (line) return line;
  const itself = event.key.toUpperCase();
  return !event.altKey && /^[0-9a-z]$/.test(real) && hasKey(station, itself) ? { key: itself } : null;
}

/** Keys are pressed by `press`; those of the machine are held as long as the real ones, knobs are turned by `turn`. */
export function listen(station, press, hold, turn) {
  const held = new Map();
  const release = () => {
    for (const name of held.values()) hold(name, false);
    held.clear();
  };
  document.addEventListener("keydown", (event) => {
    // A view of the part that has the focus takes its own keys.
    if (event.defaultPrevented) return;
    const inField = event.target.closest("input, select, textarea, dialog[open]");
    // A button that has the focus is pressed by Enter, as everywhere.
    const onButton = event.target.closest("button") && (event.key === "Enter" || event.key === " ") && !event.altKey;
    if (inField || onButton) return;
    const line = meant(station, event);
    if (!line || (line.machine && !has(station, line.machine))) return;
    event.preventDefault();
    if (line.key) press(line.key);
    else if (line.machine === "EMERGENCY_STOP") {
      if (!event.repeat) press(line.machine);
    } else if (line.machine) {
      if (held.has(event.code)) return;
      held.set(event.code, line.machine);
      hold(line.machine, true);
    } else turn(line);
  });
  document.addEventListener("keyup", (event) => {
    const name = held.get(event.code);
    if (name) hold(name, false);
    held.delete(event.code);
    // Without Alt the key was another one.
    if (event.key === "Alt") release();
  });
  addEventListener("blur", release);
}

function has(station, name) {
  return name === "EMERGENCY_STOP" || station.machine_keys.includes(name);
}

function hasKey(station, name) {
  return station.keys.some((key) => key.name === name);
}

function spaced(name) {
  return name.replaceAll("_", " ");
}

/** `CYCL DEF: Cycle definition`. */
function named(station, name) {
  const key = station.keys.find((key) => key.name === name);
  return key && key.label !== spaced(name) ? `${spaced(name)}: ${words(key.label)}` : words(spaced(name));
}

export function help(station) {
  const dialog = document.querySelector("#help");
  const called = ({ key, machine, feed, spindle }) =>
    (key && named(station, key)) ?? (machine && words(spaced(machine))) ?? (feed ? words("feed override {1} %", signed(feed)) : words("spindle override {1} %", signed(spindle)));
  const table = () => [...station.shortcuts, ...OWN]
    .filter((line) => !line.machine || has(station, line.machine))
    .map((line) => [`${line.alt ? "Alt+" : ""}${line.real.length === 1 ? line.real.toUpperCase() : line.real}`, called(line)]);
  const fill = () => {
    const own = hasKey(station, "A") ? ["A to Z, 0 to 9", "letters and digits"] : ["0 to 9", "digits"];
    dialog.querySelector("tbody").replaceChildren(...[...table(), own.map((text) => words(text))].map(([real, key]) => {
      const row = element("tr");
      row.append(element("td", "", real), element("td", "", key));
      return row;
    }));
  };
  document.querySelector("#help-button").addEventListener("click", () => {
    fill();
    dialog.showModal();
    dialog.scrollTop = 0;
  });
}

function signed(number) {
  return number < 0 ? `−${-number}` : `+${number}`;
}
