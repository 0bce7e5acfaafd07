// SPDX-License-Identifier: Apache-2.0
// The built page in headless Chromium, opened as a file; CHROMIUM names another browser.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';

import { chromium } from 'playwright-core';

export const template = fs.readFileSync(new URL('../dist/report.html', import.meta.url), 'utf8');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-page-'));

const kPatience = 180_000; // ms: a busy machine may need a minute for an empty page

let browser;
before(async () => {
  const root = process.getuid?.() === 0;
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    timeout: kPatience,
    args: root ? ['--no-sandbox'] : [],
  });
});
after(async () => {
  await browser?.close();
  fs.rmSync(folder, { recursive: true });
});

/** JSON as it may stand in a script element. */
const embedded = (value) => JSON.stringify(value).replace(/</g, '\\u003c');

let written = 0;

/** Writes the page with this content, as the C++ program does. */
function write(result, series, command = { command: 'fit_pendulum --data run.csv' }) {
  const html = template
    .replace('@RESULT@', () => embedded(result))
    .replace('@SERIES@', () => embedded(series))
    .replace('@COMMAND@', () => embedded(command));
  const file = path.join(folder, `report_${++written}.html`);
  fs.writeFileSync(file, html);
  return pathToFileURL(file).href;
}

/** Opens the page with this content. */
export function open(t, result, series, options = {}) {
  return openFile(t, write(result, series, options.command), options);
}

/** Opens a report and fails on whatever it complains of or asks the network for. */
export async function openFile(t, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options.context });
  context.setDefaultTimeout(kPatience);
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on(
    'request',
    (request) =>
      request.url() !== url && !request.url().startsWith('data:') && complaints.push(`request of ${request.url()}`),
  );
  page.on('dialog', (dialog) => complaints.push(`dialog ${dialog.message()}`));
  await page.goto(url);
  await page.waitForSelector('main section');
  t.after(async () => {
    await context.close();
    assert.deepEqual(complaints, []);
  });
  return page;
}

export const kPlot = '#fit .plot >> nth=0';

/** [from, to] of the main plot, from the sentence that tells it, s. */
export async function shownRange(page, plot = kPlot) {
  const label = await page.locator(plot).getAttribute('aria-label');
  return /from (\S+) to (\S+) s/.exec(label.replace(/−/g, '-')).slice(1).map(Number);
}

export function assertRange(actual, expected) {
  actual.forEach((end, i) => assert.ok(Math.abs(end - expected[i]) < 0.006, `${actual} instead of ${expected}`)); // 4 digits are told
}

/** How many dots of the canvas are not transparent: something was drawn. */
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
