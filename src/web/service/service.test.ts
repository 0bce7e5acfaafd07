// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test, vi } from 'vitest';

import { makeReport } from '../report/report';
import type { Parameter, Result } from '../shared/result_types';
import { commandOf } from './command';
import { stem } from './download';
import { isTable, numberFrom, pastedRows } from './forms/numbers';
import { comparedIds, comparePath, fitApi, fitPath, idOfLocation, kMostCompared, parseRoute } from './routes';
import { adviceFor, FieldError, problemFrom, problemOf, ProblemError, retryAfter, unreachable } from './server/problem';
import { EventParser, readEvents, type ServerEvent } from './server/sse';
import type { ItemModel } from './types';
import { progressWords } from './views/batch_view';
import { polynomial } from './views/calibration_plots';
import {
  areOneRecording,
  commonModels,
  differenceInErrors,
  parameterNames,
  shareRecording,
  showModel,
  wholeRange,
  type Compared,
} from './views/compare';
import { mainModel, parameterWords, stateOf, windowWords } from './views/fit_rows';
import { LiveSamples } from './views/live_plot';
import { movedEnd, roundedWindow } from './views/window_plot';

describe('routes', () => {
  test('each address has one view', () => {
    expect(parseRoute('/')).toEqual({ page: 'start' });
    expect(parseRoute('/fits')).toEqual({ page: 'fits' });
    expect(parseRoute('/fits/')).toEqual({ page: 'fits' });
    expect(parseRoute('/fits/01J%2Fa')).toEqual({ page: 'fit', id: '01J/a' });
    expect(parseRoute('/compare', '?ids=a,b,a')).toEqual({ page: 'compare', ids: ['a', 'b'] });
    expect(parseRoute('/calibration')).toEqual({ page: 'calibration' });
    expect(parseRoute('/live')).toEqual({ page: 'live' });
    expect(parseRoute('/batches/7')).toEqual({ page: 'batch', id: '7' });
  });

  test('an unknown address is missing, and no address throws', () => {
    for (const path of ['/v1/fits', '/fits/a/b', '/batches', '/live/x', '/fits/%E0%A4%A', '/index.html', '//'])
      expect(parseRoute(path).page, path).toBe(path === '//' ? 'start' : 'missing');
  });

  test('addresses are parsed to the values they were made from', () => {
    const id = 'a/b c,ü';
    expect(parseRoute(fitPath(id))).toEqual({ page: 'fit', id });
    const made = new URL(comparePath(['x1', 'y2']), 'http://localhost');
    expect(parseRoute(made.pathname, made.search)).toEqual({ page: 'compare', ids: ['x1', 'y2'] });
    expect(fitApi('x', 'series')).toBe('/v1/fits/x/series');
    expect(fitApi('x')).toBe('/v1/fits/x');
    expect(comparedIds(Array.from({ length: 40 }, (_unused, i) => `f${i}`).join(','))).toHaveLength(kMostCompared);
    expect(comparedIds(null)).toEqual([]);
  });

  test('the id is read from a Location header', () => {
    expect(idOfLocation('/v1/fits/f7')).toBe('f7');
    expect(idOfLocation('http://host/v1/batches/b%201?x')).toBe('b 1');
    expect(idOfLocation(null)).toBeNull();
    expect(idOfLocation('/v1/fits/')).toBeNull();
  });
});

const kStream =
  '\ufeff: hello\r\nretry: 2500\r\nevent: fit\r\nid: 1\r\ndata: {"a":1}\r\n\r\ndata: one\ndata:two\n\n' +
  'id: 7\rdata\r\rdata:  x\n\nevent: only\n\nid\ndata: end\n\ndata: not whole';

/** By the rules of "Interpreting an event stream" in the HTML standard. */
const kEvents: ServerEvent[] = [
  { id: '1', event: 'fit', data: '{"a":1}' },
  { id: '1', event: 'message', data: 'one\ntwo' },
  { id: '7', event: 'message', data: '' },
  { id: '7', event: 'message', data: ' x' },
  { id: '', event: 'message', data: 'end' },
];

