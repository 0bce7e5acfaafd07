// SPDX-License-Identifier: Apache-2.0
/** One plot: uPlot provides axes, cursor and selection; the curves are drawn by a Painter. */

import './pixel_ratio';

import uPlot from 'uplot';

import { xAxis, yAxis } from './axes';
import { chartSvg } from './chart_svg';
import { el } from './dom';
import { Painter, type Frame } from './painter';
import type { Mark } from './marks';
import { saveButtons } from './save';
import { onThemeChange, printing } from './theme';

export type Range = readonly [number, number];

/** An entry of a legend. */
export interface Key {
  name: string;
  mark: Mark;
}

export interface ChartOptions {
  /** Name of the files in which the plot is saved; default: "plot". */
  name?: string;
  /** Description of the plot in a sentence, for screen readers. */
  sentence: () => string;
  xLabel: string;
  yLabel: () => string;
  /** Called at every drawing. */
  xRange: () => Range;
  yRange: () => Range;
  draw: (painter: Painter) => void;
  height: number;
  yLog?: () => boolean;
  /** What the curves are, for pictures that leave the page. */
  legend?: () => Key[];
  /** A second axis on the right. */
  right?: { label: string; factor: number } | null;
  /** Reserves the same space left and right in plots that are placed one above the other. */
  aligned?: 'with right axis' | 'without';
  onSelect?: (from: number, to: number) => void;
  onCursor?: (x: number | null) => void;
}

const kPaperWidth = 664; // px: A4 between margins
const kHalfPaper = 316;
const kPaperHeight = 0.62; // of the height on a screen, so that answer and swing are on one page
const kLeastPaperHeight = 150; // px
const kNarrow = 520; // px; narrower plots have no space for a second axis
const kLeftRoom = 56; // px, for tick labels of aligned plots
const kRightRoom = 44;
const kLabelRoom = 20;
const kMargin = 28; // px, for half a tick label

export class Chart {
  readonly host: HTMLElement;
  private plot: uPlot | null = null;
  private width = 0;
  private wasThere = false;
  private readonly observer: ResizeObserver;
  private readonly forget: () => void;

  constructor(private readonly options: ChartOptions) {
    this.host = el('div', { class: 'plot', role: 'img' });
    this.host.style.minHeight = `${options.height}px`;
    this.observer = new ResizeObserver(() => this.fit());
    this.observer.observe(this.host);
    this.forget = onThemeChange(() => this.rebuild());
  }

  /** The plot with the buttons that save it. */
  withButtons(): HTMLElement {
    const { name = 'plot' } = this.options;
    return el('div', { class: 'chart' }, this.host, saveButtons(name, (title) => chartSvg(this.options, title)));
  }

  /** The element inside the axes. */
  get over(): HTMLElement | null {
    return this.plot?.over ?? null;
  }

  /** Number of pixel columns inside the axes; an estimate before the first drawing. */
  get columns(): number {
    return this.plot?.over.clientWidth || Math.max(100, this.width - 110);
  }

  /** The x value at a distance of `px` from the left end of the axes. */
  xAt(px: number): number {
    return this.plot?.posToVal(px, 'x') ?? NaN;
  }

  /** Places the cursor at an x value, as the pointer does; null removes it. */
  pointAt(x: number | null): void {
    this.plot?.setCursor({ left: x === null ? -10 : this.plot.valToPos(x, 'x'), top: x === null ? -10 : 0 });
  }

  /** Whether the plot was removed from the page. It does not draw any more. */
  get removed(): boolean {
    return this.wasThere && !this.host.isConnected;
  }

  /** Draws again after the data or ranges have changed. */
  update(): void {
    this.host.setAttribute('aria-label', this.options.sentence());
    if (!this.plot) return;
    const [x, y] = [this.options.xRange(), this.options.yRange()];
    this.plot.batch(() => {
      this.plot?.setScale('x', { min: x[0], max: x[1] });
      this.plot?.setScale('y', { min: y[0], max: y[1] });
      this.plot?.redraw(false, true);
    });
  }

