// SPDX-License-Identifier: Apache-2.0
// The content of the page of a report.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { ink, open, template } from './page.mjs';
import { makeFailed, makeRecorded, makeReport } from './reports.mjs';

test('the page contains each placeholder once', () => {
  for (const token of ['@NAMES@', '@RESULT@', '@SECTIONS@', '@SERIES@', '@COMMAND@']) assert.equal(template.split(token).length, 2, token);
  assert.match(
    template,
    /Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"/,
  );
});

test('the first section has the words of the summary in the JSON', async (t) => {
  const content = makeReport();
  const page = await open(t, content);
  const { summary } = content.result.fits[1];
  assert.equal(await page.locator('.banner .title').textContent(), summary.verdict);
  const { value, error } = summary.parameters[0];
  assert.equal(await page.locator('[data-parameter=inertia] .value').textContent(), `${value} ± ${error} kg\u00a0m²`);
  const [period] = summary.derived;
  const derived = await page.locator('.derived').textContent();
  assert.ok(derived.includes(`period of small swings ${period.value} ± ${period.error} s`), derived);
  const equation = summary.equation.replace(/th''/, 'θ″').replace(/th'/g, 'θ′').replace(/\bth\b/, 'θ');
  assert.equal(await page.locator('#verdict .equation').textContent(), equation);
  const textbook = summary.textbook.replace(/I_O/g, 'IO');
  assert.ok((await page.locator('.answer-more').textContent()).includes(textbook), textbook);
  assert.match(await page.locator('.banner .recommendation').textContent(), /^Recommended law: coulomb\. \w/);
});

test('the error budget of a parameter is a bar with words', async (t) => {
  const content = makeRecorded();
  const page = await open(t, content);
  const bar = (name) => page.locator(`[data-parameter=${name}] .budget`);
  const { error_budget: budget } = content.result.fits[0].parameters.inertia;
  const total = Object.values(budget).reduce((sum, error) => sum + error ** 2, 0);
  const share = ((100 * budget.rig ** 2) / total).toFixed(0);
  assert.match(await bar('inertia').getAttribute('aria-label'), new RegExp(`^Variance: ${share} % rig`));
  assert.equal(await bar('zero_angle').count(), 0);
  assert.match(await page.locator('[data-parameter=zero_angle]').textContent(), /fixed/);
  assert.deepEqual((await page.locator('.budget-legend li').allTextContents()).slice(0, 2), ['noise', 'rig']);
});

// sections_test.mjs compares all numbers and words.
test('the sections of the program are shown with the typography of the page', async (t) => {
  const page = await open(t, makeReport());
  const rows = page.locator('#parameters table').first().locator('tbody tr');
  const cells = async (row) => (await row.locator('th, td').allTextContents()).join('|');
  assert.match(await cells(rows.nth(0)), /^moment of inertia inertia\|[\d.]+ ± [\d.]+\|.*kg m²/);
  const angle = page.locator('#parameters table').first().locator('tr', { hasText: 'release angle' });
  assert.match(await cells(angle), /^release angle release_angle\|0\.45\d+ ± 0\.000\d+25\.\d+ ± 0\.0\d+\|rad°/);
  assert.equal(await page.locator('#parameters thead').first().textContent().then((text) => text.slice(0, 21)), 'NameValue ± std error');
  assert.match(await page.locator('#parameters').textContent(), /θ″ \+ [\d.]+ θ′/);
  assert.equal(await page.locator('#correlation .quiet').first().textContent(), 'those below 0.1 in size are not listed');
  assert.equal(await page.locator('#comparison .marked th').first().textContent(), 'coulomb');
  assert.deepEqual([...new Set(await page.locator('#closed-forms .no').allTextContents())], ['NO']);
});

test('the files, the command and the name of the page', async (t) => {
  const content = makeReport();
  const page = await open(t, content);
  assert.ok((await page.locator('#provenance').textContent()).includes(content.result.recordings[0].sha256));
  assert.match(await page.locator('#provenance pre').textContent(), /^\S*fit_pendulum .*--model viscous,coulomb,drag/);
  assert.equal(await page.title(), 'coulomb.csv – pendulum report');
});

test('without sections the page has the charts, the first screen and one sentence', async (t) => {
  const page = await open(t, { ...makeReport(), sections: null });
  assert.match(await page.locator('#parameters').textContent(), /tables are not part of this report/);
  assert.equal(await page.locator('#comparison, #closed-forms, #data').count(), 0);
  for (const plot of ['#fit .plot', '#residuals .plot', '#correlation .plot', '#constancy .plot']) assert.ok(await page.locator(plot).count(), plot);
});

test('warnings are with the law that they concern', async (t) => {
  const page = await open(t, makeReport());
  assert.equal(await page.locator('#verdict .warnings li').count(), 0);
  assert.doesNotMatch(await page.locator('.banner').textContent(), /warning/);
  await page.locator('.models label', { hasText: 'drag' }).click();
  assert.match(await page.locator('#verdict .warnings').first().textContent(), /Viscous is at its bound 0\./);
  assert.match(await page.locator('.recommendation').first().textContent(), /not the recommended law\. Recommended: coulomb/);
  await page.locator('#verdict summary', { hasText: 'Explanations' }).click();
  await page.waitForSelector('#verdict details .warnings');
  assert.doesNotMatch(await page.locator('#verdict').textContent(), /presliding/); // of the law viscous
});

test('nothing on the first screen is about the solver', async (t) => {
  const page = await open(t, makeReport());
  assert.doesNotMatch(await page.locator('#verdict').innerText(), /[Cc]onverged|minimum|iterations|tolerance/);
  const facts = page.locator('#provenance details');
  await facts.locator('summary').click();
  await page.waitForSelector('#provenance details dd');
  assert.match(await facts.textContent(), /of the minimum|converged/);
});

test('the 95 % band of the fitted curve and the noise of the residuals are drawn', async (t) => {
  const content = makeReport();
  const plain = await open(t, content);
  const { coulomb } = content.series[0].models;
  coulomb.fitted_std_error = coulomb.fitted.map(() => 0.04); // rad; the tool leaves out bands that no plot could show
  const page = await open(t, content);
  assert.match(await page.locator('#verdict .legend').last().textContent(), /95 % confidence interval of the curve/);
  assert.match(await page.locator('#fit figcaption').textContent(), /Band of the residuals: ±σ, the noise of a sample\. Band: 95 %/);
  assert.doesNotMatch(await plain.locator('#verdict').textContent(), /95 %/);
  assert.ok((await ink(page, '#verdict .plot')) > 1.2 * (await ink(plain, '#verdict .plot')));
});

test('a pair of parameters has its confidence regions', async (t) => {
  const page = await open(t, makeReport());
  assert.match(await page.locator('#correlation').textContent(), /viscous friction, dry friction.*−0\.9\d/);
  const plot = page.locator('#correlation .plot[aria-label]'); // it is named when it is drawn
  assert.match(await plot.getAttribute('aria-label'), /^68 % and 95 % regions of viscous friction and dry friction/);
  await page.locator('#correlation select').selectOption({ label: 'moment of inertia, dry friction' });
  assert.match(await plot.getAttribute('aria-label'), /regions of moment of inertia and dry friction/);
});

test('the page has all sections in order', async (t) => {
  const page = await open(t, makeReport());
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
    '#profiles .plot >> nth=0',
    '#constancy .plot >> nth=0',
  ]) {
    assert.ok((await ink(page, plot)) > 3000, plot);
    assert.match(await page.locator(plot).getAttribute('aria-label'), /\w.*\.$/, plot);
  }
});

