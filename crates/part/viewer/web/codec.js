// The data of a page, and the tiles of a part: the other side of the Rust files of these names.

const TILE = 64;
export const WHOLE = 65535;
const ALL_ALIKE = 0, ALL_CELLS = 1;

// Numbers from bytes.
export class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }

  // Seven bits a byte, low ones first. Beyond 32 bits only products are exact.
  varint() {
    let value = 0, scale = 1, byte;
    do {
      byte = this.bytes[this.at++];
      value += (byte & 0x7f) * scale;
      scale *= 128;
    } while (byte & 0x80);
    return value;
  }

  signed() {
    const value = this.varint();
    return value % 2 ? -(value + 1) / 2 : value / 2;
  }

  take(count) {
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }

  // A column of numbers, each as its difference from the one before.
  column(values, scale = 1) {
    let value = 0;
    for (let k = 0; k < values.length; k++) {
      value += this.signed();
      values[k] = value * scale;
    }
    return values;
  }
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export function fromBase64(text) {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < bytes.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

// The tiles of a message as [number, bytes].
export function readTiles(bytes) {
  const reader = new Reader(bytes);
  const tiles = [];
  let next = 0;
  for (let left = reader.varint(); left > 0; left--) {
    const tile = next + reader.varint();
    next = tile + 1;
    tiles.push([tile, reader.take(reader.varint())]);
  }
  return tiles;
}

// Heights (0 a hole, 65535 untouched) and marks of all cells, in rows along the first axis.
export class Sheet {
  constructor(columns) {
    this.columns = columns;
    this.across = Math.ceil(columns[0] / TILE);
    this.tiles = this.across * Math.ceil(columns[1] / TILE);
    this.heights = new Uint16Array(columns[0] * columns[1]).fill(WHOLE);
    this.marks = new Uint8Array(columns[0] * columns[1]);
  }

  // Corner and size of a tile.
  place(tile) {
    const x = tile % this.across * TILE, y = Math.floor(tile / this.across) * TILE;
    return { x, y, w: Math.min(TILE, this.columns[0] - x), h: Math.min(TILE, this.columns[1] - y) };
  }

  fill(tile, height, mark) {
    const { x, y, w, h } = this.place(tile);
    for (let j = y; j < y + h; j++) {
      const at = j * this.columns[0] + x;
      this.heights.fill(height, at, at + w);
      this.marks.fill(mark, at, at + w);
    }
  }

  // Takes a tile as it was sent.
  take(tile, bytes) {
    if (bytes[0] === ALL_ALIKE) return this.fill(tile, bytes[1] | bytes[2] << 8, bytes[3]);
    const { x, y, w, h } = this.place(tile);
    const count = w * h, stride = this.columns[0];
    const all = bytes[0] === ALL_CELLS;
    let low = 1, cells = count;
    if (!all) {
      low = 1 + Math.ceil(count / 8);
      cells = (bytes.length - low) / 3;
    }
    const high = low + cells, marks = high + cells;
    const { heights } = this;
    for (let cell = 0, k = 0; cell < count; cell++) {
      if (!all && !(bytes[1 + (cell >> 3)] >> (cell & 7) & 1)) continue;
      const i = cell % w, j = (cell - i) / w;
      const at = (y + j) * stride + x + i;
      let expected;
      if (j === 0) expected = i === 0 ? WHOLE : heights[at - 1];
      else if (i === 0) expected = heights[at - stride];
      else {
        const left = heights[at - 1], above = heights[at - stride], between = heights[at - stride - 1];
        const least = Math.min(left, above), most = Math.max(left, above);
        expected = between >= most ? least : between <= least ? most : left + above - between;
      }
      const folded = bytes[low + k] | bytes[high + k] << 8;
      heights[at] = expected + (folded >> 1 ^ -(folded & 1));
      this.marks[at] = bytes[marks + k];
      k++;
    }
  }
}

// A part at moments along the path: any of them is shown by the tiles that are different.
export class History {
  constructor(sheet, bytes) {
    this.sheet = sheet;
    this.times = [];
    // For each tile what it became, and when.
    this.versions = Array.from({ length: sheet.tiles }, () => []);
    this.applied = new Uint16Array(sheet.tiles);
    const reader = new Reader(bytes);
    const count = bytes.length ? reader.varint() : 0;
    for (let moment = 0, ms = 0; moment < count; moment++) {
      ms += reader.varint();
      this.times.push(ms / 1000);
      for (const [tile, data] of readTiles(reader.take(reader.varint()))) this.versions[tile].push({ moment, data });
    }
  }

  // How many moments are over at a time.
  over(time) {
    let low = 0, high = this.times.length;
    while (low < high) {
      const middle = low + high >> 1;
      if (this.times[middle] <= time + 5e-4) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // Brings the sheet to the last moment before a time; the tiles that changed.
  show(time) {
    const over = this.over(time);
    const changed = [];
    this.versions.forEach((versions, tile) => {
      let wanted = this.applied[tile];
      while (wanted < versions.length && versions[wanted].moment < over) wanted++;
      while (wanted > 0 && versions[wanted - 1].moment >= over) wanted--;
      if (wanted === this.applied[tile]) return;
      let from = this.applied[tile];
      if (wanted < from) {
        // Differences lead forward only: from the untouched tile again.
        this.sheet.fill(tile, WHOLE, 0);
        from = 0;
      }
      for (let k = from; k < wanted; k++) this.sheet.take(tile, versions[k].data);
      this.applied[tile] = wanted;
      changed.push(tile);
    });
    return changed;
  }
}

export const RAPID = 0, FEED = 1;

// The points of the path in columns: places in the blank (mm), times of their ends (s), rows, kinds, tools.
export function readPath(bytes) {
  const reader = new Reader(bytes);
  const count = reader.varint();
  const [x, y, z] = [0, 1, 2].map(() => reader.column(new Float32Array(count), 1e-3));
  const places = new Float32Array(3 * count);
  for (let k = 0; k < count; k++) places.set([x[k], y[k], z[k]], 3 * k);
  const times = reader.column(new Float64Array(count), 1e-3);
  const rows = reader.column(new Int32Array(count));
  const kinds = reader.take(count), tools = reader.take(count);
  const ends = [];
  for (let k = 0; k < count; k++) if (kinds[k] & 0x80) ends.push(k);
  return { count, places, times, rows, kinds: kinds.map(kind => kind & 0x7f), tools, ends: Int32Array.from(ends) };
}

// A path that grows: columns as those of `readPath`, with room for more.
export class GrowingPath {
  constructor() {
    this.count = 0;
    this.room(1024);
  }

  room(points) {
    const grown = { places: new Float32Array(3 * points), times: new Float64Array(points), kinds: new Uint8Array(points), tools: new Uint8Array(points) };
    for (const [name, column] of Object.entries(grown)) {
      if (this[name]) column.set(this[name].subarray(0, Math.min(column.length, this[name].length)));
      this[name] = column;
    }
  }

  // Takes the points from one on as they were sent.
  take(from, bytes) {
    const { count, places, times, kinds, tools } = readPath(bytes);
    this.count = from + count;
    if (this.count > this.times.length) this.room(2 * this.count);
    this.places.set(places, 3 * from);
    this.times.set(times, from);
    this.kinds.set(kinds, from);
    this.tools.set(tools, from);
  }
}

// Everything in the data of a page.
export function readScene(bytes) {
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  const text = new TextDecoder();
  const head = JSON.parse(text.decode(bytes.subarray(4, 4 + length)));
  let at = 4 + length;
  const [listing, moments, path] = head.lengths.map(count => bytes.subarray(at, at += count));
  return { head, listing: text.decode(listing).split('\n').slice(0, -1), moments, path: readPath(path) };
}
