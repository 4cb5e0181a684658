// SPDX-License-Identifier: Apache-2.0
// The page's script: replaces still pictures with canvases that have a light, and filters and sorts the table. Text
// from files is never inserted as HTML.

"use strict";

const kShows = [["lit", "lit"], ["normals", "normals"], ["slope", "slope"], ["tilt", "tilt"], ["length", "length"], ["z-error", "z error"]];
const kLegends = {
  slope: ["0", "2 texels high per texel", "viridis"], tilt: ["0\u00b0", "90\u00b0", "viridis"],
  length: ["\u22120.1", "+0.1", "diverging"], "z-error": ["\u22120.1", "+0.1", "diverging"],
};
const kGradients = {
  viridis: "linear-gradient(90deg, #440154, #482878, #3e4989, #31688e, #26828e, #1f9e89, #35b779, #6ece58, #b5de2b, #fde725)",
  diverging: "linear-gradient(90deg, rgb(15 51 107), rgb(92 156 212), rgb(247 247 245), rgb(240 163 87), rgb(122 48 5))",
};
const kSmallestCanvas = 512, kLargestCanvas = 1024;  // pixels, for the longer side
const kLiveStages = 12;  // the number of canvases that are kept

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

// One map or two maps under a light.
class Stage {
  constructor(root, maps, lighting) {
    Object.assign(this, {root, maps, lighting});
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
      tabindex: 0, role: "img", "aria-describedby": "keys", onkeydown: (e) => this.key(e), onpointermove: (e) => this.move(e), onpointerdown: (e) => this.move(e),
      "aria-label": `${map.file} under a light that you can move`,
    });
    this.view = element("div", {class: "view", hidden: true}, this.canvas);
    this.divider = element("div", {class: "split"});
    this.tagA = element("span", {class: "tag a"}, "A");
    this.tagB = element("span", {class: "tag b"}, "B");
    this.view.append(this.divider, this.tagA, this.tagB);
    this.still.before(this.view);
    this.caption = this.figure.querySelector("figcaption");
    this.stillCaption = this.caption.textContent;
    this.panel = this.root.querySelector(".panel");
    this.fillPanel();
  }

  fillPanel() {
    const change = (name, make = (v) => v) => (value) => { this[name] = make(value); this.changed(); };
    const range = (name, least, greatest, step) => {
      const input = element("input", {type: "range", min: least, max: greatest, step, oninput: (e) => change(name, Number)(e.target.value)});
      input.value = this[name];
      return input;
    };
    const green = (name, number) => select([["up", "up (OpenGL, Unity)"], ["down", "down (DirectX, Unreal)"]], this[name], change(name), {name});
    const others = [["", "nothing"]];
    this.maps.forEach((map, k) => { if (k !== this.map && map.levels.length > 0) others.push([k, map.file]); });
    const map = this.maps[this.map];
    const shows = kShows.filter(([name]) => map.channels[2] >= 0 || (name !== "length" && name !== "z-error"));
    this.controls = {height: range("height", 0.1, 3, 0.05), bump: range("bump", 0, 4, 0.05), split: range("split", 0, 1, 0.005)};
    this.greenA = green("yA");
    this.greenB = green("yB");
    this.splitLabel = labelled("split", this.controls.split);
    this.greenLabelB = labelled("green in B", this.greenB);
    this.legend = element("div", {class: "legend wide", hidden: true});
    this.command = element("code", {class: "command", title: "the command that makes this picture"});
    this.gpu = element("p", {class: "remark wide"});
    this.spoken = element("span", {class: "unseen", role: "status"});
    this.panel.replaceChildren(
      this.legend,
      labelled("show", select(shows, this.show, change("show"), {name: "show"})),
      labelled("light", select([["", "directional"], ["point", "point, at the pointer"]], this.point ? "point" : "", change("point", Boolean), {name: "light"})),
      labelled("light's height", this.controls.height), labelled("bump scale", this.controls.bump),
      labelled(this.other === null ? "green points" : "green in A", this.greenA),
      labelled("tiles", select([[1, "1"], [2, "2 x 2"], [4, "4 x 4"]], this.tiles, change("tiles", Number), {name: "tiles"})),
      labelled("B, beside it", select(others, this.b === null ? "" : this.b, (value) => this.choose(value), {name: "other"})), this.splitLabel, this.greenLabelB,
      element("div", {class: "row wide"}, this.command, element("button", {type: "button", onclick: () => this.start()}, "Reset")), this.gpu, this.spoken);
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

  key(event) {
    const step = event.shiftKey ? 0.02 : 0.1;
    const adjust = (name, by, least, greatest) => { this[name] = this.controls[name].value = rounded(between(this[name] + by, least, greatest)); };
    const keys = {
      ArrowLeft: () => { this.at[0] -= step; }, ArrowRight: () => { this.at[0] += step; }, ArrowUp: () => { this.at[1] += step; }, ArrowDown: () => { this.at[1] -= step; },
      PageUp: () => adjust("height", step, 0.1, 3), PageDown: () => adjust("height", -step, 0.1, 3),
      "+": () => adjust("bump", step, 0, 4), "-": () => adjust("bump", -step, 0, 4), "[": () => adjust("split", -step / 2, 0, 1), "]": () => adjust("split", step / 2, 0, 1),
      y: () => { this.yA = this.greenA.value = this.yA === "up" ? "down" : "up"; }, l: () => { this.point = !this.point; this.fillPanel(); }, Home: () => this.start(),
    };
    if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
    this.at = this.at.map((v) => between(v, -1, 1));
    this.changed();
    this.spoken.textContent = `light ${this.light.join(", ")}; bump scale ${this.bump}; green ${this.yA}`;
  }

  // -- the picture --

  changed() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }

  async draw() {
    const [width, height] = this.size;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, {width, height});
    const {a = this.map, b, yA, yB, split, tiles, bump, light, point} = this;
    const show = kShows.findIndex(([name]) => name === this.show);
    try {
      this.used = await this.lighting.draw(this.canvas, {a, b, yA, yB, split, tiles, bump, light, point, show});
    } catch (error) {
      this.gpu.textContent = `This browser could not draw the map: ${error.message}`;
      return;
    }
    this.still.hidden = true;
    this.view.hidden = false;
    this.tell();
  }

  tell() {
    const map = this.maps[this.map], two = this.b !== null;
    this.showControls();
    this.divider.style.left = `${100 * this.split}%`;
    this.caption.textContent = this.show === "lit" ? `Move the pointer over the picture to move the light${two ? ", drag to move the split" : ""}.` : "In false colours.";
    const legend = kLegends[this.show];
    this.legend.hidden = !legend;
    if (legend) {
      const bar = element("i");
      bar.style.background = kGradients[legend[2]];
      this.legend.replaceChildren(legend[0], bar, legend[1]);
    }
    this.command.textContent = this.commandLine();
    const stored = map.first > 0 ? ` Level ${map.first} of the file; larger levels would make this report too large.` : "";
    const how = this.used.packed ? "as the file stores it" : map.packed ? "decoded to 8 bits, because WebGL does not support these blocks here" : "with 8 bits per channel";
    this.gpu.textContent = `On the GPU: ${map.format}, ${how}.${stored} Drawn: ${this.canvas.width} x ${this.canvas.height}.`;
  }

  // The preview-normals command that draws the same picture.
  commandLine() {
    const words = ["preview-normals", quoted(this.maps[this.map].file)];
    if (this.b !== null) words.push(quoted(this.maps[this.b].file), "--split");
    words.push("-o", "lit.png");
    if (this.show !== "lit") words.push("--show", this.show);
    words.push("--light", this.light.join(","));
    if (this.point) words.push("--light-kind", "point");
    if (this.bump !== 1) words.push("--bump-scale", this.bump);
    if (this.yA !== this.maps[this.map].y || this.yA === "down") words.push("--y-in", this.yA);
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

// Gives every stage an empty panel as high as the panel of the first one, which is not drawn yet. Stages that start
// later then change no height above or below them.
function reservePanels(roots, maps, lighting) {
  roots.forEach((root) => root.querySelector("figure").after(element("div", {class: "panel"})));
  const first = roots[0].stage = new Stage(roots[0], maps, lighting);
  first.panel.style.minHeight = "0";
  const measure = () => {
    if (first.b === first.other && first.show === "lit") document.documentElement.style.setProperty("--panel", `${first.panel.offsetHeight}px`);
  };
  measure();
  window.addEventListener("resize", measure);
}

// Stages start when they come into view.
function makeStages() {
  const roots = [...document.querySelectorAll(".stage[data-map]")];
  if (roots.length === 0) return;
  const maps = JSON.parse(document.getElementById("maps").textContent);
  let lighting;
  try {
    lighting = new Lighting(maps);
  } catch (error) {
    document.querySelector("footer").append(element("p", {}, `This browser cannot light the maps: ${error.message}.`));
    return;
  }
  document.body.append(element("p", {id: "keys", class: "unseen"},
    "The arrow keys move the light, more slowly with Shift. Page Up and Page Down raise and lower it. Plus and minus change the bump scale; brackets move the split. " +
    "Y flips green, L changes the kind of light, and Home resets everything."));
  reservePanels(roots, maps, lighting);
  const live = new Map();  // in the order of last use
  const watch = new IntersectionObserver((entries) => {
    for (const {target, isIntersecting} of entries) {
      if (!isIntersecting) continue;
      const stage = live.get(target) || target.stage || (target.stage = new Stage(target, maps, lighting));
      live.delete(target);
      live.set(target, stage);
      stage.changed();
    }
    for (const [root, stage] of live) {
      if (live.size <= kLiveStages) break;
      live.delete(root);
      stage.rest();
    }
  }, {rootMargin: "300px"});
  roots.forEach((root) => watch.observe(root));
}

// Filters and sorts the table if there is more than one file.
function makeTable() {
  const table = document.getElementById("files"), rows = [...table.tBodies[0].rows];
  if (rows.length < 2) return;
  const sections = [...document.querySelectorAll("section.file")];
  const items = rows.map((row, k) => ({row, section: sections[k], words: row.dataset.words.split(" "), text: row.textContent.toLowerCase()}));
  let word = "", text = "";
  const apply = () => {
    for (const {row, section, words, text: own} of items) {
      row.hidden = section.hidden = !((word === "" || words.includes(word)) && own.includes(text));
    }
    buttons.forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.word === word)));
  };
  const kinds = [["", "All"], ["error", "Errors"], ["warning", "Warnings"], ["note", "Notes"], ["clean", "Clean"]];
  const count = (kind) => items.filter(({words}) => kind === "" || words.includes(kind)).length;
  const buttons = kinds.filter(([kind]) => count(kind) > 0).map(([kind, name]) =>
    element("button", {type: "button", "data-word": kind, onclick: () => { word = kind; apply(); }}, `${name} ${count(kind)}`));
  document.getElementById("table-tools").append(...buttons, element("input", {
    type: "search", placeholder: "Filter by name, rule or format", "aria-label": "Filter the files", oninput: (e) => { text = e.target.value.toLowerCase(); apply(); }}));
  apply();

  const heads = [...table.tHead.rows[0].cells];
  heads.slice(1).forEach((head, n) => {
    const name = head.textContent, column = n + 1;
    head.replaceChildren(element("button", {type: "button", onclick: () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const key = (row) => row.cells[column].textContent;
      rows.sort((p, q) => (down ? -1 : 1) * key(p).localeCompare(key(q), "en", {numeric: true}));
      table.tBodies[0].append(...rows);
    }}, name));
  });
}

function makeTheme() {
  const themes = ["auto", "light", "dark"];
  let now = 0;
  const button = element("button", {type: "button", onclick: () => {
    now = (now + 1) % themes.length;
    if (now === 0) delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = themes[now];
    button.textContent = `Theme: ${themes[now]}`;
  }}, "Theme: auto");
  document.getElementById("page-tools").append(button);
}

makeTheme();
makeTable();
makeStages();
