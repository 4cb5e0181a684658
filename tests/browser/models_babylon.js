// SPDX-License-Identifier: Apache-2.0
// models_babylon.js: draws a model by Babylon.js; see models.sh.

import * as BABYLON from "@babylonjs/core";
import "@babylonjs/loaders/glTF";
import {MeshoptDecoder} from "three/examples/jsm/libs/meshopt_decoder.module.js";
import {Decoder} from "./babylon-ktx2.js";

// Its own decoders are on a server of Babylon.js.
const kSide = 256, kDraco = "./modules/node_modules/three/examples/jsm/libs/draco/gltf/";
const draco = {wasmUrl: kDraco + "draco_wasm_wrapper.js", wasmBinaryUrl: kDraco + "draco_decoder.wasm",
               fallbackUrl: kDraco + "draco_decoder.js", numWorkers: 0};
BABYLON.DracoDecoder.DefaultConfiguration = draco;
BABYLON.DracoCompression.Configuration = {decoder: draco};
BABYLON.MeshoptCompression._Default = {
  decodeGltfBufferAsync: async (source, count, stride, mode, filter) => {
    await MeshoptDecoder.ready;
    const target = new Uint8Array(count * stride);
    MeshoptDecoder.decodeGltfBuffer(target, count, stride, source, mode, filter);
    return target;
  }
};
BABYLON.KhronosTextureContainer2.DefaultNumWorkers = 0;
globalThis.KTX2DECODER = {KTX2Decoder: Decoder, MSCTranscoder: {}, WASMMemoryManager: {}};

const canvas = document.body.appendChild(document.createElement("canvas"));
canvas.width = canvas.height = kSide;
const engine = new BABYLON.Engine(canvas, false, {preserveDrawingBuffer: true}, false);

// From the front, from behind and above, with a light beside the camera, which shows what normals do.
export async function drawn(file) {
  const scene = new BABYLON.Scene(engine), {Vector3} = BABYLON;
  try {
    scene.useRightHandedSystem = true;
    scene.clearColor = new BABYLON.Color4(0, 0, 0, 1);
    await BABYLON.AppendSceneAsync(file, scene, {pluginOptions: {gltf: {animationStartMode: 0}}});
    for (const light of scene.lights) light.setEnabled(false);
    const light = new BABYLON.DirectionalLight("light", new Vector3(0, -1, 0), scene);
    light.intensity = 3;
    new BABYLON.HemisphericLight("ambient", new Vector3(0, 1, 0), scene).intensity = 0.3;
    const {min, max} = scene.getWorldExtends();
    const center = min.add(max).scale(0.5), r = max.subtract(min).length() / 2 || 1;
    const camera = new BABYLON.FreeCamera("camera", center, scene);
    camera.mode = BABYLON.Camera.ORTHOGRAPHIC_CAMERA;
    camera.orthoLeft = camera.orthoBottom = -r;
    camera.orthoRight = camera.orthoTop = r;
    camera.minZ = 0;
    camera.maxZ = 4 * r;
    scene.activeCamera = camera;
    await scene.whenReadyAsync();
    const pictures = [];
    for (const direction of [[0.3, 0.2, 1], [-0.8, 0.5, -0.6], [0.1, 1, 0.2]]) {
      camera.position = center.add(new Vector3(...direction).normalize().scale(2 * r));
      camera.setTarget(center);
      light.direction = center.subtract(camera.position.add(new Vector3(2 * r, r, 0)));
      scene.render();
      pictures.push(Uint8Array.from(await engine.readPixels(0, 0, kSide, kSide)));
    }
    return pictures;
  } finally { scene.dispose(); }
}
