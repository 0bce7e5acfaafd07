// SPDX-License-Identifier: Apache-2.0
// Fits of the service as things that the user handles: names, windows, sliders, and work that is cancelled.

import assert from 'node:assert/strict';
import { before, test } from 'node:test';

import { assertAccessible } from './page.mjs';
import { assertShown, openView, readDataset, shownFit, startService } from './service_server.mjs';

const kDegrees = 180 / Math.PI;

let service;
before(async () => {
  service = await startService('--threads', '1', '--fit_seconds', '600');
});

const heading = (page) => page.locator('h1').textContent();

async function rename(page, name) {
  await page.getByRole('button', { name: 'Rename' }).click();
  await page.getByLabel('Name', { exact: true }).fill(name);
  await page.keyboard.press('Enter');
}

for (const [width, height] of [
  [1280, 800],
  [390, 844],
])
  test(`verdict, parameters and swing are on the first screen of ${width} x ${height}`, async (t) => {
    const id = await service.fit('recorded.csv', 'models=viscous,coulomb');
    const page = await openView(t, service, `/fits/${id}`, { context: { viewport: { width, height } } });
    await page.locator('#verdict .plot canvas').waitFor();
    for (const part of ['.banner .title', '.answer-table', '#verdict .plot canvas']) {
      const { bottom } = await page.locator(part).evaluate((element) => element.getBoundingClientRect().toJSON());
      assert.ok(bottom > 0 && bottom <= height, `${part} ends at ${bottom} px`);
    }
    await assertAccessible(page);
  });

test('a fit is renamed, and the list shows name, file, law, window and the total error', async (t) => {
  const id = await service.fit('recorded.csv', 'model=coulomb&from=2&to=12', 'recorded_rig.json');
  const page = await openView(t, service, `/fits/${id}`);
  await shownFit(page);
  assert.equal(await heading(page), 'recorded.csv');
  await rename(page, 'Heavy <bob>');
  await page.getByRole('heading', { name: 'Heavy <bob>', level: 1 }).waitFor();
  const request = await service.json(`/v1/fits/${id}/request`);
  assert.deepEqual([request.name, request.file], ['Heavy <bob>', 'recorded.csv']);
  await page.getByRole('link', { name: 'Past fits' }).click();
  const row = page.locator(`.runs tr[data-id="${id}"]`);
  await row.waitFor();
  const result = await service.json(`/v1/fits/${id}`);
  const { estimate, total_std_error, std_error } = result.fits[0].parameters.inertia;
  assert.ok(total_std_error > std_error);
  const inertia = await row.locator('[data-label=Inertia] span').textContent();
  assertShown(inertia, { estimate, std_error: total_std_error });
  const quoted = result.fits[0].summary.parameters.find(({ name }) => name === 'inertia');
  assert.ok(inertia.startsWith(`${quoted.value} ± ${quoted.error}`), `${inertia} is not ${quoted.value} ± ${quoted.error}`);
  assert.match(await row.locator('th').textContent(), /^Heavy <bob>recorded\.csv$/);
  assert.equal(await row.locator('[data-label=Law]').textContent(), 'coulomb');
  const [from, to] = (await row.locator('[data-label=Window]').textContent()).match(/[\d.]+/g).map(Number);
  assert.deepEqual([from, to], result.recordings[0].window_s);
  await row.getByRole('link').click();
  await page.getByRole('heading', { name: 'Heavy <bob>', level: 1 }).waitFor();
  await rename(page, '');
  await page.getByRole('heading', { name: 'recorded.csv', level: 1 }).waitFor();
});

test('sliders change the simulated swing, and "Back to the fit" returns', async (t) => {
  const id = await service.fit('textbook_rig.csv', 'model=coulomb', 'textbook_rig.json');
  const page = await openView(t, service, `/fits/${id}`);
  await shownFit(page);
  const { fits, recordings } = await service.json(`/v1/fits/${id}`);
  const [{ parameters, statistics }] = fits;
  const count = Object.keys({ ...parameters, ...recordings[0].fits[0].parameters }).length;
  const rms = async () => Number(/^Rms residual (\S+)/.exec(await page.locator('.slider-rms').textContent())[1]);
  const ofFit = await rms();
  assert.ok(Math.abs(ofFit - kDegrees * statistics.rms_residual_rad) < 1e-3 * ofFit, String(ofFit));
  const slider = page.getByRole('slider', { name: /moment of inertia/ });
  assert.equal(await page.locator('.sliders input').count(), count);
  const before = await slider.getAttribute('aria-valuetext');
  assert.match(before, /^0\.0\d+\skg\sm²$/);
  assert.ok(Math.abs(Number.parseFloat(before) / parameters.inertia.estimate - 1) < 1e-3);
  await slider.focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction((old) => !document.querySelector('.slider-rms').textContent.startsWith(old), `Rms residual ${ofFit}\u00a0`);
  assert.notEqual(await slider.getAttribute('aria-valuetext'), before);
  assert.ok((await rms()) > ofFit); // the estimate has the least one
  await page.getByRole('button', { name: 'Back to the fit' }).click();
  await page.waitForFunction((old) => document.querySelector('.slider-rms').textContent.startsWith(old), `Rms residual ${ofFit}\u00a0`);
  assert.equal(await slider.getAttribute('aria-valuetext'), before);
});

