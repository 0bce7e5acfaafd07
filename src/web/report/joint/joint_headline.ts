// SPDX-License-Identifier: Apache-2.0
/** The headline of a joint fit: whether its numbers are a result, and whether the recordings agree. */

import type { Headline } from '../../shared/banner';
import { inList, sentence } from '../../shared/prose';
import { hasWarning, lacksFit } from '../report';
import { wholeView } from './joint';
import type { Homogeneity, JointFit, JointResult } from './joint_types';

/** "Recording 3 disagrees with the others"; null if no single recording can be named. */
export function disagreement({ outliers }: Homogeneity): string | null {
  if (outliers.length === 0) return null;
  return outliers.length === 1
    ? `Recording ${outliers[0]} disagrees with the others`
    : `Recordings ${inList(outliers)} disagree with the others`;
}

function trouble({ status, homogeneity }: JointFit): string | null {
  if (status === 'failed') return 'The joint fit failed, so there is no result';
  if (status === 'not_identifiable') return 'Not identifiable: the recordings do not determine these parameters';
  if (status !== 'not_converged') return null;
  return homogeneity.agrees === false
    ? 'Refused: the recordings are not of one pendulum; these numbers are not a result'
    : 'Not converged: these numbers are not a result';
}

/** Both as sentences, without the second if the first already contains it. */
const together = (first: string, second: string): string =>
  (first.includes(second) ? [first] : [first, second]).map(sentence).join(' ').trim();

const kMoreThanNoise =
  'The fit converged, but the residuals contain more than noise. The error bars are valid only if the model is right.';

function converged(result: JointResult, { model, homogeneity }: JointFit): Headline {
  const { agrees, verdict } = homogeneity;
  const count = result.warnings.length;
  const remarks = count === 0 ? '' : count === 1 ? ', with a warning' : `, with ${count} warnings`;
  if (agrees === null)
    return { level: 'caution', title: `Converged: ${model}; whether the recordings agree is not known`, sentence: sentence(verdict) };
  return {
    level: 'good',
    title: `The ${result.data.length} recordings agree: ${model} describes them together${remarks}`,
    sentence: sentence(verdict),
  };
}

export function jointHeadline(result: JointResult, fit: JointFit | null): Headline {
  if (!fit) return { level: 'caution', title: 'No fit was made', sentence: 'Only closed forms were asked for.' };
  const { agrees, verdict } = fit.homogeneity;
  const wrong = trouble(fit);
  if (wrong) return { level: 'bad', title: wrong, sentence: together(fit.reason ?? '', verdict) };
  const whole = wholeView(result);
  if (hasWarning(whole, 'not_a_pendulum'))
    return { level: 'bad', title: 'Not the free swing of a pendulum', sentence: together('see the warnings', verdict) };
  const odd = disagreement(fit.homogeneity);
  if (odd) return { level: 'bad', title: odd, sentence: sentence(verdict) };
  if (agrees === false)
    return { level: 'caution', title: 'The recordings do not agree within their errors', sentence: sentence(verdict) };
  const { model } = fit;
  const lacks = whole.fits.find((one) => one.model === model);
  if (!lacks || !lacksFit(whole, lacks)) return converged(result, fit);
  const title = `Lack of fit: ${model} does not describe these recordings completely`;
  return { level: 'caution', title, sentence: together(verdict, kMoreThanNoise) };
}
