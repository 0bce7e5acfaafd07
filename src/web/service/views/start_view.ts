// SPDX-License-Identifier: Apache-2.0
/** The form for a new fit: recordings, rig, friction laws and options. */

import { button, el, text } from '../../shared/dom';
import { dropZone, type DropZone } from '../forms/drop_zone';
import { kCompared, knownModels, ModelForm } from '../forms/model_form';
import { OptionsForm } from '../forms/options_form';
import { PasteForm } from '../forms/paste_form';
import { RigForm } from '../forms/rig_form';
import { sent, submission, type Choices, type Recording } from '../forms/submit';
import { go } from '../router';
import { askJson } from '../server/api';
import type { Place, View } from '../shell';
import type { Example, ExampleData } from '../types';
import { alertPlace, attempt, clearProblems, showProblem } from './problem_view';

/** The forms keep their values while the page is open. */
interface Forms {
  rig: RigForm;
  models: ModelForm;
  options: OptionsForm;
}

let forms: Forms | null = null;
const theForms = (): Forms => (forms ??= { rig: new RigForm(), models: new ModelForm(), options: new OptionsForm() });

/** Sets the calibration for the next fit. */
export const useCalibration = (name: string, json: string): void => theForms().options.use({ name, json });

async function choices({ rig, models, options }: Forms): Promise<Choices> {
  const flags = { model: models.value(), ...options.flags() };
  return { flags, rig: await rig.value(), calibration: await options.calibrationText() };
}

/** Options of the next fit, for any source of its recording. */
export const chosenForNext = (): Promise<Choices> => choices(theForms());

const asRecording = (file: File): Recording => ({ name: file.name, content: file });

const inWords = (recordings: Recording[]): string =>
  recordings.length === 1 ? recordings[0].name : `${recordings.length} recordings`;

class StartView {
  private readonly problems = alertPlace();
  private readonly progress = el('p', { class: 'progress', role: 'status' });
  private readonly held = el('div', { class: 'held' });
  private readonly zone: DropZone;
  private busy = false;

  constructor(
    private readonly place: Place,
    private readonly all: Forms,
  ) {
    const hint =
      'CSV or text: times and angles. One file, or several; they are fitted at once, with the choices further down.';
    const take = (files: File[]): void => void this.fit(() => files.map(asRecording), () => choices(this.all));
    this.zone = dropZone('Drop recordings here, or press to choose', hint, take, place.signal);
  }

  /** Fits the recordings and then shows the fit. */
  private async fit(which: () => Recording[], what: () => Promise<Choices>): Promise<void> {
    if (this.busy) return;
    const recordings = which();
    this.busy = true;
    clearProblems(this.problems);
    this.held.replaceChildren();
    this.progress.textContent = `Fitting ${inWords(recordings)} …`;
    this.place.main.setAttribute('aria-busy', 'true');
    try {
      go(await sent(await submission(recordings, await what()), this.place.signal));
    } catch (error) {
      if (this.place.signal.aborted) return;
      const again = (): void => void this.fit(which, what);
      showProblem(this.problems, error);
      this.hold(recordings, again);
    } finally {
      this.busy = false;
      this.progress.textContent = '';
      this.place.main.removeAttribute('aria-busy');
    }
  }

  /** Keeps the request that failed, to repeat it. */
  private hold(recordings: Recording[], again: () => void): void {
    const words = `${inWords(recordings)} can be fitted again, with other choices further down.`;
    this.held.replaceChildren(text(words, 'quiet'), button('Fit again', again));
  }

  private fitPasted(form: PasteForm): void {
    void this.fit(() => [form.recording], async () => {
      const made = await choices(this.all);
      return { ...made, flags: form.flags(made.flags) };
    });
  }

  private example(example: Example): HTMLElement {
    const action = async (): Promise<void> => {
      const path = `/v1/examples/${encodeURIComponent(example.name)}`;
      const { recording, rig, models } = await askJson<ExampleData>(path, { signal: this.place.signal });
      const list = (typeof models === 'string' ? models : (models ?? []).join(',')) || kCompared.join(',');
      const made: Choices = {
        flags: { model: list, name: example.title },
        rig: rig && JSON.stringify(rig),
        calibration: null,
      };
      await this.fit(
        () => [{ name: `${example.name}.csv`, content: new Blob([recording], { type: 'text/csv' }) }],
        async () => made,
      );
    };
    const press = button('Try it', () => void attempt(press, this.problems, action), {
      'aria-label': `Try it: ${example.title}`,
    });
    return el('li', {}, el('div', {}, el('strong', {}, example.title), el('small', {}, example.about)), press);
  }

  private async fillExamples(list: HTMLElement): Promise<void> {
    try {
      const { examples } = await askJson<{ examples: Example[] }>('/v1/examples', { signal: this.place.signal });
      list.replaceChildren(...examples.map((example) => this.example(example)));
    } catch (error) {
      if (!this.place.signal.aborted) showProblem(this.problems, error, () => void this.fillExamples(list));
    }
  }

  private async fillModels(): Promise<void> {
    try {
      this.all.models.set(await knownModels(this.place.signal));
    } catch {
      // the examples come from the same service and report its problems
    }
  }

  show(): void {
    const { rig, models, options } = this.all;
    const list = el('ul', { class: 'examples' });
    const part = (id: string, title: string, ...children: Node[]): HTMLElement =>
      el('section', { 'aria-labelledby': id }, el('h2', { id }, title), ...children);
    const paste = new PasteForm((form) => this.fitPasted(form));
    this.place.main.append(
      text('From a recording of a free swing: how hard the pendulum is to turn, and what slows it down.', 'lead'),
      part('recording', 'The recording', this.zone.element, this.progress, this.problems, this.held, paste.element),
      part('example', 'No recording at hand', text('Try one of these.', 'quiet'), list),
      part('rig-known', 'The pendulum', rig.element),
      part('friction', 'What slows it down', models.element, options.element),
    );
    void this.fillExamples(list);
    void this.fillModels();
  }
}

export const startView: View = (place) => {
  place.name('Fit a recording');
  new StartView(place, theForms()).show();
};
