// What runs on the graphics card.

// The part: each pixel follows its ray over the height map, large steps first. Tops are flat, walls stand upright,
// and a section is a clean cut. Places: x and y in cells, z in steps of the heights.
export const RELIEF_VERTEX = `#version 300 es
out vec2 corner;
void main() {
  corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  gl_Position = vec4(corner, 0.0, 1.0);
}`;

export const RELIEF_FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
in vec2 corner;
out vec4 colour;
uniform usampler2D heights;
uniform usampler2D marks;
uniform sampler2D palette;
uniform vec3 target, right, up, forward, lamp;
uniform vec2 extent;        // half the window, mm
uniform float far;
uniform ivec2 cells;
uniform vec3 scale;         // mm to cells and steps
uniform vec3 clipMin, clipMax, whole;
uniform int colouring;      // 0 material, 1 tool, 2 depth
uniform float pixel, hatch;  // mm: a pixel of the picture, one of CSS

const int TOP_LEVEL = 6;
const float WHOLE = 65535.0;
const vec3 SKIN = vec3(0.27, 0.34, 0.44);
const vec3 CUT = vec3(0.58, 0.565, 0.54);
const vec3 SECTION = vec3(0.62, 0.24, 0.13);

float height(ivec2 c) {
  if (c.x < 0 || c.y < 0 || c.x >= cells.x || c.y >= cells.y) return 0.0;
  return float(texelFetch(heights, c, 0).r);
}

float highest(ivec2 c, int level) {
  if (c.x < 0 || c.y < 0 || c.x >= cells.x || c.y >= cells.y) return 0.0;
  return float(texelFetch(heights, c >> level, level).r);
}

// Where a ray meets material between t and end: t, or -1; the cell, and the axis of the wall (2 is a top).
float march(vec3 o, vec3 d, float t, float end, out ivec2 cell, out int axis) {
  vec3 inverse = 1.0 / d;
  vec2 nudge = sign(d.xy) * 1e-3;
  int level = TOP_LEVEL;
  axis = 2;
  cell = ivec2(0);
  for (int k = 0; k < 1500; k++) {
    if (t >= end) return -1.0;
    cell = ivec2(floor(o.xy + d.xy * t + nudge));
    if (cell.x < 0 || cell.y < 0 || cell.x >= cells.x || cell.y >= cells.y) return -1.0;
    ivec2 block = cell >> level;
    vec2 low = vec2(block << level), high = vec2((block + 1) << level);
    vec2 leave = (mix(low, high, step(vec2(0.0), d.xy)) - o.xy) * inverse.xy;
    float next = min(min(leave.x, leave.y), end);
    float h = float(texelFetch(heights, block, level).r);
    float z = o.z + d.z * t, least = d.z < 0.0 ? o.z + d.z * next : z;
    if (least >= h) {
      axis = leave.x < leave.y ? 0 : 1;
      t = max(next, t + 1e-6);
      level = min(level + 1, TOP_LEVEL);
    } else if (level > 0) {
      level--;
    } else if (z <= h) {
      return t;
    } else {
      axis = 2;
      return (h - o.z) * inverse.z;
    }
  }
  return -1.0;
}

// The slope of a surface that goes on to its neighbours without a wall, mm per mm.
vec2 slope(ivec2 c) {
  float own = height(c), wall = 2.5 * scale.z / min(scale.x, scale.y);
  vec2 sum = vec2(0.0), count = vec2(0.0);
  for (int k = 1; k <= 2; k++) {
    for (int s = -1; s <= 1; s += 2) {
      float a = height(c + ivec2(s * k, 0)), b = height(c + ivec2(0, s * k));
      if (abs(a - own) < wall * float(k) && a > 0.0) { sum.x += (a - own) * float(s); count.x += float(k); }
      if (abs(b - own) < wall * float(k) && b > 0.0) { sum.y += (b - own) * float(s); count.y += float(k); }
    }
  }
  return sum / max(count, vec2(1.0)) * scale.xy / scale.z;
}

// How far the material is behind a place, in cells along an axis: found by halving. 99 when there is no such border.
int border(ivec2 at, ivec2 inward, float z) {
  int air = -12, solid = 12;
  if (height(at + inward * air) > z || height(at + inward * solid) <= z) return 99;
  for (int k = 0; k < 5; k++) {
    int middle = (air + solid) >> 1;
    if (height(at + inward * middle) > z) solid = middle;
    else air = middle;
  }
  return solid;
}