describe('server-sent events', () => {
  test('are the same for all ways to cut the stream into pieces', () => {
    for (const size of [1, 2, 3, 7, 1000]) {
      const parser = new EventParser();
      const events: ServerEvent[] = [];
      for (let i = 0; i < kStream.length; i += size) events.push(...parser.push(kStream.slice(i, i + size)));
      expect(events, `pieces of ${size}`).toEqual(kEvents);
      expect(parser.retry).toBe(2500);
    }
  });

  test('the last id is kept for the next connection', () => {
    const parser = new EventParser();
    parser.lastId = '12';
    expect(parser.push('data: x\n\n')).toEqual([{ id: '12', event: 'message', data: 'x' }]);
    parser.push('id: 1\u00002\ndata: y\n\n');
    expect(parser.lastId).toBe('12');
  });

  const streamOf = (bytes: Uint8Array[]): ReadableStream<Uint8Array> =>
    new ReadableStream({
      start(controller) {
        for (const piece of bytes) controller.enqueue(piece);
        controller.close();
      },
    });

  test('a character may be cut in two, and the receiver can end the stream', async () => {
    const bytes = new TextEncoder().encode('data: θ\n\nevent: done\ndata: 1\n\ndata: more\n\n');
    const pieces = [bytes.slice(0, 7), bytes.slice(7)]; // θ has two bytes, the seventh and the eighth
    const seen: string[] = [];
    const take = (event: ServerEvent): boolean => seen.push(event.data) > 0 && event.event === 'done';
    expect(await readEvents(streamOf(pieces), new EventParser(), take)).toBe(true);
    expect(seen).toEqual(['θ', '1']);
    expect(await readEvents(streamOf(pieces), new EventParser(), () => false)).toBe(false);
  });
});

describe('typed and pasted numbers', () => {
  test('may have a decimal point or comma, and any minus sign', () => {
    expect(numberFrom(' 0,38 ')).toBe(0.38);
    expect(numberFrom('−49.6')).toBe(-49.6);
    expect(numberFrom('1e-3')).toBe(0.001);
    expect(numberFrom('.5')).toBe(0.5);
    for (const none of ['', 'x', '1,000.5', '1.2.3', '--1', 'Infinity', '0x10'])
      expect(numberFrom(none), none).toBeNaN();
  });

  const rows = [
    ['19', '-45'],
    ['97', '-30'],
  ];

  test('two columns may come from a spreadsheet, a file or a text', () => {
    for (const pasted of [
      '19\t-45\n97\t-30',
      'counts,angle_deg\r\n19,-45\r\n97,-30\r\n',
      '19;-45\n97;-30',
      '19 -45\n\n97   -30',
      '19, -45\n97, -30',
    ])
      expect(pastedRows(pasted), pasted).toEqual(rows);
    expect(pastedRows('0,5\t1,25')).toEqual([['0,5', '1,25']]);
    expect(pastedRows('0,5 1,25')).toEqual([['0,5', '1,25']]);
    expect(pastedRows('"19"\t"-45"')).toEqual([rows[0]]);
  });

  test('wrong cells of a row are kept, a heading is not', () => {
    expect(pastedRows('Reading\tAngle\n19\tx')).toEqual([['19', 'x']]);
    expect(pastedRows('19\n97')).toEqual([
      ['19', ''],
      ['97', ''],
    ]);
  });

  test('a single number is pasted as usual', () => {
    expect(isTable('19')).toBe(false);
    expect(isTable('words')).toBe(false);
    expect(isTable('19\t-45')).toBe(true);
    expect(isTable('19\n97')).toBe(true);
  });
});

describe('problems', () => {
  test('are shown in the words of the service', () => {
    const detail = 'run.csv:118: time 3.2 s does not follow 3.21 s; times must increase';
    const body = JSON.stringify({
      type: 'urn:x',
      title: 'The data cannot be used',
      status: 422,
      detail,
      code: 'unusable_data',
    });
    const problem = problemFrom(422, body);
    expect(problem).toEqual({ title: 'The data cannot be used', detail, status: 422, code: 'unusable_data' });
    // The detail says where and what to do; a sentence for all data would often be wrong.
    expect(adviceFor(problem)).toBe('');
    expect(problemOf(new ProblemError(problem))).toBe(problem);
  });

  test('an answer that is not from the service is reported', () => {
    for (const body of ['', '<html>', '[]', '{"title": 3}', 'null']) {
      const problem = problemFrom(502, body);
      expect(problem.code, body).toBe('bad_answer');
      expect(problem.detail).toContain('502');
    }
    expect(problemFrom(401, '').code).toBe('unauthorized');
  });

  test('each code has advice in complete sentences, unless the detail gives it', () => {
    const codes =
      'bad_request unauthorized forbidden not_found timed_out conflict too_large unsupported_media_type ' +
      'idempotency_key_reused too_many_samples too_many_requests headers_too_large internal cannot_write stopping unreachable bad_answer';
    for (const code of codes.split(' ')) expect(adviceFor({ ...unreachable('h'), code }), code).toMatch(/^[A-Z“].*\.$/);
    for (const code of ['unusable_data', 'no_swing', 'never heard']) {
      expect(adviceFor({ ...unreachable('h'), code }), code).toBe('');
    }
  });

  test('other errors have a title, too', () => {
    expect(problemOf(new Error('x is not a function'))).toMatchObject({
      title: 'This page has a fault',
      detail: 'x is not a function',
    });
    expect(problemOf(new FieldError('Mass is missing.', {} as HTMLElement)).title).toMatch(/missing/);
  });

  test('Retry-After is seconds or a date', () => {
    const now = Date.parse('2026-11-23T21:40:00Z');
    expect(retryAfter('3', now)).toBe(3);
    expect(retryAfter('Mon, 23 Nov 2026 21:40:05 GMT', now)).toBe(5);
    expect(retryAfter('Mon, 23 Nov 2026 21:39:00 GMT', now)).toBe(0);
    expect(retryAfter('soon', now)).toBeNull();
    expect(retryAfter(null, now)).toBeNull();
  });
});

