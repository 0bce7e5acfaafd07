// SPDX-License-Identifier: Apache-2.0
/** Colours, dashes and markers of curves. Each alone distinguishes the curves (palette of Okabe & Ito in style.css). */

import { el } from './dom';

export interface Mark {
  /** Name of a colour in style.css. */
  colour: string;
  /** Lengths of dash and space in turn, px; empty for a solid line. */
  dash: number[];
  width: number;
  /** Points instead of a line. */
  points?: boolean;
}

export const kMeasured: Mark = { colour: 'dot', dash: [], width: 1, points: true };
export const kLinear: Mark = { colour: 'curve-2', dash: [7, 4], width: 1.75 };
export const kNonlinear: Mark = { colour: 'curve-3', dash: [7, 3, 1.5, 3], width: 1.75 };
export const kApparent: Mark = { colour: 'curve-2', dash: [7, 4], width: 1.75 };

const kModels: Mark[] = [
  { colour: 'curve-1', dash: [], width: 2.5 },
  { colour: 'curve-4', dash: [10, 3], width: 1.75 },
  { colour: 'curve-5', dash: [2, 3], width: 1.75 },
  { colour: 'curve-6', dash: [10, 3, 2, 3], width: 1.75 },
  { colour: 'curve-2', dash: [5, 2], width: 1.75 },
  { colour: 'curve-3', dash: [4, 2, 1, 2, 1, 2], width: 1.75 },
];

/** Mark of a model by its rank. The best one is a solid blue line. Closed forms have other colours. */
export const modelMark = (rank: number): Mark => kModels[rank % kModels.length];

const kDashes = [[], [8, 3], [2, 3], [10, 3, 2, 3]];

/** Mark of recording k, counted from 0. */
export const recordingMark = (k: number): Mark => ({
  colour: `curve-${(k % 6) + 1}`,
  dash: kDashes[Math.floor(k / 6) % kDashes.length],
  width: 1.5,
});

const kSvg = 'http://www.w3.org/2000/svg';

/** An SVG element. */
export function svg(tag: string, attributes: Record<string, string>): SVGElement {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

/** Picture of the mark for a legend. */
export function swatch(mark: Mark): HTMLElement {
  const stroke = `var(--${mark.colour})`;
  const picture = svg('svg', { viewBox: '0 0 26 10', width: '26', height: '10', 'aria-hidden': 'true' });
  if (mark.points) {
    for (const x of ['5', '13', '21']) picture.append(svg('circle', { cx: x, cy: '5', r: '2', fill: stroke }));
  } else {
    picture.append(
      svg('path', { d: 'M0 5H26', stroke, 'stroke-width': '2.25', 'stroke-dasharray': mark.dash.join(' ') }),
    );
  }
  const box = el('span', { class: 'swatch' });
  box.append(picture);
  return box;
}
