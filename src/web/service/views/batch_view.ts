// SPDX-License-Identifier: Apache-2.0
/** A batch: its runs, as they are finished. */

import { badge } from '../../shared/badge';
import { button, el, text, type Child } from '../../shared/dom';
import { localTime } from '../../shared/local_time';
import { typeset } from '../../shared/prose';
import { confirmed } from '../dialog';
import { follow } from '../follow';
import { go } from '../router';
import { batchPath, comparePath, fitPath, kMostCompared } from '../routes';
import { selectionBar } from '../selection';
import { ask, askJson } from '../server/api';
import type { ServerEvent } from '../server/sse';
import type { Place, View } from '../shell';
import type { Batch, BatchAgreement, BatchProgress, BatchRun, FitItem, FitList } from '../types';
import { durationWords, pause } from '../waiting';
import { agreementSection } from './agreement_section';
import { fitRow, fitTable, isUnfitted } from './fit_rows';
import { alertPlace, attempt, showProblem } from './problem_view';

const kMostRows = 500;
const kPage = 100;
const kQuiet = 2; // s before the time is shown
const kTick = 0.5; // s
const kLeastPause = 0.4; // s between two requests for the numbers of finished runs

/** A run that is not finished yet. */
const itemOf = (run: BatchRun, { id, created }: Batch): FitItem => ({
  ...run,
  created,
  batch: id,
  recommended: null,
  models: [],
});

const counted = (count: number, one: string): string => `${count} ${one}${count === 1 ? '' : 's'}`;

/** "3 of 12 recordings fitted, 1 could not be fitted" */
export function progressWords({ runs, done, failed }: Pick<Batch, 'runs' | 'done' | 'failed'>): string {
  const fitted = `${done - failed} of ${counted(runs, 'recording')} fitted`;
  return failed === 0 ? `${fitted}.` : `${fitted}, ${failed} could not be fitted.`;
}

/** "; 12 s so far, about 30 s left" for a batch that takes longer than two seconds. */
export function timeWords(seconds: number, doneSince: number, left: number): string {
  if (seconds < kQuiet || left === 0) return '';
  const rest = doneSince > 0 ? `, about ${durationWords((seconds * left) / doneSince)} left` : '';
  return `${durationWords(seconds)} so far${rest}.`;
}

/** A recording without a result: a link to its page, and why. */
const failedItem = ({ id, name, reason }: FitItem): HTMLElement =>
  el('li', {}, el('a', { href: fitPath(id) }, el('bdi', {}, name || 'recording without a name')), reason !== '' && `: ${typeset(reason)}`);

class BatchView {
  private readonly table = fitTable('Recordings in the order they were sent', false);
  private readonly chosen = selectionBar();
  private readonly bar = el('progress', { 'aria-label': 'Recordings done' });
  private readonly words = text('');
  private readonly failed = el('ul', { class: 'failed', 'aria-label': 'Recordings that could not be fitted' });
  private readonly problems = alertPlace();
  private readonly connection = text('', 'quiet');
  private readonly agreement = el('div');
  private readonly rows = new Map<string, HTMLElement>();
  private readonly full = new Set<string>();
  private readonly told = new Set<string>();
  private readonly time = text('', 'quiet');
  private readonly cancel = button('Cancel', () => void this.stop());
  private readonly began = performance.now();
  private done = 0;
  private fitted = 0;
  private left = 0;
  private changed = false;
  private over = false;

  constructor(
    private readonly place: Place,
    private readonly path: string,
    private readonly batch: Batch,
  ) {
    this.words.setAttribute('role', 'status');
    this.failed.hidden = true;
    for (const run of batch.fits.slice(0, kMostRows)) this.put(itemOf(run, batch));
  }

  private put(item: FitItem): void {
    const row = fitRow(item, this.chosen.selection, false);
    const old = this.rows.get(item.id);
    if (old) old.replaceWith(row);
    else if (this.rows.size < kMostRows) this.table.body.append(row);
    else return;
    this.rows.set(item.id, row);
    this.tellFailure(item);
  }

  /** Names a recording above the table that could not be fitted. */
  private tellFailure(item: FitItem): void {
    if (!isUnfitted(item) || this.told.has(item.id)) return;
    this.told.add(item.id);
    this.failed.append(failedItem(item));
    this.failed.hidden = false;
  }

  /** Updates the progress. Events begin with runs that were finished earlier; the displayed count never decreases. */
  private tell(state: Pick<Batch, 'runs' | 'done' | 'failed'>): void {
    if (state.done < this.done) return;
    this.done = state.done;
    this.fitted = state.done - state.failed;
    this.left = state.runs - state.done;
    this.cancel.hidden = this.left === 0;
    this.bar.max = Math.max(1, state.runs);
    this.bar.value = state.done;
    this.words.textContent = progressWords(state);
  }

