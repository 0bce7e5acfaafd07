// SPDX-License-Identifier: Apache-2.0
// The content of the page of a report.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { makeFailed, makeMotions, makeResult, makeSeries, warning } from './fixture.mjs';
import { ink, open, template } from './page.mjs';

test('the page contains each placeholder once', () => {
  for (const token of ['@RESULT@', '@SECTIONS@', '@SERIES@', '@COMMAND@']) assert.equal(template.split(token).length, 2, token);
  assert.match(
    template,
    /Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"/,
  );
});

test('the first section has the words and numbers of the summary in the JSON', async (t) => {
  const result = makeResult();
  const page = await open(t, result, makeSeries());
  const { summary } = result.fits[1];
  assert.equal(await page.locator('.banner .title').textContent(), summary.verdict);
  for (const { name, value, error, source } of summary.parameters) {
    const row = page.locator(`[data-parameter=${name}]`);
    const shown = await row.locator('.value > span').textContent();
    assert.equal(shown, (error === '' ? value : `${value} ± ${error}`).replace(/\)e\+02$/, ') × 10²'));
    assert.ok((await row.textContent()).includes(source), source);
  }
  assert.equal(await page.locator('[data-parameter=inertia] .value').textContent(), '0.07900 ± 0.00004 kg\u00a0m²');
  assert.match(await page.locator('.derived').textContent(), /period of small swings 1\.3150 ± 0\.0003 s.*Q \(1\.250 ± 0\.031\) × 10²/);
  assert.equal(await page.locator('#verdict .equation').textContent(), '0.07900 θ″ + 0.00300 θ′ + 1.803 sin θ = 0');
  assert.match(await page.locator('.answer-more').textContent(), /log decrement gives IO 0\.0798 \(1 % more/);
  assert.match(await page.locator('.banner .recommendation').textContent(), /^Recommended law: coulomb\. The simplest law/);
});

test('the error budget of a parameter is a bar with words', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  const bar = (name) => page.locator(`[data-parameter=${name}] .budget`);
  // (2.77e-6 / 4.11e-5)² = 0.45 %
  assert.equal(await bar('inertia').getAttribute('aria-label'), 'Variance: 100 % rig and less than 1 % noise.');
  assert.equal(await bar('viscous').getAttribute('aria-label'), 'Variance: 100 % noise.');
  assert.equal(await bar('zero_angle').count(), 0);
  assert.deepEqual(await page.locator('.budget-legend li').allTextContents(), ['noise', 'rig']);
});

test('the sections of the program are shown with the typography of the page', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  const rows = page.locator('#parameters table').first().locator('tbody tr');
  const cells = async (row) => (await row.locator('th, td').allTextContents()).join('|');
  assert.equal(await cells(rows.nth(0)), 'moment of inertia inertia|0.07900 ± 0.00004|kg m²|[0.0789942, 0.0790051]');
  assert.equal(await cells(rows.nth(1)), 'release angle release_angle|0.40000 ± 0.0002022.918 ± 0.011|rad°|[0.39961, 0.40039]');
  assert.equal(await page.locator('#parameters thead').first().textContent(), 'NameValue ± std errorUnit95 % interval');
  assert.equal(await page.locator('#parameters td var').innerHTML(), 'I<sub>O</sub>');
  assert.match(await page.locator('#parameters table').nth(1).textContent(), /± 4\.1 × 10⁻⁵/);
  assert.match(await page.locator('#parameters').textContent(), /Standard errors: covariance σ² .*0\.07900 θ″ \+ 0\.00300 θ′ − 1\.803 sin θ = 0/);
  assert.equal(await page.locator('#correlation .quiet').first().textContent(), 'those below 0.1 in size are not listed');
  const forms = page.locator('#closed-forms');
  assert.deepEqual(await forms.locator('.no').allTextContents(), ['NO']);
  assert.match(await forms.textContent(), /inertia small angle.*inertia geometry0\.0761––/);
  assert.equal(await page.locator('#comparison .marked th').textContent(), 'coulomb');
  assert.match(await page.locator('#warnings .warnings').textContent(), /viscous: 1 × 10⁻⁵ of it/);
  await page.locator('#envelope summary', { hasText: 'Turning points' }).click();
  await page.waitForSelector('#envelope tbody tr');
  assert.deepEqual(await page.locator('#envelope tbody tr').allTextContents(), ['11.8', '... 18 more turning points', '2019.7']);
});

