// SPDX-License-Identifier: Apache-2.0
/** A sketch of a recording that is not fitted yet, with the window that a fit would use. */

import { Chart, padded } from '../../shared/chart';
import { kMeasured } from '../../shared/marks';
import type { Painter } from '../../shared/painter';
import { windowText } from '../../shared/rounding';
import { extent, toArray } from '../../shared/samples';
import { unitText } from '../../shared/units';
import type { Preview, WholeRecording } from '../types';

const kQuantities: Record<string, string> = {
  'deg': 'angle',
  'rad': 'angle',
  'deg/s': 'rate',
  'rad/s': 'rate',
  'm/s^2': 'acceleration',
};

export class Sketch {
  readonly chart: Chart;
  private readonly time: Float64Array;
  private readonly values: Float64Array;

  constructor(
    recording: WholeRecording,
    private readonly window: Preview['window'],
  ) {
    this.time = Float64Array.from(recording.time_s);
    this.values = toArray(recording.measured, this.time.length) ?? new Float64Array(0);
    const unit = unitText(recording.unit);
    const quantity = kQuantities[recording.unit] ?? 'reading';
    const [first, last] = [this.time[0] ?? 0, this.time[this.time.length - 1] ?? 1];
    this.chart = new Chart({
      sentence: () =>
        `The recording from ${windowText([first, last])}, ${quantity} in ${unit}; ${this.windowWords}.`,
      xLabel: 'time [s]',
      yLabel: () => `${quantity} [${unit}]`,
      xRange: () => padded([first, last], 0.01),
      yRange: () => padded(extent([this.values])),
      draw: (painter) => this.draw(painter),
      height: 210,
    });
  }

  private get windowWords(): string {
    return this.window ? `window from ${windowText(this.window.window_s)}` : 'no window';
  }

  private draw(painter: Painter): void {
    if (this.window) painter.span(...this.window.window_s, 'band');
    painter.line(this.time, this.values, { ...kMeasured, width: 1.25 });
    for (const end of this.window?.window_s ?? []) painter.vertical(end, 'rule', [4, 4]);
  }
}
