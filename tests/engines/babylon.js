// SPDX-License-Identifier: Apache-2.0
import * as BABYLON from "@babylonjs/core";
import "@babylonjs/loaders/glTF";
import {drive} from "./page.js";
import {Decoder} from "./babylon-ktx2.js";

BABYLON.KhronosTextureContainer2.DefaultNumWorkers = 0;
globalThis.KTX2DECODER = {KTX2Decoder: Decoder, MSCTranscoder: {}, WASMMemoryManager: {}};

drive(side => {
  const canvas = document.body.appendChild(document.createElement("canvas"));
  canvas.width = canvas.height = side;
  const engine = new BABYLON.Engine(canvas, false, {preserveDrawingBuffer: true}, false);

  return async ({map, model, place}) => {
    for (const scene of [...engine.scenes]) scene.dispose();
    const scene = new BABYLON.Scene(engine);
    scene.clearColor = new BABYLON.Color4(0, 0, 0, 1);
    if (place.includes("right-handed")) scene.useRightHandedSystem = true;
    const light = new BABYLON.DirectionalLight("light", new BABYLON.Vector3(0, -1, 0), scene);
    light.specular = BABYLON.Color3.Black();
    let texture = null;
    if (map) {
      texture = await new Promise((done, fail) => {
        const made = new BABYLON.Texture(map, scene, {invertY: !model, onLoad: () => done(made),
          onError: (message, error) => fail(message ?? error ?? "not read")});
      });
    }
    // Models of glTF face z in both kinds of scene; the loader turns them around in left-handed ones.
    const atZ = model || scene.useRightHandedSystem ? 10 : -10;
    if (model) {
      await BABYLON.SceneLoader.AppendAsync("", model, scene);
      light.intensity = 3;
      const material = scene.meshes.find(mesh => mesh.getTotalVertices() > 0).material;
      if (map) material.bumpTexture = texture;
    } else {
      const material = place.includes("PBR") ? new BABYLON.PBRMaterial("lit", scene)
                                             : new BABYLON.StandardMaterial("lit", scene);
      if (place.includes("PBR")) { material.metallic = 0; material.roughness = 1; light.intensity = 3; }
      material.specularColor = BABYLON.Color3.Black();
      material.bumpTexture = texture;
      if (place.includes("invertNormalMapX")) material.invertNormalMapX = true;
      if (place.includes("invertNormalMapY")) material.invertNormalMapY = true;
      const plane = BABYLON.MeshBuilder.CreatePlane("plane", {size: 2}, scene);
      plane.material = material;
      if (scene.useRightHandedSystem) plane.rotation.y = Math.PI;
    }
    const camera = new BABYLON.FreeCamera("camera", new BABYLON.Vector3(0, 0, atZ), scene);
    camera.setTarget(BABYLON.Vector3.Zero());
    camera.mode = BABYLON.Camera.ORTHOGRAPHIC_CAMERA;
    camera.orthoLeft = camera.orthoBottom = -1;
    camera.orthoRight = camera.orthoTop = 1;
    scene.activeCamera = camera;
    await scene.whenReadyAsync();
    return ([x, y, z]) => {
      const right = (atZ > 0) === scene.useRightHandedSystem ? 1 : -1;  // where x points on the screen
      light.direction = new BABYLON.Vector3(-right * x, -y, -Math.sign(atZ) * z);
      scene.render();
      return canvas;
    };
  };
});
