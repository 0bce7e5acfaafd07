// SPDX-License-Identifier: Apache-2.0
/** Reads the JSON in the page and renders the report. */

import '../shared/style.css';
import 'uplot/dist/uPlot.min.css';

import { embedded, start } from '../shared/embedded';
import type { Command, Result, Series } from '../shared/result_types';
import type { JointResult } from './joint/joint_types';
import { render } from './render';

start('report', 'report', (root) => {
  const result = embedded<Result | JointResult>('result');
  if (!result) throw new Error('There is no result in this file.');
  render(result, embedded<Series | Series[]>('series'), embedded<Command>('command'), root);
});
