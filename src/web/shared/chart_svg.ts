// SPDX-License-Identifier: Apache-2.0
/**
 * Draws a plot as SVG for a report or slide: title, legend, axes, ticks and labels, and the curves by the same Painter as
 * on the canvas. Its letters can be read in print 8 cm wide.
 */

import { logTicks, roundTicks, tickTexts } from './axes';
import type { ChartOptions, Key, Range } from './chart';
import type { Mark } from './marks';
import { kPlotFont, Painter, type Frame } from './painter';
import { significant } from './rounding';
import { SvgContext } from './svg_context';
import { colour } from './theme';

const kWidth = 640; // px
const kFont = 20; // px: 2.5 mm in print 8 cm wide
const kCharacter = 0.56 * kFont; // width of an average one
const kLine = 1.4 * kFont;
const kTitle = 1.8 * kFont; // for the title of the left axis
const kDigit = 0.6 * kFont;
const kPlot = 320; // height inside the axes
const kRight = 20;
const kRightAxis = 96;
const kBottom = 3.2 * kFont;
const kTick = 6;
const kSwatch = 26;
const kCharacterHeight = 0.35 * kFont; // from the middle of a digit to its baseline

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

/** The mark of a curve, as in the legend of the page. */
function swatchAt(ctx: SvgContext, mark: Mark, x: number, y: number): void {
  ctx.beginPath();
  if (mark.points) {
    ctx.fillStyle = colour(mark.colour);
    for (const part of [0.2, 0.5, 0.8]) ctx.arc(x + part * kSwatch, y, 2.5);
    ctx.fill();
    return;
  }
  ctx.strokeStyle = colour(mark.colour);
  ctx.lineWidth = 2.5;
  ctx.setLineDash(mark.dash);
  ctx.moveTo(x, y);
  ctx.lineTo(x + kSwatch, y);
  ctx.stroke();
}

function xAxis(ctx: SvgContext, { box, x }: Frame, ticks: Tick[], label: string): void {
  const bottom = box.top + box.height;
  for (const tick of ticks) {
    line(ctx, x(tick.at), box.top, x(tick.at), bottom + kTick, 'grid');
    words(ctx, tick.label, x(tick.at), bottom + 1.3 * kFont, 'center');
  }
  words(ctx, label, box.left + box.width / 2, bottom + 2.7 * kFont, 'center');
}

function yAxis(ctx: SvgContext, { box, y }: Frame, ticks: Tick[], label: string): void {
  for (const tick of ticks) {
    line(ctx, box.left - kTick, y(tick.at), box.left + box.width, y(tick.at), 'grid');
    words(ctx, tick.label, box.left - 8, y(tick.at) + kCharacterHeight, 'right');
  }
  ctx.textAlign = 'center';
  ctx.upwards(label, kFont, box.top + box.height / 2);
}

function rightAxis(ctx: SvgContext, { box, y }: Frame, ticks: Tick[], label: string): void {
  const right = box.left + box.width;
  for (const tick of ticks) words(ctx, tick.label, right + 8, y(tick.at) + kCharacterHeight, 'left');
  ctx.textAlign = 'center';
  ctx.upwards(label, right + kRightAxis - 6, box.top + box.height / 2);
}

/** Every tick, or every second, fourth and so on, so that their labels do not touch on an axis of this length, px. */
function spaced(ticks: Tick[], length: number): Tick[] {
  const widest = kFont + kDigit * Math.max(1, ...ticks.map(({ label }) => label.length));
  let stride = 1;
  while (ticks.length * widest > stride * length) stride *= 2;
  return ticks.filter((_tick, i) => i % stride === 0);
}

/** The first characters of a text that are at most so wide, px. */
function shortened(text: string, width: number): string {
  const most = Math.max(1, Math.floor(width / kCharacter));
  return text.length > most ? `${text.slice(0, most - 1)}…` : text;
}

/** Draws the entries in as many lines as they need. Returns the place below them, px. */
function drawLegend(ctx: SvgContext, keys: Key[], left: number, top: number): number {
  let [x, y] = [left, top];
  for (const { name, mark } of keys) {
    const label = shortened(name, kWidth - left - kRight - kSwatch);
    const width = kSwatch + 8 + kCharacter * label.length + kFont;
    if (x > left && x + width > kWidth) [x, y] = [left, y + kLine];
    swatchAt(ctx, mark, x, y + 0.65 * kFont);
    words(ctx, label, x + kSwatch + 8, y + kFont, 'left');
    x += width;
  }
  return y + kLine;
}

/** The plot as an SVG file. */
export function chartSvg(options: ChartOptions, title: string): string {
  const log = options.yLog?.() ?? false;
  const [xRange, yRange] = [options.xRange(), options.yRange()];
  const yTicks = ticksOf(yRange, log);
  const left = kTitle + kDigit * Math.max(3, ...yTicks.map(({ label }) => label.length));
  const right = options.right ? kRightAxis : kRight;
  const ctx = new SvgContext(options.name ?? 'plot');
  const keys = options.legend?.() ?? [];
  words(ctx, shortened(title, kWidth - 2 * kRight), kRight, 1.3 * kFont, 'left');
  const top = keys.length > 0 ? drawLegend(ctx, keys, kRight, 1.7 * kFont) + 0.3 * kFont : 2 * kFont;
  const box = { left, top, width: kWidth - left - right, height: kPlot };
  const frame: Frame = {
    ctx,
    box,
    ratio: 1,
    x: scale(xRange, false, box.left, box.left + box.width),
    y: scale(yRange, log, box.top + box.height, box.top),
    xRange,
    yRange,
  };
  xAxis(ctx, frame, spaced(ticksOf(xRange, false), box.width), options.xLabel || 'time [s]');
  yAxis(ctx, frame, yTicks, options.yLabel());
  if (options.right) rightAxis(ctx, frame, ticksOf(yRange, log, options.right.factor), options.right.label);
  const painter = new Painter(frame);
  painter.inside(() => options.draw(painter));
  const height = Math.ceil(top + kPlot + kBottom);
  return ctx.text(kWidth, height, kFont, colour('paper'), kPlotFont, options.sentence());
}
