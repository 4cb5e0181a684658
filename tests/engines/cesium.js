// SPDX-License-Identifier: Apache-2.0
import * as Cesium from "cesium";
import {drive} from "./page.js";

window.CESIUM_BASE_URL = "cesium/";

drive(async side => {
  const box = document.body.appendChild(document.createElement("div"));
  box.style.cssText = `width: ${side}px; height: ${side}px`;
  const {scene} = new Cesium.CesiumWidget(box, {
    globe: false, skyBox: false, skyAtmosphere: false, baseLayer: false, useDefaultRenderLoop: false, msaaSamples: 1,
    useBrowserRecommendedResolution: false, contextOptions: {webgl: {preserveDrawingBuffer: true}}});
  scene.canvas.width = scene.canvas.height = side;
  scene.backgroundColor = Cesium.Color.BLACK;
  scene.highDynamicRange = false;
  // On the ground, away from the centre of the Earth, where up is not defined. The axes of the model are the world's.
  const ground = new Cesium.Cartesian3(6378137, 0, 0);
  const {camera} = scene;
  camera.frustum = new Cesium.OrthographicFrustum({width: 2, aspectRatio: 1, near: 1, far: 20});
  camera.position = Cesium.Cartesian3.add(ground, new Cesium.Cartesian3(0, 0, 10), new Cesium.Cartesian3());
  camera.direction = new Cesium.Cartesian3(0, 0, -1);
  camera.up = new Cesium.Cartesian3(0, 1, 0);
  camera.right = new Cesium.Cartesian3(1, 0, 0);
  const rendered = () => { scene.initializeFrame(); scene.render(); };

  return async ({model: url}) => {
    scene.primitives.removeAll();
    const model = await Cesium.Model.fromGltfAsync({
      url, upAxis: Cesium.Axis.Z, forwardAxis: Cesium.Axis.X, incrementallyLoadTextures: false,
      modelMatrix: Cesium.Matrix4.fromTranslation(ground), environmentMapOptions: {enabled: false}});
    model.imageBasedLighting.imageBasedLightingFactor = Cesium.Cartesian2.ZERO;
    scene.primitives.add(model);
    for (let k = 0; k < 500 && !model.ready; ++k) {
      rendered();
      await new Promise(done => setTimeout(done, 10));
    }
    if (!model.ready) throw "not ready";
    return ([x, y, z]) => {
      scene.light = new Cesium.DirectionalLight({direction: new Cesium.Cartesian3(-x, -y, -z), intensity: 3});
      rendered();
      rendered();
      return scene.canvas;
    };
  };
});
