// SPDX-License-Identifier: Apache-2.0
import * as pc from "playcanvas";
import {drive} from "./page.js";

drive(side => {
  const canvas = document.body.appendChild(document.createElement("canvas"));
  canvas.width = canvas.height = side;
  const app = new pc.Application(canvas, {graphicsDeviceOptions: {preserveDrawingBuffer: true, antialias: false}});
  app.setCanvasFillMode(pc.FILLMODE_NONE, side, side);
  app.setCanvasResolution(pc.RESOLUTION_FIXED, side, side);
  app.autoRender = false;
  app.start();
  return async () => {
    // RECIPE 1
    await new Promise(done => asset.ready(done));
    const camera = new pc.Entity(), light = new pc.Entity(), plane = new pc.Entity();
    camera.addComponent("camera", {projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: 1, nearClip: 1, farClip: 20});
    camera.setPosition(0, 0, 10);
    light.addComponent("light", {type: "directional"});
    plane.addComponent("render", {type: "plane", material});
    plane.setLocalScale(2, 2, 2);
    plane.setLocalEulerAngles(90, 0, 0);
    for (const entity of [camera, light, plane]) app.root.addChild(entity);
    return direction => {
      light.setRotation(new pc.Quat().setFromDirections(new pc.Vec3(0, -1, 0),
                                                        new pc.Vec3(...direction).mulScalar(-1).normalize()));
      app.render();
      return canvas;
    };
  };
});
