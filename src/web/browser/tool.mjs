// SPDX-License-Identifier: Apache-2.0
// What the tools write. The variable FIT_PENDULUM is the path of one of them.

import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

const fitTool = process.env.FIT_PENDULUM ?? fileURLToPath(new URL('../../../build/release/bin/fit_pendulum', import.meta.url));
export const datasets = fileURLToPath(new URL('../../../datasets/', import.meta.url));
export const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-tool-'));
after(() => fs.rmSync(folder, { recursive: true }));

/** The path of a recording of the project. */
export const dataset = (name) => path.join(datasets, name);

/** Runs a tool in the folder, with exit code 0 unless `mayFail`. */
export function run(tool, args, mayFail = false) {
  try {
    execFileSync(path.join(path.dirname(fitTool), tool), args, { cwd: folder, stdio: 'ignore' });
  } catch (error) {
    if (!mayFail || typeof error.status !== 'number') throw error;
  }
}

/** The JSON that a page contains, by the ids of its elements. */
export function embedded(url) {
  const html = fs.readFileSync(fileURLToPath(url), 'utf8');
  const parts = html.matchAll(/<script type="application\/json" id="(\w+)">(.*?)<\/script>/gs);
  return Object.fromEntries([...parts].map(([, id, json]) => [id, JSON.parse(json)]));
}

/** Makes something once. Each call returns a copy, which a test may change. */
export function once(make) {
  let made;
  return () => structuredClone((made ??= make()));
}

/** Runs a fit. Returns the address of the page and the result. */
export function fit(name, ...flags) {
  const html = path.join(folder, `${name}.html`);
  const json = path.join(folder, `${name}.json`);
  run('fit_pendulum', [...flags, '--report', html, '--json', json], true); // a fit that does not converge has a page
  return { url: pathToFileURL(html).href, result: JSON.parse(fs.readFileSync(json, 'utf8')) };
}
