// SPDX-License-Identifier: Apache-2.0
/** A form to fit the same recording again with another window, law or rig. */

import { button, el, text } from '../../shared/dom';
import type { Loose, Result } from '../../shared/result_types';
import { figure, section } from '../../shared/section';
import { labelOf, labelWithUnit, rigFlags } from '../flag_words';
import { numberField, numberIn, type Field } from '../forms/forms';
import { knownModels, ModelForm } from '../forms/model_form';
import { OptionsForm } from '../forms/options_form';
import { RigForm } from '../forms/rig_form';
import { refitted, type Replaced } from '../forms/submit';
import { go } from '../router';
import { fitApi } from '../routes';
import { askJson } from '../server/api';
import { ProblemError } from '../server/problem';
import type { Place } from '../shell';
import type { FitRequest, Flags, WholeRecording } from '../types';
import { alertPlace, attempt } from './problem_view';
import { WindowPlot, type Window } from './window_plot';

const kFlagModel = 'coulomb'; // of a request without a model

/** A rig or calibration as an object, as a refit sends it. */
function parsedFile(name: string, content: string): Loose {
  try {
    return JSON.parse(content) as Loose;
  } catch (error) {
    const detail = `The file of the ${name} is not JSON (${String(error)}).`;
    throw new ProblemError({ title: 'The request is wrong', status: 400, detail, code: 'bad_request' });
  }
}

export class AgainSection {
  readonly element: HTMLElement;
  private readonly from: Field<HTMLInputElement> = numberField(labelWithUnit('from'));
  private readonly to: Field<HTMLInputElement> = numberField(labelWithUnit('to'));
  private readonly models = new ModelForm();
  private readonly rig = new RigForm();
  private readonly options = new OptionsForm(false);
  private readonly problems = alertPlace();
  private readonly plot: WindowPlot | null;
  private moved = false;
  private readonly filledRig: string; // the state of the rig form for the rig of the fit

  /** result: null if the recording could not be fitted. recording: null if it cannot be drawn. */
  constructor(
    private readonly place: Place,
    private readonly request: FitRequest,
    private readonly result: Result | null,
    recording: WholeRecording | null,
  ) {
    this.plot = recording && this.plotOf(recording);
    this.models.fill(request.options.model ?? request.options.models ?? kFlagModel);
    this.rig.fill(request.rig, request.options);
    this.filledRig = JSON.stringify(this.rig.state);
    this.options.fill(request.options, request.calibration);
    this.options.element.open = result === null; // one of the options may solve the problem
    this.moved = result === null && this.plot !== null; // the plot shows the whole recording as the window
    for (const name of ['from', 'to'] as const) {
      const { input } = this[name];
      input.dataset.flag = name;
      if (!recording) input.value = request.options[name] ?? '';
      input.addEventListener('input', () => this.typed());
    }
    this.element = this.make();
    void knownModels(place.signal).then(
      (models) => this.setModels(models),
      () => undefined, // a failed request is reported when its result is used
    );
  }

  /** The recording with its fitted window, or with the requested window if there is no fit. */
  private plotOf(recording: WholeRecording): WindowPlot {
    const used = (this.result?.recordings[0].window_s ?? null) as Window | null;
    const { from, to } = this.request.options;
    const asked = (text: string | undefined, end: number): number => (text === undefined ? end : Number(text));
    const chosen: Window = used ?? [asked(from, recording.time_s[0] ?? 0), asked(to, recording.time_s.at(-1) ?? 1)];
    const plot = new WindowPlot(recording, used, chosen, (window) => this.fill(window));
    this.fill(chosen);
    this.moved = false;
    return plot;
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
    if (from < to) this.plot?.choose([from, to]);
  }

  /** Flags that replace those of the fit. An empty value removes a flag. */
  private flags(window: 'chosen' | 'found'): Flags {
    const own = this.options.flags();
    const gone = this.options.names.filter(
      (name) => this.request.options[name] !== undefined && own[name] === undefined,
    );
    const flags: Flags = { ...Object.fromEntries(gone.map((name) => [name, ''])), model: this.models.value(), ...own };
    const ends =
      this.moved && window === 'chosen'
        ? { from: numberIn(this.from.input, labelOf('from')), to: numberIn(this.to.input, labelOf('to')) }
        : null;
    for (const end of ['from', 'to'] as const) {
      const value = ends?.[end] ?? null;
      if (value !== null) flags[end] = String(value);
      else if ((ends || window === 'found') && this.request.options[end] !== undefined) flags[end] = '';
    }
    return flags;
  }

  /** Flags of the rig that replace those of the fit, and its file. */
  private async rigChoice(): Promise<{ flags: Flags; file: string | null }> {
    const own = this.request.rig;
    if (JSON.stringify(this.rig.state) === this.filledRig)
      return { flags: {}, file: own && JSON.stringify(own) };
    const { flags, file } = await this.rig.value();
    const gone = rigFlags().filter((flag) => this.request.options[flag] !== undefined && flags[flag] === undefined);
    return { flags: { ...Object.fromEntries(gone.map((flag) => [flag, ''])), ...flags }, file };
  }

  private async replaced(rig: string | null): Promise<Replaced> {
    const parts = { rig, calibration: await this.options.calibrationText() };
    const replaced: Replaced = {};
    for (const name of ['rig', 'calibration'] as const) {
      const own = this.request[name];
      const chosen = parts[name];
      if (chosen === (own && JSON.stringify(own))) continue;
      replaced[name] = chosen === null ? null : parsedFile(name, chosen);
    }
    return replaced;
  }

  private fitAgain(control: HTMLButtonElement, window: 'chosen' | 'found'): void {
    const { signal, say } = this.place;
    void attempt(control, this.problems, async () => {
      say('Fitting …');
      const rig = await this.rigChoice();
      const flags = { ...this.flags(window), ...rig.flags };
      go(await refitted(this.request.id, flags, await this.replaced(rig.file), signal));
    });
  }

  private make(): HTMLElement {
    const words = this.plot ? 'Fit this window' : 'Fit again';
    const fit = button(words, () => this.fitAgain(fit, 'chosen'), { class: 'primary' });
    const found = button('Find the window again', () => this.fitAgain(found, 'found'));
    const caption =
      'Move the two handles to choose the part to fit, or type its ends. Drag in the plot to zoom; a double click ' +
      `shows all.${this.result ? ' Dashed: what this fit used.' : ''}`;
    const kept = this.result ? ' beside this one' : '';
    return section(
      'again',
      'Fit it once more',
      this.plot && figure(caption, this.plot.element),
      el('div', { class: 'window-fields' }, this.from.element, this.to.element),
      folded('Another kind of friction', this.models.element),
      folded('Another description of the pendulum', this.rig.element),
      this.options.element,
      el('div', { class: 'actions' }, fit, this.plot && found),
      text(`The recording stays as it was sent; the new fit is kept${kept}.`, 'quiet'),
      this.problems,
    );
  }
}

/** A collapsed part. Its content exists from the beginning, so that problems can be assigned to its fields. */
const folded = (summary: string, content: HTMLElement): HTMLElement =>
  el('details', { class: 'options' }, el('summary', {}, summary), content);

/** The section for a fit of the service, or for a recording that could not be fitted. */
export async function againSection(place: Place, request: FitRequest, result: Result | null): Promise<HTMLElement> {
  const path = fitApi(request.id, 'samples');
  const recording = await askJson<WholeRecording>(path, { signal: place.signal }).catch((error: unknown) => {
    if (error instanceof ProblemError) return null; // only the plot needs it
    throw error;
  });
  return new AgainSection(place, request, result, recording).element;
}
