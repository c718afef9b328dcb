// A study's page: the best and by how much, sorting, a choice in the Pareto plot, coverage beside the baseline's, what was refused and why.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { launch, open } from './browser.mjs';
import { realStudy, shapeOf, shotPath, study, temporaryFolder, waretwin } from './folders.mjs';

const browser = await launch();
const folder = temporaryFolder();
const { out, best, verdict, refusal, failure } = study(folder);
waretwin('report', out);
const { page, problems, seconds } = await open(browser, path.join(out, 'report.html'));
console.log(`loaded in ${seconds.toFixed(2)} s`);
assert.equal(await page.locator('body').getAttribute('data-ready'), 'study');
await page.screenshot({ path: shotPath('study'), fullPage: true });

const chosen = () => page.evaluate(() => window.waretwinPage.choice.candidate.name);
const rows = (of) => of.locator('table[aria-label="Candidates"] tbody tr');
const points = (of) => of.locator('circle[data-candidate]').count();
const first = () => rows(page).first().locator('td').first().textContent();
assert.ok((await first()).startsWith(best.name), 'the best is on top');
assert.ok((await page.locator('.verdict').textContent()).includes(verdict));
assert.ok((await page.locator('.card').nth(1).textContent()).includes('against the baseline'));
assert.ok((await page.locator('.card').last().textContent()).includes('10 of 12'));
assert.equal(await page.locator('tr.best').count(), 1);
assert.equal(await page.locator('tr.chosen').count(), 1);

// Why a candidate was refused, and why a drive failed.
const row = (name) => rows(page).filter({ hasText: name });
assert.ok((await row('c011').textContent()).includes(refusal));
assert.ok((await row('c003').textContent()).includes('mean_e_trans_m < 0.03 does not hold'));
await row('c007').click();
assert.ok((await page.locator('td.bad').filter({ hasText: failure }).count()) > 0);

// Intervals are the study's own.
const text = await page.locator('#app').textContent();
assert.ok(text.includes('90 % interval') && text.includes('[90 %]') && !text.includes('95 %'));
assert.ok(text.includes('What the candidates of a level have on average, all other factors being equal (least squares over candidates).'));
assert.ok((await page.locator('.level title').first().textContent()).endsWith('candidates'));

// Sorting: by a factor up and down; candidates without a value stay at the end.
const heads = page.locator('th .sort');
await heads.filter({ hasText: /^pitch$/ }).click();
const column = () => page.locator('table[aria-label="Candidates"] tbody tr td:nth-child(3)').allTextContents();
let pitches = (await column()).map(Number);
assert.deepEqual(pitches, [...pitches].sort((a, b) => a - b));
await heads.filter({ hasText: /^pitch$/ }).click();
pitches = (await column()).map(Number);
assert.deepEqual(pitches, [...pitches].sort((a, b) => b - a));
await heads.filter({ hasText: /^mean e trans/ }).click();
const last = await rows(page).evaluateAll((list) => list.map((each) => each.lastElementChild.textContent));
assert.deepEqual(last.slice(-3), ['–', '–', '–'], 'without a value last');

// The Pareto plot: a click chooses; so do Enter and space, and the point keeps the focus.
await page.locator('circle[data-candidate="c006"]').click();
assert.equal(await chosen(), 'c006');
assert.ok((await page.locator('tr.chosen').textContent()).includes('c006'));
assert.equal(await page.locator('.pictures.pair figure').count(), 4, 'preview and coverage, with the baseline beside');
for (const [key, name] of [['Enter', 'c001'], [' ', 'c002']]) {
  await page.locator(`circle[data-candidate="${name}"]`).focus();
  await page.keyboard.press(key);
  assert.equal(await chosen(), name);
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('data-candidate')), name, `focus after '${key}'`);
  assert.equal(await page.locator('circle.chosen').getAttribute('data-candidate'), name);
}

// Axes can be others; of coverage there are also those that were screened out or refused by it.
const axis = () => page.locator('.chart .axis').first().textContent();
const before = await axis();
assert.equal(await points(page), 10);
await page.getByLabel('Across').selectOption('mean_e_trans_m');
assert.notEqual(await axis(), before);
assert.equal(await points(page), 9, 'c004 has no such measure');
await page.getByLabel('Across').selectOption('object_coverage');
await page.getByLabel('Up', { exact: true }).selectOption('floor_coverage');
assert.equal(await points(page), 12);
assert.equal(await page.locator('circle.quiet').getAttribute('data-candidate'), 'c010');
await page.getByLabel('Measure').selectOption('floor_coverage');
await page.keyboard.press('Escape');
await page.locator('h1').click();
await page.keyboard.press('b');
assert.ok((await page.locator('tr.chosen').textContent()).includes(best.name));
await page.keyboard.press('n');
assert.notEqual(await chosen(), best.name);
await page.screenshot({ path: shotPath('study-chosen') });

// Down scrolls, as on any page.
await page.evaluate(() => window.scrollTo(0, 0));
await page.locator('h1').click();
const beforeDown = await chosen();
await page.keyboard.press('ArrowDown');
await page.waitForFunction(() => window.scrollY > 0, null, { timeout: 5000 });
assert.equal(await chosen(), beforeDown);
assert.deepEqual(problems, []);

// None may be the best; then the page says why.
const file = path.join(out, 'results.json');
const none = JSON.parse(readFileSync(file, 'utf8'));
none.best = null;
none.verdict = 'none: every candidate breaks a constraint, or could not be driven';
for (const candidate of none.candidates) Object.assign(candidate, { feasible: false, pareto: false });
writeFileSync(file, JSON.stringify(none));
waretwin('report', out);
const without = await open(browser, path.join(out, 'report.html'));
assert.ok((await without.page.locator('.verdict').textContent()).includes(none.verdict));
assert.equal(await rows(without.page).count(), 12);
assert.deepEqual(without.problems, []);

// Coverage alone: the same page, of the measures that there are.
const looked = async (report, candidates) => {
  const { page: covered, problems: wrong } = await open(browser, report);
  assert.equal(await points(covered), candidates);
  assert.equal(await rows(covered).count(), candidates);
  assert.equal(await covered.locator('circle.quiet').count(), 0);
  assert.ok(!(await rows(covered).first().textContent()).includes('screened out'));
  assert.ok((await covered.locator('.card').last().textContent()).includes('by coverage alone'));
  const was = await covered.locator('tr.chosen').textContent();
  await covered.keyboard.press('n');
  assert.notEqual(await covered.locator('tr.chosen').textContent(), was);
  assert.deepEqual(wrong, []);
  return covered;
};
const screening = study(folder, { driven: false });
waretwin('report', screening.out);
const covered = await looked(path.join(screening.out, 'report.html'), 12);
assert.equal(await covered.locator('th', { hasText: 'mean iou3d' }).count(), 0, 'nobody has a value of it');
await covered.screenshot({ path: shotPath('study-coverage'), fullPage: true });

// A real one has a page, too, and just the keys of the made-up one.
const real = realStudy(folder);
const results = (of) => JSON.parse(readFileSync(path.join(of, 'results.json'), 'utf8'));
const made = shapeOf(none);
assert.deepEqual([...shapeOf(results(real.out))].sort(), [...made].sort());
for (const key of shapeOf(results(real.screening))) assert.ok(made.has(key), key);
const driven = await open(browser, path.join(real.out, 'report.html'));
assert.ok((await driven.page.locator('.verdict').textContent()).includes(results(real.out).verdict));
assert.equal(await rows(driven.page).count(), 3);
assert.deepEqual(driven.problems, []);
await looked(path.join(real.screening, 'report.html'), 3);
await browser.close();
