// SPDX-License-Identifier: Apache-2.0
/** The readings of a fit for other values of its parameters, which the service computes. */

import { fitApi } from '../routes';
import { ask, askJson } from './api';
import { ProblemError } from './problem';

/** Every k-th sample: time in s on the file's clock, readings in `unit`. rms_residual: of measured - value. */
export interface Readings {
  time_s: number[];
  value: number[];
  unit: string;
  rms_residual: number;
}

export interface ReadingsRequest {
  /** Values by name, in the units of the result; parameters without a value keep their estimate. */
  parameters: Record<string, number>;
  model: string;
  /** From 0. */
  recording: number;
}

/** ProblemError: the service gives no readings. A fit that it no longer holds in memory is made again, once. */
export async function readingsOf(id: string, request: ReadingsRequest, signal?: AbortSignal): Promise<Readings> {
  const body = JSON.stringify(request);
  const headers = { 'Content-Type': 'application/json' };
  const readings = (): Promise<Readings> => askJson(fitApi(id, 'readings'), { method: 'POST', body, headers, signal });
  try {
    return await readings();
  } catch (error) {
    if (!(error instanceof ProblemError) || error.problem.code !== 'conflict') throw error;
  }
  await ask(fitApi(id, 'series'), { signal, busy: 'Fitting again' });
  return readings();
}
