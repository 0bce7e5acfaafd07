// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test, vi } from 'vitest';

import { elided, visible } from '../shared/names';
import { barsOf, rangeOf } from './distribution_section';
import { headline, worst, judgedOf } from './headline';
import { disagreementText } from './outliers_section';
import { meanRows, rowsToDraw, scatterRows } from './repeatability';
import { groupCount, median, middle, nearest, trendGroups, within, xRange } from './trend';
import { columnLabel } from './trend_plot';
import type {
  GroupRow,
  ModelCounts,
  ParameterSummary,
  Repeatability,
  Summary,
  Trend,
  TrendRun,
  Verdict,
} from './types';
import { mainModel, parametersOf, shownParameter, type View } from './view';
import { counted, countText, shareText, withUnitOf } from './words';

// As in a page that the program wrote.
vi.stubGlobal('document', { getElementById: () => ({ textContent: '{"inertia": {"symbol": "I_O", "words": "moment of inertia", "unit_over_g": "s^2"}}' }) });

const row = (group: string, runs: number, scatter_ratio: number | null, p: number | null = 0.5): GroupRow => ({
  group,
  runs,
  weighted_mean: 2,
  std_error: 0.1,
  interval95: [1.8, 2.2],
  scatter_ratio,
  scatter_interval95: [0.6, 1.9],
  p,
  disagrees: p !== null && p < 1e-6,
  texts: { weighted_mean: '2.00 ± 0.10', scatter_ratio: String(scatter_ratio), scatter_interval95: '0.6 to 1.9', p: '0.5' },
});

const repeats = (verdict: Verdict, scatter_ratio: number, dof = 100, rows: GroupRow[] = []): Repeatability => ({
  groups: 3,
  runs: dof + 3,
  dof,
  chi2: dof * scatter_ratio ** 2,
  scatter_ratio,
  p: 0.5,
  between_std_dev: 0,
  verdict,
  has_enough_runs: dof >= 20,
  text: '',
  texts: { chi2: '', scatter_ratio: '', p: '', between_std_dev: '' },
  rows,
});

const parameter = (name: string, repeatability: Repeatability | null = null, model = 'coulomb'): ParameterSummary =>
  ({
    model,
    name,
    unit: 's',
    runs: 100,
    median: 2,
    median_std_error: 0.25,
    repeatability,
    repeatability_reason: repeatability ? null : 'no rig has two runs to compare',
    outliers: [],
    outliers_total: 0,
  }) as unknown as ParameterSummary;

const ended = (model: string, fits: number, converged: number): ModelCounts => ({
  model,
  fits,
  converged,
  not_converged: 0,
  not_identifiable: 0,
  failed: fits - converged,
});

function summary(models: ModelCounts[], parameters: ParameterSummary[], more: Partial<Summary> = {}): Summary {
  const fits = models.reduce((sum, model) => sum + model.fits, 0);
  const store = {
    path: 'a/results.sqlite',
    runs: 100,
    refitted: 100,
    pending: 0,
    fits,
    versions: [],
    cpus: [],
    manifest_sha256: null,
  };
  return {
    schema_version: 2,
    tool: { name: 'refit_pendulums', version: '0.1.0' },
    headline: {
      text: '98 of 100 recordings fitted; 1 missing, 1 refused',
      runs: 100,
      fitted: 98,
      not_converged: 0,
      missing: 1,
      refused: 1,
      pending: 0,
      stale: 0,
      unlisted: 0,
      missing_runs: [],
      refused_runs: [],
      stale_runs: [],
    },
    grouping: {
      by: 'all',
      name: null,
      is_stated: false,
      pendulums: 1,
      smallest: 98,
      largest: 98,
      unlike: 0,
      is_compared: true,
      text: 'The 98 recordings are taken for one pendulum.',
      otherwise: 'If they are not: --group_by COLUMN.',
    },
    main_model: models[0]?.model ?? null,
    verdicts: models.map(({ model }) => ({ model, verdict: 'agrees', level: 'good', text: `Errors of ${model} are right.` })),
    agreement: null,
    store,
    group_by: null,
    trend_by: null,
    models,
    recommendations: [],
    failures: [],
    parameters,
    warnings: [],
    ...more,
  };
}

const view = (made: Summary, parameterName: string | null = null): View => ({
  summary: made,
  shown: mainModel(made),
  parameter: parameterName,
});

