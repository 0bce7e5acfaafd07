// SPDX-License-Identifier: Apache-2.0
// Opens the built pages as files in headless Chromium. The variable CHROMIUM names another browser.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';
import { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';

import { chromium } from 'playwright-core';

const built = (name) => fs.readFileSync(new URL(`../dist/${name}`, import.meta.url), 'utf8');
export const template = built('report.html');
export const summaryTemplate = built('summary.html');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-page-'));

const kPatience = 180_000; // ms: a busy machine may need a minute for an empty page

let browser;
before(async () => {
  const root = process.getuid?.() === 0;
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell',
    timeout: kPatience,
    args: root ? ['--no-sandbox'] : [],
  });
});
after(async () => {
  await browser?.close();
  fs.rmSync(folder, { recursive: true });
});

/** JSON as text for a script element. */
const embedded = (value) => JSON.stringify(value).replace(/</g, '\\u003c');

let written = 0;

/** Writes a page with its tokens replaced by JSON, as the C++ program does. */
function write(page, parts) {
  const fill = (text, [id, value]) => text.replace(`@${id.toUpperCase()}@`, () => embedded(value));
  const html = Object.entries(parts).reduce(fill, page);
  const file = path.join(folder, `page_${++written}.html`);
  fs.writeFileSync(file, html);
  return pathToFileURL(file).href;
}

/** Opens a report with this content, by the ids of its elements. */
export const open = (t, content, options = {}) => openFile(t, write(template, content), options);

/** Opens the summary of a batch with this content. */
export const openSummary = (t, content, options = {}) => openFile(t, write(summaryTemplate, content), options);

/**
 * An empty page. Its test fails on errors in the console and on requests that `mayAsk` does not allow. `expected`: errors
 * that are part of the test.
 */
export async function watchedPage(t, { context: wanted = {}, mayAsk, expected = () => false }) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...wanted });
  context.setDefaultTimeout(kPatience);
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('request', (request) => mayAsk(request.url()) || complaints.push(`request of ${request.url()}`));
  page.on('dialog', (dialog) => complaints.push(`dialog ${dialog.message()}`));
  t.after(async () => {
    await context.close();
    assert.deepEqual(
      complaints.filter((complaint) => !expected(complaint)),
      [],
    );
  });
  return page;
}

/** Opens a file. Its test fails on errors in the console and on any request to the network. */
export async function openFile(t, url, options = {}) {
  const mayAsk = (asked) => asked === url || asked.startsWith('data:');
  const page = await watchedPage(t, { context: options.context, mayAsk });
  await page.goto(url);
  await page.waitForSelector('main section');
  return page;
}

/** [theme, device, width in px]. Contrast depends on the theme, layout on the width, so two combinations are enough. */
export const kLooks = [
  ['light', 'desktop', 1280],
  ['dark', 'phone', 360],
];

const axeSource = fs.readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** The page is not wider than the window, and axe finds no problem. */
export async function assertAccessible(page) {
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
  await page.evaluate(axeSource);
  const { violations } = await page.evaluate(() =>
    window.axe.run({ resultTypes: ['violations'], runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'best-practice'] }),
  );
  const found = violations.map(
    (violation) =>
      `${violation.id}: ${violation.nodes
        .map((node) => `${node.target} ${node.failureSummary}`)
        .slice(0, 3)
        .join(' | ')}`,
  );
  assert.deepEqual(found, []);
}

export const kPlot = '#fit .plot >> nth=0';

/** Visible range [from, to] of a plot, from its description; s for the main plot. */
export async function shownRange(page, plot = kPlot) {
  const label = await page.locator(plot).getAttribute('aria-label');
  return /from (\S+) to (\S+?)( s|\.$)/.exec(label.replace(/−/g, '-')).slice(1, 3).map(Number);
}

export function assertRange(actual, expected) {
  actual.forEach((end, i) => assert.ok(Math.abs(end - expected[i]) < 0.006, `${actual} instead of ${expected}`)); // rounded to 4 digits
}

/** Number of pixels of the canvas that are not transparent. */
export const ink = (page, plot) =>
  page
    .locator(`${plot} >> canvas`)
    .first()
    .evaluate((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 3; i < data.length; i += 4) if (data[i] > 0) ++count;
      return count;
    });
