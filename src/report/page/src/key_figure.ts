// SPDX-License-Identifier: Apache-2.0
import { el, type Child } from './dom';

/** A number, large, under its name and over its unit or what else it is of; several stand in a box of class "figures". */
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
