// SPDX-License-Identifier: Apache-2.0
/** Reads the JSON that stands in the page and renders it. */

import './style.css';
import 'uplot/dist/uPlot.min.css';

import { el } from './dom';
import type { JointResult } from './joint_types';
import { render } from './render';
import type { Command, Result, Series } from './types';

/** The JSON of a script element; null where there is none. */
function embedded<T>(id: string): T | null {
  const content = document.getElementById(id)?.textContent?.trim() ?? '';
  const filled = /^[{[]/.test(content) ? content : 'null';
  return JSON.parse(filled) as T | null;
}

function start(root: HTMLElement): void {
  try {
    const result = embedded<Result | JointResult>('result');
    if (!result) throw new Error('There is no result in this file.');
    render(result, embedded<Series | Series[]>('series'), embedded<Command>('command'), root);
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    root.replaceChildren(el('p', { class: 'fatal', role: 'alert' }, `This report cannot be shown: ${why}`));
    throw error;
  }
}

const root = document.getElementById('report');
if (root) start(root);
