// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { logTicks, roundTicks, tickTexts } from './axes';
import { equationText } from './equation';
import { headline } from './headline';
import { sentence, typeset } from './prose';
import { bestFit, fileName, lacksFit, rankOf } from './report';
import { rootMeanSquare, toArray, toSamples } from './samples';
import { TimeView } from './time_view';
import type { Fit, Parameter, Result, Series } from './types';
import { inDegrees, symbolOf, unitText, withUnit, wordsOf } from './units';

describe('units', () => {
  test('powers are raised and words kept together', () => {
    expect(unitText('kg m^2')).toBe('kg\u00a0m²');
    expect(unitText('N m s^2/rad^2')).toBe('N\u00a0m\u00a0s²/rad²');
    expect(unitText('1')).toBe('');
  });

  test('symbols are those of the names, over G without a rig', () => {
    expect(symbolOf('coulomb', 'N m')).toBe('τ_c');
    expect(symbolOf('coulomb', '1')).toBe('τ_c/G');
    expect(symbolOf('inertia', 's^2')).toBe('I_O/G');
    expect(symbolOf('asymmetry', '1')).toBe('α');
    expect(symbolOf('new_term')).toBeNull();
    expect(wordsOf('new_term')).toBe('new_term');
  });

  test('angles have degrees beside them, other quantities not', () => {
    expect(inDegrees('rad')?.factor).toBeCloseTo(57.29577951, 7);
    expect(inDegrees('N m')).toBeNull();
  });

  test('a key with its unit is found, whatever the unit', () => {
    expect(withUnit({ rms_residual_rad_s: 0.1 }, 'rms_residual')).toEqual({ value: 0.1, unit: 'rad/s' });
    expect(withUnit({ rms_residual_rad: null }, 'rms_residual')).toBeNull();
    expect(withUnit(null, 'rms_residual')).toBeNull();
  });
});

test('sentences are set for the eye', () => {
  expect(typeset('p 4.1e-26, 0.00126 kg m^2, 1e+06 and e2e')).toBe('p 4.1 × 10⁻²⁶, 0.00126 kg m², 1 × 10⁶ and e2e');
  expect(sentence('the fit failed')).toBe('The fit failed.');
  expect(sentence('')).toBe('');
});

describe('null in the JSON', () => {
  test('samples: null is NaN, another length is none', () => {
    expect([...toArray([1, null, 3], 3)!]).toEqual([1, NaN, 3]);
    expect(toArray([1], 2)).toBeNull();
    expect(toArray(null, 2)).toBeNull();
    expect(rootMeanSquare(Float64Array.of(3, NaN, 4))).toBeCloseTo(Math.sqrt(12.5), 12);
  });

  test('no series, and one without fits', () => {
    expect(toSamples(null)).toBeNull();
    const series = {
      time_s: [0, 1],
      measured: [null, 1],
      unit: 'rad',
      models: { a: { fitted: null } },
    } as unknown as Series;
    expect(toSamples(series)?.models.get('a')?.fitted).toBeNull();
  });
});

const parameter = (estimate: number, error: number | null = null): Parameter =>
  ({ estimate, std_error: error, unit: 'x' }) as Parameter;

function fitOf(model: string, status: string): Fit {
  return {
    model,
    status,
    reason: 'so it is',
    parameters: { inertia: parameter(0.079, 2.8e-6) },
    derived: {},
  } as unknown as Fit;
}

function resultOf(fits: Fit[], more: Partial<Result> = {}): Result {
  return { fits, warnings: [], ...more } as unknown as Result;
}

