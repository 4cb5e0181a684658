// SPDX-License-Identifier: Apache-2.0
// The page's script: starts the stages, and filters and sorts the table. Text from files is never inserted as HTML.

const kLiveStages = 12;  // the number of canvases that are kept

const makeStage = (root, page) => new ("beside" in root.dataset ? BesideStage : "follows" in root.dataset ? RowStage : "mesh" in root.dataset ? MeshStage : Stage)(root, page);

// Gives every stage an empty panel as high as the panel of the first one, which is not drawn yet. Stages that start
// later then change no height above or below them. `name` is the height's name in the style.
function reservePanels(roots, page, name) {
  if (roots.length === 0) return;
  roots.forEach((root) => root.querySelector("figure").after(element("div", {class: "panel"})));
  const first = roots[0].stage = makeStage(roots[0], page);
  first.panel.style.minHeight = "0";
  const measure = () => {
    if (first.b === first.other && first.show === "lit") document.documentElement.style.setProperty(name, `${first.panel.offsetHeight}px`);
  };
  measure();
  window.addEventListener("resize", measure);
}

// Stages start when they come into view.
function makeStages() {
  const roots = [...document.querySelectorAll(".stage[data-map]")];
  if (roots.length === 0) return;
  const page = {maps: JSON.parse(document.getElementById("maps").textContent)};
  const onMesh = roots.filter((root) => "mesh" in root.dataset && !("beside" in root.dataset || "follows" in root.dataset)), onPlane = roots.filter((root) => !("mesh" in root.dataset));
  try {
    page.lighting = new Lighting(page.maps);
    if (onMesh.length > 0) {
      Object.assign(page, JSON.parse(document.getElementById("meshes").textContent));
      page.onMesh = new MeshLighting(page.lighting, page.meshes);
    }
  } catch (error) {
    document.querySelector("footer").append(element("p", {}, `This browser cannot light the maps: ${error.message}.`));
    return;
  }
  document.body.append(element("p", {id: "keys", class: "unseen"},
    "The arrow keys move the light, more slowly with Shift. Page Up and Page Down raise and lower it. Plus and minus change the bump scale; brackets move the split. " +
    "Y flips green, L changes the kind of light, and Home resets everything."), element("p", {id: "mesh-keys", class: "unseen"},
    "The arrow keys move the light, more slowly with Shift. A, D, W and S turn the camera to the left, to the right, up and down. Page Up and Page Down raise and lower the light. " +
    "Plus and minus change the bump scale. Y flips green, L changes the kind of light, and Home resets everything."));
  reservePanels(onPlane, page, "--panel");
  reservePanels(onMesh, page, "--mesh-panel");
  const live = new Map();  // in the order of last use
  page.lighting.canvas.addEventListener("webglcontextlost", () => live.forEach((stage) => stage.changed()));
  const watch = new IntersectionObserver((entries) => {
    for (const {target, isIntersecting} of entries) {
      if (!isIntersecting) continue;
      const stage = live.get(target) || target.stage || (target.stage = makeStage(target, page));
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
