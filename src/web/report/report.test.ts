// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import type { Result } from '../shared/result_types';
import { bestFit, isAliased, makeReport, recordingFile, shownFit, shownFitOf, warningsOf } from './report';

const result = {
  fits: [{ model: 'viscous' }, { model: 'coulomb' }, { model: 'drag' }],
  warnings: [
    { code: 'gaps', message: 'readings are missing', text: 'readings are missing', law: null },
    { code: 'lack_of_fit', message: 'viscous: the residuals', text: 'the residuals', law: 'viscous' },
    { code: 'at_bound', message: 'drag: at the bound 0: drag', text: 'at the bound 0: drag', law: 'drag' },
  ],
} as unknown as Result;

test('a law has its own warnings and those of the recording', () => {
  expect(warningsOf(result, 'drag').map(({ message }) => message)).toEqual(['readings are missing', 'at the bound 0: drag']);
  expect(warningsOf(result, 'coulomb').map(({ code }) => code)).toEqual(['gaps']);
});

test('the best fit is the recommended one, else the one with the smallest residuals that converged', () => {
  const fits = [
    { model: 'viscous', status: 'converged', statistics: { rms_residual_rad: 0.02 } },
    { model: 'coulomb', status: 'converged', statistics: { rms_residual_rad: 0.01 } },
    { model: 'stribeck', status: 'not_identifiable', statistics: { rms_residual_rad: 0.005 } },
  ];
  const of = (some: object[], recommended?: string) =>
    bestFit({ fits: some, comparison: recommended ? { recommended } : null } as unknown as Result);
  expect(of(fits, 'viscous')).toBe(0);
  expect(of(fits)).toBe(1);
  expect(of(fits.slice(2))).toBe(0);
  expect(of([])).toBe(-1);
});

const known = (parameter: string): object => ({ parameter, verdict: 'identifiable', direction: [], advice: null });

/** A result of recordings in these files. */
const resultOf = (...paths: string[]): Result =>
  ({
    recordings: paths.map((path, k) => ({
      path,
      release: k + 1,
      fits: ['viscous', 'drag'].map((model) => ({
        model,
        parameters: { release_time: { estimate: 0.5 + k } },
        identifiability: [known('release_time')],
        correlation: { names: ['inertia', 'release_time'] },
        noise: { lag1_correlation: 0.1 * k },
      })),
    })),
    fits: ['viscous', 'drag'].map((model) => ({
      model,
      status: 'converged',
      parameters: { inertia: { estimate: 2 } },
      identifiability: [known('inertia')],
      correlation: { names: ['inertia'] },
    })),
    warnings: [],
  }) as unknown as Result;

describe('recordings', () => {
  test('each has the shared parameters and its own', () => {
    const report = makeReport(resultOf('a.csv', 'b.csv'), null, null);
    const fit = shownFitOf(report.recordings[1])!;
    expect(Object.keys(fit.parameters)).toEqual(['inertia', 'release_time']);
    expect(fit.identifiability.map(({ parameter }) => parameter)).toEqual(['inertia', 'release_time']);
    expect([fit.parameters.release_time.estimate, fit.noise?.lag1_correlation]).toEqual([1.5, 0.1]);
    expect([fit.status, fit.correlation.names]).toEqual(['converged', ['inertia', 'release_time']]);
  });

  test('the fit of one has all parameters, that of several only the shared ones', () => {
    const names = (...paths: string[]) => Object.keys(shownFit(makeReport(resultOf(...paths), null, null))!.parameters);
    expect(names('a.csv')).toEqual(['inertia', 'release_time']);
    expect(names('a.csv', 'b.csv')).toEqual(['inertia']);
  });

  test('all show the same law', () => {
    const report = makeReport(resultOf('a.csv', 'b.csv'), null, null);
    report.shown = 1;
    expect([shownFit(report), ...report.recordings.map(shownFitOf)].map((fit) => fit?.model)).toEqual(['drag', 'drag', 'drag']);
  });

  test('without a fit there is none to show', () => {
    const report = makeReport({ ...resultOf('a.csv'), fits: [] }, null, null);
    expect([shownFit(report), shownFitOf(report.recordings[0])]).toEqual([null, null]);
  });

  test('the number of the free swing is shown for a file with several', () => {
    const files = (...paths: string[]) => makeReport(resultOf(...paths), null, null).recordings.map(recordingFile);
    expect(files('f/a.csv', 'f/b.csv')).toEqual(['a.csv', 'b.csv']);
    expect(files('f/a.csv', 'f/a.csv')).toEqual(['a.csv, free swing 1', 'a.csv, free swing 2']);
  });

  test('a warning about some recordings is not about the others', () => {
    const aliased = (recordings: number[]) => {
      const warnings = [{ code: 'aliased', recordings }] as unknown as Result['warnings'];
      return makeReport({ ...resultOf('a.csv', 'b.csv'), warnings }, null, null).recordings.map(isAliased);
    };
    expect(aliased([2])).toEqual([false, true]);
    expect(aliased([])).toEqual([true, true]);
  });
});
