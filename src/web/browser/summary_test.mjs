// SPDX-License-Identifier: Apache-2.0
// The page of the summary of a batch.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { kHostile, makeFailures, makeHostile, makeLarge, makeScattered, makeSummary, makeTiny } from './batches.mjs';
import { assertAccessible, assertRange, ink, kLooks, openSummary, shownRange, summaryTemplate } from './page.mjs';

const kTrend = '#trend .plot';
const ids = (page) => page.locator('main section').evaluateAll((parts) => parts.map((part) => part.id));
/** Selects another parameter. */
const choose = (page, name) => page.locator('.shown select').selectOption(name);
/** A text of the page as the program writes it. */
const printed = (text) =>
  text
    .replace(/ × 10(⁻?)([⁰¹²³⁴⁵⁶⁷⁸⁹]+)/g, (_all, minus, digits) => {
      const power = [...digits].map((digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(digit)).join('');
      return `e${minus === '' ? '+' : '-'}${power.padStart(2, '0')}`;
    })
    .replace(/−/g, '-')
    .replace(/²/g, '^2');
const heading = (page, id) => page.locator(`#${id}-title`).textContent();

test('the page contains the placeholder once', () => {
  assert.equal(summaryTemplate.split('@SUMMARY@').length, 2);
  assert.match(
    summaryTemplate,
    /Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"/,
  );
});

test('the page has all sections in order, with their plots', async (t) => {
  const page = await openSummary(t, makeSummary());
  assert.deepEqual(await ids(page), [
    'verdict',
    'failures',
    'moved',
    'runs',
    'models',
    'parameters',
    'distribution',
    'repeatability',
    'outliers',
    'trend',
    'provenance',
  ]);
  assert.equal(await page.locator('nav a').count(), 11);
  for (const plot of ['#distribution .plot', kTrend]) assert.ok((await ink(page, plot)) > 3000, plot);
  assert.equal((await page.locator('#repeatability .forest svg').count()) > 0, true);
  assert.equal(await page.title(), 'batch.sqlite – summary of runs');
});

test('values on the page equal the values in the JSON', async (t) => {
  const content = makeSummary();
  const { summary } = content;
  const page = await openSummary(t, content);
  const banner = await page.locator('.banner').textContent();
  assert.match(banner, /^.61 of 73 recordings fitted; 10 missing, 2 refused/);
  for (const { text } of [summary.grouping, summary.verdicts.find(({ model }) => model === 'coulomb')])
    assert.ok(banner.includes(text), `${text} in ${banner}`);
  const inertia = summary.parameters.find(({ model, name }) => model === 'coulomb' && name === 'inertia');
  const row = page.locator('#parameters tr', { hasText: 'inertia' }).first();
  const [name, runs, median, spread, error, scatter] = await row.locator('th, td').allTextContents();
  assert.equal(name, 'moment of inertia I_Oinertia'.replace('_', ''));
  assert.deepEqual(
    [runs, median.split('\u00a0')[0], spread, printed(error), scatter.slice(0, 4)],
    ['61', inertia.texts.median, inertia.texts.std_dev, inertia.texts.median_repeat_error, inertia.repeatability.texts.scatter_ratio],
  );
  assert.match(await page.locator('#models .bars').textContent(), /coulomb61 \(100 %\)/);
  assert.match(await page.locator('#failures').textContent(), /20 fits failed: there is no such file/);
  await choose(page, 'inertia');
  const outlier = await page.locator('#outliers tbody tr').allTextContents();
  assert.equal(outlier.length, 1);
  assert.ok(outlier[0].startsWith(`batch_odd.csvrig_a${inertia.outliers[0].text}`), outlier[0]);
  const { z_text: z } = inertia.outliers[0];
  const verdict = await page.locator('#verdict').textContent();
  // 0.0795 among repeats of 0.079: 0.63 % more.
  const found = new RegExp(`One recording disagrees with .*: batch_odd\\.csv \\(inertia 0\\.079[45]\\d*, the others 0\\.07[89]\\d*: 0\\.6\\d % more, z ${z}\\)`);
  assert.match(verdict, found);
  assert.ok(outlier[0].endsWith(z), outlier[0]);
  assert.ok((await page.locator('#provenance').textContent()).includes(summary.store.manifest_sha256));
  assert.match(await page.locator('#verdict .warnings').textContent(), /12 runs is neither a number nor a date/);
  const [first] = inertia.repeatability.rows;
  const group = await page.locator('#repeatability tbody tr', { hasText: 'rig_a' }).textContent();
  assert.equal(printed(group), Object.values({ id: 'rig_a', runs: first.runs, ...first.texts }).join(''));
  assert.ok(printed(await page.locator('#trend').textContent()).includes(inertia.trend.texts.slope));
});

test('another parameter and another model are shown, each by name', async (t) => {
  const page = await openSummary(t, makeSummary());
  await choose(page, 'inertia');
  assert.match(await heading(page, 'trend'), /moment of inertia/);
  await choose(page, 'coulomb');
  for (const id of ['distribution', 'repeatability', 'outliers', 'trend'])
    assert.match(await heading(page, id), /dry friction/);
  assert.match(await page.locator('#parameters .marked').textContent(), /dry friction/);
  assert.ok((await ink(page, kTrend)) > 3000);
  await choose(page, 'release_angle');
  assert.match(await page.locator('#repeatability').textContent(), /It depends on how each run begins/);
  await page.locator('.models label', { hasText: 'viscous' }).click();
  assert.match(await page.locator('.banner').textContent(), /61 of 73 recordings fitted/);
  assert.match(await heading(page, 'distribution'), /release angle/);
});

test('the page begins with the verdict that the error bars are too small', async (t) => {
  const page = await openSummary(t, makeScattered());
  assert.match(
    await page.locator('.banner.caution').textContent(),
    /more than their errors in 1 of 3 parameters: inertia scatters 2\.\d times/,
  );
  await choose(page, 'inertia');
  assert.match(await page.locator('#parameters .marked .no').textContent(), /more than the errors/);
  assert.match(await page.locator('#repeatability').textContent(), /The runs scatter by more than their errors predict\./);
});

test('the trend zooms by buttons, keys and the mouse', async (t) => {
  const page = await openSummary(t, makeSummary());
  const all = await shownRange(page, kTrend);
  const width = all[1] - all[0];
  await page.locator('#trend').getByRole('button', { name: 'Zoom in' }).click();
  assertRange(
    await shownRange(page, kTrend),
    [all[0] + width / 4, all[1] - width / 4],
  );
  await page.locator('#trend .linked').focus();
  await page.keyboard.press('0');
  assert.deepEqual(await shownRange(page, kTrend), all);
  await page.locator(kTrend).scrollIntoViewIfNeeded();
  const box = await page.locator(`${kTrend} >> .u-over`).boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 50);
  assert.match(await page.locator('#trend .readout').textContent(), /^batch_rig_[abc]_\d+\.csv \(rig_[abc]\): .*± .* at 2\d\.\d+$/);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.75 * box.width, box.y + 50, { steps: 5 });
  await page.mouse.up();
  const [from, to] = await shownRange(page, kTrend);
  assert.ok(
    Math.abs(from - (all[0] + 0.5 * width)) < 0.01 && Math.abs(to - (all[0] + 0.75 * width)) < 0.01,
    `${from} ${to}`,
  );
});

