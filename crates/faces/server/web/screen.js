// Draws the regions of the screen. Only what has changed is touched, so that nothing flickers and a screen reader
// speaks what is new.

import { say, words } from "/web/texts.js";

const region = (name) => document.querySelector(`[data-region="${name}"]`);

/** A new element with classes and text. */
export function element(tag, classes = "", text = "") {
  const made = document.createElement(tag);
  if (classes) made.className = classes;
  if (text) made.textContent = text;
  return made;
}

/** Sets a text when it is another one. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Makes a node have so many children of a kind. */
function children(node, count, make) {
  while (node.children.length > count) node.lastElementChild.remove();
  while (node.children.length < count) node.append(make(node.children.length));
  return [...node.children];
}

export function header([mode, headings, messages], press) {
  document.title = mode ? `Bahn: ${mode}` : "Bahn";
  const head = region("header");
  const nodes = children(head.querySelector(".headings"), headings.length, () => {
    const button = element("button", "heading");
    button.type = "button";
    button.addEventListener("click", () => press(button.dataset.mode));
    return button;
  });
  headings.forEach((heading, place) => {
    nodes[place].dataset.mode = heading.key;
    nodes[place].setAttribute("aria-pressed", String(heading.active));
    setText(nodes[place], heading.title);
  });
  const lines = children(head.querySelector(".messages"), messages.length, () => element("div", "message"));
  messages.forEach((message, place) => {
    lines[place].classList.toggle("flashing", message.flashing);
    setText(lines[place], message.place ? `${message.place}  ${message.text}` : message.text);
  });
}

export function dialogue({ prompt, entry, open }) {
  const node = region("dialogue");
  node.classList.toggle("open", open);
  setText(node.querySelector(".prompt"), prompt);
  setText(node.querySelector(".entry"), entry);
}

export function program([front, beside], status) {
  drawWindow(region("program"), front, status);
  const other = region("beside");
  other.hidden = !beside;
  if (beside) drawWindow(other, beside, status);
}

function drawWindow(node, shown, status) {
  node.dataset.kind = shown.kind;
  let title = node.querySelector(":scope > .title");
  let lines = node.querySelector(":scope > .lines");
  if (!title) {
    title = element("div", "title");
    lines = element("ol", "lines");
    node.replaceChildren(title, lines);
  }
  setText(title, shown.title);
  title.hidden = !shown.title;
  if (shown.kind === "positions") {
    largePositions(lines, status);
    return;
  }
  const nodes = children(lines, shown.lines.length, () => element("li"));
  shown.lines.forEach((line, place) => drawLine(nodes[place], line));
  keepInSight(node, nodes[shown.lines.findIndex((line) => line.current)]);
  sizes.observe(node);
}

/** Graphics that open beside a program, or a window that is turned, leave its current line in sight. */
const sizes = new ResizeObserver((changed) => {
  for (const { target } of changed) keepInSight(target, target.querySelector("li.current"));
});

// A small window is scrolled to the current line, and nothing else moves.
function keepInSight(window, line) {
  if (!line) return;
  const [around, inside] = [window.getBoundingClientRect(), line.getBoundingClientRect()];
  if (inside.top < around.top) window.scrollTop += inside.top - around.top;
  else if (inside.bottom > around.bottom) window.scrollTop += inside.bottom - around.bottom;
}

function drawLine(node, line) {
  node.className = line.current ? "current" : "";
  if (line.current) node.setAttribute("aria-current", "true");
  else node.removeAttribute("aria-current");
  const marks = line.marks ?? [];
  if (!marks.length) {
    setText(node, line.text || "\u00a0");
    return;
  }
  const characters = [...line.text];
  const parts = [];
  let at = 0;
  for (const [from, to, kind] of marks) {
    parts.push(characters.slice(at, from).join(""));
    parts.push(element("mark", kind, characters.slice(from, to).join("") || "\u00a0"));
    at = to;
  }
  parts.push(characters.slice(at).join(""));
  node.replaceChildren(...parts);
}

