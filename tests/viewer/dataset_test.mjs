// A set's page: thumbnails with boxes, a filter, one picture large, all by keyboard.
import assert from 'node:assert/strict';
import path from 'node:path';
import { launch, open } from './browser.mjs';
import { shotPath, temporaryFolder, waretwin } from './folders.mjs';

const browser = await launch();
const out = path.join(temporaryFolder(), 'set');
waretwin('dataset', '--generate', 'cell', '--out', out, '--count', '16', '--quiet', '--set', 'sensors.cameras.camera.width=640', '--set', 'sensors.cameras.camera.height=360');
const { page, problems, seconds } = await open(browser, path.join(out, 'report.html'));
console.log(`loaded in ${seconds.toFixed(2)} s`);
assert.equal(await page.locator('body').getAttribute('data-ready'), 'dataset');
const thumbs = page.locator('.thumb');
assert.equal(await thumbs.count(), 16);
await page.screenshot({ path: shotPath('dataset'), fullPage: true });
assert.ok((await page.locator('.thumb .boxes rect').count()) > 0);

await page.locator('#class-filter').selectOption('none');
const empty = await thumbs.count();
assert.ok(empty < 16);
assert.equal(await page.locator('.thumb .boxes rect').count(), 0);
await page.locator('#class-filter').selectOption('0');
assert.equal((await thumbs.count()) + empty, 16, 'of one class: with labels or without');
await page.locator('#class-filter').selectOption('');

await page.locator('h1').click();
await page.keyboard.press('ArrowRight');
await page.keyboard.press('ArrowRight');
await page.keyboard.press('Enter');
assert.ok(await page.locator('dialog.large').isVisible());
const first = await page.locator('dialog.large img').getAttribute('src');
await page.screenshot({ path: shotPath('dataset-large') });
await page.keyboard.press('ArrowRight');
assert.notEqual(await page.locator('dialog.large img').getAttribute('src'), first);
// Without boxes: the picture stays open, then the thumbnail in focus.
const boxes = (of) => page.locator(`${of} .boxes`).filter({ visible: true }).count();
assert.equal(await boxes('dialog.large'), 1);
await page.keyboard.press('b');
assert.ok(await page.locator('dialog.large').isVisible());
assert.equal(await boxes('dialog.large'), 0);
await page.keyboard.press('Escape');
assert.ok(!(await page.locator('dialog.large').isVisible()));
assert.equal(await boxes('.thumb'), 0);
const focused = () => page.evaluate(() => [...document.querySelectorAll('.thumb')].indexOf(document.activeElement));
await page.keyboard.press('ArrowRight');
const at = await focused();
assert.ok(at >= 0);
await page.keyboard.press('b');
assert.equal(await focused(), at);
assert.ok((await boxes('.thumb')) > 0);
assert.deepEqual(problems, []);
await browser.close();
