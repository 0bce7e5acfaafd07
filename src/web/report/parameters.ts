// SPDX-License-Identifier: Apache-2.0
/** Tables of parameters with their errors and units. */

import { el, symbolElement, text, type Child } from '../shared/dom';
import { keyFigure } from '../shared/key_figure';
import { typeset } from '../shared/prose';
import type { Fit, Parameter } from '../shared/result_types';
import { errorText, intervalText, plusMinus } from '../shared/rounding';
import { table, type Cell, type Column } from '../shared/table';
import { inDegrees, spacedUnit, symbolOf, wordsOf } from '../shared/units';

/** Parameters of the start and of the sensor. All others are properties of the pendulum. */
export const kCircumstances = new Set([
  'release_angle',
  'release_time',
  'initial_angle',
  'initial_rate',
  'zero_angle',
  'rate_bias',
  'zero_drift',
  'bias_drift',
  'rate_scale',
  'acceleration_bias',
  'acceleration_scale',
  'axis',
  'radius',
  'pivot_x',
  'pivot_y',
  'hysteresis',
]);

/** Name in words, symbol, and the name in flags and JSON. */
export function quantityName(name: string, unit = ''): Child[] {
  const symbol = symbolOf(name, unit);
  const words = wordsOf(name);
  return [
    words,
    symbol !== null && ' ',
    symbol !== null && symbolElement(symbol),
    words !== name && el('code', {}, name),
  ];
}

const scale = (x: number | null, factor: number): number | null => (x === null ? null : factor * x);

/** "0.4229 ± 0.0002 rad" */
export function valueText(value: number | null, error: number | null, unit: string): string {
  return plusMinus(value, error) + (value === null ? '' : spacedUnit(unit));
}

function degreesText(value: number | null, error: number | null, unit: string): string | null {
  const degrees = inDegrees(unit);
  if (!degrees || value === null) return null;
  const both = plusMinus(scale(value, degrees.factor), scale(error, degrees.factor));
  return both.includes('±')
    ? `(${both.replace(/^\((.*)\)( ×.*)$/, '$1$2')})${degrees.unit}`
    : `(${both}${degrees.unit})`;
}

export function valueCell({ estimate, std_error: error, unit }: Parameter): Cell {
  const degrees = degreesText(estimate, error, unit);
  return [valueText(estimate, error, unit), degrees !== null && el('small', {}, degrees)];
}

function intervalCell({ estimate, std_error: error, interval95: interval, unit }: Parameter): Cell {
  const degrees = inDegrees(unit);
  const inOther =
    degrees && interval
      ? `(${intervalText(
          [scale(interval[0], degrees.factor), scale(interval[1], degrees.factor)],
          scale(estimate, degrees.factor),
          scale(error, degrees.factor),
        )}${degrees.unit})`
      : null;
  return [intervalText(interval, estimate, error), inOther !== null && el('small', {}, inOther)];
}

/** Why an error or interval is missing, in words; empty if nothing is missing. */
export function noteOf(parameter: Parameter): string {
  const state = parameter.fixed ? 'held fixed' : parameter.at_bound ? 'at its bound' : '';
  const reason = parameter.reason ?? '';
  if (state === '' || reason === '') return state || reason;
  return reason.startsWith(state) ? reason : `${state}: ${reason}`;
}

function parameterTable(fit: Fit): HTMLElement {
  const rows = Object.entries(fit.parameters);
  const systematic = rows.some(([, parameter]) => parameter.systematic_std_error !== null);
  const notes = rows.some(([, parameter]) => noteOf(parameter) !== '');
  const columns: Column[] = [
    { head: 'Parameter' },
    { head: 'Value ± standard error', kind: 'number' },
    { head: '95 % interval', kind: 'number' },
  ];
  if (systematic) columns.push({ head: '± systematic', kind: 'number' });
  if (notes) columns.push({ head: 'Note' });
  const cells = rows.map(([name, parameter]) => {
    const row: Cell[] = [quantityName(name, parameter.unit), valueCell(parameter), intervalCell(parameter)];
    if (systematic) row.push(errorText(parameter.systematic_std_error, parameter.estimate, parameter.std_error));
    if (notes) row.push(typeset(noteOf(parameter)));
    return row;
  });
  return table(`Parameters of ${fit.model}`, columns, cells);
}

