// SPDX-License-Identifier: Apache-2.0
/** Do the recordings of a joint fit agree? */

import { el, text } from '../../shared/dom';
import { clippedWords, forestPlot, forestSentence, savedForest } from '../../shared/forest_plot';
import { capital } from '../../shared/prose';
import type { Homogeneity, Parameter } from '../../shared/result_types';
import { absent, figure, section } from '../../shared/section';
import { blockElement, captionOf, type Block } from '../../shared/sections';
import { unitText, wordsOf } from '../../shared/units';
import { shownFit, type Report } from '../report';
import { sectionsOf } from '../told';
import { forestRows } from './forest_rows';

function forest(homogeneity: Homogeneity, name: string, joint: Parameter | undefined): HTMLElement {
  const rows = forestRows(homogeneity, name, joint);
  const sentence = forestSentence(wordsOf(name), unitText(homogeneity.parameters[name].unit), rows);
  const plot = forestPlot(sentence, rows);
  return plot
    ? figure(clippedWords(rows), savedForest(plot, `${name}_by_recording`, sentence, rows))
    : absent('No recording determines this parameter on its own.');
}

/** The parameter that a table is about: "inertia" of "inertia [kg m^2]". */
const subjectOf = (block: Block): string | null =>
  block.kind === 'table' ? (block.columns[0]?.header.split(' ')[0] ?? null) : null;

const kMeaning =
  'The plots show each recording alone with its 95 % interval, the joint fit (dashed line), and the random-effects mean, ' +
  'whose error includes the scatter between recordings.';

export function agreementSection(report: Report): HTMLElement {
  const title = 'Do the recordings agree?';
  const fit = shownFit(report);
  const homogeneity = fit?.homogeneity;
  if (!fit || !homogeneity) return section('agreement', title, absent('Without a fit there is nothing to compare.'));
  const open = new Set(Object.keys(homogeneity.parameters));
  const plotOf = (name: string): HTMLElement => forest(homogeneity, name, fit.parameters[name]);
  const pair = (name: string, table: HTMLElement | null): HTMLElement => {
    open.delete(name);
    const both = el('div', { class: 'pair agree', 'data-forest': name }, plotOf(name), table);
    return el('div', {}, el('h3', {}, capital(wordsOf(name))), both);
  };
  const parts = sectionsOf(report, 'agreement').flatMap((one) =>
    one.blocks.map((block, k) => {
      const element = blockElement(block, captionOf(one, k));
      const name = subjectOf(block);
      return name !== null && open.has(name) ? pair(name, element) : element;
    }),
  );
  const told = el('div', { 'data-told': 'do-the-recordings-agree' }, ...parts);
  const left = [...open].map((name) => pair(name, null));
  return section('agreement', title, told, ...left, left.length + parts.length > 1 && text(kMeaning, 'quiet'));
}
