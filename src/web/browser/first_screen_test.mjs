// SPDX-License-Identifier: Apache-2.0
// The first screen, the paper and the saved plots of reports that fit_pendulum writes. The variable FIT_PENDULUM is the
// path of the tool.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { test } from 'node:test';

import { assertAccessible, ink, openFile } from './page.mjs';
import { dataset, fit } from './tool.mjs';

const kScreens = [
  [1280, 800],
  [390, 844],
];

const kReports = {
  comparison: [dataset('recorded.csv'), '--models', 'all'],
  'one law': [dataset('coulomb.csv'), '--rig', dataset('textbook_rig.json'), '--model', 'coulomb'],
  joint: ['--data', ['runs_1.csv', 'runs_2.csv', 'runs_3.csv'].map(dataset).join(','), '--model', 'viscous,coulomb', '--interval', 'covariance'],
};

/** Results by the name of the report. Each is fitted once. */
const made = {};
const report = (name) => (made[name] ??= fit(name.replace(' ', '_'), ...kReports[name]));

/** The fit that the page shows first. */
const shownFit = ({ fits, comparison }) => fits.find((one) => one.model === comparison?.recommended) ?? fits[0];

/** Lower ends of the elements, px from the top of the window. */
const bottoms = (page, selector) =>
  page.locator(selector).evaluateAll((all) => all.map((element) => element.getBoundingClientRect().bottom));

/** "(−1.2 ± 0.3) × 10⁻⁶" for "(-1.2 ± 0.3)e-06". */
function typeset(text) {
  const raised = (power) => [...String(Number(power))].map((c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]).join('');
  return text.replace(/([\d)])e([-+]\d+)/, (_all, end, power) => `${end} × 10${raised(power)}`).replace(/^(\(?)-/, '$1−');
}

for (const name of Object.keys(kReports)) {
  for (const [width, height] of kScreens) {
    for (const colorScheme of ['light', 'dark']) {
      test(`${name}: verdict, parameters with total errors and swing are on the first screen of ${width} x ${height}, ${colorScheme}`, async (t) => {
        const { url, result } = report(name);
        const page = await openFile(t, url, { context: { colorScheme, viewport: { width, height } } });
        const { summary } = shownFit(result);
        assert.ok(summary.parameters.length >= 2);
        assert.equal(await page.evaluate(() => window.scrollY), 0);
        const first = ['.banner .title', '#verdict .plot canvas', '.answer-table'];
        for (const selector of first) {
          await page.waitForSelector(selector); // the swing is drawn after the first section stands
          const ends = await bottoms(page, selector);
          assert.equal(ends.length, 1, selector);
          assert.ok(ends[0] > 0 && ends[0] <= height, `${selector} ends at ${ends[0]} px`);
        }
        for (const { name: parameter, value, error, source } of summary.parameters) {
          const row = page.locator(`[data-parameter=${parameter}]`);
          assert.equal(await row.locator('.value > span').textContent(), typeset(error ? `${value} ± ${error}` : value));
          assert.ok((await row.textContent()).includes(source), `${parameter}: ${source}`);
          for (const part of ['.value', '.budget']) {
            const selector = `[data-parameter=${parameter}] ${part}`;
            for (const end of await bottoms(page, selector)) assert.ok(end <= height, `${selector} ends at ${end} px`);
          }
          const bars = await row.locator('.budget').count();
          assert.equal(bars, error ? 1 : 0, `error budget of ${parameter}`);
        }
        const words = await page.locator('.banner').textContent();
        for (const sentence of [summary.agreement, summary.verdict]) assert.ok(words.includes(sentence), sentence);
        assert.doesNotMatch(await page.locator('#verdict').innerText(), /[Cc]onverged|of the minimum/);
        assert.ok((await ink(page, '#verdict .plot')) > 3000);
        await assertAccessible(page);
      });
    }
  }
}

test('nothing is cut on a phone', async (t) => {
  const page = await openFile(t, report('comparison').url, { context: { viewport: { width: 390, height: 844 } } });
  const cut = await page.locator('main :is(table, p, li, dd, .banner, .plot, .legend)').evaluateAll((all) =>
    all
      .filter((element) => element.offsetParent !== null && element.closest('details, pre') === null)
      .filter((element) => element.scrollWidth > element.clientWidth + 1 || element.getBoundingClientRect().right > window.innerWidth)
      .filter((element) => getComputedStyle(element).display !== 'inline')
      .map((element) => `${element.closest('section')?.id}: ${element.tagName} ${element.className} ${element.textContent.slice(0, 60)}`),
  );
  assert.deepEqual(cut, []);
});

