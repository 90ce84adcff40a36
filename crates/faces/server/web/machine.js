// The machine operating panel: keys that are held, lamps, knobs, handwheel, EMERGENCY STOP, supply, and how fast time
// passes.

import { element, setText } from "/web/screen.js";
import { say, words } from "/web/texts.js";

const node = () => document.querySelector('[data-region="machine"]');

export function build(station, send) {
  const panel = node();
  const keys = element("div", "group machine-keys");
  keys.setAttribute("role", "group");
  say(keys, "Keys of the machine", "aria-label");
  for (const name of station.machine_keys) keys.append(heldKey(name, send));
  const stop = element("button", "key emergency");
  say(stop, "EMERGENCY STOP");
  stop.type = "button";
  stop.dataset.key = "EMERGENCY_STOP";
  stop.addEventListener("click", () => send({ key: "EMERGENCY_STOP" }));
  const knobs = element("div", "group knobs");
  knobs.append(
    knob("Feed override", "feed_override", send),
    knob("Spindle override", "spindle_override", send),
    handwheel(station, send),
  );
  const time = element("div", "group time");
  const power = element("button", "key power");
  say(power, "Power");
  power.type = "button";
  power.addEventListener("click", () => send({ power: power.getAttribute("aria-pressed") !== "true" }));
  const pause = element("button", "key pause");
  say(pause, "Pause");
  pause.type = "button";
  pause.addEventListener("click", () => send({ pause: pause.getAttribute("aria-pressed") !== "true" }));
  const cycle = element("button", "key cycle");
  say(cycle, "Cycle");
  cycle.type = "button";
  say(cycle, "One contour cycle, while time stands", "title");
  cycle.addEventListener("click", () => send({ cycles: 1 }));
  time.append(power, pause, cycle, speed(send));
  panel.append(stop, keys, knobs, time);
}

// A key is pressed as long as it is held: by pointer, or by the space bar and Enter.
function heldKey(name, send) {
  const button = element("button", "key", name.replaceAll("_", " "));
  button.type = "button";
  button.dataset.key = name;
  say(button, () => words("Machine key {1}", name.replaceAll("_", " ")), "aria-label");
  let held = false;
  const set = (down) => {
    if (held === down) return;
    held = down;
    button.classList.toggle("held", down);
    send({ key: name, down });
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    button.setPointerCapture(event.pointerId);
    set(true);
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(end, () => set(false));
  button.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    set(true);
  });
  button.addEventListener("keyup", (event) => {
    if (event.key === " " || event.key === "Enter") set(false);
  });
  // A click that no pointer made, as of a screen reader, is a tap.
  button.addEventListener("click", (event) => {
    if (event.detail === 0 && !held) send({ key: name });
  });
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  return button;
}

function said(tag, english) {
  const made = element(tag);
  say(made, english);
  return made;
}

function knob(title, field, send) {
  const label = element("label", "knob");
  const input = element("input");
  Object.assign(input, { type: "range", min: 0, max: 150, value: 100 });
  input.dataset.knob = field;
  input.addEventListener("input", () => send({ [field]: Number(input.value) }));
  label.append(said("span", title), input, element("output", "", "100 %"));
  return label;
}

function handwheel(station, send) {
  const group = element("div", "handwheel");
  const axis = element("select");
  say(axis, "Axis of the handwheel", "aria-label");
  axis.append(...[...station.axes].map((letter) => new Option(letter, letter)));
  const factor = element("select");
  say(factor, "Interpolation factor of the handwheel", "aria-label");
  factor.append(...Array.from({ length: 11 }, (_, value) => new Option(String(value), String(value), value === 3, value === 3)));
  const choose = () => send({ handwheel_axis: axis.value, factor: Number(factor.value) });
  axis.addEventListener("change", choose);
  factor.addEventListener("change", choose);
  const wheel = element("div", "wheel");
  for (const [text, steps, label] of [["⟲", -1000, "Turn the handwheel back"], ["⟳", 1000, "Turn the handwheel"]]) {
    const button = element("button", "key", text);
    button.type = "button";
    say(button, label, "aria-label");
    button.addEventListener("click", () => send({ handwheel: steps }));
    wheel.append(button);
  }
  wheel.addEventListener("wheel", (event) => {
    event.preventDefault();
    send({ handwheel: event.deltaY < 0 ? 250 : -250 });
  }, { passive: false });
  group.append(said("span", "Handwheel"), axis, factor, wheel);
  return group;
}

function speed(send) {
  const label = element("label", "speed");
  const select = element("select");
  select.append(...[0.1, 0.5, 1, 2, 5, 10, 50, 100].map((factor) => new Option(`${factor} ×`, String(factor), factor === 1, factor === 1)));
  select.addEventListener("change", () => send({ speed: Number(select.value) }));
  label.append(said("span", "Time"), select);
  return label;
}

export function draw([machine, lamps]) {
  const panel = node();
  const pressed = (selector, on) => panel.querySelector(selector)?.setAttribute("aria-pressed", String(on));
  pressed(".emergency", machine.emergency_stop);
  pressed(".power", machine.power);
  pressed(".pause", machine.paused);
  panel.querySelector(".cycle").disabled = !machine.paused;
  for (const button of panel.querySelectorAll(".machine-keys .key")) {
    button.classList.toggle("lit", lamps[button.dataset.key] === true);
  }
  for (const [place, field] of ["feed_override", "spindle_override"].entries()) {
    const input = panel.querySelector(`[data-knob="${field}"]`);
    if (document.activeElement !== input) input.value = machine.knobs[place];
    setText(input.nextElementSibling, `${Math.round(machine.knobs[place])} %`);
  }
  const select = panel.querySelector(".speed select");
  const factor = String(machine.speed);
  // A factor of the command line or of a program may be none of those that are offered.
  if (![...select.options].some((option) => option.value === factor)) select.append(new Option(`${factor} ×`, factor));
  if (document.activeElement !== select) select.value = factor;
}
