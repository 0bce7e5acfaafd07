// SPDX-License-Identifier: Apache-2.0
/** Builds the summary of a batch. */

import { el } from '../shared/dom';
import { fileName, visible } from '../shared/names';
import { fillPage, refill, type Content } from '../shared/page';
import { wordsOf } from '../shared/units';
import { distributionSection } from './distribution_section';
import { failuresSection } from './failures_section';
import { modelsSection } from './models_section';
import { movedSection } from './moved_section';
import { outliersSection } from './outliers_section';
import { parametersSection } from './parameters_section';
import { provenanceSection } from './provenance_section';
import { repeatabilitySection } from './repeatability_section';
import { runsSection } from './runs_section';
import { trendSection } from './trend_section';
import type { Summary } from './types';
import { verdictSection } from './verdict_section';
import { mainModel, shownParameter, type View } from './view';
import { counted } from './words';

/** The sections of the selected parameter. Their headings have its name. */
function detailSections(view: View): HTMLElement[] {
  const one = shownParameter(view);
  if (!one) return [];
  const { group_by: group } = view.summary;
  const made = [
    distributionSection(one),
    repeatabilitySection(one, group),
    outliersSection(one, view.summary),
    trendSection(one),
  ];
  for (const part of made) part.querySelector('h2')?.append(el('span', { class: 'which' }, ` · ${wordsOf(one.name)}`));
  return made;
}

function sections(view: View, changed: () => void): HTMLElement[] {
  const details = el('div', {}, ...detailSections(view));
  const overview = parametersSection(view, () => {
    refill(details, detailSections(view));
    changed();
  });
  const parts = [verdictSection(view), failuresSection(view), movedSection(view), runsSection(view.summary)];
  return [...parts, modelsSection(view), overview, details, provenanceSection(view)].filter((part) => part !== null);
}

function content(view: View): Content {
  const { store, models } = view.summary;
  const name = visible(fileName(store.path));
  return {
    kind: 'Summary of runs',
    title: name,
    heading: name,
    facts: [counted(store.runs, 'run'), counted(store.fits, 'fit'), counted(models.length, 'model')].join(' · '),
    models: models.map(({ model, converged }) => ({ model, status: converged > 0 ? 'converged' : 'not_converged' })),
    recommended: null,
    shown: view.shown,
    show: (index) => (view.shown = index),
    sections: (changed) => sections(view, changed),
  };
}

/** Fills `root` with the summary. Outside `root` only the title and the theme of the page change. */
export function render(summary: Summary, root: HTMLElement): void {
  fillPage(root, content({ summary, shown: mainModel(summary), parameter: null }));
}
