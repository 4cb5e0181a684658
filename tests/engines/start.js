// SPDX-License-Identifier: Apache-2.0
// start.js: what a page cannot load or catch before its first case ends the run.
for (const kind of ["error", "unhandledrejection"]) {
  addEventListener(kind, event => {
    const text = String(event.reason?.stack ?? event.message ?? event.reason);
    if (window.started) console.error(text);
    else fetch("failed", {method: "POST", body: `${text}\n`});
  });
}
