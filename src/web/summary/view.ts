// SPDX-License-Identifier: Apache-2.0
/** A summary, and which model and parameter are selected. */

import type { ModelCounts, ParameterSummary, Summary } from './types';

export interface View {
  summary: Summary;
  /** Index of the selected model. */
  shown: number;
  /** Name of the selected parameter; null before the first choice. */
  parameter: string | null;
}

/** The model that was recommended most often. Without a comparison, the first model that has parameters. */
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

/** Parameters of the selected model. */
export const parametersOf = (view: View): ParameterSummary[] =>
  view.summary.parameters.filter(({ model }) => model === shownModel(view)?.model);

/** The selected parameter, else the first that has several runs of one rig, else the first. */
export function shownParameter(view: View): ParameterSummary | null {
  const all = parametersOf(view);
  return all.find(({ name }) => name === view.parameter) ?? all.find((one) => one.repeatability) ?? all[0] ?? null;
}
