// SPDX-License-Identifier: Apache-2.0
import { choice, el } from './dom';

const kMostButtons = 8;

/** A choice: radio buttons for a few options, a drop-down list for many. */
export function select(
  legend: string,
  options: { value: string; label: string }[],
  chosen: string,
  change: (value: string) => void,
): HTMLElement {
  if (options.length <= kMostButtons) return choice(legend, options, chosen, change);
  const list = el('select');
  for (const { value, label } of options) {
    const option = el('option', { value }, label);
    option.selected = value === chosen;
    list.append(option);
  }
  list.addEventListener('change', () => change(list.value));
  return el('label', { class: 'select' }, el('span', {}, legend), list);
}
