// SPDX-License-Identifier: Apache-2.0
// Mouse and keyboard on the page of a report.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { assertAccessible, assertRange, ink, kPlot, open, shownRange } from './page.mjs';
import { makeReport } from './reports.mjs';

test('dragging zooms, the residuals follow, and Show all goes back', async (t) => {
  const page = await open(t, makeReport());
  await page.locator(kPlot).scrollIntoViewIfNeeded();
  const box = await page.locator(`${kPlot} >> .u-over`).boundingBox();
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + 0.25 * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, y, { steps: 5 });
  await page.mouse.up();
  const [from, to] = await shownRange(page);
  assert.ok(Math.abs(from - 0.25 * 19.99) < 0.1 && Math.abs(to - 0.5 * 19.99) < 0.1, `${from} ${to}`);
  assert.deepEqual(await shownRange(page, '#fit .plot >> nth=1'), [from, to]);
  await page.locator('#fit').getByRole('button', { name: 'Show all' }).click();
  assert.deepEqual(await shownRange(page), [0, 19.99]);
  await page.locator('#fit').getByRole('button', { name: 'Zoom in' }).click();
  await page.locator('#fit').getByRole('button', { name: 'Later' }).click();
  const [later] = await shownRange(page);
  assert.ok(Math.abs(later - (19.99 / 4 + 19.99 / 8)) < 0.02, String(later));
  await page.locator(kPlot).dblclick();
  assert.deepEqual(await shownRange(page), [0, 19.99]);
});

test('the keyboard zooms, moves and resets', async (t) => {
  const page = await open(t, makeReport());
  await page.locator('#fit .linked').focus();
  await page.keyboard.press('+');
  assertRange(await shownRange(page), [4.9975, 14.9925]);
  await page.keyboard.press('ArrowLeft');
  assertRange(await shownRange(page), [2.49875, 12.49375]);
  await page.keyboard.press('-');
  await page.keyboard.press('0');
  assert.deepEqual(await shownRange(page), [0, 19.99]);
});

test('every control is reached by the Tab key and shows its focus', async (t) => {
  const page = await open(t, makeReport());
  const reached = new Set();
  for (let i = 0; i < 110; ++i) {
    await page.keyboard.press('Tab');
    reached.add(
      await page.evaluate(
        () =>
          document.activeElement?.getAttribute('aria-label') ||
          document.activeElement?.textContent?.trim() ||
          document.activeElement?.getAttribute('value') ||
          document.activeElement?.className,
      ),
    );
  }
  for (const name of ['Dark', 'measured', 'Zoom in', 'Later', 'Save the plot fit as SVG', 'Samples as a table', 'Command'])
    assert.ok(reached.has(name), name);
});

test('another model can be shown in detail, or drawn over the first model', async (t) => {
  const page = await open(t, makeReport());
  const drag = page.locator('#fit').getByRole('button', { name: 'drag' });
  assert.equal(await drag.getAttribute('aria-pressed'), 'false');
  await drag.click();
  assert.match(await page.locator(kPlot).getAttribute('aria-label'), /^measured and coulomb and drag:/);
  await page.locator('#fit').getByRole('button', { name: 'Zoom in' }).click();
  await page.locator('.models label', { hasText: 'viscous' }).click();
  assert.match(await page.locator('.banner').textContent(), /The law viscous does not describe all readings/);
  assert.equal(await page.locator('[data-parameter=coulomb]').count(), 0);
  assertRange(await shownRange(page), [4.9975, 14.9925]);
  await page.locator('.models label', { hasText: 'drag' }).click();
  assert.match(await page.locator('[data-parameter=viscous]').textContent(), /at its bound/);
});

test('residuals in counts, σ and radians', async (t) => {
  const page = await open(t, makeReport());
  const size = async () =>
    Number(
      /, ([\d.]+) \S+ root mean square/.exec(await page.locator('#fit .plot >> nth=1').getAttribute('aria-label'))[1],
    );
  const degrees = await size();
  const { result } = makeReport();
  const [recording] = result.recordings;
  for (const [name, unit] of [
    ['counts', (180 / Math.PI) * recording.resolution_rad],
    ['σ', (180 / Math.PI) * recording.fits[1].noise.sigma_rad],
    ['rad', 180 / Math.PI],
  ]) {
    await page.locator('#fit .choice label', { hasText: name }).click();
    assert.ok(Math.abs((await size()) / (degrees / unit) - 1) < 0.01, name);
  }
});