// Which way a wall looks. It has steps of whole cells; the line through its borders some cells away has not.
vec3 wallNormal(vec2 at, float z) {
  vec2 rough = vec2(0.0);
  ivec2 middle = ivec2(floor(at));
  for (int j = -2; j <= 2; j++) {
    for (int i = -2; i <= 2; i++) {
      vec2 off = vec2(middle + ivec2(i, j)) + 0.5 - at;
      rough -= step(z, height(middle + ivec2(i, j)) - 0.5) * off;
    }
  }
  bool first = abs(rough.x) > abs(rough.y);
  int look = first ? (rough.x < 0.0 ? -1 : 1) : (rough.y < 0.0 ? -1 : 1);
  ivec2 inward = first ? ivec2(-look, 0) : ivec2(0, -look), along = first ? ivec2(0, 1) : ivec2(1, 0);
  int own = border(middle, inward, z);
  float squares = 1.0, products = 0.0;
  if (own < 99) {
    for (int k = 1; k <= 3; k++) {
      for (int s = -1; s <= 1; s += 2) {
        int u = 4 * k * s, b = border(middle + along * u, inward, z) - own;
        if (abs(b) > abs(u) * 3 / 2 + 1) continue;
        squares += float(u * u);
        products += float(u * b);
      }
    }
  }
  float lean = products / squares;
  return vec3(first ? vec2(float(look), lean) : vec2(lean, float(look)), 0.0);
}

// How much of the sky is hidden by what stands around.
float hidden(vec3 p, vec3 n) {
  float sum = 0.0, all = 0.0;
  float toMm = 1.0 / scale.z;
  for (int k = 0; k < 8; k++) {
    float angle = (float(k) + 0.5) * 0.7853982;
    vec2 direction = vec2(cos(angle), sin(angle));
    float weight = n.z > 0.5 ? 1.0 : max(0.0, dot(direction, n.xy));
    float sine = 0.0;
    for (int ring = 1; ring <= 4; ring++) {
      float distance = 1.5 * exp2(float(ring));
      float rise = (highest(ivec2(floor(p.xy + direction * distance)), max(ring - 2, 0)) - p.z) * toMm;
      sine = max(sine, rise * inversesqrt(rise * rise + distance * distance / (scale.x * scale.x)));
    }
    sum += weight * sine;
    all += weight;
  }
  return sum / max(all, 0.01);
}

vec3 toLinear(vec3 c) { return pow(c, vec3(2.2)); }

vec3 depthColour(float share) {
  vec3 a = toLinear(vec3(0.93, 0.94, 0.95)), b = toLinear(vec3(0.42, 0.60, 0.75)), c = toLinear(vec3(0.08, 0.18, 0.33));
  return share < 0.5 ? mix(a, b, share * 2.0) : mix(b, c, share * 2.0 - 1.0);
}

vec3 surface(float h, ivec2 cutBy, bool skin) {
  if (colouring == 2) return depthColour(1.0 - h / WHOLE);
  if (skin) return SKIN;
  if (colouring == 1) {
    uint mark = texelFetch(marks, clamp(cutBy, ivec2(0), cells - 1), 0).r;
    if (mark > 0u) return toLinear(texelFetch(palette, ivec2(int(mark), 0), 0).rgb);
  }
  return CUT;
}