test('groups are hidden one by one, and drawn about their medians', async (t) => {
  const page = await openSummary(t, makeSummary());
  const told = () => page.locator(kTrend).getAttribute('aria-label');
  assert.match(await told(), /of 61 runs/);
  await page.locator('#trend').getByRole('button', { name: 'rig_b' }).click();
  assert.match(await told(), /of 41 runs/);
  await page.locator('#trend .choice label', { hasText: 'differences' }).click();
  assert.ok((await ink(page, kTrend)) > 3000);
});

test('every control is reached by the Tab key', async (t) => {
  const page = await openSummary(t, makeSummary());
  const reached = new Set();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press('Tab');
    reached.add(
      await page.evaluate(() => {
        const at = document.activeElement;
        return at?.getAttribute('aria-label') || at?.textContent?.trim() || at?.parentElement?.textContent || '';
      }),
    );
  }
  for (const name of [
    'Dark',
    'coulomb',
    'rig_a',
    'Zoom in',
    'Further',
    'Bars as a table',
    'Runs as a table',
    '10 of the runs',
  ])
    assert.ok(reached.has(name), `${name} of ${[...reached].join('; ')}`);
});

test('three runs', async (t) => {
  const page = await openSummary(t, makeTiny());
  assert.match(
    await page.locator('.banner').textContent(),
    /3 of 3 recordings fittedThe 3 recordings are taken for repeats of one pendulum/,
  );
  assert.match(await page.locator('#models').textContent(), /No run compared models/);
  assert.match(await page.locator('#failures').textContent(), /Every fit gave a result/);
  assert.match(await page.locator('#trend').textContent(), /per run/);
  assert.equal(await page.locator('.models').count(), 0);
});

