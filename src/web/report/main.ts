// SPDX-License-Identifier: Apache-2.0
/** Reads the JSON in the page and renders the report. */

import '../shared/style.css';
import 'uplot/dist/uPlot.min.css';

import { embedded, start } from '../shared/embedded';
import { fillPage } from '../shared/page';
import type { Command, Result, Series } from '../shared/result_types';
import type { ReportSection } from '../shared/sections';
import { reportContent } from './render';
import { makeReport } from './report';

start('report', 'report', (root) => {
  const result = embedded<Result>('result');
  if (!result) throw new Error('There is no result in this file.');
  const told = embedded<ReportSection[]>('sections');
  const report = makeReport(result, embedded<Series[]>('series'), embedded<Command>('command'), told);
  fillPage(root, reportContent(report));
});
