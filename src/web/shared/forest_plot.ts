// SPDX-License-Identifier: Apache-2.0
/** Draws a forest plot as SVG. Positions are shares of the width, so it fits any page. */

import { roundTicks, tickTexts } from './axes';
import { el } from './dom';
import { clipped, forestRange, placeOf, type ForestRow, type Place } from './forest';
import { svg } from './marks';
import { inList, numberText } from './prose';
import { saveButtons, standalone } from './save';

const kRow = 34; // px
const kAxis = 30; // px, for ticks and tick labels
const kCharacter = 7; // px
const kLeastWidth = 190; // px, width of the axis on a phone

const percent = (share: number): string => `${Number((100 * share).toFixed(3))}%`;

const kColours: Record<ForestRow['kind'], string> = { recording: 'curve-1', joint: 'ink', random: 'curve-4' };

const colourOf = (row: ForestRow): string => `var(--${row.disagrees ? 'bad' : (row.colour ?? kColours[row.kind])})`;

/** SVG paths of the markers, centred at (0, 0). */
const kMarkers: Record<ForestRow['kind'] | 'disagrees', string> = {
  recording: 'M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0Z',
  joint: 'M-8 0L0 -7L8 0L0 7Z',
  random: 'M-5.5 -5.5H5.5V5.5H-5.5Z',
  disagrees: 'M0 -7L7 6H-7Z',
};

/** A path at a share of the width and y px from the top. */
function shape(share: number, y: number, d: string, style: Record<string, string>): SVGElement {
  const box = svg('svg', { x: percent(share), y: String(y), overflow: 'visible', width: '1', height: '1' });
  box.append(svg('path', { d, ...style }));
  return box;
}

function marks(row: ForestRow, place: Place, y: number): SVGElement[] {
  const stroke = colourOf(row);
  const line = { stroke, 'stroke-width': '2', fill: 'none' };
  const drawn = [svg('line', { x1: percent(place.from), x2: percent(place.to), y1: String(y), y2: String(y), ...line })];
  const end = (share: number, cut: boolean, arrow: string): SVGElement =>
    shape(share, y, cut ? arrow : 'M0 -4V4', line);
  if (place.from !== place.at) drawn.push(end(place.from, place.cutLow, 'M7 -5L0 0L7 5'));
  if (place.to !== place.at) drawn.push(end(place.to, place.cutHigh, 'M-7 -5L0 0L-7 5'));
  const fill = row.kind === 'random' ? 'var(--paper)' : stroke;
  const marker = kMarkers[row.disagrees ? 'disagrees' : row.kind];
  if (place.at !== null) drawn.push(shape(place.at, y, marker, { fill, stroke, 'stroke-width': '1.5' }));
  return drawn;
}

/** As many ticks as have space for their labels on a phone. */
function ticksOf([low, high]: readonly [number, number]): { share: number; label: string }[] {
  const share = (x: number): number => (x - low) / (high - low);
  const all = roundTicks(low, high).filter((tick) => share(tick) >= 0.04 && share(tick) <= 0.96);
  const labels = tickTexts(all, all.length > 1 ? all[1] - all[0] : high - low);
  const widest = Math.max(1, ...labels.map((label) => label.length)) * kCharacter + 12;
  const most = Math.max(1, Math.floor(kLeastWidth / widest));
  const stride = Math.ceil(all.length / most);
  return all.flatMap((tick, i) => (i % stride === 0 ? [{ share: share(tick), label: labels[i] }] : []));
}

function axis(range: readonly [number, number], y: number): SVGElement[] {
  const stroke = 'var(--rule)';
  const drawn = [svg('line', { x1: '0', x2: '100%', y1: String(y), y2: String(y), stroke })];
  for (const { share, label } of ticksOf(range)) {
    const x = percent(share);
    const words = svg('text', { x, y: String(y + 18), 'text-anchor': 'middle', fill: 'var(--muted)' });
    words.textContent = label;
    drawn.push(svg('line', { x1: x, x2: x, y1: String(y), y2: String(y + 5), stroke }), words);
  }
  return drawn;
}

function picture(rows: ForestRow[], range: readonly [number, number]): SVGElement {
  const height = rows.length * kRow;
  const drawing = svg('svg', { width: '100%', height: String(height + kAxis), overflow: 'visible' });
  const joint = rows.find((row) => row.kind === 'joint');
  const at = joint && placeOf(joint, range)?.at;
  if (typeof at === 'number') {
    const style = { stroke: 'var(--rule)', 'stroke-dasharray': '5 4', class: 'joint' };
    drawing.append(svg('line', { x1: percent(at), x2: percent(at), y1: '0', y2: String(height), ...style }));
  }
  rows.forEach((row, i) => {
    const place = placeOf(row, range);
    if (place) drawing.append(...marks(row, place, (i + 0.5) * kRow));
  });
  drawing.append(...axis(range, height));
  return drawing;
}

function labels(rows: ForestRow[]): HTMLElement {
  const list = el('div', { class: 'labels' });
  for (const row of rows) {
    const remark = row.disagrees ? 'disagrees' : row.estimate === null ? 'not determined' : null;
    const small = remark !== null && el('small', row.disagrees ? { class: 'no' } : {}, remark);
    list.append(el('div', row.kind === 'recording' ? {} : { class: row.kind }, row.label, small));
  }
  return list;
}

/** Description of the plot for screen readers. */
export function forestSentence(what: string, unit: string, rows: ForestRow[]): string {
  const told = rows.flatMap((row) =>
    row.estimate === null ? [] : [`${row.label}${row.disagrees ? ' (disagrees)' : ''} ${numberText(row.text)}`],
  );
  return `Forest plot of the ${what}${unit === '' ? '' : ` in ${unit}`}: ${inList(told)}.`;
}

/** Which intervals are longer than drawn, in words; empty if none is. */
export function clippedWords(rows: ForestRow[]): string {
  const range = forestRange(rows);
  const cut = range ? clipped(rows, range) : [];
  if (cut.length === 0) return '';
  return cut.length === 1
    ? `The interval of ${cut[0]} is longer than drawn (arrow); the table has it.`
    : `The intervals of ${inList(cut)} are longer than drawn (arrows); the table has them.`;
}

/** The plot with buttons that save it, with the names of its rows. `name`: of the files. */
export function savedForest(plot: HTMLElement, name: string, sentence: string, rows: ForestRow[]): HTMLElement {
  const labels = rows.map((row, i): [string, number] => [row.label, (i + 0.5) * kRow]);
  const text = (title: string): string => {
    const drawing = plot.querySelector<SVGElement>('.strip > svg');
    return drawing ? standalone(drawing, title, sentence, labels) : '';
  };
  return el('div', { class: 'chart' }, plot, saveButtons(name, text));
}

/** Null if no estimate is known. range: of the axis. */
export function forestPlot(sentence: string, rows: ForestRow[], range = forestRange(rows)): HTMLElement | null {
  if (!range) return null;
  const strip = el('div', { class: 'strip' });
  strip.append(picture(rows, range));
  return el('div', { class: 'forest', role: 'img', 'aria-label': sentence }, labels(rows), strip);
}
