// SPDX-License-Identifier: Apache-2.0
/** Problems of what was typed, told of its fields: inputs say by data-flag and data-rig what they are for. */

import { flagsIn, inFields } from './flag_words';
import { FieldError, ProblemError } from './problem';

type Find = (selector: string) => HTMLElement | null;

const kFile = /^(rig|calibration)(?:\.json)?: /;
const kMember = /(?:"(std_dev|value)" of )?"([a-z_]+)"/g; // "rod_length", "std_dev" of "rod_length"

/** The problem of a rig or a calibration: of the quantities that were typed in, or else of the file that was chosen. */
function ofFile(kind: string, problem: string, find: Find): FieldError | null {
  const fields: HTMLElement[] = [];
  const told = problem.replace(kMember, (all: string, part: string | undefined, member: string) => {
    const field = find(`[data-rig="${part === 'std_dev' ? `std_dev of ${member}` : member}"]`);
    if (!field) return all;
    fields.push(field);
    return `“${field.dataset.what ?? member}”`;
  });
  if (fields.length > 0) return new FieldError(`${told}.`, fields[0], fields.slice(1));
  const file = find(kind === 'rig' ? '[data-rig="file"]' : '[data-flag="calibration"]');
  return file && new FieldError(`The ${kind}: ${problem}.`, file);
}

/** The problem as one of fields that `find` finds, or else as it is. */
export function asFieldError(error: unknown, find: Find): unknown {
  if (!(error instanceof ProblemError)) return error;
  const { code, detail } = error.problem;
  const file = kFile.exec(detail);
  if (file) return ofFile(file[1], detail.slice(file[0].length), find) ?? error;
  if (code !== 'wrong_request') return error;
  const fields = flagsIn(detail).flatMap((flag) => find(`[data-flag="${flag}"]`) ?? []);
  return fields.length > 0 ? new FieldError(`${inFields(detail)}.`, fields[0], fields.slice(1)) : error;
}

const kDescribedBy = 'aria-describedby';

/** Takes the mark of a mistake from a field. */
export function unmark(field: HTMLElement): void {
  field.removeAttribute('aria-invalid');
  const { problem } = field.dataset;
  if (problem === undefined) return;
  const others = (field.getAttribute(kDescribedBy) ?? '').split(' ').filter((id) => id !== problem && id !== '');
  if (others.length > 0) field.setAttribute(kDescribedBy, others.join(' '));
  else field.removeAttribute(kDescribedBy);
  delete field.dataset.problem;
}

/** Takes the marks of a problem from all its fields. */
export function unmarkAll(id: string): void {
  for (const field of document.querySelectorAll<HTMLElement>(`[data-problem="${CSS.escape(id)}"]`)) unmark(field);
}

/** Marks a field as mistaken, described by the element of that id, until one of the problem's fields is changed. */
export function mark(field: HTMLElement, id: string): void {
  unmark(field);
  field.setAttribute('aria-invalid', 'true');
  field.setAttribute(kDescribedBy, `${field.getAttribute(kDescribedBy) ?? ''} ${id}`.trim());
  field.dataset.problem = id;
  for (const change of ['input', 'change']) field.addEventListener(change, () => unmarkAll(id), { once: true });
}
