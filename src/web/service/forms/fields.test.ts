// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test, vi } from 'vitest';

import { kept, keep } from '../../shared/kept';
import { flagsIn, helpOf, inFields, labelOf, labelWithUnit, nameModels, optionsOf, setFlags, type Options } from '../flag_words';
import { FieldError, ProblemError, problemOf, titleOf } from '../server/problem';
import { forgetRecording, heldRecording, holdRecording, kMostKept } from './held_recording';
import { asFieldError } from './problem_fields';

const flag = (name: string, label: string, unit = '', words: Options = []) => {
  const help = `What it is; default --from.`;
  return { name, label, help, unit, type: 'string' as const, default: '', words };
};
setFlags([
  flag('from', 'From', 's'),
  flag('to', 'To', 's'),
  flag('time_column', 'Column of times'),
  flag('sample_rate_hz', 'Samples per second'),
  flag('unit', 'Unit of the values', '', [['deg', 'degrees']]),
  flag('noise', 'Noise of the sensor', '', [['quantized', 'rounding']]),
  flag('calibration', 'Calibration file'),
  flag('model', 'Kind of friction'),
]);

describe('labels and help of fields', () => {
  test('have the unit of a number, and labels instead of flags', () => {
    expect([labelWithUnit('from'), labelWithUnit('unit')]).toEqual(['From [s]', 'Unit of the values']);
    expect(helpOf('to')).toBe('What it is; default “From”.');
    expect([labelOf('bits'), labelOf('new'), helpOf('new')]).toEqual(['Bits of the converter', 'new', '']);
  });
});

describe('flags in sentences', () => {
  test('become the labels of their fields', () => {
    expect(inFields('--from 9 s is not before --to 3 s')).toBe('“From” 9 s is not before “To” 3 s');
    expect(inFields('give --time_column or --sample_rate_hz and --unit')).toBe(
      `give “${labelOf('time_column')}” or “${labelOf('sample_rate_hz')}” and “${labelOf('unit')}”`,
    );
    expect(inFields('slow (look at --residuals, try another model)')).toBe(
      'slow (look at “Are the residuals noise?”, try another model)',
    );
  });

  test('have the labels of their options as values', () => {
    const [, words] = optionsOf('noise').find(([value]) => value === 'quantized')!;
    expect(inFields('use --noise quantized')).toBe(`use “${labelOf('noise')}: ${words}”`);
    expect(inFields('; --model linear describes')).toBe('; “Kind of friction” linear describes');
    nameModels([{ name: 'linear', label: 'small angles' }]);
    expect(inFields('; use --model linear for this recording')).toBe(
      '; use “Kind of friction: small angles” for this recording',
    );
    expect(inFields('--model linear,drag is')).toBe('“Kind of friction” linear,drag is');
  });

  test('without a field stay unchanged, as other words do', () => {
    for (const words of ['widen --bounds', 'start with --token_file', 'a - b -- c', '--constructor x', 'leave it out'])
      expect(inFields(words)).toBe(words);
  });

  test('are "left empty" instead of "left out"', () => {
    expect(inFields('--unit deg contradicts it; leave the flag out')).toBe(
      '“Unit of the values: degrees” contradicts it; leave that field empty',
    );
    expect(inFields('the values are angles; leave --calibration out')).toMatch(/; leave “Calibration file” empty$/);
    expect(flagsIn('--from and --to')).toEqual(['from', 'to']);
  });
});

const problem = (detail: string, code: string): ProblemError =>
  new ProblemError({ title: 'No', status: 422, detail, code });

/** A form with fields for these selectors; the label of a field is its selector. */
const fields =
  (...selectors: string[]) =>
  (selector: string): HTMLElement | null =>
    selectors.includes(selector) ? ({ dataset: { what: selector } } as unknown as HTMLElement) : null;

