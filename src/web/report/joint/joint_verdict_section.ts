// SPDX-License-Identifier: Apache-2.0
/** The verdict of a joint fit: its parameters, and whether the recordings agree. */

import { banner, warnings } from '../../shared/banner';
import { el, text } from '../../shared/dom';
import { plusMinus } from '../../shared/rounding';
import { section } from '../../shared/section';
import { equationText } from '../equation';
import { keyFigures, parameterPart } from '../parameters';
import { shownFit } from '../report';
import { recommendation } from '../sections/verdict_section';
import { shownJointFit, type JointReport } from './joint';
import { jointHeadline } from './joint_headline';
import type { JointFit } from './joint_types';

/** If the recordings scatter and no single one disagrees: the random-effects mean, whose error includes the scatter. */
function remarkOf({ homogeneity, status }: JointFit): (name: string) => string | null {
  const scattered = status === 'converged' && homogeneity.agrees === false && homogeneity.outliers.length === 0;
  return (name) => {
    const scatter = homogeneity.parameters[name]?.random_effects;
    if (!scattered || !scatter || scatter.mean === null) return null;
    return `random effects: ${plusMinus(scatter.mean, scatter.std_error)}`;
  };
}

export function jointVerdictSection(report: JointReport): HTMLElement {
  const joint = shownJointFit(report);
  const fit = shownFit(report.whole);
  const equation = fit && equationText(fit);
  const usable = joint && fit && Object.keys(fit.parameters ?? {}).length > 0;
  return section(
    'verdict',
    'Verdict',
    banner(jointHeadline(report.result, joint)),
    recommendation(report.whole),
    usable && keyFigures(fit, remarkOf(joint)),
    equation && el('p', { class: 'equation' }, equation),
    usable
      ? parameterPart(fit, 'What the recordings do not determine')
      : fit && text('There are no parameters to show.', 'absent'),
    warnings(report.whole.result),
  );
}
