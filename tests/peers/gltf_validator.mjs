// SPDX-License-Identifier: Apache-2.0
// gltf_validator.mjs: what Khronos' validator says about models, for gltf_validator_test.cpp.
//
//     node gltf_validator.mjs FOLDER-WITH-node_modules LIST [all]
//
// LIST names a file a line. Prints a line for each: CODE@POINTER for each error, separated by blanks, and for each
// unknown word or number, which is only a warning. With "all": CODE for each message of any severity.
import {createRequire} from "node:module";
import fs from "node:fs";
import path from "node:path";

const [modules, list, all] = process.argv.slice(2);
const validator = createRequire(path.resolve(modules, "node_modules/x.js"))("gltf-validator");
for (const file of fs.readFileSync(list, "utf8").split("\n").filter(name => name !== "")) {
  const beside = uri => fs.promises.readFile(path.resolve(path.dirname(file), decodeURIComponent(uri)))
    .then(bytes => new Uint8Array(bytes));
  const options = {uri: path.basename(file), maxIssues: 0, externalResourceFunction: beside};
  let errors;
  try {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), options);
    if (all) {
      console.log(report.issues.messages.map(issue => issue.code).sort().join(" "));
      continue;
    }
    errors = report.issues.messages.filter(issue => issue.severity === 0 || issue.code === "VALUE_NOT_IN_LIST")
      .map(issue => `${issue.code}@${(issue.pointer ?? "").replaceAll(" ", "_")}`);
  } catch (reason) {  // it is no glTF at all
    errors = ["UNREADABLE@"];
  }
  console.log([...new Set(errors)].join(" "));
}
