// SPDX-License-Identifier: Apache-2.0
/** The list of all fits, newest first. */

import { button, el, text } from '../../shared/dom';
import { confirmed } from '../dialog';
import { selectField, textField } from '../forms/forms';
import { knownModels } from '../forms/model_form';
import { fitApi } from '../routes';
import { selectionBar, unselect } from '../selection';
import { ask, askJson } from '../server/api';
import type { Place, View } from '../shell';
import type { FitList } from '../types';
import { fitRow, fitTable } from './fit_rows';
import { alertPlace, attempt, showProblem } from './problem_view';

const kPage = 50;
const kTypingPause = 300; // ms

const kStatuses: [string, string][] = [
  ['', 'any'],
  ['converged', 'converged'],
  ['not_converged', 'not converged'],
  ['not_identifiable', 'not identifiable'],
  ['failed', 'failed'],
];

class FitsView {
  private readonly name = textField('Name contains');
  private readonly model = selectField('Law', [['', 'any']]);
  private readonly status = selectField('Status', kStatuses);
  private readonly problems = alertPlace();
  private readonly table = fitTable('Past fits, newest first');
  private readonly count = text('', 'quiet');
  private readonly more = button('Show more', () => void attempt(this.more, this.problems, () => this.load(false)));
  private readonly remove = button('Delete', () => void this.deleteChosen(), { class: 'danger' });
  private readonly chosen = selectionBar([this.remove]);
  private next: FitList['next'] = null;
  private asked = 0;

  constructor(private readonly place: Place) {
    this.count.setAttribute('role', 'status');
    const search = (): void => void this.search();
    let timer = 0;
    this.name.input.addEventListener('input', () => {
      clearTimeout(timer);
      timer = window.setTimeout(search, kTypingPause);
    });
    for (const { input } of [this.model, this.status]) input.addEventListener('change', search);
  }

  private query(): string {
    const query = new URLSearchParams({ limit: String(kPage) });
    const filters = {
      name: this.name.input.value.trim(),
      model: this.model.input.value,
      status: this.status.input.value,
    };
    for (const [name, value] of Object.entries(filters)) if (value !== '') query.set(name, value);
    if (this.next !== null) query.set('before', String(this.next));
    return query.toString();
  }

  private async search(): Promise<void> {
    try {
      await this.load(true);
    } catch (error) {
      if (!this.place.signal.aborted) showProblem(this.problems, error, () => void this.search());
    }
  }

  /** Shows only the answer to the last of several searches. */
  private async load(anew: boolean): Promise<void> {
    const turn = ++this.asked;
    if (anew) this.next = null;
    const list = await askJson<FitList>(`/v1/fits?${this.query()}`, { signal: this.place.signal });
    if (turn !== this.asked) return;
    this.problems.replaceChildren();
    const rows = list.fits.map((item) => fitRow(item, this.chosen.selection));
    if (anew) this.table.body.replaceChildren(...rows);
    else this.table.body.append(...rows);
    this.next = list.next;
    this.more.hidden = list.next === null;
    this.tell(rows[0], anew);
  }

  private tell(first: HTMLElement | undefined, anew: boolean): void {
    const shown = this.table.body.children.length;
    this.table.element.hidden = shown === 0;
    const one = shown === 1 ? 'One fit' : `${shown} fits`;
    this.count.textContent =
      shown === 0 ? 'There are no such fits.' : `${one} shown${this.next === null ? '' : '; there are more'}.`;
    if (!anew) first?.querySelector('a')?.focus();
  }

  private async deleteChosen(): Promise<void> {
    const { ids, changed } = this.chosen.selection;
    const what = ids.size === 1 ? `“${[...ids.values()][0]}”` : `these ${ids.size} fits`;
    if (
      !(await confirmed(`Delete ${what}?`, 'Results and recordings are removed from the service for good.', 'Delete'))
    )
      return;
    await attempt(this.remove, this.problems, async () => {
      for (const id of [...ids.keys()]) {
        await ask(fitApi(id), { method: 'DELETE', signal: this.place.signal });
        unselect(id);
      }
      await this.load(true);
    });
    changed();
  }

  async show(): Promise<void> {
    const filters = el('form', { class: 'filters', role: 'search', 'aria-label': 'Past fits' });
    filters.append(this.name.element, this.model.element, this.status.element);
    filters.addEventListener('submit', (event) => {
      event.preventDefault();
      void this.search();
    });
    this.more.hidden = true;
    this.place.main.append(filters, this.chosen.bar, this.problems, this.count, this.table.element, this.more);
    await this.load(true);
    for (const { name, label } of await knownModels(this.place.signal))
      this.model.input.append(el('option', { value: name }, label === name ? name : `${name}: ${label}`));
  }
}

export const fitsView: View = (place) => {
  place.name('Past fits');
  return new FitsView(place).show();
};
