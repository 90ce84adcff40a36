"use strict";
const body = document.querySelector("tbody");
document.getElementById("find").addEventListener("input", event => {
  const wanted = event.target.value.toLowerCase();
  for (const row of body.rows) row.hidden = !row.textContent.toLowerCase().includes(wanted);
});
document.querySelectorAll("th").forEach((head, column) => {
  let turn = 1;
  head.addEventListener("click", () => {
    const text = row => row.cells[column].innerText;
    const sorted = [...body.rows].sort((a, b) => turn * text(a).localeCompare(text(b), undefined, { numeric: true }));
    turn = -turn;
    body.append(...sorted);
  });
});