function largePositions(lines, status) {
  const axes = status?.axes ?? [];
  // Lines of another kind of window may stand there.
  for (const line of [...lines.children]) if (!line.classList.contains("axis")) line.remove();
  const nodes = children(lines, axes.length, () => {
    const line = element("li", "axis");
    line.append(element("span", "star"), element("span", "letter"), element("span", "value"));
    return line;
  });
  axes.forEach((axis, place) => {
    nodes[place].className = axis.referenced ? "axis" : "axis unreferenced";
    const [star, letter, value] = nodes[place].children;
    setText(star, axis.handwheel ? "⊙" : "");
    setText(letter, axis.label);
    setText(value, axis.value);
  });
}

const ITEMS = [
  ["position", (status) => status.position_type + (status.inch ? " INCH" : "")],
  ["axes", () => ""],
  ["tool", (status) => `T ${status.tool}${status.tool_axis ? ` ${status.tool_axis}` : ""}`],
  ["speed", (status) => `S ${Math.round(status.s)}${status.gear ? `/${status.gear}` : ""}`],
  ["feed", (status) => `F ${status.f}`],
  ["functions", () => ""],
  ["flags", (status) => status.flags.join(" ")],
  ["star", (status) => (status.star === "off" ? "" : "*")],
  ["waiting", (status) => status.waiting],
];

export function drawStatus(status) {
  const node = region("status");
  const nodes = children(node, ITEMS.length + 2, (place) =>
    place < ITEMS.length ? element("span", ITEMS[place][0]) : bar(place === ITEMS.length ? "F" : "S"));
  ITEMS.forEach(([name, text], place) => {
    if (name === "axes") axes(nodes[place], status.axes);
    else if (name === "functions") functions(nodes[place], status);
    else setText(nodes[place], text(status));
    nodes[place].hidden = !nodes[place].textContent;
    if (name === "feed") nodes[place].classList.toggle("inverse", status.f_inverse);
    if (name === "tool") nodes[place].classList.toggle("inverse", status.t_inverse);
    if (name === "star") nodes[place].classList.toggle("blinking", status.star === "blinking");
  });
  const [feed, speed] = nodes.slice(ITEMS.length);
  setBar(feed, status.feed_mm_min, status.programmed_feed_mm_min, status.overrides[0]);
  setBar(speed, Math.abs(status.spindle_rpm), status.s, status.overrides[1]);
}

// A line breaks between axes, never within one.
function axes(node, shown) {
  const nodes = children(node, shown.length, () => element("span", "axis-value"));
  shown.forEach((axis, place) => setText(nodes[place], `${axis.handwheel ? "⊙" : ""}${axis.label.trim()} ${axis.value} `));
}

/** `M5/9`: the PLC shows the function of the spindle or that of the coolant inverse. */
function functions(node, status) {
  const parts = status.m ? status.m.split("/") : [];
  const nodes = children(node, parts.length, () => element("span"));
  parts.forEach((part, place) => {
    setText(nodes[place], (place ? "/" : "") + part);
    nodes[place].classList.toggle("inverse", status.m_inverse[place]);
  });
}

/** A bar ends at so many per cent of what was programmed. */
const BAR_MAX = 150;

function bar(name) {
  const node = element("label", "bar");
  const meter = element("meter");
  meter.max = BAR_MAX;
  // Where it is as fast as programmed.
  const scale = element("span", "scale");
  const mark = element("span", "hundred");
  mark.style.left = `${100 * 100 / BAR_MAX}%`;
  scale.append(meter, mark);
  say(meter, name === "F" ? "Feed, percent" : "Spindle speed, percent", "aria-label");
  node.append(element("span", "", name), scale, element("span", "percent"));
  return node;
}

// A bar is what is done of what was programmed, up to BAR_MAX.
function setBar(node, value, programmed, override) {
  const part = programmed > 0 ? (value / programmed) * 100 : 0;
  const meter = node.querySelector("meter");
  const rounded = Math.round(part);
  if (meter.value !== rounded) meter.value = rounded;
  setText(node.querySelector(".percent"), `${Math.round(override)} %`);
}

const COLOURS = 16;

