// SPDX-License-Identifier: Apache-2.0
import { inList } from '../../shared/prose';
import type { Homogeneity } from '../../shared/result_types';

/** "Recording 3 disagrees with the others"; null if no single recording can be named. */
export function disagreement({ outliers }: Homogeneity): string | null {
  if (outliers.length === 0) return null;
  return outliers.length === 1
    ? `Recording ${outliers[0]} disagrees with the others`
    : `Recordings ${inList(outliers)} disagree with the others`;
}
