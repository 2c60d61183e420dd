// A headless Chromium, controlled through a pipe (DevTools protocol) and always ended.

import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { delimiter, join } from 'node:path';
import { tmpdir } from 'node:os';

/** The browser's program, or null. */
export function browser() {
  if (process.env.OVERACT_CHROMIUM) return process.env.OVERACT_CHROMIUM;
  const names = ['chromium', 'chromium-browser', 'google-chrome', 'chrome'];
  const folders = (process.env.PATH || '').split(delimiter);
  return folders.flatMap(folder => names.map(name => join(folder, name))).find(existsSync) || null;
}

const FLAGS = [
  '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--hide-scrollbars', '--remote-debugging-pipe',
];

export class Chromium {
  constructor(program) {
    this.profile = mkdtempSync(join(tmpdir(), 'overact-page-'));
    this.process = spawn(program, [...FLAGS, `--user-data-dir=${this.profile}`], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    this.waiting = new Map();
    this.listeners = [];
    this.next = 1;
    let rest = '';
    this.process.stdio[4].on('data', data => {
      const parts = (rest + data).split('\0');
      rest = parts.pop();
      for (const part of parts) this.hear(JSON.parse(part));
    });
    this.process.on('exit', () => {
      for (const { reject } of this.waiting.values()) reject(new Error('the browser has ended'));
      this.waiting.clear();
    });
  }

  hear(message) {
    if (!message.id) return this.listeners.forEach(listener => listener(message));
    const call = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) call?.reject(new Error(`${call.method}: ${message.error.message}`));
    else call?.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    const id = this.next++;
    this.process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject, method }));
  }

  /** A new tab. */
  async tab(url) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const tab = new Tab(this, sessionId);
    await tab.begin(url);
    return tab;
  }

  /** Ends the browser, and removes its files once all of its processes have released them. */
  async end() {
    const gone = new Promise(resolve => this.process.on('exit', resolve));
    this.process.kill('SIGKILL');
    await gone;
    for (let attempt = 0; attempt < 20; attempt++) {
      try {
        return rmSync(this.profile, { recursive: true, force: true });
      } catch {
        await new Promise(resolve => setTimeout(resolve, 100));
      }
    }
  }
}

export class Tab {
  constructor(chromium, session) {
    this.chromium = chromium;
    this.session = session;
    /** Errors that the page logged. */
    this.complaints = [];
    this.requests = [];
    chromium.listeners.push(({ sessionId, method, params }) => {
      if (sessionId !== session) return;
      if (method === 'Runtime.exceptionThrown') this.complaints.push(params.exceptionDetails.exception?.description || params.exceptionDetails.text);
      if (method === 'Log.entryAdded' && params.entry.level === 'error') this.complaints.push(`${params.entry.text} ${params.entry.url || ''}`);
      if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    });
  }

  send(method, params) { return this.chromium.send(method, params, this.session); }

  async begin(url) {
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await this.send(`${domain}.enable`);
    await this.send('Page.navigate', { url });
  }

  /** Evaluates an expression in the page. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description || exceptionDetails.text}`);
    return result.value;
  }

  /** Waits until an expression is true, with a time limit in seconds. */
  async until(expression, seconds = 60) {
    const end = Date.now() + 1000 * seconds;
    while (Date.now() < end) {
      const found = await this.value(`(() => { try { return ${expression}; } catch { return false; } })()`);
      if (found) return found;
      await new Promise(resolve => setTimeout(resolve, 100));
    }
    throw new Error(`not within ${seconds} s: ${expression}; ${this.complaints.join('; ')}`);
  }

  async click(id) { await this.value(`document.getElementById('${id}').click()`); }

  /** Chooses files in an input. */
  async files(id, files) {
    const { result } = await this.send('Runtime.evaluate', { expression: `document.getElementById('${id}')` });
    await this.send('DOM.setFileInputFiles', { files, objectId: result.objectId });
  }

  async type(text) { await this.send('Input.insertText', { text }); }

  async key(key, code, modifiers = 0) {
    const isEnter = key === 'Enter';
    const event = { key, code, modifiers, windowsVirtualKeyCode: isEnter ? 13 : key.toUpperCase().charCodeAt(0) };
    await this.send('Input.dispatchKeyEvent', isEnter ? { type: 'keyDown', text: '\r', ...event } : { type: 'rawKeyDown', ...event });
    await this.send('Input.dispatchKeyEvent', { type: 'keyUp', ...event });
  }

  async drag([x, y], [right, down]) {
    const mouse = (type, dx, dy) => this.send('Input.dispatchMouseEvent', { type, x: x + dx, y: y + dy, button: 'left', buttons: 1, clickCount: 1 });
    await mouse('mousePressed', 0, 0);
    for (const part of [0.25, 0.5, 0.75, 1]) await mouse('mouseMoved', right * part, down * part);
    await mouse('mouseReleased', right, down);
  }

  /** Sets the size and colour scheme of the window. */
  async look(width, height, dark) {
    await this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: width < 600 });
    await this.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });
  }

  async picture() {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png' });
    return Buffer.from(data, 'base64');
  }
}
