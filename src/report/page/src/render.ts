// SPDX-License-Identifier: Apache-2.0
/** The whole report from the result, with or without its samples. */

import { closedFormSection } from './closed_form_section';
import { comparisonSection } from './comparison_section';
import { constancySection } from './constancy_section';
import { correlationSection } from './correlation_section';
import { choice, el } from './dom';
import { envelopeSection } from './envelope_section';
import { fitSection } from './fit_section';
import { phaseSection } from './phase_section';
import { profileSection } from './profile_section';
import { provenanceSection, rigSection } from './provenance_section';
import { fileName, makeReport, type Report } from './report';
import { residualSection } from './residual_section';
import { significant } from './rounding';
import { startTheme, themeButton } from './theme';
import type { Command, Result, Series } from './types';
import { validationSection } from './validation_section';
import { verdictSection } from './verdict';

const kSections: ((report: Report) => HTMLElement | null)[] = [
  verdictSection,
  fitSection,
  validationSection,
  envelopeSection,
  phaseSection,
  residualSection,
  correlationSection,
  profileSection,
  comparisonSection,
  constancySection,
  closedFormSection,
  rigSection,
  provenanceSection,
];

function header({ result: { data } }: Report): HTMLElement {
  const facts = `${data.used_samples} of ${data.samples} samples · ${significant(data.duration_s, 4)} s · ${significant(data.sample_rate_hz, 4)} Hz`;
  const heading = el(
    'div',
    {},
    el('p', { class: 'kind' }, 'Pendulum report'),
    el('h1', {}, fileName(data.path)),
    el('p', { class: 'quiet' }, facts),
  );
  return el('header', {}, heading, themeButton());
}

/** The contents, from the headings that are there. */
function contents(parts: HTMLElement): HTMLElement {
  const list = el('ol');
  for (const part of parts.querySelectorAll('section')) {
    list.append(el('li', {}, el('a', { href: `#${part.id}` }, part.querySelector('h2')?.textContent ?? part.id)));
  }
  return el('nav', { 'aria-label': 'Contents' }, list);
}

/** Which of several fits is shown in detail. */
function modelChooser(report: Report, change: (index: number) => void): HTMLElement | null {
  const { fits, comparison } = report.result;
  if (fits.length < 2) return null;
  const options = fits.map((fit, i) => {
    const remark =
      fit.model === comparison?.recommended
        ? ' (recommended)'
        : fit.status === 'converged'
          ? ''
          : ` (${fit.status.replace(/_/g, ' ')})`;
    return { value: String(i), label: fit.model + remark };
  });
  const group = choice('Model shown', options, String(report.shown), (value) => change(Number(value)));
  group.classList.add('models');
  return group;
}

/**
 * Fills `root` with the report. series and command may be null; then what needs them says so. The only thing that it
 * changes outside `root` are the title and the theme of the page.
 */
export function render(result: Result, series: Series | null, command: Command | null, root: HTMLElement): void {
  const report = makeReport(result, series, command);
  startTheme();
  document.title = `${fileName(result.data.path)} – pendulum report`;
  const parts = el('div');
  const fill = (): void => parts.replaceChildren(...kSections.flatMap((make) => make(report) ?? []));
  fill();
  const navigation = el('div', { class: 'side' }, contents(parts));
  const chooser = modelChooser(report, (index) => {
    report.shown = index;
    const top = window.scrollY;
    fill();
    navigation.replaceChildren(contents(parts));
    window.scrollTo({ top });
  });
  const page = el(
    'div',
    { class: 'page' },
    el('a', { class: 'skip', href: '#main' }, 'Skip to the report'),
    header(report),
  );
  const body = el('div', { class: 'columns' }, navigation, el('main', { id: 'main', class: 'report' }, chooser, parts));
  page.append(body);
  root.replaceChildren(page);
}
