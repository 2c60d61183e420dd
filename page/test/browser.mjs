// Tests of the page in a headless Chromium: a typed description is checked, corrected, drawn, rotated, generated and
// identified, with the numbers of the command line.
//
// node browser.mjs FOLDER: the folder that page/build wrote. OVERACT_BINARY is the command line (default
// target/debug/overact), OVERACT_CHROMIUM the browser, OVERACT_SCREENSHOTS a folder for pictures. Tests without their
// programs are skipped with a message. The time limit is fifteen minutes.

import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { Chromium, browser } from './chromium.mjs';
import { serve } from './host.mjs';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const folder = resolve(process.argv[2] || join(root, 'target/page'));
const binary = process.env.OVERACT_BINARY || join(root, 'target/debug/overact');
const program = browser();
if (!program) skip('there is no browser; set OVERACT_CHROMIUM to a Chromium');
if (!existsSync(join(folder, 'overact_bg.wasm'))) skip(`there is no page in ${folder}`);

function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(0);
}

/** A DualV with short virtual runs, in a separate folder. */
const short = mkdtempSync(join(tmpdir(), 'overact-page-'));
const description = readFileSync(join(root, 'robots/dualv.toml'), 'utf8').replaceAll('duration = "10 s"', 'duration = "1.5 s"');
writeFileSync(join(short, 'dualv.toml'), description);

const chromium = new Chromium(program);
const { server, address } = await serve(folder);
const limit = setTimeout(() => end(new Error('fifteen minutes are over')), 900000);
const failures = [];

async function end(error) {
  clearTimeout(limit);
  await chromium.end();
  server.close();
  rmSync(short, { recursive: true, force: true });
  if (error) console.error(error.stack || String(error));
  for (const one of failures) console.error(`failed: ${one}`);
  process.exit(error || failures.length ? 1 : 0);
}

function holds(what, condition, seen = '') {
  console.log(`${condition ? 'ok    ' : 'FAILED'} ${what}${seen === '' ? '' : `: ${seen}`}`);
  if (!condition) failures.push(`${what}: ${seen}`);
}

/** Largest relative difference of the numbers of two documents, and its location. */
function difference(own, other, path = '') {
  if (typeof own === 'number' && typeof other === 'number') {
    const size = Math.max(Math.abs(own), Math.abs(other), 1e-9);
    return [Math.abs(own - other) / size, path];
  }
  if (own && other && typeof own === 'object' && typeof other === 'object') {
    const keys = [...new Set([...Object.keys(own), ...Object.keys(other)])];
    return keys.map(key => difference(own[key], other[key], `${path}.${key}`)).reduce((a, b) => (b[0] > a[0] ? b : a), [0, '']);
  }
  return [own === other ? 0 : Infinity, `${path}: ${own} and ${other}`];
}

