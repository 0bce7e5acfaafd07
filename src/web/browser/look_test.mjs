// SPDX-License-Identifier: Apache-2.0
// Themes, widths, printing and accessibility of the page of a report.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { assertAccessible, ink, kLooks, kPlot, open } from './page.mjs';
import { makeReport, withLongPaths } from './reports.mjs';

for (const [colorScheme, name, width] of kLooks) {
  test(`${colorScheme}, ${name}: accessible, and the page is not wider than the window`, async (t) => {
    const page = await open(t, withLongPaths(makeReport()), {
      context: { colorScheme, viewport: { width, height: 800 } },
    });
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), colorScheme);
    await assertAccessible(page);
  });
}

test('the theme changes by its button, with the plots', async (t) => {
  const page = await open(t, makeReport(), { context: { colorScheme: 'light' } });
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await background();
  await page.getByRole('button', { name: 'Dark' }).click();
  assert.notEqual(await background(), light);
  assert.ok((await ink(page, kPlot)) > 3000);
  await page.reload(); // the page is a file
  assert.notEqual(await background(), light);
  await page.getByRole('button', { name: 'Light' }).click();
  assert.equal(await background(), light);
});

test('the printed page is light and without controls, and no plot is wider than the page', async (t) => {
  const page = await open(t, makeReport(), { context: { colorScheme: 'dark' } });
  await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
  await page.waitForFunction(() => document.documentElement.dataset.theme === 'light');
  assert.equal(await page.locator('.buttons').first().isVisible(), false);
  const widths = await page
    .locator('.plot canvas')
    .evaluateAll((all) => all.map((canvas) => canvas.getBoundingClientRect().width));
  assert.ok(Math.max(...widths) <= 680, String(widths)); // A4 less margins of 15 mm is 680 px wide
  const pdf = await page.pdf({ preferCSSPageSize: true });
  assert.ok(pdf.length > 20_000);
});
