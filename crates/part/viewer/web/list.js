// The blocks of the programs: only those in the window are elements of the page, however many there are.

const ROW = 22;
const BEYOND = 8;

export class BlockList {
  // `programs`: their names with first row and count; `onChoose` gets a row.
  constructor(box, rows, programs, onChoose) {
    this.box = box;
    this.rows = rows;
    this.programs = programs;
    this.onChoose = onChoose;
    this.current = -1;
    this.remarks = new Map();
    this.inner = box.appendChild(document.createElement('div'));
    this.inner.className = 'rows';
    this.inner.style.height = `${rows.length * ROW}px`;
    box.addEventListener('scroll', () => this.draw());
    new ResizeObserver(() => {
      this.reveal();
      this.draw();
    }).observe(box);
    box.addEventListener('click', event => {
      const row = event.target.closest('[data-row]');
      if (row) onChoose(Number(row.dataset.row));
    });
    box.addEventListener('keydown', event => this.key(event));
    this.draw();
  }

  // Rows with something to know: 'error' or 'warning'.
  mark(row, kind) {
    if (row !== null && this.remarks.get(row) !== 'error') this.remarks.set(row, kind);
  }

  key(event) {
    const page = Math.max(1, Math.floor(this.box.clientHeight / ROW) - 1);
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity }[event.key];
    if (step === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    const row = Math.min(this.rows.length - 1, Math.max(0, this.current + step));
    this.onChoose(row, Math.sign(step));
  }

  // The block that is executed.
  show(row) {
    if (row === this.current) return;
    this.current = row;
    this.reveal();
    this.draw();
  }

  reveal() {
    const top = this.current * ROW, { scrollTop, clientHeight } = this.box;
    if (this.current < 0 || (top >= scrollTop + ROW && top <= scrollTop + clientHeight - 2 * ROW)) return;
    this.box.scrollTop = top - clientHeight / 3;
  }

  draw() {
    const { scrollTop, clientHeight } = this.box;
    const first = Math.max(0, Math.floor(scrollTop / ROW) - BEYOND);
    const last = Math.min(this.rows.length, Math.ceil((scrollTop + clientHeight) / ROW) + BEYOND);
    const made = [];
    for (let row = first; row < last; row++) made.push(this.element(row));
    this.inner.replaceChildren(...made);
    const active = this.current >= first && this.current < last;
    if (active) this.box.setAttribute('aria-activedescendant', `block-${this.current}`);
    else this.box.removeAttribute('aria-activedescendant');
  }

  element(row) {
    const made = document.createElement('div');
    const program = this.programs.findLast(({ first }) => first <= row);
    const number = document.createElement('span');
    number.className = 'number';
    number.textContent = row - program.first;
    const text = document.createElement('span');
    text.className = 'text';
    text.textContent = this.rows[row];
    made.append(number, text);
    made.className = ['row', this.remarks.get(row) ?? '', row === program.first ? 'begins' : ''].join(' ');
    made.style.top = `${row * ROW}px`;
    made.dataset.row = row;
    made.id = `block-${row}`;
    made.role = 'option';
    made.setAttribute('aria-selected', String(row === this.current));
    made.setAttribute('aria-posinset', row + 1);
    made.setAttribute('aria-setsize', this.rows.length);
    return made;
  }
}
