// SPDX-License-Identifier: Apache-2.0
/** Reads the JSON in the page and renders the summary. */

import '../shared/style.css';
import './summary.css';
import 'uplot/dist/uPlot.min.css';

import { embedded, start } from '../shared/embedded';
import { render } from './render';
import type { Summary } from './types';

start('page', 'summary', (root) => {
  const summary = embedded<Summary>('summary');
  if (!summary) throw new Error('There is no summary in this file.');
  render(summary, root);
});
