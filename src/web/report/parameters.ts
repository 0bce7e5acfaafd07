// SPDX-License-Identifier: Apache-2.0
/** Tables of parameters with their errors and units. */

import { el, symbolElement, text, type Child } from '../shared/dom';
import { typeset } from '../shared/prose';
import type { Fit, Parameter } from '../shared/result_types';
import { errorText, intervalText, plusMinus } from '../shared/rounding';
import { section } from '../shared/section';
import { table, type Cell, type Column } from '../shared/table';
import { inDegrees, spacedUnit, symbolOf, unitText, wordsOf } from '../shared/units';
import { sourcesOf } from './budget';

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

/** Statistical and systematic error together; the statistical error alone where nothing systematic is known. */
export const totalError = (parameter: Parameter): number | null => parameter.total_std_error ?? parameter.std_error;

/** Value and total error. */
export function valueCell(parameter: Parameter): Cell {
  const { estimate, unit } = parameter;
  const error = totalError(parameter);
  const degrees = degreesText(estimate, error, unit);
  return [valueText(estimate, error, unit), degrees !== null && el('small', {}, degrees)];
}

function intervalCell({ std_error: error, interval95: interval, unit }: Parameter): Cell {
  const degrees = inDegrees(unit);
  const inOther =
    degrees && interval
      ? `(${intervalText(
          [scale(interval[0], degrees.factor), scale(interval[1], degrees.factor)],
          scale(error, degrees.factor),
        )}${degrees.unit})`
      : null;
  return [intervalText(interval, error), inOther !== null && el('small', {}, inOther)];
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
    { head: systematic ? 'Value ± total error' : 'Value ± standard error', kind: 'number' },
    { head: systematic ? '95 % interval, noise alone' : '95 % interval', kind: 'number' },
  ];
  if (notes) columns.push({ head: 'Note' });
  const cells = rows.map(([name, parameter]) => {
    const row: Cell[] = [quantityName(name, parameter.unit), valueCell(parameter), intervalCell(parameter)];
    if (notes) row.push(typeset(noteOf(parameter)));
    return row;
  });
  return table(`Parameters of ${fit.model}`, columns, cells);
}

/** Standard errors by source; null if all errors come from noise. */
function budgetTable(fit: Fit): HTMLElement | null {
  const sources = sourcesOf(fit);
  if (sources.every(({ key }) => key === 'noise')) return null;
  const number = 'number' as const;
  const columns: Column[] = [
    { head: 'Error budget' },
    ...sources.map(({ words }) => ({ head: `± ${words}`, kind: number })),
    { head: '± total', kind: number },
  ];
  const rows = Object.entries(fit.parameters).map(([name, parameter]): Cell[] => {
    const { estimate, unit, error_budget: budget } = parameter;
    const total = totalError(parameter);
    const cell = (error: number | null | undefined): Cell => (error ? errorText(error, estimate, total) : '–');
    const inUnit = unitText(unit) === '' ? '' : ` [${unitText(unit)}]`;
    return [`${wordsOf(name)}${inUnit}`, ...sources.map(({ key }) => cell(budget?.[key])), cell(total)];
  });
  return table('Standard errors by source, added in squares to the total', columns, rows);
}

function derivedTable(fit: Fit): HTMLElement | null {
  const rows = Object.entries(fit.derived);
  if (rows.length === 0) return null;
  const systematic = rows.some(([, derived]) => derived.systematic_std_error !== undefined);
  const number = 'number' as const;
  const columns: Column[] = [
    { head: 'Derived quantity' },
    { head: systematic ? 'Value ± total error' : 'Value ± standard error', kind: number },
    { head: systematic ? '95 % interval, noise alone' : '95 % interval', kind: number },
  ];
  return table(
    'Computed from the parameters',
    columns,
    rows.map(([name, derived]) => {
      const { estimate, std_error: error, systematic_std_error: more = 0, interval95: interval, unit } = derived;
      const total = error === null ? null : Math.hypot(error, more);
      return [quantityName(name), valueText(estimate, total, unit), intervalText(interval, error)];
    }),
  );
}

/** Parameters that are not identifiable, and what to measure instead. */
function advice(fit: Fit, heading: string): HTMLElement | null {
  const open = fit.identifiability.filter((known) => known.verdict !== 'identifiable');
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
        ? 'A free swing determines only ratios to the stiffness k of the spring (for a pendulum at small angles: to the gravity torque G). Inertia and torques are therefore in units of k. A rig with a known stiffness gives SI units.'
        : 'A free swing determines only ratios to the gravity torque G. Inertia and torques are therefore in units of G. A rig with known masses and length gives SI units.',
    );
  return text(typeset(parts.join(' ')), 'quiet');
}

/**
 * Tables of the parameters and of the derived quantities. `adviceHeading` stands above the list of parameters that are
 * not identifiable.
 */
function parameterPart(fit: Fit, adviceHeading = 'What the recording does not determine'): HTMLElement {
  return el(
    'div',
    {},
    parameterTable(fit),
    budgetTable(fit),
    derivedTable(fit),
    advice(fit, adviceHeading),
    methods(fit),
  );
}

/** All parameters, their errors by source, and derived quantities; null without a fit. */
export function parameterSection(fit: Fit | null, adviceHeading?: string): HTMLElement | null {
  if (!fit || Object.keys(fit.parameters).length === 0) return null;
  return section('parameters', 'Parameters and their errors', parameterPart(fit, adviceHeading));
}
