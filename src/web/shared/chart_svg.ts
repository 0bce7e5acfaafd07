// SPDX-License-Identifier: Apache-2.0
/** Draws a plot as SVG: axes, ticks and labels, and the curves by the same Painter as on the canvas. */

import { logTicks, roundTicks, tickTexts } from './axes';
import type { ChartOptions, Range } from './chart';
import { kPlotFont, Painter, type Frame } from './painter';
import { significant } from './rounding';
import { SvgContext } from './svg_context';
import { colour } from './theme';

const kTitle = 38; // px, for the title of the left axis
const kDigit = 7.6; // px
const kRight = 16;
const kRightAxis = 64;
const kTop = 12;
const kBottom = 46;
const kTick = 5;
const kCharacterHeight = 4; // px from the middle of a digit to its baseline

interface Tick {
  at: number;
  label: string;
}

function ticksOf([low, high]: Range, log: boolean, factor = 1): Tick[] {
  if (log) return logTicks(low, high).map((at) => ({ at, label: significant(at, 2) }));
  const ticks = roundTicks(factor * low, factor * high);
  const labels = tickTexts(ticks, ticks.length > 1 ? ticks[1] - ticks[0] : factor * (high - low));
  return ticks.map((tick, i) => ({ at: tick / factor, label: labels[i] }));
}

/** Position of a value between two ends, with a linear or logarithmic scale. */
function scale([low, high]: Range, log: boolean, from: number, to: number): (value: number) => number {
  const of = log ? Math.log10 : (x: number): number => x;
  const [first, last] = [of(low), of(high)];
  return (value) => from + ((of(value) - first) / (last - first)) * (to - from);
}

function line(ctx: SvgContext, x1: number, y1: number, x2: number, y2: number, name: string): void {
  ctx.strokeStyle = colour(name);
  ctx.lineWidth = 1;
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.moveTo(x1, y1);
  ctx.lineTo(x2, y2);
  ctx.stroke();
}

function words(ctx: SvgContext, label: string, x: number, y: number, align: CanvasTextAlign): void {
  ctx.fillStyle = colour('ink');
  ctx.textAlign = align;
  ctx.fillText(label, x, y);
}

function xAxis(ctx: SvgContext, { box, x }: Frame, ticks: Tick[], label: string): void {
  const bottom = box.top + box.height;
  for (const tick of ticks) {
    line(ctx, x(tick.at), box.top, x(tick.at), bottom + kTick, 'grid');
    words(ctx, tick.label, x(tick.at), bottom + 18, 'center');
  }
  words(ctx, label, box.left + box.width / 2, bottom + 38, 'center');
}

function yAxis(ctx: SvgContext, { box, y }: Frame, ticks: Tick[], label: string): void {
  for (const tick of ticks) {
    line(ctx, box.left - kTick, y(tick.at), box.left + box.width, y(tick.at), 'grid');
    words(ctx, tick.label, box.left - 8, y(tick.at) + kCharacterHeight, 'right');
  }
  ctx.textAlign = 'center';
  ctx.upwards(label, 16, box.top + box.height / 2);
}

function rightAxis(ctx: SvgContext, { box, y }: Frame, ticks: Tick[], label: string): void {
  const right = box.left + box.width;
  for (const tick of ticks) words(ctx, tick.label, right + 8, y(tick.at) + kCharacterHeight, 'left');
  ctx.textAlign = 'center';
  ctx.upwards(label, right + kRightAxis - 6, box.top + box.height / 2);
}

/** The plot as an SVG file of this size, px. */
export function chartSvg(options: ChartOptions, width: number, height: number): string {
  const log = options.yLog?.() ?? false;
  const [xRange, yRange] = [options.xRange(), options.yRange()];
  const yTicks = ticksOf(yRange, log);
  const left = kTitle + kDigit * Math.max(3, ...yTicks.map(({ label }) => label.length));
  const right = options.right ? kRightAxis : kRight;
  const box = { left, top: kTop, width: width - left - right, height: height - kTop - kBottom };
  const ctx = new SvgContext(options.name ?? 'plot');
  const frame: Frame = {
    ctx,
    box,
    ratio: 1,
    x: scale(xRange, false, box.left, box.left + box.width),
    y: scale(yRange, log, box.top + box.height, box.top),
    xRange,
    yRange,
  };
  xAxis(ctx, frame, ticksOf(xRange, false), options.xLabel || 'time [s]');
  yAxis(ctx, frame, yTicks, options.yLabel());
  if (options.right) rightAxis(ctx, frame, ticksOf(yRange, log, options.right.factor), options.right.label);
  const painter = new Painter(frame);
  painter.inside(() => options.draw(painter));
  return ctx.text(width, height, colour('paper'), kPlotFont, options.sentence());
}
