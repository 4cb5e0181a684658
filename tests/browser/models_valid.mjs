// SPDX-License-Identifier: Apache-2.0
// models_valid.mjs FILES.json: errors and warnings that Khronos' validator finds in an output and not in its original;
// see models.sh.
import {readFileSync} from "fs";
import {createRequire} from "module";
import {dirname, join} from "path";

const validator = createRequire(join(process.cwd(), "modules/"))("gltf-validator");

// How often each code of an error or warning is found.
async function found(file) {
  const external = async uri => new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri))));
  const counts = {};
  try {
    const bytes = new Uint8Array(readFileSync(file));
    const options = {uri: file, externalResourceFunction: external, maxIssues: 0};
    const report = await validator.validateBytes(bytes, options);
    for (const {code, severity} of report.issues.messages) if (severity < 2) counts[code] = (counts[code] || 0) + 1;
  } catch (error) { counts["not examined"] = 1; }
  return counts;
}

const text = readFileSync(process.argv[2], "utf8");
for (const [name, before, after] of JSON.parse(text)) {
  const a = await found(decodeURIComponent(before)), b = await found(decodeURIComponent(after));
  const more = Object.keys(b).filter(code => b[code] > (a[code] || 0));
  if (more.length) console.log(`${name}\tmore errors: ${more.join(" ")}`);
}
