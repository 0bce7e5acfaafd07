// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

/** The folders that the modules of a folder may import from. */
const kMayImport: Record<string, string[]> = {
  shared: ['shared'],
  report: ['report', 'shared'],
  summary: ['shared', 'summary'],
  service: ['report', 'service', 'shared'],
};

const kSources = import.meta.glob<string>('./{report,service,shared,summary}/**/*.ts', { eager: true, import: 'default', query: '?raw' });

/** The folder of a module, "shared" for './shared/units.ts'. The path may be relative to the module `from`. */
const folderOf = (module: string, from: string): string => new URL(module, `file:///${from}`).pathname.split('/')[1];

test('modules import only from the folders that their own folder may use', () => {
  expect(Object.keys(kSources).length).toBeGreaterThan(100);
  const wrong = Object.entries(kSources).flatMap(([path, source]) =>
    [...source.matchAll(/\b(?:from|import) '(\.[^']+)'/g)]
      .filter(([, module]) => !kMayImport[folderOf(path, '')].includes(folderOf(module, path)))
      .map(([, module]) => `${path} imports ${module}`),
  );
  expect(wrong).toEqual([]);
});
