// SPDX-License-Identifier: Apache-2.0
/** A summary and what of it is shown. */

import type { ModelCounts, ParameterSummary, Summary } from './types';

export interface View {
  summary: Summary;
  /** Index of the model that is shown. */
  shown: number;
  /** Name of the parameter that is shown in detail; null until there is one. */
  parameter: string | null;
}

/** The model that was recommended most; without a comparison the one with most parameters to show, then the first. */
export function mainModel({ models, recommendations, parameters }: Summary): number {
  const runs = (name: string): number => recommendations.find(({ model }) => model === name)?.runs ?? 0;
  const rank = ({ model, converged }: ModelCounts): number[] => [
    runs(model),
    parameters.some((one) => one.model === model) ? 1 : 0,
    recommendations.length > 0 ? converged : 0,
  ];
  let best = 0;
  models.forEach((model, i) => {
    const [mine, others] = [rank(model), rank(models[best])];
    const differs = mine.findIndex((value, k) => value !== others[k]);
    if (differs >= 0 && mine[differs] > others[differs]) best = i;
  });
  return best;
}

export const shownModel = ({ summary, shown }: View): ModelCounts | null => summary.models[shown] ?? null;

/** Of the model that is shown. */
export const parametersOf = (view: View): ParameterSummary[] =>
  view.summary.parameters.filter(({ model }) => model === shownModel(view)?.model);

/** The one that was chosen; else the first whose runs can be compared, else the first. */
export function shownParameter(view: View): ParameterSummary | null {
  const all = parametersOf(view);
  return all.find(({ name }) => name === view.parameter) ?? all.find((one) => one.repeatability) ?? all[0] ?? null;
}
