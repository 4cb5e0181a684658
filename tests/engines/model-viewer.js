// SPDX-License-Identifier: Apache-2.0
import "@google/model-viewer";
import {drive} from "./page.js";

// An environment of 64x32 texels of Radiance HDR that is black but for a patch around a direction.
function environment([x, y, z]) {
  const width = 64, height = 32, texels = new Uint8Array(4 * width * height);
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      const theta = Math.PI * (row + 0.5) / height, phi = 2 * Math.PI * ((column + 0.5) / width - 0.5);
      const toward = [Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi)];
      if (toward[0] * -x + toward[1] * y + toward[2] * z > 0.95)
        texels.set([128, 128, 128, 133], 4 * (row * width + column));
    }
  }
  const head = `#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`;
  return URL.createObjectURL(new Blob([head, texels])) + "#.hdr";  // by its name it is HDR
}

drive(async side => {
  let viewer = null;
  return async ({model}) => {
    viewer?.remove();
    return async light => {
      viewer?.remove();
      viewer = document.createElement("model-viewer");
      viewer.style.cssText = `width: ${side}px; height: ${side}px; background-color: black; --poster-color: transparent`;
      for (const [name, value] of Object.entries({
        "environment-image": environment(light), "camera-orbit": "0deg 90deg 10m", "camera-target": "0m 0m 0m",
        "min-camera-orbit": "auto auto 0m", "field-of-view": `${2 * Math.atan(0.1) * 180 / Math.PI}deg`,
        "min-field-of-view": "1deg", "shadow-intensity": "0", "tone-mapping": "neutral", "interaction-prompt": "none",
        loading: "eager", reveal: "auto", src: model})) viewer.setAttribute(name, value);
      const loaded = new Promise((done, fail) => {
        viewer.addEventListener("load", done);
        viewer.addEventListener("error", event => fail(event.detail?.sourceError ?? "error"));
      });
      document.body.append(viewer);
      await loaded;
      viewer.jumpCameraToGoal();
      await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
      const blob = await viewer.toBlob({idealAspect: false});
      return createImageBitmap(blob);
    };
  };
});
