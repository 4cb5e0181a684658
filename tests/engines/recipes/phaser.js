// SPDX-License-Identifier: Apache-2.0
import * as Phaser from "phaser";
import {drive} from "./page.js";

drive(side => new Promise(started => {
  const x = side / 2, y = side / 2;
  const game = new Phaser.Game({
    type: Phaser.WEBGL, width: side, height: side, banner: false, audio: {noAudio: true}, parent: document.body,
    render: {preserveDrawingBuffer: true}, scale: {mode: Phaser.Scale.NONE},
    callbacks: {postBoot: () => game.loop.stop()},
    scene: {
      preload() {
        // RECIPE 1
        this.load.once("complete", () => setTimeout(() => game.step(performance.now(), 16)));
      },
      create() {
        // RECIPE 2
        started(async () => ([left, up]) => {
          this.lights.lights[0].setPosition(x + 200 * Math.sign(left), y - 200 * Math.sign(up));
          game.step(performance.now(), 16);
          return game.canvas;
        });
      },
    },
  });
}));