describe('problems of fields', () => {
  test('of a rig name the field instead of the file', () => {
    const error = problem('rig.json: "rod_length" is -0.43; it must be positive', 'unusable_data');
    const told = asFieldError(error, fields('[data-rig="rod_length"]')) as FieldError;
    expect(told).toBeInstanceOf(FieldError);
    expect(told.message).toBe('“[data-rig="rod_length"]” is -0.43; it must be positive.');
    expect(asFieldError(error, fields())).toBe(error);
    const ofFile = asFieldError(error, fields('[data-rig="file"]')) as FieldError;
    expect(ofFile.message).toBe('The rig: "rod_length" is -0.43; it must be positive.');
  });

  test('of a standard deviation name the quantity', () => {
    const error = problem('rig: "std_dev" of "bob_mass" is -1; it must be 0 or more', 'unusable_data');
    const told = asFieldError(error, fields('[data-rig="std_dev of bob_mass"]', '[data-rig="bob_mass"]')) as FieldError;
    expect(told.field.dataset.what).toBe('[data-rig="std_dev of bob_mass"]');
  });

  test('of flags belong to all their fields', () => {
    const find = fields('[data-flag="from"]', '[data-flag="to"]');
    const told = asFieldError(problem('--from 9 s is not before --to 3 s', 'bad_request'), find) as FieldError;
    expect(told.message).toBe('“From” 9 s is not before “To” 3 s.');
    expect([told.field, ...told.others]).toHaveLength(2);
    const noSwing = problem('no swing; choose a window with --from and --to', 'no_swing');
    expect(asFieldError(noSwing, find)).toBe(noSwing);
    expect(problemOf(told).title).toMatch(/missing or wrong/);
  });

  test('of an address have a title that is English', () => {
    expect(titleOf(problem('no fit x', 'not_found').problem)).toBe('There is nothing at this address');
    expect(titleOf(problem('x', 'no_swing').problem)).toBe('No');
  });
});

describe('recordings of the start page', () => {
  const storeWith = (): void => {
    const stored = new Map<string, string>();
    vi.stubGlobal('sessionStorage', {
      getItem: (name: string) => stored.get(name) ?? null,
      setItem: (name: string, words: string) => stored.set(name, words),
      removeItem: (name: string) => stored.delete(name),
    });
  };

  test('are kept byte for byte, whether they are text or not', async () => {
    storeWith();
    for (const bytes of [new TextEncoder().encode('\ufefft,Winkel °\r\n0,1'), Uint8Array.of(80, 75, 3, 4, 0, 255, 254)]) {
      expect(await holdRecording({ name: 'a.csv', content: new Blob([bytes]) })).toBe(true);
      const held = heldRecording();
      expect(held?.name).toBe('a.csv');
      expect(new Uint8Array(await held!.content.arrayBuffer())).toEqual(bytes);
    }
    forgetRecording();
    expect(heldRecording()).toBeNull();
    vi.unstubAllGlobals();
  });

  test('are not kept if they are too large, and the one before is forgotten', async () => {
    storeWith();
    await holdRecording({ name: 'a.csv', content: new Blob(['0,1']) });
    expect(await holdRecording({ name: 'b.csv', content: new Blob(['1'.repeat(kMostKept + 1)]) })).toBe(false);
    expect(heldRecording()).toBeNull();
    vi.unstubAllGlobals();
  });
});

describe('pasted recordings', () => {
  test('are kept if the browser allows it, and no error occurs if not', () => {
    const refuse = (): never => {
      throw new DOMException('no', 'SecurityError');
    };
    vi.stubGlobal('sessionStorage', { getItem: refuse, setItem: refuse, removeItem: refuse });
    keep('closed', 'x', 'y');
    expect(kept('closed', 'x')).toBeNull();
    const stored = new Map<string, string>();
    const getItem = (name: string): string | null => stored.get(name) ?? null;
    const setItem = (name: string, words: string): void => {
      if (words.length > 3) throw new DOMException('no room', 'QuotaExceededError');
      stored.set(name, words);
    };
    vi.stubGlobal('sessionStorage', { getItem, setItem, removeItem: (name: string) => stored.delete(name) });
    keep('closed', 'x', 'y');
    expect(kept('closed', 'x')).toBe('y');
    keep('closed', 'x', 'too long');
    expect(kept('closed', 'x')).toBeNull(); // not the previous text
    vi.unstubAllGlobals();
  });
});
