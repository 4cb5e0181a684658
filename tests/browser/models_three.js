// SPDX-License-Identifier: Apache-2.0
// models_three.js: draws a model by three.js; see models.sh.

import * as THREE from "three";
import {DRACOLoader} from "three/examples/jsm/loaders/DRACOLoader.js";
import {GLTFLoader} from "three/examples/jsm/loaders/GLTFLoader.js";
import {KTX2Loader} from "three/examples/jsm/loaders/KTX2Loader.js";
import {MeshoptDecoder} from "three/examples/jsm/libs/meshopt_decoder.module.js";

const kSide = 256, kLibraries = "./modules/node_modules/three/examples/jsm/libs/";
const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
renderer.setSize(kSide, kSide);
const loader = new GLTFLoader();
loader.setMeshoptDecoder(MeshoptDecoder);
loader.setDRACOLoader(new DRACOLoader().setDecoderPath(kLibraries + "draco/gltf/"));
loader.setKTX2Loader(new KTX2Loader().setTranscoderPath(kLibraries + "basis/").detectSupport(renderer));

// From the front, from behind and above, with a light beside the camera, which shows what normals do.
export async function drawn(file) {
  const {scene: root} = await loader.loadAsync(file);
  const scene = new THREE.Scene().add(root), light = new THREE.DirectionalLight(0xffffff, 3);
  scene.add(light, new THREE.AmbientLight(0xffffff, 0.3));
  root.traverse(node => { if (node.isLight) node.visible = false; });
  const ball = new THREE.Box3().setFromObject(root).getBoundingSphere(new THREE.Sphere()), r = ball.radius || 1;
  const camera = new THREE.OrthographicCamera(-r, r, r, -r, 0, 4 * r);
  const pictures = [];
  for (const direction of [[0.3, 0.2, 1], [-0.8, 0.5, -0.6], [0.1, 1, 0.2]]) {
    camera.position.copy(ball.center).addScaledVector(new THREE.Vector3(...direction).normalize(), 2 * r);
    camera.lookAt(ball.center);
    light.position.copy(camera.position).add(new THREE.Vector3(2 * r, r, 0));
    light.target.position.copy(ball.center);
    light.target.updateMatrixWorld();
    renderer.render(scene, camera);
    const codes = new Uint8Array(4 * kSide * kSide), gl = renderer.getContext();
    gl.readPixels(0, 0, kSide, kSide, gl.RGBA, gl.UNSIGNED_BYTE, codes);
    pictures.push(codes);
  }
  root.traverse(node => {
    if (!node.isMesh) return;
    node.geometry.dispose();
    for (const material of [node.material].flat()) {
      for (const value of Object.values(material)) if (value && value.isTexture) value.dispose();
      material.dispose();
    }
  });
  return pictures;
}
