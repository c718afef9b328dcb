// A study's page: the best and by how much, sorting, a click in the Pareto plot, coverage beside the baseline's.
import assert from 'node:assert/strict';
import path from 'node:path';
import { launch, open } from './browser.mjs';
import { shotPath, study, temporaryFolder, waretwin } from './folders.mjs';

const browser = await launch();
const { out, best } = study(temporaryFolder());
waretwin('report', out);
const { page, problems, seconds } = await open(browser, path.join(out, 'report.html'));
console.log(`loaded in ${seconds.toFixed(2)} s`);
assert.equal(await page.locator('body').getAttribute('data-ready'), 'study');
await page.screenshot({ path: shotPath('study'), fullPage: true });

const first = () => page.locator('tbody tr td').first().textContent();
assert.ok((await first()).startsWith(best.name), 'the best is on top');
assert.ok((await page.locator('.card').nth(1).textContent()).includes('against the baseline'));
assert.equal(await page.locator('tr.best').count(), 1);
assert.equal(await page.locator('tr.chosen').count(), 1);

// Sorting: by a factor up and down; candidates without a value stay at the end.
const heads = page.locator('th .sort');
await heads.filter({ hasText: /^pitch$/ }).click();
const column = () => page.locator('table[aria-label="Candidates"] tbody tr td:nth-child(3)').allTextContents();
let pitches = (await column()).map(Number);
assert.deepEqual(pitches, [...pitches].sort((a, b) => a - b));
await heads.filter({ hasText: /^pitch$/ }).click();
pitches = (await column()).map(Number);
assert.deepEqual(pitches, [...pitches].sort((a, b) => b - a));
await heads.filter({ hasText: /^e trans/ }).click();
const states = await page.locator('table[aria-label="Candidates"] tbody tr').evaluateAll((rows) => rows.map((row) => row.lastElementChild.textContent));
assert.deepEqual(states.slice(-3), ['–', '–', '–'], 'without a value last');

// The Pareto plot: a click chooses; axes can be others.
await page.locator('circle[data-candidate="c006"]').click();
assert.equal(await page.evaluate(() => window.waretwinPage.choice.candidate.name), 'c006');
assert.ok((await page.locator('tr.chosen').textContent()).includes('c006'));
assert.equal(await page.locator('.pictures.pair figure').count(), 4, 'preview and coverage, with the baseline beside');
const axis = () => page.locator('.chart .axis').first().textContent();
const before = await axis();
await page.getByLabel('Across').selectOption('e_trans');
assert.notEqual(await axis(), before);
assert.equal(await page.locator('circle[data-candidate]').count(), 9, 'c004 has no such measure');
await page.getByLabel('Measure').selectOption('floor_coverage');
await page.keyboard.press('b');
assert.ok((await page.locator('tr.chosen').textContent()).includes(best.name));
await page.screenshot({ path: shotPath('study-chosen') });
assert.deepEqual(problems, []);
await browser.close();
