// SPDX-License-Identifier: Apache-2.0
import * as THREE from "three";
import {KTX2Loader} from "three/examples/jsm/loaders/KTX2Loader.js";
import {drive} from "./page.js";

function picture() {
  // RECIPE 1
  return material;
}

function packed(renderer, material) {
  // RECIPE 2
}

drive(side => {
  const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
  renderer.setSize(side, side);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 1, 20);
  camera.position.z = 10;
  return async ({place}) => {
    const scene = new THREE.Scene(), light = new THREE.DirectionalLight(0xffffff, 3);
    let material = new THREE.MeshStandardMaterial();
    if (place === "packed") packed(renderer, material);
    else material = picture();
    while (!material.normalMap?.image) await new Promise(done => setTimeout(done, 20));
    scene.add(light, new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material));
    return direction => {
      light.position.set(...direction);
      renderer.render(scene, camera);
      return renderer.domElement;
    };
  };
});
