// SPDX-License-Identifier: Apache-2.0
/** A field for the calibration table of a recording in counts or volts: chosen, dropped or pasted. */

import { button, el, text } from '../../shared/dom';
import { fileField, labelled } from './forms';
import type { ReadyCalibration } from './options_form';

/** Units of readings that need a calibration to become angles. */
export const kRawUnits = ['counts', 'volts', 'mv'];

const kTypes = '.csv,.txt,.tsv,.json,text/*';

export class CalibrationForm {
  readonly element = el('div', { class: 'calibration-form' });

  constructor(use: (calibration: ReadyCalibration) => void) {
    const file = fileField('Calibration: a table or a file', 'You can also drop the file here.', kTypes);
    const area = labelled(
      'Or paste the table',
      el('textarea', { rows: '4', spellcheck: 'false', autocomplete: 'off', placeholder: 'counts,angle_deg\n512,0\n600,18.5' }),
      'Two columns with their names: readings and angles.',
    );
    const problem = el('p', { class: 'absent', role: 'alert' });
    const take = async (chosen: File): Promise<void> => {
      problem.textContent = '';
      try {
        use({ name: chosen.name, json: await chosen.text() });
      } catch (error) {
        problem.textContent = `${chosen.name} could not be read (${String(error)}). Choose the file again.`;
      }
    };
    file.input.addEventListener('change', () => file.input.files?.[0] && void take(file.input.files[0]));
    const press = button('Use this table', () => {
      if (area.input.value.trim() !== '') use({ name: 'the pasted table', json: area.input.value });
    });
    this.element.append(
      text('These readings are not angles yet. A table of readings and angles turns them into degrees.', 'quiet'),
      file.element,
      problem,
      area.element,
      press,
    );
    this.element.addEventListener('drop', (event) => {
      const dropped = event.dataTransfer?.files[0];
      if (!dropped) return;
      event.preventDefault();
      event.stopPropagation(); // the page takes other files as recordings
      void take(dropped);
    });
  }
}
