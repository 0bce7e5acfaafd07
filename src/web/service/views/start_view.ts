// SPDX-License-Identifier: Apache-2.0
/** The form for a new fit: recordings, rig, friction laws and options. */

import { button, el, text } from '../../shared/dom';
import { keep, kept } from '../../shared/kept';
import { kColumnFlags } from '../forms/column_form';
import { textField, type Field } from '../forms/forms';
import { dropZone, type DropZone } from '../forms/drop_zone';
import { forgetRecording, heldRecording, holdRecording } from '../forms/held_recording';
import { kCompared, knownModels, ModelForm } from '../forms/model_form';
import { OptionsForm, type OptionsState } from '../forms/options_form';
import { PasteForm } from '../forms/paste_form';
import { RigForm, type RigState } from '../forms/rig_form';
import { previewed, sent, submission, type Choices, type Recording } from '../forms/submit';
import { pressEnded } from '../press';
import { go } from '../router';
import { askJson } from '../server/api';
import type { Place, View } from '../shell';
import type { Example, ExampleData, Flags, Preview } from '../types';
import { LookSection } from './look_section';
import { alertPlace, attempt, clearProblems, showProblem } from './problem_view';

/** The forms keep their values until the tab is closed. */
interface Forms {
  rig: RigForm;
  models: ModelForm;
  options: OptionsForm;
  name: Field<HTMLInputElement>;
}

const kChoices = 'pendulum_choices';

let forms: Forms | null = null;

/** What the forms keep over a reload. */
interface Kept {
  rig: RigState;
  models: ModelForm['state'];
  options: OptionsState;
  name?: string;
}

const kLongestName = 200; // characters, as in the service

function keepForms({ rig, models, options, name }: Forms): void {
  const state = { rig: rig.state, models: models.state, options: options.state, name: name.input.value };
  keep('closed', kChoices, JSON.stringify(state));
}

function restoreForms({ rig, models, options, name }: Forms): void {
  const words = kept('closed', kChoices);
  if (words === null) return;
  try {
    const state = JSON.parse(words) as Kept;
    rig.restore(state.rig);
    models.restore(state.models);
    options.restore(state.options);
    name.input.value = state.name ?? '';
  } catch {
    keep('closed', kChoices, ''); // of another version of the page
  }
}

function theForms(): Forms {
  if (forms) return forms;
  const name = textField('Name', '', { maxlength: String(kLongestName), placeholder: 'optional' });
  forms = { rig: new RigForm(), models: new ModelForm(), options: new OptionsForm(), name };
  restoreForms(forms);
  return forms;
}

/** Sets the calibration for the next fit. */
export function useCalibration(name: string, json: string): void {
  theForms().options.use({ name, json });
  keepForms(theForms());
}

async function choices({ rig, models, options }: Forms): Promise<Choices> {
  const { flags, file } = await rig.value();
  return {
    flags: { model: models.value(), ...options.flags(), ...flags },
    rig: file,
    calibration: await options.calibrationText(),
  };
}

/** The choices for a preview: as for a fit, but the form of the rig need not be complete. */
async function readChoices({ rig, models, options }: Forms): Promise<Choices> {
  const law: Flags = models.entered === '' ? {} : { model: models.entered };
  const flags = { ...law, ...options.flags(), ...rig.entered };
  return { flags, rig: null, calibration: await options.calibrationText() };
}

/** The choices for a fit of one recording, which may have a name. */
async function namedChoices(all: Forms): Promise<Choices> {
  const made = await choices(all);
  const name = all.name.input.value.trim();
  return name === '' ? made : { ...made, flags: { ...made.flags, name } };
}

/** Options of the next fit, for any source of its recording. */
export const chosenForNext = (): Promise<Choices> => choices(theForms());

/** The recording of this view, and whether the browser keeps it over a reload. */
interface Current {
  recording: Recording;
  isKept: boolean;
}

let current: Current | null = null;

const asRecording = (file: File): Recording => ({ name: file.name, content: file });

const inWords = (recordings: Recording[]): string =>
  recordings.length === 1 ? recordings[0].name : `${recordings.length} recordings`;

const kLead = 'From a recording of a free swing: how hard the pendulum is to turn, and what slows it down.';

const kTooLarge =
  'This recording is too large for the memory of the browser: after a reload of the page, choose it again.';

/** Of two files, the one whose name says that it is a calibration. */
function calibrationOf(files: File[]): File | null {
  const named = files.filter(({ name }) => /calib/i.test(name));
  return files.length === 2 && named.length === 1 ? named[0] : null;
}

