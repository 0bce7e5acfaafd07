// SPDX-License-Identifier: Apache-2.0
/** Source of the summary. */

import { el, type Child } from '../shared/dom';
import { identifier, visible } from '../shared/names';
import { section } from '../shared/section';
import { facts } from '../shared/table';
import type { Store, Summary } from './types';
import { countText } from './words';

/** The parts, one below the other. */
const lines = (items: string[]): Child[] =>
  items.length === 0 ? ['unknown'] : items.map((item) => el('div', {}, visible(item)));

function runsText({ runs, refitted, pending }: Store): string {
  if (pending === 0 && refitted === runs) return `${countText(runs)}, all of them fitted`;
  return `${countText(runs)}, of which ${countText(refitted)} are fitted and ${countText(pending)} pending`;
}

export function provenanceSection({ summary }: { summary: Summary }): HTMLElement {
  const { store, tool, group_by: group, trend_by: trend } = summary;
  return section(
    'provenance',
    'Where it comes from',
    facts([
      ['store', identifier(store.path)],
      ['runs', runsText(store)],
      ['fits', countText(store.fits)],
      [
        'manifest',
        store.manifest_sha256 === null ? 'unknown' : ['SHA-256 ', el('code', { class: 'hash' }, store.manifest_sha256)],
      ],
      [
        'one rig',
        group === null
          ? 'no column of the manifest distinguishes rigs'
          : ['runs of one ', el('code', {}, visible(group))],
      ],
      ['trends over', trend === null ? 'the position in the manifest' : el('code', {}, visible(trend))],
      ['fitted by version', lines(store.versions)],
      ['on', lines(store.cpus)],
      ['made by', `${tool.name} ${tool.version}, summary schema ${summary.schema_version}`],
    ]),
  );
}
