// SPDX-License-Identifier: Apache-2.0
// Forms of the service's page: typed and pasted values, values that are kept, and messages for wrong values.

import assert from 'node:assert/strict';
import { before, test } from 'node:test';

import { kPasted, openView, readDataset, shownFit, startService } from './service_server.mjs';

let service;
before(async () => (service = await startService()));

/** The rows of time and angle in degrees, without header and comments. */
const kBare = kPasted
  .split('\n')
  .filter((line) => /^[-\d]/.test(line))
  .join('\n');

const refused = ['status of 400', 'status of 422'];
const field = (page, label) => page.getByLabel(label, { exact: true });

/** Waits until a problem is shown whose sentence matches, and returns it. */
async function problemLike(page, words) {
  const detail = page.locator('.problem .detail', { hasText: words });
  await detail.waitFor();
  return detail;
}

/** Asserts that the fields are marked and described by the sentence, and that the first has the focus. */
async function assertMarked(page, detail, labels) {
  const id = await detail.getAttribute('id');
  for (const label of labels) {
    assert.equal(await field(page, label).getAttribute('aria-invalid'), 'true', label);
    assert.ok((await field(page, label).getAttribute('aria-describedby')).split(' ').includes(id), label);
  }
  assert.ok(await field(page, labels[0]).evaluate((input) => input === document.activeElement));
}

async function pasteNumbers(page, numbers) {
  await page.getByText('Or paste numbers').click();
  await field(page, 'Numbers').fill(numbers);
}

/** Makes a batch of one recording that cannot be fitted. Returns the id of its run. */
async function unfitted(name, content) {
  const form = new FormData();
  for (const part of [content, content]) form.append('data', new Blob([part]), name);
  const answer = await fetch(`${service.url}/v1/batches?model=coulomb`, { method: 'POST', body: form });
  const id = answer.headers.get('Location').split('/').pop();
  for (;;) {
    const batch = await service.json(`/v1/batches/${id}`);
    if (batch.state === 'done') return batch.fits[0];
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
}

test('a failed run is fitted after the options that its problem names are filled in', async (t) => {
  const run = await unfitted('bare.csv', `battery,temperature\n${kBare}`);
  assert.match(run.reason, /--value_column/);
  const page = await openView(t, service, `/fits/${run.id}`, { refused });
  const detail = await problemLike(page, '“Column of the angle”');
  assert.doesNotMatch(await detail.textContent(), /--/);
  assert.equal(await page.locator('#again .plot').count(), 0); // the columns to draw are unknown
  await field(page, 'Column of times').fill('1');
  await field(page, 'Column of the angle').fill('2');
  await field(page, 'Unit of the values').selectOption({ label: 'degrees' });
  await page.getByRole('button', { name: 'Fit again' }).click();
  const { options } = await service.json(`/v1/fits/${await shownFit(page, run.id)}/request`);
  assert.deepEqual(options, { model: 'coulomb', time_column: '1', value_column: '2', unit: 'deg' });
});

test('a run without a swing shows its recording, to choose a window from it', async (t) => {
  const held = ['time_s,angle_deg', ...Array.from({ length: 200 }, (_unused, i) => `${i / 100},${20 + (i % 2)}`), ''];
  const run = await unfitted('held.csv', held.join('\n'));
  const page = await openView(t, service, `/fits/${run.id}`, { refused });
  await page.waitForSelector('#again .plot canvas');
  assert.equal(await field(page, 'To [s]').inputValue(), '1.99');
});

test('a window that ends before it begins marks both of its fields, until one is changed', async (t) => {
  const page = await openView(t, service, `/fits/${await service.fit('coulomb.csv', 'model=coulomb')}`, { refused });
  await page.waitForSelector('#again');
  await field(page, 'From [s]').fill('9');
  await field(page, 'To [s]').fill('3');
  await page.getByRole('button', { name: 'Fit this window' }).click();
  await assertMarked(page, await problemLike(page, '“From” 9 s does not lie before “To” 3 s'), ['From [s]', 'To [s]']);
  await field(page, 'To [s]').fill('12');
  assert.equal(await field(page, 'To [s]').getAttribute('aria-invalid'), null);
  assert.equal(await field(page, 'To [s]').getAttribute('aria-describedby'), null);
  assert.equal(await field(page, 'From [s]').getAttribute('aria-invalid'), null);
});

test('an impossible mass marks its field, for a new fit and for a repeated fit', async (t) => {
  const page = await openView(t, service, '/', { refused });
  await page.locator('.choice label', { hasText: 'masses and length' }).click();
  for (const [label, value] of [
    ['How heavy is the bob?', '500'],
    ['How heavy is the rod?', '100'],
    ['How long is the rod?', '-43'],
  ])
    await field(page, label).fill(value);
  await pasteNumbers(page, kPasted);
  await page.getByRole('button', { name: 'Fit these numbers' }).click();
  const words = '“Length of the rod” is -0.43; it must be positive';
  await problemLike(page, words); // beside the sketch
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  await page.locator('.alert-place .problem .detail', { hasText: words }).waitFor();
  await assertMarked(page, page.locator('.alert-place .problem .detail'), ['How long is the rod?']);
  await field(page, 'How long is the rod?').fill('43');
  // The recording is read again, and the problem removed, while the mouse button is pressed.
  await page.getByRole('button', { name: 'Fit', exact: true }).click({ delay: 1000 });
  await shownFit(page);
  await page.getByText('Another description of the pendulum').click();
  await field(page, 'How long is the rod?').fill('-43');
  await page.getByRole('button', { name: 'Fit this window' }).click();
  await assertMarked(page, await problemLike(page, words), ['How long is the rod?']);
});

test('two columns without names are shown with the units that their numbers suggest', async (t) => {
  const page = await openView(t, service, '/');
  await pasteNumbers(page, kBare);
  await page.getByRole('button', { name: 'Fit these numbers' }).click();
  await page.locator('.look h3', { hasText: 'pasted numbers' }).waitFor();
  assert.equal(await field(page, 'Unit of the times').inputValue(), 's');
  assert.equal(await field(page, 'Column of the angle').inputValue(), '2');
  assert.equal(await field(page, 'Unit of the values').inputValue(), 'deg');
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  const { options } = await service.json(`/v1/fits/${await shownFit(page)}/request`);
  assert.deepEqual(options, { model: 'viscous,coulomb,drag' });
});

test('pasted numbers are kept after another view and after a reload', async (t) => {
  const page = await openView(t, service, '/');
  await pasteNumbers(page, kBare);
  await field(page, 'Name of the recording').fill('mine');
  await page.getByRole('link', { name: 'Past fits' }).click();
  await page.getByRole('heading', { level: 1, name: 'Past fits' }).waitFor();
  await page.goBack();
  assert.equal(await field(page, 'Numbers').inputValue(), kBare);
  await page.reload();
  assert.equal(await field(page, 'Numbers').inputValue(), kBare);
  assert.equal(await field(page, 'Name of the recording').inputValue(), 'mine');
});

test('the choice of the light or dark theme is kept', async (t) => {
  const page = await openView(t, service, '/', { context: { colorScheme: 'light' } });
  await page.getByRole('button', { name: 'Dark', exact: true }).click();
  await page.reload();
  await page.getByRole('button', { name: 'Light', exact: true }).waitFor();
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
});

test('the error mark of a cell is removed when a table is pasted', async (t) => {
  const page = await openView(t, service, '/calibration');
  const cell = field(page, 'Reading, row 1');
  await cell.fill('x');
  await page.getByRole('button', { name: 'Calibrate' }).click();
  await assertMarked(page, await problemLike(page, '“x” is not a number'), ['Reading, row 1']);
  await cell.evaluate((input, table) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData('text', table);
    input.dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true, cancelable: true }));
  }, readDataset('textbook_calibration.csv'));
  assert.equal(await page.locator('.entry [aria-invalid]').count(), 0);
});

