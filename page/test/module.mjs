// The page's WebAssembly in Node.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import vm from 'node:vm';

/** Functions and classes of the module in the folder that page/build wrote. */
export function load(folder) {
  const glue = readFileSync(join(folder, 'overact.js'), 'utf8');
  const overact = vm.runInThisContext(`${glue}\n;wasm_bindgen`);
  overact.initSync({ module: readFileSync(join(folder, 'overact_bg.wasm')) });
  overact.listen(() => {}, defect => { throw new Error(defect); });
  return overact;
}
