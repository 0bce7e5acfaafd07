// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import type { Fit, Parameter, Result } from '../shared/result_types';
import { equationText } from './equation';
import { headline } from './headline';
import { bestFit, lacksFit, rankOf } from './report';

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
  test('a failed fit is reported first', () => {
    const of = (status: string): string =>
      headline(resultOf([fitOf('coulomb', status)]), fitOf('coulomb', status)).level;
    expect(of('converged')).toBe('good');
    for (const status of ['not_converged', 'not_identifiable', 'failed']) expect(of(status)).toBe('bad');
    expect(headline(resultOf([]), null).title).toBe('No fit was made');
  });

  test('lack of fit is reported for the model that has it', () => {
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
});
