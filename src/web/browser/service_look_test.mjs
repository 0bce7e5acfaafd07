// SPDX-License-Identifier: Apache-2.0
// The start page of the service: what is read in a recording before it is fitted, and what is missing.

import assert from 'node:assert/strict';
import { before, test } from 'node:test';

import { assertAccessible } from './page.mjs';
import { drop, kPasted, openView, readDataset, shownFit, startService } from './service_server.mjs';

let service;
before(async () => (service = await startService()));

const field = (page, label) => page.getByLabel(label, { exact: true });
const chosen = (page, label) => field(page, label).evaluate((menu) => menu.selectedOptions[0].textContent);
const look = (page) => page.locator('.look');

/** coulomb.csv with other names for its columns. */
const renamed = (names) => kPasted.replace('time_s,angle_deg', names);

/** The rows of coulomb.csv without times, numbered from 1: a fit needs their rate. */
function numbered(names) {
  const rows = kPasted.split('\n').filter((line) => /^[-\d]/.test(line));
  return [names, ...rows.map((row, i) => `${i + 1},${Math.round(row.split(',')[1])}`), ''].join('\n');
}

async function shownLook(page, name) {
  await look(page).getByRole('heading', { name }).waitFor();
}

test('guessed columns and units are shown as menus before the fit, with first rows and a sketch', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'logger.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'logger.csv');
  assert.equal(await chosen(page, 'Column of times'), 't');
  assert.equal(await chosen(page, 'Unit of the times'), 'seconds');
  assert.equal(await chosen(page, 'Column of the angle'), 'reading');
  assert.equal(await chosen(page, 'Unit of the values'), 'degrees');
  assert.match(await look(page).locator('.look-head').textContent(), /Text with columns separated by commas; \d+ samples/);
  assert.deepEqual(await look(page).locator('.first-rows thead th').allTextContents(), ['ttime', 'readingreading']);
  assert.equal(await look(page).locator('.first-rows tbody tr').count(), 8);
  await look(page).locator('.plot canvas').first().waitFor();
  assert.match(await look(page).locator('figcaption').textContent(), /Shaded: the window, 0 to/);
  assert.equal(await look(page).locator('.assumptions li').count(), 2);
  assert.doesNotMatch(await look(page).textContent(), /--/);
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  await shownFit(page);
});

test('a menu changes how the recording is read', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'logger.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'logger.csv');
  await field(page, 'Unit of the values').selectOption('rad_s');
  await page.waitForFunction(() => /rate in rad\/s/.test(document.querySelector('.look .plot')?.getAttribute('aria-label') ?? ''));
  assert.equal(await look(page).locator('.assumptions li').count(), 1);
  await field(page, 'Unit of the values').selectOption('deg');
  await page.waitForFunction(() => /angle in °/.test(document.querySelector('.look .plot')?.getAttribute('aria-label') ?? ''));
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  const { options } = await service.json(`/v1/fits/${await shownFit(page)}/request`);
  assert.deepEqual(options, { model: 'viscous,coulomb,drag', unit: 'deg' });
});

test('everything that is missing is asked at once, also what the rig lacks', async (t) => {
  const page = await openView(t, service, '/');
  await page.locator('.choice label', { hasText: 'masses and length' }).click();
  await field(page, 'How heavy is the bob?').fill('380');
  await drop(page, [{ name: 'counts.csv', content: numbered('n,encoder') }]);
  await shownLook(page, 'counts.csv');
  assert.deepEqual(await look(page).locator('.missing li button').allTextContents(), [
    'Which column is the time, or how many samples are there in a second?',
    'In which unit are the values?',
    'How heavy is the rod? How long is the rod?',
  ]);
  for (const label of ['Samples per second', 'Unit of the values', 'How heavy is the rod?', 'How long is the rod?'])
    assert.equal(await field(page, label).getAttribute('aria-invalid'), 'true', label);
  await page.getByRole('button', { name: 'Fit', exact: true }).click(); // goes to the first question instead
  assert.equal(new URL(page.url()).pathname, '/');
  await field(page, 'Samples per second').fill('100');
  await field(page, 'Unit of the values').selectOption('deg');
  await field(page, 'How heavy is the rod?').fill('95');
  await field(page, 'How long is the rod?').fill('43');
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  const { options } = await service.json(`/v1/fits/${await shownFit(page)}/request`);
  assert.deepEqual(options, {
    model: 'viscous,coulomb,drag',
    time_column: 'none',
    unit: 'deg',
    sample_rate_hz: '100',
    bob_mass: '380g',
    rod_mass: '95g',
    rod_length: '43cm',
  });
});