describe('the verdict', () => {
  test('what is wrong comes first', () => {
    const of = (status: string): string =>
      headline(resultOf([fitOf('coulomb', status)]), fitOf('coulomb', status)).level;
    expect(of('converged')).toBe('good');
    for (const status of ['not_converged', 'not_identifiable', 'failed']) expect(of(status)).toBe('bad');
    expect(headline(resultOf([]), null).title).toBe('No fit was made');
  });

  test('lack of fit is told of the model that lacks it', () => {
    const [one, two] = [fitOf('viscous', 'converged'), fitOf('coulomb', 'converged')];
    const warnings = [{ code: 'lack_of_fit', message: 'm' }];
    expect(headline(resultOf([one], { warnings }), one).title).toMatch(/^Lack of fit: viscous/);
    const rows = [
      { model: 'viscous', lack_of_fit: true },
      { model: 'coulomb', lack_of_fit: false },
    ];
    const comparison = { recommended: 'coulomb', rows } as unknown as Result['comparison'];
    const result = resultOf([one, two], { warnings, comparison });
    expect([lacksFit(result, one), lacksFit(result, two)]).toEqual([true, false]);
    expect(headline(resultOf([one, two], { warnings }), one).level).toBe('caution');
  });

  test('the recommended fit is shown, else the first that converged', () => {
    const fits = [fitOf('viscous', 'failed'), fitOf('coulomb', 'converged'), fitOf('drag', 'converged')];
    expect(bestFit(resultOf(fits))).toBe(1);
    const result = resultOf(fits, { comparison: { recommended: 'drag', rows: [] } as unknown as Result['comparison'] });
    expect(bestFit(result)).toBe(2);
    expect(fits.map((_fit, i) => rankOf(result, i))).toEqual([1, 2, 0]);
    expect(bestFit(resultOf([]))).toBe(-1);
  });

  test('the equation has its numbers', () => {
    const fit = fitOf('stribeck', 'converged');
    fit.equation = "0.079 th'' + 0.003 th' + (0.004 + (0.008 - 0.004) exp(-(th'/0.4)^2)) sgn(th') + 1.8 sin th = 0";
    expect(equationText(fit)).toBe('0.079 θ″ + 0.003 θ′ + (0.004 + (0.008 − 0.004) exp(-(θ′/0.4)²)) sgn(θ′) + 1.8 sin θ = 0');
    fit.equation = null;
    expect(equationText(fit)).toBeNull();
  });

  test('names of files without their folders', () => {
    expect(fileName('a/b/run.csv')).toBe('run.csv');
    expect(fileName('C:\\a\\run.csv')).toBe('run.csv');
    expect(fileName(null)).toBe('recording without a name');
  });
});

describe('ticks', () => {
  test('have decimals enough, and all the same', () => {
    expect(tickTexts([0, 0.05, 0.1], 0.05)).toEqual(['0.00', '0.05', '0.10']);
    expect(tickTexts([-1, 0, 1], 1)).toEqual(['−1', '0', '1']);
    expect(tickTexts([0, 2e-6], 2e-6)).toEqual(['0', '2 × 10⁻⁶']);
  });

  test('of a logarithmic axis are 1, 2, 5', () => {
    expect(logTicks(0.03, 0.6).map((tick) => Number(tick.toPrecision(3)))).toEqual([0.05, 0.1, 0.2, 0.5]);
    expect(logTicks(0, 1)).toEqual([]);
    expect(roundTicks(-24, 24).map((tick) => tick + 0)).toEqual([-20, -10, 0, 10, 20]);
  });
});

describe('the range of times', () => {
  test('zooms about a point, stays inside, and is told to all', () => {
    const view = new TimeView(0, 20, 0.1);
    let told = 0;
    view.onChange(() => ++told);
    view.zoom(0.5, 0);
    expect(view.current).toEqual([0, 10]);
    view.pan(2);
    expect(view.current).toEqual([10, 20]);
    view.zoom(1e-9);
    expect(view.current[1] - view.current[0]).toBeCloseTo(0.1, 12);
    view.set(-5, 5);
    expect(view.current).toEqual([0, 10]);
    view.reset();
    expect([view.whole, told]).toEqual([true, 5]);
  });
});
