// SPDX-License-Identifier: Apache-2.0
// The page as fit_pendulum writes it; FIT_PENDULUM is the path of the tool.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

import { openFile, shownRange } from './page.mjs';

const tool = process.env.FIT_PENDULUM ?? fileURLToPath(new URL('../../../../build/release/bin/fit_pendulum', import.meta.url));
const datasets = fileURLToPath(new URL('../../../../datasets/', import.meta.url));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-tool-'));
after(() => fs.rmSync(folder, { recursive: true }));

/** Fits and gives the page's address and the result it was made from. */
function fit(name, ...flags) {
  const html = path.join(folder, `${name}.html`);
  const json = path.join(folder, `${name}.json`);
  execFileSync(tool, [...flags, '--report', html, '--json', json], { stdio: 'ignore' });
  return { url: pathToFileURL(html).href, result: JSON.parse(fs.readFileSync(json, 'utf8')) };
}

/** What "0.0790 ± 0.0003" says, as [value, error]. */
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
  assert.match(await page.locator('.recommendation').textContent(), /coulomb/);
  const { parameters } = result.fits[1];
  for (const name of ['inertia', 'viscous', 'coulomb', 'release_time']) {
    const shown =
      name === 'release_time' // a circumstance, not a figure of the pendulum: in the table only
        ? page.locator('#verdict tr', { hasText: name }).locator('td').first()
        : page.locator(`[data-parameter=${name}] .value`).first();
    const [value, error] = numbersOf((await shown.textContent()).replace(/\ss$/, ''));
    const { estimate, std_error: expected } = parameters[name];
    assert.ok(Math.abs(value - estimate) <= 0.05 * expected, `${name}: ${value} is not ${estimate}`); // 2 digits of the error
    assert.ok(Math.abs(error - expected) <= 0.05 * expected, `${name}: ± ${error} is not ${expected}`);
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

test('a Stribeck fit has its equation and profiles', async (t) => {
  const { url, result } = fit(
    'stribeck',
    ...['--data', path.join(datasets, 'to_rest.csv'), '--model', 'stribeck,asymmetric', '--interval', 'covariance'],
  );
  const page = await openFile(t, url);
  assert.equal(result.fits.length, 2);
  assert.match(await page.locator('#verdict').textContent(), /asymmetric|stribeck/);
});