describe('words', () => {
  test('counts and shares', () => {
    expect(countText(9999)).toBe('9999');
    expect(countText(1234567)).toBe('1\u202f234\u202f567');
    expect(counted(1, 'run')).toBe('1 run');
    expect(counted(0, 'run')).toBe('0 runs');
    expect(shareText(1, 0)).toBe('–');
    expect(shareText(0, 10)).toBe('0 %');
    expect(shareText(10, 10)).toBe('100 %');
    expect(shareText(99_999, 100_000)).toBe('99.9 %'); // not all of them
    expect(shareText(1, 100_000)).toBe('< 0.1 %'); // not none
  });

  test('numbers of the JSON are typeset, with their unit if there is a number', () => {
    expect(withUnitOf('0.0790012', 'kg m^2')).toBe('0.0790012\u00a0kg\u00a0m²');
    expect(withUnitOf('-1.2e-06', '1')).toBe('−1.2 × 10⁻⁶');
    expect(withUnitOf('-', 's')).toBe('–');
  });

  test('hidden characters of a name are made visible', () => {
    expect(visible('a\nb\u202ec\u0000')).toBe('a\\nb\\u202ec\\u0000');
    expect(visible('Größe <b>')).toBe('Größe <b>');
    expect(elided('short', 18)).toBe('short');
    expect(elided('0123456789', 7)).toBe('012…789');
    expect([...elided('🙂'.repeat(30), 7)]).toHaveLength(7); // whole characters
  });
});

describe('what is shown first', () => {
  test('the model that was recommended most often', () => {
    const models = [ended('viscous', 10, 10), ended('coulomb', 10, 9)];
    const recommendations = [
      { model: 'coulomb', runs: 8 },
      { model: 'viscous', runs: 2 },
    ];
    expect(mainModel(summary(models, [], { recommendations }))).toBe(1);
    expect(mainModel(summary(models, []))).toBe(0);
    expect(mainModel(summary(models, [parameter('inertia')]))).toBe(1); // of coulomb
    expect(mainModel(summary([], []))).toBe(0);
  });

  test('the first parameter with several runs of one rig', () => {
    const all = [
      parameter('release_angle'),
      parameter('inertia', repeats('agrees', 1)),
      parameter('inertia', null, 'viscous'),
    ];
    const made = summary([ended('coulomb', 10, 10)], all);
    expect(parametersOf(view(made))).toHaveLength(2);
    expect(shownParameter(view(made))?.name).toBe('inertia');
    expect(shownParameter(view(made, 'release_angle'))?.name).toBe('release_angle');
    expect(shownParameter(view(made, 'of another model'))?.name).toBe('inertia');
    expect(shownParameter(view(summary([], [])))).toBeNull();
  });
});

describe('the headline', () => {
  const of = (parameters: ParameterSummary[], converged = 99, more: Partial<Summary> = {}) =>
    headline(view(summary([ended('coulomb', 100, converged)], parameters, more)));

  const verdictOf = (level: 'good' | 'caution', text: string): Partial<Summary> => ({
    verdicts: [{ model: 'coulomb', verdict: level === 'good' ? 'agrees' : 'too_small', level, text }],
  });

  test('counts every recording first, then says what was taken for one pendulum, then the verdict', () => {
    expect(of([], 99, verdictOf('caution', 'Repeats differ by more than their errors.'))).toEqual({
      level: 'caution',
      title: '98 of 100 recordings fitted; 1 missing, 1 refused',
      sentence:
        'The 98 recordings are taken for one pendulum. If they are not: --group_by COLUMN. ' +
        'Repeats differ by more than their errors.',
    });
    expect(of([]).level).toBe('good');
  });

  test('different pendulums get no verdict', () => {
    const text = '100 different pendulums (each has its own rig); repeatability needs several recordings of one.';
    const made = summary([], []);
    const grouping = { ...made.grouping, is_compared: false, text, otherwise: null };
    const said = of([], 99, { ...verdictOf('caution', 'Whether the errors are right is not known.'), grouping });
    expect(said).toMatchObject({ level: 'caution', sentence: text });
  });

  test('says which recordings disagree as the program does', () => {
    const disagreement = 'One recording disagrees: d.csv (inertia 0.081402, the others 0.078999: 3 % more, z 17.8).';
    expect(disagreementText(summary([], [], { disagreement }))).toBe(disagreement);
    expect(of([], 99, { disagreement }).level).toBe('caution');
    expect(disagreementText(summary([], []))).toBe('');
  });

  test('a model that few runs converged with does not represent them', () => {
    const fine = [parameter('inertia', repeats('agrees', 1))];
    expect(of(fine, 80).level).toBe('caution');
    expect(of(fine, 40).level).toBe('bad');
  });

  test('no fit, and no converged fit', () => {
    expect(headline(view(summary([], []))).title).toBe('Nothing has been fitted');
    const failure = { status: 'failed', exit_code: 3, reason: 'no file', fits: 7, models: [], examples: [] };
    expect(of([], 0, { failures: [{ ...failure, fits: 2, reason: 'other' }, failure] })).toMatchObject({
      level: 'bad',
      title: '98 of 100 recordings fitted; 1 missing, 1 refused: no fit converged',
      sentence: 'Most often (7 fits): no file.',
    });
    expect(of([], 0).sentence).toBe('');
  });

  test('the parameter that scatters most', () => {
    const made = view(
      summary(
        [ended('coulomb', 9, 9)],
        [parameter('a', repeats('agrees', 0.9)), parameter('b', repeats('agrees', 1.1)), parameter('c')],
      ),
    );
    expect(worst(judgedOf(made))?.name).toBe('b');
    expect(worst([])).toBeNull();
  });
});

