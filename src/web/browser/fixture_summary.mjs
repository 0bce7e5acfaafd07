// SPDX-License-Identifier: Apache-2.0
// Summaries of batches for the tests. `node fixture_summary.mjs NAME` prints one of `summaries` as JSON.

import { pathToFileURL } from 'node:url';

import { seeded } from './fixture_motion.mjs';

const kTypical = {
  inertia: { value: 0.079, error: 1.2e-6, spread: 4e-6, unit: 'kg m^2' },
  viscous: { value: 0.003, error: 1.1e-5, spread: 6e-5, unit: 'N m s/rad' },
  coulomb: { value: 0.0041, error: 2.1e-5, spread: 1.5e-4, unit: 'N m' },
  drag: { value: 2.6e-5, error: 3.4e-6, spread: 4e-6, unit: 'N m s^2/rad^2' },
};

/** Normally distributed pseudorandom numbers. */
function normals(seed) {
  const random = seeded(seed);
  return () => Math.sqrt(-2 * Math.log(random())) * Math.cos(2 * Math.PI * random());
}

const quantile = (sorted, share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
const sum = (values) => values.reduce((total, value) => total + value, 0);
const mean = (values) => sum(values) / values.length;

/**
 * Runs of `rigs` rigs. Their estimates scatter about the value of the rig, `scatter` times as much as their errors say.
 */
function runsOf({ value, error, spread }, { runs, rigs, scatter, drift, names, seed }) {
  const normal = normals(seed);
  const centres = Array.from({ length: rigs }, () => value + spread * normal());
  return Array.from({ length: runs }, (_unused, i) => {
    const own = error * Math.exp(0.25 * normal());
    const far = i % 700 === 350 ? 9 * own : 0;
    return {
      x: i,
      y: centres[i % rigs] + scatter * own * normal() + far + drift * error * i,
      std_error: own,
      id: names?.(i) ?? `run_${i}`,
      group:
        rigs > 1
          ? `rig_${String.fromCharCode(97 + ((i % rigs) % 26))}${i % rigs >= 26 ? Math.floor((i % rigs) / 26) : ''}`
          : null,
    };
  });
}

function histogramOf(sorted) {
  const [from, to] = [quantile(sorted, 0.002), quantile(sorted, 0.998)];
  if (!(to > from)) return null;
  const bars = Math.min(60, Math.max(5, Math.round(2 * Math.cbrt(sorted.length))));
  const counts = new Array(bars).fill(0);
  const inside = sorted.filter((y) => y >= from && y <= to);
  for (const y of inside) ++counts[Math.min(bars - 1, Math.floor(((y - from) / (to - from)) * bars))];
  return { from, to, counts, below: sorted.filter((y) => y < from).length, above: sorted.filter((y) => y > to).length };
}

/** Weighted mean of the runs of one rig, its χ² and derived numbers. */
function groupOf(group, runs) {
  const weights = runs.map((run) => run.std_error ** -2);
  const centre = sum(runs.map((run, i) => weights[i] * run.y)) / sum(weights);
  const chi2 = sum(runs.map((run, i) => weights[i] * (run.y - centre) ** 2));
  const ratio = runs.length > 1 ? Math.sqrt(chi2 / (runs.length - 1)) : null;
  return {
    group,
    runs: runs.length,
    weighted_mean: centre,
    std_error: sum(weights) ** -0.5,
    interval95: [centre - 2 * sum(weights) ** -0.5, centre + 2 * sum(weights) ** -0.5],
    scatter_ratio: ratio,
    scatter_interval95: [0.7 * (ratio ?? 1), 1.6 * (ratio ?? 1)],
    disagrees: ratio !== null && pOf(ratio, runs.length - 1) < 0.001,
    p: ratio === null ? null : pOf(ratio, runs.length - 1),
    chi2,
  };
}

/** Two-sided p, by R. A. Fisher's normal approximation of √(2 χ²), which is accurate enough for a fixture. */
function pOf(ratio, dof) {
  const z = Math.abs(Math.sqrt(2 * dof) * ratio - Math.sqrt(2 * dof - 1));
  return Math.max(1e-120, Math.min(1, Math.exp(-0.717 * z - 0.416 * z * z)));
}

function repeatabilityOf(runs) {
  const named = new Map();
  for (const run of runs) named.set(run.group ?? 'all', [...(named.get(run.group ?? 'all') ?? []), run]);
  const rows = [...named].map(([group, own]) => groupOf(group, own));
  const chi2 = sum(rows.map((row) => row.chi2));
  const dof = runs.length - rows.length;
  const ratio = Math.sqrt(chi2 / dof);
  const p = pOf(ratio, dof);
  const verdict = p > 0.01 ? 'agrees' : ratio > 1 ? 'scatter_larger' : 'scatter_smaller';
  return {
    groups: rows.length,
    runs: runs.length,
    dof,
    chi2,
    scatter_ratio: ratio,
    p,
    between_std_dev: Math.sqrt(Math.max(0, ratio ** 2 - 1)) * mean(runs.map((run) => run.std_error)),
    verdict,
    has_enough_runs: dof >= 20,
    text: `runs of one rig scatter ${ratio.toFixed(2)} times as much as their standard errors (chi2 ${chi2.toFixed(1)}, ${dof} degrees of freedom)`,
    rows: rows.map(({ chi2: _unused, ...row }) => row),
  };
}

function trendOf(runs, column, most = 2000) {
  const points = runs.map((run) => ({ ...run, x: column === 'date' ? run.x / 40 : run.x }));
  const centres = new Map();
  for (const { group, y } of points) centres.set(group, [...(centres.get(group) ?? []), y]);
  const x0 = mean(points.map(({ x }) => x));
  const off = points.map((point) => point.y - mean(centres.get(point.group)));
  const sxx = sum(points.map(({ x }) => (x - x0) ** 2));
  const slope = sum(points.map(({ x }, i) => (x - x0) * off[i])) / sxx;
  const error = Math.sqrt(mean(off.map((y) => y * y)) / sxx);
  const every = Math.ceil(points.length / most);
  return {
    column,
    unit: column === 'date' ? 'days since 2026-01-01' : null,
    slope,
    std_error: error,
    p: Math.exp(-0.717 * Math.abs(slope / error) - 0.416 * (slope / error) ** 2),
    text: Math.abs(slope / error) > 3 ? 'it changes from run to run by more than chance' : 'no trend beyond chance',
    points: points.filter((_unused, i) => i % every === 0),
    points_total: points.length,
  };
}

/** One parameter of one model, from its runs. */
function parameterOf(model, name, typical, options) {
  const runs = runsOf(typical, options);
  const sorted = runs.map((run) => run.y).sort((a, b) => a - b);
  const middle = mean(sorted);
  const comparable = runs.length > options.rigs;
  const isFar = ({ x }) => x % 700 === 350;
  const far = runs.filter(isFar).map(({ id, group, y, std_error }) => ({ id, group, estimate: y, std_error, z: 9 }));
  return {
    model,
    name,
    unit: typical.unit,
    derived: false,
    runs: runs.length,
    median: quantile(sorted, 0.5),
    mean: middle,
    std_dev: Math.sqrt(sum(sorted.map((y) => (y - middle) ** 2)) / Math.max(1, runs.length - 1)),
    minimum: sorted[0],
    maximum: sorted[sorted.length - 1],
    lower_quartile: quantile(sorted, 0.25),
    upper_quartile: quantile(sorted, 0.75),
    median_std_error: quantile(
      runs.map((run) => run.std_error).sort((a, b) => a - b),
      0.5,
    ),
    median_repeat_error: quantile(
      runs.map((run) => run.std_error).sort((a, b) => a - b),
      0.5,
    ),
    histogram: histogramOf(sorted),
    repeatability: comparable ? repeatabilityOf(runs.filter((run) => !isFar(run))) : null,
    repeatability_reason: comparable ? null : 'no rig has two runs to compare',
    outliers: far.slice(0, 50),
    outliers_total: far.length,
    trend: runs.length > 2 ? trendOf(runs, options.column, options.points) : null,
  };
}

const storeOf = (runs, refitted, fits, path = 'results/results.sqlite') => ({
  path,
  runs,
  refitted,
  pending: runs - refitted,
  fits,
  versions: ['0.1.0'],
  cpus: ['Intel(R) Xeon(R) Processor (avx512)'],
  manifest_sha256: '3f'.repeat(32),
});

const tool = { name: 'refit_pendulums', version: '0.1.0' };

/** What a summary says first: counts, the pendulums, whether the errors of each model are right. */
function answerOf({ runs, fitted, missing = 0, refused = 0, pendulums = 1, group = null, verdicts = [], outlier = null }) {
  const example = (id, reason) => ({ id, reason });
  const pending = runs - fitted - missing - refused;
  const rest = [
    [missing, 'missing'],
    [refused, 'refused'],
    [pending, 'not fitted yet'],
  ].filter(([count]) => count > 0);
  const each = Math.ceil(fitted / pendulums);
  return {
    headline: {
      text: `${fitted} of ${runs} recordings fitted${rest.length > 0 ? '; ' : ''}${rest.map(([count, words]) => `${count} ${words}`).join(', ')}`,
      runs,
      fitted,
      not_converged: 0,
      missing,
      refused,
      pending,
      stale: 0,
      unlisted: 0,
      missing_runs: missing > 0 ? [example('run_17', 'there is no such file; check the path')] : [],
      refused_runs: refused > 0 ? [example('run_3', 'it has no swing')] : [],
      stale_runs: [],
    },
    grouping: {
      by: pendulums > 1 ? 'rig' : 'all',
      name: group,
      is_stated: false,
      pendulums,
      smallest: each,
      largest: each,
      unlike: 0,
      is_compared: fitted > 1,
      text:
        pendulums > 1
          ? `Recordings with the same rig file are taken for repeats of one pendulum: ${pendulums} pendulums, ${each} recordings each.`
          : `The ${fitted} recordings are taken for repeats of one pendulum: nothing says otherwise.`,
      otherwise: 'If another column tells the pendulums apart: --group_by COLUMN. If all are of one: --group_by all.',
    },
    main_model: verdicts.at(-1)?.model ?? null,
    verdicts,
    agreement: outlier && {
      model: 'coulomb',
      groups: pendulums,
      disagreeing: 1,
      rows: [
        {
          group,
          runs: each,
          statistic: 2 * each + 400,
          dof: 2 * each - 2,
          p: 1e-9,
          outliers: [{ id: outlier, parameter: 'inertia', estimate: 0.0814, others: 0.079, z: 25.2 }],
        },
      ],
    },
  };
}

const verdictOf = (model, verdict = 'agrees') => ({
  model,
  verdict,
  level: verdict === 'too_small' || verdict === 'not_compared' ? 'caution' : 'good',
  text:
    verdict === 'too_small'
      ? `Under the law ${model}, repeats differ by more than their errors in 1 of 4 parameters: inertia scatters 1.4 times as much as its errors predict. Either the pendulum changed or the errors are too small.`
      : `Under the law ${model}, repeats differ as much as their errors say, in all 4 parameters. No difference from the errors was found.`,
});
const ended = (model, fits, not_converged = 0, not_identifiable = 0, failed = 0) => ({
  model,
  fits,
  converged: fits - not_converged - not_identifiable - failed,
  not_converged,
  not_identifiable,
  failed,
});

const kFailures = [
  {
    status: 'failed',
    exit_code: 3,
    reason: 'there is no such file; check the path',
    fits: 24,
    models: ['viscous', 'coulomb'],
    examples: Array.from({ length: 10 }, (_unused, i) => `run_${17 + 31 * i}`),
  },
  {
    status: 'not_converged',
    exit_code: 1,
    reason: 'the search ended after 200 iterations',
    fits: 5,
    models: ['coulomb'],
    examples: ['run_88', 'run_91'],
  },
  {
    status: 'not_identifiable',
    exit_code: 1,
    reason: 'viscous and coulomb are told together only (correlation -0.9997)',
    fits: 3,
    models: ['coulomb'],
    examples: ['run_1204'],
  },
];

/** 2000 runs of three rigs and two models. `scatter`: of the inertia, in error bars. */
export function makeSummary({ runs = 2000, rigs = 3, scatter = 1, names, drift = 0 } = {}) {
  const options = { runs: runs - 20, rigs, scatter: 1, drift: 0, names, column: 'date' };
  const parameters = [
    ['viscous', 'inertia', 11],
    ['viscous', 'viscous', 13],
    ['coulomb', 'inertia', 17],
    ['coulomb', 'viscous', 19],
    ['coulomb', 'coulomb', 23],
    ['coulomb', 'drag', 29],
  ].map(([model, name, seed]) =>
    parameterOf(model, name, kTypical[name], { ...options, seed, ...(name === 'inertia' ? { scatter, drift } : {}) }),
  );
  parameters.push({
    ...parameterOf(
      'coulomb',
      'release_angle',
      { value: 0.4, error: 2e-4, spread: 0, unit: 'rad' },
      { ...options, scatter: 400, seed: 31 },
    ),
    repeatability: null,
    repeatability_reason: 'each run has a release angle of its own',
    outliers: [],
    outliers_total: 0,
    trend: null,
  });
  return {
    schema_version: 2,
    tool,
    ...answerOf({
      runs,
      fitted: runs - 14,
      missing: 10,
      refused: 2,
      pendulums: rigs,
      group: rigs > 1 ? 'rig' : null,
      verdicts: ['viscous', 'coulomb'].map((model) => verdictOf(model, scatter > 1.1 ? 'too_small' : 'agrees')),
      outlier: names ? names(1) : 'run_1050',
    }),
    store: storeOf(runs, runs - 2, 2 * runs - 4),
    group_by: rigs > 1 ? 'rig' : null,
    trend_by: 'date',
    models: [ended('viscous', runs - 2, 0, 0, 12), ended('coulomb', runs - 2, 5, 3, 12)],
    recommendations: [
      { model: 'viscous', runs: Math.round(0.2 * runs) },
      { model: 'coulomb', runs: Math.round(0.79 * runs) },
      { model: null, runs: runs - Math.round(0.2 * runs) - Math.round(0.79 * runs) },
    ],
    failures: kFailures,
    parameters,
    warnings: [{ code: 'pending', message: '2 runs have not been fitted yet; run refit_pendulums again' }],
  };
}

/** Three runs of one rig, one model. */
export function makeTiny() {
  const options = { runs: 3, rigs: 1, scatter: 1, drift: 0, seed: 5, column: 'position' };
  return {
    schema_version: 2,
    tool,
    ...answerOf({ runs: 3, fitted: 3, verdicts: [verdictOf('coulomb', 'few')] }),
    store: storeOf(3, 3, 3, 'tiny.sqlite'),
    group_by: null,
    trend_by: null,
    models: [ended('coulomb', 3)],
    recommendations: [],
    failures: [],
    parameters: ['inertia', 'viscous', 'coulomb'].map((name, i) =>
      parameterOf('coulomb', name, kTypical[name], { ...options, seed: 5 + i }),
    ),
    warnings: [],
  };
}

/** A batch without a converged fit. */
export function makeFailures() {
  return {
    schema_version: 2,
    tool,
    ...answerOf({ runs: 40, fitted: 0, missing: 38, refused: 2, verdicts: [verdictOf('coulomb', 'not_compared')] }),
    store: storeOf(40, 40, 40, 'failures.sqlite'),
    group_by: 'rig',
    trend_by: null,
    models: [ended('coulomb', 40, 0, 0, 40)],
    recommendations: [],
    failures: [
      { ...kFailures[0], fits: 38, models: ['coulomb'] },
      {
        status: 'failed',
        exit_code: 4,
        reason: 'run.csv:118: time 3.20 s does not follow 3.21 s; times must increase',
        fits: 2,
        models: ['coulomb'],
        examples: ['run_3', 'run_5'],
      },
    ],
    parameters: [],
    warnings: [],
  };
}

/** 100 parameters of 2000 runs of 40 rigs each. */
export function makeLarge() {
  const options = { runs: 2000, rigs: 40, scatter: 1, drift: 0, column: 'position' };
  return {
    schema_version: 2,
    tool,
    ...answerOf({ runs: 100_000, fitted: 100_000, pendulums: 40, group: 'rig', verdicts: [verdictOf('coulomb')] }),
    store: storeOf(100_000, 100_000, 100_000, 'large.sqlite'),
    group_by: 'rig',
    trend_by: null,
    models: [ended('coulomb', 100_000)],
    recommendations: [],
    failures: [],
    parameters: Array.from({ length: 100 }, (_unused, i) => ({
      ...parameterOf(
        'coulomb',
        `term_${i}`,
        { value: 1 + i, error: 1e-3, spread: 1e-2, unit: 'N m' },
        { ...options, seed: 101 + i },
      ),
    })),
    warnings: [],
  };
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
  const summary = makeSummary({ runs: 60, names: (i) => kHostile[i % kHostile.length] });
  for (const one of summary.parameters) {
    if (one.repeatability) one.repeatability.rows.forEach((row, i) => (row.group = kHostile[i % kHostile.length]));
    for (const point of one.trend?.points ?? []) point.group = kHostile[point.x < 0.7 ? 0 : 1];
    one.outliers = kHostile.map((id) => ({
      id,
      group: id,
      estimate: one.median,
      std_error: one.median_std_error,
      z: 7.2,
    }));
    one.outliers_total = one.outliers.length;
  }
  const [long] = [kHostile[1]];
  Object.assign(summary.store, {
    path: `folder/${kHostile[0].replace('/', '')}.sqlite`,
    cpus: [kHostile[0], long],
    versions: [long],
  });
  summary.group_by = kHostile[0];
  summary.failures = [
    {
      status: 'failed',
      exit_code: null,
      reason: `${kHostile[0]} ${long}`,
      fits: 12,
      models: ['coulomb'],
      examples: kHostile,
    },
  ];
  summary.warnings = [{ code: 'odd', message: `${kHostile[3]} ${long}` }];
  return summary;
}

export const summaries = {
  realistic: makeSummary,
  scattered: () => makeSummary({ scatter: 1.4, drift: 2e-3 }),
  tiny: makeTiny,
  failures: makeFailures,
  large: makeLarge,
  hostile: makeHostile,
};

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  process.stdout.write(`${JSON.stringify(summaries[process.argv[2]]())}\n`);
}
