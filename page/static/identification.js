// Identification from logs, entirely on this machine.
'use strict';

class Logs {
  constructor(page) {
    this.page = page;
    this.logs = [];
    const get = id => document.getElementById(id);
    this.list = get('runs');
    this.from = get('from');
    this.result = get('result');
    const drop = get('drop');
    const input = get('logs');
    get('choose').addEventListener('click', () => input.click());
    input.addEventListener('change', () => { this.add([...input.files]); input.value = ''; });
    for (const name of ['dragenter', 'dragover']) {
      drop.addEventListener(name, event => { event.preventDefault(); drop.classList.add('over'); });
    }
    drop.addEventListener('dragleave', () => drop.classList.remove('over'));
    drop.addEventListener('drop', event => {
      event.preventDefault();
      drop.classList.remove('over');
      this.add([...event.dataTransfer.files]);
    });
    get('simulate').addEventListener('click', () => this.simulate());
    get('identify').addEventListener('click', () => this.identify());
    this.show();
  }

  async add(files) {
    for (const file of files) {
      const bytes = new Uint8Array(await file.arrayBuffer());
      this.logs.push({ name: file.name, bytes, payload: false, held_out: false });
    }
    this.show();
  }

  /** Virtual runs of the description, as logs that can be saved. */
  async simulate() {
    const made = await this.page.work('simulate', this.page.described());
    if (!made) return;
    this.logs = made.map(run => ({
      name: `${run.name}.csv`, bytes: new TextEncoder().encode(run.csv), payload: run.payload, held_out: run.held_out,
    }));
    this.show();
  }

  async identify() {
    const logs = this.logs.map(log => ({ ...log }));
    this.result.replaceChildren();
    const found = await this.page.work('identify', { ...this.page.described(), logs });
    if (found) this.tell(found);
  }

  show() {
    this.list.replaceChildren(...this.logs.map(log => this.item(log)));
    const measured = this.logs.filter(log => !log.held_out).length;
    this.from.textContent = measured ? `from ${measured} of ${this.logs.length} logs` : 'from the virtual experiment of the description';
  }

  item(log) {
    const tick = (key, label) => {
      const box = element('input', { type: 'checkbox' });
      box.checked = log[key];
      box.addEventListener('change', () => { log[key] = box.checked; this.show(); });
      return element('label', {}, box, ` ${label}`);
    };
    const remove = element('button', { type: 'button', 'aria-label': `Remove ${log.name}` }, 'Remove');
    remove.addEventListener('click', () => { this.logs = this.logs.filter(one => one !== log); this.show(); });
    const keep = element('button', { type: 'button', 'aria-label': `Save ${log.name}` }, 'Save');
    keep.addEventListener('click', () => save(log.name, 'application/octet-stream', log.bytes));
    return element('li', {}, element('span', { class: 'name' }, log.name), tick('payload', 'with payload'), tick('held_out', 'validation'), keep, remove);
  }

  tell(found) {
    // The report has no script, and the frame would run none. In a frame without an address, links to anchors would
    // lead to this page.
    const page = found.page.replaceAll('href="#', 'href="about:srcdoc#');
    const frame = element('iframe', { sandbox: 'allow-downloads', title: 'Report of the identification', srcdoc: page });
    this.result.replaceChildren(
      element('p', { class: 'bar' }, saving('report.html', 'text/html', found.page), saving('report.json', 'application/json', found.document), saving('report.csv', 'text/csv', found.numbers)),
      frame,
      element('details', {}, element('summary', {}, 'Output of the command line'), element('pre', { class: 'summary', tabindex: '0' }, found.summary)));
    this.result.found = found;
  }
}
