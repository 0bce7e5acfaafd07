// SPDX-License-Identifier: Apache-2.0
// The page of the service: from a recording to its fit, and actions with the fit.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { before, test } from 'node:test';

import { assertShown, drop, kPasted, openView, readDataset, shownFit, startService, dataset } from './service_server.mjs';

let service;
before(async () => (service = await startService()));

const value = (page, name) => page.locator(`[data-parameter=${name}] .value > span`).textContent();

/** Asserts that inertia and friction in the first section are those of the JSON of the model, and that no parameter is missing. */
async function assertParameters(page, id, model) {
  const result = await service.json(`/v1/fits/${id}`);
  const { parameters } = result.fits.find((fit) => fit.model === model);
  for (const [name, { estimate, total_std_error: std_error }] of Object.entries(parameters))
    assertShown(await value(page, name), { estimate, std_error });
  const { parameters: own } = result.recordings[0].fits.find((fit) => fit.model === model);
  assert.equal(await page.locator('[data-parameter]').count(), Object.keys({ ...parameters, ...own }).length);
  return result;
}

/** Drags a handle of the window with the mouse, to a share of the width of the plot. */
async function dragHandle(page, name, to) {
  await page.locator('#again .plot').scrollIntoViewIfNeeded();
  const box = await page.locator('#again .plot .u-over').boundingBox();
  const handle = await page.getByRole('slider', { name }).boundingBox();
  const y = box.y + box.height / 3;
  await page.mouse.move(handle.x + handle.width / 2, y);
  await page.mouse.down();
  await page.mouse.move(box.x + to * box.width, y, { steps: 6 });
  await page.mouse.up();
}

const windowFields = async (page) =>
  Promise.all(
    ['From [s]', 'To [s]'].map(async (label) => Number(await page.getByLabel(label, { exact: true }).inputValue())),
  );

test('a dropped file is fitted at once, and the numbers equal those of the API', async (t) => {
  const page = await openView(t, service, '/');
  await drop(page, [{ name: 'coulomb.csv', content: readDataset('coulomb.csv') }]);
  const id = await shownFit(page);
  assert.equal(await page.locator('h1').textContent(), 'coulomb.csv');
  assert.equal(await page.evaluate(() => document.activeElement?.tagName), 'H1');
  const result = await assertParameters(page, id, 'coulomb');
  assert.equal(result.comparison.recommended, 'coulomb');
  assert.deepEqual(
    result.fits.map((fit) => fit.model),
    ['viscous', 'coulomb', 'drag'],
  );
  assert.match(await page.locator('#verdict').textContent(), /Recommended law: coulomb/);
  assert.equal(await page.locator('#comparison .marked th').first().textContent(), 'coulomb');
  assert.match(
    await page.locator('#provenance pre').textContent(),
    /^fit_pendulum --data coulomb\.csv --model viscous,coulomb,drag$/,
  );
});

test('with masses and length the inertia is in kg m², and only the chosen model is fitted', async (t) => {
  const page = await openView(t, service, '/');
  await page.locator('.choice label', { hasText: 'masses and length' }).click();
  const exact = JSON.parse(readDataset('textbook_rig.json'));
  const rig = Object.fromEntries(Object.entries(exact).map(([key, { value }]) => [key, value]));
  await page.getByLabel('How heavy is the bob?', { exact: true }).fill(String(1000 * rig.bob_mass).replace('.', ','));
  await page.getByLabel('How heavy is the rod?', { exact: true }).fill(String(1000 * rig.rod_mass));
  await page.getByLabel('How long is the rod?', { exact: true }).fill(String(rig.rod_length));
  await page.getByLabel('Unit of: Length of the rod').selectOption('m');
  await page.getByLabel('How large is g where you are?', { exact: true }).fill(String(rig.gravity));
  await page.locator('.choice label', { hasText: 'I choose' }).click();
  for (const label of await page.locator('.checks label').all()) {
    const box = label.locator('input');
    await box.setChecked((await box.getAttribute('value')) === 'viscous');
  }
  await page.locator('input[type=file][multiple]').setInputFiles(dataset('textbook_rig.csv'));
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  const id = await shownFit(page);
  const result = await assertParameters(page, id, 'viscous');
  assert.deepEqual(result.rig, rig);
  assert.equal(result.fits.length, 1);
  assert.equal(result.fits[0].parameters.inertia.unit, 'kg m^2');
  assert.match(await page.locator('[data-parameter=inertia]').textContent(), /kg.m²/);
});

test('numbers can be pasted', async (t) => {
  const page = await openView(t, service, '/');
  await page.getByText('Or paste numbers').click();
  await page.getByLabel('Numbers', { exact: true }).fill(kPasted);
  await page.getByLabel('Name of the recording').fill('from the notebook');
  await page.getByRole('button', { name: 'Fit these numbers' }).click();
  await assertParameters(page, await shownFit(page), 'coulomb');
  assert.equal(await page.locator('h1').textContent(), 'from the notebook');
});