/** Whether the reader guessed a column or a unit. */
const isGuessed = ({ assumptions }: Preview): boolean =>
  assumptions.some(({ options }) => options.some((option) => kColumnFlags.includes(option)));

function restored(): Current | null {
  const recording = heldRecording();
  return recording && { recording, isKept: true };
}

class StartView {
  private readonly problems = alertPlace();
  private readonly progress = el('p', { class: 'progress', role: 'status' });
  private readonly held = el('div', { class: 'held' });
  private readonly zone: DropZone;
  private readonly look: LookSection;
  private readonly fitBar = el('div', { class: 'fit-bar', hidden: '' });
  private readonly fitWords = text('', 'quiet');
  private readonly examples = el('ul', { class: 'examples' });
  private busy = false;
  private taken = 0; // times that files were dropped or chosen
  private reading = new AbortController();
  private read: Promise<Preview | null> = Promise.resolve(null); // the last reading

  constructor(
    private readonly place: Place,
    private readonly all: Forms,
  ) {
    const hint =
      'Accepted: CSV and other text of loggers and serial monitors; exports of phyphox, Tracker, Logger Pro, Capstone ' +
      'and ROS; workbooks (.xlsx, .xls, .ods); MAT-files; NumPy; JSON; zip files of these. Several files are fitted as ' +
      'a batch.';
    this.zone = dropZone('Drop a recording here, paste it, or press to choose', hint, (files) => void this.take(files), place.signal);
    this.look = new LookSection(all.options, () => this.changed(), () => this.remove());
    const fit = button('Fit', () => void this.fitCurrent(), { class: 'primary' });
    this.fitBar.append(fit, all.name.element, this.fitWords);
    place.signal.addEventListener('abort', () => this.reading.abort());
    for (const event of ['input', 'change']) place.main.addEventListener(event, () => keepForms(all), { signal: place.signal });
    for (const element of [all.rig.element, all.models.element, all.options.element])
      element.addEventListener('change', () => this.changed(), { signal: place.signal });
  }

  /** Takes new files: one recording, a recording with its calibration, or a batch. */
  private async take(files: File[]): Promise<void> {
    if (this.busy) return;
    const order = ++this.taken;
    const calibration = calibrationOf(files);
    if (calibration) {
      try {
        this.all.options.use({ name: calibration.name, json: await calibration.text() });
      } catch (error) {
        return showProblem(this.problems, error, () => void this.take(files));
      }
      if (order !== this.taken) return; // other files were dropped meanwhile
    }
    const recordings = files.filter((file) => file !== calibration).map(asRecording);
    if (recordings.length > 1) await this.fit(() => recordings, () => choices(this.all));
    else await this.lookAt(recordings[0], true);
  }

  /** Shows a new recording. Fits it at once if `mayFit` and there is nothing to decide. */
  private async lookAt(recording: Recording, mayFit: boolean): Promise<void> {
    if (mayFit) {
      this.forgetRecordingChoices();
      this.look.hide();
      this.showParts();
    }
    this.reading.abort(); // the answer for an earlier recording must not be shown with this one
    current = { recording, isKept: false };
    const isKept = await holdRecording(recording);
    if (current?.recording !== recording) return; // another was dropped meanwhile
    current = { recording, isKept };
    keepForms(this.all);
    this.read = this.readCurrent();
    const preview = await this.read;
    if (current?.recording !== recording) return;
    if (!preview) {
      const again = (): void => void this.lookAt(recording, mayFit);
      if (!this.look.isShown) this.hold([recording], 'Read again', again);
      return;
    }
    const isReady = preview.missing.length === 0 && !preview.problem && !isGuessed(preview);
    if (mayFit && isReady && this.all.rig.isEmpty) return this.fitCurrent();
    this.look.element.querySelector('h3')?.focus({ preventScroll: true });
    this.look.element.scrollIntoView({ block: 'start' });
  }

  /** The name, and the columns and units that the user chose in the menus, belong to the recording before. */
  private forgetRecordingChoices(): void {
    if (!current) return; // chosen before any recording, for the first
    this.all.name.input.value = '';
    this.all.options.put(Object.fromEntries(kColumnFlags.map((flag) => [flag, ''])));
  }

  private changed(): void {
    keepForms(this.all);
    if (this.look.isShown) this.read = this.readCurrent();
  }