test('amplitudes on a logarithmic axis', async (t) => {
  const page = await open(t, makeReport());
  await page.locator('#envelope label', { hasText: 'logarithmic' }).click();
  await page.waitForSelector('#envelope .plot[aria-label*=logarithmic]');
  assert.ok((await ink(page, '#envelope .plot')) > 3000);
});

test('a million samples are drawn and zoomed', { timeout: 600_000 }, async (t) => {
  const content = makeReport();
  const [series] = content.series;
  const kCount = 1_000_000;
  const repeated = (values) => Array.from({ length: kCount }, (_unused, i) => values[i % values.length]);
  Object.assign(series, { time_s: Array.from({ length: kCount }, (_unused, i) => i / 1000), measured: repeated(series.measured) });
  const { coulomb } = series.models;
  series.models = { coulomb: { ...coulomb, fitted: repeated(coulomb.fitted), linear_closed_form: null, nonlinear_closed_form: null } };
  const page = await open(t, content);
  assert.ok((await ink(page, kPlot)) > 20_000);
  const took = await page.evaluate(async () => {
    const start = performance.now();
    [...document.querySelectorAll('#fit button')]
      .find((button) => button.getAttribute('aria-label') === 'Zoom in')
      .click();
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    return performance.now() - start;
  });
  t.diagnostic(`one step of zoom took ${took.toFixed(0)} ms`);
  assert.ok(took < 10_000, `${took} ms`); // a page that blocks would take tens of seconds
  const [from, to] = await shownRange(page);
  assert.ok(Math.abs(from - 250) < 1 && Math.abs(to - 750) < 1);
});

/** The angle of a rod from hanging straight down, rad, positive to the right. */
const angleOf = async (page, name) => {
  const turned = await page.locator(`[data-swing=${name}]`).getAttribute('transform');
  return (-Math.PI / 180) * Number(/^rotate\((.*)\)$/.exec(turned)[1]);
};

test('the pendulum is where it was measured and fitted, and does not move for readers who prefer that', async (t) => {
  const content = makeReport();
  const page = await open(t, content, { context: { reducedMotion: 'reduce' } });
  await page.getByRole('button', { name: 'Watch it swing' }).click();
  await page.locator('.pendulum').getByRole('button', { name: 'Play' }).waitFor();
  await page.locator('.pendulum').getByLabel('Time', { exact: true }).evaluate((slider) => {
    slider.value = '5';
    slider.dispatchEvent(new Event('input'));
  });
  const time = Number(await page.locator('.pendulum').getByLabel('Time', { exact: true }).inputValue());
  const [series] = content.series;
  const next = series.time_s.findIndex((each) => each >= time);
  const share = (time - series.time_s[next - 1]) / (series.time_s[next] - series.time_s[next - 1]);
  const { recommended: model } = content.result.comparison;
  const own = content.result.recordings[0].fits.find((fit) => fit.model === model);
  const zero = own.parameters.zero_angle.estimate;
  for (const [name, values] of [['measured', series.measured], [model, series.models[model].fitted]]) {
    const angle = values[next - 1] + share * (values[next] - values[next - 1]) - zero;
    const shown = await angleOf(page, name);
    assert.ok(Math.abs(shown - angle) < 1e-9, `${name}: ${shown} is not ${angle}`);
  }
  assert.match(await page.locator('#fit .readout').textContent(), new RegExp(`^t = ${time.toFixed(1)}`)); // the plot's cursor
  await assertAccessible(page);
});

test('the pendulum swings at true speed until it is stopped', async (t) => {
  const page = await open(t, makeReport());
  await page.getByRole('button', { name: 'Watch it swing' }).click();
  const now = () => page.evaluate(() => [performance.now() / 1000, Number(document.querySelector('.pendulum input').value)]);
  await page.waitForFunction(() => Number(document.querySelector('.pendulum input').value) > 0.2);
  const [began, from] = await now();
  await page.waitForFunction((from) => Number(document.querySelector('.pendulum input').value) > from + 0.5, from);
  const [ended, to] = await now();
  assert.ok(Math.abs(to - from - (ended - began)) < 0.2, `${to - from} s in ${ended - began} s`);
  await page.locator('.pendulum').getByRole('button', { name: 'Pause' }).click();
  const stopped = await now();
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.equal((await now())[1], stopped[1]);
  await page.getByRole('button', { name: 'Watch it swing' }).click();
  assert.equal(await page.locator('.pendulum').count(), 0);
});
