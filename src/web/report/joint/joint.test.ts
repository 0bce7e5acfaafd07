// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { clipped, forestRange, placeOf, type ForestRow } from '../../shared/forest';
import { clippedWords, forestSentence } from '../../shared/forest_plot';
import type { Homogeneity, Num, Parameter, Result, Series, SharedAgreement } from '../../shared/result_types';
import { makeReport } from '../report';
import { forestRows } from './forest_rows';
import { beginning, elapsed, originWords, overlay } from './overlay';

const parameter = (estimate: Num, error: Num = null): Parameter =>
  ({
    estimate,
    std_error: error,
    text: `${estimate} ± ${error}`,
    interval95: estimate === null || error === null ? null : [estimate - 2 * error, estimate + 2 * error],
    unit: 's',
  }) as Parameter;

function agreement(runs: [Num, Num][], mean: Num = 2, agrees = true): SharedAgreement {
  return {
    unit: 's',
    agrees,
    random_effects: { mean, text: '2.0 ± 0.2', interval95: [1.5, 2.5] },
    recordings: runs.map(([estimate, std_error]) => ({ estimate, std_error, text: `${estimate} ± ${std_error}` })),
  };
}

const homogeneity = (more: Partial<Homogeneity> = {}): Homogeneity => ({
  agrees: true,
  outliers: [],
  parameters: { inertia: agreement([[1.9, 0.1], [2, 0.1], [2.2, 0.2]]) },
  ...more,
});

const rowsOf = (runs: [Num, Num][], joint?: Parameter, mean?: Num): ForestRow[] =>
  forestRows(homogeneity({ parameters: { inertia: agreement(runs, mean) } }), 'inertia', joint);

describe('the forest plot', () => {
  test('has each recording with ±1.96 errors, the joint estimate and the mean of random effects', () => {
    const rows = rowsOf([[1.9, 0.1], [2, 0.1], [null, null]], parameter(2, 0.05));
    expect(rows.map((row) => row.label)).toEqual([
      'recording 1',
      'recording 2',
      'recording 3',
      'joint fit',
      'random effects',
    ]);
    expect(rows[0].interval95![0]).toBeCloseTo(1.704, 12);
    expect(rows[2]).toMatchObject({ estimate: null, interval95: null });
    expect(rows[3]).toMatchObject({ estimate: 2, interval95: [1.9, 2.1] });
    expect(rows[4]).toMatchObject({ estimate: 2, interval95: [1.5, 2.5] });
    expect(forestSentence('moment of inertia', 's', rows)).toBe(
      'Forest plot of the moment of inertia in s: recording 1 1.9 ± 0.1, recording 2 2 ± 0.1, joint fit 2 ± 0.05 and random effects 2.0 ± 0.2.',
    );
  });

  test('marks an outlier at the parameters that differ', () => {
    const marks = (agrees: boolean): boolean[] => {
      const parameters = { inertia: agreement([[1.9, 0.1], [2, 0.1]], 2, agrees) };
      return forestRows(homogeneity({ outliers: [2], parameters }), 'inertia', undefined).map((row) => row.disagrees);
    };
    expect(marks(false)).toEqual([false, true, false]);
    expect(marks(true)).toEqual([false, false, false]);
  });

  test('shows intervals of similar length completely', () => {
    const rows = rowsOf([[1.9, 0.1], [2, 0.1], [2.2, 0.2]]);
    const [low, high] = forestRange(rows)!;
    expect(low).toBeLessThan(1.5);
    expect(high).toBeGreaterThan(2.592); // 2.2 + 1.96 0.2
    expect(clipped(rows, [low, high])).toEqual([]);
    expect(clippedWords(rows)).toBe('');
  });

  test('a recording with a very long interval does not hide the others', () => {
    const rows = rowsOf([[1.9, 0.01], [2, 0.01], [50, 100]]);
    const range = forestRange(rows)!;
    expect(range[1] - range[0]).toBeLessThan(2);
    expect(placeOf(rows[2], range)).toMatchObject({ at: null, cutLow: true, cutHigh: true, from: 0, to: 1 });
    expect(clippedWords(rows)).toBe(
      'The intervals of recording 3 and the random effects are longer than drawn (arrows); the table has them.',
    );
  });

  test('places are shares of the axis', () => {
    const [row] = rowsOf([[2, 1 / 1.96]]);
    const place = placeOf(row, [0, 4])!;
    expect([place.from, place.at, place.to].map((share) => share?.toFixed(6))).toEqual(['0.250000', '0.500000', '0.750000']);
    expect([place.cutLow, place.cutHigh]).toEqual([false, false]);
  });

  test('there is no plot without estimates, and estimates without errors are points', () => {
    expect(forestRange(rowsOf([[null, null]], undefined, null))).toBeNull();
    const points = rowsOf([[1, null], [3, null]]);
    const range = forestRange(points)!;
    expect(range[0]).toBeLessThan(1);
    expect(placeOf(points[0], range)).toMatchObject({ cutLow: false, cutHigh: false });
  });
});

describe('recordings in one plot', () => {
  const result = (): Result =>
    ({
      recordings: [0, 1, 2].map((k) => ({
        clock_scale: 1 + k,
        window_s: [k, 9],
        fits: [{ parameters: { release_time: parameter(0.5 + k, 0.01) }, identifiability: [] }],
      })),
      fits: [{ model: 'viscous', status: 'converged', parameters: {}, identifiability: [] }],
      warnings: [],
    }) as unknown as Result;

  const series = (unit: string): Series =>
    ({
      time_s: [0, 1, 2],
      measured: [0.1, 0.2, 0.3],
      unit,
      models: { viscous: { fitted: [0, 0, 0], residual: null, linear_closed_form: null, nonlinear_closed_form: null } },
    }) as unknown as Series;

  test('times are true seconds since the release, or since the start of the window', () => {
    const report = makeReport(result(), null, null);
    expect([...elapsed(Float64Array.of(1.5, 2.5), report.recordings[1])]).toEqual([0, 2]); // 1 s of this clock is 2 s
    expect(originWords(report.recordings)).toBe('time since the release [s]');
    delete report.recordings[2].fits[0].parameters.release_time;
    expect(beginning(report.recordings[2])).toEqual({ time: 2, released: false });
    expect(originWords(report.recordings)).toMatch(/release or first used sample/);
    expect(originWords(report.recordings.slice(2))).toBe('time since the first used sample [s]');
  });

  test('recordings with another unit are left out and listed', () => {
    const { curves, unit, others } = overlay(makeReport(result(), [series('rad'), series('V'), series('rad')], null));
    expect([curves.map((curve) => curve.k), unit, others]).toEqual([[0, 2], 'rad', [2]]);
    expect([...curves[0].measured.time]).toEqual([-0.5, 0.5, 1.5]);
    expect([...curves[0].residual!.values]).toEqual([0.1, 0.2, 0.3]);
    expect(curves[0].measured.mark.colour).not.toBe(curves[1].measured.mark.colour);
    expect(overlay(makeReport(result(), null, null)).curves).toEqual([]);
  });

  test('fits of one recording keep the clock of its file', () => {
    const report = makeReport(result(), [series('rad'), series('rad'), series('rad')], null);
    const { curves } = overlay({ ...report, oneClock: true }, 'fit');
    for (const curve of curves) expect([...curve.measured.time]).toEqual([0, 1, 2]);
  });
});
