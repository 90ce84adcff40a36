// Wires the page: regions from the station are drawn, keys are sent to it.

import { Connection } from "/web/connection.js";
import * as keyboard from "/web/keyboard.js";
import * as machine from "/web/machine.js";
import { PartWindow } from "/web/part.js";
import * as scheme from "/web/scheme.js";
import * as screen from "/web/screen.js";
import * as teacher from "/web/teacher.js";
import * as texts from "/web/texts.js";
import * as timeline from "/web/timeline.js";

const { words } = texts;

/** The newest of each region. */
const last = new Map();

/** What comes piece by piece, or once, is not drawn again. */
const PASSING = ["part", "refused"];

let status = null;
let windows = null;
let knobs = [100, 100];
let hasPart = true;

const draw = {
  time: timeline.time,
  header: (value) => {
    screen.header(value, press);
    scheme.side(value[1]);
  },
  dialogue: screen.dialogue,
  program: (value) => {
    windows = value;
    screen.program(value, status);
  },
  status: (value) => {
    status = value;
    screen.drawStatus(value);
    // Large positions stand in a window.
    if (windows) screen.program(windows, status);
  },
  plc: screen.plcWindow,
  graphics: screen.graphics,
  softkeys: (value) => screen.softKeys(value, press),
  machine: (value) => {
    machine.draw(value);
    timeline.paused(value[0].paused);
    knobs = value[0].knobs;
  },
  timeline: timeline.draw,
  why: teacher.why,
  lesson: teacher.lesson,
  look: (value) => {
    scheme.look(value);
    if (value.language !== texts.language) speak(value.language);
  },
  part: (news) => part.take(news),
  crew: crew,
  refused: (why) => line(words(why)),
};

const connection = await begin();
const part = new PartWindow(document.querySelector(".stage"), (looks) => {
  screen.modern(looks);
  connection.ask({ part: looks });
});

async function begin() {
  const [station] = await Promise.all([fetch("/api/station").then((answer) => answer.json()), texts.load()]);
  const send = (input) => connection.input(input);
  hasPart = station.has_part;
  leaveOut(station);
  keyboard.build(station, press, (key, down) => send({ key, down }));
  keyboard.help(station);
  keyboard.listen(station, press, (key, down) => send({ key, down }), turn);
  machine.build(station, send);
  timeline.build(send);
  teacher.build(send);
  return new Connection(
    (name, value) => {
      last.set(name, value);
      draw[name]?.(value);
    },
    (connected) => {
      line(connected ? "" : words("The station does not answer; it is asked again."));
      if (connected) part.connected();
    },
  );
}

/** What a panel has not is not shown. */
function leaveOut(station) {
  const parts = {
    has_past: '[data-region="timeline"]', has_teacher: '[data-region="teacher"], [data-tab="teacher"]', has_part: '[data-key="3D_VIEW"]',
  };
  document.body.classList.toggle("no-past", !station.has_past);
  for (const [name, selector] of Object.entries(parts)) {
    for (const node of document.querySelectorAll(selector)) node.hidden = !station[name];
  }
}

/** The control speaks another language, and so does what stands around its screen. */
async function speak(language) {
  await texts.load(language);
  for (const [name, value] of last) if (!PASSING.includes(name)) draw[name]?.(value);
  teacher.retell();
  part.retell();
}

function press(key) {
  // A key of the page.
  if (key === "3D_VIEW") return hasPart ? part.turnOn(!part.on) : undefined;
  connection.input({ key });
}

// A knob goes from 0 to 150 %.
function turn({ feed, spindle }) {
  const to = (knob, step) => Math.max(0, Math.min(150, knob + step));
  connection.input(feed ? { feed_override: to(knobs[0], feed) } : { spindle_override: to(knobs[1], spindle) });
}

scheme.build(() => part.tint());

for (const tab of document.querySelectorAll(".tabs [data-tab]")) {
  tab.addEventListener("click", () => {
    document.body.dataset.tab = tab.dataset.tab;
    for (const other of document.querySelectorAll(".tabs [data-tab]")) {
      other.setAttribute("aria-pressed", String(other === tab));
    }
  });
}

function line(text) {
  screen.setText(document.querySelector(".tabs .line"), text);
}

// One operates, the others look on: who wants the keys asks for them.
function crew({ may_operate, operates, asks }) {
  document.body.classList.toggle("looks-on", !operates);
  const node = document.querySelector(".tabs .line");
  if (operates && !asks) return line("");
  if (!may_operate) return line(words("You look on."));
  const buttons = operates
    ? [["Hand over", { hand_over: true }], ["No", { hand_over: false }]]
    : [["Operate", { operate: true }]];
  node.replaceChildren(
    words(operates ? "Somebody wants the keys." : "Somebody else operates."),
    ...buttons.map(([text, message]) => {
      const button = screen.element("button", "", words(text));
      button.type = "button";
      button.addEventListener("click", () => connection.ask(message));
      return button;
    }),
  );
}
