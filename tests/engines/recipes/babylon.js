// SPDX-License-Identifier: Apache-2.0
import * as BABYLON from "@babylonjs/core";
import {drive} from "./page.js";

drive(side => {
  const canvas = document.body.appendChild(document.createElement("canvas"));
  canvas.width = canvas.height = side;
  const engine = new BABYLON.Engine(canvas, false, {preserveDrawingBuffer: true}, false);
  return async () => {
    const scene = new BABYLON.Scene(engine);
    // RECIPE 1
    material.specularColor = BABYLON.Color3.Black();
    BABYLON.MeshBuilder.CreatePlane("plane", {size: 2}, scene).material = material;
    const light = new BABYLON.DirectionalLight("light", new BABYLON.Vector3(0, -1, 0), scene);
    light.intensity = 0.7;
    const camera = new BABYLON.FreeCamera("camera", new BABYLON.Vector3(0, 0, -10), scene);
    camera.mode = BABYLON.Camera.ORTHOGRAPHIC_CAMERA;
    camera.orthoLeft = camera.orthoBottom = -1;
    camera.orthoRight = camera.orthoTop = 1;
    await scene.whenReadyAsync();
    return ([x, y, z]) => {
      light.direction = new BABYLON.Vector3(-x, -y, z);
      scene.render();
      return canvas;
    };
  };
});
