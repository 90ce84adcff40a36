// A part on a canvas. Whoever has one says what is to be seen; it draws when something has changed, and never else.

import { Camera } from './camera.js';
import { Sheet, readTiles, WHOLE } from './codec.js';
import { Relief } from './relief.js';
import { Lines } from './lines.js';
import { Tool } from './tool.js';

// While something moves, a picture may take so long, ms: 60 a second; it gets coarser until it does.
const FRAME = 16.7;
// Finest and coarsest picture as pixels for a CSS pixel, and the most pixels of a picture.
const FINEST = 2, COARSEST = 0.25, MOST_PIXELS = 9e6;
// Quiet for so long, ms: the fine picture is drawn, which may take so long.
const REST = 160, RESTING = 250;

export const COLOURINGS = ['material', 'tool', 'depth'];

export class PartView {
  // `blank`: size in mm, and cells (null: there is no part, only the path).
  constructor(canvas, blank) {
    this.canvas = canvas;
    const gl = canvas.getContext('webgl2', { antialias: false, alpha: true, premultipliedAlpha: true });
    if (!gl) throw new Error('This browser has no WebGL 2.');
    this.gl = gl;
    this.size = blank.size;
    this.camera = new Camera(blank.size);
    this.clip = [[0, 0, 0], [...blank.size]];
    this.colouring = 0;
    this.show = { part: true, path: true, tool: true, box: true };
    this.now = Infinity;
    this.toolAt = null;
    this.listeners = [];
    this.coarse = 1;
    // The picture at rest is no coarser, however slow the graphics are.
    this.floor = 0.5;
    this.frames = 0;
    this.blank = blank;
    this.build();
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.build());
    new ResizeObserver(() => this.changed()).observe(canvas);
  }

  // All that lies on the graphics card; again when it forgot everything.
  build() {
    const { gl, blank } = this;
    if (blank.cells) {
      this.sheet ??= new Sheet(blank.cells);
      this.relief = new Relief(gl, this.sheet, blank.size);
      if (this.marks) this.relief.colours(this.marks);
    }
    this.lines = Object.assign(new Lines(gl), this.lineColours);
    this.lines.edges(blank.size);
    if (this.drawnPath) this.lines.path(this.drawnPath);
    const shape = this.tool?.shape;
    this.tool = new Tool(gl);
    this.tool.take(shape ?? null);
    this.changed();
  }

  // Bytes of changed tiles, as the server sends them.
  tiles(bytes) {
    const tiles = readTiles(bytes);
    for (const [tile, data] of tiles) this.sheet.take(tile, data);
    this.tilesChanged(tiles.map(([tile]) => tile));
  }

  // The untouched blank again.
  whole() {
    const { sheet } = this;
    const all = Array.from({ length: sheet.tiles }, (_, tile) => tile);
    for (const tile of all) sheet.fill(tile, WHOLE, 0);
    this.tilesChanged(all);
  }

  tilesChanged(tiles) {
    if (tiles.length === 0) return;
    this.relief.update(tiles);
    this.changed();
  }

  // Red, green and blue for each mark of a cell.
  markColours(marks) {
    this.marks = new Uint8Array(256 * 4).fill(255);
    for (const [mark, colour] of marks) this.marks.set(colour, 4 * mark);
    this.relief?.colours(this.marks);
    this.changed();
  }

  // The path; from a point on it is another one than before.
  path(path, from = 0) {
    this.drawnPath = path;
    this.lines.path(path, from);
    this.changed();
  }

  // Colours of lines, 0 to 1: of tools by their number in the path, of rapid traverse, of the edges of the blank.
  lineTints(tools, rapid, box) {
    const colours = new Float32Array(64 * 4).fill(1);
    tools.forEach((colour, k) => colours.set([...colour, 1], 4 * k));
    this.lineColours = { colours, rapid: [...rapid, 1], box: [...box, 1] };
    Object.assign(this.lines, this.lineColours);
    this.changed();
  }

  // What is behind a plane is shown: `axis` 0 to 2, `at` in mm, `keep` the side that stays (-1 below, 1 above).
  section(axis, at, keep) {
    this.clip = [[0, 0, 0], [...this.size]];
    if (axis !== null) this.clip[keep < 0 ? 1 : 0][axis] = Math.min(this.size[axis], Math.max(0, at));
    this.changed();
  }

  // The point of the part under a CSS pixel of the canvas, mm from the corner of the blank; or null.
  pick(x, y) {
    if (!this.relief || !this.show.part) return null;
    return this.relief.pick(this.camera.ray(x, y), this.clip);
  }

  // Draws soon.
  changed() {
    this.touched = performance.now();
    this.dirty = true;
    this.asked ??= requestAnimationFrame(time => this.frame(time));
  }

  // Is called after every picture.
  onFrame(listener) {
    this.listeners.push(listener);
  }

  frame(time) {
    this.asked = null;
    if (this.cost === undefined) {
      this.cost = null;
      this.calibrate();
    }
    if (this.cost === null) return;
    // A change that waited long for its picture is a change all the same.
    const quiet = this.frames === 0 || !this.dirty && performance.now() - this.touched > REST;
    if (this.dirty && this.steady) this.judge(time - this.last);
    this.steady = this.dirty && !quiet;
    this.last = time;
    const ratio = quiet ? this.finest() : this.dirty ? Math.min(this.coarse * devicePixelRatio, this.finest()) : this.drawn;
    const dirty = this.dirty;
    this.dirty = false;
    if (this.fitCanvas(ratio) || dirty || this.drawn !== ratio) this.draw(ratio);
    // The fine picture comes after the last change.
    if (!quiet) this.asked ??= requestAnimationFrame(next => this.frame(next));
  }

  // How long a picture takes, by a small one: ms for a pixel. One before it compiles the shaders.
  async calibrate() {
    const { canvas, show } = this;
    let cost = 0;
    // The path costs what it costs, however coarse the picture is.
    this.show = { part: true };
    canvas.style.visibility = 'hidden';
    for (const ratio of [0.05, 0.3]) {
      this.fitCanvas(ratio);
      const start = performance.now();
      this.draw(ratio);
      await this.drawnNow();
      cost = (performance.now() - start) / (canvas.width * canvas.height);
    }
    this.cost = cost;
    this.show = show;
    this.coarse = Math.min(1, Math.max(COARSEST, this.ratioFor(0.7 * FRAME) / devicePixelRatio));
    this.frames = 0;
    canvas.style.visibility = '';
    this.changed();
  }

  // Resolves when the graphics card has drawn everything. It is not waited for with the page standing still.
  drawnNow() {
    const { gl } = this;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise(resolve => {
      const look = () => {
        if (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) return setTimeout(look, 1);
        gl.deleteSync(fence);
        resolve();
      };
      look();
    });
  }

  // Pixels for a CSS pixel of a picture that takes so long.
  ratioFor(ms) {
    return Math.sqrt(ms / this.cost / Math.max(1, this.canvas.clientWidth * this.canvas.clientHeight));
  }

  // A picture was too slow, or there is time to spare.
  judge(ms) {
    if (!(ms > 0) || ms > 2000) return;
    this.mean = 0.7 * (this.mean ?? ms) + 0.3 * ms;
    this.spare = this.mean < 1.15 * FRAME ? (this.spare ?? 0) + 1 : 0;
    if (this.mean > 1.35 * FRAME && this.coarse > COARSEST) {
      this.coarse = Math.max(COARSEST, this.coarse * (this.mean > 4 * FRAME ? 0.5 : 0.8));
      this.mean = FRAME;
    } else if (this.spare > 40 && this.coarse < 1) {
      this.coarse = Math.min(1, this.coarse * 1.25);
      this.spare = 0;
    }
  }

  // A picture at rest may take its time, but not long.
  finest() {
    const area = Math.max(1, this.canvas.clientWidth * this.canvas.clientHeight);
    const most = Math.min(Math.max(FINEST, devicePixelRatio), Math.sqrt(MOST_PIXELS / area));
    return Math.min(most, Math.max(this.floor, this.ratioFor(RESTING)));
  }

  // Nothing is left to be drawn.
  get settled() {
    return this.cost > 0 && !this.dirty && !this.asked && this.drawn === this.finest();
  }

  fitCanvas(ratio) {
    const { canvas, camera } = this;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    const size = [Math.max(1, Math.round(w * ratio)), Math.max(1, Math.round(h * ratio))];
    const resized = canvas.width !== size[0] || canvas.height !== size[1];
    if (resized) [canvas.width, canvas.height] = size;
    if (camera.window[0] !== w || camera.window[1] !== h) camera.resize(w, h);
    return resized;
  }

  draw(ratio) {
    const { gl, canvas, camera } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clearDepth(1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (this.relief && this.show.part) this.relief.draw(camera, this.clip, this.colouring, ratio);
    this.lines.draw(camera, this.show, this.now, ratio, ratio >= Math.min(1, this.floor));
    if (this.show.tool && this.toolAt) this.tool.draw(camera, this.toolAt);
    this.drawn = ratio;
    this.frames++;
    for (const listener of this.listeners) listener();
  }
}
