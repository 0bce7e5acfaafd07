// SPDX-License-Identifier: Apache-2.0
// The page of several recordings that were fitted together.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { makeJointFailed, makeJointResult, makeJointSeries } from './fixture_joint.mjs';
import { assertAccessible, assertRange, ink, kLooks, open, shownRange } from './page.mjs';

const openJoint = (t, options = {}, more = {}) => open(t, makeJointResult(options), makeJointSeries(options), more);
const kNothing = /NaN|undefined|\bnull\b|Infinity|not_/;

test('the page has all sections in order', async (t) => {
  const page = await openJoint(t);
  const ids = await page.locator('main section').evaluateAll((parts) => parts.map((part) => part.id));
  const one = ['fit', 'validation', 'envelope', 'phase', 'residuals', 'constancy', 'closed-forms', 'data'];
  const rest = ['correlation', 'profiles', 'comparison', 'warnings', 'told-of-a-new-kind', 'rig', 'provenance'];
  assert.deepEqual(ids, ['verdict', 'agreement', 'parameters', 'recordings', 'overlay', 'one', ...one, ...rest]);
  assert.equal(await page.locator('nav a').count(), ids.length);
  assert.equal(await page.locator('h1').textContent(), '3 recordings, fitted together');
  for (const plot of ['#overlay .plot >> nth=0', '#overlay .plot >> nth=1', '#fit .plot >> nth=0'])
    assert.ok((await ink(page, plot)) > 3000, plot);
});

test('the page begins with the agreement and the shared parameters', async (t) => {
  const page = await openJoint(t);
  const banner = page.locator('.banner.good');
  assert.match(await banner.locator('.title').textContent(), /^The recordings agree on inertia, viscous/);
  assert.match(await banner.textContent(), /The law coulomb describes the readings/);
  assert.equal(await page.locator('[data-parameter=inertia] .value > span').textContent(), '0.07900 ± 0.00004');
  assert.equal(await page.locator('[data-parameter=release_angle]').count(), 0);
  assert.doesNotMatch(await page.locator('#parameters table').first().textContent(), /release_angle/);
  assert.doesNotMatch(await page.locator('.answer-table').textContent(), /random effects/);
  assert.ok((await ink(page, '#verdict .plot')) > 3000);
});

test('plot and table have the separate fits, the joint fit and the random effects', async (t) => {
  const page = await openJoint(t);
  const table = page.locator('[data-forest=inertia] table'); // without the drawing of the text
  assert.equal((await table.locator('tbody tr').first().locator('th, td').allTextContents()).join('|'), '1 separate|0.079 ± 0.001|−0.5');
  const told = await page.locator('[data-forest=inertia] .forest').getAttribute('aria-label');
  assert.match(told, /recording 1 0\.078997 ± 0\.000006, .*, joint fit 0\.0789996 ± 0\.0000028 and random effects/);
  assert.equal(await page.locator('[data-forest=inertia] line.joint').count(), 1);
  const places = await page.locator('[data-forest=inertia] .strip svg path').evaluateAll((all) =>
    all.map((path) => path.getBoundingClientRect()).filter((box) => box.width > 9).map((box) => box.x + box.width / 2),
  );
  assert.equal(places.length, 5);
  assert.ok(places[0] < places[3] && places[3] < places[1] && places[1] < places[2], String(places)); // in order of the estimates
});

test('a recording that disagrees is marked in words everywhere', async (t) => {
  const page = await openJoint(t, { odd: true });
  assert.match(await page.locator('.banner.caution').textContent(), /recording 3 disagrees with the others.*do not quote them/);
  assert.match(await page.locator('#agreement .alarm').textContent(), /recording 3 disagrees with the others/);
  assert.match(await page.locator('[data-forest=inertia] .labels').textContent(), /recording 3disagrees/);
  assert.match(await page.locator('#recordings tbody tr').nth(2).textContent(), /^3disagreesrun3\.csv/);
  assert.equal(await page.locator('#recordings .no').count(), 1);
});

test('recordings that scatter have the random-effects mean next to the joint estimate', async (t) => {
  const result = makeJointResult();
  for (const fit of result.fits) {
    fit.homogeneity.agrees = false;
    Object.assign(fit.summary, { level: 'caution', agreement: 'They scatter.' });
  }
  const page = await open(t, result, makeJointSeries());
  assert.match(await page.locator('.banner.caution').textContent(), /^!They scatter\./);
  assert.match(await page.locator('[data-parameter=inertia] small').first().textContent(), /random effects: 0\.079002 ± 0\.000006/);
});

