// SPDX-License-Identifier: Apache-2.0
/** Plots of the calibration: points, curve and residuals. */

import { Chart, padded } from '../../shared/chart';
import { el } from '../../shared/dom';
import { significant } from '../../shared/rounding';
import { extent } from '../../shared/samples';
import { figure } from '../../shared/section';
import { unitText } from '../../shared/units';
import type { CalibrationAnswer } from '../types';

const kSteps = 120; // points of the curve

/** c0 + c1 x + c2 x² ... */
export const polynomial = (coefficients: readonly number[], x: number): number =>
  coefficients.reduceRight((sum, c) => sum * x + c, 0);

function curveChart({ calibration, points }: CalibrationAnswer): Chart {
  const readings = points.map(({ reading }) => reading);
  const angles = points.map(({ angle }) => angle);
  const [from, to] = padded(extent([readings]));
  const xs = Array.from({ length: kSteps + 1 }, (_unused, i) => from + ((to - from) * i) / kSteps);
  const curve = xs.map((x) => polynomial(calibration.coefficients, x));
  const unit = unitText(calibration.angle_unit);
  return new Chart({
    sentence: () =>
      `Angle in ${unit} over the reading in ${calibration.input}: ${points.length} points and the curve through them.`,
    xLabel: `reading [${calibration.input}]`,
    yLabel: () => `angle [${unit}]`,
    xRange: () => [from, to],
    yRange: () => padded(extent([angles, curve])),
    draw: (painter) => {
      painter.line(xs, curve, { colour: 'curve-1', dash: [], width: 1.75 });
      painter.dots(readings, angles, 'ink', 3.6);
    },
    height: 260,
  });
}

function residualChart({ calibration, points }: CalibrationAnswer): Chart {
  const readings = points.map(({ reading }) => reading);
  const residuals = points.map(({ residual }) => residual);
  const unit = unitText(calibration.angle_unit);
  const largest = Math.max(...residuals.map(Math.abs), 1e-300);
  return new Chart({
    sentence: () => `Residuals, angle minus curve, over the reading: at most ${significant(largest, 3)} ${unit}.`,
    xLabel: `reading [${calibration.input}]`,
    yLabel: () => `residual [${unit}]`,
    xRange: () => padded(extent([readings])),
    yRange: () => padded([-largest, largest], 0.1),
    draw: (painter) => {
      painter.horizontal(0, 'rule');
      painter.errorBars(
        readings,
        residuals.map((r) => Math.min(r, 0)),
        residuals.map((r) => Math.max(r, 0)),
        'curve-1',
        0,
      );
      painter.dots(readings, residuals, 'curve-1', 3.6);
    },
    height: 260,
  });
}

export function calibrationPlots(answer: CalibrationAnswer): HTMLElement {
  return el(
    'div',
    { class: 'pair' },
    figure('Points and curve.', curveChart(answer).host),
    figure('Residuals: angle − curve.', residualChart(answer).host),
  );
}
