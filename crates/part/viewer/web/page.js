// The page of a run: its data, and what stands around the view.

import { fromBase64, inflate, readScene, History } from './codec.js';
import { PartView } from './view.js';
import { Overlay } from './overlay.js';
import { buttons } from './controls.js';
import { BlockList } from './list.js';

const find = selector => document.querySelector(selector);

// h:mm:ss, tenths below ten minutes.
function clock(seconds) {
  const pad = value => String(value).padStart(2, '0');
  const tenths = Math.round(seconds * 10);
  if (tenths < 6000) return `${Math.floor(tenths / 600)}:${pad(Math.floor(tenths / 10) % 60)}.${tenths % 10}`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 3600)}:${pad(Math.floor(whole / 60) % 60)}:${pad(whole % 60)}`;
}

const linear = colour => colour.map(value => (value / 255) ** 2.2);
const screen = colour => `rgb(${colour.join(' ')})`;

class Run {
  constructor(scene) {
    Object.assign(this, scene);
    const { head } = this;
    this.view = new PartView(find('.stage canvas'), { size: head.size, cells: head.cells });
    this.overlay = new Overlay(find('.stage svg'), this.view, head.axes);
    if (head.cells) this.history = new History(this.view.sheet, this.moments);
    this.view.markColours(head.marks.flatMap(({ marks, colours }) => marks.map((mark, k) => [mark, colours[k]])));
    this.view.path(this.path);
    this.tint();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.tint());
    this.rows = this.listing.map(text => text.replace(/^\s*\d+\s+/, ''));
    this.end = this.path.count ? this.path.times[this.path.count - 1] : 0;
    this.firstPoint = new Int32Array(this.rows.length).fill(-1);
    for (let k = this.path.count - 1; k >= 0; k--) if (this.path.rows[k] >= 0) this.firstPoint[this.path.rows[k]] = k;
    this.tell();
    this.list = new BlockList(find('#blocks'), this.rows, head.programs, (row, way) => this.goTo(row, way ?? 0));
    for (const remark of head.warnings) this.list.mark(remark.row, 'warning');
    if (head.error) this.list.mark(head.error.row, 'error');
    this.list.draw();
    this.controls = buttons(find('#viewer'), this.view, this.overlay, head);
    this.transport();
    this.tabs();
    this.seek(this.end);
  }

  // Colours that follow the scheme of the page.
  tint() {
    const style = getComputedStyle(document.documentElement);
    const colour = name => {
      const [r, g, b] = style.getPropertyValue(name).match(/[\da-f]{2}/gi).map(hex => parseInt(hex, 16) / 255);
      return [r, g, b];
    };
    const plain = colour('--path');
    const tools = this.head.tools.map(tool => (this.head.tools.length > 2 && tool.colour)
      ? tool.colour.map(value => value / 255) : plain);
    this.view.lineTints(tools, colour('--rapid'), colour('--edge'));
  }

  tell() {
    const { head } = this;
    document.title = head.title;
    find('#title').textContent = head.title;
    find('#model').textContent = head.model;
    const remarks = [...head.error ? [{ ...head.error, kind: 'error' }] : [],
      ...head.warnings.map(warning => ({ ...warning, kind: 'warning' }))];
    const result = find('#result');
    result.textContent = head.error ? 'Error' : head.warnings.length === 0 ? 'No warnings'
      : head.warnings.length === 1 ? '1 warning' : `${head.warnings.length} warnings`;
    result.className = head.error ? 'error' : head.warnings.length ? 'warning' : 'fine';
    find('#remarks').replaceChildren(...remarks.map(remark => this.remark(remark)));
    find('#facts').replaceChildren(...head.facts.flatMap(([name, value]) => {
      const [dt, dd] = [document.createElement('dt'), document.createElement('dd')];
      dt.textContent = name;
      dd.textContent = value;
      return [dt, dd];
    }));
    const used = new Set(this.path.tools);
    find('#tools').replaceChildren(...head.tools.flatMap((tool, k) => used.has(k) && tool.number !== null
      ? [this.legend(tool)] : []));
    const left = head.programs.some(program => program.rows < program.blocks);
    find('#note').textContent = [
      `Lines of the path keep within ${Number(head.tolerance.toPrecision(2))} mm of it.`,
      head.cells ? `The part has ${head.cells.join(' × ')} columns.` : 'The program has no BLK FORM, so there is no part.',
      left ? 'Not all blocks are listed.' : '',
    ].join(' ');
  }

  remark({ text, row, count, kind }) {
    const item = document.createElement('li');
    item.className = kind;
    const known = row !== null;
    const place = document.createElement(known ? 'button' : 'span');
    const times = count > 1 ? ` (${count} times)` : '';
    const program = known ? this.head.programs.findLast(({ first }) => first <= row) : null;
    place.textContent = (known ? `Block ${row - program.first}: ` : '') + text + times;
    if (known) place.addEventListener('click', () => this.goTo(row, 0));
    item.append(place);
    return item;
  }

  legend(tool) {
    const item = document.createElement('li');
    const swatch = document.createElement('i');
    if (tool.colour) swatch.style.background = screen(tool.colour);
    const round = value => Number(value.toFixed(3));
    const corner = tool.corner <= 0 ? '' : tool.corner >= tool.radius ? ', ball end' : `, R2 ${round(tool.corner)}`;
    const point = tool.point > 0 ? `, point ${round(tool.point)}°` : '';
    item.append(swatch, `T${tool.number}  R ${round(tool.radius)}${corner}${point}`);
    return item;
  }

  transport() {
    const slider = find('#slider');
    slider.max = this.end;
    slider.step = 'any';
    slider.addEventListener('input', () => this.seek(Number(slider.value)));
    slider.addEventListener('keydown', event => {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      const block = { PageUp: 1, PageDown: -1 }[event.key];
      if (event.key === 'Home') this.seek(0);
      else if (event.key === 'End') this.seek(this.end);
      else if (step) this.byElement(step);
      else if (block) this.byBlock(block);
      else return;
      event.preventDefault();
    });
    find('#previous').addEventListener('click', () => this.byBlock(-1));
    find('#next').addEventListener('click', () => this.byBlock(1));
  }

  // The point whose way contains a time.
  pointAt(time) {
    let low = 0, high = this.path.count - 1;
    while (low < high) {
      const middle = low + high >> 1;
      if (this.path.times[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // Shows the moment `time`, s; `point` says which of the points that are there at this time.
  seek(time, point = this.pointAt(time)) {
    this.time = Math.min(this.end, Math.max(0, time));
    const { path, head, view } = this;
    if (this.history) view.tilesChanged(this.history.show(this.time >= this.end ? Infinity : this.time));
    view.now = this.time;
    if (path.count) {
      this.point = point;
      const begin = point > 0 ? path.times[point - 1] : 0, length = path.times[point] - begin;
      const share = length > 0 ? Math.min(1, (this.time - begin) / length) : 1;
      const from = Math.max(0, point - 1);
      view.toolAt = [0, 1, 2].map(k => {
        const a = path.places[3 * from + k], b = path.places[3 * point + k];
        return path.kinds[point] === 3 ? b : a + (b - a) * share;
      });
      const tool = head.tools[path.tools[point]];
      view.tool.tint = linear(tool.colour ?? [190, 192, 196]);
      view.tool.take(tool.radius > 0 ? tool : null);
      this.tell_(path.rows[point], tool);
    }
    view.changed();
  }

  tell_(row, tool) {
    const slider = find('#slider');
    slider.value = this.time;
    const text = `${clock(this.time)} of ${clock(this.end)}`;
    find('#time').textContent = text;
    this.list.show(row);
    const block = row >= 0 ? this.rows[row] : '';
    find('#now').textContent = block;
    find('#spindle').textContent = tool.number === null ? '' : `T${tool.number}`;
    slider.setAttribute('aria-valuetext', `${text}, ${block}`);
  }

  // The end of the next element, or of the one before.
  byElement(step) {
    const { ends } = this.path;
    const at = step > 0 ? ends.find(point => point > this.point) : ends.findLast(point => point < this.point);
    if (at !== undefined) this.seek(this.path.times[at], at);
    else if (step < 0) this.seek(0);
  }

  // The end of the next block that is executed, or of the one before.
  byBlock(step) {
    const { rows, count, times } = this.path;
    let at = this.point;
    if (step > 0) {
      while (at + 1 < count && rows[at + 1] === rows[this.point]) at++;
      at = Math.min(at + 1, count - 1);
      while (at + 1 < count && rows[at + 1] === rows[at]) at++;
    } else {
      while (at > 0 && rows[at] === rows[this.point]) at--;
    }
    this.seek(times[at], at);
  }

  // A block of the list: where it is executed first; `way`: of the next one in this direction that is executed.
  goTo(row, way) {
    let at = row;
    while (way !== 0 && this.firstPoint[at] === -1 && at + way >= 0 && at + way < this.rows.length) at += way;
    let point = this.firstPoint[at];
    if (point === undefined || point === -1) return this.list.show(row);
    while (point + 1 < this.path.count && this.path.rows[point + 1] === at) point++;
    this.seek(this.path.times[point], point);
  }

  tabs() {
    const tabs = [...document.querySelectorAll('[role="tab"]')];
    const choose = tab => {
      for (const other of tabs) {
        other.setAttribute('aria-selected', String(other === tab));
        other.tabIndex = other === tab ? 0 : -1;
        document.getElementById(other.getAttribute('aria-controls')).hidden = other !== tab;
      }
    };
    tabs.forEach((tab, k) => {
      tab.addEventListener('click', () => choose(tab));
      tab.addEventListener('keydown', event => {
        if (event.key !== 'ArrowRight' && event.key !== 'ArrowLeft') return;
        const other = tabs[(k + (event.key === 'ArrowRight' ? 1 : tabs.length - 1)) % tabs.length];
        choose(other);
        other.focus();
      });
    });
    find('#result').addEventListener('click', () => choose(find('#tab-report')));
  }
}

async function start() {
  try {
    const data = await inflate(fromBase64(find('#data').textContent));
    globalThis.bahn = new Run(readScene(data));
  } catch (error) {
    const failed = find('#failed');
    failed.textContent = `The part cannot be shown: ${error.message}`;
    failed.hidden = false;
    throw error;
  }
}

start();
