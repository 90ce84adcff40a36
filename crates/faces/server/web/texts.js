// What stands around the screen, in the language of the control. A text is named by what it is in English; the station
// has the table.

let table = {};
export let language = "en";

/** Of each node: its text, or attributes, by what they are in English. */
const originals = new WeakMap();

/** Fetches the texts of a language, without a code those of the control, and says everything in it. */
export async function load(code) {
  const texts = await (await fetch(`/api/texts${code ? `?language=${code}` : ""}`)).json();
  language = texts.language;
  table = texts.texts;
  document.documentElement.lang = language;
  adopt(document);
}

/** A text in the language, with values in place of {1} and {2}. */
export function words(english, ...values) {
  return (table[english] ?? english).replace(/\{(\d)\}/g, (_, place) => values[place - 1]);
}

/** A node says a text, or a function's answer, in whatever language comes: as its text, or as one of its attributes. */
export function say(node, english, attribute = "text") {
  originals.set(node, { ...originals.get(node), [attribute]: english });
  node.dataset.words = Object.keys(originals.get(node)).join(" ");
  put(node);
}

/** Nodes of the page itself name what is to be said in another language: data-words="text title". */
export function adopt(root) {
  for (const node of root.querySelectorAll("[data-words]")) {
    if (!originals.has(node)) {
      const read = (name) => [name, name === "text" ? node.textContent : node.getAttribute(name)];
      originals.set(node, Object.fromEntries(node.dataset.words.split(" ").map(read)));
    }
    put(node);
  }
}

function put(node) {
  for (const [name, english] of Object.entries(originals.get(node))) {
    const text = typeof english === "function" ? english() : words(english);
    if (name !== "text") node.setAttribute(name, text);
    else if (node.textContent !== text) node.textContent = text;
  }
}
