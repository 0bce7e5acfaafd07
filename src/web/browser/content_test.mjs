// SPDX-License-Identifier: Apache-2.0
// The content of the page of a report.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { makeFailed, makeMotions, makeResult, makeSeries } from './fixture.mjs';
import { ink, open, template } from './page.mjs';

test('the page contains each placeholder once', () => {
  for (const token of ['@RESULT@', '@SERIES@', '@COMMAND@']) assert.equal(template.split(token).length, 2, token);
  assert.match(
    template,
    /Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"/,
  );
});

test('values on the page equal the values in the JSON', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  // 0.0790000 ± 0.0000028: two digits of the error, by hand from 2.7734679e-6.
  assert.equal(await page.locator('[data-parameter=inertia] .value').textContent(), '0.0789996 ± 0.0000028');
  assert.equal(await page.locator('[data-parameter=viscous] .value').textContent(), '0.00300 ± 0.00010');
  assert.equal(await page.locator('[data-parameter=coulomb] .value').textContent(), '0.00399 ± 0.00011');
  const row = page.locator('#verdict tr', { hasText: 'release_angle' });
  assert.match(await row.textContent(), /0\.40000 ± 0\.00020.rad\(22\.918 ± 0\.011\)°/);
  assert.match(await page.locator('#verdict tr', { hasText: 'zero_angle' }).textContent(), /held fixed: held by --fix/);
  assert.match(await page.locator('#verdict tr', { hasText: 'inertia' }).first().textContent(), /kg.m².*0\.00004/);
  assert.match(await page.locator('.banner').textContent(), /Converged: coulomb/);
  assert.match(await page.locator('.recommendation').textContent(), /Recommended model: coulomb\. It is the simplest/);
  assert.match(await page.locator('#provenance').textContent(), /(ab){32}/);
  assert.match(await page.locator('#provenance pre').textContent(), /^fit_pendulum --data run\.csv$/);
  assert.equal(await page.title(), 'run.csv – pendulum report');
});

test('the page has all sections in order', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  const ids = await page.locator('main section').evaluateAll((parts) => parts.map((part) => part.id));
  assert.deepEqual(ids, [
    'verdict',
    'fit',
    'validation',
    'envelope',
    'phase',
    'residuals',
    'correlation',
    'profiles',
    'comparison',
    'constancy',
    'closed-forms',
    'rig',
    'provenance',
  ]);
  assert.equal(await page.locator('nav a').count(), ids.length);
  for (const plot of [
    '#fit .plot >> nth=0',
    '#fit .plot >> nth=1',
    '#validation .plot',
    '#envelope .plot',
    '#phase .plot',
    '#residuals .plot >> nth=0',
    '#residuals .plot >> nth=1',
    '#profiles .plot',
    '#constancy .plot >> nth=0',
  ]) {
    assert.ok((await ink(page, plot)) > 3000, plot);
    assert.match(await page.locator(plot).getAttribute('aria-label'), /\w.*\.$/, plot);
  }
});

test('the page begins with the failure of a fit and has its other sections', async (t) => {
  const page = await open(t, makeFailed(), {
    ...makeSeries({ models: [] }),
    peaks: [],
    extrema: [],
    models: { coulomb: { fitted: null, residual: null, linear_closed_form: null, nonlinear_closed_form: null } },
  });
  assert.match(
    await page.locator('main').innerText(),
    /^Verdict\s+✕\s+The fit failed, so there is no result\s+The pendulum never moves\./,
  );
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|null/);
});

for (const [status, words] of [
  ['not_converged', /Not converged/],
  ['not_identifiable', /Not identifiable/],
]) {
  test(`the page begins with the status ${status}`, async (t) => {
    const result = makeResult({ models: ['coulomb'] });
    result.fits[0].status = status;
    for (const parameter of Object.values(result.fits[0].parameters))
      Object.assign(parameter, { std_error: null, interval95: null, reason: 'it did not converge' });
    const page = await open(t, result, makeSeries({ models: ['coulomb'] }));
    assert.match(await page.locator('.banner.bad').textContent(), words);
    assert.match(await page.locator('#verdict table').first().textContent(), /it did not converge/);
  });
}

test('without samples the tables remain', async (t) => {
  const page = await open(t, makeResult(), null, { command: null });
  assert.match(await page.locator('#fit').textContent(), /samples are not part of this report/);
  assert.equal(await page.locator('[data-parameter=inertia] .value').textContent(), '0.0789996 ± 0.0000028');
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|null/);
});

test('no number of a full report is NaN', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  for (const summary of await page.locator('summary').all()) await summary.click();
  await page.waitForFunction(() => [...document.querySelectorAll('details[open]')].every((part) => part.children.length > 1));
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|\bnull\b|Infinity/);
});

test('a name that looks like HTML is shown as text', async (t) => {
  const name = 'a/<img src=x onerror=alert(1)></script><b>.csv';
  const result = makeResult({ path: name });
  result.warnings.push({ code: 'odd', message: '<i>odd</i>' });
  const page = await open(t, result, makeSeries(), { command: { command: `fit_pendulum --data '${name}'` } });
  assert.equal(await page.locator('#provenance dd').first().textContent(), name);
  assert.equal(await page.locator('#report img, #report b').count(), 0);
});

test('an undersampled swing is drawn together with its slow apparent swing', async (t) => {
  const options = { models: ['viscous'], samples: 30, rate: 1 };
  const result = makeResult(options);
  result.warnings = [{ code: 'aliased', message: 'less than twice a swing' }];
  result.data.sampling = { ...result.data.sampling, frequency_hz: 0.7604, apparent_frequency_hz: null };
  const series = { ...makeSeries(options), peaks: [], extrema: [], motions: makeMotions(options) };
  const page = await open(t, result, series);
  // The motion of the fixture swings at 1 / 1.315 s = 0.7605 Hz: |0.7605 - 1| = 0.2395 Hz.
  const words = await page.locator('#validation').textContent();
  const apparent = Number(/\|f − fₛ\| = ([\d.]+) Hz/.exec(words)[1]);
  assert.ok(Math.abs(apparent - 0.2395) < 2e-4, words);
  for (const plot of ['#validation .plot', '#phase .plot']) assert.ok((await ink(page, plot)) > 3000, plot);
});

test('closed forms alone, without a fit', async (t) => {
  const result = { ...makeResult({ models: ['viscous'] }), fits: [], comparison: null };
  const page = await open(t, result, { ...makeSeries({ models: [] }), profiles: null });
  assert.match(await page.locator('.banner').textContent(), /No fit was made/);
  assert.match(await page.locator('#closed-forms tr', { hasText: 'log_decrement' }).textContent(), /0\.0394 ± 0\.0005/); // 0.03 1.315
  assert.ok((await ink(page, '#envelope .plot')) > 3000);
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|\bnull\b/);
});
