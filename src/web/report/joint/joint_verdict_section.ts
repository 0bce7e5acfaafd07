// SPDX-License-Identifier: Apache-2.0
/** The answer of a joint fit: whether the recordings agree, and the shared parameters. */

import { banner, warnings } from '../../shared/banner';
import { plusMinus } from '../../shared/rounding';
import { answerPart, answerSection } from '../answer';
import { shownFit } from '../report';
import { kNoFit } from '../sections/verdict_section';
import { shownJointFit, type JointReport } from './joint';
import type { JointFit } from './joint_types';
import { jointSwing } from './overlay_section';

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
  const { result } = report.whole;
  const fit = shownFit(report.whole);
  const swing = jointSwing(report);
  const parts =
    joint && fit
      ? answerPart({ fit, result, swing, remark: remarkOf(joint) })
      : [banner(kNoFit), swing, warnings(result)];
  return answerSection(parts);
}
