// Evaluates functions by the page's WebAssembly: `node values.mjs FOLDER ROBOTS < questions`.
//
// A question is a line `STEM FUNCTION SAMPLES INPUTS` and a line of numbers for each input, sample by sample, as
// for tests/compiled/examples/values.rs. The answer is a line of numbers, or one that begins with `error`.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { load } from './module.mjs';

const [folder, robots] = process.argv.slice(2);
const overact = load(folder);
const sessions = new Map();

function session(stem) {
  if (!sessions.has(stem)) {
    // One robot at a time, because a module's memory does not shrink.
    for (const one of sessions.values()) one.free();
    sessions.clear();
    const text = readFileSync(join(robots, `${stem}.toml`), 'utf8');
    sessions.set(stem, new overact.Session(`${stem}.toml`, text));
  }
  return sessions.get(stem);
}

const numbers = line => line.split(' ').filter(word => word).map(Number);
const lines = readFileSync(0, 'utf8').split('\n');
for (let at = 0; lines[at]; ) {
  const [stem, name, samples, count] = lines[at++].split(' ');
  const inputs = lines.slice(at, at += Number(count)).flatMap(numbers);
  try {
    const values = session(stem).values(name, Number(samples), Float64Array.from(inputs));
    console.log([...values].join(' '));
  } catch (error) {
    console.log(`error: ${typeof error === 'string' ? JSON.parse(error)[0].message : error}`);
  }
}
