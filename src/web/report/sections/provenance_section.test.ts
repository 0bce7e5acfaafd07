// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import type { Sampling } from '../../shared/result_types';
import { samplingText } from './provenance_section';

const sampling = (more: Partial<Sampling>): Sampling =>
  ({ rate_hz: 200, jitter_s: 0, gaps: 0, longest_gap_s: 0, samples_per_period: 263.6, saturated_samples: 0, ...more }) as Sampling;

test('rounding of time stamps is not called a variation of the intervals', () => {
  expect(samplingText(sampling({ jitter_s: 1.3e-15 }))).toBe('200 Hz, no gaps, 264 samples in a period');
  expect(samplingText(sampling({ jitter_s: 1.3e-5, gaps: 1, longest_gap_s: 0.4 }))).toBe(
    '200 Hz, intervals vary by 0.013 ms, 1 gap of up to 0.4 s, 264 samples in a period',
  );
});
