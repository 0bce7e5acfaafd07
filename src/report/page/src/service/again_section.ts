// SPDX-License-Identifier: Apache-2.0
/** The same recording once more: another part of it, another law, another rig. */

import { button, details, el, text } from '../dom';
import { figure, section } from '../section';
import type { Loose, Result } from '../types';
import { askJson } from './api';
import { numberField, numberIn, type Field } from './forms';
import { knownModels, ModelForm } from './model_form';
import { OptionsForm } from './options_form';
import { alertPlace, attempt } from './problem_view';
import { RigForm } from './rig_form';
import { go } from './router';
import { fitApi } from './routes';
import type { Place } from './shell';
import { refitted, type Replaced } from './submit';
import type { FitRequest, Flags, WholeRecording } from './types';
import { WindowPlot, type Window } from './window_plot';

const kFlagModel = 'coulomb'; // of a request that names none

export class AgainSection {
  readonly element: HTMLElement;
  private readonly from: Field<HTMLInputElement> = numberField('From [s]');
  private readonly to: Field<HTMLInputElement> = numberField('To [s]');
  private readonly models = new ModelForm();
  private readonly rig = new RigForm();
  private readonly options = new OptionsForm(false);
  private readonly problems = alertPlace();
  private readonly plot: WindowPlot;
  private moved = false;

  /** result: null where the recording could not be fitted. */
  constructor(
    private readonly place: Place,
    private readonly request: FitRequest,
    result: Result | null,
    recording: WholeRecording,
  ) {
    const used = (result?.data.window_s ?? null) as Window | null;
    const times = recording.time_s;
    const chosen: Window = used ?? [times[0] ?? 0, times[times.length - 1] ?? 1];
    this.plot = new WindowPlot(recording, used, chosen, (window) => this.fill(window));
    this.fill(chosen);
    this.moved = false;
    this.models.fill(request.options.model ?? request.options.models ?? kFlagModel);
    this.rig.fill(request.rig);
    this.options.fill(request.options, request.calibration);
    for (const { input } of [this.from, this.to]) input.addEventListener('input', () => this.typed());
    this.element = this.make();
    void knownModels(place.signal).then(
      (models) => this.setModels(models),
      () => undefined, // what cannot be asked now says so when it is used
    );
  }

  private setModels(models: Awaited<ReturnType<typeof knownModels>>): void {
    this.models.set(models);
    this.models.fill(this.request.options.model ?? this.request.options.models ?? kFlagModel);
  }

  private fill([from, to]: Window): void {
    this.moved = true;
    this.from.input.value = String(from);
    this.to.input.value = String(to);
  }

  private typed(): void {
    this.moved = true;
    const [from, to] = [this.from.input, this.to.input].map((input) => Number(input.value.replace(',', '.')));
    if (from < to) this.plot.choose([from, to]);
  }

  /** Flags that take the place of those of the fit: an empty one takes one away. */
  private flags(window: 'chosen' | 'found'): Flags {
    const own = this.options.flags();
    const gone = this.options.names.filter(
      (name) => this.request.options[name] !== undefined && own[name] === undefined,
    );
    const flags: Flags = { ...Object.fromEntries(gone.map((name) => [name, ''])), model: this.models.value(), ...own };
    const ends =
      this.moved && window === 'chosen'
        ? { from: numberIn(this.from.input, 'From'), to: numberIn(this.to.input, 'To') }
        : null;
    for (const end of ['from', 'to'] as const) {
      const value = ends?.[end] ?? null;
      if (value !== null) flags[end] = String(value);
      else if ((ends || window === 'found') && this.request.options[end] !== undefined) flags[end] = '';
    }
    return flags;
  }

  private async replaced(): Promise<Replaced> {
    const parts = { rig: await this.rig.value(), calibration: await this.options.calibrationText() };
    const replaced: Replaced = {};
    for (const name of ['rig', 'calibration'] as const) {
      const own = this.request[name];
      const chosen = parts[name];
      if (chosen === (own && JSON.stringify(own))) continue;
      replaced[name] = chosen === null ? null : (JSON.parse(chosen) as Loose);
    }
    return replaced;
  }

  private fitAgain(control: HTMLButtonElement, window: 'chosen' | 'found'): void {
    const { signal, say } = this.place;
    void attempt(control, this.problems, async () => {
      say('Fitting …');
      go(await refitted(this.request.id, this.flags(window), await this.replaced(), signal));
    });
  }

  private make(): HTMLElement {
    const fit = button('Fit this window', () => this.fitAgain(fit, 'chosen'), { class: 'primary' });
    const found = button('Find the window again', () => this.fitAgain(found, 'found'));
    const caption =
      'Drag to choose the part to fit; its ends can be moved, or typed below. Dashed: what this fit used.';
    const law = details('Another kind of friction', () => this.models.element);
    const rig = details('Another description of the pendulum', () => this.rig.element);
    for (const part of [law, rig]) part.classList.add('options');
    return section(
      'again',
      'Fit it once more',
      figure(caption, this.plot.chart.host),
      el('div', { class: 'window-fields' }, this.from.element, this.to.element),
      law,
      rig,
      this.options.element,
      el('div', { class: 'actions' }, fit, found),
      text('The recording stays as it was sent; the new fit is kept beside this one.', 'quiet'),
      this.problems,
    );
  }
}

/** The section for a fit of the service. */
export async function againSection(place: Place, request: FitRequest, result: Result | null): Promise<HTMLElement> {
  const path = fitApi(request.id, 'samples');
  const recording = await askJson<WholeRecording>(path, { signal: place.signal });
  return new AgainSection(place, request, result, recording).element;
}
