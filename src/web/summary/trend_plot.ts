// SPDX-License-Identifier: Apache-2.0
/** Plot of the estimates and their errors over the column of the trend, with zoom. */

import { Chart, padded, type Key, type Range } from '../shared/chart';
import { choice, el, toggle } from '../shared/dom';
import { recordingMark, swatch, type Mark } from '../shared/marks';
import { elided, visible } from '../shared/names';
import { followPointer, keyboardBox, navigationButtons, type NavigationWords } from '../shared/navigation';
import type { Painter } from '../shared/painter';
import { numberText } from '../shared/prose';
import { significant } from '../shared/rounding';
import { extent } from '../shared/samples';
import { figure } from '../shared/section';
import { TimeView } from '../shared/time_view';
import { spacedUnit, unitText, wordsOf } from '../shared/units';
import { groupCount, median, middle, nearest, trendGroups, within, xRange, type TrendGroup } from './trend';
import type { ParameterSummary, Trend } from './types';
import { counted, countText } from './words';

const kSparse = 5; // px per run; with more space, error bars have caps
const kCrowded = 2; // px per run; with less space, error bars are grey behind the points
const kLongest = 4; // times the median; longer error bars may be cut at the edge of the plot
const kLabel = 24; // characters
const kWords: NavigationWords = { group: 'Runs shown', back: 'Back', on: 'Further', all: 'Show all runs (0)' };
const kLine = { colour: 'ink', dash: [7, 4], width: 1.5 };

/** "position in the manifest", "date [days since 2026-01-01]" */
export const columnLabel = ({ column, unit }: Trend): string =>
  column === 'position' ? 'position in the manifest' : visible(column) + (unit ? ` [${unit}]` : '');

export class TrendPlot {
  private readonly groups: TrendGroup[];
  private readonly hidden = new Set<TrendGroup>();
  private readonly view: TimeView;
  private readonly chart: Chart;
  private readonly line = el('p', { class: 'readout', 'aria-hidden': 'true' }, '\u00a0');
  private readonly slope: number;
  private aboutMean: boolean;

  constructor(
    private readonly one: ParameterSummary,
    private readonly trend: Trend,
  ) {
    this.groups = trendGroups(trend);
    this.slope = trend.slope ?? 0;
    this.aboutMean = this.mixed;
    const [from, to] = xRange(this.groups);
    this.view = new TimeView(from, to, 1e-3 * (to - from));
    this.chart = new Chart({
      sentence: () => this.sentence(),
      xLabel: columnLabel(trend),
      yLabel: () => this.yLabel(),
      xRange: () => this.view.current,
      yRange: () => this.yRange(),
      draw: (painter) => this.draw(painter),
      legend: () => this.keys(),
      onSelect: (low, high) => this.view.set(low, high),
      onCursor: (x) => this.read(x),
      height: 330,
    });
    followPointer(this.chart, this.view);
    this.view.onChange(() => this.chart.update());
  }

  /** Too many groups for different colours. */
  private get mixed(): boolean {
    return this.groups.length === 1 && groupCount(this.trend) > 1;
  }

  private yLabel(): string {
    const unit = unitText(this.one.unit);
    const what = wordsOf(this.one.name) + (this.aboutMean ? ' − its group’s median' : '');
    return what + (unit && ` [${unit}]`);
  }

  private keys(): Key[] {
    return this.shown().flatMap((group) => (group.name === null ? [] : [{ name: group.name, mark: this.pointsOf(group) }]));
  }

  private shown(): TrendGroup[] {
    return this.groups.filter((group) => !this.hidden.has(group));
  }

  private y(group: TrendGroup, i: number): number {
    return group.y[i] - (this.aboutMean ? group.centre[i] : 0);
  }

  /** The points in the visible range. */
  private visible(): { group: TrendGroup; x: number[]; y: number[]; error: number[] }[] {
    const [from, to] = this.view.current;
    return this.shown().map((group) => {
      const [first, end] = within(group, from, to);
      const indices = Array.from({ length: end - first }, (_unused, i) => first + i);
      return {
        group,
        x: group.x.slice(first, end),
        y: indices.map((i) => this.y(group, i)),
        error: group.error.slice(first, end),
      };
    });
  }

  private sentence(): string {
    const [from, to] = this.view.current;
    const runs = this.visible().reduce((sum, { x }) => sum + x.length, 0);
    return `${wordsOf(this.one.name)} of ${counted(runs, 'run')} over ${columnLabel(this.trend)} from ${significant(from, 4)} to ${significant(to, 4)}.`;
  }