  /** Shows how long the batch has taken since the page was opened, until it is done. */
  private async tellTime(): Promise<void> {
    const before = this.done;
    for (; !this.over; await pause(kTick, this.place.signal)) {
      const seconds = (performance.now() - this.began) / 1000;
      this.time.textContent = timeWords(seconds, this.done - before, this.left);
    }
    this.time.textContent = '';
  }

  /** Ends the work: recordings that are not fitted yet leave the batch. */
  private async stop(): Promise<void> {
    await attempt(this.cancel, this.problems, async () => {
      await ask(`${this.path}?keep=done`, { method: 'DELETE', signal: this.place.signal });
      go(batchPath(this.batch.id), true);
    });
  }

  private take = ({ event, data }: ServerEvent): boolean => {
    if (event === 'done') {
      this.tell(JSON.parse(data) as BatchProgress);
      this.over = true;
      return true;
    }
    if (event !== 'fit') return false;
    const progress = JSON.parse(data) as BatchProgress;
    this.tell(progress);
    this.changed = true;
    const { id, name, exit_code, reason } = progress;
    if (!this.full.has(id)) this.put(itemOf({ id, name, exit_code, reason, state: 'done' }, this.batch));
    return false;
  };

  /** Requests the numbers of finished runs from time to time, until all are finished. */
  private async fillNumbers(): Promise<void> {
    for (let last = false; !last; await pause(kLeastPause, this.place.signal)) {
      last = this.over;
      if (!this.changed && !last) continue;
      this.changed = false;
      let next: FitList['next'] = '';
      for (let seen = 0; next !== null && seen < kMostRows; seen += kPage) {
        const query = new URLSearchParams({ batch: this.batch.id, limit: String(kPage) });
        if (next !== '') query.set('before', String(next));
        const list: FitList = await askJson<FitList>(`/v1/fits?${query}`, { signal: this.place.signal });
        for (const item of list.fits) this.fill(item);
        next = list.next;
      }
    }
  }

  /** Shows the numbers of a finished run. */
  private fill(item: FitItem): void {
    if (item.state !== 'done' || !this.rows.has(item.id) || this.full.has(item.id)) return;
    this.full.add(item.id);
    this.put(item);
  }

  /** Says whether the fitted recordings agree, and marks those that do not. */
  private async tellAgreement(): Promise<void> {
    if (this.fitted < 2) return;
    const found = await askJson<BatchAgreement>(`${this.path}/agreement`, { signal: this.place.signal });
    this.agreement.replaceChildren(agreementSection(found));
    for (const { id } of found.outliers)
      this.rows.get(id)?.querySelector('th')?.append(' ', badge('disagrees with the others', 'caution'));
  }

  private actions(): HTMLElement {
    const { batch } = this;
    const remove = button('Delete all', () => void this.remove(remove), { class: 'danger' });
    const all = button('Compare all', () => go(comparePath([...this.rows.keys()])));
    all.hidden = batch.runs < 2 || batch.runs > kMostCompared;
    return el('div', { class: 'actions' }, this.cancel, all, remove);
  }

  private async remove(control: HTMLButtonElement): Promise<void> {
    const what = `Delete all ${counted(this.batch.runs, 'recording')}?`;
    if (!(await confirmed(what, 'What waits is not fitted any more, and the fits of this batch go too.', 'Delete')))
      return;
    await attempt(control, this.problems, async () => {
      await ask(this.path, { method: 'DELETE', signal: this.place.signal });
      go('/fits', true);
    });
  }

  async show(): Promise<void> {
    const { main, signal } = this.place;
    const { runs } = this.batch;
    const few =
      runs > kMostRows && text(`The first ${kMostRows} are listed here; “Past fits” has all of them.`, 'quiet');
    const sent: Child[] = ['Sent ', localTime(this.batch.created), ', your local time.'];
    main.append(
      this.agreement,
      el('p', { class: 'quiet' }, ...sent),
      this.words,
      this.failed,
      this.bar,
      this.time,
      this.connection,
      this.problems,
      this.actions(),
      this.chosen.bar,
      this.table.element,
    );
    if (few) main.append(few);
    this.tell(this.batch);
    const connected = (): void => void (this.connection.textContent = '');
    const lost = (s: number): void =>
      void (this.connection.textContent = `The connection broke off; next attempt in ${Math.ceil(s)} s.`);
    const following = follow(`${this.path}/events`, { take: this.take, connected, lost }, signal);
    const numbers = this.fillNumbers().then(() => this.tellAgreement());
    await Promise.all([following, numbers, this.tellTime()]).catch((error: unknown) => {
      if (!signal.aborted) showProblem(this.problems, error);
    });
  }
}

export const batchView =
  (id: string): View =>
  async (place) => {
    place.name('Several recordings');
    const path = `/v1/batches/${encodeURIComponent(id)}`;
    const batch = await askJson<Batch>(path, { signal: place.signal });
    place.name(`${counted(batch.runs, 'recording')}`);
    await new BatchView(place, path, batch).show();
  };
