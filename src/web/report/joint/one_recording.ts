// SPDX-License-Identifier: Apache-2.0
/** The recordings of a joint fit one at a time, with the sections of a report of one recording. */

import { choice, el, text } from '../../shared/dom';
import { refill } from '../../shared/page';
import { section } from '../../shared/section';
import { recordingFile, type OneRecording, type Report } from '../report';
import { constancySection } from '../sections/constancy_section';
import { envelopeSection } from '../sections/envelope_section';
import { fitSection } from '../sections/fit_section';
import { phaseSection } from '../sections/phase_section';
import { residualSection } from '../sections/residual_section';
import { validationSection } from '../sections/validation_section';
import { toldPart } from '../told';

const kSections: ((one: OneRecording) => HTMLElement | null)[] = [
  fitSection,
  validationSection,
  envelopeSection,
  phaseSection,
  residualSection,
  constancySection,
  ({ report }) => toldPart(report, 'closed-forms', 'Closed forms'),
  ({ report }) => toldPart(report, 'data', 'Data'),
];

/** The sections of the recording that is shown. Their headings have its number. */
function sectionsOf({ recordings, recording }: Report): HTMLElement[] {
  const made = kSections.flatMap((make) => make(recordings[recording]) ?? []);
  for (const part of made) {
    part.querySelector('h2')?.append(el('span', { class: 'which' }, ` · recording ${recording + 1}`));
  }
  return made;
}

/** Radio buttons for the recordings, and the sections of the chosen one. `changed` is called after a choice. */
export function oneRecordingPart(report: Report, changed: () => void): HTMLElement {
  const sections = el('div', {}, ...sectionsOf(report));
  const options = report.recordings.map(({ number }, k) => ({ value: String(k), label: String(number) }));
  const name = el('p', { class: 'quiet', 'aria-live': 'polite' });
  const tell = (): void => {
    const one = report.recordings[report.recording];
    name.textContent = `Recording ${one.number}: ${recordingFile(one)}.`;
  };
  tell();
  const chooser = choice('Recording shown', options, String(report.recording), (value) => {
    report.recording = Number(value);
    tell();
    refill(sections, sectionsOf(report));
    changed();
  });
  chooser.classList.add('recordings');
  const words = 'The sections below show one recording: its own start and zero, and the shared parameters of the joint fit.';
  return el('div', {}, section('one', 'One recording in detail', text(words), chooser, name), sections);
}
