// SPDX-License-Identifier: Apache-2.0
// Reports that fit_pendulum writes. The variable FIT_PENDULUM is the path of the tool.

import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

const tool = process.env.FIT_PENDULUM ?? fileURLToPath(new URL('../../../build/release/bin/fit_pendulum', import.meta.url));
export const datasets = fileURLToPath(new URL('../../../datasets/', import.meta.url));
export const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-tool-'));
after(() => fs.rmSync(folder, { recursive: true }));

/** The path of a recording of the project. */
export const dataset = (name) => path.join(datasets, name);

/** Runs a fit. Returns the address of the page and the result. */
export function fit(name, ...flags) {
  const html = path.join(folder, `${name}.html`);
  const json = path.join(folder, `${name}.json`);
  execFileSync(tool, [...flags, '--report', html, '--json', json], { stdio: 'ignore' });
  return { url: pathToFileURL(html).href, result: JSON.parse(fs.readFileSync(json, 'utf8')) };
}