  /** Creates the plot again after colours, kinds of axes or labels have changed. */
  rebuild(): void {
    if (this.gone()) return;
    this.plot?.destroy();
    this.plot = null;
    this.width = 0;
    this.fit();
  }

  destroy(): void {
    this.observer.disconnect();
    this.forget();
    this.plot?.destroy();
    this.plot = null;
  }

  /** Whether the plot is not in the page. Destroys it if it was removed. */
  private gone(): boolean {
    if (this.host.isConnected) this.wasThere = true;
    else if (this.wasThere) this.destroy();
    return !this.host.isConnected;
  }

  private fit(): void {
    if (this.gone()) return;
    const room = this.host.clientWidth;
    const width = printing() ? this.paperWidth() : room;
    if (width < 40 || width === this.width) return;
    this.width = width;
    this.plot?.destroy();
    this.plot = new uPlot(
      this.uPlotOptions(width),
      [
        [0, 1],
        [0, 1],
      ],
      this.host,
    );
    this.update();
  }

  private paperWidth(): number {
    return this.host.closest('.pair') ? kHalfPaper : kPaperWidth;
  }

  private uPlotOptions(width: number): uPlot.Options {
    const options = this.options;
    const axes = [
      xAxis(options.xLabel),
      yAxis(options.yLabel, { log: options.yLog?.(), room: options.aligned && kLeftRoom }),
    ];
    const wide = width >= kNarrow;
    if (options.right && wide) {
      axes.push(
        yAxis(() => options.right!.label, {
          right: true,
          factor: options.right.factor,
          room: options.aligned && kRightRoom,
        }),
      );
    }
    const margin =
      axes.length > 2 ? 0 : options.aligned === 'with right axis' && wide ? kRightRoom + kLabelRoom : kMargin;
    return {
      width,
      height: printing() ? Math.max(kLeastPaperHeight, Math.round(kPaperHeight * options.height)) : options.height,
      padding: [10, margin, 0, 0],
      legend: { show: false },
      cursor: {
        show: options.onCursor !== undefined || options.onSelect !== undefined,
        y: false,
        points: { show: false },
        drag: { x: options.onSelect !== undefined, y: false, setScale: false },
      },
      scales: {
        x: { time: false, auto: false, range: (_plot, low, high) => [low ?? 0, high ?? 1] },
        y: { auto: false, distr: options.yLog?.() ? 3 : 1, range: (_plot, low, high) => [low ?? 0, high ?? 1] },
      },
      axes,
      series: [{}, { scale: 'y', show: true, paths: () => null, points: { show: false } }],
      hooks: this.hooks(),
    };
  }

  private hooks(): uPlot.Hooks.Arrays {
    const { draw, onSelect, onCursor } = this.options;
    return {
      draw: [
        (plot) => {
          const painter = new Painter(frameOf(plot));
          painter.inside(() => draw(painter));
        },
      ],
      setSelect: [
        (plot) => {
          if (!onSelect || plot.select.width < 4) return;
          const { left, width } = plot.select;
          plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          onSelect(plot.posToVal(left, 'x'), plot.posToVal(left + width, 'x'));
        },
      ],
      setCursor: [
        (plot) => {
          const { left } = plot.cursor;
          onCursor?.(left === undefined || left === null || left < 0 ? null : plot.posToVal(left, 'x'));
        },
      ],
    };
  }
}

/** The area of a plot on its canvas. */
function frameOf(plot: uPlot): Frame {
  const end = ({ min, max }: uPlot.Scale): Range => [min ?? 0, max ?? 1];
  return {
    ctx: plot.ctx,
    box: plot.bbox,
    ratio: window.devicePixelRatio,
    x: (value) => plot.valToPos(value, 'x', true),
    y: (value) => plot.valToPos(value, 'y', true),
    xRange: end(plot.scales.x),
    yRange: end(plot.scales.y),
  };
}

/** The range plus a share of its width at both ends; a range of nonzero width for a constant. */
export function padded(range: Range | null, share = 0.06): Range {
  if (!range) return [-1, 1];
  const width = range[1] - range[0] || Math.abs(range[0]) || 1;
  return [range[0] - share * width, range[1] + share * width];
}