  /** Reads the current recording and shows what was read. Returns null if it is not readable. */
  private async readCurrent(): Promise<Preview | null> {
    if (!current) return null;
    const { recording, isKept } = current;
    this.reading.abort();
    this.reading = new AbortController();
    const { signal } = this.reading;
    // With a look, problems stay until the answer: their removal would move the Fit button under the pointer.
    if (!this.look.isShown) clearProblems(this.problems);
    this.held.replaceChildren();
    if (!this.look.isShown) this.progress.textContent = `Reading ${recording.name} …`;
    try {
      // The answer may move the Fit button, whose press has caused this reading.
      const preview = await previewed(recording, await readChoices(this.all), signal).finally(pressEnded);
      if (signal.aborted) return null;
      clearProblems(this.problems);
      this.showPreview(preview, isKept ? '' : kTooLarge);
      return preview;
    } catch (error) {
      if (signal.aborted) return null;
      showProblem(this.problems, error);
      return null;
    } finally {
      if (!signal.aborted) this.progress.textContent = '';
    }
  }

  private showPreview(preview: Preview, note: string): void {
    const active = document.activeElement as HTMLElement | null;
    const flag = active?.closest('.look') ? active.dataset.flag : undefined;
    this.look.show(preview, note);
    this.look.markMissing();
    if (flag) this.look.element.querySelector<HTMLElement>(`[data-flag="${flag}"]`)?.focus({ preventScroll: true });
    this.showParts();
    const open = preview.missing.length;
    const said = open > 0 ? `${open} things are missing` : preview.problem ? 'a fit would be refused' : 'ready for a fit';
    this.place.say(`${preview.name}: ${said}`);
    if (open > 0) this.fitWords.textContent = 'Answer what is missing first.';
    else if (preview.problem) this.fitWords.textContent = 'Solve the problem above first.';
    else this.fitWords.textContent = 'Fits the shaded window with the choices above.';
  }

  private showParts(): void {
    const isShown = this.look.isShown;
    this.zone.button.classList.toggle('small', isShown);
    this.fitBar.hidden = !isShown;
    if (isShown) this.fitBar.before(this.problems, this.held);
    else this.progress.after(this.problems, this.held);
    const examples = this.examples.closest('section');
    if (examples) examples.hidden = isShown;
  }

  private remove(): void {
    this.reading.abort();
    this.forgetRecordingChoices();
    keepForms(this.all);
    current = null;
    forgetRecording();
    this.look.hide();
    this.showParts();
    this.zone.button.focus();
  }

  private async fitCurrent(): Promise<void> {
    await this.read; // a choice that was just made may answer what was missing
    if (!current) return;
    const { recording } = current;
    if (this.look.focusMissing()) return this.place.say('Something is missing');
    await this.fit(() => [recording], () => namedChoices(this.all));
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
      if (!this.look.isShown) this.hold(recordings, 'Fit again', again);
    } finally {
      this.busy = false;
      this.progress.textContent = '';
      this.place.main.removeAttribute('aria-busy');
    }
  }

  /** Keeps the request that failed, to repeat it. */
  private hold(recordings: Recording[], label: string, again: () => void): void {
    const words = `${inWords(recordings)} can be sent again, with other choices further down.`;
    this.held.replaceChildren(text(words, 'quiet'), button(label, again));
  }

  private takePasted(form: PasteForm): void {
    clearProblems(this.problems);
    try {
      void this.lookAt(form.recording, true);
    } catch (error) {
      showProblem(this.problems, error);
    }
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
    const part = (id: string, title: string, ...children: Node[]): HTMLElement =>
      el('section', { 'aria-labelledby': id }, el('h2', { id }, title), ...children);
    const guide = el('a', { href: '/docs' }, 'User guide');
    const paste = new PasteForm((form) => this.takePasted(form));
    this.place.main.append(
      el('p', { class: 'lead' }, `${kLead} `, guide),
      part('recording', 'The recording', this.zone.element, this.progress, paste.element, this.look.element),
      part('example', 'No recording at hand', text('Try one of these.', 'quiet'), this.examples),
      part('rig-known', 'The pendulum', rig.element),
      part('friction', 'What slows it down', models.element, options.element),
      this.fitBar,
    );
    options.hideColumns(false);
    this.showParts();
    current ??= restored();
    if (current) void this.lookAt(current.recording, false);
    void this.fillExamples(this.examples);
    void this.fillModels();
  }
}

export const startView: View = (place) => {
  place.name('Fit a recording');
  new StartView(place, theForms()).show();
};
