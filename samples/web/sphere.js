// SPDX-License-Identifier: Apache-2.0
// sphere.js: a normal map on a sphere under a light that the pointer and arrow keys move.

const kTiling = 2; // how often the map lies around the half that is seen
const kAmbient = 0.08, kStep = 0.1;

export class Sphere {
  #canvas;
  #texels; // codes of 8 bits, 4 a texel
  #width = 0;
  #height = 0;
  #light = [-0.5, 0.5];

  constructor(canvas) {
    this.#canvas = canvas;
    const move = ({ offsetX, offsetY }) => {
      this.#moveTo((2 * offsetX) / canvas.clientWidth - 1, 1 - (2 * offsetY) / canvas.clientHeight);
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      move(event);
    });
    canvas.addEventListener('pointermove', (event) => event.buttons !== 0 && move(event));
    canvas.addEventListener('keydown', (event) => {
      const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      this.#moveTo(this.#light[0] + kStep * by[0], this.#light[1] + kStep * by[1]);
    });
    this.draw();
  }

  /** The light from the eye, as x and y of a unit vector. */
  get light() {
    return this.#light;
  }

  /** `picture`: an ImageBitmap of normals, y up; undefined: a smooth sphere. */
  show(picture) {
    this.#width = picture?.width ?? 0;
    this.#height = picture?.height ?? 0;
    if (picture) {
      const context = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
      context.drawImage(picture, 0, 0);
      this.#texels = context.getImageData(0, 0, picture.width, picture.height).data;
    }
    this.draw();
  }

  #moveTo(x, y) {
    const length = Math.max(1, Math.hypot(x, y));
    this.#light = [x / length, y / length];
    requestAnimationFrame(() => this.draw());
  }

  /** The map's normal at a place from 0 to 1, or the smooth one. */
  #normal(u, v) {
    if (this.#width === 0) return [0, 0, 1];
    const i = Math.floor(((u % 1) + 1) * this.#width) % this.#width;
    const j = Math.floor(((v % 1) + 1) * this.#height) % this.#height;
    const at = 4 * (j * this.#width + i);
    return [0, 1, 2].map((channel) => this.#texels[at + channel] / 127.5 - 1);
  }

  draw() {
    const { width: size } = this.#canvas, context = this.#canvas.getContext('2d');
    const image = context.createImageData(size, size);
    const [lx, ly] = this.#light, lz = Math.sqrt(Math.max(0, 1 - lx * lx - ly * ly));
    for (let j = 0; j < size; ++j) {
      for (let i = 0; i < size; ++i) {
        const x = (2 * i + 1) / size - 1, y = 1 - (2 * j + 1) / size, inside = 1 - x * x - y * y;
        if (inside <= 0) continue;
        const z = Math.sqrt(inside), flat = Math.hypot(x, z);
        // u grows to the right along the equator, v downwards.
        const [nx, ny, nz] = this.#normal((kTiling * Math.atan2(x, z)) / Math.PI, (-kTiling * Math.asin(y)) / Math.PI);
        const tangent = [z / flat, 0, -x / flat];
        const up = [y * tangent[2], z * tangent[0] - x * tangent[2], -y * tangent[0]]; // position x tangent
        const n = [0, 1, 2].map((k) => nx * tangent[k] + ny * up[k] + nz * [x, y, z][k]);
        const lit = (n[0] * lx + n[1] * ly + n[2] * lz) / Math.hypot(...n);
        const at = 4 * (j * size + i);
        image.data.fill(255 * Math.sqrt(kAmbient + (1 - kAmbient) * Math.max(0, lit)), at, at + 3);
        image.data[at + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
  }
}