export function plcWindow(lines) {
  const node = region("plc");
  node.hidden = !lines;
  if (!lines) return;
  const nodes = children(node, lines.length, () => element("div", "plc-line"));
  lines.forEach((line, place) => {
    const parts = [];
    if (line.bar) {
      const meter = element("meter", `colour-${line.bar[2] % COLOURS}`);
      [meter.max, meter.value] = line.bar;
      parts.push(meter);
    }
    for (let from = 0; from < line.text.length; ) {
      let to = from;
      while (to < line.text.length && line.colours[to] === line.colours[from]) to += 1;
      parts.push(element("span", `colour-${line.colours[from] % COLOURS}`, line.text.slice(from, to)));
      from = to;
    }
    nodes[place].replaceChildren(...parts);
  });
}

const VIEWS = {
  plan: "Plan view of the part", three_planes: "Projection of the part in three planes", solid: "3D view of the part",
  oscilloscope: "Curves of the oscilloscope", lines: "Contour of the program", figure: "Drawing of the cycle",
};
const picture = { wanted: 0, loading: 0 };

/** The part as the graphics show it: a picture is asked for when there is another one, and never two at once. */
export function graphics(shown) {
  const node = region("graphics");
  node.dataset.control = shown ? "shown" : "";
  // Curves are no part: they stand in the window whatever else is looked at.
  node.dataset.view = shown?.view ?? "";
  node.querySelector(".made").hidden = !shown;
  if (!shown) {
    picture.wanted = 0;
    return;
  }
  const image = node.querySelector("img");
  image.alt = words(VIEWS[shown.view]) + (shown.magn > 1 ? words(", magnified {1} times", shown.magn) : "");
  const bar = node.querySelector("progress");
  bar.hidden = !shown.running;
  bar.value = shown.progress;
  say(bar, shown.view === "oscilloscope" ? "Recording" : "Test run", "aria-label");
  const seconds = shown.machining_time_s;
  setText(node.querySelector(".time"), seconds === null ? "" : words("Machining time {1}", clock(seconds)));
  picture.wanted = shown.serial;
  loadPicture(node, image);
}

/** The operator looks at the part from every side, or at what the control shows of it. */
export function modern(on) {
  const node = region("graphics");
  node.dataset.modern = on ? "shown" : "";
  if (!on) loadPicture(node, node.querySelector("img"));
}

function loadPicture(node, image) {
  if ((node.dataset.modern && node.dataset.view !== "oscilloscope") || picture.loading || !picture.wanted || picture.wanted === Number(image.dataset.serial)) return;
  picture.loading = picture.wanted;
  const done = (loaded) => {
    image.dataset.serial = picture.loading;
    image.classList.toggle("empty", !loaded);
    picture.loading = 0;
    loadPicture(node, image);
  };
  image.onload = () => done(true);
  image.onerror = () => done(false);
  const sharp = Math.min(window.devicePixelRatio || 1, 2);
  const width = Math.round(Math.max(320, Math.min(node.clientWidth, 1200)) * sharp);
  image.src = `/api/graphics.png?width=${width}&height=${Math.round(width * 0.75)}&serial=${picture.wanted}`;
}

function clock(seconds) {
  const whole = Math.round(seconds);
  const two = (value) => String(value).padStart(2, "0");
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

export function softKeys({ keys, row, rows }, press) {
  const node = region("softkeys");
  if (!node.children.length) {
    const names = ["SK_LEFT", ...Array.from({ length: 8 }, (_, place) => `SK${place + 1}`), "SK_RIGHT"];
    for (const name of names) {
      const button = element("button", "key soft");
      button.type = "button";
      button.dataset.key = name;
      button.addEventListener("click", () => press(name));
      node.append(button);
    }
  }
  const nodes = [...node.children];
  const turns = rows > 1;
  for (const [button, text, label] of [[nodes[0], "◁", words("Soft-key row to the left")], [nodes[9], "▷", words("Soft-key row to the right")]]) {
    setText(button, text);
    button.setAttribute("aria-label", turns ? `${label}, ${words("row {1} of {2}", row + 1, rows)}` : label);
    button.disabled = !turns;
  }
  for (let place = 0; place < 8; place += 1) {
    const text = keys[place] ?? "";
    const button = nodes[place + 1];
    setText(button, text);
    button.setAttribute("aria-label", text ? words("Soft key {1}: {2}", place + 1, text) : words("Soft key {1}, empty", place + 1));
    button.disabled = !text;
  }
}
