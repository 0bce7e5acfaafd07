// SPDX-License-Identifier: Apache-2.0
/** One fit: the report of it, and what can be done next. */

import { el, text } from '../dom';
import { reportColumns } from '../page';
import { reportContent } from '../render';
import { shownFit, makeReport } from '../report';
import type { Result, Series } from '../types';
import { againSection } from './again_section';
import { askJson } from './api';
import { commandOf } from './command';
import { fitDoors } from './fit_doors';
import { localTime } from './fit_rows';
import { knownModels } from './model_form';
import { ProblemError } from './problem';
import { alertPlace, tellProblem } from './problem_view';
import { batchPath, fitApi } from './routes';
import type { Place, View } from './shell';
import { freshResult } from './submit';
import type { FitRequest } from './types';

/** The result, or why there is none: a run of a batch may not have been fitted. */
async function resultOf(id: string, signal: AbortSignal): Promise<Result | ProblemError> {
  const fresh = freshResult(id);
  if (fresh) return fresh;
  try {
    return await askJson<Result>(fitApi(id), { signal });
  } catch (error) {
    if (error instanceof ProblemError && error.problem.status === 422) return error;
    throw error;
  }
}

function factsOf(request: FitRequest, facts: string): HTMLElement {
  const parts = el(
    'p',
    { class: 'quiet facts-line' },
    facts,
    facts !== '' && ' · ',
    facts === '' ? 'sent ' : 'fitted ',
    localTime(request.created),
  );
  if (request.batch) parts.append(' · ', el('a', { href: batchPath(request.batch) }, 'its batch'));
  return parts;
}

/** What is said to those who listen when a fit has come. */
function spoken(result: Result): string {
  const fit = shownFit(makeReport(result, null, null));
  return fit ? `Fitted: ${fit.model}, ${fit.status.replace(/_/g, ' ')}.` : 'Done: closed forms only.';
}

function showReport(
  place: Place,
  request: FitRequest,
  result: Result,
  series: Series | null,
  again: HTMLElement,
): void {
  const problems = alertPlace();
  const content = reportContent(result, series, { command: commandOf(request) }, request.name);
  const { sections } = content;
  const withAgain = (changed: () => void): HTMLElement[] => {
    const made = sections(changed);
    const next = made.findIndex((part) => part.id === 'fit') + 1;
    return [...made.slice(0, next), again, ...made.slice(next)];
  };
  const columns = reportColumns({ ...content, sections: withAgain }, el('div', { class: 'report' }));
  place.main.append(
    factsOf(request, content.facts),
    fitDoors(request.id, request.name, true, problems, place),
    problems,
    columns,
  );
  place.say(spoken(result));
}

/** Of a recording that could not be fitted: why, and how to go on. */
function showFailure(place: Place, request: FitRequest, error: ProblemError, again: HTMLElement): void {
  const problems = alertPlace();
  place.main.append(factsOf(request, ''), fitDoors(request.id, request.name, false, problems, place), problems, again);
  tellProblem(problems, error);
}

export const fitView =
  (id: string): View =>
  async (place) => {
    const { main, signal, name } = place;
    name('Fit');
    const waiting = text('Fetching the fit …', 'progress');
    main.append(waiting);
    const asked = askJson<FitRequest>(fitApi(id, 'request'), { signal });
    asked.catch(() => undefined); // told by the result below, which is asked for at the same time
    const named = knownModels(signal).catch(() => undefined); // by their labels sentences name them
    try {
      const result = await resultOf(id, signal);
      const request = await asked;
      await named;
      name(request.name || 'Recording without a name');
      if (result instanceof ProblemError) {
        showFailure(place, request, result, await againSection(place, request, null));
        return;
      }
      const series = askJson<Series>(fitApi(id, 'series'), { signal }).catch(() => null);
      const again = againSection(place, request, result);
      showReport(place, request, result, await series, await again);
    } finally {
      waiting.remove();
    }
  };
