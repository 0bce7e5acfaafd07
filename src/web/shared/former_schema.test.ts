// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { withCurrentNames } from './former_schema';

test('a result of schema version 1 is read with the names of version 2', () => {
  const former = {
    schema_version: 1,
    data: { sampling: { seen_frequency_hz: 0.8 }, path: 'why' },
    fits: [
      {
        parameters: { edge_lag: { estimate: 0.001 }, inertia: { estimate: 0.08 } },
        covariance: { names: ['inertia', 'edge_lag'] },
        noise: { why: 'the residuals are 3 resolutions' },
        closed_form: [
          { z: null, why: 'no errors', reason: 'no errors' },
          { z: 1, why: null },
        ],
        homogeneity: { disagreeing: [2], amplitude_dependence: [{ rest_p: 0.5 }] },
        runs: [{ alone: 'converged' }],
        warnings: [{ code: 'left_out', message: 'left_out' }],
      },
    ],
    comparison: { rows: [{ judged: true }] },
    warnings: [{ code: 'saturated', message: '2 readings' }],
  };
  expect(withCurrentNames(former)).toEqual({
    schema_version: 1,
    data: { sampling: { apparent_frequency_hz: 0.8 }, path: 'why' },
    fits: [
      {
        parameters: { hysteresis: { estimate: 0.001 }, inertia: { estimate: 0.08 } },
        covariance: { names: ['inertia', 'hysteresis'] },
        noise: { reason: 'the residuals are 3 resolutions' },
        closed_form: [
          { z: null, reason: 'no errors' },
          { z: 1, reason: null },
        ],
        homogeneity: { outliers: [2], amplitude_dependence: [{ p_of_remainder: 0.5 }] },
        runs: [{ separate: 'converged' }],
        warnings: [{ code: 'larger_motion_outside', message: 'left_out' }],
      },
    ],
    comparison: { rows: [{ is_compared: true }] },
    warnings: [{ code: 'saturated', message: '2 readings' }],
  });
});

test('anything else is unchanged', () => {
  const calibration = { schema_version: 1, alone: 1 };
  expect(withCurrentNames(calibration)).toBe(calibration);
  const current = { schema_version: 2, fits: [], alone: 1 };
  expect(withCurrentNames(current)).toBe(current);
  expect(withCurrentNames(null)).toBeNull();
});
