// Text editor of the description, with problems below their lines.
//
// The text consists of the text nodes of one element. Problems are elements between them, at the ends of lines,
// and not part of the text. The browser inserts typed text into the text nodes. Undo is implemented here, because
// the browser's own does not know the elements in between.
'use strict';

class Editor {
  constructor(element, changed) {
    this.element = element;
    this.changed = changed;
    this.past = [];
    this.future = [];
    element.contentEditable = 'plaintext-only';
    if (element.contentEditable !== 'plaintext-only') element.contentEditable = 'true';
    element.addEventListener('beforeinput', event => this.before(event));
    element.addEventListener('input', () => this.after());
    element.addEventListener('keydown', event => this.key(event));
    element.addEventListener('compositionstart', () => { this.isComposing = true; });
    element.addEventListener('compositionend', () => { this.isComposing = false; this.after(); });
    element.addEventListener('copy', event => this.copy(event));
    element.addEventListener('cut', event => { this.copy(event); this.replace(''); });
    element.addEventListener('paste', event => {
      event.preventDefault();
      this.replace(event.clipboardData.getData('text/plain').replace(/\r\n?/g, '\n'));
    });
  }

  get text() {
    let text = '';
    for (const node of this.element.childNodes) {
      if (node.nodeType === Node.TEXT_NODE) text += node.data;
      else if (node.nodeName === 'BR') text += '\n';
      else if (!node.classList.contains('problem')) text += node.textContent;
    }
    return text;
  }

  /** Replaces the text; undo restores the previous one. */
  set(text) {
    this.put(text, [0, 0]);
    this.past = [];
    this.future = [];
    this.last = { text, at: [0, 0] };
    this.element.scrollTop = 0;
    this.changed();
  }

  put(text, at) {
    this.element.replaceChildren(document.createTextNode(text.endsWith('\n') ? text : text + '\n'));
    this.select(at);
  }

  /** Number of characters of the text before a position in the document. */
  offset(node, within) {
    let count = 0;
    const children = [...this.element.childNodes];
    for (const [index, child] of children.entries()) {
      if (node === this.element && index >= within) return count;
      const inside = child === node || child.contains(node);
      if (child.nodeType === Node.TEXT_NODE) {
        if (inside) return count + within;
        count += child.data.length;
      } else if (inside) return count;
      else if (child.nodeName === 'BR') count += 1;
    }
    return count;
  }

  /** Start and end of the selected characters. */
  get selected() {
    const selection = getSelection();
    if (!selection.rangeCount || !this.element.contains(selection.anchorNode)) return null;
    const range = selection.getRangeAt(0);
    return [this.offset(range.startContainer, range.startOffset), this.offset(range.endContainer, range.endOffset)];
  }

  select([from, to]) {
    if (document.activeElement !== this.element) return;
    const range = document.createRange();
    range.setStart(...this.place(from));
    range.setEnd(...this.place(to));
    const selection = getSelection();
    selection.removeAllRanges();
    selection.addRange(range);
  }

  /** Text node and offset of a character. */
  place(offset) {
    let last = [this.element, 0];
    for (const child of this.element.childNodes) {
      if (child.nodeType !== Node.TEXT_NODE) continue;
      if (offset <= child.data.length) return [child, offset];
      offset -= child.data.length;
      last = [child, child.data.length];
    }
    return last;
  }

  /** Replaces the selection by a text. */
  replace(inserted) {
    const at = this.selected;
    if (!at) return;
    const text = this.text;
    const [from, to] = at;
    this.put(text.slice(0, from) + inserted + text.slice(to), [from + inserted.length, from + inserted.length]);
    this.after();
    this.reveal();
  }

  before(event) {
    if (event.inputType === 'historyUndo') { event.preventDefault(); this.undo(); }
    if (event.inputType === 'historyRedo') { event.preventDefault(); this.redo(); }
    if (event.inputType === 'insertParagraph' || event.inputType === 'insertLineBreak') {
      event.preventDefault();
      this.replace('\n');
    }
  }

  after() {
    const text = this.text;
    if (this.last && text !== this.last.text) {
      this.past.push(this.last);
      if (this.past.length > 500) this.past.shift();
      this.future = [];
    }
    this.last = { text, at: this.selected || [0, 0] };
    this.changed();
  }

  key(event) {
    const meta = event.ctrlKey || event.metaKey;
    const key = event.key.toLowerCase();
    if (meta && !event.altKey && key === 'z') {
      event.preventDefault();
      if (event.shiftKey) this.redo(); else this.undo();
    } else if (meta && key === 'y') {
      event.preventDefault();
      this.redo();
    }
  }

  undo() { this.step(this.past, this.future); }

  redo() { this.step(this.future, this.past); }

  step(from, to) {
    const state = from.pop();
    if (!state) return;
    to.push(this.last);
    this.last = state;
    this.put(state.text, state.at);
    this.changed();
  }

  copy(event) {
    const at = this.selected;
    if (!at) return;
    event.preventDefault();
    event.clipboardData.setData('text/plain', this.text.slice(...at));
  }

  /** Scrolls to the caret. */
  reveal() {
    const selection = getSelection();
    if (!selection.rangeCount) return;
    const box = selection.getRangeAt(0).getBoundingClientRect();
    const own = this.element.getBoundingClientRect();
    if (box.bottom > own.bottom) this.element.scrollTop += box.bottom - own.bottom + 20;
  }

  /** Shows problems below their lines; those without a line are at the top. */
  show(problems) {
    const isShown = this.element.querySelector('.problem');
    if (this.isComposing || !problems.length && !isShown) return;
    const text = this.text;
    const at = this.selected;
    const scroll = this.element.scrollTop;
    const lines = text.split('\n');
    const parts = [];
    let begun = 0;
    let passed = 0;
    const sorted = [...problems].sort((a, b) => (a.line || 0) - (b.line || 0));
    for (const one of sorted) {
      const line = Math.min(one.line || 0, lines.length);
      while (passed < line) { begun += lines[passed].length + 1; passed += 1; }
      parts.push([Math.min(begun, text.length), one]);
    }
    const nodes = [];
    let from = 0;
    for (const [end, one] of parts) {
      if (end > from) nodes.push(document.createTextNode(text.slice(from, end)));
      from = Math.max(from, end);
      nodes.push(this.problem(one));
    }
    nodes.push(document.createTextNode(text.slice(from)));
    this.element.replaceChildren(...nodes);
    this.element.scrollTop = scroll;
    if (at) this.select(at);
  }

  problem(one) {
    const box = document.createElement('span');
    box.className = 'problem';
    box.contentEditable = 'false';
    box.append(`${one.code}: ${one.message}`);
    if (one.help) {
      const help = document.createElement('i');
      help.append(one.help);
      box.append(help);
    }
    return box;
  }
}
