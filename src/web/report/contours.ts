// SPDX-License-Identifier: Apache-2.0
/** Confidence regions of a pair of parameters as a plot. */

import { Chart, padded } from '../shared/chart';
import { el } from '../shared/dom';
import type { Fit } from '../shared/result_types';
import { significant } from '../shared/rounding';
import { extent } from '../shared/samples';
import { figure } from '../shared/section';
import { select } from '../shared/select';
import { unitText, wordsOf } from '../shared/units';
import { covarianceOf, ellipse, kRegions, sum, type Covariance2 } from './ellipse';

export type Pair = readonly [x: string, y: string];

interface Curve {
  x: number[];
  y: number[];
  systematic: boolean;
}

function axisTitle(fit: Fit, name: string): string {
  const unit = unitText(fit.parameters[name]?.unit ?? '1');
  return `${wordsOf(name)}${unit === '' ? '' : ` [${unit}]`}`;
}

/** The regions by noise alone, and those that include systematic errors if there are any. */
function curvesOf(fit: Fit, [x, y]: Pair): Curve[] {
  const noise = covarianceOf(fit.covariance, x, y);
  const [atX, atY] = [fit.parameters[x]?.estimate, fit.parameters[y]?.estimate];
  if (!noise || typeof atX !== 'number' || typeof atY !== 'number') return [];
  const systematic = covarianceOf(fit.systematic_covariance, x, y);
  const around = (covariance: Covariance2, isSystematic: boolean): Curve[] =>
    kRegions.map(({ quantile }) => ({ ...ellipse(covariance, quantile, atX, atY), systematic: isSystematic }));
  const grows = systematic && (systematic.xx > 0 || systematic.yy > 0);
  return [...(grows ? around(sum(noise, systematic), true) : []), ...around(noise, false)];
}

function pairChart(fit: Fit, pair: Pair): HTMLElement {
  const [x, y] = pair;
  const curves = curvesOf(fit, pair);
  const both = curves.some((curve) => curve.systematic);
  const what = both ? 'solid: with all errors; dashed: from noise alone' : 'from noise';
  const sentence = `68 % and 95 % regions of ${wordsOf(x)} and ${wordsOf(y)} (${what})`;
  const center = [fit.parameters[x]?.estimate ?? NaN, fit.parameters[y]?.estimate ?? NaN];
  const chart = new Chart({
    name: `${x}_and_${y}`,
    sentence: () => `${sentence}, around ${significant(center[0], 5)} and ${significant(center[1], 5)}.`,
    xLabel: axisTitle(fit, x),
    yLabel: () => axisTitle(fit, y),
    xRange: () => padded(extent(curves.map((curve) => curve.x)), 0.08),
    yRange: () => padded(extent(curves.map((curve) => curve.y)), 0.08),
    draw: (painter) => {
      for (const curve of curves) {
        const dash = both && !curve.systematic ? [5, 3] : [];
        painter.line(curve.x, curve.y, { colour: curve.systematic || !both ? 'curve-1' : 'curve-2', dash, width: 1.75 });
      }
      painter.dots([center[0]], [center[1]], 'dot', 3);
    },
    height: 280,
  });
  return figure(`${sentence}.`, chart.withButtons());
}

/** A plot of one pair, and the choice of another. `first`: the pair that is shown first. */
export function contourPart(fit: Fit, names: readonly string[], first: Pair): HTMLElement {
  const pairs = names.flatMap((y, i) => names.slice(0, i).map((x): Pair => [x, y]));
  const place = el('div', {}, pairChart(fit, first));
  const options = pairs.map(([x, y], k) => ({ value: String(k), label: `${wordsOf(x)}, ${wordsOf(y)}` }));
  const chosen = pairs.findIndex(([x, y]) => first.includes(x) && first.includes(y));
  const chooser = select('Pair', options, String(Math.max(0, chosen)), (value) =>
    place.replaceChildren(pairChart(fit, pairs[Number(value)])),
  );
  return el('div', { class: 'contours' }, pairs.length > 1 && chooser, place);
}