test('a problem with the readings is shown beside the sliders, which stay usable', async (t) => {
  const id = await service.fit('textbook_rig.csv', 'model=coulomb', 'textbook_rig.json');
  const page = await openView(t, service, `/fits/${id}`, { refused: ['400 (Bad Request)'] });
  await shownFit(page);
  const detail = 'inertia is too small';
  const body = JSON.stringify({ title: 'The request is wrong', detail, status: 400, code: 'bad_request' });
  await page.route('**/readings', (route) => route.fulfill({ status: 400, contentType: 'application/problem+json', body }));
  const slider = page.getByRole('slider', { name: /moment of inertia/ });
  await slider.focus();
  await page.keyboard.press('ArrowRight');
  await page.getByText(detail).waitFor();
  assert.match(await page.locator('.slider-rms').textContent(), /^Rms residual –,/);
  await page.unroute('**/readings');
  await page.keyboard.press('ArrowRight');
  await page.getByText(detail).waitFor({ state: 'hidden' });
  assert.match(await page.locator('.slider-rms').textContent(), /^Rms residual \d/);
});

test('a drag zooms the plot of the window, and only its handles move the window', async (t) => {
  const page = await openView(t, service, `/fits/${await service.fit('coulomb.csv', 'model=coulomb')}`);
  await shownFit(page);
  const over = page.locator('#again .u-over');
  await over.scrollIntoViewIfNeeded();
  const field = (label) => page.getByLabel(label, { exact: true });
  const ends = async () => [Number(await field('From [s]').inputValue()), Number(await field('To [s]').inputValue())];
  const before = await ends();
  const handle = page.getByRole('slider', { name: 'End of the window' });
  const drag = async (from, to) => {
    const box = await over.boundingBox();
    const y = box.y + box.height / 4;
    await page.mouse.move(box.x + from * box.width, y);
    await page.mouse.down();
    await page.mouse.move(box.x + to * box.width, y, { steps: 5 });
    await page.mouse.up();
  };
  await drag(0.25, 0.75);
  assert.deepEqual(await ends(), before);
  assert.equal(await handle.count(), 0); // outside of what is shown
  await over.dblclick();
  await handle.waitFor();
  await handle.focus();
  await page.keyboard.press('Shift+ArrowLeft');
  const [from, to] = await ends();
  assert.equal(from, before[0]);
  assert.ok(Math.abs(before[1] - to - 2.04) < 0.02, String(to)); // a tenth of 20 s and margins
  await drag(0.25, 0.5);
  await page.getByRole('button', { name: 'Choose what is shown' }).click();
  const [begin, end] = await ends();
  assert.ok(Math.abs(begin - 5) < 0.3 && Math.abs(end - 10) < 0.3, `${begin} to ${end}`);
});

/** How many fits have ended without a result. */
async function stopped() {
  const answer = await fetch(`${service.url}/metrics`);
  const text = await answer.text();
  return Number(/^pendulum_fits_total\{kind="request",outcome="failed"\} (\d+)/m.exec(text)?.[1] ?? 0);
}

const eventually = async (isTrue) => {
  for (const end = Date.now() + 60_000; Date.now() < end; ) {
    if (await isTrue()) return true;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  return false;
};

test('a long fit shows its time, and Cancel ends it in the service', async (t) => {
  const id = await service.fit('recorded.csv', 'model=coulomb');
  const page = await openView(t, service, `/fits/${id}`);
  await shownFit(page);
  const before = await stopped();
  // a bootstrap of all models of this recording takes minutes
  const slow = (route) => {
    const url = new URL(route.request().url());
    url.searchParams.set('model', 'all');
    url.searchParams.set('interval', 'bootstrap');
    return route.continue({ url: url.href });
  };
  await page.route('**/refits?*', slow);
  await page.getByRole('button', { name: 'Fit this window' }).click();
  const busy = page.locator('.busy');
  await busy.waitFor();
  assert.match(await busy.textContent(), /^Fitting …\d+ sCancel$/);
  await busy.getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('Fitting: cancelled.').waitFor();
  assert.equal(await busy.count(), 0);
  assert.ok(await eventually(async () => (await stopped()) === before + 1));
  assert.equal(new URL(page.url()).pathname, `/fits/${id}`);
});

test('Cancel ends a batch and keeps what is fitted', async (t) => {
  const form = new FormData();
  for (let i = 0; i < 60; ++i) form.append('data', new Blob([readDataset('recorded.csv')]), `run_${i}.csv`);
  const answer = await fetch(`${service.url}/v1/batches?model=all`, { method: 'POST', body: form });
  const id = answer.headers.get('Location').split('/').pop();
  const page = await openView(t, service, `/batches/${id}`);
  await page.getByText(/^[1-9]\d* of 60 recordings fitted/).waitFor();
  await page.getByText(/ so far, about .* left\.$/).waitFor();
  await page.getByRole('button', { name: 'Cancel' }).click();
  assert.ok(await eventually(async () => (await service.json(`/v1/batches/${id}`)).state === 'done'));
  const { runs, done } = await service.json(`/v1/batches/${id}`);
  assert.ok(runs < 60 && done === runs && runs > 0, `${done} of ${runs}`);
  await page.getByText(`${runs} of ${runs} recording`).waitFor();
  assert.equal(await page.getByRole('button', { name: 'Cancel' }).count(), 0);
});
