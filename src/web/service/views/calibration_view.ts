// SPDX-License-Identifier: Apache-2.0
/** Makes a calibration from readings at known angles. */

import { curveText } from '../../report/sections/provenance_section';
import { button, details, el, text } from '../../shared/dom';
import { numberText } from '../../shared/prose';
import { fixed, significant } from '../../shared/rounding';
import { save } from '../../shared/save';
import { section } from '../../shared/section';
import { scrollBox, table } from '../../shared/table';
import { unitText } from '../../shared/units';
import { labelOf } from '../flag_words';
import { numberField, numberIn, selectField } from '../forms/forms';
import { go } from '../router';
import { askJson, newKey } from '../server/api';
import type { Place, View } from '../shell';
import type { CalibrationAnswer } from '../types';
import { calibrationPlots } from './calibration_plots';
import { CalibrationTable } from './calibration_table';
import { alertPlace, attempt } from './problem_view';
import { useCalibration } from './start_view';

/** The potentiometer of the textbook. */
const kExample: [number, number][] = [
  [19, -45],
  [97, -30],
  [177, -15],
  [261, 0],
  [324, 15],
  [396, 30],
  [475, 45],
];

const kOrders: [string, string][] = [
  ['1', '1, a straight line'],
  ['2', '2'],
  ['3', '3'],
  ['4', '4'],
  ['5', '5'],
];

function coefficientTable({ coefficients }: CalibrationAnswer): HTMLElement {
  const rows = coefficients.map(({ name, text: value, unit }) => [name, `${numberText(value)} ${unitText(unit)}`]);
  return table(
    'Coefficients of the curve',
    [{ head: 'Coefficient' }, { head: 'Value ± standard error', kind: 'number' }],
    rows,
  );
}

function pointTable({ calibration, points }: CalibrationAnswer): HTMLElement {
  const unit = unitText(calibration.angle_unit);
  const number = 'number' as const;
  const heads = [`Angle [${unit}]`, `Curve [${unit}]`, `Residual [${unit}]`, `Left out [${unit}]`];
  const decimals = calibration.angle_unit === 'deg' ? 2 : 4;
  const rows = points.map((point) => [
    significant(point.reading, 6),
    ...[point.angle, point.fitted, point.residual, point.left_out].map((value) =>
      value === null ? '–' : fixed(value, decimals),
    ),
  ]);
  return table(
    'Points',
    [{ head: `Reading [${calibration.input}]` }, ...heads.map((head) => ({ head, kind: number }))],
    rows,
  );
}

/** How well the curve fits the points, in words. */
function quality({ calibration, leave_one_out_rms: rms }: CalibrationAnswer): string {
  const unit = calibration.angle_unit === 'deg' ? 'degrees' : calibration.angle_unit;
  const spread = calibration.residual_std_dev;
  const parts: string[] = [];
  if (typeof spread === 'number')
    parts.push(`The points scatter about the curve by ${significant(spread, 3)} ${unit}.`);
  if (rms !== null)
    parts.push(`A point that took no part is missed by ${significant(rms, 3)} ${unit} (root mean square).`);
  return parts.join(' ');
}

class CalibrationView {
  private readonly table = new CalibrationTable();
  private readonly reading = selectField('Readings in', [
    ['counts', 'counts of a converter'],
    ['volts', 'volts'],
  ]);
  private readonly angle = selectField('Angles in', [
    ['deg', 'degrees'],
    ['rad', 'radians'],
  ]);
  private readonly order = selectField(labelOf('order'), kOrders);
  private readonly bits = numberField(labelOf('bits'), 'If known: readings at its ends are then told apart.');
  private readonly problems = alertPlace();
  private readonly outcome = el('div', { class: 'report' });

  constructor(private readonly place: Place) {
    this.order.input.dataset.flag = 'order';
    this.bits.input.dataset.flag = 'bits';
    const units = (): void =>
      this.table.name(this.reading.input.value, this.angle.input.value === 'deg' ? 'degrees' : 'radians');
    for (const { input } of [this.reading, this.angle]) input.addEventListener('change', units);
  }

  private async calibrate(): Promise<void> {
    const lines = this.table.values().map(([reading, angle]) => `${reading},${angle}`);
    const body = [`${this.reading.input.value},angle_${this.angle.input.value}`, ...lines, ''].join('\n');
    const query = new URLSearchParams({ order: this.order.input.value });
    const bits = numberIn(this.bits.input, labelOf('bits'));
    if (bits !== null) query.set('bits', String(bits));
    const headers = { 'Content-Type': 'text/csv', 'Idempotency-Key': newKey() };
    const answer = await askJson<CalibrationAnswer>(`/v1/calibrations?${query}`, {
      method: 'POST',
      body,
      headers,
      signal: this.place.signal,
    });
    this.show(answer);
  }

  private show(answer: CalibrationAnswer): void {
    const json = `${JSON.stringify(answer.calibration, null, 2)}\n`;
    const use = (): void => {
      useCalibration('the calibration just made', json);
      go('/');
    };
    const result = section(
      'outcome',
      'The calibration',
      el('p', { class: 'equation' }, curveText(answer.calibration)),
      text(quality(answer)),
      el(
        'div',
        { class: 'actions' },
        button('Use it for the next fit', use, { class: 'primary' }),
        button('Download cal.json', () => save(new Blob([json], { type: 'application/json' }), 'cal.json')),
      ),
      calibrationPlots(answer),
      coefficientTable(answer),
      pointTable(answer),
      details('As calibrate_sensor prints it', () =>
        scrollBox('Calibration in text', el('pre', {}, el('code', {}, answer.text))),
      ),
    );
    this.outcome.replaceChildren(result);
    const heading = result.querySelector('h2');
    heading?.setAttribute('tabindex', '-1');
    heading?.focus();
  }

  make(): void {
    const fit = button('Calibrate', () => void attempt(fit, this.problems, () => this.calibrate()), {
      class: 'primary',
    });
    const example = button('Fill in the textbook’s table', () => this.table.fill(kExample));
    const settings = el('div', { class: 'fields' });
    for (const { element } of [this.reading, this.angle, this.order, this.bits]) settings.append(element);
    this.place.main.append(
      text(
        'A potentiometer gives counts or volts. Hold the pendulum at angles that you know, note what it reads, and type both in; two columns of a spreadsheet can be pasted into any field.',
        'lead',
      ),
      section(
        'readings',
        'Readings',
        settings,
        this.table.element,
        el('div', { class: 'actions' }, fit, example),
        this.problems,
      ),
      this.outcome,
    );
  }
}

export const calibrationView: View = (place) => {
  place.name('Calibration');
  new CalibrationView(place).make();
};
