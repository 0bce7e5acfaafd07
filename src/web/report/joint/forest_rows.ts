// SPDX-License-Identifier: Apache-2.0
/** The rows of the forest plot of a shared parameter. */

import type { ForestRow } from '../../shared/forest';
import type { Homogeneity, Parameter, SharedAgreement } from '../../shared/result_types';

const kTwoSided95 = 1.96;

type Estimate = Pick<ForestRow, 'estimate' | 'text' | 'interval95'>;
const pick = ({ estimate, text, interval95 }: Estimate): Estimate => ({ estimate, text, interval95 });

function recordingRows(agreement: SharedAgreement, outliers: readonly number[]): ForestRow[] {
  return agreement.recordings.map(({ estimate, std_error, text }, k) => {
    const reach = estimate !== null && std_error !== null ? kTwoSided95 * std_error : null;
    return {
      kind: 'recording',
      label: `recording ${k + 1}`,
      disagrees: agreement.agrees === false && outliers.includes(k + 1),
      estimate,
      text,
      interval95: estimate !== null && reach !== null ? [estimate - reach, estimate + reach] : null,
    };
  });
}

/** One row for each recording alone, then the joint estimate and the random-effects mean, if they exist. */
export function forestRows({ parameters, outliers }: Homogeneity, name: string, joint: Parameter | undefined): ForestRow[] {
  const agreement = parameters[name];
  const scatter = agreement.random_effects;
  const rows = recordingRows(agreement, outliers);
  const common = { disagrees: false };
  if (joint && joint.estimate !== null)
    rows.push({ ...common, ...pick(joint), kind: 'joint', label: 'joint fit' });
  if (scatter && scatter.mean !== null)
    rows.push({ ...common, ...pick({ ...scatter, estimate: scatter.mean }), kind: 'random', label: 'random effects' });
  return rows;
}
