// SPDX-License-Identifier: Apache-2.0
// page.js: has an engine draw each case of cases.json under each light, and posts the pictures to serve.py.

const post = (path, body) => fetch(path, {method: "POST", body});
const complaints = [];
for (const kind of ["error", "warn"]) {
  const before = console[kind].bind(console);
  console[kind] = (...words) => { complaints.push(words.map(String).join(" ")); before(...words); };
}

// Means of R, G and B of a canvas that the engine has just drawn, one byte a pixel.
function texels(canvas, side) {
  const copy = new OffscreenCanvas(side, side).getContext("2d");
  copy.drawImage(canvas, 0, 0, side, side);
  const rgba = copy.getImageData(0, 0, side, side).data;
  return Uint8Array.from({length: side * side}, (_, k) => (rgba[4 * k] + rgba[4 * k + 1] + rgba[4 * k + 2]) / 3);
}

const patience = milliseconds => new Promise((_, fail) => setTimeout(() => fail("no picture"), milliseconds));

// prepare(case) promises a function that draws the case under the light that comes from a direction, and returns the
// canvas or promises it.
export async function drive(start) {
  try {
    const {side, lights, cases} = await (await fetch("cases.json")).json();
    const prepare = await start(side);
    window.started = true;
    const refused = new Map();  // files that gave no picture, which take long
    for (const one of cases) {
      complaints.length = 0;
      try {
        if (one.map && refused.has(one.map)) throw refused.get(one.map);
        const draw = await Promise.race([prepare(one), patience(120000)]);
        for (const [name, light] of Object.entries(lights)) {
          const canvas = await Promise.race([draw(light), patience(120000)]);
          await post(`${one.id}.${name}.grey`, texels(canvas, side));
        }
      } catch (error) {
        refused.set(one.map, error);
        complaints.unshift(String(error?.stack ?? error));
      }
      if (complaints.length > 0) await post(`${one.id}.txt`, complaints.join("\n"));
    }
    await post("done", "");
  } catch (error) { await post("failed", `${error?.stack ?? error}\n`); }
}
