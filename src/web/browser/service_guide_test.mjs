// SPDX-License-Identifier: Apache-2.0
// The user guide: its search, in the service and as files, and the links to it. mkdocs and KaTeX build it.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

import { assertAccessible, kLooks, watchedPage } from './page.mjs';
import { openView, startService } from './service_server.mjs';

const settings = fileURLToPath(new URL('../../docs/site/mkdocs.yml', import.meta.url));
const guide = fs.mkdtempSync(path.join(os.tmpdir(), 'pendulum-guide-'));

let service;
before(async () => {
  const environment = { ...process.env, PYTHONDONTWRITEBYTECODE: '1' };
  execFileSync('mkdocs', ['build', '--quiet', '--strict', '--config-file', settings, '--site-dir', guide], { env: environment });
  service = await startService('--docs', guide);
});
after(() => fs.rmSync(guide, { recursive: true }));

/** Opens a page of the guide as a file. */
async function openGuideFile(t, name) {
  const folder = pathToFileURL(guide).href;
  const page = await watchedPage(t, { mayAsk: (asked) => asked.startsWith(folder) });
  await page.goto(`${folder}/${name}`);
  return page;
}

const places = {
  'in the service': (t) => openView(t, service, '/docs/index.html'),
  'as a file': (t) => openGuideFile(t, 'index.html'),
};

for (const [where, open] of Object.entries(places)) {
  test(`the search leads by keys to the paragraph, ${where}`, async (t) => {
    const page = await open(t);
    await page.getByRole('searchbox', { name: 'Search the guide' }).fill('stale_values readings');
    assert.match(await page.locator('.search [role=status]').textContent(), /^\d+ found/);
    assert.match(await page.locator('.search li').first().textContent(), /^Reference › About the file.*stale_values/);
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    await page.waitForURL(/reference\.html#p\d+$/);
    assert.match(await page.locator(':target').textContent(), /stale_values/);
    assert.ok(await page.locator(':target').evaluate((row) => row.getBoundingClientRect().top >= 0));
  });
}

test('the search says that nothing is found, and Escape empties it', async (t) => {
  const page = await places['as a file'](t);
  const field = page.getByRole('searchbox');
  await field.fill('zeppelin (');
  assert.equal(await page.locator('.search [role=status]').textContent(), 'Nothing found');
  await field.press('Escape');
  assert.equal(await field.inputValue(), '');
  assert.equal(await page.locator('.search [role=status]').textContent(), '');
});

for (const [theme, device, width] of kLooks) {
  test(`pictures and results of the search are accessible, ${theme}, ${device}`, async (t) => {
    const context = { viewport: { width, height: 844 }, colorScheme: theme };
    const page = await openView(t, service, '/docs/friction_laws.html', { context });
    await page.getByRole('searchbox').fill('stribeck');
    await assertAccessible(page);
    const pictures = page.locator('img[src^="law_"]');
    assert.ok((await pictures.evaluateAll((all) => all.filter((one) => one.naturalWidth > 0).length)) >= 7);
  });
}

test('a warning of a fit links to its row in the guide', async (t) => {
  // The summary of this fit has the warning another_minimum (src/docs/friction_laws.md).
  const id = await service.fit('to_rest.csv', 'model=coulomb', 'textbook_rig.json');
  const page = await openView(t, service, `/fits/${id}`);
  await page.locator('#verdict summary', { hasText: 'Explanations' }).click();
  await page.locator('#warnings a', { hasText: 'Guide: Reference, rig_exact' }).waitFor();
  await page.locator('#verdict a', { hasText: 'Guide: Reference, another_minimum' }).click();
  await page.waitForURL(/\/docs\/reference\.html#another_minimum$/);
  assert.equal(await page.locator(':target').textContent(), 'another_minimum');
});

test('without a guide the link of the start page leads to a page that says how to get it', async (t) => {
  const empty = path.join(guide, 'empty');
  fs.mkdirSync(empty);
  const bare = await startService('--docs', empty);
  const page = await openView(t, bare, '/', { refused: ['status of 404'] });
  await page.getByRole('link', { name: 'User guide' }).click();
  await page.getByRole('heading', { name: 'The user guide is not installed' }).waitFor();
  await assertAccessible(page);
  await page.getByRole('link', { name: 'Back to the service' }).click();
  await page.getByRole('heading', { name: 'Fit a recording' }).waitFor();
});
