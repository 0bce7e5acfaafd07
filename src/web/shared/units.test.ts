// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { inDegrees, symbolOf, unitText, withUnit, wordsOf } from './units';

describe('units', () => {
  test('powers are superscripts, and spaces do not break', () => {
    expect(unitText('kg m^2')).toBe('kg\u00a0m²');
    expect(unitText('N m s^2/rad^2')).toBe('N\u00a0m\u00a0s²/rad²');
    expect(unitText('1')).toBe('');
  });

  test('names have symbols, divided by G without a rig', () => {
    expect(symbolOf('coulomb', 'N m')).toBe('τ_c');
    expect(symbolOf('coulomb', '1')).toBe('τ_c/G');
    expect(symbolOf('inertia', 's^2')).toBe('I_O/G');
    expect(symbolOf('asymmetry', '1')).toBe('α');
    expect(symbolOf('new_term')).toBeNull();
    expect(wordsOf('new_term')).toBe('new_term');
  });

  test('only angles are converted to degrees', () => {
    expect(inDegrees('rad')?.factor).toBeCloseTo(57.29577951, 7);
    expect(inDegrees('N m')).toBeNull();
  });

  test('a key with any unit is found', () => {
    expect(withUnit({ rms_residual_rad_s: 0.1 }, 'rms_residual')).toEqual({ value: 0.1, unit: 'rad/s' });
    expect(withUnit({ rms_residual_rad: null }, 'rms_residual')).toBeNull();
    expect(withUnit(null, 'rms_residual')).toBeNull();
  });
});