describe('repeatability', () => {
  test('the last row is the expected ratio', () => {
    const found = repeats('agrees', 1, 10, [row('a', 6, 1.1), row('c'.repeat(300), 6, 3, 1e-9)]);
    const rows = scatterRows(found);
    expect(rows.map(({ estimate }) => estimate)).toEqual([1.1, 3, 1]);
    expect(rows.map((one) => one.disagrees)).toEqual([false, true, false]);
    expect(rows[0].text).toBe('1.1');
    expect(rows[0].interval95).toEqual(found.rows[0].scatter_interval95);
    expect(rows[1].label).toHaveLength(18);
    expect(rows[2]).toMatchObject({ kind: 'joint', label: 'true error bars' });
    expect(meanRows(found)[0].text).toBe('2.00 ± 0.10');
    expect(meanRows(found)[0].interval95).toEqual(found.rows[0].interval95);
  });

  test('of many groups those with the smallest p are drawn, in order', () => {
    const rows = Array.from({ length: 100 }, (_unused, i) => row(`g${i}`, 5, 1, i % 2 ? 1e-3 * i : 0.9));
    const drawn = rowsToDraw(rows);
    expect(drawn).toHaveLength(24);
    expect(drawn[0].group).toBe('g1');
    expect(drawn[23].group).toBe('g47');
  });
});

test('the axis of a histogram has space for the error bar', () => {
  const bars = { from: 1, to: 3, counts: [1, 0, 2, 1], below: 0, above: 0 };
  expect(barsOf(bars)).toEqual({ left: [1, 1.5, 2, 2.5], width: 0.5 });
  expect(rangeOf(parameter('a'), bars)).toEqual([1, 3]);
  expect(rangeOf({ ...parameter('a'), median_std_error: 2 }, bars)).toEqual([0, 4]);
  expect(rangeOf({ ...parameter('a'), median_std_error: 100 }, bars)).toEqual([-2, 6]);
  expect(rangeOf({ ...parameter('a'), median: null }, bars)).toEqual([1, 3]);
});

describe('the trend', () => {
  const run = (x: number, y: number | null, group: string | null, std_error: number | null = 0.1): TrendRun => ({
    x,
    y,
    std_error,
    text: `${y}`,
    id: `run_${x}`,
    group,
  });
  const trend = (points: TrendRun[], more: Partial<Trend> = {}): Trend => ({
    column: 'position',
    unit: null,
    slope: 0.5,
    std_error: 0.1,
    p: 0.1,
    text: '',
    texts: { slope: '', p: '' },
    points,
    points_total: points.length,
    ...more,
  });

  test('groups are in order of occurrence, their runs in order of x', () => {
    const groups = trendGroups(trend([run(3, 13, 'b'), run(1, 1, 'a'), run(0, null, 'a'), run(2, 2, 'a', null)]));
    expect(groups.map(({ name }) => name)).toEqual(['b', 'a']);
    expect(groups[1]).toMatchObject({ x: [1, 2], y: [1, 2], error: [0.1, NaN], texts: ['1', '2'], ids: ['run_1', 'run_2'] });
    expect(xRange(groups)).toEqual([1 - 0.04, 3 + 0.04]);
    expect(xRange([])).toEqual([-0.02, 1.02]);
    expect(within(groups[1], 1.5, 9)).toEqual([1, 2]);
    expect(within(groups[1], 5, 9)).toEqual([0, 0]);
    expect(nearest(groups[1], 1.6)).toBe(1);
  });

  test('lines have the slope of the trend, and half of the runs are above them', () => {
    const points = [0, 1, 2, 3, 4].flatMap((x) => [run(x, 10 + 0.5 * x, 'a'), run(x, 0.5 * x, 'b')]);
    const made = trend(points);
    expect(middle(made)).toBe(2);
    expect(trendGroups(made).map(({ centre }) => centre[0])).toEqual([11, 1]);
    expect(median([])).toBeNaN();
    expect(median([3, 1, NaN, 2, 4])).toBe(2.5);
  });

  test('more groups than colours are drawn as one', () => {
    const many = trend(Array.from({ length: 70 }, (_unused, i) => run(i, i % 7, `rig_${i % 7}`)));
    expect(trendGroups(many)).toHaveLength(1);
    expect(trendGroups(many)[0].groups[3]).toBe('rig_3');
    expect(groupCount(many)).toBe(7);
  });

  test('the label of the column has its unit', () => {
    expect(columnLabel(trend([]))).toBe('position in the manifest');
    const dated = trend([], { column: 'date', unit: 'days since 2026-01-01' });
    expect(columnLabel(dated)).toBe('date [days since 2026-01-01]');
  });
});
