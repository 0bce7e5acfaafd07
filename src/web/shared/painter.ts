// SPDX-License-Identifier: Apache-2.0
/** Draws in the coordinates of the axes of a plot. */

import type { Mark } from './marks';
import { colour } from './theme';

type Numbers = ArrayLike<number>;

/** The part of a canvas context that a Painter uses. */
export type Context = Pick<
  CanvasRenderingContext2D,
  | 'arc'
  | 'beginPath'
  | 'clip'
  | 'closePath'
  | 'fill'
  | 'fillRect'
  | 'fillStyle'
  | 'fillText'
  | 'font'
  | 'lineJoin'
  | 'lineTo'
  | 'lineWidth'
  | 'moveTo'
  | 'rect'
  | 'restore'
  | 'save'
  | 'setLineDash'
  | 'stroke'
  | 'strokeStyle'
  | 'textAlign'
  | 'textBaseline'
>;

/** Where a Painter draws: the area inside the axes, and the positions of values. Lengths in units of the context. */
export interface Frame {
  ctx: Context;
  box: { left: number; top: number; width: number; height: number };
  /** Units of the context in a px. */
  ratio: number;
  x: (value: number) => number;
  y: (value: number) => number;
  /** Values at the left and right end of the axes, and at the bottom and the top. */
  xRange: readonly [number, number];
  yRange: readonly [number, number];
}

export class Painter {
  private readonly ctx: Context;
  private readonly ratio: number;
  private readonly x: (value: number) => number;
  private readonly y: (value: number) => number;

  constructor(private readonly frame: Frame) {
    ({ ctx: this.ctx, ratio: this.ratio, x: this.x, y: this.y } = frame);
  }

  /** Calls `draw` with drawing restricted to the area inside the axes. */
  inside(draw: () => void): void {
    const { left, top, width, height } = this.frame.box;
    this.ctx.save();
    this.ctx.beginPath();
    this.ctx.rect(left, top, width, height);
    this.ctx.clip();
    draw();
    this.ctx.restore();
  }

  private stroke(mark: Pick<Mark, 'colour' | 'dash' | 'width'>): void {
    this.ctx.strokeStyle = colour(mark.colour);
    this.ctx.lineWidth = mark.width * this.ratio;
    this.ctx.lineJoin = 'round';
    this.ctx.setLineDash(mark.dash.map((length) => length * this.ratio));
    this.ctx.stroke();
  }

  /** A line through the points, broken at NaN. */
  line(xs: Numbers, ys: Numbers, mark: Pick<Mark, 'colour' | 'dash' | 'width'>): void {
    this.ctx.beginPath();
    let broken = true;
    for (let i = 0; i < xs.length; ++i) {
      if (!Number.isFinite(ys[i])) {
        broken = true;
        continue;
      }
      if (broken) this.ctx.moveTo(this.x(xs[i]), this.y(ys[i]));
      else this.ctx.lineTo(this.x(xs[i]), this.y(ys[i]));
      broken = false;
    }
    this.stroke(mark);
  }

  /** Dots with this radius, px. */
  dots(xs: Numbers, ys: Numbers, name: string, radius: number): void {
    const r = radius * this.ratio;
    this.ctx.fillStyle = colour(name);
    this.ctx.beginPath();
    for (let i = 0; i < xs.length; ++i) {
      if (!Number.isFinite(ys[i])) continue;
      const x = this.x(xs[i]);
      const y = this.y(ys[i]);
      this.ctx.moveTo(x + r, y);
      this.ctx.arc(x, y, r, 0, 2 * Math.PI);
    }
    this.ctx.fill();
  }

  /** Vertical lines from low to high, with caps that reach `reach` px to each side. */
  errorBars(xs: Numbers, low: Numbers, high: Numbers, name: string, reach = 3): void {
    const cap = reach * this.ratio;
    this.ctx.beginPath();
    for (let i = 0; i < xs.length; ++i) {
      if (!(Number.isFinite(low[i]) && Number.isFinite(high[i]))) continue;
      const [x, bottom, top] = [this.x(xs[i]), this.y(low[i]), this.y(high[i])];
      this.ctx.moveTo(x, bottom);
      this.ctx.lineTo(x, top);
      this.ctx.moveTo(x - cap, bottom);
      this.ctx.lineTo(x + cap, bottom);
      this.ctx.moveTo(x - cap, top);
      this.ctx.lineTo(x + cap, top);
    }
    this.stroke({ colour: name, dash: [], width: 1.25 });
  }

  /** The area between two curves, broken at NaN. */
  area(xs: Numbers, low: Numbers, high: Numbers, name: string): void {
    this.ctx.fillStyle = colour(name);
    this.ctx.beginPath();
    for (let i = 0; i < xs.length; ++i) {
      const first = i;
      while (i < xs.length && Number.isFinite(low[i]) && Number.isFinite(high[i])) ++i;
      for (let k = first; k < i; ++k) this.ctx[k === first ? 'moveTo' : 'lineTo'](this.x(xs[k]), this.y(low[k]));
      for (let k = i - 1; k >= first; --k) this.ctx.lineTo(this.x(xs[k]), this.y(high[k]));
      if (i > first) this.ctx.closePath();
    }
    this.ctx.fill();
  }

  /** Bars from 0 to `heights`, horizontally from `left` to `right`. */
  bars(left: Numbers, right: Numbers, heights: Numbers, name: string): void {
    this.ctx.fillStyle = colour(name);
    const zero = this.y(0);
    for (let i = 0; i < left.length; ++i) {
      const x = this.x(left[i]);
      const width = Math.max(this.ratio, this.x(right[i]) - x - this.ratio);
      this.ctx.fillRect(x, Math.min(zero, this.y(heights[i])), width, Math.abs(this.y(heights[i]) - zero));
    }
  }

  /** A band from `low` to `high` over the whole width. */
  band(low: number, high: number, name: string): void {
    const { left, width } = this.frame.box;
    this.ctx.fillStyle = colour(name);
    this.ctx.fillRect(left, this.y(high), width, this.y(low) - this.y(high));
  }

  /** A band from `from` to `to` over the whole height. */
  span(from: number, to: number, name: string): void {
    const { top, height } = this.frame.box;
    this.ctx.fillStyle = colour(name);
    this.ctx.fillRect(this.x(from), top, this.x(to) - this.x(from), height);
  }

  horizontal(y: number, name: string, dash: number[] = []): void {
    this.line(this.frame.xRange, [y, y], { colour: name, dash, width: 1.25 });
  }

  vertical(x: number, name: string, dash: number[] = []): void {
    this.line([x, x], this.frame.yRange, { colour: name, dash, width: 1.25 });
  }

  /** Short text at a point, shifted vertically by dy px. align: as of a canvas. */
  words(content: string, x: number, y: number, name: string, align: CanvasTextAlign = 'left', dy = -4): void {
    this.ctx.font = `${12 * this.ratio}px ${kPlotFont}`;
    this.ctx.fillStyle = colour(name);
    this.ctx.textAlign = align;
    this.ctx.textBaseline = 'bottom';
    this.ctx.fillText(
      content,
      this.x(x) + (align === 'left' ? 4 : align === 'right' ? -4 : 0) * this.ratio,
      this.y(y) + dy * this.ratio,
    );
  }
}

export const kPlotFont = 'system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, "DejaVu Sans", sans-serif';