test('failures only', async (t) => {
  const page = await openSummary(t, makeFailures());
  assert.deepEqual(await ids(page), ['verdict', 'failures', 'moved', 'runs', 'models', 'parameters', 'provenance']);
  assert.match(
    await page.locator('.banner.bad').textContent(),
    /0 of 40 recordings fitted; 38 missing, 2 refused: no fit converged.*Most often \(38 fits\): there is no such file/,
  );
  await page.locator('#failures summary').click();
  await page.waitForSelector('#failures details .id');
  assert.equal(await page.locator('#failures details .id').count(), 10);
});

test('times are those of the reader, with the date in ISO order', async (t) => {
  const content = makeTiny();
  Object.assign(content.summary.refit, { began: '2026-11-30T18:30:00Z', ended: '2026-11-30T19:05:59Z' });
  content.summary.runs[0].fitted = '2026-11-30T18:31:00Z';
  const page = await openSummary(t, content, { context: { timezoneId: 'Asia/Kolkata' } }); // UTC + 5 h 30 min
  assert.match(await page.locator('#verdict').textContent(), /began 2026-12-01 00:00, ended 2026-12-01 00:35/);
  assert.match(await page.locator('#runs tbody tr').first().textContent(), /2026-12-01 00:01/);
});

test('the page says what is new, what failed and what moved', async (t) => {
  const content = makeSummary();
  const { summary } = content;
  assert.match(summary.refit.text, /^All 73 recordings are new\.$/);
  summary.parameters.find(({ model, name }) => model === 'coulomb' && name === 'inertia').trend.is_moving = true;
  const page = await openSummary(t, content);
  assert.ok((await page.locator('#verdict').textContent()).includes(summary.refit.text));
  assert.match(await page.locator('#moved').textContent(), /moment of inertia: /);
  const rows = page.locator('#runs tbody tr');
  assert.equal(await rows.count(), 12);
  assert.match(await rows.first().textContent(), /^(missing|still)_\d.csv(missing|refused)/);
  await page.getByRole('button', { name: 'Show all 73 recordings' }).click();
  assert.equal(await rows.count(), 73);
  assert.match(await rows.nth(12).textContent(), /^batch_odd\.csvdisagrees with the othersinertia 0\.079[45]/);
  assert.equal(await rows.filter({ hasText: /^missing_/ }).first().locator('button').count(), 0);
});

test('one click copies the command that makes the report of a recording', async (t) => {
  const page = await openSummary(t, makeTiny(), { context: { permissions: ['clipboard-read', 'clipboard-write'] } });
  await page.getByRole('button', { name: 'Command for the report of tiny_run_002.csv' }).click();
  await page.getByText('Copied: paste it in a terminal.').waitFor();
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(copied, /^fit_pendulum tiny_run_002\.csv --rig '?[^ ]*recorded_rig\.json'? --model coulomb --report tiny_run_002\.html$/);
  assert.equal(await page.locator('.command:visible').textContent(), copied);
});

