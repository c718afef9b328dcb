// A run's page: opens from disk without complaints, chooses an object by a click in 3D, moves through time by keys, hides and colours.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { launch, open } from './browser.mjs';
import { drive, shotPath, temporaryFolder, waretwin } from './folders.mjs';

const browser = await launch();
const out = drive(temporaryFolder());
const file = path.join(out, 'report.html');
const { page, problems, seconds } = await open(browser, file);
console.log(`loaded in ${seconds.toFixed(2)} s`);
assert.equal(await page.locator('body').getAttribute('data-ready'), 'run');
await page.screenshot({ path: shotPath('run') });

// The canvas shows something: more than its ground colour.
const colours = await page.evaluate(() => {
  const canvas = document.querySelector('.canvas canvas');
  const copy = document.createElement('canvas');
  copy.width = 64;
  copy.height = 48;
  const pen = copy.getContext('2d');
  pen.drawImage(canvas, 0, 0, 64, 48);
  const data = pen.getImageData(0, 0, 64, 48).data;
  const seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add(`${data[i] >> 4},${data[i + 1] >> 4},${data[i + 2] >> 4}`);
  return seen.size;
});
assert.ok(colours > 10, `the 3D view has ${colours} colours`);

// A click on an object chooses it: its row and its details.
const target = await page.evaluate(() => {
  const { state, view } = window.waretwinPage;
  const item = state.items.find((each) => each.mapped && each.truth);
  view.focus(item);
  return { key: item.key, at: view.screenOf(item), row: state.items.indexOf(item) };
});
await page.waitForTimeout(300);
await page.mouse.click(target.at.x, target.at.y);
assert.equal(await page.evaluate(() => window.waretwinPage.state.chosen?.key), target.key);
assert.ok(await page.locator('.details').isVisible());
assert.equal(await page.locator('tr.chosen').count(), 1);
await page.screenshot({ path: shotPath('run-picked') });

// A row chosen by keyboard.
await page.keyboard.press('Escape');
assert.equal(await page.locator('tr.chosen').count(), 0);
await page.locator('tbody tr[tabindex]').nth(1).focus();
await page.keyboard.press('Enter');
assert.equal(await page.locator('tr.chosen').count(), 1);

// Arrow keys go through the drive: another picture, another time.
const shown = () => page.locator('.frames img.colour').getAttribute('src');
const time = () => page.locator('.slider output').textContent();
const toTime = async (key) => {
  await page.locator('input.time').focus();
  await page.keyboard.press(key);
};
await toTime('Home');
await page.evaluate(() => document.activeElement.blur());
const before = { picture: await shown(), time: await time() };
await page.keyboard.press('ArrowRight');
await page.keyboard.press('ArrowRight');
const after = { picture: await shown(), time: await time() };
assert.ok(before.picture.startsWith('data:image/jpeg'));
assert.notEqual(before.picture, after.picture);
assert.notEqual(before.time, after.time);
await page.keyboard.press('ArrowLeft');
await page.keyboard.press('ArrowLeft');
assert.equal(await shown(), before.picture, 'and back');
await page.locator('input.time').focus();
await page.keyboard.press('ArrowRight');
assert.notEqual(await shown(), before.picture, 'one step with the slider in focus, not two');
const frame = () => page.evaluate(() => window.waretwinPage.state.frame);
assert.equal(await frame(), 1);

// Down moves the drive from the slider and the 3D view; elsewhere it scrolls, as on any page.
const scrolled = () => page.evaluate(() => window.scrollY);
await page.keyboard.press('ArrowUp');
assert.equal(await frame(), 2);
await page.locator('.canvas canvas').focus();
const from = await scrolled();
await page.keyboard.press('ArrowDown');
assert.equal(await frame(), 1);
assert.equal(await scrolled(), from);
await page.evaluate(() => {
  document.activeElement.blur();
  window.scrollTo(0, 0);
});
await page.keyboard.press('ArrowDown');
await page.waitForFunction(() => window.scrollY > 0, null, { timeout: 5000 });
assert.equal(await frame(), 1);
await page.locator('.cutter input').focus();
const cut = () => page.locator('.cutter input').inputValue();
const cutBefore = await cut();
await page.keyboard.press('ArrowRight');
assert.notEqual(await cut(), cutBefore, 'a slider keeps its own keys');
assert.equal(await frame(), 1);
await page.keyboard.press('ArrowLeft');
await page.evaluate(() => window.scrollTo(0, 0));

