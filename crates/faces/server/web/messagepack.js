// Reads MessagePack, as far as the server writes it: no extensions.

const text = new TextDecoder();

/** The value that an ArrayBuffer holds. */
export function decode(buffer) {
  const bytes = new Uint8Array(buffer);
  const view = new DataView(buffer);
  let at = 0;

  const take = (length, read) => {
    const value = read(at);
    at += length;
    return value;
  };
  const string = (length) => take(length, (from) => text.decode(bytes.subarray(from, from + length)));
  const binary = (length) => take(length, (from) => bytes.subarray(from, from + length));
  const array = (length) => Array.from({ length }, value);
  const map = (length) => Object.fromEntries(Array.from({ length }, () => [value(), value()]));
  const unsigned = (size) => {
    if (size === 1) return take(1, (from) => view.getUint8(from));
    if (size === 2) return take(2, (from) => view.getUint16(from));
    if (size === 4) return take(4, (from) => view.getUint32(from));
    return Number(take(8, (from) => view.getBigUint64(from)));
  };
  const signed = (size) => {
    if (size === 1) return take(1, (from) => view.getInt8(from));
    if (size === 2) return take(2, (from) => view.getInt16(from));
    if (size === 4) return take(4, (from) => view.getInt32(from));
    return Number(take(8, (from) => view.getBigInt64(from)));
  };

  function value() {
    const head = bytes[at++];
    if (head < 0x80) return head;
    if (head < 0x90) return map(head & 0x0f);
    if (head < 0xa0) return array(head & 0x0f);
    if (head < 0xc0) return string(head & 0x1f);
    if (head >= 0xe0) return head - 0x100;
    switch (head) {
      case 0xc0: return null;
      case 0xc2: return false;
      case 0xc3: return true;
      case 0xc4: case 0xc5: case 0xc6: return binary(unsigned(1 << (head - 0xc4)));
      case 0xca: return take(4, (from) => view.getFloat32(from));
      case 0xcb: return take(8, (from) => view.getFloat64(from));
      case 0xcc: case 0xcd: case 0xce: case 0xcf: return unsigned(1 << (head - 0xcc));
      case 0xd0: case 0xd1: case 0xd2: case 0xd3: return signed(1 << (head - 0xd0));
      case 0xd9: case 0xda: case 0xdb: return string(unsigned(1 << (head - 0xd9)));
      case 0xdc: case 0xdd: return array(unsigned(2 << (head - 0xdc)));
      case 0xde: case 0xdf: return map(unsigned(2 << (head - 0xde)));
      default: throw new Error(`unknown head ${head}`);
    }
  }
  return value();
}
