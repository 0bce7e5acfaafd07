// SPDX-License-Identifier: Apache-2.0
/** The headline of a fit: whether its numbers are a result. */

import type { Headline, Level } from '../shared/banner';
import { sentence } from '../shared/prose';
import type { Fit, Result } from '../shared/result_types';
import { hasWarning, lacksFit } from './report';

const kTroubles: Record<string, [Level, string]> = {
  failed: ['bad', 'The fit failed, so there is no result'],
  not_converged: ['bad', 'Not converged: these numbers are not a result'],
  not_identifiable: ['bad', 'Not identifiable: the recording does not determine these parameters'],
};

export function headline(result: Result, fit: Fit | null): Headline {
  if (!fit) return { level: 'caution', title: 'No fit was made', sentence: 'Only closed forms were asked for.' };
  const trouble = kTroubles[fit.status];
  const reason = sentence(fit.reason ?? '');
  if (trouble) return { level: trouble[0], title: trouble[1], sentence: reason };
  if (hasWarning(result, 'not_a_pendulum')) {
    return { level: 'bad', title: 'Not the free swing of a pendulum', sentence: 'See the warnings.' };
  }
  if (lacksFit(result, fit)) {
    const what =
      'The fit converged, but the residuals contain more than noise. ' +
      'The error bars are valid only if the model is right.';
    return {
      level: 'caution',
      title: `Lack of fit: ${fit.model} does not describe the whole recording`,
      sentence: what,
    };
  }
  const count = result.warnings.length;
  const title =
    count === 0
      ? `Converged: ${fit.model} describes this recording`
      : `Converged: ${fit.model}, with ${count === 1 ? 'a warning' : `${count} warnings`}`;
  return {
    level: hasWarning(result, 'lack_of_fit') && !result.comparison ? 'caution' : 'good',
    title,
    sentence: reason,
  };
}
