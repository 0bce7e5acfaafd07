// SPDX-License-Identifier: Apache-2.0
/** Comparison of the fit with the textbook's closed forms. */

import { el } from '../../shared/dom';
import { sentence, typeset } from '../../shared/prose';
import type { ClosedFormRow, ClosedForms, Derived } from '../../shared/result_types';
import { fixed, plusMinus } from '../../shared/rounding';
import { absent, section } from '../../shared/section';
import { table, type Cell, type Column } from '../../shared/table';
import { unitText } from '../../shared/units';
import { quantityName, valueText } from '../parameters';
import { shownFitOf, type OneRecording } from '../report';

const kNames: Record<string, string> = {
  damping_ratio_log_decrement: 'damping ratio',
  inertia_small_angle: 'moment of inertia',
  viscous_log_decrement: 'viscous friction',
  inertia_elliptic_period: 'moment of inertia',
  inertia_geometry: 'moment of inertia',
  inertia_point_mass: 'moment of inertia',
  zero_angle_turning_points: 'zero of the sensor',
  inertia_turning_points: 'moment of inertia',
  viscous_turning_points: 'viscous friction',
  coulomb_turning_points: 'dry friction',
  drag_turning_points: 'air drag',
};

const verdict = (agrees: boolean | null): HTMLElement | string => {
  if (agrees === null) return '–';
  return agrees ? 'yes' : el('strong', { class: 'no' }, 'no');
};

function row(check: ClosedFormRow): Cell[] {
  const name = kNames[check.quantity] ?? check.quantity.replace(/_/g, ' ');
  const unit = unitText(check.unit);
  const z = check.z === null ? '–' : fixed(check.z, 1);
  return [
    [name + (unit === '' ? '' : ` [${unit}]`), el('small', {}, check.method)],
    plusMinus(check.closed_form, check.std_error),
    plusMinus(check.fit, check.fit_std_error),
    z,
    [verdict(check.agrees), check.reason !== null && el('small', { class: 'why' }, typeset(check.reason))],
  ];
}

/** Results from the turning points alone, for a report without a fit. */
function alone(forms: ClosedForms | null): HTMLElement | null {
  const isEstimate = (value: unknown): value is Derived =>
    typeof value === 'object' && value !== null && 'estimate' in value;
  const listed = (method: string, from: object | null | undefined): Cell[][] =>
    Object.entries(from ?? {}).flatMap(([name, value]: [string, unknown]) =>
      isEstimate(value)
        ? [[quantityName(name, value.unit), method, valueText(value.estimate, value.std_error, value.unit)]]
        : [],
    );
  const rows = [
    ...listed('log decrement, small angles', forms?.linear),
    ...listed('least squares over all turning points', forms?.decrement?.parameters),
  ];
  const columns: Column[] = [{ head: 'Quantity' }, { head: 'By' }, { head: 'Value ± standard error', kind: 'number' }];
  return rows.length > 0 ? table('Closed forms', columns, rows) : null;
}

export function closedFormSection(one: OneRecording): HTMLElement {
  const title = 'Checked against closed forms';
  const checks = shownFitOf(one)?.closed_form ?? [];
  if (checks.length === 0) {
    const why = one.data.reason ?? 'there is no fit to compare with';
    return section('closed-forms', 'Closed forms', absent(sentence(why)), alone(one.data.closed_forms));
  }
  const judged = checks.filter((check) => check.agrees !== null);
  const agreeing = judged.filter((check) => check.agrees).length;
  const columns: Column[] = [
    { head: 'Quantity, and by which formula' },
    { head: 'Closed form', kind: 'number' },
    { head: 'Fit', kind: 'number' },
    { head: 'z', kind: 'number' },
    { head: 'Agrees?' },
  ];
  const summary = `${agreeing} of ${judged.length} closed forms agree with the fit within 3 standard deviations of the difference (z).`;
  return section(
    'closed-forms',
    title,
    el('p', {}, summary),
    table('Closed forms beside the fit', columns, checks.map(row)),
  );
}
