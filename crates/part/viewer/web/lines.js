// The path of the tool and the edges of the blank.

import { program, LINE_VERTEX, LINE_FRAGMENT } from './shaders.js';
import { RAPID, FEED } from './codec.js';

// Numbers of a segment: two places, kind, tool, way before it, its times.
const NUMBERS = 11;
const EDGE = 2;

export class Lines {
  constructor(gl) {
    this.gl = gl;
    this.shader = program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.sets = { path: this.set(), box: this.set() };
    this.colours = new Float32Array(64 * 4).fill(0.8);
    this.rapid = [0.8, 0.2, 0.2, 1];
    this.box = [0.5, 0.5, 0.5, 1];
    // Segments of the path as numbers, and how many end at a point or before it.
    this.numbers = new Float32Array(0);
    this.upTo = [];
  }

  set() {
    const { gl, shader } = this;
    const made = { array: gl.createVertexArray(), buffer: gl.createBuffer(), count: 0 };
    gl.bindVertexArray(made.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, made.buffer);
    for (const [name, size, from] of [['from', 3, 0], ['to', 3, 3], ['about', 4, 6], ['until', 1, 10]]) {
      const at = gl.getAttribLocation(shader.program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * NUMBERS, 4 * from);
      gl.vertexAttribDivisor(at, 1);
    }
    gl.bindVertexArray(null);
    return made;
  }

  fill(set, numbers) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    set.count = numbers.length / NUMBERS;
  }

  // The path; from a point on it is another one than before.
  path(path, from = 0) {
    const { places, kinds, tools, times, count } = path;
    const { upTo } = this;
    let number = from > 0 ? upTo[from - 1] : 0;
    const first = number;
    if (this.numbers.length < NUMBERS * (number + count - from)) {
      const grown = new Float32Array(NUMBERS * 2 * (number + count - from));
      grown.set(this.numbers.subarray(0, NUMBERS * number));
      this.numbers = grown;
      from = Math.max(from, 1);
      this.grown = true;
    }
    const { numbers } = this;
    upTo[0] = 0;
    let way = number > 0 ? this.wayBehind(number - 1) : 0;
    for (let k = Math.max(from, 1); k < count; k++) {
      if (kinds[k] === RAPID || kinds[k] === FEED) {
        const at = NUMBERS * number++;
        numbers.set(places.subarray(3 * k - 3, 3 * k + 3), at);
        numbers.set([kinds[k], tools[k], way, times[k - 1], times[k]], at + 6);
        way = this.wayBehind(number - 1);
      }
      upTo[k] = number;
    }
    upTo.length = count;
    this.upload(first, number);
  }

  // How far the tool has gone behind a segment; it matters for dashes only.
  wayBehind(segment) {
    const [x0, y0, z0, x1, y1, z1, , , way] = this.numbers.subarray(NUMBERS * segment, NUMBERS * (segment + 1));
    return (way + Math.hypot(x1 - x0, y1 - y0, z1 - z0)) % 1e4;
  }

  // Only what is new goes to the graphics card.
  upload(first, count) {
    const { gl, numbers } = this;
    const set = this.sets.path;
    gl.bindBuffer(gl.ARRAY_BUFFER, set.buffer);
    if (this.grown) gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    else if (count > first) {
      gl.bufferSubData(gl.ARRAY_BUFFER, 4 * NUMBERS * first, numbers, NUMBERS * first, NUMBERS * (count - first));
    }
    this.grown = false;
    set.count = count;
  }

  // The edges of a box from the origin.
  edges(size) {
    const numbers = [];
    for (let axis = 0; axis < 3; axis++) {
      for (let k = 0; k < 4; k++) {
        const from = [0, 0, 0];
        from[(axis + 1) % 3] = k & 1 ? size[(axis + 1) % 3] : 0;
        from[(axis + 2) % 3] = k & 2 ? size[(axis + 2) % 3] : 0;
        const to = [...from];
        to[axis] = size[axis];
        numbers.push(...from, ...to, EDGE, 0, 0, 0, 0);
      }
    }
    this.fill(this.sets.box, Float32Array.from(numbers));
  }

  // `show`: which of path and box; lines behind the part are faint, or left out where that takes too long.
  draw(camera, show, now, ratio, hasTime) {
    const { gl, shader: { program, at } } = this;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.camera, false, camera.matrix());
    const window = camera.window.map(side => side * ratio);
    gl.uniform2fv(at.window, window);
    gl.uniform4fv(at.colours, this.colours);
    gl.uniform4fv(at.rapid, this.rapid);
    gl.uniform4fv(at.box, this.box);
    gl.uniform1f(at.now, now);
    gl.uniform1f(at.dash, 5 * camera.mm);
    gl.uniform1f(at.ahead, 0.22);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    for (const [name, width, strength, behind] of [['box', 1, 0.55, 0.12], ['path', 1.5, 0.85, 0.12]]) {
      if (!show[name]) continue;
      const set = this.sets[name];
      gl.bindVertexArray(set.array);
      gl.uniform1f(at.width, width * ratio);
      gl.uniform1f(at.bias, 0.6 * camera.mm / camera.far);
      for (const [depth, share] of [[gl.LEQUAL, strength], [gl.GREATER, hasTime ? behind : 0]]) {
        if (share === 0) continue;
        gl.depthFunc(depth);
        gl.uniform1f(at.strength, share);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, set.count);
      }
    }
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}
