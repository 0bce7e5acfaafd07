// SPDX-License-Identifier: Apache-2.0
/** The time range that linked plots show. It can be zoomed, moved and reset, and stays within the recording. */

export class TimeView {
  private range: [number, number];
  private readonly listeners = new Set<() => void>();

  /** from, to: ends of the recording, s. least: width of the narrowest range, s. */
  constructor(
    private readonly from: number,
    private readonly to: number,
    private readonly least: number,
  ) {
    this.range = [from, to];
  }

  get current(): readonly [number, number] {
    return this.range;
  }

  get whole(): boolean {
    return this.range[0] <= this.from && this.range[1] >= this.to;
  }

  onChange(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Shows [from, to], made wider if it is narrower than the narrowest range, and moved into the recording. */
  set(from: number, to: number): void {
    const width = Math.min(Math.max(to - from, this.least), this.to - this.from);
    const middle = 0.5 * (from + to);
    const start = Math.min(Math.max(middle - 0.5 * width, this.from), this.to - width);
    this.range = width >= this.to - this.from ? [this.from, this.to] : [start, start + width];
    for (const listener of this.listeners) listener();
  }

  reset(): void {
    this.set(this.from, this.to);
  }

  /** factor < 1 zooms in. The time `about` keeps its place on the screen. */
  zoom(factor: number, about = 0.5 * (this.range[0] + this.range[1])): void {
    const [from, to] = this.range;
    const width = Math.min(Math.max((to - from) * factor, this.least), this.to - this.from);
    const share = (about - from) / (to - from);
    this.set(about - share * width, about + (1 - share) * width);
  }

  /** Moves by a share of the width, to later times if positive. */
  pan(share: number): void {
    const [from, to] = this.range;
    const width = to - from;
    const start = Math.min(Math.max(from + share * width, this.from), this.to - width);
    this.set(start, start + width);
  }
}
