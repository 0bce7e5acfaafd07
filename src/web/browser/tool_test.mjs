// SPDX-License-Identifier: Apache-2.0
// The page that fit_pendulum writes. The variable FIT_PENDULUM is the path of the tool.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';

import { ink, openFile, shownRange } from './page.mjs';
import { datasets, fit, folder } from './tool.mjs';

/** [value, error] from "0.0790 ± 0.0003". */
function numbersOf(text) {
  const scaled = /^\((\S+) ± (\S+)\)×10(\S+)$/.exec(text.replace(/−/g, '-'));
  if (scaled) throw new Error(`a power of ten in ${text}`);
  return text.replace(/−/g, '-').split(' ± ').map(Number);
}

test('a comparison shows the numbers of its JSON', async (t) => {
  const { url, result } = fit(
    'compared',
    ...['--data', path.join(datasets, 'coulomb.csv'), '--rig', path.join(datasets, 'textbook_rig.json')],
    ...['--model', 'viscous,coulomb,drag'],
  );
  const page = await openFile(t, url);
  assert.equal(result.comparison.recommended, 'coulomb');
  assert.match(await page.locator('.recommendation').first().textContent(), /coulomb/);
  const parameters = { ...result.fits[1].parameters, ...result.recordings[0].fits[1].parameters };
  for (const name of ['inertia', 'viscous', 'coulomb', 'release_time']) {
    const [value, error] = numbersOf(await page.locator(`[data-parameter=${name}] .value > span`).textContent());
    const { estimate, total_std_error: expected } = parameters[name];
    assert.ok(Math.abs(value - estimate) <= 0.15 * expected, `${name}: ${value} is not ${estimate}`); // rounded by its error
    assert.ok(Math.abs(error - expected) <= 0.15 * expected, `${name}: ± ${error} is not ${expected}`);
  }
  const rows = await page.locator('#comparison tbody tr').allTextContents();
  for (const model of ['viscous', 'coulomb', 'drag']) assert.ok(rows.some((row) => row.includes(model)), model);
  const [from, to] = await shownRange(page);
  assert.ok(Math.abs(from) < 0.01 && Math.abs(to - 19.99) < 0.01, `${from} to ${to}`);
  assert.match(await page.locator('#provenance pre').textContent(), /--model viscous,coulomb,drag/);
  assert.match(await page.locator('#constancy').textContent(), /constants of the recording/);
});

test('closed forms alone are shown', async (t) => {
  const { url } = fit('closed', '--data', path.join(datasets, 'coulomb.csv'), '--closed_form_only');
  const page = await openFile(t, url);
  assert.ok((await page.locator('main section').count()) > 2);
});

/** Every `stride`-th row of a recording, as a file of its own. */
function thinned(name, stride) {
  const rows = fs.readFileSync(path.join(datasets, name), 'utf8').trimEnd().split('\n');
  const first = rows.findIndex((row) => /^[-+.\d]/.test(row));
  const file = path.join(folder, `every_${stride}_of_${name}`);
  fs.writeFileSync(file, [...rows.slice(0, first), ...rows.slice(first).filter((_row, i) => i % stride === 0), ''].join('\n'));
  return file;
}

test('a recording that is sampled too slowly has the fitted motion between its samples', async (t) => {
  const data = ['--data', thinned('coulomb.csv', 100), '--rig', path.join(datasets, 'textbook_rig.json')];
  const { url } = fit('slow', ...data, '--model', 'viscous');
  const page = await openFile(t, url);
  // 100 Hz / 100 = 1 Hz; the rig swings at 0.76 Hz (README), so the samples seem to swing at 0.24 Hz.
  const words = await page.locator('#validation').textContent();
  assert.match(words, /swings at f = 0\.7[56]\d* Hz and was sampled at fₛ = 1 Hz/);
  assert.match(words, /= 0\.24\d* Hz/);
  for (const plot of ['#fit .plot', '#validation .plot', '#phase .plot']) {
    assert.ok((await ink(page, plot)) > 3000, plot);
  }
});

