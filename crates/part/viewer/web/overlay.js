// What lies over the picture: the axes, a scale, and the points that are measured.

const SVG = 'http://www.w3.org/2000/svg';
const COLOURS = ['var(--axis-x)', 'var(--axis-y)', 'var(--axis-z)'];

const element = (name, attributes = {}, text) => {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
};

// A round length near another: 1, 2 or 5 times a power of ten.
export function roundLength(mm) {
  const decade = 10 ** Math.floor(Math.log10(mm));
  return [5, 2, 1].find(factor => factor * decade <= mm) * decade;
}

export class Overlay {
  constructor(svg, view, axes) {
    this.svg = svg;
    this.view = view;
    this.axes = axes;
    this.points = [];
    this.cross = false;
    view.onFrame(() => this.draw());
  }

  draw() {
    const { svg, view: { camera } } = this;
    const [w, h] = camera.window;
    svg.setAttribute('viewBox', `0 0 ${w} ${h}`);
    svg.replaceChildren(...this.triad(46, h - 46), ...this.scale(w, h), ...this.measured(), ...this.crosshair(w, h));
  }

  triad(x, y) {
    const { right, up, forward } = this.view.camera.basis();
    const order = [0, 1, 2].sort((a, b) => forward[b] - forward[a]);
    return order.flatMap(k => {
      const tip = [x + 26 * right[k], y - 26 * up[k]], name = [x + 36 * right[k], y - 36 * up[k]];
      return [
        element('line', { x1: x, y1: y, x2: tip[0], y2: tip[1], stroke: COLOURS[k], class: 'axis' }),
        element('text', { x: name[0], y: name[1], fill: COLOURS[k], class: 'name' }, this.axes[k]),
      ];
    });
  }

  scale(w, h) {
    const { mm } = this.view.camera;
    const length = roundLength(Math.min(160, w / 4) * mm), pixels = length / mm;
    const right = w - 18, y = h - 18;
    return [
      element('path', { d: `M${right - pixels} ${y - 5}v5h${pixels}v-5`, class: 'scale' }),
      element('text', { x: right - pixels / 2, y: y - 9, class: 'label' }, `${Number(length.toPrecision(1))} mm`),
    ];
  }

  measured() {
    const at = this.points.map(point => this.view.camera.project(point));
    const marks = at.map(([x, y]) => element('circle', { cx: x, cy: y, r: 5, class: 'point' }));
    if (at.length < 2) return marks;
    const [[x1, y1], [x2, y2]] = at;
    return [element('line', { x1, y1, x2, y2, class: 'distance' }), ...marks];
  }

  // Where Enter picks.
  crosshair(w, h) {
    if (!this.cross) return [];
    return [element('path', { d: `M${w / 2 - 12} ${h / 2}h24M${w / 2} ${h / 2 - 12}v24`, class: 'cross' })];
  }
}
