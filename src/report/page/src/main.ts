// SPDX-License-Identifier: Apache-2.0
/** Reads the JSON that stands in the page and renders it. */

import './style.css';
import 'uplot/dist/uPlot.min.css';

import { embedded, start } from './embedded';
import type { JointResult } from './joint_types';
import { render } from './render';
import type { Command, Result, Series } from './types';

start('report', 'report', (root) => {
  const result = embedded<Result | JointResult>('result');
  if (!result) throw new Error('There is no result in this file.');
  render(result, embedded<Series | Series[]>('series'), embedded<Command>('command'), root);
});
