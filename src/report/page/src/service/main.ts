// SPDX-License-Identifier: Apache-2.0
/** The page of the service: one script for all of its views. */

import '../style.css';
import './service.css';
import 'uplot/dist/uPlot.min.css';

import { start } from '../embedded';
import { wordWith } from '../prose';
import { batchView } from './batch_view';
import { calibrationView } from './calibration_view';
import { compareView } from './compare_view';
import { fitView } from './fit_view';
import { fitsView } from './fits_view';
import { inFields } from './flag_words';
import { liveView } from './live_view';
import { missing, startRouter } from './router';
import type { Route } from './routes';
import type { View } from './shell';
import { startView } from './start_view';

function viewOf(route: Route): View {
  switch (route.page) {
    case 'start':
      return startView;
    case 'fits':
      return fitsView;
    case 'fit':
      return fitView(route.id);
    case 'compare':
      return compareView(route.ids);
    case 'batch':
      return batchView(route.id);
    case 'calibration':
      return calibrationView;
    case 'live':
      return liveView;
    case 'missing':
      return missing;
  }
}

wordWith(inFields);
start('service', 'page', (root) => startRouter(root, viewOf));
