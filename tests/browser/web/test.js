// SPDX-License-Identifier: Apache-2.0
// Uses samples/web as a visitor does, and posts what the visitor saves. See web.sh.

const frame = document.getElementById('page');
const post = (name, body) => fetch(`/${name}`, { method: 'POST', body });
const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
let page;
const $ = (id) => page.getElementById(id);
const expect = (fact, what) => {
  if (!fact) throw new Error(`${what}; status: ${$('status')?.textContent}; said: ${$('said')?.textContent}`);
};

async function until(condition, what) {
  for (let k = 0; k < 1200; ++k) {
    if (condition()) return;
    await pause(50);
  }
  expect(false, `never: ${what}`);
}
const idle = async (what) => {
  await pause(50);
  await until(() => !page.body.hasAttribute('aria-busy'), what);
};

async function drop(...names) {
  const transfer = new frame.contentWindow.DataTransfer();
  for (const name of names) transfer.items.add(new File([await (await fetch(`/${name}`)).arrayBuffer()], name));
  page.dispatchEvent(new frame.contentWindow.DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
  await idle(`drop of ${names}`);
}
function choose(id, value) {
  $(id).value = value;
  expect($(id).value === value, `${id} takes ${value}`);
  $(id).dispatchEvent(new Event('change'));
}
async function press(id) {
  $(id).focus();
  expect(page.activeElement === $(id), `${id} takes the focus`);
  $(id).click();
  await idle(id);
}
async function save(as) {
  const link = $('save');
  await post(as, await (await fetch(link.href)).arrayBuffer());
  return link.download;
}
const pixels = () => $('sphere').getContext('2d').getImageData(0, 0, 320, 320).data.join();

async function test() {
  await until(() => frame.contentDocument?.readyState === 'complete' && frame.contentDocument.getElementById('sphere'), 'page');
  page = frame.contentDocument;
  for (const control of page.querySelectorAll('button, select, input, canvas, iframe, progress')) {
    const named = control.labels?.length > 0 || control.textContent.trim() || control.ariaLabel || control.title;
    expect(named, `${control.id} has a name`);
  }
  await idle('start');

  const smooth = pixels();
  await drop('waves.png');
  expect($('list').textContent.includes('heights: bake'), 'heights are known');
  choose('format', 'dds bc5');
  $('bumpiness').value = 6;
  await press('bake');
  expect((await save('baked.dds')) === 'waves.dds', 'name of the output');
  expect(!$('report').hidden && $('report').srcdoc.length > 10000, 'the report is shown');
  const lit = pixels();
  expect(lit !== smooth, 'the map is on the sphere');
  $('sphere').dispatchEvent(new frame.contentWindow.KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
  await pause(200);
  expect(pixels() !== lit, 'an arrow key moves the light');

  choose('format', 'ktx2 astc-6x6');
  choose('y', 'down');
  await press('pack');
  await save('packed.ktx2');
  choose('files', 'waves.dds');
  await idle('choice');
  choose('format', 'png rgb16');
  await press('pack');
  await save('flipped.png');

  await drop('N301-srgb-decoded.png');
  expect($('list').textContent.includes('N301'), 'a finding');
  await press('repair');
  await save('repaired.png');
  await drop('crate_low.glb');
  expect($('status').textContent === 'Done.', 'a model is checked');
  await drop('large.png');

  // A long run: the page goes on, and the run can be cancelled.
  choose('format', 'ktx2 astc-6x6');
  let ticks = 0;
  const timer = setInterval(() => ++ticks, 10);
  $('bake').click();
  await pause(400);
  expect(page.body.hasAttribute('aria-busy') && ticks > 5, `the page goes on: ${ticks} ticks`);
  clearInterval(timer);
  $('cancel').click();
  await idle('cancel');
  expect($('status').textContent === 'Cancelled.', 'cancelled');
  choose('files', 'waves.png');
  await idle('choice');
  await press('check');
  expect($('list').textContent.includes('heights: bake'), 'work after it');
}

try {
  await test();
  await post('done', '');
} catch (error) {
  await post('failed', `${error.stack}\n`);
}
