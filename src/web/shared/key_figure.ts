// SPDX-License-Identifier: Apache-2.0
import { el, type Child } from './dom';

/** A large number below its name and above its unit. Place several of them in an element of class "figures". */
export function keyFigure(name: Child[], value: string, unit: Child[], remark: Child = null): HTMLElement {
  return el(
    'div',
    { class: 'key' },
    el('span', { class: 'name' }, ...name),
    el('span', { class: 'value' }, value),
    el('span', { class: 'unit' }, ...unit),
    remark,
  );
}
