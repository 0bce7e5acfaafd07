// SPDX-License-Identifier: Apache-2.0
// The page of several recordings that were fitted together.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { assertAccessible, assertRange, ink, kLooks, open, shownRange } from './page.mjs';
import { makeJoint, makeJointFailed, makeOdd, makeRecorded, withLongPaths } from './reports.mjs';

const openJoint = (t) => open(t, makeJoint());
const kNothing = /NaN|undefined|\bnull\b|Infinity/;

test('the page has all sections in order', async (t) => {
  const page = await openJoint(t);
  const ids = await page.locator('main section').evaluateAll((parts) => parts.map((part) => part.id));
  const one = ['fit', 'validation', 'envelope', 'phase', 'residuals', 'constancy', 'closed-forms', 'data'];
  const rest = ['correlation', 'comparison', 'warnings', 'rig', 'provenance'];
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
  assert.equal(await page.locator('[data-parameter=release_angle]').count(), 0);
  assert.doesNotMatch(await page.locator('#parameters table').first().textContent(), /release_angle/);
  assert.doesNotMatch(await page.locator('.answer-table').textContent(), /random effects/);
  assert.ok((await ink(page, '#verdict .plot')) > 3000);
});

test('plot and table have the separate fits, the joint fit and the random effects', async (t) => {
  const content = makeJoint();
  const page = await open(t, content);
  const fit = content.result.fits.find(({ model }) => model === content.result.comparison.recommended);
  const { recordings, random_effects: effects } = fit.homogeneity.parameters.inertia;
  const first = page.locator('[data-forest=inertia] tbody tr').first(); // without the drawing of the text
  assert.ok((await first.textContent()).includes(recordings[0].text));
  assert.equal(
    await page.locator('[data-forest=inertia] .forest').getAttribute('aria-label'),
    `Forest plot of the moment of inertia in s²: ${recordings.map(({ text }, k) => `recording ${k + 1} ${text}`).join(', ')}, ` +
      `joint fit ${fit.parameters.inertia.text} and random effects ${effects.text}.`,
  );
  assert.equal(await page.locator('[data-forest=inertia] line.joint').count(), 1);
  const places = await page.locator('[data-forest=inertia] .strip svg path').evaluateAll((all) =>
    all.map((path) => path.getBoundingClientRect()).filter((box) => box.width > 9).map((box) => box.x + box.width / 2),
  );
  const estimates = [...recordings, fit.parameters.inertia].map(({ estimate }) => estimate).concat(effects.mean);
  const order = (values) => values.map((_value, i) => i).sort((a, b) => values[a] - values[b]);
  assert.deepEqual(order(places), order(estimates));
});

test('a recording that disagrees is marked in words everywhere', async (t) => {
  const page = await open(t, makeOdd());
  assert.match(await page.locator('.banner:not(.good)').textContent(), /do not quote them.*recording 4 \(.*\) disagrees with the others/);
  assert.match(await page.locator('#agreement .caution').textContent(), /recording 4 \(.*\) disagrees with the others/);
  assert.match(await page.locator('[data-forest=inertia] .labels').textContent(), /recording 4disagrees/);
  assert.match(await page.locator('#recordings tbody tr').nth(3).textContent(), /^4disagrees.*runs_4\.csv/);
  assert.equal(await page.locator('#recordings table').first().locator('.no').count(), 1);
});

test('recordings that scatter have the random-effects mean next to the joint estimate', async (t) => {
  const content = makeJoint();
  const page = await open(t, content);
  await page.locator('.models label', { hasText: 'viscous' }).click(); // its values differ between the recordings
  const { homogeneity } = content.result.fits.find(({ model }) => model === 'viscous');
  assert.deepEqual([homogeneity.agrees, homogeneity.outliers], [false, []]);
  assert.match(await page.locator('.banner:not(.good)').textContent(), /do not agree on viscous/);
  const remark = `random effects: ${homogeneity.parameters.viscous.random_effects.text}`;
  assert.equal(await page.locator('[data-parameter=viscous] td small').first().textContent(), remark);
});