test('a Stribeck fit has its equation and profiles', async (t) => {
  const { url, result } = fit(
    'stribeck',
    ...['--data', path.join(datasets, 'to_rest.csv'), '--model', 'stribeck,asymmetric', '--interval', 'covariance'],
  );
  const page = await openFile(t, url);
  assert.equal(result.fits.length, 2);
  assert.match(await page.locator('#verdict').textContent(), /asymmetric|stribeck/);
});

/** Compares all numbers on the page of a joint fit with its JSON. */
async function assertJoint(t, ...files) {
  const data = files.map((name) => path.join(datasets, name)).join(',');
  const { url, result } = fit(`joint_${files.length}`, '--data', data, '--model', 'viscous,coulomb', '--interval', 'covariance');
  const page = await openFile(t, url);
  assert.equal(await page.locator('h1').textContent(), `${files.length} recordings, fitted together`);
  const recommended = result.comparison.recommended;
  const [least] = result.fits
    .filter((one) => one.status === 'converged')
    .sort((one, other) => one.statistics.rms_residual_rad - other.statistics.rms_residual_rad);
  const shown = result.fits.find((one) => one.model === recommended) ?? least;
  assert.equal(await page.locator('[data-forest]').count(), shown.shared.length);
  // Values are rounded to the last digit of their error. A unit of that digit is at most 1 / 3.55 of the error.
  for (const name of shown.shared) {
    const { recordings: runs } = shown.homogeneity.parameters[name];
    const told = [...runs, shown.parameters[name]].filter((one) => one.std_error !== null && one.estimate > 1e-4);
    for (const one of told) {
      const row = page.locator(`[data-forest=${name}] tbody tr`).nth(runs.includes(one) ? runs.indexOf(one) : runs.length);
      const [value, error] = numbersOf(await row.locator('td').first().textContent());
      assert.ok(Math.abs(value - one.estimate) <= 0.15 * one.std_error, `${name}: ${value} is not ${one.estimate}`);
      assert.ok(Math.abs(error - one.std_error) <= 0.15 * one.std_error, `${name}: ± ${error} is not ${one.std_error}`);
    }
  }
  const agreement = await page.locator('#agreement > div > p').first().textContent();
  assert.match(agreement, shown.homogeneity.agrees ? /^Verdict: the recordings agree/ : /disagree|do not agree/);
  assert.equal(await page.locator('#recordings table').first().locator('tbody tr').count(), files.length);
  const provenance = await page.locator('#provenance').textContent();
  for (const { sha256 } of result.recordings) assert.ok(provenance.includes(sha256), sha256);
  const label = await page.locator('#overlay .plot').first().getAttribute('aria-label');
  assert.match(label, /^Recordings 1(, \d)* and \d, measured and fitted/);
  return { page, homogeneity: shown.homogeneity };
}

test('recordings of one rig agree, and the page has the numbers of the JSON', async (t) => {
  const { page, homogeneity } = await assertJoint(t, 'runs_1.csv', 'runs_2.csv', 'runs_3.csv');
  assert.equal(homogeneity.agrees, true);
  assert.equal(await page.locator('#agreement .no, #recordings .no').count(), 0);
});

test('a recording of another rig among them is marked', async (t) => {
  const { page, homogeneity } = await assertJoint(t, 'runs_1.csv', 'runs_2.csv', 'runs_3.csv', 'runs_4.csv');
  assert.deepEqual(homogeneity.outliers, [4]);
  assert.match(await page.locator('.banner:not(.good)').textContent(), /[Rr]ecording 4 (\(.*runs_4\.csv\) )?disagrees with the others/);
  assert.match(await page.locator('#recordings tbody tr').nth(3).textContent(), /^4disagrees/);
});
