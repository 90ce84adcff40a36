// The time line under the screen: dragging it goes back to any moment, where time stands; going on from there leads
// another way, and the old one is kept as a branch.

import { element, setText } from "/web/screen.js";
import { say, words } from "/web/texts.js";

/** Between two moments that are gone to while dragging: each is simulated anew. */
const DRAG_MS = 200;

let parts = null;
let now = 0;
let end = 0;
let marks = [];
let timer = 0;
let wanted = null;

export function build(send) {
  const node = document.querySelector('[data-region="timeline"]');
  const slider = Object.assign(element("input"), { type: "range", min: 0, max: 0, step: 0.01, value: 0 });
  say(slider, "Time line, seconds since power-on", "aria-label");
  const ticks = element("div", "ticks");
  ticks.setAttribute("aria-hidden", "true");
  const track = element("div", "track");
  track.append(ticks, slider);
  const shown = element("span", "moment");
  const events = list("Go to an event");
  const branches = list("Go to another way");
  const newest = button("Newest", () => send({ go_to: end }));
  const on = button("Go on", () => send({ pause: false }));
  node.append(track, shown, on, newest, events, branches);
  parts = { slider, ticks, shown, events, branches, newest, on };

  slider.addEventListener("input", () => {
    wanted = Number(slider.value);
    if (!timer) go();
  });
  const go = () => {
    timer = 0;
    if (wanted === null) return;
    send({ go_to: wanted });
    wanted = null;
    timer = setTimeout(go, DRAG_MS);
  };
  events.addEventListener("change", () => {
    if (events.value) send({ go_to: Number(events.value) });
    events.value = "";
  });
  branches.addEventListener("change", () => {
    const [branch, moment] = branches.value.split(" ").map(Number);
    if (branches.value) send({ go_to: moment, branch });
    branches.value = "";
  });
}

function button(text, act) {
  const made = element("button");
  say(made, text);
  made.type = "button";
  made.addEventListener("click", act);
  return made;
}

function list(title) {
  const made = element("select");
  say(made, title, "aria-label");
  made.append(new Option("", ""));
  say(made.options[0], title);
  return made;
}

/** Where time stands, and how far it was gone. */
export function time([, moment, last]) {
  [now, end] = [moment, Math.max(last, moment)];
  const { slider, shown, newest } = parts;
  const back = end - now > 0.05;
  // What is dragged is not moved away from under the finger.
  if (!timer) {
    slider.max = end;
    slider.value = now;
  }
  const within = words("{1} s of {2} s", now.toFixed(1), end.toFixed(1));
  slider.setAttribute("aria-valuetext", within);
  setText(shown, back ? within : `${now.toFixed(1)} s`);
  newest.disabled = !back;
  place();
}

/** Time stands. */
export function paused(stands) {
  parts.on.disabled = !stands;
}

/** What happened when, and the ways that were left. */
export function draw([happened, left]) {
  marks = happened;
  parts.ticks.replaceChildren(...marks.map((mark) => element("i", `tick-${mark.kind}`)));
  place();
  options(parts.events, marks.map((mark) => [`${mark.t.toFixed(1)} s  ${mark.text}`, String(mark.t)]));
  options(parts.branches, left.map((way) => [
    words("Way {1}: {2} s to {3} s", way.number, way.from_s.toFixed(1), way.to_s.toFixed(1)), `${way.number} ${way.to_s}`,
  ]));
  parts.branches.hidden = !left.length;
}

function options(select, entries) {
  select.replaceChildren(select.options[0], ...entries.map(([text, value]) => new Option(text, value)));
  select.value = "";
}

function place() {
  const ticks = parts.ticks.children;
  marks.forEach((mark, index) => {
    if (ticks[index]) ticks[index].style.left = `${end > 0 ? Math.min(100, (mark.t / end) * 100) : 0}%`;
  });
}