/** Output of the command line, or null without it. */
function command(...words) {
  if (!existsSync(binary)) return null;
  return execFileSync(binary, words, { cwd: join(root, 'robots'), maxBuffer: 1 << 28, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
}

try {
  const tab = await chromium.tab(address);
  await loads(tab);
  await edits(tab);
  await turns(tab);
  await generates(tab);
  await identifies(tab);
  await refuses(tab);
  await fits(tab);
  holds('no complaint of the browser', tab.complaints.length === 0, tab.complaints.join('; '));
  const foreign = tab.requests.filter(url => !url.startsWith(address) && !url.startsWith('blob:') && !url.startsWith('data:'));
  holds('no request leaves the host', foreign.length === 0, foreign.join(' '));
  await opensAsOneFile();
  await end();
} catch (error) {
  await end(error);
}

async function loads(tab) {
  await tab.look(1280, 900, false);
  const shown = "document.getElementById('state').className === 'good' && document.querySelector('#sheet svg')";
  await tab.until(shown);
  let time = await tab.value('performance.now()');
  // Three attempts, because the machine may be busy.
  for (let attempt = 1; attempt < 3 && time >= 3000; attempt++) {
    await tab.send('Page.reload', { ignoreCache: true });
    await new Promise(resolve => setTimeout(resolve, 500));
    await tab.until(shown);
    time = Math.min(time, await tab.value('performance.now()'));
  }
  holds('loaded, checked and drawn in 3 s', time < 3000, `${Math.round(time)} ms`);
}

async function edits(tab) {
  const text = await tab.value('page.editor.text');
  await tab.value("document.getElementById('editor').focus()");
  await tab.value("page.editor.select([page.editor.text.indexOf('motion = '), page.editor.text.indexOf('motion = ')])");
  await tab.type('nonsense = 1');
  await tab.key('Enter', 'Enter');
  await tab.until("document.querySelector('#editor .problem')");
  const below = await tab.value("document.querySelector('#editor .problem').previousSibling.data.trimEnd().split('\\n').pop()");
  const told = await tab.value("document.querySelector('#editor .problem').textContent");
  holds('an error stands below its line', below === 'nonsense = 1', below);
  holds('with its code', /^OA\d+: .*nonsense/.test(told), told);
  holds('and is no part of the text', !(await tab.value('page.editor.text')).includes('OA'));
  await picture(tab, 'error');
  await tab.key('z', 'KeyZ', 2);
  await tab.key('z', 'KeyZ', 2);
  await tab.until("document.getElementById('state').className === 'good'");
  holds('undone, it is mended', await tab.value('page.editor.text') === text);
  holds('and the error is gone', await tab.value("!document.querySelector('#editor .problem')"));
  await tab.value("document.getElementById('editor').focus(); page.editor.select([0, 0])");
  await tab.key('Enter', 'Enter');
  await tab.type('# typed');
  const typed = await tab.value('page.editor.text');
  holds('what is typed is in the text', typed.startsWith('\n# typed'), typed.slice(0, 20));
  await tab.value("page.editor.undo(); page.editor.undo(); page.editor.undo()");
  await tab.until("document.getElementById('state').className === 'good'");
}

async function turns(tab) {
  const before = await tab.value("document.querySelector('#sheet svg').outerHTML");
  const place = await tab.value("(box => [box.x + box.width / 2, box.y + box.height / 2])(document.getElementById('sheet').getBoundingClientRect())");
  await tab.drag(place, [90, 40]);
  await tab.until(`document.querySelector('#sheet svg').outerHTML.length !== ${before.length}`);
  holds('the mouse turns the drawing', await tab.value("page.drawing.angles.every(one => one !== 0)"));
  await tab.click('straight');
  await new Promise(resolve => setTimeout(resolve, 500));
  holds('and it turns back', await tab.value("document.querySelector('#sheet svg').outerHTML") === before);
}

async function generates(tab) {
  await tab.click('tab-operations');
  await tab.until('page.model', 120);
  const own = await tab.value('page.model.inspection');
  const rows = await tab.value("document.querySelectorAll('#counts tbody tr').length");
  holds('a row for each function', rows === own.functions.length, rows);
  await tab.click('tab-parameters');
  const base = await tab.value("document.querySelectorAll('#parameters tbody tr').length");
  holds('a row for each base parameter', base === own.base_parameters.length, base);
  const told = command('inspect', 'dualv.toml', '--effort', 'quick', '--json');
  if (!told) return console.log('skipped: no command line to compare with');
  const other = JSON.parse(told);
  const [most, where] = difference(own.base_parameters, other.base_parameters);
  holds('base parameters and regroupings are those of `overact inspect`', most < 1e-9, `${most} ${where}`);
  const counts = own.functions.map((one, at) => [one.function, one.operations, other.functions[at].operations]);
  const differing = counts.filter(([, one, two]) => one !== two);
  // Sines of constants may differ in the last digit from those of the other C library, and with them which
  // expressions are equal.
  holds('operations too, to 1 %', counts.every(([, one, two]) => Math.abs(one - two) <= 0.01 * two), `${differing.length} of ${counts.length} differ: ${differing.join(' ')}`);
  await tab.value("document.getElementById('effort').value = 'none'; page.stale()");
  await tab.until('page.model', 120);
  const rust = command('generate', 'dualv.toml', '--effort', 'none');
  sameCode('the Rust is that of `overact generate`', await tab.value('page.model.rust'), rust);
  const c = JSON.parse(command('generate', 'dualv.toml', '--effort', 'none', '--lang', 'c', '--json'));
  const [header, source] = c.robots[0].files.map(file => file.source);
  sameCode('so is the header of C', await tab.value('page.model.c.header'), header);
  sameCode('and its source', await tab.value('page.model.c.source'), source);
}

/** Asserts that two texts of code differ in the last digits of constants at most. */
function sameCode(what, own, other) {
  const number = /\d+(\.\d+)?(e[-+]?\d+)?/g;
  const isSame = own.replace(number, '#') === other.replace(number, '#');
  const [most] = isSame ? difference(own.match(number).map(Number), other.match(number).map(Number)) : [Infinity];
  holds(what, most < 1e-9, most);
}

async function identifies(tab) {
  await tab.value(`page.editor.set(${JSON.stringify(description)})`);
  await tab.until("document.getElementById('state').className === 'good'");
  await tab.click('tab-identification');
  const virtual = await identified(tab);
  holds('the report is shown', await tab.value("document.querySelector('iframe').srcdoc.includes('Identification of')"));
  // A separate process lays out the frame.
  if (process.env.OVERACT_SCREENSHOTS) await new Promise(resolve => setTimeout(resolve, 3000));
  await picture(tab, 'report');
  await tab.click('simulate');
  await tab.until('page.logs.logs.length > 0', 120);
  const named = await tab.value("document.querySelectorAll('#runs li').length");
  await tab.value("page.logs.logs[0].name = '<img src=x onerror=\"window.hostile = 1\">.csv'; page.logs.show()");
  holds('a run is a log each', named === await tab.value('page.logs.logs.length'), named);
  const again = await identified(tab);
  const [most, where] = difference(values(virtual), values(again));
  holds('logs of the virtual runs give the same parameters', most < 1e-9, `${most} ${where}`);
  holds('a hostile name is a name', await tab.value("!window.hostile && !document.querySelector('#runs img')"));
  if (existsSync(binary)) await identifiesAsTheCommand(tab, virtual);
}

async function identified(tab) {
  await tab.value('page.logs.result.found = null');
  const begin = Date.now();
  await tab.click('identify');
  await tab.until('page.logs.result.found', 400);
  console.log(`       identified in ${((Date.now() - begin) / 1000).toFixed(1)} s`);
  return JSON.parse(await tab.value('page.logs.result.found.document'));
}

/** The same logs for both. */
async function identifiesAsTheCommand(tab, virtual) {
  const run = (...words) => execFileSync(binary, words, { cwd: short, maxBuffer: 1 << 28, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
  const { runs } = JSON.parse(run('simulate', 'dualv.toml', '-o', 'logs/', '--json'));
  const heldOut = await tab.value('page.logs.logs.map(log => log.held_out)');
  const kinds = runs.map((one, at) => [one.file, one.payload, heldOut[at]]);
  await tab.value('page.logs.logs = []; page.logs.show()');
  await tab.files('logs', kinds.map(([file]) => join(short, file)));
  await tab.until(`document.querySelectorAll('#runs li').length === ${kinds.length}`);
  for (const [at, [, payload, held]] of kinds.entries()) {
    for (const [box, wanted] of [payload, held].entries()) {
      if (wanted) await tab.value(`document.querySelectorAll('#runs li')[${at}].querySelectorAll('input')[${box}].click()`);
    }
  }
  const own = await identified(tab);
  const option = (name, payload, held) => {
    const files = kinds.filter(one => one[1] === payload && one[2] === held).map(one => one[0]);
    return files.length ? [name, ...files] : [];
  };
  const words = [...option('--data', false, false), ...option('--payload-data', true, false), ...option('--cross-validate', false, true), ...option('--cross-validate-payload', true, true)];
  const [most, where] = difference(values(own), values(JSON.parse(run('identify', 'dualv.toml', ...words, '--json'))));
  holds('parameters from logs are those of `overact identify`', most < 1e-6, `${most} ${where}`);
  // A rounding difference of one encoder step affects the controller and everything after it.
  const made = values(JSON.parse(run('identify', 'dualv.toml', '--json')));
  const far = values(virtual).flatMap((all, at) => all.map((one, k) => Math.abs(one.value - made[at][k].value) / (made[at][k].standard_deviation || 1)));
  holds('those of the virtual experiment are within a standard deviation', Math.max(...far) < 1, Math.max(...far));
}

/** Estimates with their standard deviations. */
function values(document) {
  return document.estimates.map(one => one.parameters.map(({ name, value, standard_deviation }) => ({ name, value, standard_deviation })));
}

async function refuses(tab) {
  await tab.value("page.logs.logs = [{ name: '<b>x</b>.csv', bytes: new TextEncoder().encode('a,b\\n1,<script>\\n'), payload: false, held_out: false }]; page.logs.show()");
  await tab.click('identify');
  await tab.until("!document.getElementById('failed').hidden", 60);
  const told = await tab.value("document.getElementById('failed').textContent");
  holds('a log that is none is refused with its name', told.includes('<b>x</b>.csv'), told.slice(0, 120));
  await tab.value("page.logs.logs = []; page.logs.show()");
  const hostile = String.raw`ROBOTS.emps.replace(/name = ".*"/, 'name = "<img src=x onerror=alert(1)></svg><script>window.hostile = 1</script>"')`;
  await tab.value(`page.editor.set(${hostile}); document.getElementById('tab-drawing').click()`);
  await tab.until("document.getElementById('state').className !== 'good' || document.getElementById('state').textContent.includes('img')", 30);
  await new Promise(resolve => setTimeout(resolve, 800));
  holds('hostile text is no markup', await tab.value("!window.hostile && !document.querySelector('img') && !document.querySelector('#sheet script')"), await tab.value("document.getElementById('state').textContent"));
  await tab.value("page.open('dualv')");
  await tab.until("document.getElementById('state').className === 'good'");
}

/** Saves a screenshot if a folder for pictures is given. */
async function picture(tab, name) {
  const folder = process.env.OVERACT_SCREENSHOTS;
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await tab.value("document.getElementById(innerWidth < 600 ? 'right' : 'left').scrollIntoView()");
  await new Promise(resolve => setTimeout(resolve, 300));
  writeFileSync(join(folder, `${name}.png`), await tab.picture());
}

async function fits(tab) {
  for (const [width, height] of [[1280, 900], [390, 844]]) {
    for (const dark of [false, true]) {
      await tab.look(width, height, dark);
      for (const shown of ['drawing', 'parameters', 'operations', 'rust', 'identification']) {
        await tab.click(`tab-${shown}`);
        if (shown !== 'drawing' && shown !== 'identification') await tab.until('page.model', 120);
        const overflow = await tab.value('document.documentElement.scrollWidth - innerWidth');
        holds(`${shown} fits ${width} px, ${dark ? 'dark' : 'light'}`, overflow <= 0, overflow);
        if (shown === 'parameters') {
          const terms = await tab.value("[...document.querySelectorAll('#parameters .term')].map(one => one.getClientRects().length)");
          holds('sums are broken between their terms alone', terms.length > 0 && terms.every(one => one === 1), `${terms.length} terms`);
        }
        await picture(tab, `${shown}-${width}-${dark ? 'dark' : 'light'}`);
      }
    }
  }
}

async function opensAsOneFile() {
  const tab = await chromium.tab(pathToFileURL(join(folder, 'overact.html')).href);
  await tab.until("document.getElementById('state').className === 'good' && document.querySelector('#sheet svg')");
  holds('the one file opens from a disk', true, `${Math.round(await tab.value('performance.now()'))} ms`);
  holds('without a complaint', tab.complaints.length === 0, tab.complaints.join('; '));
}