// As in a page that the program wrote.
vi.stubGlobal('document', { getElementById: () => ({ textContent: '{"coulomb": {"symbol": "τ_c", "words": "dry friction", "unit_over_g": "1"}}' }) });

const model = (name: string, status: ItemModel['status'], inertia: number | null = 0.079): ItemModel => ({
  model: name,
  status,
  reason: '',
  rms_residual: 0.003,
  residual_unit: 'rad',
  parameters: {
    inertia: { estimate: inertia, unit: 'kg m^2', text: '0.0790 ± 0.0028' },
    coulomb: { estimate: 0.0022, unit: '1', text: '0.00220 ± 0.00020' },
  },
});

describe('lists of fits', () => {
  test('show the recommended model, else one that converged', () => {
    const models = [model('viscous', 'failed'), model('coulomb', 'converged'), model('drag', 'converged')];
    expect(mainModel({ recommended: 'drag', models })?.model).toBe('drag');
    expect(mainModel({ recommended: null, models })?.model).toBe('coulomb');
    expect(mainModel({ recommended: null, models: [] })).toBeNull();
  });

  test('values have errors and units; without a rig they are in units of G', () => {
    expect(parameterWords(model('x', 'converged'), 'inertia')).toEqual({
      value: '0.0790 ± 0.0028',
      unit: 'kg\u00a0m²',
    });
    expect(parameterWords(model('x', 'converged'), 'coulomb')).toEqual({ value: '0.00220 ± 0.00020', unit: 'over G' });
    expect(parameterWords(model('x', 'converged', null), 'inertia').value).toBe('–');
    expect(parameterWords(null, 'inertia').value).toBe('–');
  });

  test('windows are in seconds', () => {
    expect(windowWords([0, 46.35])).toBe('0 to 46.35\u00a0s');
    expect(windowWords(null)).toBe('–');
    expect(windowWords(undefined)).toBe('–');
  });

  test('say how a fit ended', () => {
    const item = { state: 'done' as const, exit_code: 0, recommended: null, models: [model('x', 'not_converged')] };
    expect(stateOf(item)).toEqual({ words: 'not converged', level: 'caution' });
    expect(stateOf({ ...item, state: 'waiting' }).words).toBe('waiting');
    expect(stateOf({ ...item, models: [], exit_code: 4 }).words).toBe('not fitted');
  });

  test('count the finished runs of a batch', () => {
    expect(progressWords({ runs: 12, done: 4, failed: 1 })).toBe('3 of 12 recordings fitted, 1 could not be fitted.');
    expect(progressWords({ runs: 1, done: 1, failed: 0 })).toBe('1 of 1 recording fitted.');
  });
});

const parameter = (estimate: number | null, std_error: number | null, unit = 's'): Parameter =>
  ({ estimate, std_error, interval95: null, unit }) as unknown as Parameter;

const compared = (id: string, sha256: string | null, models: Record<string, Parameter>[]): Compared => {
  const own = { parameters: {}, identifiability: [] };
  const result = {
    recordings: [{ sha256, fits: models.map(() => own) }],
    fits: models.map((parameters, i) => ({ model: `m${i}`, status: 'converged', parameters, identifiability: [] })),
  } as unknown as Result;
  return { id, name: id, created: '', report: makeReport(result, null, null) };
};

