// SPDX-License-Identifier: Apache-2.0
// The page shows all sections that fit_pendulum embeds, with all their numbers. The variable FIT_PENDULUM is the path of
// the tool.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { openFile } from './page.mjs';
import { dataset, embedded, fit } from './tool.mjs';

const rig = ['--rig', dataset('textbook_rig.json'), '--model', 'viscous,coulomb', '--interval', 'covariance'];
const kReports = {
  'one recording': ['--data', dataset('coulomb.csv'), ...rig],
  'three recordings': ['--data', ['runs_1.csv', 'runs_2.csv', 'runs_3.csv'].map(dataset).join(','), ...rig],
};

/** All texts of a block. The page leaves out columns without content. */
const textsOf = (block) => {
  if (block.kind === 'facts') return block.rows.flatMap((row) => [row.name, row.text]);
  if (block.kind === 'table') {
    const heads = block.columns.flatMap(({ header }, i) => (block.rows.some((row) => row[i] !== '') ? [header] : []));
    return [...heads, ...block.rows.flat(), block.left_out ?? ''];
  }
  return block.texts ?? [block.text];
};

/** The numbers of a text, however it writes minus signs and powers. */
const numbersOf = (text) =>
  text
    .replace(/−/g, '-')
    .replace(/ × 10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/g, (_all, power) => `e${[...power].map((c) => '-0123456789'['⁻⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(c)]).join('')}`)
    .match(/(?<![\d.])\d+(\.\d+)?(\)?e[-+]?\d+)?/g)
    ?.map((number) => number.replace(/e\+?(-?)0*(\d)/, 'e$1$2')) ?? [];

/** Words without names and powers, which the page writes in another way. */
const plainWords = (text) => text.match(/(?<![\w"_-])[A-Za-z]{4,}(?![\w"_-])/g)?.map((word) => word.toLowerCase()) ?? [];

async function assertTold(page, section) {
  const what = `${section.title} ${section.law ?? ''} ${section.recording ?? ''}`;
  const place = page.locator(`[data-told="${section.id}"]`);
  assert.ok((await place.count()) >= 1, `${what} is missing`);
  const shown = (await place.evaluateAll((all) => all.flatMap((one) => [...one.querySelectorAll('h3, p, li, dt, dd, summary, :is(td, th) > :is(span, small), .left-out')].map((part) => part.textContent)))).join('\n');
  const [numbers, words] = [new Set(numbersOf(shown)), shown.toLowerCase()];
  for (const text of section.blocks.flatMap(textsOf)) {
    for (const number of numbersOf(text.replace(/\^-?\d/g, ''))) {
      if (/^\s*[-*<>|]+\s*$/.test(text) || text === '1') continue; // a drawing; the unit of a pure number
      assert.ok(numbers.has(number), `${what}: ${number} of "${text}" is not shown`);
    }
    if (/^[a-z_]+(, [a-z_]+)*$/.test(text)) continue; // names, which the page may write in words
    for (const word of plainWords(text).filter((one) => one !== 'sigma')) assert.ok(words.includes(word), `${what}: ${word} of "${text}"`);
  }
}

for (const [name, flags] of Object.entries(kReports)) {
  test(`${name}: every section is on the page with its numbers, for each law and recording`, async (t) => {
    const { url, result } = fit(name.replace(' ', '_'), ...flags);
    const sections = embedded(url).sections;
    assert.ok(sections.length > 15);
    const page = await openFile(t, url);
    for (const { model } of result.fits) {
      await page.locator('.models label', { hasText: model }).click();
      for (const number of result.recordings.length > 1 ? result.recordings.map((_one, k) => k + 1) : [null]) {
        if (number !== null) await page.locator('.recordings label', { hasText: String(number) }).click();
        await page.locator('[data-told] details').evaluateAll((all) => all.forEach((part) => (part.open = true)));
        await page.waitForFunction(() => [...document.querySelectorAll('[data-told] details')].every((part) => part.children.length > 1));
        const due = sections.filter(({ law, recording }) => (law ?? model) === model && (recording ?? number) === number);
        assert.ok(due.length > 10);
        for (const section of due) await assertTold(page, section);
      }
    }
  });
}