test('overlaid recordings are shown and hidden one by one, and zoomed together', async (t) => {
  const page = await openJoint(t);
  const [main, below] = ['#overlay .plot >> nth=0', '#overlay .plot >> nth=1'];
  const label = (plot) => page.locator(plot).getAttribute('aria-label');
  assert.match(await label(main), /^Recordings 1, 2 and 3, measured and fitted: angle over time from −1 to 18\.99 s\.$/);
  const toggle = page.locator('#overlay').getByRole('button', { name: 'recording 2' });
  await toggle.click();
  assert.equal(await toggle.getAttribute('aria-pressed'), 'false');
  assert.match(await label(main), /^Recordings 1 and 3, measured and fitted/);
  const { residual } = makeJointSeries()[0].models.coulomb; // the same for all recordings
  const rms = Math.sqrt(residual.reduce((sum, x) => sum + x * x, 0) / residual.length).toPrecision(3);
  const sizes = `root mean squares: recording 1 ${rms} rad, recording 3 ${rms} rad.`;
  assert.equal((await label(below)).split('; ')[1], sizes);
  for (const name of ['recording 1', 'recording 3'])
    await page.locator('#overlay').getByRole('button', { name, exact: true }).click();
  assert.match(await label(main), /^Recordings none/);
  assert.ok((await ink(page, main)) < 0.7 * (await ink(await openJoint(t), main)));
  await toggle.click();
  await page.locator('#overlay').getByRole('button', { name: 'fitted' }).click();
  assert.match(await label(main), /^Recordings 2, measured: /);
  await page.locator('#overlay').getByRole('button', { name: 'Zoom in' }).click();
  assertRange(await shownRange(page, main), [3.998, 13.99]);
  assert.deepEqual(await shownRange(page, below), await shownRange(page, main));
  await page.locator('#overlay .linked').focus();
  await page.keyboard.press('0');
  assertRange(await shownRange(page, main), [-1, 18.99]);
  await page.locator('#overlay summary').click();
  assert.match(await page.locator('#overlay details tbody tr').first().textContent(), /^2−1\.000/);
});

test('another recording and another model are shown in detail', async (t) => {
  const page = await openJoint(t);
  assert.equal(await page.locator('#fit h2').textContent(), 'Measured and fitted · recording 1');
  await page.locator('.recordings label', { hasText: '2' }).click();
  assert.equal(await page.locator('#fit h2').textContent(), 'Measured and fitted · recording 2');
  assert.match(await page.locator('#one').textContent(), /Recording 2: run2\.csv\./);
  assertRange(await shownRange(page), [0.5, 20.49]);
  assert.match(await page.locator('#residuals').textContent(), /0\.004 rad/);
  await page.locator('.models label', { hasText: 'drag' }).click();
  assert.equal(await page.locator('#fit h2').textContent(), 'Measured and fitted · recording 2');
  assert.match(await page.locator('#fit .plot >> nth=0').getAttribute('aria-label'), /^measured and drag/);
  assert.equal(await page.locator('[data-forest]').count(), 4);
  assert.match(await page.locator('[data-parameter=drag]').textContent(), /at its bound/);
});

test('the provenance lists all files, and different calibrations separately', async (t) => {
  const page = await openJoint(t);
  const words = await page.locator('#provenance').textContent();
  for (const k of [1, 2, 3]) assert.match(words, new RegExp(`folder/run${k}\\.csv.*(${k}a){32}`));
  assert.match(await page.locator('#rig').textContent(), /Recording 1: run1\.csv.*No calibration.*Recording 2: run2\.csv/);
  assert.equal(await page.title(), '3 recordings – pendulum report');
});

test('the page reports that a joint fit failed and that the agreement is unknown', async (t) => {
  const failed = makeJointFailed();
  const series = makeJointSeries({ models: [] }).map((one) => ({ ...one, profiles: null, peaks: [], extrema: [] }));
  const page = await open(t, failed, series);
  assert.match(await page.locator('.banner.bad').textContent(), /No result with coulomb.*the pendulum never moves.*Not tested/s);
  assert.ok((await ink(page, '#overlay .plot')) > 3000);
  assert.doesNotMatch(await page.locator('main').innerText(), kNothing);
});

test('without samples the tables remain; no number is NaN', async (t) => {
  const bare = await open(t, makeJointResult(), null, { command: null });
  assert.match(await bare.locator('#overlay').textContent(), /samples are not part of this report/);
  const page = await openJoint(t, { odd: true });
  for (const summary of await page.locator('summary').all()) await summary.click();
  for (const one of [bare, page]) assert.doesNotMatch(await one.locator('main').innerText(), kNothing);
});

for (const [colorScheme, name, width] of kLooks) {
  test(`${colorScheme}, ${name}: a joint report is accessible and not wider than the window`, async (t) => {
    const page = await openJoint(t, { odd: true, count: 8 }, { context: { colorScheme, viewport: { width, height: 800 } } });
    await assertAccessible(page);
  });
}

test('on paper the forest plots fit the page', async (t) => {
  const page = await openJoint(t, { odd: true }, { context: { viewport: { width: 680, height: 900 } } });
  await page.emulateMedia({ media: 'print' });
  const ends = await page.locator('.forest').evaluateAll((all) => all.map((plot) => plot.getBoundingClientRect().right));
  assert.ok(Math.max(...ends) <= 680, String(ends)); // A4 less margins of 15 mm is 680 px wide
  assert.ok((await page.pdf({ preferCSSPageSize: true })).length > 20_000);
});
