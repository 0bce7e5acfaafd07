// SPDX-License-Identifier: Apache-2.0
/** Which curve is shown while the reader moves sliders. */

import { Newest } from '../newest';
import { Cancelled } from '../server/problem';

/** Readings `values` at `time`, and the rms of measured - value; NaN if there are none. */
export interface Curve {
  time: Float64Array;
  values: Float64Array;
  rms: number;
}

type Changed = Record<string, number>;

export class FollowedCurve {
  private last: Curve; // with readings
  private readonly newest = new Newest<Changed>((changed, dropped) => this.showFor(changed, dropped));

  /**
   * best: the curve of the fit. ask: the curve for parameters that differ from the fit. show: shows a curve, and why it
   * is not the one that was asked for. left: aborted when the reader has left the view.
   */
  constructor(
    private readonly best: Curve,
    private readonly ask: (changed: Changed, signal: AbortSignal) => Promise<Curve>,
    private readonly show: (curve: Curve, problem?: unknown) => void,
    private readonly left: AbortSignal,
  ) {
    this.last = best;
  }

  /** Shows the curve for the parameters that differ from the fit; that of the fit at once, if there are none. */
  async follow(changed: Changed): Promise<void> {
    if (Object.keys(changed).length > 0) return this.newest.ask(changed);
    this.newest.drop();
    this.last = this.best;
    this.show(this.best);
  }

  /** A reader who cancels keeps the last curve; after a problem there is none. */
  private async showFor(changed: Changed, dropped: AbortSignal): Promise<void> {
    const ended = AbortSignal.any([this.left, dropped]);
    try {
      const curve = await this.ask(changed, ended);
      if (!ended.aborted) this.last = curve;
    } catch (error) {
      if (ended.aborted) return;
      const { time } = this.best;
      const none = { time, values: time.map(() => NaN), rms: NaN };
      return this.show(error instanceof Cancelled ? this.last : none, error);
    }
    if (!ended.aborted) this.show(this.last);
  }
}