test('numbers have a mantissa of one digit before the point', async (t) => {
  const page = await openFile(t, report('comparison').url);
  for (const model of ['viscous', 'drag', 'stribeck', 'asymmetric', 'coulomb']) {
    await page.locator('.models label', { hasText: model }).click();
    const words = await page.locator('main').innerText();
    assert.doesNotMatch(words, /(^|[^\d.(–])(0\.0+|\d{2,}(\.\d+)?) × 10/m, model);
    assert.doesNotMatch(words, /\((0\.0+|\d{2,}(\.\d+)?) (±|to) [^()]*\) × 10|10⁻¹[0-9]\sms/, model);
  }
});

const [swing, residuals] = ['#fit .plot >> nth=0', '#fit .plot >> nth=1'];
const kPaper = { width: 680, height: 1031 }; // px: A4 without its margins, 180 mm x 273 mm

/** Number of pages of a PDF. */
const pagesOf = (pdf) => pdf.toString('latin1').match(/\/Type\s*\/Page\b(?!s)/g).length;

for (const name of ['one law', 'comparison']) {
  test(`${name}: the printed report has at most three pages, the first with answer and swing`, async (t) => {
    const page = await openFile(t, report(name).url);
    await page.setViewportSize(kPaper);
    await page.emulateMedia({ media: 'print' });
    const { y, height } = await page.locator(name === 'one law' ? residuals : swing).boundingBox();
    assert.ok(y + height <= kPaper.height, `the swing ends at ${y + height} px`);
    const pdf = await page.pdf({ preferCSSPageSize: true });
    const pages = pagesOf(pdf);
    assert.ok(pages >= 1 && pages <= 3, `${pages} pages`);
    const wanted = ['#verdict .banner', '.answer-table', swing, residuals, '#validation .plot', '#envelope .plot', '#provenance'];
    for (const selector of [...wanted, ...(name === 'comparison' ? ['#comparison'] : [])])
      assert.ok(await page.locator(selector).isVisible(), selector);
    for (const selector of ['.save', '#phase', '#parameters', '.models'])
      for (const element of await page.locator(selector).all()) assert.equal(await element.isVisible(), false, selector);
  });
}

/** Presses a button that saves a plot. Returns name and content of the file. */
async function saved(page, plot, kind) {
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: `Save the plot ${plot} as ${kind}`, exact: true }).press('Enter'),
  ]);
  return { name: file.suggestedFilename(), content: fs.readFileSync(await file.path()) };
}

test('plots are saved as PNG and SVG', async (t) => {
  const page = await openFile(t, report('comparison').url);
  const png = await saved(page, 'swing', 'PNG');
  assert.equal(png.name, 'recorded_swing.png');
  assert.equal(png.content.subarray(1, 4).toString(), 'PNG');
  assert.equal(png.content.readUInt32BE(16), 1280); // the width in the header chunk
  const plots = await page.locator('.chart').count();
  assert.equal(await page.locator('.save button').count(), 2 * plots);
  for (const [plot, pattern] of [
    ['swing', />recorded.csv: swing<.*>measured<.*>coulomb<.*time \[s\].*angle \[°\].*<path d="M[^"]*L[^"]*" fill="none" stroke="#0072b2".*a1 1 0 1 0/],
    ['residuals', /residual \[°\].*<rect [^>]*fill="#e6eef5"/],
    ['autocorrelation', /lag \[samples\]/],
    ['phase portrait', /rate \[°\/s\]/],
  ]) {
    const { name, content } = await saved(page, plot, 'SVG');
    assert.equal(name, `recorded_${plot.replace(' ', '_')}.svg`);
    const text = content.toString();
    assert.match(text, pattern, plot);
    assert.doesNotMatch(text, /NaN|undefined|Infinity/, plot);
    const problem = await page.evaluate(
      (drawing) => new DOMParser().parseFromString(drawing, 'image/svg+xml').querySelector('parsererror')?.textContent,
      text,
    );
    assert.equal(problem, undefined, plot);
  }
});

test('a picture saved from a dark page is on white and says what its curves are', async (t) => {
  const page = await openFile(t, report('comparison').url, { context: { colorScheme: 'dark' } });
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  assert.equal(await theme(), 'dark');
  for (const plot of ['fit', 'residuals', 'amplitudes', 'phase portrait']) {
    const text = (await saved(page, plot, 'SVG')).content.toString();
    assert.match(text, /<rect width="640" height="\d+" fill="#ffffff"/, plot);
    assert.match(text, new RegExp(`>recorded.csv: ${plot}<`), plot);
    assert.doesNotMatch(text, /#15181c|<text [^>]*fill="#e9ecef"/, plot);
  }
  assert.match((await saved(page, 'amplitudes', 'SVG')).content.toString(), />turning points<.*>fitted coulomb</);
  assert.equal(await theme(), 'dark');
});

test('a plot of several recordings is saved with the names of its rows', async (t) => {
  const page = await openFile(t, report('joint').url);
  const { content } = await saved(page, 'inertia by recording', 'SVG');
  for (const row of ['recording 1', 'recording 3', 'joint fit']) assert.match(content.toString(), new RegExp(`>${row}<`));
  assert.doesNotMatch(content.toString(), /var\(/);
  const png = await saved(page, 'inertia by recording', 'PNG');
  assert.equal(png.content.subarray(1, 4).toString(), 'PNG');
  assert.ok(png.content.readUInt32BE(16) > 400);
});
