// SPDX-License-Identifier: Apache-2.0
// Starts the service (SERVE_PENDULUM is the path of the tool) and opens its page in headless Chromium.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import readline from 'node:readline';
import { after } from 'node:test';
import { fileURLToPath } from 'node:url';

import { watchedPage } from './page.mjs';

const kRoot = fileURLToPath(new URL('../../../', import.meta.url));
const tool = process.env.SERVE_PENDULUM ?? path.join(kRoot, 'build/release/bin/serve_pendulum');

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-service-'));
const running = new Set();

after(async () => {
  await Promise.all([...running].map((service) => service.stop()));
  fs.rmSync(folder, { recursive: true });
});

export const dataset = (name) => path.join(kRoot, 'datasets', name);
export const readDataset = (name) => fs.readFileSync(dataset(name), 'utf8');
/** The first 9 s of coulomb.csv, to paste. A browser needs half a minute to lay out the whole file in a field. */
export const kPasted = readDataset('coulomb.csv').split('\n').slice(0, 900).join('\n');

/** Writes a temporary file. */
export function write(name, content) {
  const file = path.join(folder, name);
  fs.mkdirSync(path.dirname(file), { recursive: true });
  fs.writeFileSync(file, content);
  return file;
}

let started = 0;

/** Starts the service with its own store on a free port. `url` is its address. */
export async function startService(...flags) {
  const store = path.join(folder, `fits_${++started}.sqlite`);
  const child = spawn(tool, ['--port', '0', '--store', store, ...flags], { stdio: ['ignore', 'pipe', 'pipe'] });
  const log = [];
  child.stderr.on('data', (text) => log.push(String(text)));
  const ended = new Promise((resolve) => child.on('exit', (code) => resolve(code)));
  const lines = readline.createInterface({ input: child.stdout });
  const listening = new Promise((resolve) => lines.once('line', resolve));
  const first = await Promise.race([listening, ended.then((code) => `ended with ${code}: ${log.join('')}`)]);
  const url = /^serve_pendulum: listening on (http:\/\/\S+)$/.exec(first)?.[1];
  assert.ok(url, `serve_pendulum did not say where it listens, but: ${first}`);
  const service = {
    url,
    log: () => log.join(''),
    async stop() {
      running.delete(service);
      child.kill('SIGTERM');
      assert.equal(await ended, 0, log.join(''));
    },
    /** The JSON at an address of the service. */
    async json(address, options = {}) {
      const answer = await fetch(url + address, options);
      assert.ok(answer.ok, `${address}: ${answer.status}`);
      return answer.json();
    },
    /** Fits a data set without the page. Returns the id of the new fit. */
    async fit(name, query, rig = null) {
      const form = new FormData();
      form.append('data', new Blob([readDataset(name)]), name);
      if (rig) form.append('rig', new Blob([readDataset(rig)]), rig);
      const answer = await fetch(`${url}/v1/fits?${query}`, { method: 'POST', body: form });
      assert.equal(answer.status, 200, await answer.clone().text());
      return answer.headers.get('Location').split('/').pop();
    },
  };
  running.add(service);
  return service;
}

/**
 * Opens a view. The test fails on errors in the console, which include violations of the content security policy, and on
 * requests to other addresses. `refused`: errors that are part of the test, such as "status of 422".
 */
export async function openView(t, service, address, { context, refused = [] } = {}) {
  const expected = (complaint) => refused.some((what) => complaint.includes(what));
  const mayAsk = (asked) => asked.startsWith(`${service.url}/`) || /^(data|blob):/.test(asked);
  const page = await watchedPage(t, { context, mayAsk, expected });
  await page.goto(service.url + address);
  await page.waitForSelector('h1');
  return page;
}

/** Drops files on the page, as a user does. */
export async function drop(page, files) {
  const transfer = await page.evaluateHandle((all) => {
    const data = new DataTransfer();
    for (const { name, content } of all) data.items.add(new File([content], name, { type: 'text/csv' }));
    return data;
  }, files);
  for (const event of ['dragenter', 'dragover', 'drop'])
    await page.dispatchEvent('.drop', event, { dataTransfer: transfer });
}

/** The id of the displayed fit, from its address, once it differs from `before`. */
export async function shownFit(page, before = '') {
  await page.waitForURL((url) => /^\/fits\/[^/]+$/.test(url.pathname) && !url.pathname.endsWith(`/${before}`));
  await page.waitForSelector('#verdict');
  return new URL(page.url()).pathname.split('/').pop();
}

/** [value, error] from "0.0790 ± 0.0003" or "(1.2 ± 0.3) × 10⁻⁶". */
function numbersOf(text) {
  const plain = text.replace(/−/g, '-').replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]/g, (c) => '0123456789-'['⁰¹²³⁴⁵⁶⁷⁸⁹⁻'.indexOf(c)]);
  const scaled = /^\((\S+) ± (\S+)\) × 10(\S+)$/.exec(plain);
  if (scaled) return [1, 2].map((i) => Number(scaled[i]) * 10 ** Number(scaled[3]));
  return /^(\S+) ± (\S+)/.exec(plain).slice(1, 3).map(Number);
}

/**
 * Asserts that the text has the estimate and its error, each rounded by less than 0.15 of the error (PDG, "Rounding").
 */
export function assertShown(text, { estimate, std_error: error }) {
  const [value, shown] = numbersOf(text);
  assert.ok(Math.abs(value - estimate) <= 0.15 * error, `${text} is not ${estimate}`);
  assert.ok(Math.abs(shown - error) <= 0.15 * error, `${text} has not the error ${error}`);
}
