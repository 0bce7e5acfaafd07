// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { TimeView } from './time_view';

describe('the range of times', () => {
  test('zooms about a point, stays within the recording, and calls its listeners', () => {
    const view = new TimeView(0, 20, 0.1);
    let told = 0;
    view.onChange(() => ++told);
    view.zoom(0.5, 0);
    expect(view.current).toEqual([0, 10]);
    view.pan(2);
    expect(view.current).toEqual([10, 20]);
    view.zoom(1e-9);
    expect(view.current[1] - view.current[0]).toBeCloseTo(0.1, 12);
    view.set(-5, 5);
    expect(view.current).toEqual([0, 10]);
    view.reset();
    expect([view.whole, told]).toEqual([true, 5]);
  });
});