test('the reason for an unusable file is shown in the words of the service and gets the focus', async (t) => {
  const page = await openView(t, service, '/', { refused: ['status of 422'] });
  const content = `${readDataset('coulomb.csv')}20.1,not a number\n`;
  const form = new FormData();
  form.append('data', new Blob([content]), 'bad.csv');
  const told = await (await fetch(`${service.url}/v1/fits?model=coulomb`, { method: 'POST', body: form })).json();
  assert.equal(told.status, 422);
  await drop(page, [{ name: 'bad.csv', content }]);
  const alert = page.getByRole('alert').filter({ has: page.locator('.problem') });
  await alert.waitFor();
  assert.equal(await alert.locator('.detail').textContent(), told.detail);
  assert.equal(await alert.locator('.title').textContent(), told.title);
  assert.ok(await page.evaluate(() => document.activeElement.classList.contains('problem')));
  await page.getByRole('button', { name: 'Read again' }).waitFor();
});

test('a field that is empty or not a number is named and gets the focus', async (t) => {
  const page = await openView(t, service, '/');
  await page.locator('.choice label', { hasText: 'masses and length' }).click();
  await drop(page, [{ name: 'coulomb.csv', content: readDataset('coulomb.csv') }]);
  await page.getByRole('button', { name: 'Fit', exact: true }).click();
  await page.locator('.problem').waitFor();
  assert.equal(
    await page.locator('.problem .detail').textContent(),
    'Please answer: How heavy is the bob? How heavy is the rod? How long is the rod?',
  );
  assert.ok(
    await page
      .getByLabel('How heavy is the bob?', { exact: true })
      .evaluate((input) => input === document.activeElement),
  );
});

test('another window is chosen with its handles, and fitted', async (t) => {
  const page = await openView(t, service, `/fits/${await service.fit('coulomb.csv', 'model=coulomb')}`);
  const first = await shownFit(page);
  await dragHandle(page, 'Begin of the window', 0.25);
  await dragHandle(page, 'End of the window', 0.75);
  const [from, to] = await windowFields(page);
  assert.ok(Math.abs(from - 5) < 0.3 && Math.abs(to - 15) < 0.3, `${from} to ${to}`); // quarters of 20 s, and a margin
  await dragHandle(page, 'End of the window', 0.6);
  const [same, earlier] = await windowFields(page);
  assert.equal(same, from);
  assert.ok(Math.abs(earlier - 12) < 0.3, String(earlier));
  await page.getByRole('button', { name: 'Fit this window' }).click();
  const second = await shownFit(page, first);
  const result = await assertParameters(page, second, 'coulomb');
  const { window_s: fitted } = result.recordings[0];
  assert.ok(Math.abs(fitted[0] - from) < 0.02 && Math.abs(fitted[1] - earlier) < 0.02);
  const { options } = await service.json(`/v1/fits/${second}/request`);
  assert.deepEqual([Number(options.from), Number(options.to)], [from, earlier]);
  assert.deepEqual(await windowFields(page), fitted);
});

test('a window can be chosen by touch', async (t) => {
  const id = await service.fit('coulomb.csv', 'model=coulomb');
  const context = { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true };
  const page = await openView(t, service, `/fits/${id}`, { context });
  await page.locator('#again .plot').scrollIntoViewIfNeeded();
  const box = await page.locator('#again .plot .u-over').boundingBox();
  const handle = await page.getByRole('slider', { name: 'Begin of the window' }).boundingBox();
  const client = await page.context().newCDPSession(page);
  const touch = (type, share) =>
    client.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: share === null ? [] : [{ x: box.x + share * box.width, y: box.y + box.height / 3 }],
    });
  const before = await windowFields(page);
  await touch('touchStart', (handle.x + handle.width / 2 - box.x) / box.width);
  for (const share of [0.1, 0.2, 0.3]) await touch('touchMove', share);
  await touch('touchEnd', null);
  const [from, to] = await windowFields(page);
  assert.ok(Math.abs(from - 6) < 0.4, `${from} to ${to}`);
  assert.equal(to, before[1]);
});

test('another law, rig and window are chosen by keyboard, and the window can be found again', async (t) => {
  const page = await openView(t, service, `/fits/${await service.fit('textbook_rig.csv', 'model=coulomb&from=3')}`);
  const first = await shownFit(page);
  await page.getByLabel('To [s]', { exact: true }).fill('12,5');
  await page.getByText('Another kind of friction').click();
  await page.locator('#again .choice label', { hasText: 'find out for me' }).click();
  await page.getByText('Another description of the pendulum').click();
  await page.locator('#again .choice label', { hasText: 'its gravity torque' }).click();
  await page.getByLabel('How large is the gravity torque G?', { exact: true }).fill('1.8');
  await page.getByLabel('To [s]', { exact: true }).focus();
  while (!(await page.evaluate(() => document.activeElement.textContent === 'Fit this window')))
    await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  const second = await shownFit(page, first);
  const made = await service.json(`/v1/fits/${second}/request`);
  assert.equal(made.options.gravity_torque, '1.8N m');
  assert.equal(made.options.model, 'viscous,coulomb,drag');
  assert.deepEqual([Number(made.options.from), Number(made.options.to)], [3, 12.5]);
  await page.getByRole('button', { name: 'Find the window again' }).click();
  const third = await service.json(`/v1/fits/${await shownFit(page, second)}/request`);
  assert.ok(!('from' in third.options) && !('to' in third.options), JSON.stringify(third.options));
  assert.equal(third.options.gravity_torque, '1.8N m');
});

