// SPDX-License-Identifier: Apache-2.0
// A stage: the canvas with a light that replaces a still picture, its controls and its keys.

const kShows = [["lit", "lit"], ["normals", "normals"], ["slope", "slope"], ["tilt", "tilt"], ["length", "length"], ["z-error", "z error"],
  ["occluded", "lit, with occlusion"]];
const kLegends = {
  slope: ["0", "2 texels high per texel", "viridis"], tilt: ["0\u00b0", "90\u00b0", "viridis"],
  length: ["\u22120.1", "+0.1", "diverging"], "z-error": ["\u22120.1", "+0.1", "diverging"],
};
const kGradients = {
  viridis: "linear-gradient(90deg, #440154, #482878, #3e4989, #31688e, #26828e, #1f9e89, #35b779, #6ece58, #b5de2b, #fde725)",
  diverging: "linear-gradient(90deg, rgb(15 51 107), rgb(92 156 212), rgb(247 247 245), rgb(240 163 87), rgb(122 48 5))",
};
const kSmallestCanvas = 512, kLargestCanvas = 1024;  // pixels, for the longer side
// An element with attributes, listeners ("onclick") and children.
function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== false) node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children);
  return node;
}
const select = (words, chosen, onchange, attributes = {}) => element("select", {onchange: (e) => onchange(e.target.value), ...attributes},
  ...words.map(([value, text]) => element("option", {value, selected: String(value) === String(chosen)}, text)));
const labelled = (text, control, kind = "") => element("label", {class: kind}, element("span", {}, text), control);
const rounded = (value) => Math.round(value * 100) / 100;
const between = (value, least, greatest) => Math.min(Math.max(value, least), greatest);
const quoted = (name) => (/^[\w.\/+@%,:=-]+$/.test(name) ? name : "'" + name.replaceAll("'", "'\\''") + "'");

// One map or two maps under a light, on a plane. `page` holds what all stages share: {maps, lighting} and, if there are
// meshes, {meshes, decoders, onMesh}.
class Stage {
  constructor(root, page) {
    Object.assign(this, {root, page, maps: page.maps});
    this.map = Number(root.dataset.map);
    this.other = "other" in root.dataset ? Number(root.dataset.other) : null;
    this.still = root.querySelector("img");
    this.figure = root.querySelector("figure");
    this.reset();
    this.build();
  }

  reset() {
    this.at = [-0.4, 0.5];  // the pointer: -1 to 1, with up positive
    Object.assign(this, {height: 1.2, point: false, bump: 1, tiles: 1, split: 0.5, show: "lit", b: this.other});
    this.yA = this.maps[this.map].y;
    this.yB = this.other === null ? "up" : this.maps[this.other].y;
  }

  get light() {
    const [w, h] = this.maps[this.map].levels[0];
    return this.point ? [rounded(this.at[0] * w / h), rounded(this.at[1]), this.height]
      : [rounded(2 * this.at[0]), rounded(2 * this.at[1]), this.height];
  }

  // The canvas's size: that of the map with its tiles, enlarged by a whole number or limited.
  get size() {
    const [w, h] = this.maps[this.map].levels[0].slice(0, 2).map((n) => n * this.tiles), longer = Math.max(w, h);
    const scale = longer > kLargestCanvas ? kLargestCanvas / longer : Math.ceil(kSmallestCanvas / longer);
    return [w, h].map((n) => Math.max(1, Math.round(n * scale)));
  }

  // -- elements --

  build() {
    const map = this.maps[this.map];
    this.canvas = element("canvas", {
      tabindex: 0, role: "img", "aria-describedby": this.keysId, onkeydown: (e) => this.key(e), onpointermove: (e) => this.move(e), onpointerdown: (e) => this.move(e),
      "aria-label": `${map.file} ${this.what} under a light that you can move`,
    });
    this.view = element("div", {class: "view", hidden: true}, this.canvas);
    this.addMarks();
    this.still.before(this.view);
    this.caption = this.figure.querySelector("figcaption");
    this.stillCaption = this.caption.textContent;
    this.panel = this.root.querySelector(".panel");
    this.fillPanel();
  }

