// The keyboard of the control, and the real one.

import { element } from "/web/screen.js";

/** Captions that differ from the names. */
const CAPTIONS = {
  POINT: ".", SIGN: "+/-", UP: "▲", DOWN: "▼", LEFT: "◀", RIGHT: "▶", R_PLUS: "R+", R_MINUS: "R−",
  MANUAL: "Manual", HANDWHEEL: "Wheel", MDI: "MDI", SINGLE: "Single", FULL: "Full", PROGRAM: "Program", TEST: "Test",
};

/** Groups in the order in which they stand, and what they are called. */
const GROUPS = [
  ["mode", "Operating modes"], ["files", "Programs"], ["contour", "Path"], ["tool", "Tools"], ["cycle", "Cycles"],
  ["graphics", "Graphics"], ["axis", "Axes"], ["number", "Numbers"], ["value", "Values"], ["entry", "Entry"],
  ["cursor", "Cursor"], ["letter", "Letters"],
];

export function build(station, press) {
  const node = document.querySelector('[data-region="keyboard"]');
  for (const [group, title] of GROUPS) {
    const keys = station.keys.filter((key) => key.group === group);
    const block = element("div", `group ${group}`);
    block.setAttribute("role", "group");
    block.setAttribute("aria-label", title);
    for (const key of keys) {
      const button = element("button", "key", CAPTIONS[key.name] ?? key.name.replaceAll("_", " "));
      button.type = "button";
      button.dataset.key = key.name;
      // What stands on a key belongs to its name: somebody may say it to press it.
      button.setAttribute("aria-label", `${button.textContent}: ${key.label}`);
      button.title = key.label;
      button.addEventListener("click", () => press(key.name));
      block.append(button);
    }
    node.append(block);
  }
}

/** Keys of a real keyboard, without modifiers. */
const REAL = {
  Enter: "ENT", Backspace: "CE", Escape: "CE", Delete: "DEL", End: "END", Insert: "NO_ENT",
  ArrowUp: "UP", ArrowDown: "DOWN", ArrowLeft: "LEFT", ArrowRight: "RIGHT",
  PageUp: "SK_LEFT", PageDown: "SK_RIGHT", ".": "POINT", ",": "POINT", "-": "SIGN", "+": "SIGN",
  F1: "SK1", F2: "SK2", F3: "SK3", F4: "SK4", F5: "SK5", F6: "SK6", F7: "SK7", F8: "SK8",
};

/** With Alt. */
const ALT = {
  1: "MANUAL", 2: "HANDWHEEL", 3: "MDI", 4: "SINGLE", 5: "FULL", 6: "PROGRAM", 7: "TEST",
  n: "PGM_NR", d: "CYCL_DEF", c: "CYCL_CALL", t: "TOOL_CALL", f: "TOOL_DEF", l: "LBL_SET", k: "LBL_CALL", s: "STOP",
  g: "GOTO", m: "MOD", b: "BLK_FORM", a: "CAPTURE", r: "RND", x: "CR", y: "CT", z: "CC", p: "PGM_CALL", h: "HELP", v: "3D_VIEW",
};

/** The key of the control that a key of a real keyboard presses. */
export function keyOf(event) {
  if (event.ctrlKey || event.metaKey) return null;
  if (event.altKey) return ALT[event.key.toLowerCase()] ?? null;
  if (REAL[event.key]) return REAL[event.key];
  return /^[0-9a-zA-Z]$/.test(event.key) ? event.key.toUpperCase() : null;
}

export function listen(press) {
  document.addEventListener("keydown", (event) => {
    // A view of the part that has the focus takes its own keys.
    if (event.defaultPrevented) return;
    const inField = event.target.closest("input, select, textarea, dialog[open]");
    // A button that has the focus is pressed by Enter, as everywhere.
    const onButton = event.target.closest("button") && (event.key === "Enter" || event.key === " ");
    if (inField || onButton) return;
    const key = keyOf(event);
    if (!key) return;
    event.preventDefault();
    press(key);
  });
}

export function help() {
  const dialog = document.querySelector("#help");
  const rows = [
    ...Object.entries(REAL).map(([real, key]) => [real, key]),
    ...Object.entries(ALT).map(([real, key]) => [`Alt+${real.toUpperCase()}`, key]),
    ["A to Z, 0 to 9", "letters and digits"],
  ];
  dialog.querySelector("tbody").replaceChildren(...rows.map(([real, key]) => {
    const row = element("tr");
    row.append(element("td", "", real), element("td", "", key));
    return row;
  }));
  document.querySelector("#help-button").addEventListener("click", () => dialog.showModal());
}
