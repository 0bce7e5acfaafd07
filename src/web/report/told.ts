// SPDX-License-Identifier: Apache-2.0
/** The sections of the program in the parts of the page. */

import { details, el, type Child } from '../shared/dom';
import { prose } from '../shared/prose';
import { absent, section } from '../shared/section';
import { blockElements, type ReportSection, type RowLook } from '../shared/sections';
import { shownFit, type Report } from './report';

/** Which sections a part of the page has. A part that begins with the same word as their ids is the same subject. */
const kParts = {
  agreement: ['do-the-recordings-agree'],
  recordings: ['recordings', 'each-recording-s-own'],
  parameters: ['parameters', 'derived-quantities', 'equation-of-motion', 'what-one-swing-cannot-tell'],
  envelope: ['turning-points'],
  residuals: ['noise-and-statistics', 'what-the-residuals-suggest', 'what-the-sensor-may-do'],
  correlation: ['correlations'],
  comparison: ['comparison', 'likelihood-ratio-tests'],
  constancy: ['constancy'],
  'closed-forms': ['closed-forms'],
  data: ['data', 'sampling'],
  rig: ['rig'],
  provenance: ['fit'],
  warnings: ['warnings'],
} as const;

export type Part = keyof typeof kParts;

/** Long sections, and those for few readers. */
const kFolded = ['fit', 'turning-points', 'what-the-sensor-may-do', 'what-one-swing-cannot-tell'];

/** Sections are also found by the beginning of their id: "what-the-sensor-may-do-ideal". */
const isOf = ({ id }: ReportSection, name: string): boolean => id === name || id.startsWith(`${name}-`);

/** All sections about the law and the recording that are shown. */
function shownSections(report: Report): ReportSection[] {
  const law = shownFit(report)?.model ?? null;
  return (report.told ?? []).filter(
    (one) => (one.law === null || one.law === law) && (one.recording === null || one.recording === report.recording + 1),
  );
}

/** The sections of a part of the page, in the order of the part. */
export const sectionsOf = (report: Report, part: Part): ReportSection[] =>
  kParts[part].flatMap((name) => shownSections(report).filter((one) => isOf(one, name)));

/** A section with its title. `untitled`: the heading of its part says the same. */
function toldSection(told: ReportSection, untitled: boolean, look: RowLook): HTMLElement {
  const named = { 'data-told': told.id };
  const title = told.title + (told.remark === null ? '' : ` (${told.remark})`);
  if (kFolded.some((name) => isOf(told, name)))
    return el('div', named, details(title, () => el('div', {}, ...blockElements(told, look))));
  const remark = told.remark !== null && el('span', { class: 'which' }, ' (', ...prose(told.remark), ')');
  const heading = untitled
    ? told.remark !== null && el('p', { class: 'quiet' }, ...prose(told.remark))
    : el('h3', {}, ...prose(told.title), remark);
  return el('div', named, heading, ...blockElements(told, look));
}

/** The content of a part of the page. `title`: its heading. */
export const told = (report: Report, part: Part, title: string, look: RowLook = {}): HTMLElement[] =>
  sectionsOf(report, part).map((one) => toldSection(one, one.title === title, look));

/** A part of the page with its charts below the words; null without both. */
export function toldPart(report: Report, part: Part, title: string, charts: Child[] = [], look: RowLook = {}): HTMLElement | null {
  const words = told(report, part, title, look);
  return words.length + charts.filter(Boolean).length > 0 ? section(part, title, ...words, ...charts) : null;
}

const kNothing = 'The tables are not part of this report: the program that made the result did not write them.';

/** Parameters and what follows from them, or one sentence in place of all tables. */
export const parameterPart = (report: Report): HTMLElement | null =>
  report.told === null
    ? section('parameters', 'Parameters', absent(kNothing))
    : toldPart(report, 'parameters', 'Parameters');

/** Sections that no part of the page has: the program may get new ones. */
export function otherParts(report: Report): HTMLElement[] {
  const names = Object.values(kParts).flat();
  const others = shownSections(report).filter((one) => !names.some((name) => isOf(one, name)));
  return others.map((one) => section(`told-${one.id}`, one.title, toldSection(one, true, {})));
}