test('overlaid recordings are shown and hidden one by one, and zoomed together', async (t) => {
  const content = makeJoint();
  const page = await open(t, content);
  const [main, below] = ['#overlay .plot >> nth=0', '#overlay .plot >> nth=1'];
  const label = (plot) => page.locator(plot).getAttribute('aria-label');
  assert.match(await label(main), /^Recordings 1, 2 and 3, measured and fitted: angle over time from \S+ to \S+ s\.$/);
  const whole = await shownRange(page, main);
  const toggle = page.locator('#overlay').getByRole('button', { name: 'recording 2' });
  await toggle.click();
  assert.equal(await toggle.getAttribute('aria-pressed'), 'false');
  assert.match(await label(main), /^Recordings 1 and 3, measured and fitted/);
  const sizes = [0, 2].map((k) => {
    const { measured, models } = content.series[k];
    const squares = measured.map((value, i) => (value - models.coulomb.fitted[i]) ** 2);
    const rms = Math.sqrt(squares.reduce((sum, x) => sum + x, 0) / squares.length);
    return `recording ${k + 1} ${Number(((180 / Math.PI) * rms).toPrecision(3))} °`;
  });
  assert.equal((await label(below)).split('; ')[1], `root mean squares: ${sizes.join(', ')}.`);
  for (const name of ['recording 1', 'recording 3'])
    await page.locator('#overlay').getByRole('button', { name, exact: true }).click();
  assert.match(await label(main), /^Recordings none/);
  assert.ok((await ink(page, main)) < 0.7 * (await ink(await openJoint(t), main)));
  await toggle.click();
  await page.locator('#overlay').getByRole('button', { name: 'fitted' }).click();
  assert.match(await label(main), /^Recordings 2, measured: /);
  await page.locator('#overlay').getByRole('button', { name: 'Zoom in' }).click();
  const [from, to] = await shownRange(page, main);
  assert.ok(Math.abs(to - from - 0.5 * (whole[1] - whole[0])) < 0.02, `${from} ${to}`);
  assert.deepEqual(await shownRange(page, below), [from, to]);
  await page.locator('#overlay .linked').focus();
  await page.keyboard.press('0');
  assertRange(await shownRange(page, main), whole);
  await page.locator('#overlay summary').click();
  assert.match(await page.locator('#overlay details tbody tr').first().textContent(), /^2−?\d/);
});

test('another recording and another model are shown in detail', async (t) => {
  const content = makeJoint();
  const page = await open(t, content);
  assert.equal(await page.locator('#fit h2').textContent(), 'Measured and fitted · recording 1');
  await page.locator('.recordings label', { hasText: '2' }).click();
  assert.equal(await page.locator('#fit h2').textContent(), 'Measured and fitted · recording 2');
  assert.match(await page.locator('#one').textContent(), /Recording 2: runs_2\.csv\./);
  assertRange(await shownRange(page), content.result.recordings[1].window_s);
  const noise = content.sections.find(({ id, law, recording }) => id.startsWith('noise') && law === 'coulomb' && recording === 2);
  const [{ text }] = noise.blocks[0].rows;
  assert.ok((await page.locator('#residuals').textContent()).includes(/[\d.]+ rad/.exec(text)[0]), text);
  await page.locator('.models label', { hasText: 'drag' }).click();
  assert.equal(await page.locator('#fit h2').textContent(), 'Measured and fitted · recording 2');
  assert.match(await page.locator('#fit .plot >> nth=0').getAttribute('aria-label'), /^measured and drag/);
  assert.equal(await page.locator('[data-forest]').count(), 4);
});

test('the provenance lists all files, and different calibrations separately', async (t) => {
  const content = makeJoint();
  content.result.recordings[1].calibration = makeRecorded().result.recordings[0].calibration;
  const page = await open(t, content);
  const words = await page.locator('#provenance').textContent();
  for (const { sha256 } of content.result.recordings) assert.ok(words.includes(sha256), sha256);
  assert.match(await page.locator('#rig').textContent(), /Recording 1: runs_1\.csv.*No calibration.*Recording 2: runs_2\.csv/);
  assert.equal(await page.title(), '3 recordings – pendulum report');
});

test('the page reports that a joint fit failed and that the agreement is unknown', async (t) => {
  const content = makeJointFailed();
  const page = await open(t, content);
  const words = await page.locator('.banner.bad').textContent();
  const { verdict, agreement } = content.result.fits[0].summary;
  for (const sentence of [verdict, agreement]) assert.ok(words.includes(sentence), sentence);
  assert.ok((await ink(page, '#overlay .plot')) > 3000);
  assert.doesNotMatch(await page.locator('main').innerText(), kNothing);
});

test('without samples the tables remain; no number is NaN', async (t) => {
  const bare = await open(t, { ...makeJoint(), series: null, command: null });
  assert.match(await bare.locator('#overlay').textContent(), /samples are not part of this report/);
  const page = await open(t, makeOdd());
  for (const summary of await page.locator('summary').all()) await summary.click();
  for (const one of [bare, page]) assert.doesNotMatch(await one.locator('main').innerText(), kNothing);
});

for (const [colorScheme, name, width] of kLooks) {
  test(`${colorScheme}, ${name}: a joint report is accessible and not wider than the window`, async (t) => {
    const page = await open(t, withLongPaths(makeOdd()), { context: { colorScheme, viewport: { width, height: 800 } } });
    await assertAccessible(page);
  });
}

test('on paper the forest plots fit the page', async (t) => {
  const page = await open(t, makeOdd(), { context: { viewport: { width: 680, height: 900 } } });
  await page.emulateMedia({ media: 'print' });
  const ends = await page.locator('.forest').evaluateAll((all) => all.map((plot) => plot.getBoundingClientRect().right));
  assert.ok(Math.max(...ends) <= 680, String(ends)); // A4 less margins of 15 mm is 680 px wide
  assert.ok((await page.pdf({ preferCSSPageSize: true })).length > 20_000);
});
