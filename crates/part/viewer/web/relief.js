// The part on the graphics card: its height map with the greatest height of ever larger squares above it.

import { program, RELIEF_VERTEX, RELIEF_FRAGMENT } from './shaders.js';

// Squares of 64 cells are the largest: a tile is a square of each level.
const LEVELS = 7;
const WHOLE_STEPS = 65535;
// With more tiles than this the whole map is sent at once.
const FEW = 24;

export class Relief {
  // `size` of the blank in mm.
  constructor(gl, sheet, size) {
    this.gl = gl;
    this.sheet = sheet;
    this.size = size;
    this.shader = program(gl, RELIEF_VERTEX, RELIEF_FRAGMENT);
    this.nothing = gl.createVertexArray();
    const side = sheet.columns.map(count => Math.ceil(count / 64) * 64);
    this.levels = Array.from({ length: LEVELS }, (_, level) => {
      const [w, h] = side.map(count => count >> level);
      return { w, h, heights: level === 0 ? null : new Uint16Array(w * h) };
    });
    const format = (texture, levels, kind) => {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, levels, kind, side[0], side[1]);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.NEAREST_MIPMAP_NEAREST : gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    };
    this.heights = gl.createTexture();
    this.marks = gl.createTexture();
    this.palette = gl.createTexture();
    format(this.heights, LEVELS, gl.R16UI);
    format(this.marks, 1, gl.R8UI);
    this.colours(new Uint8Array(256 * 4));
    this.update(null);
  }

  // Red, green, blue, 255 for each of the 256 marks.
  colours(bytes) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.palette);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  // Takes over tiles of the sheet that changed; all of them without a list.
  update(tiles) {
    const { sheet, gl } = this;
    const few = tiles && tiles.length <= FEW;
    const list = tiles ?? Array.from({ length: sheet.tiles }, (_, tile) => tile);
    for (const tile of list) this.raise(sheet.place(tile));
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    if (few) {
      for (const tile of list) this.send(sheet.place(tile));
    } else if (list.length > 0) {
      const [w, h] = sheet.columns;
      this.send({ x: 0, y: 0, w, h });
    }
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, 0);
  }

  // The greatest heights above a tile.
  raise({ x, y, w, h }) {
    let below = this.sheet.heights, stride = this.sheet.columns[0], [limitX, limitY] = this.sheet.columns;
    for (let level = 1; level < LEVELS; level++) {
      const { heights, w: width } = this.levels[level];
      const fromX = x >> level, fromY = y >> level;
      const toX = (x + w - 1 >> level) + 1, toY = (y + h - 1 >> level) + 1;
      for (let j = fromY; j < toY; j++) {
        const row = 2 * j * stride, next = 2 * j + 1 < limitY ? row + stride : row;
        for (let i = fromX; i < toX; i++) {
          const a = 2 * i, b = 2 * i + 1 < limitX ? a + 1 : a;
          heights[j * width + i] = Math.max(below[row + a], below[row + b], below[next + a], below[next + b]);
        }
      }
      below = heights;
      stride = limitX = width;
      limitY = this.levels[level].h;
    }
  }

  send({ x, y, w, h }) {
    const { gl, sheet } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.marks);
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, sheet.columns[0]);
    const first = y * sheet.columns[0] + x;
    gl.texSubImage2D(gl.TEXTURE_2D, 0, x, y, w, h, gl.RED_INTEGER, gl.UNSIGNED_BYTE, sheet.marks, first);
    gl.bindTexture(gl.TEXTURE_2D, this.heights);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, x, y, w, h, gl.RED_INTEGER, gl.UNSIGNED_SHORT, sheet.heights, first);
    for (let level = 1; level < LEVELS; level++) {
      const { heights, w: width } = this.levels[level];
      const i = x >> level, j = y >> level;
      gl.pixelStorei(gl.UNPACK_ROW_LENGTH, width);
      gl.texSubImage2D(gl.TEXTURE_2D, level, i, j, (x + w - 1 >> level) + 1 - i, (y + h - 1 >> level) + 1 - j,
        gl.RED_INTEGER, gl.UNSIGNED_SHORT, heights, j * width + i);
    }
  }

  // Millimetres to cells and steps of the heights.
  scale() {
    return [this.sheet.columns[0] / this.size[0], this.sheet.columns[1] / this.size[1], WHOLE_STEPS / this.size[2]];
  }

  // `clip`: least and greatest coordinates that are shown, mm; `ratio`: pixels of the canvas for a CSS pixel.
  draw(camera, clip, colouring, ratio) {
    const { gl, shader: { program, at } } = this;
    const scale = this.scale();
    const { right, up, forward } = camera.basis();
    gl.useProgram(program);
    gl.bindVertexArray(this.nothing);
    for (const [unit, texture] of [this.heights, this.marks, this.palette].entries()) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform1i(at.heights, 0);
    gl.uniform1i(at.marks, 1);
    gl.uniform1i(at.palette, 2);
    gl.uniform3fv(at.target, camera.target);
    gl.uniform3fv(at.right, right);
    gl.uniform3fv(at.up, up);
    gl.uniform3fv(at.forward, forward);
    gl.uniform3fv(at.lamp, camera.lamp());
    gl.uniform2f(at.extent, camera.window[0] * camera.mm / 2, camera.window[1] * camera.mm / 2);
    gl.uniform1f(at.far, camera.far);
    gl.uniform2i(at.cells, ...this.sheet.columns);
    gl.uniform3fv(at.scale, scale);
    gl.uniform3fv(at.clipMin, clip[0].map((value, k) => value * scale[k]));
    gl.uniform3fv(at.clipMax, clip[1].map((value, k) => value * scale[k]));
    gl.uniform3fv(at.whole, this.size.map((value, k) => value * scale[k]));
    gl.uniform1i(at.colouring, colouring);
    gl.uniform1f(at.pixel, camera.mm / ratio);
    gl.uniform1f(at.hatch, camera.mm);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // Where a ray (mm) meets the part, or null.
  pick([origin, direction], clip) {
    const scale = this.scale();
    const o = origin.map((value, k) => value * scale[k]);
    const d = direction.map((value, k) => value * scale[k] || 1e-9);
    let enter = 0, end = Infinity;
    for (let k = 0; k < 3; k++) {
      const a = (clip[0][k] * scale[k] - o[k]) / d[k], b = (clip[1][k] * scale[k] - o[k]) / d[k];
      enter = Math.max(enter, Math.min(a, b));
      end = Math.min(end, Math.max(a, b));
    }
    const [nx, ny] = this.sheet.columns;
    const place = t => origin.map((value, k) => value + direction[k] * t);
    const cellAt = (t, k) => Math.floor(o[k] + d[k] * t + Math.sign(d[k]) * 1e-6);
    const clampTo = (value, count) => Math.min(count - 1, Math.max(0, value));
    if (!(enter < end)) return null;
    let t = enter, i = clampTo(cellAt(t, 0), nx), j = clampTo(cellAt(t, 1), ny);
    while (t < end && i >= 0 && j >= 0 && i < nx && j < ny) {
      const height = this.sheet.heights[j * nx + i];
      const leaveX = (i + (d[0] > 0 ? 1 : 0) - o[0]) / d[0], leaveY = (j + (d[1] > 0 ? 1 : 0) - o[1]) / d[1];
      const next = Math.min(leaveX, leaveY, end);
      if (height > 0) {
        if (o[2] + d[2] * t <= height + 1e-3) return place(t);
        if (o[2] + d[2] * next < height) return place((height - o[2]) / d[2]);
      }
      if (leaveX < leaveY) i += Math.sign(d[0]);
      else j += Math.sign(d[1]);
      t = Math.max(next, t);
    }
    return null;
  }
}
