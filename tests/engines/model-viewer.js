// SPDX-License-Identifier: Apache-2.0
// model-viewer.js: the element as its page offers it, with the three.js that is inside its bundle. It has no lamps: a
// light is an environment picture that is black but for a disc.
import {ModelViewerElement} from "@google/model-viewer/dist/model-viewer.js";
import {drive} from "./page.js";

ModelViewerElement.minimumRenderScale = 1;
self.ModelViewerElement = {ktx2TranscoderLocation: "basis/"};  // each element that is made asks for it here

// A Radiance picture of all directions, whose rows are not compressed. u = 1/2 is where x grows, the first row is up.
function environment([x, y, z]) {
  const width = 256, height = 128, head = `#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`;
  const bytes = new Uint8Array(head.length + 4 * width * height);
  bytes.set(new TextEncoder().encode(head));
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      const up = Math.PI * (0.5 - (row + 0.5) / height), around = 2 * Math.PI * ((column + 0.5) / width - 0.5);
      const cosine = Math.cos(up) * (x * Math.cos(around) + z * Math.sin(around)) + y * Math.sin(up);
      if (cosine > 0.98) bytes.set([128, 128, 128, 128 + 3], head.length + 4 * (row * width + column));  // 2^2
    }
  }
  return `${URL.createObjectURL(new Blob([bytes]))}#light.hdr`;
}

const event = (element, name) => new Promise((done, fail) => {
  element.addEventListener(name, done, {once: true});
  element.addEventListener("error", event => fail(String(event.detail?.sourceError ?? "not read")), {once: true});
});
const frame = () => new Promise(requestAnimationFrame);

drive(side => {
  const types = {png: "image/png", ktx2: "image/ktx2"};
  let shown = null;

  return async ({map, model}) => {
    shown?.remove();
    shown = document.createElement("model-viewer");
    shown.style.cssText = `width: ${side}px; height: ${side}px; background-color: black`;
    for (const [name, value] of Object.entries({
      loading: "eager", "tone-mapping": "none", "interaction-prompt": "none", "camera-target": "0m 0m 0m",
      "camera-orbit": "0deg 90deg 20m", "max-camera-orbit": "auto auto 20m", "min-field-of-view": "1deg",
      "field-of-view": `${2 * Math.atan(1 / 20) * 180 / Math.PI}deg`})) shown.setAttribute(name, value);
    const loaded = event(shown, "load");
    shown.src = model;
    document.body.append(shown);
    await loaded;
    if (map) {
      const texture = await shown.createTexture(map, types[map.split(".").pop()]);
      shown.model.materials[0].normalTexture.setTexture(texture);
    }
    return async light => {
      const changed = event(shown, "environment-change");
      shown.environmentImage = environment(light);
      await changed;
      shown.jumpCameraToGoal();
      for (let k = 0; k < 6; ++k) await frame();
      return createImageBitmap(await shown.toBlob({idealAspect: false}));
    };
  };
});