describe('comparisons', () => {
  test('differences are in combined standard errors', () => {
    expect(differenceInErrors(parameter(1, 0.3), parameter(2, 0.4))).toBeCloseTo(2, 12); // sqrt(0.09 + 0.16) = 0.5
    expect(differenceInErrors(parameter(1, null), parameter(2, 0.5))).toBeCloseTo(2, 12);
    expect(differenceInErrors(parameter(1, 0.3), parameter(2, 0.4, 'kg m^2'))).toBeNull();
    expect(differenceInErrors(parameter(1, 0), parameter(2, 0))).toBeNull();
    expect(differenceInErrors(null, parameter(2, 0.4))).toBeNull();
  });

  test('common models, and all parameters', () => {
    const a = compared('a', 'x', [{ inertia: parameter(1, 1) }, { inertia: parameter(1, 1), drag: parameter(1, 1) }]);
    const b = compared('b', 'y', [{ inertia: parameter(1, 1), coulomb: parameter(1, 1) }]);
    expect(commonModels([a, b])).toEqual(['m0']);
    expect(parameterNames([a, b])).toEqual(['inertia', 'coulomb']);
    showModel([a, b], 'm1');
    expect([a.report.shown, b.report.shown]).toEqual([1, 0]);
    expect(shareRecording([a, b])).toBe(false);
    expect(shareRecording([a, b, compared('c', 'x', [])])).toBe(true);
    expect(shareRecording([compared('a', null, []), compared('b', null, [])])).toBe(false);
    expect(areOneRecording([a, compared('c', 'x', [])])).toBe(true);
    expect(areOneRecording([a, b, compared('c', 'x', [])])).toBe(false);
    expect(areOneRecording([compared('a', null, []), compared('b', null, [])])).toBe(false);
  });

  test('the axis holds all intervals', () => {
    const row = { kind: 'recording' as const, label: '', disagrees: false, text: '' };
    const [low, high] = wholeRange([
      { ...row, estimate: 1, interval95: [-9, 11] },
      { ...row, estimate: 2, interval95: [1.9, 2.1] },
    ]);
    expect(low).toBeCloseTo(-10, 12);
    expect(high).toBeCloseTo(12, 12);
  });
});

describe('windows', () => {
  test('a handle moves its own end, within the recording', () => {
    expect(movedEnd([2, 20], 0, 4, [0, 30], 0.1)).toEqual([4, 20]);
    expect(movedEnd([2, 20], 1, 12, [0, 30], 0.1)).toEqual([2, 12]);
    expect(movedEnd([2, 20], 0, -5, [0, 30], 0.1)).toEqual([0, 20]);
    expect(movedEnd([2, 20], 1, 99, [0, 30], 0.1)).toEqual([2, 30]);
  });

  test('a handle does not pass the other one', () => {
    expect(movedEnd([2, 20], 0, 25, [0, 30], 0.5)).toEqual([19.5, 20]);
    expect(movedEnd([2, 20], 1, 1, [0, 30], 0.5)).toEqual([2, 2.5]);
  });
});

describe('rounding of a window', () => {
  test('is to the millisecond', () => {
    expect(roundedWindow([-1.23456, 20.00049], 0.03)).toEqual([-1.235, 20]);
  });

  test('does not close the narrowest window of a short recording', () => {
    const [from, to] = roundedWindow([0.1001, 0.1001 + 2e-4], 2e-4); // of 0.2 s
    expect(to - from).toBeCloseTo(2e-4, 5);
  });
});

describe('a live recording', () => {
  test('grows, and an earlier time begins a new run', () => {
    const samples = new LiveSamples();
    const many = Array.from({ length: 3000 }, (_unused, i) => i);
    samples.add(many, many);
    samples.add([3000], [null]);
    expect(samples.count).toBe(3001);
    expect([...samples.time.slice(-2)]).toEqual([2999, 3000]);
    expect(samples.values[3000]).toBeNaN();
    samples.add([0.5], [7]);
    expect([...samples.time]).toEqual([0.5]);
    samples.clear();
    expect(samples.last).toBeNull();
  });
});

describe('files and commands', () => {
  test('a file is named after its recording', () => {
    expect(stem('run 1.csv')).toBe('run_1');
    expect(stem('../../etc/passwd')).toBe('etc_passwd');
    expect(stem('.csv')).toBe('fit');
    expect(stem('Schwingung_ü.2.txt')).toBe('Schwingung_ü.2');
  });

  test('the command is safe to paste into a shell', () => {
    const options = { name: 'Heavy bob', model: 'viscous,coulomb', from: '2' };
    const request = { file: "it's.csv", options, rig: { name: "Ada's" }, calibration: null };
    expect(commandOf(request)).toBe(
      "printf '%s\\n' '{\"name\":\"Ada'\\''s\"}' > rig.json\n" +
        "fit_pendulum --data 'it'\\''s.csv' --rig rig.json --model viscous,coulomb --from 2",
    );
  });

  test('a calibration is a polynomial of the reading', () => {
    expect(polynomial([-49.6077, 0.1985], 261)).toBeCloseTo(2.2008, 10);
    expect(polynomial([1, 2, 3], 2)).toBe(17);
  });
});
