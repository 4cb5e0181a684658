// SPDX-License-Identifier: Apache-2.0
// page.js: files in, one command at a time in the worker, files out.

import { Sphere } from './sphere.js';

const $ = (id) => document.getElementById(id);
const files = new Map(); // names and bytes
const sphere = new Sphere($('sphere'));
const kModels = /\.(glb|gltf)$/i;
let worker, cancel;

/** Runs a command. Returns what it printed and wrote; nothing if it was cancelled. */
function run(...args) {
  worker ??= new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
  $('status').textContent = `${args.join(' ')} ...`;
  $('progress').removeAttribute('value'); // unknown as yet
  return new Promise((resolve) => {
    cancel = () => {
      worker.terminate();
      worker = undefined;
      resolve();
    };
    worker.onmessage = ({ data: { progress, ended } }) => {
      if (progress !== undefined) $('progress').value = progress;
      if (ended !== undefined) resolve(ended);
    };
    worker.onerror = ({ message }) => resolve({ code: -1, out: '', err: `worker: ${message}\n`, written: [] });
    worker.postMessage({ args, files });
  });
}

let last = Promise.resolve();
/** Begins a task when the one before it has ended, so that no two run at once. */
function queue(task) {
  last = last.then(async () => {
    $('cancel').disabled = false;
    document.body.setAttribute('aria-busy', 'true');
    try {
      await task();
    } catch (error) {
      say({ err: `${error}\n` });
    }
    $('progress').value = 0;
    $('cancel').disabled = true;
    document.body.removeAttribute('aria-busy');
  });
  return last;
}

function say(ended) {
  $('said').textContent = ended ? ended.err : '';
  $('said').hidden = !$('said').textContent;
  $('status').textContent = ended === undefined ? 'Cancelled.' : ended.code === 0 || ended.code === 1 ? 'Done.' : 'Failed.';
}

function add(name, bytes) {
  files.set(name, bytes);
  let option = [...$('files').options].find(({ value }) => value === name);
  if (option === undefined) $('files').append((option = new Option('', name)));
  option.text = `${name}, ${bytes.length.toLocaleString('en')} bytes`;
  $('files').value = name;
  offer();
}

/** The chosen file can be saved. */
function offer() {
  const name = $('files').value, link = $('save');
  if (link.href) URL.revokeObjectURL(link.href);
  link.hidden = name === '';
  link.textContent = `Save ${name}`;
  link.download = name;
  link.href = URL.createObjectURL(new Blob([files.get(name) ?? '']));
}

async function show(name) {
  const ended = kModels.test(name) ? undefined : await run('unpack-normals', name, '-o', 'shown.png', '--y', 'up', '--format', 'rgb8', '--quiet');
  const picture = ended?.written.find(([written]) => written === 'shown.png');
  const options = { colorSpaceConversion: 'none', premultiplyAlpha: 'none' };
  sphere.show(picture && (await createImageBitmap(new Blob([picture[1]], { type: 'image/png' }), options)));
}

function list(report) {
  const found = report.findings.map(({ id, severity, message, fix }) => {
    const item = document.createElement('li');
    item.className = severity;
    item.textContent = `${id}: ${message}${fix && !fix.includes('FIXED') ? `. ${fix}` : ''}`;
    return item;
  });
  if (report.kind === 'heights') {
    const item = document.createElement('li');
    item.textContent = 'These look like heights: bake them.';
    $('list').replaceChildren(item);
  } else if (found.length === 0) {
    const item = document.createElement('li');
    item.textContent = `${report.input}: nothing is wrong.`;
    $('list').append(item);
  } else {
    $('list').append(...found);
  }
}

async function check(name) {
  $('list').replaceChildren();
  $('report').hidden = true;
  const ended = await run('check-normals', name, '--json', '--report', 'report.html');
  say(ended);
  if (ended === undefined) return;
  for (const line of ended.out.split('\n').filter((text) => text.startsWith('{'))) {
    const report = JSON.parse(line);
    if (report.findings) list(report);
  }
  const page = ended.written.find(([written]) => written === 'report.html');
  if (page) {
    $('report').srcdoc = new TextDecoder().decode(page[1]);
    $('report').hidden = false;
  }
}

/** Runs a command on the chosen file and takes its output, which is checked and shown. */
async function make(command, wanted, options) {
  const name = $('files').value;
  if (name === '') return say({ err: 'Drop or choose a file first.\n' });
  const stem = name.replace(/\.[^.]*$/, ''), extension = wanted ?? /[^.]*$/.exec(name)[0];
  let out = `${stem}.${extension}`;
  for (let k = 2; files.has(out); ++k) out = `${stem}-${k}.${extension}`;
  const ended = await run(command, name, '-o', out, ...options);
  say(ended);
  const written = ended?.written.find(([each]) => each === out);
  if (!written) return;
  add(...written);
  await show(out);
  await check(out);
  say(ended);
}

function outputs(...more) {
  const [container, format] = $('format').value.split(' ');
  return [container, ['--format', format, '--y', $('y').value, ...more]];
}

const actions = {
  check: () => $('files').value && check($('files').value),
  bake: () => make('bake-normals', ...outputs('--bumpiness', $('bumpiness').value)),
  pack: () => {
    if (kModels.test($('files').value)) return make('pack-normals', undefined, []);
    return make('pack-normals', ...outputs(...($('y-in').value ? ['--y-in', $('y-in').value] : [])));
  },
  repair: () => make('repair-normals', undefined, []),
};
for (const [id, action] of Object.entries(actions)) $(id).addEventListener('click', () => queue(action));
$('cancel').addEventListener('click', () => cancel?.());
$('files').addEventListener('change', () => {
  offer();
  queue(() => show($('files').value));
});

function take(dropped) {
  queue(async () => {
    for (const file of dropped) add(file.name, new Uint8Array(await file.arrayBuffer()));
    for (const { name } of dropped) {
      $('files').value = name;
      offer();
      await show(name);
      await check(name);
    }
  });
}
$('choose').addEventListener('change', () => take([...$('choose').files]));
for (const kind of ['dragover', 'dragleave', 'drop']) {
  document.addEventListener(kind, (event) => {
    event.preventDefault();
    $('drop').classList.toggle('over', kind === 'dragover');
    if (kind === 'drop') take([...event.dataTransfer.files]);
  });
}
