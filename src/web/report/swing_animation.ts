// SPDX-License-Identifier: Apache-2.0
/** The pendulum, swinging at true speed as it was measured and as it was fitted. */

import { button, el, text } from '../shared/dom';
import { svg, type Mark } from '../shared/marks';
import { fixed } from '../shared/rounding';
import { extent, lowerBound, type Samples } from '../shared/samples';
import type { TimeView } from '../shared/time_view';
import { zeroOf } from './envelope';
import { shownFitOf, type OneRecording } from './report';

/** angle: rad from hanging straight down, at `time` in s; NaN for a missing value. */
export interface Swinging {
  name: string;
  mark: Mark;
  time: Float64Array;
  angle: Float64Array;
}

/** The value at time t on the straight line between its neighbours; NaN outside. */
export function valueAt(time: Float64Array, values: Float64Array, t: number): number {
  const next = lowerBound(time, t);
  if (time[next] === t) return values[next];
  if (next === 0 || next === time.length) return NaN;
  const share = (t - time[next - 1]) / (time[next] - time[next - 1]);
  return values[next - 1] + share * (values[next] - values[next - 1]);
}

/** The measured motion, if the readings are angles, and the motion of the law that is shown. */
export function swingsOf(one: OneRecording, samples: Samples, measured: Mark, fitted: Mark): Swinging[] {
  const fit = shownFitOf(one);
  const { time, unit } = samples;
  const zero = zeroOf(fit?.parameters ?? {}, one.data.window_s[0]);
  const fromZero = (values: Float64Array): Float64Array => values.map((value, i) => value - zero(time[i]));
  const swings: Swinging[] = [];
  if (unit === 'rad') swings.push({ name: 'measured', mark: measured, time, angle: fromZero(samples.measured) });
  if (!fit) return swings;
  const motion = samples.motions.get(fit.model);
  const values = samples.models.get(fit.model)?.fitted;
  if (motion) swings.push({ name: fit.model, mark: fitted, time: motion.time, angle: motion.angle });
  else if (values && unit === 'rad') swings.push({ name: fit.model, mark: fitted, time, angle: fromZero(values) });
  return swings;
}

const kSteps = 1000; // of the slider

/** A rod with its bob; the measured one is a dot, the fitted one a ring about it. */
class Rod {
  readonly element: SVGElement;

  constructor(private readonly swing: Swinging) {
    const colour = `var(--${swing.mark.colour})`;
    const [bob, width] = swing.mark.points ? ['0.07', '0.02'] : ['0.13', '0.035'];
    this.element = svg('g', { 'data-swing': swing.name, stroke: colour, 'stroke-width': width });
    this.element.append(
      svg('line', { x1: '0', y1: '0', x2: '0', y2: '1' }),
      svg('circle', { cx: '0', cy: '1', r: bob, fill: swing.mark.points ? colour : 'none' }),
    );
  }

  show(t: number): void {
    const angle = valueAt(this.swing.time, this.swing.angle, t);
    this.element.setAttribute('visibility', Number.isFinite(angle) ? 'visible' : 'hidden');
    // In SVG a positive angle turns clockwise; the pendulum's positive angle is to the right of the pivot.
    if (Number.isFinite(angle)) this.element.setAttribute('transform', `rotate(${(-180 / Math.PI) * angle})`);
  }
}

/** `onTime` gets the time that is shown. It begins to swing when it is made, unless the reader prefers less motion. */
export class SwingAnimation {
  readonly element: HTMLElement;
  private readonly rods: Rod[];
  private readonly slider = el('input', { type: 'range', 'aria-label': 'Time', step: 'any' });
  private readonly clock = text('', 'quiet');
  private readonly press = button('Pause', () => this.play(!this.playing));
  private playing = false;
  private time: number;

  /** scale: true seconds of a second of the file. */
  constructor(
    swings: readonly Swinging[],
    private readonly view: TimeView,
    private readonly scale: number,
    private readonly onTime: (time: number) => void,
  ) {
    this.rods = swings.map((swing) => new Rod(swing));
    this.time = view.current[0];
    const names = swings.map((swing) => swing.name).join(' and ');
    const [low, high] = extent(swings.map((swing) => swing.angle)) ?? [0, 0];
    const isBelow = Math.max(-low, high) < 0.5 * Math.PI; // and nothing is drawn above the pivot
    const picture = svg('svg', { viewBox: isBelow ? '-1.2 -0.1 2.4 1.3' : '-1.2 -1.2 2.4 2.4', role: 'img', 'aria-label': `The pendulum, ${names}` });
    picture.append(svg('circle', { cx: '0', cy: '0', r: '0.04', fill: 'var(--ink)' }), ...this.rods.map((rod) => rod.element));
    this.slider.addEventListener('input', () => {
      this.play(false);
      this.show(Number(this.slider.value));
    });
    this.element = el('div', { class: 'pendulum' }, picture as unknown as HTMLElement, this.clock, this.slider, this.press);
    this.show(this.time);
    this.play(!matchMedia('(prefers-reduced-motion: reduce)').matches);
  }

  stop(): void {
    this.play(false);
  }

  private show(time: number): void {
    const [from, to] = this.view.current;
    this.time = Math.min(Math.max(time, from), to);
    this.slider.min = String(from);
    this.slider.max = String(to);
    this.slider.step = String((to - from) / kSteps);
    this.slider.value = String(this.time);
    this.clock.textContent = `t = ${fixed(this.time, 2)} s`;
    for (const rod of this.rods) rod.show(this.time);
    this.onTime(this.time);
  }

  private play(on: boolean): void {
    this.press.textContent = on ? 'Pause' : 'Play';
    if (on === this.playing) return;
    this.playing = on;
    let before: number | null = null;
    const step = (now: number): void => {
      if (!this.playing) return;
      if (before !== null) {
        if (!this.element.isConnected) return this.play(false);
        const next = this.time + (now - before) / 1000 / this.scale;
        this.show(next > this.view.current[1] ? this.view.current[0] : next);
      }
      before = now;
      requestAnimationFrame(step);
    };
    if (on) requestAnimationFrame(step);
  }
}
