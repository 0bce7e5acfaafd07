// SPDX-License-Identifier: Apache-2.0
// The page with a token, a busy service, an interrupted network, and a recording in progress.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { test } from 'node:test';

import jsQR from 'jsqr';

import { assertAccessible, ink } from './page.mjs';
import { dataset, drop, openView, readDataset, shownFit, startService, write } from './service_server.mjs';

const kCoulomb = { name: 'coulomb.csv', content: readDataset('coulomb.csv') };

test('a token is asked for once, and again when it is wrong', async (t) => {
  const token = 'correct-horse-battery-staple';
  const service = await startService('--token_file', write('token', `${token}\n`));
  const page = await openView(t, service, '/', { refused: ['status of 401'] });
  const dialog = page.getByRole('dialog', { name: 'Token' });
  await dialog.getByLabel('Token', { exact: true }).fill('not it');
  await dialog.getByRole('button', { name: 'Go on' }).click();
  await dialog.getByText('That token was not accepted.').waitFor();
  await assertAccessible(page);
  await dialog.getByLabel('Token', { exact: true }).fill(token);
  await page.keyboard.press('Enter');
  await page
    .getByRole('button', { name: /^Try it/ })
    .first()
    .waitFor();
  assert.equal(await page.locator('dialog').count(), 0);
  await drop(page, [kCoulomb]);
  const id = await shownFit(page);
  await page.reload();
  await page.waitForSelector('#verdict');
  assert.equal(await page.locator('dialog').count(), 0);
  await page.getByText('Download', { exact: true }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Result (JSON)' }).click(),
  ]);
  const headers = { Authorization: `Bearer ${token}` };
  assert.equal(
    fs.readFileSync(await download.path(), 'utf8'),
    await (await fetch(`${service.url}/v1/fits/${id}`, { headers })).text(),
  );
  assert.doesNotMatch(page.url(), /horse/);
  await service.stop();
});

test('a link and its QR code carry the token to another device, and it stays in no address', async (t) => {
  const token = 'a+b&c#d=e-horse%20';
  const service = await startService('--token_file', write('token', `${token}\n`));
  const page = await openView(t, service, '/', { refused: ['status of 401'] });
  assert.equal(await page.getByRole('button', { name: 'Use on another device' }).count(), 0); // hidden
  await page.getByRole('dialog').getByLabel('Token', { exact: true }).fill(token);
  await page.keyboard.press('Enter');
  await page.getByRole('button', { name: 'Use on another device' }).click();
  const dialog = page.getByRole('dialog', { name: 'Use on another device' });
  await assertAccessible(page);
  const link = await dialog.getByLabel('Link', { exact: true }).inputValue();
  const { data, width, height } = await dialog.locator('.qr').evaluate(async (drawn) => {
    const image = new Image();
    const text = new XMLSerializer().serializeToString(drawn);
    image.src = `data:image/svg+xml,${encodeURIComponent(text.replace('<svg ', '<svg width="400" height="400" '))}`;
    await image.decode();
    const canvas = new OffscreenCanvas(400, 400).getContext('2d');
    canvas.drawImage(image, 0, 0, 400, 400);
    return { data: [...canvas.getImageData(0, 0, 400, 400).data], width: 400, height: 400 };
  });
  assert.equal(jsQR(Uint8ClampedArray.from(data), width, height).data, link);
  const other = await openView(t, service, link.slice(service.url.length));
  await other.getByRole('button', { name: /^Try it/ }).first().waitFor();
  assert.equal(other.url(), `${service.url}/`);
  assert.equal(await other.evaluate(() => history.length), 2); // the blank page before it, and this one
  await other.getByRole('link', { name: 'Past fits' }).click();
  await other.getByText('There are no such fits.').waitFor();
  assert.equal(await other.locator('dialog').count(), 0);
  assert.doesNotMatch(service.log(), /horse/);
  await service.stop();
});

test('without the token nothing is shown, and the page says what it needs', async (t) => {
  const service = await startService('--token_file', write('token', 'correct-horse-battery-staple\n'));
  const page = await openView(t, service, '/fits', { refused: ['status of 401'] });
  await page.getByRole('dialog').getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('No token was given.').waitFor();
  assert.equal(await page.locator('.runs tbody tr').count(), 0);
  await service.stop();
});

/** Answers the first requests for a fit as a busy service does. */
async function busy(page, times, seconds) {
  let left = times;
  const keys = [];
  await page.route('**/v1/fits?*', async (route) => {
    if (route.request().method() !== 'POST') return route.continue();
    keys.push(route.request().headers()['idempotency-key']);
    if (left-- <= 0) return route.continue();
    const detail = '64 requests wait already';
    const problem = {
      type: 'urn:pendulum:problem:too_many_requests',
      title: 'Too many requests',
      status: 429,
      detail,
      code: 'too_many_requests',
      exit_code: 75,
    };
    return route.fulfill({
      status: 429,
      headers: { 'Retry-After': String(seconds) },
      contentType: 'application/problem+json',
      body: JSON.stringify(problem),
    });
  });
  return keys;
}

