// SPDX-License-Identifier: Apache-2.0
import * as THREE from "three";
import {DDSLoader} from "three/examples/jsm/loaders/DDSLoader.js";
import {EXRLoader} from "three/examples/jsm/loaders/EXRLoader.js";
import {GLTFLoader} from "three/examples/jsm/loaders/GLTFLoader.js";
import {KTX2Loader} from "three/examples/jsm/loaders/KTX2Loader.js";
import {drive} from "./page.js";

drive(side => {
  const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
  renderer.setSize(side, side);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 1, 20);
  camera.position.z = 10;
  const loaders = {png: new THREE.TextureLoader(), dds: new DDSLoader(), exr: new EXRLoader(),
                   ktx2: new KTX2Loader().setTranscoderPath("basis/").detectSupport(renderer)};

  return async ({map, model, place}) => {
    const scene = new THREE.Scene(), light = new THREE.DirectionalLight(0xffffff, 3);
    scene.add(light);
    let texture = null;
    if (map) {
      texture = await loaders[map.split(".").pop()].loadAsync(map);
      if (!texture.mipmaps.length && texture.isCompressedTexture) throw "a texture without levels";
    }
    if (model) {
      const {scene: root} = await new GLTFLoader().setKTX2Loader(loaders.ktx2).loadAsync(model);
      scene.add(root);
      const mesh = root.getObjectByProperty("isMesh", true);
      if (map && map.endsWith(".png")) texture.flipY = false;  // glTF's v points down
      if (place.includes("new material"))
        mesh.material = new THREE.MeshStandardMaterial({color: 0x999999, roughness: 1, normalMap: texture});
      else if (map)
        mesh.material.normalMap = texture;
      if (place.includes("normalScale.y = -1")) mesh.material.normalScale.y = -1;
    } else {
      const material = new THREE.MeshStandardMaterial({color: 0x999999, roughness: 1, normalMap: texture});
      if (place.includes("repeat.y = -1")) {
        texture.wrapT = THREE.RepeatWrapping;
        texture.repeat.y = -1;
      }
      if (place.includes("normalScale.y = -1")) material.normalScale.y = -1;
      scene.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material));
    }
    return direction => {
      light.position.set(...direction);
      renderer.render(scene, camera);
      return renderer.domElement;
    };
  };
});
