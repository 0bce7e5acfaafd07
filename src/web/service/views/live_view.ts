// SPDX-License-Identifier: Apache-2.0
/** The recording that record_pendulum is writing. */

import { button, choice, el, text } from '../../shared/dom';
import { fixed, significant } from '../../shared/rounding';
import { figure } from '../../shared/section';
import { spacedUnit } from '../../shared/units';
import { follow } from '../follow';
import { sent, submission } from '../forms/submit';
import { go } from '../router';
import { ask, askJson } from '../server/api';
import { ProblemError } from '../server/problem';
import type { ServerEvent } from '../server/sse';
import type { Place, View } from '../shell';
import type { LiveState } from '../types';
import { LivePlot, LiveSamples } from './live_plot';
import { alertPlace, attempt, showProblem } from './problem_view';
import { chosenForNext } from './start_view';

const kStates: Record<LiveState['state'], string> = {
  waiting: 'Waiting for a recording to begin.',
  recording: 'Recording.',
  ended: 'The recording has ended.',
};

class LiveView {
  private readonly samples = new LiveSamples();
  private readonly plot = new LivePlot(this.samples);
  private readonly state = el('p', { role: 'status', class: 'live-state' });
  private readonly numbers = el('p', { class: 'readout' });
  private readonly connection = text('', 'quiet');
  private readonly problems = alertPlace();
  private readonly fit = button('Fit it', () => this.fitIt(), { class: 'primary' });

  constructor(
    private readonly place: Place,
    private now: LiveState,
  ) {
    this.tell();
  }

  private tell(): void {
    const { state, name, unit } = this.now;
    this.state.textContent = `${kStates[state]}${name === '' ? '' : ` File: ${name}.`}`;
    this.state.className = `live-state ${state}`;
    this.fit.disabled = state !== 'ended';
    if (unit !== this.plot.unit && unit) {
      this.plot.unit = unit;
      this.plot.chart.rebuild();
    }
  }

  private tellSamples(): void {
    const { count, time, values, last } = this.samples;
    if (last === null) return;
    const rate = this.now.rate_hz;
    const parts = [
      `${Math.max(count, this.now.samples)} samples`,
      `${fixed(last - time[0], 1)} s`,
      rate ? `${significant(rate, 4)} Hz` : '',
      `last reading ${significant(values[count - 1], 4)}${spacedUnit(this.now.unit ?? '')}`,
    ];
    this.numbers.textContent = parts.filter((part) => part !== '').join(' · ');
  }

  private take = ({ event, data }: ServerEvent): boolean => {
    if (event === 'samples') {
      const { time_s, values } = JSON.parse(data) as { time_s: number[]; values: (number | null)[] };
      this.samples.add(time_s, values);
    } else if (event === 'state') {
      this.now = JSON.parse(data) as LiveState;
      if (this.now.state === 'waiting') this.samples.clear(); // a new run begins, or the service sends this run again
      this.tell();
    } else {
      return false;
    }
    this.tellSamples();
    this.plot.update();
    return false;
  };

  private fitIt(): void {
    const { signal } = this.place;
    void attempt(this.fit, this.problems, async () => {
      this.place.say('Fitting …');
      const content = await (await ask('/v1/live/recording', { signal })).blob();
      const name = this.now.name || 'live recording';
      go(await sent(await submission([{ name, content }], await chosenForNext()), signal));
    });
  }

  async show(): Promise<void> {
    const { main, signal } = this.place;
    const spans = [
      { value: '20', label: 'last 20 s' },
      { value: '', label: 'all' },
    ];
    const chooser = choice('Shown', spans, '20', (value) => {
      this.plot.span = value === '' ? null : Number(value);
      this.plot.zoom(null);
    });
    const words = text('Once the recording has ended it can be fitted, with the choices of ', 'quiet');
    words.append(el('a', { href: '/' }, 'New fit'), '; until then the pendulum is best left alone.');
    main.append(
      this.state,
      this.connection,
      figure(this.numbers, this.plot.chart.host, chooser),
      text('Drag to zoom; a double click follows the recording again.', 'quiet'),
      this.fit,
      words,
      this.problems,
    );
    const connected = (): void => {
      this.samples.clear(); // after a new connection the service sends the whole run again
      this.connection.textContent = '';
    };
    const lost = (s: number): void =>
      void (this.connection.textContent = `The connection broke off; next attempt in ${Math.ceil(s)} s.`);
    await follow('/v1/live/events', { take: this.take, connected, lost }, signal).catch((error: unknown) => {
      if (!signal.aborted) showProblem(this.problems, error);
    });
  }
}

const kNotLive = 'This service does not follow a recording: it was started without --live.';

export const liveView: View = async (place) => {
  place.name('Live');
  try {
    const state = await askJson<LiveState>('/v1/live', { signal: place.signal });
    await new LiveView(place, state).show();
  } catch (error) {
    if (!(error instanceof ProblemError && error.problem.status === 404)) throw error;
    const start = el(
      'p',
      {},
      'To see a recording while it is made, start the service with ',
      el('code', {}, 'serve_pendulum --store fits.sqlite --live run.csv'),
      ' and the recorder with ',
      el('code', {}, 'record_pendulum --out run.csv'),
      '.',
    );
    place.main.append(text(kNotLive), start);
  }
};