test('a request to a busy service is repeated unchanged after the time that the service gives', async (t) => {
  const service = await startService();
  const page = await openView(t, service, '/', { refused: ['status of 429'] });
  const keys = await busy(page, 1, 2);
  await drop(page, [kCoulomb]);
  const notice = page.locator('.notice');
  await notice.waitFor();
  assert.match(await notice.textContent(), /Too many requests\. 64 requests wait already.* tried again in 2 s/);
  await shownFit(page);
  assert.equal(keys.length, 2);
  assert.equal(keys[0], keys[1]);
  assert.equal(await notice.count(), 0);
  await service.stop();
});

test('waiting for a busy service can be ended', async (t) => {
  const service = await startService();
  const page = await openView(t, service, '/', { refused: ['status of 429'] });
  const keys = await busy(page, 9, 500);
  await drop(page, [kCoulomb]);
  await page.locator('.notice').getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('Cancelled.').waitFor();
  await page.getByRole('button', { name: 'Fit', exact: true }).waitFor();
  assert.equal(keys.length, 1);
  assert.equal(new URL(page.url()).pathname, '/');
  await service.stop();
});

test('a network failure is reported, and the dropped file is not lost', async (t) => {
  const service = await startService();
  const page = await openView(t, service, '/', { refused: ['net::ERR'] });
  await page
    .getByRole('button', { name: /^Try it/ })
    .first()
    .waitFor();
  await page.context().setOffline(true);
  await drop(page, [kCoulomb]);
  await page.locator('.problem').waitFor();
  assert.match(await page.locator('.problem').textContent(), /The service does not answer.*127\.0\.0\.1/);
  await page.context().setOffline(false);
  await page.getByRole('button', { name: 'Read again' }).click();
  await shownFit(page);
  await service.stop();
});

test('an interrupted stream continues where it stopped', async (t) => {
  const service = await startService();
  const form = new FormData();
  for (const k of [1, 2, 3]) form.append('data', new Blob([readDataset(`runs_${k}.csv`)]), `runs_${k}.csv`);
  const answer = await fetch(`${service.url}/v1/batches?model=coulomb`, { method: 'POST', body: form });
  const address = answer.headers.get('Location');
  const page = await openView(t, service, '/');
  const asked = [];
  await page.route('**/events', async (route) => {
    asked.push(route.request().headers()['last-event-id']);
    if (asked.length > 1) return route.continue();
    const event = { id: 'x', name: 'x', exit_code: 0, reason: '', done: 1, failed: 0, runs: 3 };
    return route.fulfill({
      contentType: 'text/event-stream',
      body: `id: 1\nevent: fit\ndata: ${JSON.stringify(event)}\n\n`,
    });
  });
  await page.goto(service.url + address.replace('/v1', ''));
  await page.getByText('3 of 3 recordings fitted.').waitFor();
  while (asked.length < 2) await page.waitForTimeout(50);
  assert.deepEqual(asked.slice(0, 2), [undefined, '1']);
  await page.goto('about:blank'); // else the page would send another request to the stopped service
  await service.stop();
});

test('a recording is shown while it is made, and fitted when it has ended', async (t) => {
  const lines = readDataset('coulomb.csv').split('\n');
  const head = lines.findIndex((line) => /^\d/.test(line));
  const run = write('live/run.csv', '');
  fs.unlinkSync(run);
  const service = await startService('--live', run);
  for (const context of [
    { viewport: { width: 1280, height: 900 } },
    { viewport: { width: 360, height: 740 }, colorScheme: 'dark' },
  ]) {
    const page = await openView(t, service, '/live', { context });
    await page.getByText('Waiting for a recording to begin.').waitFor();
    await assertAccessible(page);
  }
  const page = await openView(t, service, '/live');
  fs.writeFileSync(`${run}.part`, `${lines.slice(0, head + 500).join('\n')}\n`);
  await page.getByText('Recording. File: run.csv.').waitFor();
  await page.locator('.readout', { hasText: /^500 samples/ }).waitFor();
  assert.ok(await page.getByRole('button', { name: 'Fit it' }).isDisabled());
  fs.appendFileSync(`${run}.part`, `${lines.slice(head + 500, head + 900).join('\n')}\n`);
  await page.locator('.readout', { hasText: /^900 samples/ }).waitFor();
  await page.waitForSelector('.plot[aria-label^="Readings from 0 to 8."]'); // 900 samples at 100 Hz end at 8.99 s
  assert.ok((await ink(page, 'main .plot')) > 2000);
  fs.appendFileSync(`${run}.part`, lines.slice(head + 900).join('\n'));
  fs.renameSync(`${run}.part`, run);
  await page.getByText('The recording has ended. File: run.csv.').waitFor();
  await assertAccessible(page);
  await page.getByRole('button', { name: 'Fit it' }).click();
  const id = await shownFit(page);
  assert.equal(
    await (await fetch(`${service.url}/v1/fits/${id}/recording`)).text(),
    fs.readFileSync(dataset('coulomb.csv'), 'utf8'),
  );
  await service.stop();
});
