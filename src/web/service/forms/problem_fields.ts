// SPDX-License-Identifier: Apache-2.0
/** Assigns problems to form fields. The attributes data-flag and data-rig of an input say what it is for. */

import { flagsIn, inFields } from '../flag_words';
import { FieldError, ProblemError } from '../server/problem';

type Find = (selector: string) => HTMLElement | null;

const kFile = /^(?:the )?(rig|calibration)(?:\.json|\.csv| given by flags)?: /;
const kMember = /(?:"(std_dev|value)" of )?"([a-z_]+)"/g; // "rod_length", "std_dev" of "rod_length"

/** Assigns a problem of a rig or a calibration to the fields of the quantities it names, else to the chosen file. */
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

/** Assigns the problem to the fields that `find` returns. Returns it unchanged if there are none. */
export function asFieldError(error: unknown, find: Find): unknown {
  if (!(error instanceof ProblemError)) return error;
  const { code, detail } = error.problem;
  const file = kFile.exec(detail);
  if (file) return ofFile(file[1], detail.slice(file[0].length), find) ?? error;
  if (code !== 'bad_request') return error;
  const fields = flagsIn(detail).flatMap((flag) => find(`[data-flag="${flag}"]`) ?? []);
  return fields.length > 0 ? new FieldError(`${inFields(detail)}.`, fields[0], fields.slice(1)) : error;
}

const kDescribedBy = 'aria-describedby';

/** Removes the error mark from a field. */
export function unmark(field: HTMLElement): void {
  field.removeAttribute('aria-invalid');
  const { problem } = field.dataset;
  if (problem === undefined) return;
  const others = (field.getAttribute(kDescribedBy) ?? '').split(' ').filter((id) => id !== problem && id !== '');
  if (others.length > 0) field.setAttribute(kDescribedBy, others.join(' '));
  else field.removeAttribute(kDescribedBy);
  delete field.dataset.problem;
}

/** Removes the error marks of a problem from all its fields. */
export function unmarkAll(id: string): void {
  for (const field of document.querySelectorAll<HTMLElement>(`[data-problem="${CSS.escape(id)}"]`)) unmark(field);
}

/**
 * Marks a field as wrong until one of the fields of the problem is changed. The element with this id describes the
 * error.
 */
export function mark(field: HTMLElement, id: string): void {
  unmark(field);
  field.setAttribute('aria-invalid', 'true');
  field.setAttribute(kDescribedBy, `${field.getAttribute(kDescribedBy) ?? ''} ${id}`.trim());
  field.dataset.problem = id;
  for (const change of ['input', 'change']) field.addEventListener(change, () => unmarkAll(id), { once: true });
}