void main() {
  vec3 from = target + right * corner.x * extent.x + up * corner.y * extent.y - forward * far;
  vec3 o = from * scale, d = forward * scale;
  d += vec3(equal(sign(d), vec3(0.0))) * 1e-7 + vec3(lessThan(abs(d), vec3(1e-7))) * sign(d) * 1e-7;
  vec3 inverse = 1.0 / d;
  vec3 a = (clipMin - o) * inverse, b = (clipMax - o) * inverse;
  vec3 near = min(a, b), leave = max(a, b);
  float enter = max(max(near.x, near.y), near.z), end = min(min(leave.x, leave.y), leave.z);
  if (enter >= end || end <= 0.0) discard;

  int face = near.x >= enter ? 0 : near.y >= enter ? 1 : 2;
  vec3 p = o + d * enter;
  ivec2 cell = clamp(ivec2(floor(p.xy + sign(d.xy) * 1e-3)), ivec2(0), cells - 1);
  int axis = face;
  float t = enter;
  vec3 n = vec3(0.0), base;
  bool section = false;
  if (height(cell) > 0.0 && p.z <= height(cell) + (face == 2 && d.z < 0.0 ? 0.0 : -0.5)) {
    n[face] = -sign(d[face]);
    section = p[face] > 0.5 && p[face] < whole[face] - 0.5;
    base = section ? SECTION : surface(height(cell), cell, true);
    if (!section && face == 2 && d.z < 0.0) base = surface(WHOLE, cell, true);
  } else {
    t = march(o, d, enter, end, cell, axis);
    if (t < 0.0) discard;
    p = o + d * t;
    float h = height(cell);
    if (axis == 2) {
      n = normalize(vec3(-slope(cell), 1.0));
      base = surface(h, cell, h >= WHOLE);
    } else {
      ivec2 before = cell;
      before[axis] -= d[axis] > 0.0 ? 1 : -1;
      if (height(before) > p.z) {
        // At a corner of the cell the ray came from the other side.
        before = cell;
        axis = 1 - axis;
        before[axis] -= d[axis] > 0.0 ? 1 : -1;
      }
      float foot = height(before);
      vec3 flat_ = vec3(0.0);
      flat_[axis] = -sign(d[axis]);
      if ((h - foot) / scale.z * scale.x < 2.5) n = normalize(vec3(-slope(cell), 1.0));
      else {
        n = wallNormal(p.xy + flat_.xy * 1e-2, p.z);
        n = dot(n, forward) < 0.0 ? normalize(n) : flat_;
      }
      base = surface(p.z, before, false);
    }
  }
  if (section) {
    vec2 dots = corner * extent / hatch;
    base *= mod(dots.x + dots.y, 9.0) < 1.3 ? 0.72 : 1.0;
  }

  vec3 out_ = p + n * vec3(1.5, 1.5, 0.0);
  float sky = 1.0 - 0.75 * (section ? 0.0 : hidden(out_, n));
  float lit = max(dot(n, lamp), 0.0);
  if (lit > 0.0 && !section) {
    vec3 l = lamp * scale;
    l += vec3(lessThan(abs(l), vec3(1e-7))) * 1e-7;
    // Far enough off that the steps of a slanting wall cast no shadows.
    vec3 start = p + n * vec3(2.5, 2.5, 0.6 * scale.z / scale.x);
    vec3 rise = (mix(vec3(0.0), whole, step(vec3(0.0), l)) - start) / l;
    ivec2 other; int side;
    float limit = min(min(rise.x, rise.y), rise.z);
    if (limit > 0.0 && march(start, l, 0.0, limit, other, side) >= 0.0) lit *= 0.3;
  }
  vec3 halfway = normalize(lamp - forward);
  float shine = pow(max(dot(n, halfway), 0.0), 28.0) * (colouring == 0 ? 0.16 : 0.06) * step(0.01, lit);
  vec3 ambient = mix(vec3(0.26, 0.25, 0.24), vec3(0.42, 0.44, 0.47), 0.5 + 0.5 * n.z) * sky;
  vec3 light = base * (ambient + 0.78 * lit) + shine;
  // A bright rim where a top ends at a wall.
  if (axis == 2 && !section && n.z > 0.9) {
    int r = int(clamp(pixel * scale.x, 1.0, 8.0));
    float low = min(min(height(cell + ivec2(r, 0)), height(cell - ivec2(r, 0))),
                    min(height(cell + ivec2(0, r)), height(cell - ivec2(0, r))));
    if (p.z - low > 4.0 * scale.z / scale.x) light = mix(light, vec3(1.0), 0.16);
  }
  colour = vec4(pow(min(light, vec3(1.0)), vec3(1.0 / 2.2)), 1.0);
  gl_FragDepth = clamp(0.5 + 0.5 * (t - far) / far, 0.0, 1.0);
}`;

// The path: a ribbon of constant width on the screen for each segment.
export const LINE_VERTEX = `#version 300 es
in vec3 from, to;
in vec4 about;              // kind, tool, way before it (mm), time at its beginning (s)
in float until;
uniform mat4 camera;
uniform vec2 window;
uniform float width, bias;
flat out int kind, tool;
out float way, time, side;
void main() {
  vec4 a = camera * vec4(from, 1.0), b = camera * vec4(to, 1.0);
  vec2 along = (b.xy - a.xy) * window;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  float end = float(gl_VertexID >> 1);
  side = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec4 at = mix(a, b, end);
  at.xy += (vec2(-along.y, along.x) * side + along * (end * 2.0 - 1.0) * 0.5) * (width + 1.0) / window;
  at.z -= bias;
  gl_Position = at;
  kind = int(about.x);
  tool = int(about.y);
  way = about.z + end * length(to - from);
  time = mix(about.w, until, end);
}`;

export const LINE_FRAGMENT = `#version 300 es
precision highp float;
flat in int kind, tool;
in float way, time, side;
out vec4 colour;
uniform vec4 colours[64];
uniform vec4 rapid, box;
uniform float now, dash, width, strength, ahead;
void main() {
  vec4 own = kind == 0 ? rapid : kind == 1 ? colours[tool] : box;
  if (kind == 0 && mod(way, 2.0 * dash) > 1.2 * dash) discard;
  float soft = clamp((1.0 - abs(side)) * (width + 1.0) * 0.5, 0.0, 1.0);
  float alpha = own.a * soft * strength * (kind < 2 && time > now ? ahead : 1.0);
  colour = vec4(own.rgb * alpha, alpha);
}`;

// The tool: a shape of revolution.
export const TOOL_VERTEX = `#version 300 es
in vec3 place, normal;
uniform mat4 camera;
uniform vec3 at;
out vec3 direction;
void main() {
  gl_Position = camera * vec4(place + at, 1.0);
  direction = normal;
}`;

export const TOOL_FRAGMENT = `#version 300 es
precision highp float;
in vec3 direction;
out vec4 colour;
uniform vec3 lamp, tint;
uniform float alpha;
void main() {
  vec3 n = normalize(direction);
  float lit = 0.45 + 0.55 * max(dot(n, lamp), 0.0) + 0.25 * pow(max(dot(n, lamp), 0.0), 12.0);
  colour = vec4(pow(min(tint * lit, vec3(1.0)), vec3(1.0 / 2.2)) * alpha, alpha);
}`;

export function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const places = {};
  for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); k++) {
    const name = gl.getActiveUniform(made, k).name.replace('[0]', '');
    places[name] = gl.getUniformLocation(made, name);
  }
  return { program: made, at: places };
}
