// The page: the text is checked and drawn while typing; the rest is computed when its tab is open.
'use strict';

/** The module, compiled once for all workers, and the script of a worker. */
const program = (() => {
  let loaded = null;
  return () => loaded ||= (async () => {
    if (typeof EMBEDDED !== 'undefined') return EMBEDDED();
    const response = await fetch('overact_bg.wasm');
    if (!response.ok) throw new Error(`overact_bg.wasm can't be loaded: ${response.status}`);
    const module = WebAssembly.compileStreaming && (response.headers.get('content-type') || '').startsWith('application/wasm')
      ? await WebAssembly.compileStreaming(response)
      : await WebAssembly.compile(await response.arrayBuffer());
    return { module, script: 'worker.js' };
  })();
})();

const get = id => document.getElementById(id);

class Page {
  constructor() {
    this.quick = new Calls(program);
    this.long = new Calls(program);
    this.name = 'dualv.toml';
    this.checked = 0;
    this.isRight = false;
    this.model = null;
    this.making = null;
    this.editor = new Editor(get('editor'), () => this.edited());
    this.drawing = new Drawing(get('sheet'), (around, over) => this.quick.call('draw', { around, over }));
    this.logs = new Logs(this);
    this.tabs();
    this.files();
    get('straight').addEventListener('click', () => this.drawing.straight());
    get('stop').addEventListener('click', () => this.long.stop());
    get('effort').addEventListener('change', () => this.stale());
    const given = decodeURIComponent(location.hash.slice(1));
    this.open(given in ROBOTS ? given : 'dualv');
  }

  files() {
    const robots = get('robots');
    robots.append(...Object.keys(ROBOTS).map(name => element('option', {}, name)));
    robots.addEventListener('change', () => this.open(robots.value));
    get('open').addEventListener('click', () => get('file').click());
    get('file').addEventListener('change', async () => {
      const [file] = get('file').files;
      get('file').value = '';
      if (!file) return;
      this.name = file.name;
      this.editor.set(await file.text());
    });
    get('save').addEventListener('click', () => save(this.name, 'text/plain', this.editor.text));
  }

  /** Opens a bundled robot. */
  open(name) {
    get('robots').value = name;
    this.name = `${name}.toml`;
    this.editor.set(ROBOTS[name]);
  }

  described() {
    return { name: this.name, text: this.editor.text };
  }

  edited() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.check(), 250);
    get('sheet').classList.add('stale');
    get('failed').hidden = true;
    this.isRight = false;
    this.stale();
  }

  /** Marks results as those of an older description. */
  stale() {
    this.model = null;
    this.making = null;
    this.long.stop();
    if (this.isRight) this.need();
  }

  async check() {
    const turn = ++this.checked;
    const state = get('state');
    // A running check belongs to an older text.
    this.quick.stop();
    try {
      const said = await this.quick.call('check', this.described());
      if (turn !== this.checked) return;
      this.isRight = true;
      this.editor.show([]);
      state.className = said.note ? '' : 'good';
      state.textContent = `${said.robot}: ${said.legs} legs, ${said.joints} joints, ${said.actuators} actuators, ${said.dof} degrees of freedom${said.note ? `. ${said.note}` : ', no errors'}`;
      get('sheet').classList.remove('stale');
      await this.drawing.show();
      this.need();
    } catch (error) {
      if (turn !== this.checked || error instanceof Stopped) return;
      state.className = 'bad';
      if (error instanceof Problems) {
        this.editor.show(error.problems);
        const count = error.problems.length;
        state.textContent = count === 1 ? '1 error, below its line' : `${count} errors, each below its line`;
      } else state.textContent = error.message;
    }
  }

  /** Compiles the model if the open tab shows it. */
  async need() {
    if (!this.isRight || this.model || this.making || !['parameters', 'operations', 'rust', 'c'].includes(this.tab)) return;
    const values = { ...this.described(), effort: get('effort').value };
    const making = this.making = {};
    const model = await this.work('model', values);
    if (this.making !== making) return;
    this.making = null;
    if (!model) return;
    this.model = model;
    get('parameters').replaceChildren(...parametersOf(model.inspection));
    get('counts').replaceChildren(...operationsOf(model.inspection));
    const stem = this.name.replace(/\.toml$/, '');
    get('rust').replaceChildren(...codeOf([{ name: `${stem}.rs`, text: model.rust }]));
    get('c').replaceChildren(...codeOf([{ name: `${model.c.name}.h`, text: model.c.header }, { name: `${model.c.name}.c`, text: model.c.source }]));
  }

  /** Runs long work with a progress bar; the result is undefined if it fails or is stopped. */
  async work(call, values) {
    this.long.stop();
    const failed = get('failed');
    failed.hidden = true;
    get('work').hidden = false;
    get('progress').removeAttribute('value');
    get('doing').textContent = '';
    const mine = this.working = {};
    try {
      return await this.long.call(call, values, (part, doing) => {
        get('progress').value = part;
        get('doing').textContent = doing;
      });
    } catch (error) {
      if (!(error instanceof Stopped)) {
        failed.textContent = error instanceof Problems ? error.problems.map(described).join('\n\n') : error.message;
        failed.hidden = false;
      }
      return null;
    } finally {
      if (this.working === mine) get('work').hidden = true;
    }
  }

  tabs() {
    const all = [...document.querySelectorAll('[role=tab]')];
    const choose = tab => {
      for (const one of all) {
        const isChosen = one === tab;
        one.setAttribute('aria-selected', isChosen);
        one.tabIndex = isChosen ? 0 : -1;
        get(one.getAttribute('aria-controls')).hidden = !isChosen;
      }
      this.tab = tab.getAttribute('aria-controls');
      get('failed').hidden = true;
      this.need();
    };
    for (const [at, tab] of all.entries()) {
      tab.addEventListener('click', () => choose(tab));
      tab.addEventListener('keydown', event => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = all[(at + step + all.length) % all.length];
        next.focus();
        choose(next);
      });
    }
    this.tab = 'drawing';
  }
}

/** A problem as text, as on the command line. */
function described(one) {
  const place = [one.file, one.line, one.column].filter(part => part !== null && part !== undefined).join(':');
  return `${one.code}: ${one.message}${place ? `\n  in ${place}` : ''}${one.help ? `\n  ${one.help}` : ''}`;
}

const page = new Page();
