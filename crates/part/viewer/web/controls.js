// Mouse, touch and keys on a view, and its buttons.

import { COLOURINGS } from './view.js';

// Degrees for a pixel, and for a key.
const TURN = 0.45, KEY_TURN = 7.5;
const CLICK_PX = 4;

// Turns by one pointer, moves by two or with Shift or another button, zooms by wheel or two fingers.
export function handle(view, onPick) {
  const { canvas, camera } = view;
  const down = new Map();
  let way = 0;
  const place = event => {
    const { left, top } = canvas.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  canvas.addEventListener('pointerdown', event => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, place(event));
    if (down.size === 1) way = 0;
    else way = Infinity;
  });
  canvas.addEventListener('pointermove', event => {
    const before = down.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    way += Math.hypot(dx, dy);
    if (down.size === 2) {
      const other = [...down.entries()].find(([id]) => id !== event.pointerId)[1];
      const span = at => Math.max(8, Math.hypot(at[0] - other[0], at[1] - other[1]));
      camera.zoom(span(now) / span(before), [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]);
      camera.pan(dx / 2, dy / 2);
    } else if (way > CLICK_PX) {
      if (event.shiftKey || event.buttons & 6) camera.pan(dx, dy);
      else camera.rotate(dx * TURN, dy * TURN);
    }
    down.set(event.pointerId, now);
    view.changed();
  });
  const up = event => {
    if (!down.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && way <= CLICK_PX && event.button === 0) onPick(...place(event));
  };
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    camera.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), place(event));
    view.changed();
  }, { passive: false });
  keys(view, onPick);
}

function keys(view, onPick) {
  const { canvas, camera } = view;
  canvas.addEventListener('keydown', event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (arrow && event.shiftKey) camera.pan(24 * arrow[0], 24 * arrow[1]);
    else if (arrow) camera.rotate(KEY_TURN * arrow[0], KEY_TURN * arrow[1]);
    else if (event.key === '+' || event.key === '=') camera.zoom(1.25);
    else if (event.key === '-') camera.zoom(0.8);
    else if (event.key === '0' || event.key === 'Home') camera.reset();
    else if (['1', '2', '3', '4'].includes(event.key)) camera.stand(['iso', 'top', 'front', 'right'][event.key - 1]);
    else if (event.key === 'Enter') onPick(...camera.window.map(side => side / 2));
    else return;
    event.preventDefault();
    view.changed();
  });
}

const format = mm => mm.toLocaleString('en', { minimumFractionDigits: 3, maximumFractionDigits: 3, useGrouping: false });

const english = (text, ...values) => text.replace(/\{(\d)\}/g, (_, place) => values[place - 1]);

// The buttons in `root`, found by their data-* names; `frame`: axes and least coordinates; `words` says a text in the
// language of the page.
export function buttons(root, view, overlay, frame, words = english) {
  const find = name => root.querySelector(`[data-control="${name}"]`);
  const readout = root.querySelector('[data-readout]');
  const toggle = (button, on) => button.setAttribute('aria-pressed', String(on));
  for (const button of root.querySelectorAll('[data-view]')) {
    button.addEventListener('click', () => {
      view.camera.stand(button.dataset.view);
      view.changed();
    });
  }
  for (const button of root.querySelectorAll('[data-show]')) {
    button.addEventListener('click', () => {
      view.show[button.dataset.show] = !view.show[button.dataset.show];
      toggle(button, view.show[button.dataset.show]);
      view.changed();
    });
  }
  const colours = find('colours');
  colours.addEventListener('change', () => {
    view.colouring = COLOURINGS.indexOf(colours.value);
    root.dataset.colours = colours.value;
    view.changed();
  });
  const section = sections(root, view, frame, words);
  const measure = measuring(find('measure'), readout, view, overlay, frame, words);
  find('reset').addEventListener('click', () => {
    view.camera.reset();
    section.reset();
    measure.reset();
    for (const button of root.querySelectorAll('[data-show]')) {
      view.show[button.dataset.show] = true;
      toggle(button, true);
    }
    colours.value = 'material';
    colours.dispatchEvent(new Event('change'));
  });
  handle(view, measure.pick);
  // In another language.
  const retell = () => {
    section.retell();
    measure.retell();
  };
  return { measure, section, retell };
}

function sections(root, view, frame, words) {
  const axis = root.querySelector('[data-control="section"]');
  const place = root.querySelector('[data-control="place"]');
  const flip = root.querySelector('[data-control="flip"]');
  const shown = root.querySelector('[data-place]');
  const name = k => frame.axes[k];
  const retell = () => {
    for (const option of axis.options) if (option.value !== '') option.textContent = words('Section {1}', name(option.value));
  };
  retell();
  let keep = 1;
  const apply = () => {
    const k = axis.value === '' ? null : Number(axis.value);
    root.dataset.section = axis.value;
    if (k !== null) shown.textContent = `${name(k)} ${format(frame.min[k] + Number(place.value))}`;
    place.setAttribute('aria-valuetext', shown.textContent);
    view.section(k, Number(place.value), keep);
  };
  const choose = () => {
    const k = Number(axis.value);
    place.max = view.size[k];
    place.step = view.size[k] / 400;
    place.value = view.size[k] / 2;
    // What is nearer to the eye is taken away.
    keep = k === 1 ? 1 : -1;
    apply();
  };
  axis.addEventListener('change', choose);
  place.addEventListener('input', apply);
  flip.addEventListener('click', () => {
    keep = -keep;
    apply();
  });
  return {
    reset() {
      axis.value = '';
      apply();
    },
    retell,
  };
}

function measuring(button, readout, view, overlay, frame, words) {
  let on = false;
  const say = text => {
    readout.textContent = text;
    readout.hidden = text === '';
  };
  const coordinates = point => point.map((value, k) => `${frame.axes[k]} ${format(value + frame.min[k])}`).join('  ');
  const description = () => {
    const { points } = overlay;
    if (points.length === 0) return words('Pick a point of the part.');
    if (points.length === 1) return words('{1}. Pick another point.', coordinates(points[0]));
    const off = points[1].map((value, k) => value - points[0][k]);
    const parts = off.map((value, k) => `Δ${frame.axes[k]} ${format(value)}`).join('  ');
    return `${format(Math.hypot(...off))} mm   ${parts}`;
  };
  const set = state => {
    on = state;
    overlay.points = [];
    overlay.cross = on;
    button.setAttribute('aria-pressed', String(on));
    view.canvas.classList.toggle('picking', on);
    say(on ? description() : '');
    view.changed();
  };
  button.addEventListener('click', () => set(!on));
  return {
    pick(x, y) {
      if (!on) return;
      const point = view.pick(x, y);
      if (!point) return say(words('There is no material. Pick a point of the part.'));
      if (overlay.points.length === 2) overlay.points = [];
      overlay.points.push(point);
      say(description());
      view.changed();
    },
    reset: () => set(false),
    retell: () => say(on ? description() : ''),
  };
}
