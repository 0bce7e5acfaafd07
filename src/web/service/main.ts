// SPDX-License-Identifier: Apache-2.0
/** Entry of the page of the service. */

import '../shared/style.css';
import './service.css';
import './views.css';
import 'uplot/dist/uPlot.min.css';

import { embedded, start } from '../shared/embedded';
import { guideAt } from '../shared/guide';
import { wordWith } from '../shared/prose';
import { inFields, setFlags, type FormFlag } from './flag_words';
import { again, missing, startRouter } from './router';
import type { Route } from './routes';
import { takeToken } from './server/token';
import type { View } from './shell';
import { batchView } from './views/batch_view';
import { calibrationView } from './views/calibration_view';
import { compareView } from './views/compare_view';
import { fitView } from './views/fit_view';
import { fitsView } from './views/fits_view';
import { liveView } from './views/live_view';
import { startView } from './views/start_view';

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
guideAt('/docs/');
start('service', 'page', (root) => {
  setFlags(embedded<FormFlag[]>('flags') ?? []);
  takeToken();
  startRouter(root, viewOf);
  window.addEventListener('hashchange', () => {
    if (takeToken()) again();
  });
});
