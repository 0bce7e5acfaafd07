// SPDX-License-Identifier: Apache-2.0
/** What the service reads in a recording before it is fitted: first rows, columns, window, and what is missing. */

import { button, el, text } from '../../shared/dom';
import { windowText } from '../../shared/rounding';
import { figure } from '../../shared/section';
import { inFields } from '../flag_words';
import { CalibrationForm, kRawUnits } from '../forms/calibration_form';
import { ColumnForm } from '../forms/column_form';
import type { OptionsForm, ReadyCalibration } from '../forms/options_form';
import { mark } from '../forms/problem_fields';
import { questionOf } from '../forms/rig_quantities';
import { ProblemError } from '../server/problem';
import type { Flags, Preview, Question } from '../types';
import { tellProblem } from './problem_view';
import { Sketch } from './sketch';

const kQuestions: Record<string, string> = {
  time_column: 'Which column is the time, and in which unit?',
  sample_rate_hz: 'Which column is the time, or how many samples are there in a second?',
  value_column: 'Which column is the angle?',
  unit: 'In which unit are the values?',
};

let questions = 0;

/** A sentence without the name of the file before it. */
const withoutName = (sentence: string, name: string): string =>
  sentence.startsWith(`${name}: `) ? sentence.slice(name.length + 2) : sentence;

/** The question in plain words. */
function plainQuestion({ options }: Question): string {
  const asked = options.flatMap((option) => kQuestions[option] ?? questionOf(option) ?? []);
  const isOfRig = options.length > 0 && questionOf(options[0]) !== undefined;
  return (isOfRig ? asked.join(' ') : asked[0]) ?? 'Something else is needed';
}

const capital = (sentence: string): string => sentence.charAt(0).toUpperCase() + sentence.slice(1);

export class LookSection {
  readonly element = el('div', { class: 'look' });
  private preview: Preview | null = null;

  /** `change` is called when the user has changed the columns or the calibration. */
  constructor(
    private readonly options: OptionsForm,
    private readonly change: () => void,
    private readonly clear: () => void,
  ) {}

  get isShown(): boolean {
    return this.preview !== null;
  }

  hide(): void {
    this.preview = null;
    this.options.hideColumns(false);
    this.element.replaceChildren();
  }

  /** `note`: a sentence on the recording. */
  show(preview: Preview, note: string): void {
    this.preview = preview;
    this.options.hideColumns(true);
    const set = (flags: Flags, isTyping = false): void => {
      this.options.put(flags);
      if (!isTyping) this.change();
    };
    const columns = new ColumnForm(preview, this.options.columnFlags, set);
    const problems = el('div');
    const parts = [
      this.head(preview, note),
      this.missing(preview),
      problems,
      this.rows(preview),
      columns.element,
      this.calibration(preview),
      this.sketch(preview),
      this.assumptions(preview),
    ];
    this.element.replaceChildren(...parts.filter((part) => part !== null));
    if (preview.problem) tellProblem(problems, new ProblemError(preview.problem));
  }

  private head(preview: Preview, note: string): HTMLElement {
    const place = preview.member ? `, ${preview.member}` : '';
    const samples = preview.samples ? `; ${preview.samples.samples} samples` : '';
    return el(
      'div',
      { class: 'look-head' },
      el('h3', { tabindex: '-1' }, preview.name),
      text(`${capital(preview.format ?? 'recording')}${place}${samples}.`, 'quiet'),
      note !== '' && text(note, 'quiet'),
      button('Remove it', this.clear, { 'aria-label': `Remove ${preview.name}` }),
    );
  }

  /** All open questions. */
  private missing({ missing, name }: Preview): HTMLElement | null {
    if (missing.length === 0) return null;
    const list = el('ol');
    for (const question of missing) {
      const go = button(plainQuestion(question), () => this.fieldOf(question)?.focus(), { class: 'link' });
      const why = capital(withoutName(inFields(question.question), name));
      list.append(el('li', {}, go, el('small', { id: `missing-${++questions}` }, `${why}.`)));
    }
    const words = missing.length === 1 ? 'One thing is missing:' : `${missing.length} things are missing:`;
    return el('div', { class: 'missing', role: 'group', 'aria-label': 'What is missing' }, el('p', {}, words), list);
  }