test('the menu of downloads closes when one is chosen', async (t) => {
  const page = await openView(t, service, `/fits/${await service.fit('coulomb.csv', 'model=viscous')}`);
  await page.getByText('Download', { exact: true }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Result (JSON)' }).click(),
  ]);
  assert.equal(download.suggestedFilename(), 'coulomb.json');
  assert.equal(await page.locator('.fit-actions details').evaluate((menu) => menu.open), false);
  assert.equal(await page.evaluate(() => document.activeElement.tagName), 'SUMMARY');
});

test('windows of one recording are compared on its own clock', async (t) => {
  const windows = ['from=0&to=9', 'from=3.3&to=14'];
  const ids = await Promise.all(windows.map((window) => service.fit('coulomb.csv', `model=coulomb&${window}`)));
  const page = await openView(t, service, `/compare?ids=${ids}`);
  const plot = page.locator('#overlay .plot').first();
  await plot.locator('canvas').waitFor();
  assert.match(await plot.getAttribute('aria-label'), /over time from 0\.?0* to 14\.?0* s/);
});

for (const width of [1280, 390]) {
  test(`no word of a menu is cut, ${width} px wide`, async (t) => {
    const page = await openView(t, service, '/', { context: { viewport: { width, height: 844 } } });
    await page.getByText('Further options', { exact: true }).click();
    const cut = await page.locator('select:visible').evaluateAll((menus) =>
      menus.flatMap((menu) => {
        const { font, paddingLeft } = getComputedStyle(menu);
        const ruler = document.createElement('canvas').getContext('2d');
        ruler.font = font;
        const room = menu.clientWidth - 2 * parseFloat(paddingLeft) - 16; // without the arrow
        return [...menu.options].map(({ text }) => text).filter((text) => ruler.measureText(text).width > room);
      }),
    );
    assert.deepEqual(cut, []);
  });
}
