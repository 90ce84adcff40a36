// Lessons, and the teacher's drawer: what of the machine can be broken.

import { element, setText } from "/web/screen.js";
import { say, words } from "/web/texts.js";

const NO_LESSONS = "This machine has no lessons.";

/** What fetches again what it shows. */
const fetched = [];
let line = null;
let hints = 0;
let draw = () => {};

export function build(send) {
  const node = document.querySelector('[data-region="teacher"]');
  node.append(lessons(send), drawer(send));
}

function button(text, act, classes = "") {
  const made = element("button", classes);
  say(made, text);
  made.type = "button";
  made.addEventListener("click", act);
  return made;
}

function fold(title, name, opened) {
  const made = element("details", name);
  const summary = element("summary");
  say(summary, title);
  made.append(summary);
  made.addEventListener("toggle", () => made.open && opened());
  // What it shows is in another language then.
  fetched.push(() => made.open && opened());
  return made;
}

function labelled(text, field) {
  const made = element("label");
  const name = element("span");
  say(name, text);
  made.append(name, field);
  return made;
}

function lessons(send) {
  const select = element("select");
  const begin = button("Begin", () => send({ lesson: select.value }));
  const nothing = element("p");
  say(nothing, NO_LESSONS);
  const choose = element("div", "choose");
  choose.append(labelled("Lesson", select), begin);
  const task = element("div", "lesson");
  const node = fold("Lessons", "lessons", async () => {
    const found = await (await fetch("/api/lessons")).json();
    const known = Array.isArray(found) ? found : [];
    select.replaceChildren(...known.map(({ name, title }) => new Option(title, name)));
    choose.hidden = !known.length;
    say(nothing, found.error ?? NO_LESSONS);
    nothing.hidden = known.length > 0;
  });
  choose.hidden = true;
  node.append(choose, nothing, task);
  draw = () => {
    if (!line) return task.replaceChildren();
    node.open = true;
    task.replaceChildren(...shown(send));
  };
  return node;
}

// A lesson changes seldom: it is drawn anew.
function shown(send) {
  const done = line.checks.filter((check) => check.done).length;
  const states = {
    running: words("{1} of {2} done", done, line.checks.length), passed: words("Passed"), failed: words("Not passed. {1}", line.reason),
  };
  const state = element("p", `state ${line.state}`, states[line.state]);
  state.setAttribute("role", "status");
  const checks = element("ol", "checks");
  for (const check of line.checks) {
    const item = element("li", check.done ? "done" : "", check.text);
    item.append(element("span", "sign", check.done ? ` ✓ ${words("done")}` : ` ${words("open")}`));
    checks.append(item);
  }
  const given = element("ul", "hints");
  given.append(...line.hints.slice(0, hints).map((hint) => element("li", "", hint)));
  const buttons = element("div", "choose");
  if (line.state === "running") {
    if (hints < line.hints.length) {
      buttons.append(button(() => words("Hint {1} of {2}", hints + 1, line.hints.length), () => {
        hints += 1;
        draw();
      }, "hint"));
    }
    buttons.append(button("I am done", () => send({ hand_in: true }), "hand-in"));
  }
  buttons.append(button("End the lesson", () => send({ lesson: "" }), "end"));
  return [element("h2", "", line.title), element("p", "task", line.task), checks, given, state, buttons];
}

/** The lesson that goes on. */
export function lesson(value) {
  if (value?.name !== line?.name) hints = 0;
  line = value;
  draw();
}

function drawer(send) {
  const things = element("select", "things");
  const ways = element("select", "ways");
  let known = [];
  const thing = () => known[Number(things.value)];
  const choose = () => ways.replaceChildren(...(thing()?.faults ?? []).map((way) => new Option(way.words, way.action)));
  things.addEventListener("change", choose);
  const buttons = element("div", "choose");
  buttons.append(
    button("Break", () => ways.value && send({ action: ways.value }), "break"),
    button("Repair", () => thing() && send({ action: thing().repair }), "repair"),
  );
  const node = fold("Teacher's drawer", "drawer", async () => {
    const chosen = things.value;
    known = await (await fetch("/api/drawer")).json();
    const groups = new Map();
    known.forEach((entry, place) => {
      if (!groups.has(entry.group)) groups.set(entry.group, Object.assign(element("optgroup"), { label: entry.group }));
      groups.get(entry.group).append(new Option(`${entry.name}: ${entry.words}`, String(place)));
    });
    things.replaceChildren(...groups.values());
    if (chosen) things.value = chosen;
    choose();
  });
  node.append(labelled("What", things), labelled("How", ways), buttons);
  return node;
}

/** Another language: what the station says is fetched again. */
export function retell() {
  for (const again of fetched) again();
}

/** Why the machine stands. */
export function why(reasons) {
  const node = document.querySelector('[data-region="why"] ul');
  node.replaceChildren(...reasons.map((reason) => element("li", "", reason)));
}
