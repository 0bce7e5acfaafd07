// SPDX-License-Identifier: Apache-2.0
/** Cells of a table of parameters of several fits. */

import { el } from '../../shared/dom';
import { numberText } from '../../shared/prose';
import type { Parameter } from '../../shared/result_types';
import type { Cell } from '../../shared/table';
import { inDegrees, spacedUnit } from '../../shared/units';

/** Value and total error: the statistical error alone where nothing systematic is known. */
export function valueCell({ text, text_in_degrees: degrees, unit }: Parameter): Cell {
  const value = numberText(text) + (text === null ? '' : spacedUnit(unit));
  return [value, degrees !== undefined && el('small', {}, `${numberText(degrees)}\u00a0${inDegrees(unit)?.unit}`)];
}