test('a verdict with doubts is not followed by the words that there are no warnings', async (t) => {
  const content = makeTiny();
  const good = await openSummary(t, content);
  assert.match(await good.locator('#verdict').textContent(), /No warnings\./);
  content.summary.verdicts[0].level = 'caution';
  const doubtful = await openSummary(t, content);
  assert.doesNotMatch(await doubtful.locator('#verdict').textContent(), /No warnings/);
});

test('all values of the parameters can be read on a phone', async (t) => {
  const page = await openSummary(t, makeSummary(), { context: { viewport: { width: 390, height: 844 } } });
  await page.getByRole('button', { name: /^Show \d+ derived quantities$/ }).click();
  const { summary } = makeSummary();
  const rows = page.locator('#parameters tbody tr');
  assert.equal(await rows.count(), summary.parameters.filter(({ model }) => model === 'coulomb').length);
  for (const row of await rows.all()) assert.equal(await row.isVisible(), true);
  const [hidden, outside] = await page.locator('#parameters .scroll').evaluate((box) => [
    box.scrollHeight - box.clientHeight,
    [...box.querySelectorAll('td')].filter((cell) => cell.getBoundingClientRect().right > window.innerWidth).length,
  ]);
  assert.deepEqual([hidden, outside], [0, 0]);
  await assertAccessible(page);
});

test('100 parameters of 2000 points are drawn, one after another', { timeout: 600_000 }, async (t) => {
  const page = await openSummary(t, makeLarge());
  assert.equal(await page.locator('#parameters tbody tr').count(), 100);
  const took = await page.evaluate(async () => {
    const start = performance.now();
    const list = document.querySelector('.shown select');
    list.value = 'term_99';
    list.dispatchEvent(new Event('change'));
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    return performance.now() - start;
  });
  t.diagnostic(`another parameter took ${took.toFixed(0)} ms`);
  assert.ok(took < 10_000, `${took} ms`); // a page that blocks would take tens of seconds
  assert.match(await heading(page, 'trend'), /term_99/);
  assert.match(
    await page.locator('#repeatability figcaption').first().textContent(),
    /24 groups of 40 that agree least/,
  );
  await page.locator('#repeatability summary').click();
  await page.waitForSelector('#repeatability details tbody tr');
  assert.equal(await page.locator('#repeatability details tbody tr').count(), 40);
  assert.ok((await ink(page, kTrend)) > 3000);
});

test('names are shown as text, whatever characters they have', async (t) => {
  const page = await openSummary(t, makeHostile(), { context: { viewport: { width: 390, height: 800 } } });
  const names = await page.locator('#outliers tbody th').allTextContents();
  assert.deepEqual(names, [kHostile[0], kHostile[1], 'two\\nlines\\tand a tab', kHostile[3], '\\u202etxt.exe']);
  assert.equal(await page.locator('main script, main img').count(), 0);
  assert.match(await page.locator('#failures').textContent(), /<script>alert\(1\)<\/script> x{300}/);
  await page.locator('#trend summary').click();
  await page.waitForSelector('#trend details tbody tr');
  await assertAccessible(page);
});

for (const [colorScheme, name, width] of kLooks) {
  test(`${colorScheme}, ${name}: accessible, and not wider than the window`, async (t) => {
    const options = { context: { colorScheme, viewport: { width, height: 800 } } };
    for (const make of [makeScattered, makeFailures, makeLarge]) {
      const page = await openSummary(t, make(), options);
      assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), colorScheme);
      await assertAccessible(page);
    }
  });
}

test('the printed page is light and without controls, and no plot is wider than the page', async (t) => {
  const page = await openSummary(t, makeSummary(), { context: { colorScheme: 'dark' } });
  await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
  await page.waitForFunction(() => document.documentElement.dataset.theme === 'light');
  assert.equal(await page.locator('.buttons').first().isVisible(), false);
  for (const part of await page.locator('main section').all()) assert.equal(await part.isVisible(), true);
  const widths = await page
    .locator('.plot canvas')
    .evaluateAll((all) => all.map((canvas) => canvas.getBoundingClientRect().width));
  assert.ok(Math.max(...widths) <= 680, String(widths)); // A4 less margins of 15 mm is 680 px wide
  assert.ok((await page.pdf({ preferCSSPageSize: true })).length > 20_000);
});
