// SPDX-License-Identifier: Apache-2.0
/** One fit: its report, and further actions. */

import { reportContent } from '../../report/render';
import { makeReport, shownFit, type Report } from '../../report/report';
import { el, text } from '../../shared/dom';
import { reportColumns } from '../../shared/page';
import type { Result, Series } from '../../shared/result_types';
import type { ReportSection } from '../../shared/sections';
import { commandOf } from '../command';
import { knownModels } from '../forms/model_form';
import { freshResult } from '../forms/submit';
import { batchPath, fitApi } from '../routes';
import { askJson } from '../server/api';
import { ProblemError } from '../server/problem';
import type { Place, View } from '../shell';
import type { FitRequest } from '../types';
import { againSection } from './again_section';
import { fitActions } from './fit_actions';
import { localTime } from '../../shared/local_time';
import { alertPlace, tellProblem } from './problem_view';
import { slidersSection } from './sliders_section';

/** The result, or the reason why there is none: a run of a batch may have failed. */
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
    facts !== '' && el('span', { class: 'when' }, ' · '),
    el('span', { class: 'when' }, facts === '' ? 'sent ' : 'fitted ', localTime(request.created)),
  );
  if (request.file !== request.name) parts.append(' · file ', el('bdi', {}, request.file));
  if (request.batch) parts.append(' · ', el('a', { href: batchPath(request.batch) }, 'its batch'));
  return parts;
}

/** Announcement for screen readers when a fit is shown. */
function spoken(report: Report): string {
  const fit = shownFit(report);
  return fit ? `Fitted: ${fit.model}, ${fit.status.replace(/_/g, ' ')}.` : 'Done: closed forms only.';
}

function showReport(
  place: Place,
  request: FitRequest,
  result: Result,
  series: Series[] | null,
  told: ReportSection[] | null,
  again: HTMLElement,
): void {
  const problems = alertPlace();
  for (const recording of result.recordings) recording.path ??= request.file;
  const report = makeReport(result, series, { command: commandOf(request) }, told);
  const content = reportContent(report, request.name);
  const { sections } = content;
  const feel = slidersSection(report.recordings[0], request.id, place.signal);
  const withAgain = (changed: () => void): HTMLElement[] => {
    const made = sections(changed);
    const next = made.findIndex((part) => part.id === 'fit') + 1;
    return [...made.slice(0, next), ...(feel ? [feel] : []), again, ...made.slice(next)];
  };
  const columns = reportColumns({ ...content, sections: withAgain }, el('div', { class: 'report' }));
  place.main.append(
    factsOf(request, content.facts),
    fitActions(request, true, problems, place),
    problems,
    columns,
  );
  place.say(spoken(report));
}

/** For a recording that could not be fitted: the reason, and a form to try again. */
function showFailure(place: Place, request: FitRequest, error: ProblemError, again: HTMLElement): void {
  const problems = alertPlace();
  place.main.append(factsOf(request, ''), fitActions(request, false, problems, place), problems, again);
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
    asked.catch(() => undefined); // the request for the result below fails in the same way and is reported
    const named = knownModels(signal).catch(() => undefined); // sentences use their labels
    try {
      const result = await resultOf(id, signal);
      const request = await asked;
      await named;
      name(request.name || 'Recording without a name');
      if (result instanceof ProblemError) {
        showFailure(place, request, result, await againSection(place, request, null));
        return;
      }
      const part = <T>(of: string): Promise<T | null> =>
        askJson<T>(fitApi(id, of), { signal, busy: 'Fitting again for the plots' }).catch(() => null);
      // One after the other: the service fits once for both.
      const parts = part<Series[]>('series').then(async (series) => ({ series, told: await part<ReportSection[]>('sections') }));
      const again = againSection(place, request, result);
      const { series, told } = await parts;
      showReport(place, request, result, series, told, await again);
    } finally {
      waiting.remove();
    }
  };