test('from the address bar to the fit of an example by the keyboard alone', async (t) => {
  const page = await openView(t, service, '/');
  await page
    .getByRole('button', { name: /^Try it/ })
    .first()
    .waitFor();
  const name = () =>
    page.evaluate(() => document.activeElement?.getAttribute('aria-label') || document.activeElement?.textContent);
  await page.keyboard.press('Tab');
  assert.equal(await name(), 'Skip to the content');
  for (let i = 0; !(await name()).startsWith('Try it'); ++i) {
    assert.ok(i < 40, 'no example is reached');
    await page.keyboard.press('Tab');
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
    assert.notEqual(outline, 'none', `the focus is not seen on ${await name()}`);
  }
  const { examples } = await service.json('/v1/examples');
  await page.keyboard.press('Enter');
  const id = await shownFit(page);
  assert.equal(await page.locator('h1').textContent(), examples[0].title);
  assert.equal(await page.evaluate(() => document.activeElement?.tagName), 'H1');
  const { comparison, fits } = await service.json(`/v1/fits/${id}`);
  await assertParameters(page, id, comparison?.recommended ?? fits[0].model);
});

test('downloads equal the files that the service keeps', async (t) => {
  const id = await service.fit('coulomb.csv', 'model=coulomb');
  const page = await openView(t, service, `/fits/${id}`);
  for (const [label, part, name] of [
    ['Result (JSON)', '', 'coulomb.json'],
    ['Residuals (CSV)', '/residuals', 'coulomb_residuals.csv'],
    ['Series (JSON)', '/series', 'coulomb_series.json'],
    ['Report (HTML page)', '/report', 'coulomb.html'],
    ['Report (Markdown)', '/markdown', 'coulomb.md'],
    ['Recording as sent', '/recording', 'coulomb.csv'],
  ]) {
    if (!(await page.locator('.fit-actions details').evaluate((menu) => menu.open)))
      await page.getByText('Download', { exact: true }).click();
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.getByRole('button', { name: label }).click(),
    ]);
    assert.equal(download.suggestedFilename(), name);
    const expected = Buffer.from(await (await fetch(`${service.url}/v1/fits/${id}${part}`)).arrayBuffer());
    assert.ok(fs.readFileSync(await download.path()).equals(expected), label);
  }
});

test('the link is copied', async (t) => {
  const id = await service.fit('coulomb.csv', 'model=viscous');
  const page = await openView(t, service, `/fits/${id}`, {
    context: { permissions: ['clipboard-read', 'clipboard-write'] },
  });
  await page.getByRole('button', { name: 'Copy link' }).click();
  await page.getByText('The link is copied.').waitFor();
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), `${service.url}/fits/${id}`);
});

test('a fit is deleted only after a confirmation', async (t) => {
  const id = await service.fit('runs_1.csv', 'model=coulomb&name=short-lived');
  const page = await openView(t, service, `/fits/${id}`, { refused: ['status of 404'] });
  await page.getByRole('button', { name: 'Delete' }).click();
  await page.keyboard.press('Enter'); // Cancel has the focus
  assert.equal((await fetch(`${service.url}/v1/fits/${id}`)).status, 200);
  await page.getByRole('button', { name: 'Delete' }).click();
  await page.locator('dialog').getByRole('button', { name: 'Delete' }).click();
  await page.waitForURL('**/fits');
  assert.equal((await fetch(`${service.url}/v1/fits/${id}`)).status, 404);
  await page.goto(`${service.url}/fits/${id}`);
  await page.locator('.problem').waitFor();
  assert.equal(await page.locator('.problem .title').textContent(), 'There is nothing at this address');
});

test('links, back and forward change the view without loading the page again', async (t) => {
  const page = await openView(t, service, '/');
  await page.evaluate(() => (window.kept = true));
  for (const [link, heading] of [
    ['Past fits', 'Past fits'],
    ['Calibration', 'Calibration'],
  ]) {
    await page.getByRole('navigation', { name: 'Site' }).getByRole('link', { name: link }).click();
    await page.getByRole('heading', { level: 1, name: heading }).waitFor();
    assert.equal(await page.title(), `${heading} – Pendulum`);
    assert.equal(await page.getByRole('link', { name: link }).getAttribute('aria-current'), 'page');
  }
  await page.goBack();
  await page.getByRole('heading', { level: 1, name: 'Past fits' }).waitFor();
  assert.equal(await page.evaluate(() => window.kept), true);
});
