// SPDX-License-Identifier: Apache-2.0
/** Creates elements. Strings become text nodes, never HTML, so names of files cannot inject markup. */

export type Child = Node | string | null | undefined | false;

/** An element with attributes and children. Strings become text nodes. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  append(element, children);
  return element;
}

export function append(parent: Node, children: Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    parent.appendChild(typeof child === 'string' ? document.createTextNode(child) : child);
  }
}

/** A symbol such as "I_O/G" in italics, with the O as a subscript. */
export function symbolElement(symbol: string): HTMLElement {
  const variable = el('var');
  for (const [, base, low] of symbol.matchAll(/([^_]+?)(?:_([^_/]+))?(?=[^_]|$)/g)) {
    append(variable, [base, low !== undefined && el('sub', {}, low)]);
  }
  return variable;
}

/** A button with its action. */
export function button(label: string, action: () => void, attributes: Record<string, string> = {}): HTMLButtonElement {
  const element = el('button', { type: 'button', ...attributes }, label);
  element.addEventListener('click', action);
  return element;
}

/** A toggle button. */
export function toggle(content: Child[], on: boolean, change: (on: boolean) => void): HTMLButtonElement {
  const element = el('button', { type: 'button', 'aria-pressed': String(on), class: 'toggle' }, ...content);
  element.addEventListener('click', () => {
    const now = element.getAttribute('aria-pressed') !== 'true';
    element.setAttribute('aria-pressed', String(now));
    change(now);
  });
  return element;
}

let radioGroups = 0;

/** A row of radio buttons. */
export function choice(
  legend: string,
  options: { value: string; label: string }[],
  chosen: string,
  change: (value: string) => void,
): HTMLElement {
  const name = `choice-${++radioGroups}`;
  const group = el('fieldset', { class: 'choice' }, el('legend', {}, legend));
  for (const { value, label } of options) {
    const input = el('input', { type: 'radio', name, value });
    input.checked = value === chosen;
    input.addEventListener('change', () => change(value));
    group.append(el('label', {}, input, el('span', {}, label)));
  }
  return group;
}

/** A collapsed part. Its content is made when it is first opened or printed. */
export function details(summary: string, make: () => Node, open = false): HTMLDetailsElement {
  const element = el('details', {}, el('summary', {}, summary));
  let made = false;
  const fill = (): void => {
    if (made || !element.open) return;
    made = true;
    element.append(make());
  };
  element.addEventListener('toggle', fill);
  element.open = open;
  if (open) fill();
  return element;
}

/** A paragraph. */
export const text = (content: string, style = ''): HTMLElement => el('p', style ? { class: style } : {}, content);