test('the page begins with the failure of a fit and has its other sections', async (t) => {
  const content = makeFailed();
  const page = await open(t, content);
  const words = await page.locator('main').innerText();
  assert.match(words, /^Result\s+✕\s+No result with coulomb/);
  assert.ok(words.includes(content.result.fits[0].summary.verdict));
  assert.doesNotMatch(words, /NaN|undefined|\bnull\b/);
});

test('a result of an earlier version, without a summary, says so', async (t) => {
  const content = makeReport();
  for (const fit of content.result.fits) delete fit.summary;
  const page = await open(t, content);
  assert.match(await page.locator('.banner').textContent(), /no summary/);
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|\bnull\b/);
});

test('a section of a new kind is shown', async (t) => {
  const content = makeReport();
  const words = { kind: 'words', text: 'still shown.', emphasis: 'none' };
  content.sections.push({ id: 'of-a-new-kind', title: 'Of a new kind', law: null, recording: null, remark: null, blocks: [words] });
  const page = await open(t, content);
  assert.match(await page.locator('#told-of-a-new-kind').textContent(), /Of a new kind.*Still shown\./);
});

test('without samples the tables remain', async (t) => {
  const page = await open(t, { ...makeReport(), series: null, command: null });
  assert.match(await page.locator('#fit').textContent(), /samples are not part of this report/);
  assert.match(await page.locator('[data-parameter=inertia] .value > span').textContent(), /± 0\.0/);
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|null/);
});

test('no number of a full report is NaN', async (t) => {
  const page = await open(t, makeReport());
  for (const summary of await page.locator('summary').all()) await summary.click();
  await page.waitForFunction(() => [...document.querySelectorAll('details[open]')].every((part) => part.children.length > 1));
  assert.doesNotMatch(await page.locator('main').innerText(), /NaN|undefined|\bnull\b|Infinity/);
});

test('a name that looks like HTML is shown as text', async (t) => {
  const name = 'a/<img src=x onerror=alert(1)></script><b>.csv';
  const content = makeReport();
  const { warnings, recordings } = content.result;
  recordings[0].path = name;
  warnings.push({ ...warnings[0], message: '<i>odd</i>', text: '<i>odd</i>' });
  content.command.command = `fit_pendulum --data '${name}'`;
  const page = await open(t, content);
  assert.equal(await page.locator('#provenance dd').first().textContent(), name);
  assert.equal(await page.locator('#report img, #report b').count(), 0);
});
