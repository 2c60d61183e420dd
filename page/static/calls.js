// Calls of a worker as promises; stopping a call ends its worker, and the next call starts a new one.
'use strict';

/** Error with the problems of a description or a log. */
class Problems extends Error {
  constructor(problems) {
    super(problems.map(one => one.message).join('\n'));
    this.problems = problems;
  }
}

/** Error of work that newer work replaced. */
class Stopped extends Error {}

class Calls {
  /** @param {() => Promise<{module: WebAssembly.Module, script: string}>} program */
  constructor(program) {
    this.program = program;
    this.worker = null;
    this.waiting = new Map();
    this.next = 1;
  }

  async ready() {
    if (this.worker) return this.worker;
    const { module, script } = await this.program();
    if (this.worker) return this.worker;
    const worker = new Worker(script);
    worker.onmessage = ({ data }) => this.hear(data);
    worker.onerror = event => this.end(new Error(event.message || 'the worker could not be started'));
    this.worker = worker;
    worker.postMessage({ id: 0, call: 'start', values: { module } });
    return worker;
  }

  hear(data) {
    const call = this.waiting.get(data.id);
    if (data.defect && data.id === 0) return this.end(new Error(data.defect));
    if (!call) return;
    if ('part' in data) return call.progress(data.part, data.doing);
    this.waiting.delete(data.id);
    if (data.problems) call.reject(new Problems(data.problems));
    else if (data.defect) {
      call.reject(new Error(`overact itself failed, which is a defect of it: ${data.defect}`));
      this.end(new Stopped());
    } else call.resolve(data.result);
  }

  /** Ends the worker and rejects pending calls with the reason. */
  end(error) {
    if (this.worker) this.worker.terminate();
    this.worker = null;
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    for (const call of waiting) call.reject(error);
  }

  stop() {
    if (this.waiting.size) this.end(new Stopped());
  }

  async call(call, values, progress = () => {}, transfer = []) {
    const worker = await this.ready();
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject, progress });
      worker.postMessage({ id, call, values }, transfer);
    });
  }
}
