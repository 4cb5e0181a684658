// SPDX-License-Identifier: Apache-2.0
import {drive} from "./page.js";

drive(async side => {
  const canvas = document.body.appendChild(document.createElement("canvas"));
  canvas.width = canvas.height = side;
  await new Promise((done, fail) => {  // not a module
    const script = Object.assign(document.createElement("script"), {src: "filament/filament.js", onload: done,
                                                                    onerror: fail});
    document.head.append(script);
  });
  await new Promise(done => window.Filament.init([], done));
  const {Filament} = window;  // init() has replaced it
  const engine = Filament.Engine.create(canvas, {preserveDrawingBuffer: true});
  const {EntityManager, Camera$Projection, LightManager, LightManager$Type} = Filament;
  const scene = engine.createScene(), view = engine.createView(), renderer = engine.createRenderer();
  const chain = engine.createSwapChain(), camera = engine.createCamera(EntityManager.get().create());
  camera.setProjection(Camera$Projection.ORTHO, -1, 1, -1, 1, 1, 20);
  camera.lookAt([0, 0, 10], [0, 0, 0], [0, 1, 0]);
  camera.setExposureDirect(1);
  view.setCamera(camera);
  view.setScene(scene);
  view.setViewport([0, 0, side, side]);
  view.setPostProcessingEnabled(false);
  renderer.setClearOptions({clearColor: [0, 0, 0, 1], clear: true});
  const loader = engine.createAssetLoader();
  let asset = null, light = null;

  return async ({model}) => {
    if (asset) scene.removeEntities(asset.getEntities());
    asset = loader.createAsset(new Uint8Array(await (await fetch(model)).arrayBuffer()));
    await new Promise(done => asset.loadResources(done));
    scene.addEntities(asset.getEntities());
    return async ([x, y, z]) => {
      if (light) scene.remove(light);
      light = EntityManager.get().create();
      LightManager.Builder(LightManager$Type.DIRECTIONAL).color([1, 1, 1]).intensity(2)
        .direction([-x, -y, -z]).castShadows(false).build(engine, light);
      scene.addEntity(light);
      for (let k = 0; k < 3; ++k) {  // textures arrive one by one
        renderer.render(chain, view);
        engine.execute();
        await new Promise(done => requestAnimationFrame(done));
      }
      renderer.render(chain, view);
      engine.execute();
      return canvas;
    };
  };
});
