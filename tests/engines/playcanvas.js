// SPDX-License-Identifier: Apache-2.0
import * as pc from "playcanvas";
import {drive} from "./page.js";

// Basis Universal: the transcoder is that of three.js.
pc.basisInitialize({glueUrl: "basis/basis_transcoder.js", wasmUrl: "basis/basis_transcoder.wasm",
                    fallbackUrl: "basis/basis_transcoder.js"});

drive(side => {
  const canvas = document.body.appendChild(document.createElement("canvas"));
  canvas.width = canvas.height = side;
  const app = new pc.Application(canvas, {graphicsDeviceOptions: {preserveDrawingBuffer: true, antialias: false}});
  app.setCanvasFillMode(pc.FILLMODE_NONE, side, side);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, side, side);
  app.autoRender = false;
  app.scene.ambientLight = new pc.Color(0, 0, 0);
  app.start();
  const camera = new pc.Entity();
  camera.addComponent("camera", {projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: 1, nearClip: 1, farClip: 20,
                                 clearColor: new pc.Color(0, 0, 0)});
  camera.setPosition(0, 0, 10);
  app.root.addChild(camera);
  const light = new pc.Entity();
  light.addComponent("light", {type: "directional", intensity: 1});
  app.root.addChild(light);
  let shown = null;

  const load = (url, type) => new Promise((done, fail) => {
    const asset = new pc.Asset(url, type, {url});
    asset.on("load", () => done(asset.resource));
    asset.on("error", fail);
    app.assets.add(asset);
    app.assets.load(asset);
  });

  return async ({map, model}) => {
    shown?.destroy();
    const texture = map ? await load(map, "texture") : null;
    if (model) {
      shown = (await load(`${model}?${map}`, "container")).instantiateRenderEntity();
      if (map) {
        const {material} = shown.findComponents("render")[0].meshInstances[0];
        material.normalMap = texture;
        material.update();
      }
    } else {
      const material = new pc.StandardMaterial();
      material.diffuse = new pc.Color(0.6, 0.6, 0.6);
      material.useMetalness = true;
      material.metalness = 0;
      material.gloss = 0;
      material.normalMap = texture;
      material.update();
      shown = new pc.Entity();
      shown.addComponent("render", {type: "plane", material});
      shown.setLocalScale(2, 2, 2);
      shown.setLocalEulerAngles(90, 0, 0);  // its plane is horizontal
    }
    app.root.addChild(shown);
    return direction => {
      const down = new pc.Vec3(...direction).mulScalar(-1).normalize();  // lights shine along their -y
      light.setRotation(new pc.Quat().setFromDirections(new pc.Vec3(0, -1, 0), down));
      app.render();
      return canvas;
    };
  };
});