test('masses in g and a length in cm give the answer of the SI values', async (t) => {
  const page = await openView(t, service, '/');
  await page.locator('.choice label', { hasText: 'masses and length' }).click();
  for (const [label, value] of [
    ['How heavy is the bob?', '380'],
    ['Standard deviation of: Mass of the bob', '0,5'],
    ['How heavy is the rod?', '95'],
    ['How long is the rod?', '43'],
    ['How large is g where you are?', '9.81'],
  ])
    await field(page, label).fill(value);
  await page.locator('input[type=file][multiple]').setInputFiles({
    name: 'run.csv',
    mimeType: 'text/csv',
    buffer: Buffer.from(readDataset('coulomb.csv')),
  });
  await shownLook(page, 'run.csv');
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  const shown = await service.json(`/v1/fits/${await shownFit(page)}`);
  const form = new FormData();
  form.append('data', new Blob([readDataset('coulomb.csv')]), 'run.csv');
  const rig = { bob_mass: { value: 0.38, std_dev: 0.0005 }, rod_mass: 0.095, rod_length: 0.43, gravity: 9.81 };
  form.append('rig', new Blob([JSON.stringify(rig)]), 'rig.json');
  const answer = await fetch(`${service.url}/v1/fits?model=viscous,coulomb,drag`, { method: 'POST', body: form });
  const asked = await answer.json();
  assert.deepEqual(shown.rig, rig);
  assert.equal(shown.fits[1].parameters.inertia.unit, 'kg m^2');
  const parameters = ({ fits, recordings }) => [...fits, ...recordings[0].fits].map((fit) => fit.parameters);
  assert.deepEqual(parameters(shown), parameters(asked));
});

test('the recording and all choices survive a reload and the way back from a fit, until they are removed', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'logger.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'logger.csv');
  await page.locator('.choice label', { hasText: 'masses and length' }).click();
  await field(page, 'How long is the rod?').fill('430');
  await field(page, 'Unit of: Length of the rod').selectOption('mm');
  await field(page, 'Unit of the values').selectOption('mrad');
  await page.reload();
  await shownLook(page, 'logger.csv');
  assert.equal(await chosen(page, 'Unit of the values'), 'milliradians');
  assert.equal(await field(page, 'How long is the rod?').inputValue(), '430');
  assert.equal(await field(page, 'Unit of: Length of the rod').inputValue(), 'mm');
  await page.locator('.choice label', { hasText: 'nothing' }).click();
  await field(page, 'Unit of the values').selectOption('deg');
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  await shownFit(page);
  await page.getByRole('link', { name: 'New fit' }).click();
  await shownLook(page, 'logger.csv');
  assert.equal(await chosen(page, 'Unit of the values'), 'degrees');
  await page.getByRole('button', { name: 'Remove logger.csv' }).click();
  await page.reload();
  await page.getByText('No recording at hand').waitFor();
  assert.equal(await look(page).locator('h3').count(), 0);
});

test('a fit gets the name that is entered beside the Fit button, also after a reload', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'logger.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'logger.csv');
  await field(page, 'Name').fill('Heavy bob');
  await page.reload();
  await shownLook(page, 'logger.csv');
  assert.equal(await field(page, 'Name').inputValue(), 'Heavy bob');
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  const { name, file } = await service.json(`/v1/fits/${await shownFit(page)}/request`);
  assert.deepEqual([name, file], ['Heavy bob', 'logger.csv']);
  await page.getByRole('link', { name: 'New fit' }).click();
  await shownLook(page, 'logger.csv');
  await drop(page, [{ name: 'other.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'other.csv');
  assert.equal(await field(page, 'Name').inputValue(), ''); // the name was that of another recording
});

test('the name of a fit is forgotten for a recording that is dropped before the one before is read again', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'logger.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'logger.csv');
  await field(page, 'Name').fill('Heavy bob');
  const unanswered = [];
  await page.route('**/v1/preview*', (route) => unanswered.push(route), { times: 1 });
  await page.reload();
  await page.getByText('Reading logger.csv').waitFor();
  await drop(page, [{ name: 'other.csv', content: renamed('t,reading') }]);
  await shownLook(page, 'other.csv');
  assert.equal(unanswered.length, 1);
  assert.equal(await field(page, 'Name').inputValue(), '');
});

test('readings in volts without a calibration are a problem before the fit, unless the law needs no angle', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'volts.csv', content: renamed('time_s,pot_volts') }]);
  await shownLook(page, 'volts.csv');
  assert.match(await look(page).locator('.problem').textContent(), /the readings are in volts/);
  assert.match(await page.locator('.fit-bar').textContent(), /Solve the problem above first/);
  await look(page).locator('.calibration-form').waitFor();
  await page.locator('.choice label', { hasText: 'I choose' }).click();
  await page.locator('.checks input[value=linear]').check();
  for (const law of ['viscous', 'coulomb', 'drag']) await page.locator(`.checks input[value=${law}]`).uncheck();
  await look(page).locator('.problem').waitFor({ state: 'detached' });
});

