// The part that is being cut, from every side: the viewer's modules, fed by what the station sends of it.

import { GrowingPath } from "/web/viewer/codec.js";
import { buttons } from "/web/viewer/controls.js";
import { Overlay } from "/web/viewer/overlay.js";
import { PartView } from "/web/viewer/view.js";
import { setText } from "/web/screen.js";
import { adopt, words } from "/web/texts.js";

const KEPT = "bahn-3d-view";
const NOTHING = "Nothing is cut yet. TEST RUN and program run show their part here.";

const linear = (colour) => colour.map((value) => (value / 255) ** 2.2);

export class PartWindow {
  /** In a node of the page; calls `looks(on)` when the operator looks at the part, and when he does not any more. */
  constructor(node, looks) {
    this.node = node;
    this.looks = looks;
    this.button = document.querySelector('[data-key="3D_VIEW"]');
    this.button.addEventListener("click", () => this.turnOn(!this.on));
    this.clear();
    this.on = localStorage.getItem(KEPT) === "on";
    this.show();
    // The connection may be there already, or not yet.
    if (this.on) looks(true);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.tint());
  }

  turnOn(on) {
    this.on = on;
    localStorage.setItem(KEPT, on ? "on" : "off");
    this.show();
    this.looks(on);
  }

  show() {
    this.node.hidden = !this.on;
    this.button.setAttribute("aria-pressed", String(this.on));
  }

  /** Another language. */
  retell() {
    setText(this.node.querySelector(".nothing"), words(this.said));
    this.controls?.retell();
  }

  /** A new connection: what was sent over the old one is not known there. */
  connected() {
    if (this.on) this.looks(true);
  }

  /** Nothing to be seen. */
  clear() {
    this.view?.gl.getExtension("WEBGL_lose_context")?.loseContext();
    this.view = null;
    this.controls = null;
    this.head = null;
    this.id = null;
    this.stage(NOTHING);
  }

  stage(said) {
    this.node.replaceChildren(document.querySelector("#stage").content.cloneNode(true));
    adopt(this.node);
    this.said = said;
    const nothing = this.node.querySelector(".nothing");
    setText(nothing, words(said));
    nothing.hidden = !said;
    this.node.classList.toggle("empty", Boolean(said));
  }

  /** What is new; null: there is no part. */
  take(news) {
    if (!this.on) return;
    if (!news) {
      this.clear();
      return;
    }
    if (news.head) this.begin(news.head, news.id);
    // What is about another part than the page has leads nowhere: the station is asked for all of it.
    if (news.id !== this.id) this.looks(true);
    if (news.id !== this.id || !this.view) return;
    if (news.colours) this.paint(news.colours);
    if (news.tiles) this.view.tiles(news.tiles);
    if (news.path) {
      this.path.take(news.from, news.path);
      this.view.path(this.path, news.from);
    }
    this.tool(news);
  }

  /** Another part. One as large is looked at from where the last one was. */
  begin(head, id) {
    const alike = this.view && JSON.stringify([this.head.size, this.head.cells, this.head.axes]) === JSON.stringify([head.size, head.cells, head.axes]);
    this.head = head;
    this.id = id;
    this.path = new GrowingPath();
    if (alike) {
      this.view.whole();
      this.view.path(this.path);
      return;
    }
    this.view?.gl.getExtension("WEBGL_lose_context")?.loseContext();
    this.stage("");
    const canvas = this.node.querySelector("canvas");
    try {
      this.view = new PartView(canvas, { size: head.size, cells: head.cells });
    } catch (error) {
      this.view = null;
      this.stage(error.message);
      return;
    }
    this.node.view = this.view;
    this.overlay = new Overlay(this.node.querySelector("svg"), this.view, head.axes);
    this.controls = buttons(this.node, this.view, this.overlay, head, words);
    // Whoever turns the part with the mouse goes on typing for the control.
    canvas.addEventListener("mousedown", (event) => event.preventDefault());
    this.tint();
  }

  paint({ tools, marks }) {
    this.tools = tools;
    this.view.markColours(marks.flatMap((cutter) => cutter.marks.map((mark, k) => [mark, cutter.colours[k]])));
    this.tint();
  }

  // Colours of lines follow the scheme of the page.
  tint() {
    if (!this.view) return;
    const style = getComputedStyle(this.node);
    const colour = (name) => style.getPropertyValue(name).match(/[\da-f]{2}/gi).map((hex) => parseInt(hex, 16) / 255);
    const plain = colour("--path");
    const tools = this.tools ?? [];
    const tints = tools.map((tool) => (tools.length > 2 && tool.colour ? tool.colour.map((value) => value / 255) : plain));
    this.view.lineTints(tints, colour("--rapid"), colour("--edge"));
  }

  tool({ tool, at }) {
    const { view } = this;
    view.toolAt = at ?? null;
    const shape = this.tools?.[tool];
    if (shape) {
      view.tool.tint = linear(shape.colour ?? [190, 192, 196]);
      view.tool.take(shape.radius > 0 ? shape : null);
    }
    view.changed();
  }
}