function derivedTable(fit: Fit): HTMLElement | null {
  const rows = Object.entries(fit.derived ?? {});
  if (rows.length === 0) return null;
  const columns: Column[] = [
    { head: 'Derived quantity' },
    { head: 'Value ± standard error', kind: 'number' },
    { head: '95 % interval', kind: 'number' },
  ];
  const systematic = rows.some(([, derived]) => derived.systematic_std_error !== undefined);
  if (systematic) columns.push({ head: '± systematic', kind: 'number' });
  return table(
    'Computed from the parameters',
    columns,
    rows.map(([name, derived]) => {
      const error = derived.systematic_std_error ?? null;
      const cells: Cell[] = [
        quantityName(name),
        valueText(derived.estimate, derived.std_error, derived.unit),
        intervalText(derived.interval95, derived.estimate, derived.std_error),
      ];
      if (systematic) cells.push(errorText(error, derived.estimate, derived.std_error));
      return cells;
    }),
  );
}

/** Parameters that are not identifiable, and what to measure instead. */
function advice(fit: Fit, heading: string): HTMLElement | null {
  const open = (fit.identifiability ?? []).filter((known) => known.verdict !== 'identifiable');
  if (open.length === 0) return null;
  const list = el('ul');
  for (const known of open) {
    const together = known.direction.length > 1 ? `, in the combination of ${known.direction.join(', ')}` : '';
    const what = `${wordsOf(known.parameter)}: ${known.verdict}${together}${known.advice ? `; ${known.advice}` : ''}.`;
    list.append(el('li', {}, typeset(what)));
  }
  return el('div', {}, el('h3', {}, heading), list);
}

function methods(fit: Fit): HTMLElement | null {
  const parts: string[] = [];
  if (fit.std_error_method) parts.push(`Standard errors: ${fit.std_error_method}.`);
  if (fit.interval_method) parts.push(`95 % intervals: ${fit.interval_method}.`);
  if (parts.length === 0) parts.push('There are no standard errors.');
  const overG = fit.parameters.inertia?.unit === 's^2';
  if (overG)
    parts.push(
      fit.model.startsWith('linear')
        ? 'A free swing determines only ratios to the stiffness k of the spring (for a pendulum at small angles, to the gravity torque G): inertia and torques are in units of it, unless a rig gives it.'
        : 'A free swing determines only ratios to the gravity torque G: inertia and torques are in units of G, unless a rig gives it.',
    );
  return text(typeset(parts.join(' ')), 'quiet');
}

/**
 * Tables of the parameters and of the derived quantities. `adviceHeading` stands above the list of parameters that are
 * not identifiable.
 */
export function parameterPart(fit: Fit, adviceHeading = 'What the recording does not determine'): HTMLElement {
  const part = el('div', {}, parameterTable(fit));
  for (const more of [methods(fit), advice(fit, adviceHeading), derivedTable(fit)]) if (more) part.append(more);
  return part;
}

const smallText = (words: string | null): Child => words !== null && el('small', {}, words);

/** The parameters of the pendulum in large figures. `remark` returns an additional line for a parameter. */
export function keyFigures(fit: Fit, remark: (name: string) => string | null = () => null): HTMLElement {
  const box = el('div', { class: 'figures' });
  for (const [name, parameter] of Object.entries(fit.parameters)) {
    if (kCircumstances.has(name)) continue;
    const symbol = symbolOf(name, parameter.unit);
    const note =
      noteOf(parameter) === '' ? null : parameter.fixed ? 'held fixed' : parameter.at_bound ? 'at its bound' : null;
    const figure = keyFigure(
      [wordsOf(name), symbol !== null && ' ', symbol !== null && symbolElement(symbol)],
      plusMinus(parameter.estimate, parameter.std_error),
      [spacedUnit(parameter.unit).trim() || 'a pure number', note !== null && ` · ${note}`],
      smallText(remark(name)),
    );
    figure.dataset.parameter = name;
    box.append(figure);
  }
  return box;
}
