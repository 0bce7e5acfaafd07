// SPDX-License-Identifier: Apache-2.0
import type { FitRequest } from './types';

/** A word, quoted for a POSIX shell if needed. */
const quoted = (word: string): string => (/^[\w.,:=/+-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);

/** The command line that makes the same fit from the downloaded recording. */
export function commandOf({
  name,
  options,
  rig,
  calibration,
}: Pick<FitRequest, 'name' | 'options' | 'rig' | 'calibration'>): string {
  const words = ['fit_pendulum', '--data', quoted(name)];
  if (rig) words.push('--rig', 'rig.json');
  if (calibration) words.push('--calibration', 'calibration.json');
  for (const [flag, value] of Object.entries(options)) {
    if (flag !== 'name') words.push(`--${flag === 'models' ? 'model' : flag}`, quoted(String(value)));
  }
  return words.join(' ');
}
