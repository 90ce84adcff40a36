// The colours of the page: calm ones, or those that the machine parameters of the control say (MP7350 to MP7363). The choice
// is kept in the browser. The layout is that of the control model.

const KEPT = "bahn-scheme";
const display = document.querySelector(".display");

export function build(changed) {
  const select = document.querySelector("#scheme");
  select.value = localStorage.getItem(KEPT) === "control" ? "control" : "calm";
  const choose = () => {
    localStorage.setItem(KEPT, select.value);
    display.classList.toggle("control", select.value === "control");
    changed();
  };
  select.addEventListener("change", choose);
  choose();
}

/** How the screen of the control is made. */
export function look({ layout, letters, colours }) {
  document.body.dataset.layout = layout;
  document.body.dataset.letters = letters;
  const known = Object.entries(colours);
  display.classList.toggle("monochrome", known.length === 0);
  for (const [name, colour] of known) display.style.setProperty(`--mp-${name.replace(".", "-")}`, colour);
}

/** The side of the screen that has the keys has its own colours. */
export function side(headings) {
  const active = headings.find((heading) => heading.active);
  display.classList.toggle("programming", ["PROGRAM", "TEST"].includes(active?.key));
}
