// SPDX-License-Identifier: Apache-2.0
// The stage of a map on its mesh: the light follows the pointer as on a plane, and dragging turns the camera.

const kMeshCanvas = 768;  // pixels
const kFirstView = [30, 20];  // degrees: preview-normals --mesh
const kFirstLight = [-0.8, 1, 1.2];  // in the world, which does not turn with the camera
const thousandths = (value) => Math.round(value * 1000) / 1000;

class MeshStage extends Stage {
  get number() { return Number(this.root.dataset.mesh); }
  get mesh() { return this.page.meshes[this.number]; }
  get camera() { return viewOf(this.yaw, this.pitch); }
  get size() { return [kMeshCanvas, kMeshCanvas]; }
  get keysId() { return "mesh-keys"; }
  get what() { return "on its mesh"; }
  addMarks() {}

  // The first picture is the still one.
  reset() {
    [this.yaw, this.pitch] = kFirstView;
    const {right, up, toward} = this.camera;
    this.at = [dot(kFirstLight, right) / 2, dot(kFirstLight, up) / 2];
    Object.assign(this, {height: dot(kFirstLight, toward), point: false, bump: 1, b: null, show: "lit"});
    this.yA = this.root.dataset.y;
    this.decoder = this.mesh.decoder;
    this.missed = this.root.dataset.missed || null;
    this.last = null;  // where the pointer was
  }

  // `at` and `height` are in the axes of the camera; the light is in the world.
  get light() {
    const {right, up, toward, half} = this.camera, reach = this.point ? half : 2;
    return sumOf([right, up, toward], [reach * this.at[0], reach * this.at[1], this.height]).map(thousandths);
  }

  fillPanel() {
    this.controls = {height: this.range("height", 0.1, 3, 0.05), bump: this.range("bump", 0, 4, 0.05), yaw: this.range("yaw", -180, 180, 0.5), pitch: this.range("pitch", -89, 89, 0.5)};
    this.greenA = this.green("yA");
    const decoders = this.page.decoders.map(([name, , meaning]) => [name, `${name} (${meaning})`]);
    this.panel.replaceChildren(
      labelled("decoder", select(decoders, this.decoder, this.change("decoder"), {name: "decoder"}), "wide"),
      labelled("green points", this.greenA), labelled("bump scale", this.controls.bump),
      labelled("light", this.lightKind()), labelled("light's height", this.controls.height),
      labelled("camera yaw", this.controls.yaw), labelled("camera pitch", this.controls.pitch), ...this.missedRow(), ...this.lastRows());
  }

  // Missed texels are red as long as the reader wants it.
  missedRow() {
    const mask = this.root.dataset.missed;
    if (!mask) return [];
    return [labelled("missed texels", select([[mask, "red"], ["", "as they were filled"]], this.missed || "", this.change("missed", (id) => id || null), {name: "missed"}))];
  }

  // The stages of other meshes follow.
  changed() {
    super.changed();
    for (const follower of this.followers || []) follower.changed();
  }

  // Turns the camera by degrees: to the right and up.
  turn(right, up) {
    this.yaw = this.controls.yaw.value = thousandths((this.yaw + right + 540) % 360 - 180);
    this.pitch = this.controls.pitch.value = thousandths(between(this.pitch + up, -89, 89));
  }

  // Dragging turns the mesh with the pointer, half a turn from edge to edge.
  move(event) {
    if (event.type === "pointerdown") event.target.setPointerCapture(event.pointerId);
    const box = event.target.getBoundingClientRect(), now = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    if (event.type === "pointermove" && event.buttons & 1) {
      if (this.last) this.turn(Math.round(-1800 * (now[0] - this.last[0])) / 10, Math.round(1800 * (now[1] - this.last[1])) / 10);
    } else {
      this.at = [2 * now[0] - 1, 1 - 2 * now[1]];
    }
    this.last = now;
    this.changed();
  }

  keys(step) {
    const turn = 50 * step, keys = super.keys(step);
    delete keys["["];  // there is no split
    delete keys["]"];
    return {...keys, a: () => this.turn(-turn, 0), d: () => this.turn(turn, 0), w: () => this.turn(0, turn), s: () => this.turn(0, -turn)};
  }

  state() { return `${super.state()}; camera ${this.yaw}, ${this.pitch}`; }

  paint() {
    const {map, number: mesh, yA: y, camera: view, bump, light, point, missed} = this;
    const [, kind, , rebuildsZ] = this.page.decoders.find(([name]) => name === this.decoder);
    return this.page.onMesh.draw(this.canvas, {map, mesh, y, kind, rebuildsZ, view, bump, light, point, missed});
  }

  tell() {
    this.caption.textContent = "Point to move the light; drag to turn the mesh.";
    this.command.textContent = this.commandLine();
    this.tellGpu(`${this.mesh.triangles} triangles; `);
  }

  // The page has names as a shell reads them. A name with <UDIM> stands for all tiles, each of which gets a picture.
  commandLine() {
    const file = this.root.dataset.file, output = file.includes("<UDIM>") ? "--name 'lit-{stem}.png'" : "-o lit.png";
    const words = ["preview-normals", file, output, this.mesh.arguments, "--decoder", this.decoder, "--y-in", this.yA];
    words.push("--camera", `${this.yaw},${this.pitch}`, "--light", this.light.join(","));
    if (this.point) words.push("--light-kind", "point");
    if (this.bump !== 1) words.push("--bump-scale", this.bump);
    return words.concat("--size", this.size.join("x")).join(" ");
  }
}

// The mesh that the one before it is compared with: without a map, under the same light, turned with it.
class BesideStage extends MeshStage {
  constructor(root, page) {
    super(root, page);
    const leads = this.leading;
    this.leader = leads.stage || (leads.stage = makeStage(leads, page));
    (this.leader.followers = this.leader.followers || []).push(this);
  }

  get leading() { return this.root.previousElementSibling; }
  get what() { return "and the mesh that it was made from"; }
  get camera() {
    const [x, y, z, radius] = this.mesh.place || [0, 0, 0, 1];
    return viewOf(this.leader.yaw, this.leader.pitch, Math.max(1, Math.hypot(x, y, z) + radius));
  }
  reset() {}
  fillPanel() { this.gpu = this.root.querySelector(".remark"); }
  move(event) { this.leader.move(event); }
  key(event) { this.leader.key(event); }

  paint() {
    const {map, number: mesh, camera: view, leader: {light, point, yA: y}} = this;
    return this.page.onMesh.draw(this.canvas, {map, mesh, y, kind: "per-vertex", rebuildsZ: true, view, bump: 0, light, point, missed: null});
  }
  tell() { this.caption.textContent = this.stillCaption; }
}

// One mesh of a row, each with a map of its own. The others turn as the leading one does.
class RowStage extends BesideStage {
  get leading() { return this.root.parentElement.querySelector("[data-leads]"); }
  get what() { return "on its mesh"; }
  fillPanel() {}
  paint() {
    const {map, number: mesh, camera: view, leader: {bump, light, point, decoder}} = this;
    const [, kind, , rebuildsZ] = this.page.decoders.find(([name]) => name === decoder);
    return this.page.onMesh.draw(this.canvas, {map, mesh, y: this.root.dataset.y, kind, rebuildsZ, view, bump, light, point, missed: null});
  }
}
