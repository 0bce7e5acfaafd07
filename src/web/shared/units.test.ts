// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test, vi } from 'vitest';

import { inDegrees, symbolOf, unitText, withUnit, wordsOf } from './units';

// As in a page that the program wrote.
vi.stubGlobal('document', { getElementById: () => ({ textContent: '{"inertia": {"symbol": "I_O", "words": "moment of inertia", "unit_over_g": "s^2"}, "coulomb": {"symbol": "τ_c", "words": "dry friction", "unit_over_g": "1"}, "asymmetry": {"symbol": "α", "words": "asymmetry of friction"}, "zero_drift": {"symbol": "z\'", "words": ""}}' }) });

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
    expect(symbolOf('zero_drift', 'rad/s')).toBe('z′');
    expect(symbolOf('new_term')).toBeNull();
    expect(wordsOf('inertia')).toBe('moment of inertia');
    expect(wordsOf('zero_drift')).toBe('zero_drift');
    expect(wordsOf('new_term')).toBe('new_term');
  });

  test('only angles are converted to degrees', () => {
    expect(inDegrees('rad')?.factor).toBeCloseTo(57.29577951, 7);
    expect(inDegrees('N m')).toBeNull();
  });

  test('a key with any unit is found', () => {
    expect(withUnit({ rms_residual_rad_s: 0.1 }, 'rms_residual')).toBe(0.1);
    expect(withUnit({ rms_residual_rad: null }, 'rms_residual')).toBeUndefined();
    expect(withUnit({ sigma_std_error: 1, sigma_rad: 2 }, 'sigma')).toBe(2);
  });
});
