// Worker for long work: processes numbered calls in order.
'use strict';

if (typeof wasm_bindgen === 'undefined') importScripts('overact.js');

/** State between calls: the last valid description, and the robot with its logs. */
const kept = { description: null, model: null, session: null };
let current = 0;
let defect = null;

function free(what) {
  if (kept[what]) kept[what].free();
  kept[what] = null;
}

function session(name, text) {
  free('session');
  kept.session = new wasm_bindgen.Session(name, text);
  return kept.session;
}

const calls = {
  start({ module }) {
    wasm_bindgen.initSync({ module });
    wasm_bindgen.listen(
      (part, doing) => postMessage({ id: current, part, doing }),
      message => { defect = message; });
  },
  check({ name, text }) {
    const checked = new wasm_bindgen.Description(name, text);
    free('description');
    kept.description = checked;
    return JSON.parse(checked.said());
  },
  draw({ around, over }) {
    return kept.description ? kept.description.drawing(around, over) : null;
  },
  model({ name, text, effort }) {
    const model = new wasm_bindgen.Model(name, text, effort);
    const all = { inspection: JSON.parse(model.inspection()), rust: model.rust(), c: { name: model.c_name(), header: model.c_header(), source: model.c_source() } };
    model.free();
    return all;
  },
  simulate({ name, text }) {
    return JSON.parse(session(name, text).simulate());
  },
  identify({ name, text, logs }) {
    const robot = session(name, text);
    for (const log of logs) robot.add_log(log.name, log.bytes, log.payload, log.held_out);
    const found = robot.identify();
    const all = { summary: found.summary(), page: found.page(), document: found.document(), numbers: found.numbers(), trusted: found.trusted() };
    found.free();
    return all;
  },
};

onmessage = ({ data: { id, call, values } }) => {
  current = id;
  defect = null;
  try {
    postMessage({ id, result: calls[call](values) });
  } catch (error) {
    // Problems are thrown as JSON; anything else is an internal error, after which the module is unusable.
    if (typeof error === 'string') postMessage({ id, problems: JSON.parse(error) });
    else postMessage({ id, defect: defect || String(error) });
  }
};