  get keysId() { return "keys"; }
  get what() { return ""; }

  addMarks() {
    this.divider = element("div", {class: "split"});
    this.tagA = element("span", {class: "tag a"}, "A");
    this.tagB = element("span", {class: "tag b"}, "B");
    this.view.append(this.divider, this.tagA, this.tagB);
  }

  // Controls that set this[name].
  change(name, make = (v) => v) { return (value) => { this[name] = make(value); this.changed(); }; }
  range(name, least, greatest, step) {
    const input = element("input", {type: "range", min: least, max: greatest, step, name, oninput: (e) => this.change(name, Number)(e.target.value)});
    input.value = this[name];
    return input;
  }
  green(name) { return select([["up", "up (OpenGL, Unity)"], ["down", "down (DirectX, Unreal)"]], this[name], this.change(name), {name}); }
  lightKind() {
    return select([["", "directional"], ["point", "point, at the pointer"]], this.point ? "point" : "", this.change("point", Boolean), {name: "light"});
  }

  // The end of the panel: the command, and what the GPU was given.
  lastRows() {
    this.command = element("code", {class: "command", title: "the command that makes this picture"});
    this.gpu = element("p", {class: "remark wide"});
    this.spoken = element("span", {class: "unseen", role: "status"});
    return [element("div", {class: "row wide"}, this.command, element("button", {type: "button", onclick: () => this.start()}, "Reset")), this.gpu, this.spoken];
  }

  fillPanel() {
    const others = [["", "nothing"]];
    this.maps.forEach((map, k) => { if (k !== this.map && map.levels.length > 0) others.push([k, map.file]); });
    const map = this.maps[this.map];
    const shows = kShows.filter(([name]) => (name === "occluded" ? "occlusion" in map : map.channels[2] >= 0 || (name !== "length" && name !== "z-error")));
    this.controls = {height: this.range("height", 0.1, 3, 0.05), bump: this.range("bump", 0, 4, 0.05), split: this.range("split", 0, 1, 0.005)};
    this.greenA = this.green("yA");
    this.greenB = this.green("yB");
    this.splitLabel = labelled("split", this.controls.split);
    this.greenLabelB = labelled("green in B", this.greenB);
    this.legend = element("div", {class: "legend wide", hidden: true});
    this.panel.replaceChildren(
      this.legend,
      labelled("show", select(shows, this.show, this.change("show"), {name: "show"})), labelled("light", this.lightKind()),
      labelled("light's height", this.controls.height), labelled("bump scale", this.controls.bump),
      labelled(this.other === null ? "green points" : "green in A", this.greenA),
      labelled("tiles", select([[1, "1"], [2, "2 x 2"], [4, "4 x 4"]], this.tiles, this.change("tiles", Number), {name: "tiles"})),
      labelled("B, beside it", select(others, this.b === null ? "" : this.b, (value) => this.choose(value), {name: "other"})), this.splitLabel, this.greenLabelB, ...this.lastRows());
    this.showControls();
  }

  // Shows the controls of B if there is a B.
  showControls() {
    for (const node of [this.divider, this.tagA, this.tagB, this.splitLabel, this.greenLabelB]) node.hidden = this.b === null;
  }

  start() {
    this.reset();
    this.fillPanel();
    this.changed();
  }

  choose(value) {
    this.b = value === "" ? null : Number(value);
    if (this.b !== null) this.yB = this.greenB.value = this.maps[this.b].y;
    this.changed();
  }

  // -- the reader --

  move(event) {
    const box = this.canvas.getBoundingClientRect();
    if (event.buttons & 1 && this.b !== null) {
      this.split = this.controls.split.value = between((event.clientX - box.left) / box.width, 0, 1);
    } else {
      this.at = [2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height];
    }
    this.changed();
  }

  adjust(name, by, least, greatest) { this[name] = this.controls[name].value = rounded(between(this[name] + by, least, greatest)); }