  /** The first field in the page that answers a question. */
  private fieldOf({ options }: Question): HTMLElement | null {
    return this.fieldsOf(options)[0] ?? null;
  }

  private fieldsOf(options: string[]): HTMLElement[] {
    const main = this.element.closest('main') ?? document;
    return options.flatMap((option) => main.querySelector<HTMLElement>(`[data-flag="${option}"]`) ?? []);
  }

  /** Marks the fields that answer the open questions. */
  markMissing(): void {
    const reasons = this.element.querySelectorAll('.missing small');
    this.preview?.missing.forEach((question, i) => {
      const open = this.fieldsOf(question.options).filter((field) => (field as HTMLInputElement).value === '');
      for (const field of open) mark(field, reasons[i].id);
    });
  }

  /** Moves the focus to the first open question. Returns whether there is one. */
  focusMissing(): boolean {
    const first = this.preview?.missing[0];
    if (!first) return false;
    (this.fieldOf(first) ?? this.element.querySelector<HTMLElement>('.missing button'))?.focus();
    return true;
  }

  private rows({ columns, rows, time, value }: Preview): HTMLElement | null {
    if (rows.length === 0) return null;
    const role = (i: number): string => (time?.column === i ? 'time' : value?.column === i ? 'reading' : '');
    const heads = columns.map(({ name }, i) =>
      el('th', { scope: 'col', class: role(i) }, name, role(i) !== '' && el('small', {}, role(i))),
    );
    const body = rows.map((cells) =>
      el('tr', {}, ...columns.map((_column, i) => el('td', { class: role(i) }, cells[i] ?? ''))),
    );
    const table = el(
      'table',
      { class: 'first-rows' },
      el('caption', {}, 'The first rows'),
      el('thead', {}, el('tr', {}, ...heads)),
      el('tbody', {}, ...body),
    );
    return el('div', { class: 'first-rows-box', tabindex: '0', role: 'group', 'aria-label': 'The first rows' }, table);
  }

  private calibration({ value, calibration }: Preview): HTMLElement | null {
    if (calibration && this.options.usesCalibration) {
      const none = (): void => {
        this.options.use(null);
        this.change();
      };
      return el('div', { class: 'ready' }, text('A calibration turns the readings into angles.', 'quiet'), button('Use none', none));
    }
    if (calibration || !kRawUnits.includes(value?.unit ?? '')) return null;
    const use = (given: ReadyCalibration): void => {
      this.options.use(given);
      this.change();
    };
    return new CalibrationForm(use).element;
  }

  private sketch({ samples, window }: Preview): HTMLElement | null {
    if (!samples) return null;
    if (!window) return figure('The recording. No window is chosen yet.', new Sketch(samples, window).chart.host);
    const others = window.releases.length > 1 ? ` It is swing ${window.release} of ${window.releases.length}.` : '';
    const why = [window.begins && `Begins: ${window.begins}.`, window.ends && `Ends: ${window.ends}.`];
    const words = `Shaded: the window, ${windowText(window.window_s)}. ${why.filter(Boolean).join(' ')}${others}`;
    const caption = `${words} The fit may shorten the window.`;
    return figure(caption, new Sketch(samples, window).chart.host);
  }

  private assumptions({ assumptions, name }: Preview): HTMLElement | null {
    if (assumptions.length === 0) return null;
    const lines = assumptions.map(({ message }) => el('li', {}, `${capital(withoutName(inFields(message), name))}.`));
    return el('div', { class: 'assumptions' }, el('p', {}, 'Assumptions and warnings:'), el('ul', {}, ...lines));
  }
}
