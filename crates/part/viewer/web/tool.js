// The tool as a shape of revolution, its tip at the origin.

import { program, TOOL_VERTEX, TOOL_FRAGMENT } from './shaders.js';

const SIDES = 48;

// Radius and height of the outline from the tip up, mm.
export function outline({ radius, corner, point, length }) {
  const r = Math.max(radius, 0.2);
  const height = Math.max(length > 0 ? Math.min(length, Math.max(8 * r, 40)) : Math.max(6 * r, 30), 2.5 * r);
  const points = [[0, 0]];
  const round = Math.min(Math.max(corner, 0), r);
  let top = 0;
  if (point > 0 && point < 180 && round === 0) {
    top = r / Math.tan(point / 2 * Math.PI / 180);
    points.push([r, top]);
  } else if (round > 0) {
    for (let k = 0; k <= 10; k++) {
      const angle = k / 10 * Math.PI / 2;
      points.push([r - round + round * Math.sin(angle), round * (1 - Math.cos(angle))]);
    }
    top = round;
  } else {
    points.push([r, 0]);
  }
  points.push([r, Math.max(height, top + r)], [0, Math.max(height, top + r)]);
  return points;
}

// Triangles of places and normals.
function triangles(points) {
  const numbers = [];
  for (let k = 0; k + 1 < points.length; k++) {
    const [r0, z0] = points[k], [r1, z1] = points[k + 1];
    const length = Math.hypot(r1 - r0, z1 - z0);
    if (length === 0) continue;
    const out = (z1 - z0) / length, up = (r0 - r1) / length;
    for (let side = 0; side < SIDES; side++) {
      const corner = (turn, r, z) => {
        const c = Math.cos(turn * 2 * Math.PI / SIDES), s = Math.sin(turn * 2 * Math.PI / SIDES);
        return [r * c, r * s, z, out * c, out * s, up];
      };
      const quad = [corner(side, r0, z0), corner(side + 1, r0, z0), corner(side + 1, r1, z1), corner(side, r1, z1)];
      for (const at of [0, 1, 2, 0, 2, 3]) numbers.push(...quad[at]);
    }
  }
  return Float32Array.from(numbers);
}

export class Tool {
  constructor(gl) {
    this.gl = gl;
    this.shader = program(gl, TOOL_VERTEX, TOOL_FRAGMENT);
    this.array = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (const [name, from] of [['place', 0], ['normal', 3]]) {
      const at = gl.getAttribLocation(this.shader.program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, 4 * from);
    }
    gl.bindVertexArray(null);
    this.count = 0;
    this.shape = null;
    this.tint = [0.7, 0.7, 0.72];
  }

  // Another tool in the spindle; null for none.
  take(shape) {
    if (shape === this.shape) return;
    this.shape = shape;
    const numbers = shape ? triangles(outline(shape)) : new Float32Array(0);
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, numbers, this.gl.STATIC_DRAW);
    this.count = numbers.length / 6;
  }

  // Where it is hidden by the part it shimmers through.
  draw(camera, place) {
    if (this.count === 0) return;
    const { gl, shader: { program, at } } = this;
    gl.useProgram(program);
    gl.bindVertexArray(this.array);
    gl.uniformMatrix4fv(at.camera, false, camera.matrix());
    gl.uniform3fv(at.at, place);
    gl.uniform3fv(at.lamp, camera.lamp());
    gl.uniform3fv(at.tint, this.tint);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    // First its depth alone, so that its own back does not show through.
    gl.uniform1f(at.alpha, 0);
    gl.drawArrays(gl.TRIANGLES, 0, this.count);
    gl.depthFunc(gl.EQUAL);
    gl.uniform1f(at.alpha, 0.82);
    gl.drawArrays(gl.TRIANGLES, 0, this.count);
    gl.depthFunc(gl.LEQUAL);
    gl.disable(gl.BLEND);
  }
}
