// SPDX-License-Identifier: Apache-2.0
/** The comparison of several fits. */

import { overlaySection } from '../../report/joint/overlay_section';
import { makeReport } from '../../report/report';
import { el, text } from '../../shared/dom';
import { forestPlot, forestSentence } from '../../shared/forest_plot';
import { recordingMark, swatch } from '../../shared/marks';
import type { Result, Series } from '../../shared/result_types';
import { fixed, significant } from '../../shared/rounding';
import { section } from '../../shared/section';
import { select } from '../../shared/select';
import { table, type Cell, type Column } from '../../shared/table';
import { quantityName, spacedUnit, unitText, wordsOf } from '../../shared/units';
import { fitApi, fitPath } from '../routes';
import { askJson } from '../server/api';
import type { View } from '../shell';
import type { FitRequest } from '../types';
import {
  areOneRecording,
  commonModels,
  comparedRows,
  differenceInErrors,
  fitOf,
  isShared,
  kBest,
  parameterNames,
  parameterOf,
  recordingOf,
  shareRecording,
  showModel,
  wholeRange,
  type Compared,
} from './compare';
import { localTime } from '../../shared/local_time';
import { valueCell } from './parameter_cells';

const number = 'number' as const;

const named = (k: number): Cell => [swatch(recordingMark(k)), String(k + 1)];

function fitsTable(all: Compared[]): HTMLElement {
  const columns: Column[] = [
    { head: 'Fit' },
    { head: 'Recording' },
    { head: 'Model' },
    { head: 'Status' },
    { head: 'Window [s]', kind: number },
    { head: 'Made' },
  ];
  const rows = all.map((one, k): Cell[] => {
    const fit = fitOf(one);
    const [from, to] = recordingOf(one).window_s;
    return [
      named(k),
      el('a', { href: fitPath(one.id) }, el('bdi', {}, one.name)),
      fit?.model ?? '–',
      fit?.status.replace(/_/g, ' ') ?? '–',
      `${significant(from, 4)} to ${significant(to, 4)}`,
      localTime(one.created),
    ];
  });
  return table('The fits', columns, rows);
}

/** "+1.3 σ": difference from the first fit. */
function differenceWords(z: number | null): string {
  return z === null ? '–' : `${z > 0 ? '+' : ''}${fixed(z, Math.abs(z) < 9.95 ? 1 : 0)} σ`;
}

function parameterRow(all: Compared[], name: string): Cell[] {
  const [first] = all;
  const unit = parameterOf(first, name)?.unit ?? '';
  const values = all.map((one, k): Cell => {
    const parameter = parameterOf(one, name);
    if (!parameter) return '–';
    const z = differenceInErrors(parameterOf(first, name), parameter);
    const value = valueCell(parameter);
    const cells = Array.isArray(value) ? value : [value];
    return k === 0 || !isShared(all, name)
      ? cells
      : [...cells, el('small', { class: Math.abs(z ?? 0) > 3 ? 'no difference' : 'difference' }, differenceWords(z))];
  });
  return [el('span', {}, ...quantityName(name, unit)), ...values];
}

function parameterTable(all: Compared[]): HTMLElement {
  const heads = all.map((_one, k) => ({
    head: el('span', {}, swatch(recordingMark(k)), `Fit ${k + 1}`),
    kind: number,
  }));
  const rows = parameterNames(all).map((name) => parameterRow(all, name));
  return table('Parameters ± standard errors', [{ head: 'Parameter' }, ...heads], rows);
}

function forests(all: Compared[]): HTMLElement[] {
  return parameterNames(all).flatMap((name) => {
    const rows = !isShared(all, name) ? [] : comparedRows(all, name);
    if (rows.length === 0) return [];
    const unit = all.map((one) => parameterOf(one, name)?.unit).find((found) => found !== undefined) ?? '';
    const plot = forestPlot(forestSentence(wordsOf(name), unitText(unit), rows), rows, wholeRange(rows));
    return plot ? [el('h3', {}, wordsOf(name), spacedUnit(unit) && ` [${unitText(unit)}]`), plot] : [];
  });
}

const kMeaning =
  'Beneath inertia and friction: the difference from fit 1 in combined standard errors (σ), as of independent recordings. ' +
  'Beyond 3 σ the difference is hardly chance.';
const kShared =
  'Some of these fits are of the same recording. Their errors are then not independent: a difference tells of the ' +
  'window or the model rather than of the pendulum.';

function parts(all: Compared[]): HTMLElement[] {
  const bars = forests(all);
  const recordings = all.map(({ report }) => report.recordings[0]);
  const overlaid = overlaySection({ recordings, oneClock: areOneRecording(all) }, 'fit');
  return [
    section('fits', 'What is compared', fitsTable(all)),
    section(
      'parameters',
      'Parameters',
      parameterTable(all),
      text(kMeaning, 'quiet'),
      shareRecording(all) && text(kShared, 'absent'),
    ),
    ...(bars.length > 0
      ? [
          section(
            'bars',
            'With error bars',
            text('Lines are 95 % intervals.', 'quiet'),
            el('div', { class: 'forests' }, ...bars),
          ),
        ]
      : []),
    overlaid,
  ];
}

async function compared(id: string, signal: AbortSignal): Promise<Compared> {
  const [request, result, series] = await Promise.all([
    askJson<FitRequest>(fitApi(id, 'request'), { signal }),
    askJson<Result>(fitApi(id), { signal }),
    askJson<Series[]>(fitApi(id, 'series'), { signal }).catch(() => null),
  ]);
  return { id, name: request.name, created: request.created, report: makeReport(result, series, null) };
}

export const compareView =
  (ids: string[]): View =>
  async ({ main, signal, name, say }) => {
    name('Compare fits');
    if (ids.length < 2) {
      main.append(el('p', {}, 'Choose two or more of the ', el('a', { href: '/fits' }, 'past fits'), '.'));
      return;
    }
    const waiting = text('Fetching the fits …', 'progress');
    main.append(waiting);
    const all = await Promise.all(ids.map((id) => compared(id, signal))).finally(() => waiting.remove());
    const body = el('div', { class: 'report' });
    const show = (model: string): void => {
      showModel(all, model);
      body.replaceChildren(...parts(all));
    };
    const options = [
      { value: kBest, label: 'the best of each' },
      ...commonModels(all).map((value) => ({ value, label: value })),
    ];
    show(kBest);
    main.append(select('Model', options, kBest, show), body);
    say(`${all.length} fits compared.`);
  };
