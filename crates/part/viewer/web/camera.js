// From where the part is seen: parallel projection, as in a drawing. Angles as those of `bahn test --angle`.

export const VIEWS = {
  iso: [30, 38],
  top: [0, 90],
  front: [0, 0],
  right: [90, 0],
};

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = a => {
  const length = Math.hypot(...a) || 1;
  return a.map(value => value / length);
};

export class Camera {
  // For a box from the origin to `size`, mm.
  constructor(size) {
    this.size = size;
    this.window = [1, 1];
    this.reset();
  }

  reset() {
    this.stand('iso');
  }

  // A standard view, all of the part in the window.
  stand(name) {
    [this.azimuth, this.elevation] = VIEWS[name];
    this.fit();
  }

  fit() {
    this.target = this.size.map(side => side / 2);
    const { right, up } = this.basis();
    const extent = axis => this.size.reduce((sum, side, k) => sum + Math.abs(axis[k]) * side, 0);
    const room = Math.min(72, 0.2 * Math.min(...this.window));
    this.mm = Math.max(extent(right) / Math.max(this.window[0] - room, 1),
      extent(up) / Math.max(this.window[1] - 2 * room, 1));
    // It fits until somebody moves it.
    this.fitted = true;
  }

  // The window has another size, in CSS pixels.
  resize(width, height) {
    this.window = [Math.max(width, 1), Math.max(height, 1)];
    if (this.fitted) this.fit();
  }

  basis() {
    const a = this.azimuth * Math.PI / 180, e = this.elevation * Math.PI / 180;
    const right = [Math.cos(a), Math.sin(a), 0];
    const forward = [-Math.sin(a) * Math.cos(e), Math.cos(a) * Math.cos(e), -Math.sin(e)];
    return { right, forward, up: cross(right, forward) };
  }

  rotate(dx, dy) {
    this.azimuth = (this.azimuth - dx) % 360;
    this.elevation = Math.min(90, Math.max(-90, this.elevation + dy));
  }

  // By pixels.
  pan(dx, dy) {
    const { right, up } = this.basis();
    this.target = this.target.map((value, k) => value + (-dx * right[k] + dy * up[k]) * this.mm);
    this.fitted = false;
  }

  // What is under a pixel stays there.
  zoom(factor, at = [this.window[0] / 2, this.window[1] / 2]) {
    const before = this.mm;
    const whole = Math.max(...this.size);
    this.mm = Math.min(whole / 20, Math.max(whole / 2e5, this.mm / factor));
    const { right, up } = this.basis();
    const u = (at[0] - this.window[0] / 2) * (before - this.mm);
    const v = (this.window[1] / 2 - at[1]) * (before - this.mm);
    this.target = this.target.map((value, k) => value + u * right[k] + v * up[k]);
    this.fitted = false;
  }

  // Half of the depth that is seen.
  get far() {
    return 4 * Math.hypot(...this.size) + 1000 * this.mm;
  }

  // Pixel of a point, and how far it is behind the target.
  project(point) {
    const { right, up, forward } = this.basis();
    const from = point.map((value, k) => value - this.target[k]);
    return [this.window[0] / 2 + dot(from, right) / this.mm, this.window[1] / 2 - dot(from, up) / this.mm,
      dot(from, forward)];
  }

  // Origin and direction of the ray through a pixel.
  ray(x, y) {
    const { right, up, forward } = this.basis();
    const u = (x - this.window[0] / 2) * this.mm, v = (this.window[1] / 2 - y) * this.mm;
    const origin = this.target.map((value, k) => value + u * right[k] + v * up[k] - this.far * forward[k]);
    return [origin, forward];
  }

  // The same as a matrix for WebGL, column by column.
  matrix() {
    const { right, up, forward } = this.basis();
    const scale = [2 / (this.mm * this.window[0]), 2 / (this.mm * this.window[1]), 1 / this.far];
    const rows = [right, up, forward].map((axis, k) => axis.map(value => value * scale[k]));
    const m = new Float32Array(16);
    rows.forEach((row, k) => {
      m[k] = row[0];
      m[4 + k] = row[1];
      m[8 + k] = row[2];
      m[12 + k] = -dot(row, this.target);
    });
    m[15] = 1;
    return m;
  }

  // The lamp stands on the left of the eye, above it in the picture, and over the part on the side that is seen.
  lamp() {
    const { right, up, forward } = this.basis();
    const over = forward[2] > 0.05 ? -0.75 : 0.75;
    return unit([0, 1, 2].map(k => -0.62 * right[k] + 0.3 * up[k] - 0.35 * forward[k] + (k === 2 ? over : 0)));
  }
}