test('a recording that is too large for the memory of the browser is shown, and the page says so', async (t) => {
  const page = await openView(t, service, '/');
  const content = `${renamed('t,reading')}\n${'# a comment of forty characters, again and\n'.repeat(100_000)}`;
  await page.locator('input[type=file][multiple]').setInputFiles({
    name: 'long.csv',
    mimeType: 'text/csv',
    buffer: Buffer.from(content),
  });
  await shownLook(page, 'long.csv');
  assert.match(await look(page).locator('.look-head').textContent(), /too large for the memory of the browser/);
});

test('a calibration table is dropped beside a recording in counts, or pasted into its look', async (t) => {
  const table = readDataset('recorded_calibration.csv');
  const content = readDataset('recorded.csv')
    .split('\n')
    .filter((line) => !line.startsWith('# calibration'))
    .slice(0, 3000)
    .join('\n');
  const page = await openView(t, service, '/');
  await drop(page, [
    { name: 'recorded.csv', content },
    { name: 'calibration table.csv', content: table },
  ]);
  await shownFit(page);
  const sent = await service.json(`/v1/fits/${new URL(page.url()).pathname.split('/').pop()}`);
  assert.notEqual(sent.calibration, null);
  await page.getByRole('link', { name: 'New fit' }).click();
  await page.getByRole('button', { name: 'Use none' }).first().click();
  await field(page, 'Or paste the table').fill(table);
  await page.getByRole('button', { name: 'Use this table' }).click();
  await page.waitForFunction(() => /angle in/.test(document.querySelector('.look .plot')?.getAttribute('aria-label') ?? ''));
});

test('text that is pasted on the page is a recording, and the formats that are read are named', async (t) => {
  const page = await openView(t, service, '/');
  for (const format of ['CSV', 'phyphox', 'Tracker', '.xlsx', 'MAT-files', 'zip'])
    assert.match(await page.locator('.drop-hint').textContent(), new RegExp(format));
  await page.evaluate((words) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData('text/plain', words);
    document.body.dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true }));
  }, renamed('t,reading'));
  await shownLook(page, 'pasted numbers');
});

test('a window that cannot be found is a problem beside the sketch', async (t) => {
  const page = await openView(t, service, '/');
  const rows = Array.from({ length: 200 }, (_unused, i) => `${i / 100},${20 + (i % 2)}`);
  await drop(page, [{ name: 'held.csv', content: ['time_s,angle_deg', ...rows, ''].join('\n') }]);
  await shownLook(page, 'held.csv');
  await look(page).locator('.problem').waitFor();
  await look(page).locator('.plot canvas').first().waitFor();
});

for (const [colorScheme, width, height] of [
  ['light', 1280, 800],
  ['dark', 1280, 800],
  ['light', 390, 844],
  ['dark', 390, 844],
])
  test(`the look before a fit is accessible, ${colorScheme}, ${width} px wide`, async (t) => {
    const page = await openView(t, service, '/', { context: { colorScheme, viewport: { width, height } } });
    await page.locator('.choice label', { hasText: 'masses and length' }).click();
    await field(page, 'How heavy is the bob?').fill('380');
    await drop(page, [{ name: 'counts.csv', content: numbered('n,encoder') }]);
    await shownLook(page, 'counts.csv');
    await assertAccessible(page);
    await field(page, 'Samples per second').fill('100');
    await field(page, 'Unit of the values').selectOption('counts');
    await look(page).locator('.calibration-form').waitFor();
    await assertAccessible(page);
  });

for (const [width, height] of [
  [1280, 800],
  [390, 600],
]) {
  test(`no element with the focus is under the Fit bar, ${width} x ${height}`, async (t) => {
    const page = await openView(t, service, '/', { context: { viewport: { width, height } } });
    await drop(page, [{ name: 'logger.csv', content: renamed('t,reading') }]);
    await shownLook(page, 'logger.csv');
    const hidden = [];
    let stops = 0;
    for (; stops < 120; ++stops) {
      await page.keyboard.press('Tab');
      const covered = await page.evaluate(() => {
        const focused = document.activeElement;
        if (focused === document.body) return null;
        const bar = document.querySelector('.fit-bar');
        if (bar.contains(focused)) return '';
        const { top, bottom, height } = focused.getBoundingClientRect();
        const seen = Math.min(bottom, bar.getBoundingClientRect().top) - Math.max(top, 0);
        return seen >= Math.min(height, 24) ? '' : `${focused.tagName} ${focused.textContent.slice(0, 40)}`;
      });
      if (covered === null) break;
      if (covered !== '') hidden.push(covered);
    }
    assert.ok(stops > 10, String(stops));
    assert.deepEqual(hidden, []);
  });
}
