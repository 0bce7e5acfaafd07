// SPDX-License-Identifier: Apache-2.0
import type { FitRequest } from './types';

/** A word, quoted for a POSIX shell if needed. */
const quoted = (word: string): string => (/^[\w.,:=/+-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);

/** The commands that make the same fit from the downloaded recording. The first ones write the rig and the calibration. */
export function commandOf({
  file,
  options,
  rig,
  calibration,
}: Pick<FitRequest, 'file' | 'options' | 'rig' | 'calibration'>): string {
  const words = ['fit_pendulum', '--data', quoted(file)];
  const lines: string[] = [];
  for (const [flag, content] of Object.entries({ rig, calibration })) {
    if (!content) continue;
    lines.push(`printf '%s\\n' ${quoted(JSON.stringify(content))} > ${flag}.json\n`);
    words.push(`--${flag}`, `${flag}.json`);
  }
  for (const [flag, value] of Object.entries(options)) {
    if (flag !== 'name') words.push(`--${flag === 'models' ? 'model' : flag}`, quoted(String(value)));
  }
  return lines.join('') + words.join(' ');
}
