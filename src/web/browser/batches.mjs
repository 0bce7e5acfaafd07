// SPDX-License-Identifier: Apache-2.0
// Summaries that refit_pendulums writes of batches of simulated recordings.

import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

import { dataset, embedded, folder, once, run } from './tool.mjs';

const kRuns = 20; // of each rig
const kInertias = { rig_a: 0.079, rig_b: 0.081, rig_c: 0.077 };

function simulate(name, inertia, seed, count, spread) {
  const motion = `inertia=${inertia},viscous=0.003,coulomb=0.004,release_angle=0.423,release_time=1`;
  run('simulate_pendulum', [
    ...['--rig', dataset('recorded_rig.json'), '--set', motion, '--spread', `inertia=${spread}`],
    ...['--duration', '12', '--rate', '50', '--noise', '0.2', '--seed', `${seed}`, '--count', `${count}`],
    ...['--out', `${name}.csv`],
  ]);
}

/** Refits a manifest. Returns what the page of the summary contains. */
function summaryOf(name, header, rows, models, flags = []) {
  fs.writeFileSync(path.join(folder, `${name}.csv`), [header, ...rows, ''].join('\n'));
  const store = `${name}.sqlite`;
  run('refit_pendulums', [`${name}.csv`, '--rig', dataset('recorded_rig.json'), '--models', models, '--store', store], true);
  const page = path.join(folder, `${name}.html`);
  run('refit_pendulums', ['report', '--store', store, '--out', page, ...flags]);
  return embedded(pathToFileURL(page));
}

const padded = (k) => String(k).padStart(3, '0');
const missing = (count) => Array.from({ length: count }, (_unused, k) => `missing_${k}.csv`);

/** Files without a swing. */
function refused(count) {
  const lines = ['time_s,angle_deg', ...Array.from({ length: 200 }, (_unused, i) => `${i / 50},1`), ''];
  const names = Array.from({ length: count }, (_unused, k) => `still_${k}.csv`);
  for (const name of names) fs.writeFileSync(path.join(folder, name), lines.join('\n'));
  return names;
}

function threeRigs(name, spread) {
  const runs = Object.entries(kInertias).flatMap(([rig, inertia], k) => {
    simulate(`${name}_${rig}`, inertia, 100 * (k + 1), kRuns, spread);
    return Array.from({ length: kRuns }, (_unused, i) => [`${name}_${rig}_${padded(i + 1)}.csv`, rig]);
  });
  simulate(`${name}_odd`, 0.0795, 7, 1, 0); // said to be of rig_a
  const others = [...missing(10), ...refused(2)].map((file) => `${file},rig_a,unknown`);
  const rows = [...runs, [`${name}_odd.csv`, 'rig_a']].map(([file, rig], i) => `${file},${rig},${20 + i / 40}`);
  return summaryOf(name, 'path,pendulum,temperature', [...rows, ...others], 'viscous,coulomb', [
    ...['--group_by', 'pendulum', '--trend_by', 'temperature'],
  ]);
}

/** 61 recordings of three rigs, of which one differs from its rig; ten files are missing, two have no swing. */
export const makeSummary = once(() => threeRigs('batch', 0));

/** The same, but the inertia of a rig changes from run to run by three times its error. */
export const makeScattered = once(() => threeRigs('scattered', 2e-5));

/** Three runs of one rig, one model. */
export const makeTiny = once(() => {
  simulate('tiny_run', kInertias.rig_a, 5, 3, 0);
  return summaryOf('tiny', 'path', [1, 2, 3].map((k) => `tiny_run_${padded(k)}.csv`), 'coulomb');
});

/** A batch without a converged fit. */
export const makeFailures = once(() => summaryOf('failures', 'path', [...missing(38), ...refused(2)], 'coulomb'));

const repeated = (list, count) => Array.from({ length: count }, (_unused, i) => ({ ...list[i % list.length] }));

/** More than a page can draw at once: 100 parameters of 2000 runs of 40 rigs, repeated from a small batch. */
export function makeLarge() {
  const content = makeSummary();
  const { summary } = content;
  const of = summary.parameters.filter(({ model, repeatability }) => model === 'coulomb' && repeatability);
  summary.parameters = Array.from({ length: 100 }, (_unused, i) => {
    const one = structuredClone(of[i % of.length]);
    one.name = `term_${i}`;
    one.repeatability.rows = repeated(one.repeatability.rows, 40).map((row, k) => ({ ...row, group: `rig_${k}` }));
    one.trend.points = repeated(one.trend.points, 2000).map((point, k) => ({ ...point, x: k, group: `rig_${k % 40}` }));
    return one;
  });
  return content;
}

/** Names with markup and control characters, which a page must show as text. */
export const kHostile = [
  '<script>alert(1)</script>',
  'x'.repeat(300),
  'two\nlines\tand a tab',
  '"><img src=x onerror=alert(1)>',
  '\u202etxt.exe',
];

/** A summary that has these names in all places. */
export function makeHostile() {
  const content = makeSummary();
  const { summary } = content;
  const [markup, long, , image] = kHostile;
  for (const one of summary.parameters) {
    one.repeatability?.rows.forEach((row, i) => (row.group = kHostile[i]));
    one.trend?.points.forEach((point, i) => Object.assign(point, { id: kHostile[i % 5], group: kHostile[i % 2] }));
    const outlier = { estimate: one.median, std_error: one.median_std_error, text: one.texts.median, z: 7.2 };
    one.outliers = kHostile.map((id) => ({ id, group: id, ...outlier }));
    one.outliers_total = one.outliers.length;
  }
  Object.assign(summary.store, { path: `folder/${markup.replace('/', '')}.sqlite`, cpus: [markup, long], versions: [long] });
  summary.group_by = markup;
  summary.failures = [{ ...summary.failures[0], reason: `${markup} ${long}`, fits: 12, examples: kHostile }];
  summary.warnings = [{ code: 'odd', message: `${image} ${long}` }];
  return content;
}

export const summaries = {
  realistic: makeSummary,
  scattered: makeScattered,
  tiny: makeTiny,
  failures: makeFailures,
  large: makeLarge,
  hostile: makeHostile,
};