test('the files, the command and the name of the page', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  assert.match(await page.locator('#provenance').textContent(), /(ab){32}/);
  assert.match(await page.locator('#provenance pre').textContent(), /^fit_pendulum --data run\.csv$/);
  assert.equal(await page.title(), 'run.csv – pendulum report');
});

test('without sections the page has the charts, the first screen and one sentence', async (t) => {
  const page = await open(t, makeResult(), makeSeries(), { sections: null });
  assert.match(await page.locator('#parameters').textContent(), /tables are not part of this report/);
  assert.equal(await page.locator('#comparison, #closed-forms, #data').count(), 0);
  for (const plot of ['#fit .plot', '#residuals .plot', '#correlation .plot', '#constancy .plot']) assert.ok(await page.locator(plot).count(), plot);
});

test('warnings are with the law that they concern', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  assert.deepEqual(await page.locator('#verdict .warnings li').allTextContents(), ['Viscous is weakly identifiable.']);
  assert.doesNotMatch(await page.locator('.banner').textContent(), /warning/);
  await page.locator('#verdict summary', { hasText: 'Explanations' }).click();
  await page.waitForSelector('#verdict details .warnings');
  assert.match(await page.locator('#verdict details', { hasText: 'Explanations' }).textContent(), /record for longer/);
  assert.doesNotMatch(await page.locator('#verdict').textContent(), /more than noise; try|at the bound/);
  await page.locator('.models label', { hasText: 'drag' }).click();
  assert.match(await page.locator('#verdict .warnings').first().textContent(), /At the bound 0: drag\./);
  assert.match(await page.locator('.recommendation').first().textContent(), /not the recommended law\. Recommended: coulomb/);
});

test('nothing on the first screen is about the solver', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  assert.doesNotMatch(await page.locator('#verdict').innerText(), /[Cc]onverged|minimum|iterations|tolerance/);
  const facts = page.locator('#provenance details');
  await facts.locator('summary').click();
  await page.waitForSelector('#provenance details dd');
  assert.match(await facts.textContent(), /within 0\.1 standard errors of the minimum/);
});

test('the 95 % band of the fitted curve and the noise of the residuals are drawn', async (t) => {
  const [plain, page] = [await open(t, makeResult(), makeSeries()), await open(t, makeResult(), makeSeries({ band: true }))];
  assert.match(await page.locator('#verdict .legend').last().textContent(), /95 % confidence interval of the curve/);
  assert.match(await page.locator('#fit figcaption').textContent(), /Band of the residuals: ±σ, the noise of a sample\. Band: 95 %/);
  assert.doesNotMatch(await plain.locator('#verdict').textContent(), /95 %/);
  assert.ok((await ink(page, '#verdict .plot')) > 1.2 * (await ink(plain, '#verdict .plot')));
});

test('a pair of parameters has its confidence regions', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  assert.match(await page.locator('#correlation').textContent(), /viscous friction, dry friction−0\.995/);
  const plot = page.locator('#correlation .plot[aria-label]'); // it is named when it is drawn
  assert.match(await plot.getAttribute('aria-label'), /^68 % and 95 % regions of viscous friction and dry friction/);
  await page.locator('#correlation label', { hasText: 'moment of inertia, dry friction' }).click();
  assert.match(await plot.getAttribute('aria-label'), /regions of moment of inertia and dry friction/);
});

