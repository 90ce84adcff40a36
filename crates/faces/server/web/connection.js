// The connection to the station. Inputs have numbers: what was not acknowledged before a connection broke is sent
// again, and the station does each of them once.

import { decode } from "/web/messagepack.js";

const RETRY_MS = [200, 500, 1000, 2000];

export class Connection {
  /** Calls `regions(name, value)` for what has changed and `state(connected)` when the connection comes or goes. */
  constructor(regions, state) {
    this.regions = regions;
    this.state = state;
    this.name = sessionStorage.getItem("bahn-name") ?? `viewer-${crypto.getRandomValues(new Uint32Array(1))[0]}`;
    sessionStorage.setItem("bahn-name", this.name);
    // Who knows the key is this viewer: it is sent to the station alone.
    this.key = sessionStorage.getItem("bahn-key") ?? [...crypto.getRandomValues(new Uint32Array(4))].map((word) => word.toString(16).padStart(8, "0")).join("");
    sessionStorage.setItem("bahn-key", this.key);
    this.waiting = JSON.parse(sessionStorage.getItem("bahn-waiting") ?? "[]");
    this.number = Number(sessionStorage.getItem("bahn-number") ?? 0);
    this.tries = 0;
    this.open();
  }

  open() {
    const protocol = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${protocol}://${location.host}/ws?name=${encodeURIComponent(this.name)}&key=${this.key}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.tries = 0;
      this.state(true);
      for (const input of this.waiting) this.socket.send(JSON.stringify(input));
    };
    this.socket.onmessage = (event) => {
      for (const [name, value] of decode(event.data)) {
        if (name === "taken") this.taken(value);
        else this.regions(name, value);
      }
    };
    this.socket.onclose = () => {
      this.state(false);
      setTimeout(() => this.open(), RETRY_MS[Math.min(this.tries++, RETRY_MS.length - 1)]);
    };
  }

  /** Sends an input: `{key: "ENT"}`. */
  input(input) {
    const numbered = { n: ++this.number, ...input };
    this.waiting.push(numbered);
    this.keep();
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(numbered));
  }

  /** Asks to operate, or hands over. */
  ask(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  taken(number) {
    // A page that was opened anew under its old name goes on after what was taken.
    this.number = Math.max(this.number, number);
    this.waiting = this.waiting.filter((input) => input.n > number);
    this.keep();
  }

  keep() {
    sessionStorage.setItem("bahn-waiting", JSON.stringify(this.waiting));
    sessionStorage.setItem("bahn-number", String(this.number));
  }
}