  // What keys do. Those that move something move it by `step`.
  keys(step) {
    return {
      ArrowLeft: () => { this.at[0] -= step; }, ArrowRight: () => { this.at[0] += step; }, ArrowUp: () => { this.at[1] += step; }, ArrowDown: () => { this.at[1] -= step; },
      PageUp: () => this.adjust("height", step, 0.1, 3), PageDown: () => this.adjust("height", -step, 0.1, 3),
      "+": () => this.adjust("bump", step, 0, 4), "-": () => this.adjust("bump", -step, 0, 4),
      "[": () => this.adjust("split", -step / 2, 0, 1), "]": () => this.adjust("split", step / 2, 0, 1),
      y: () => { this.yA = this.greenA.value = this.yA === "up" ? "down" : "up"; }, l: () => { this.point = !this.point; this.fillPanel(); }, Home: () => this.start(),
    };
  }

  key(event) {
    const keys = this.keys(event.shiftKey ? 0.02 : 0.1), key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.altKey || event.metaKey || !(key in keys)) return;
    event.preventDefault();
    keys[key]();
    this.at = this.at.map((v) => between(v, -1, 1));
    this.changed();
    this.spoken.textContent = this.state();
  }

  // What a screen reader says after a key.
  state() { return `light ${this.light.join(", ")}; bump scale ${this.bump}; green ${this.yA}`; }

  // -- the picture --

  changed() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }

  async draw() {
    const [width, height] = this.size;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, {width, height});
    try {
      this.used = await this.paint();
    } catch (error) {
      this.rest();
      this.gpu.textContent = `This browser could not draw the map: ${error.message}.`;
      return;
    }
    this.still.hidden = true;
    this.view.hidden = false;
    this.tell();
  }

  get isLit() { return this.show === "lit" || this.show === "occluded"; }

  paint() {
    const {a = this.map, b, yA, yB, split, tiles, bump, light, point} = this;
    return this.page.lighting.draw(this.canvas, {a, b, yA, yB, split, tiles, bump, light, point, show: kShows.findIndex(([name]) => name === this.show)});
  }

  tell() {
    const two = this.b !== null;
    this.showControls();
    this.divider.style.left = `${100 * this.split}%`;
    this.caption.textContent = this.isLit ? `Move the pointer over the picture to move the light${two ? ", drag to move the split" : ""}.` : "In false colours.";
    const legend = kLegends[this.show];
    this.legend.hidden = !legend;
    if (legend) {
      const bar = element("i");
      bar.style.background = kGradients[legend[2]];
      this.legend.replaceChildren(legend[0], bar, legend[1]);
    }
    this.command.textContent = this.commandLine();
    this.tellGpu("");
  }

  // States what the GPU was given: the map, and `before` that.
  tellGpu(before) {
    const map = this.maps[this.map];
    const stored = map.first > 0 ? ` Level ${map.first} of the file; larger levels would make this report too large.` : "";
    const how = this.used.packed ? "as the file stores it" : map.packed ? "decoded to 8 bits, because WebGL does not support these blocks here" : "with 8 bits per channel";
    this.gpu.textContent = `On the GPU: ${before}${map.format}, ${how}.${stored} Drawn: ${this.canvas.width} x ${this.canvas.height}.`;
  }

  // The preview-normals command that draws the same picture.
  commandLine() {
    const words = ["preview-normals", quoted(this.maps[this.map].file)];
    if (this.b !== null) words.push(quoted(this.maps[this.b].file), "--split");
    words.push("-o", "lit.png");
    if (this.show === "occluded") words.push("--ambient", kMuchAmbient, "--occlusion", quoted(this.maps[this.map].occlusion));
    else if (this.show !== "lit") words.push("--show", this.show);
    words.push("--light", this.light.join(","));
    if (this.point) words.push("--light-kind", "point");
    if (this.bump !== 1) words.push("--bump-scale", this.bump);
    words.push("--y-in", this.yA);  // always: a file may state another direction than its texels show
    if (this.tiles > 1) words.push("--shape", `tiled:${this.tiles}x${this.tiles}`);
    return words.concat("--size", this.size.join("x")).join(" ");
  }

  // Shows the still picture again, because canvases take memory.
  rest() {
    this.view.hidden = true;
    this.still.hidden = false;
    this.caption.textContent = this.stillCaption;
    this.canvas.width = this.canvas.height = 1;
  }
}