// Boxes over the picture, and without.
await page.evaluate(() => {
  const { state } = window.waretwinPage;
  state.setFrame(state.data.frames.findIndex((frame) => frame.detections.length > 0));
});
assert.ok((await page.locator('.frames .boxes rect').count()) > 0);
await page.keyboard.press('b');
assert.ok(!(await page.locator('.frames .boxes').isVisible()));

// Layers by box and by key; the picture of the 3D view changes.
const view = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(document.querySelector('.canvas canvas').toDataURL())))));
let last = await view();
for (const [key, id] of [['m', 'mesh'], ['t', 'truth'], ['o', 'mapped'], ['p', 'path']]) {
  await page.keyboard.press(key);
  assert.ok(!(await page.locator(`#show-${id}`).isChecked()));
  const now = await view();
  assert.notEqual(now, last, `without ${id} it looks otherwise`);
  last = now;
}
for (const id of ['mesh', 'truth', 'mapped', 'path']) await page.locator(`#show-${id}`).check();
last = await view();
for (const way of ['label', 'error', 'surface']) {
  await page.locator('#colouring').selectOption(way);
  const now = await view();
  assert.notEqual(now, last, `colours by ${way}`);
  last = now;
}
await page.keyboard.press('Escape');
await page.screenshot({ path: shotPath('run-error') });
await page.locator('#show-grow').check();
await toTime('Home');
assert.notEqual(await view(), last, 'at the start the map is small');
await page.screenshot({ path: shotPath('run-grow') });

// Hiding one object; the keys' list.
await toTime('End');
await page.keyboard.press('n');
await page.keyboard.press('h');
assert.equal(await page.evaluate(() => window.waretwinPage.state.hidden.size), 1);
await page.keyboard.press('h');
assert.equal(await page.evaluate(() => window.waretwinPage.state.hidden.size), 0);
await page.keyboard.press('?');
assert.ok(await page.locator('dialog.help').isVisible());
await page.screenshot({ path: shotPath('run-keys') });
await page.keyboard.press('Escape');
assert.ok(!(await page.locator('dialog.help').isVisible()));

// Table 6 in both forms; what else a run's page has.
await page.getByRole('tab', { name: 'aligned' }).click();
for (const title of ['Table 6', 'Trajectory error over time', 'Time per mapped frame, as in Table 4 (ms)', 'About this run']) {
  assert.equal(await page.getByRole('heading', { name: title, exact: true }).count(), 1, title);
}
await page.setViewportSize({ width: 1920, height: 1080 });
await page.screenshot({ path: shotPath('run-large'), fullPage: true });
assert.deepEqual(problems, []);

// Each table has its own pairs: aligned, one object more is a stray. Bold is bold.
const scoreFile = path.join(out, 'score.json');
const score = JSON.parse(readFileSync(scoreFile, 'utf8'));
assert.ok(score.objects_aligned, 'the drive can be aligned');
const lost = score.objects_aligned.find((object) => object.map_id !== null);
const lostId = lost.map_id;
Object.assign(lost, { map_id: null, iou3d: 0, e_trans_m: null, e_rot_deg: null });
writeFileSync(scoreFile, JSON.stringify(score));
writeFileSync(path.join(out, 'baseline.md'), '# Verdict\n\n| measure | |\n|---|---|\n| recall | **worse** |\n');
waretwin('report', out);
const other = await open(browser, file);
const mapIds = (name) => other.page.locator(`table[aria-label="${name}"] tbody td:nth-child(3)`).allTextContents();
const mapped = await other.page.evaluate(() => window.waretwinPage.state.data.mapped.map((box) => box.id));
const pairs = new Set(score.objects_aligned.map((object) => object.map_id));
await other.page.getByRole('tab', { name: 'aligned' }).click();
const aligned = await mapIds('Table 6, aligned');
assert.equal(aligned.filter((id) => id === String(lostId)).length, 1);
assert.equal(aligned.length, score.objects_aligned.length + mapped.filter((id) => !pairs.has(id)).length);
assert.equal(await other.page.locator('.markdown td b').textContent(), 'worse');
assert.deepEqual(other.problems, []);

// A score that lacks parts leaves out what they show, no more.
for (const key of ['explanations', 'objects', 'summary', 'objects_aligned', 'summary_aligned']) delete score[key];
writeFileSync(scoreFile, JSON.stringify(score));
waretwin('report', out);
const bare = await open(browser, file);
assert.equal(await bare.page.getByRole('heading', { name: 'Mapped objects' }).count(), 1);
assert.ok((await bare.page.locator('table[aria-label="Mapped objects"] tbody tr').count()) > 0);
assert.deepEqual(bare.problems, []);
await browser.close();
