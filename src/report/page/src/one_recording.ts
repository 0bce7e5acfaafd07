// SPDX-License-Identifier: Apache-2.0
/** One recording of a joint fit after another, by the sections of a report of one recording. */

import { closedFormSection } from './closed_form_section';
import { constancySection } from './constancy_section';
import { choice, el, text } from './dom';
import { envelopeSection } from './envelope_section';
import { fitSection } from './fit_section';
import { recordingFile, type JointReport } from './joint';
import { refill } from './page';
import { phaseSection } from './phase_section';
import type { Report } from './report';
import { residualSection } from './residual_section';
import { section } from './section';
import { validationSection } from './validation_section';

const kSections: ((report: Report) => HTMLElement | null)[] = [
  fitSection,
  validationSection,
  envelopeSection,
  phaseSection,
  residualSection,
  constancySection,
  closedFormSection,
];

/** The sections of the recording that is shown, which their headings name. */
function sectionsOf({ recordings, recording }: JointReport): HTMLElement[] {
  const made = kSections.flatMap((make) => make(recordings[recording]) ?? []);
  for (const part of made) {
    part.querySelector('h2')?.append(el('span', { class: 'which' }, ` · recording ${recording + 1}`));
  }
  return made;
}

/** A choice of the recording and what there is of it; `changed` is called when another one is shown. */
export function oneRecordingPart(report: JointReport, changed: () => void): HTMLElement {
  const sections = el('div', {}, ...sectionsOf(report));
  const options = report.result.data.map((_data, k) => ({ value: String(k), label: String(k + 1) }));
  const name = el('p', { class: 'quiet', 'aria-live': 'polite' });
  const tell = (): void => {
    const number = report.recording;
    name.textContent = `Recording ${number + 1}: ${recordingFile(report.result, number)}.`;
  };
  tell();
  const chooser = choice('Recording shown', options, String(report.recording), (value) => {
    report.recording = Number(value);
    tell();
    refill(sections, sectionsOf(report));
    changed();
  });
  chooser.classList.add('recordings');
  const words = 'The sections below show one recording with its own start and zero, the shared parameters by the joint fit.';
  return el('div', {}, section('one', 'One recording in detail', text(words), chooser, name), sections);
}