test('the page has all sections in order', async (t) => {
  const page = await open(t, makeResult(), makeSeries());
  const ids = await page.locator('main section').evaluateAll((parts) => parts.map((part) => part.id));
  assert.deepEqual(ids, [
    'verdict',
    'fit',
    'parameters',
    'validation',
    'envelope',
    'phase',
    'residuals',
    'correlation',
    'profiles',
    'comparison',
    'constancy',
    'closed-forms',
    'data',
    'warnings',
    'told-of-a-new-kind',
    'rig',
    'provenance',
  ]);
  assert.equal(await page.locator('nav a').count(), ids.length);
  for (const plot of [
    '#verdict .plot',
    '#fit .plot >> nth=0',
    '#fit .plot >> nth=1',
    '#validation .plot',
    '#envelope .plot',
    '#phase .plot',
    '#residuals .plot >> nth=0',
    '#residuals .plot >> nth=1',
    '#correlation .plot',
    '#profiles .plot',
    '#constancy .plot >> nth=0',
  ]) {
    assert.ok((await ink(page, plot)) > 3000, plot);
    assert.match(await page.locator(plot).getAttribute('aria-label'), /\w.*\.$/, plot);
  }
});

test('the page begins with the failure of a fit and has its other sections', async (t) => {
  const nothing = { fitted: null, residual: null, linear_closed_form: null, nonlinear_closed_form: null };
  const series = makeSeries({ models: [] }, { peaks: [], extrema: [], models: { coulomb: nothing } });
  const page = await open(t, makeFailed(), series);
  assert.match(
    await page.locator('main').innerText(),
    /^Result\s+✕\s+No result with coulomb \(failed\): the pendulum never moves\./,
  );
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|null/);
});

test('a result of an earlier version, without a summary, says so', async (t) => {
  const result = makeResult({ models: ['coulomb'] });
  delete result.fits[0].summary;
  const page = await open(t, result, makeSeries({ models: ['coulomb'] }));
  assert.match(await page.locator('.banner').textContent(), /no summary/);
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|\bnull\b/);
});

test('without samples the tables remain', async (t) => {
  const page = await open(t, makeResult(), null, { command: null });
  assert.match(await page.locator('#fit').textContent(), /samples are not part of this report/);
  assert.equal(await page.locator('[data-parameter=inertia] .value > span').textContent(), '0.07900 ± 0.00004');
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
  result.warnings.push(warning('odd', '<i>odd</i>'));
  const page = await open(t, result, makeSeries(), { command: { command: `fit_pendulum --data '${name}'` } });
  assert.equal(await page.locator('#provenance dd').first().textContent(), name);
  assert.equal(await page.locator('#report img, #report b').count(), 0);
});

test('an undersampled swing is drawn together with its slow apparent swing', async (t) => {
  const options = { models: ['viscous'], samples: 30, rate: 1 };
  const result = makeResult(options);
  result.warnings = [warning('aliased', 'less than twice a swing')];
  Object.assign(result.recordings[0].sampling, { frequency_hz: 0.7604, apparent_frequency_hz: null });
  const series = makeSeries(options, { peaks: [], extrema: [], motions: makeMotions(options) });
  const page = await open(t, result, series);
  // The motion of the fixture swings at 1 / 1.315 s = 0.7605 Hz: |0.7605 - 1| = 0.2395 Hz.
  const words = await page.locator('#validation').textContent();
  const apparent = Number(/\|f − fₛ\| = ([\d.]+) Hz/.exec(words)[1]);
  assert.ok(Math.abs(apparent - 0.2395) < 2e-4, words);
  for (const plot of ['#validation .plot', '#phase .plot']) assert.ok((await ink(page, plot)) > 3000, plot);
});

test('closed forms alone, without a fit', async (t) => {
  const result = makeResult({ models: ['viscous'] });
  result.fits = result.recordings[0].fits = [];
  const page = await open(t, result, makeSeries({ models: [] }, { profiles: null }));
  assert.match(await page.locator('.banner').textContent(), /Nothing was fitted/);
  assert.ok((await ink(page, '#envelope .plot')) > 3000);
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|\bnull\b/);
});