  private yRange(): Range {
    const shown = this.visible();
    const most = kLongest * median(shown.flatMap(({ error }) => error)) || 0;
    const reach = (error: number): number => (error <= most ? error : 0);
    const ends = shown.flatMap(({ y, error }) => [
      y.map((at, i) => at - reach(error[i])),
      y.map((at, i) => at + reach(error[i])),
    ]);
    return padded(extent(ends));
  }

  private draw(painter: Painter): void {
    const shown = this.visible();
    const room =
      this.chart.columns /
      Math.max(
        1,
        shown.reduce((sum, { x }) => sum + x.length, 0),
      );
    for (const { group, x, y, error } of shown) {
      const colour = room < kCrowded ? 'bar' : this.markOf(group).colour;
      painter.errorBars(
        x,
        y.map((at, i) => at - error[i]),
        y.map((at, i) => at + error[i]),
        colour,
        room < kSparse ? 0 : 3,
      );
    }
    for (const { group, x, y } of shown)
      painter.dots(x, y, this.markOf(group).colour, room > 12 ? 3.4 : room > kSparse ? 2.6 : 1.7);
    if (this.trend.slope !== null)
      this.drawLines(
        painter,
        shown.map(({ group }) => group),
      );
  }

  /** One line for each group, or one for all groups together. */
  private drawLines(painter: Painter, groups: TrendGroup[]): void {
    const ends = [...this.view.current];
    if (this.mixed && !this.aboutMean) return;
    const origin = middle(this.trend);
    const starts = this.aboutMean ? [0] : groups.map(({ centre }) => centre[0]);
    for (const start of starts)
      painter.line(
        ends,
        ends.map((x) => start + this.slope * (x - origin)),
        kLine,
      );
  }

  private pointsOf(group: TrendGroup): Mark {
    return { ...this.markOf(group), points: true };
  }

  private markOf(group: TrendGroup): Mark {
    return recordingMark(this.groups.indexOf(group));
  }

  /** Shows the run nearest to the cursor. */
  private read(x: number | null): void {
    const [from, to] = this.view.current;
    const found = this.shown().flatMap((group) => {
      const i = x === null ? -1 : nearest(group, x);
      return i < 0 || group.x[i] < from || group.x[i] > to ? [] : [{ group, i }];
    });
    const next = found.sort((a, b) => Math.abs(a.group.x[a.i] - x!) - Math.abs(b.group.x[b.i] - x!))[0];
    if (!next) {
      this.line.textContent = '\u00a0';
      return;
    }
    const { group, i } = next;
    const of = group.groups[i] === null ? '' : ` (${elided(group.groups[i]!, kLabel)})`;
    const value = numberText(group.texts[i]) + spacedUnit(this.one.unit);
    this.line.textContent = `${elided(group.ids[i], 40)}${of}: ${value} at ${significant(group.x[i], 6)}`;
  }

  private legend(): HTMLElement | null {
    if (this.groups.length < 2) return null;
    const box = el('div', { class: 'legend', role: 'group', 'aria-label': 'Groups shown' });
    for (const group of this.groups) {
      const change = (on: boolean): void => {
        if (on) this.hidden.delete(group);
        else this.hidden.add(group);
        this.chart.update();
      };
      const name = group.name === null ? 'no group' : elided(group.name, kLabel);
      box.append(toggle([swatch(this.pointsOf(group)), name], true, change));
    }
    return box;
  }

  private modes(): HTMLElement {
    if (groupCount(this.trend) < 2) return el('span');
    const options = [
      { value: 'value', label: 'values' },
      { value: 'about', label: 'differences within groups' },
    ];
    return choice('Drawn', options, this.aboutMean ? 'about' : 'value', (value) => {
      this.aboutMean = value === 'about';
      this.chart.rebuild();
    });
  }

  element(): HTMLElement {
    const { points, points_total: total } = this.trend;
    const hint = 'Drag to zoom, double click to show all; Shift and drag, or a finger, moves.';
    const some = total > points.length ? `${countText(points.length)} of ${counted(total, 'run')} are drawn. ` : '';
    const line = this.trend.slope === null ? '' : `Dashed: the slope${this.mixed ? ' of the differences' : ''}. `;
    const caption = el('span', {}, some + line, el('span', { class: 'hint' }, hint));
    const box = keyboardBox(
      `${wordsOf(this.one.name)} over ${columnLabel(this.trend)}`,
      this.view,
      this.chart.host,
      this.line,
    );
    return figure(
      caption,
      box,
      this.legend(),
      el('div', { class: 'bar' }, this.modes(), navigationButtons(this.view, kWords)),
    );
  }
}
