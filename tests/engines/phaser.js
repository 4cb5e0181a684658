// SPDX-License-Identifier: Apache-2.0
import * as Phaser from "phaser";
import {drive} from "./page.js";

drive(side => new Promise(started => {
  const kReach = 40;  // of the light, in sides of the image: far away, it shines as if from infinity
  const game = new Phaser.Game({
    type: Phaser.WEBGL, width: side, height: side, banner: false, audio: {noAudio: true}, parent: document.body,
    render: {preserveDrawingBuffer: true, antialias: true, mipmapFilter: ""}, scale: {mode: Phaser.Scale.NONE},
    callbacks: {postBoot: () => game.loop.stop()},
    scene: {create() {
      const scene = this, load = (key, urls) => new Promise((done, fail) => {
        scene.load.once("complete", done).once("loaderror", fail);
        scene.load.image(key, urls);
        scene.load.start();
      });
      scene.lights.enable().setAmbientColor(0);
      const light = scene.lights.addLight(0, 0, 4 * kReach * side, 0xffffff, 1.5);
      let count = 0, image = null;
      const white = document.createElement("canvas").getContext("2d");
      white.canvas.width = white.canvas.height = side;
      white.fillStyle = "#999";
      white.fillRect(0, 0, side, side);

      started(async ({map, place}) => {
        image?.destroy();
        const key = `lit${++count}`;
        await load(key, [white.canvas.toDataURL(), map]);
        image = scene.add.image(side / 2, side / 2, key).setDisplaySize(side, side).setLighting(true);
        image.setFlip(place.includes("flipX"), place.includes("flipY"));
        if (place.includes("rotated")) image.setAngle(90);
        return ([x, y, z]) => {
          light.setPosition(side / 2 + kReach * side * x, side / 2 - kReach * side * y);
          light.z = kReach * side * z;
          game.step(performance.now(), 16);
          return game.canvas;
        };
      });
    }}});
}));
