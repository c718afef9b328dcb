// A run's page in a browser without WebGL: a still picture, and all else works. And the plain page of a build without Node.
import assert from 'node:assert/strict';
import path from 'node:path';
import { launch, open } from './browser.mjs';
import { drive, shotPath, temporaryFolder, waretwin } from './folders.mjs';

const browser = await launch({ webgl: false });
const out = drive(temporaryFolder(), '--set', 'simulation.colour=false');
const file = path.join(out, 'report.html');
const { page, problems } = await open(browser, file);
const still = page.locator('.still img');
assert.ok(await still.isVisible());
assert.ok(await still.evaluate((image) => image.complete && image.naturalWidth > 100), 'the picture is one');
assert.ok((await page.locator('.still').textContent()).includes('WebGL'));
assert.equal(await page.locator('.canvas').count(), 0);
await page.screenshot({ path: shotPath('still') });

// Without colour pictures, boxes are over the depth.
await page.locator('input.time').focus();
await page.keyboard.press('Home');
const before = await page.locator('.frames img.colour').getAttribute('src');
assert.ok(before.startsWith('data:image/jpeg'));
await page.keyboard.press('ArrowRight');
assert.notEqual(await page.locator('.frames img.colour').getAttribute('src'), before);
await page.locator('tbody tr[tabindex]').first().click();
assert.ok(await page.locator('.details').isVisible());
// Keys that need no 3D.
await page.keyboard.press('Escape');
assert.ok(!(await page.locator('.details').isVisible()));
await page.keyboard.press('n');
assert.ok(await page.locator('.details').isVisible());
assert.equal(await page.locator('tr.chosen').count(), 1);
await page.keyboard.press('b');
assert.ok(!(await page.locator('.frames .boxes').isVisible()));
assert.ok(!(await page.locator('#show-boxes').isChecked()));
await page.locator('#show-boxes').check();
assert.ok(await page.locator('.frames .boxes').isVisible());
// Browsers themselves say that WebGL is off; nothing else may be wrong.
assert.deepEqual(problems.filter((text) => !/WebGL/i.test(text)), []);

process.env.WARETWIN_VIEWER = 'none';
waretwin('report', out);
const plain = await browser.newPage();
await plain.goto(`file://${file}`);
assert.ok((await plain.locator('.note').first().textContent()).includes('plain page'));
assert.equal(await plain.locator('script').count(), 0);
assert.ok((await plain.locator('figure img').count()) >= 2);
await plain.screenshot({ path: shotPath('plain') });
await browser.close();
