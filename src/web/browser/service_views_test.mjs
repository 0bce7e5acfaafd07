// SPDX-License-Identifier: Apache-2.0
// All views of the service's page: accessibility, narrow windows, errors in the console; lists, comparisons, batches, calibration.

import assert from 'node:assert/strict';
import fs from 'node:fs';
import { before, test } from 'node:test';

import { assertAccessible, ink, kLooks } from './page.mjs';
import { assertShown, drop, openView, readDataset, shownFit, startService } from './service_server.mjs';

let service;
let one;
let other;
let batch;
before(async () => {
  service = await startService();
  one = await service.fit('coulomb.csv', 'model=viscous,coulomb,drag', 'textbook_rig.json');
  other = await service.fit('textbook_rig.csv', 'model=viscous,coulomb', 'textbook_rig.json');
  const form = new FormData();
  for (const k of [1, 2, 3]) form.append('data', new Blob([readDataset(`runs_${k}.csv`)]), `runs_${k}.csv`);
  form.append('data', new Blob(['no numbers at all\n']), 'letter.txt');
  const answer = await fetch(`${service.url}/v1/batches?model=coulomb`, { method: 'POST', body: form });
  assert.equal(answer.status, 202);
  batch = answer.headers.get('Location').split('/').pop();
});

const kTable = readDataset('textbook_calibration.csv');

async function calibrate(page) {
  await page.getByLabel('Reading, row 1', { exact: true }).evaluate((input, table) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData('text', table.replace(/,/g, '\t'));
    input.dispatchEvent(new ClipboardEvent('paste', { clipboardData, bubbles: true, cancelable: true }));
  }, kTable);
  await page.getByRole('button', { name: 'Calibrate' }).click();
  await page.waitForSelector('#outcome');
}

const open = async (page, ...summaries) => {
  for (const summary of summaries) await page.locator('summary', { hasText: summary }).click();
};

/** Name, address, and actions before the view is tested. */
const views = () => [
  [
    'start',
    '/',
    (page) =>
      page
        .getByRole('button', { name: /^Try it/ })
        .first()
        .waitFor(),
  ],
  [
    'start with all of its choices',
    '/',
    async (page) => {
      await page
        .getByRole('button', { name: /^Try it/ })
        .first()
        .waitFor();
      await open(page, 'Or paste numbers', 'Further options');
      await page.locator('.choice label', { hasText: 'masses and length' }).click();
      await page.locator('.choice label', { hasText: 'I choose' }).click();
    },
  ],
  [
    'a problem',
    '/',
    async (page) => {
      await drop(page, [{ name: 'letter.pdf', content: '%PDF-1.4\n' }]);
      await page.locator('.problem').waitFor();
    },
  ],
  [
    'a fit',
    `/fits/${one}`,
    async (page) => {
      await page.waitForSelector('#verdict');
      await open(page, 'Another kind of friction', 'Another description', 'Download');
    },
  ],
  ['past fits', '/fits', (page) => page.locator('.runs tbody tr').first().waitFor()],
  ['a comparison', `/compare?ids=${one},${other}`, (page) => page.waitForSelector('#parameters')],
  ['calibration', '/calibration', calibrate],
  ['live, without --live', '/live', (page) => page.getByText('was started without --live').waitFor()],
  [
    'a batch',
    `/batches/${batch}`,
    (page) => page.getByText('3 of 4 recordings fitted, 1 could not be fitted.').waitFor(),
  ],
  ['a fit that is not there', '/fits/nothing', (page) => page.locator('.problem').waitFor()],
];

for (const [colorScheme, device, width] of kLooks) {
  const touch = device === 'phone' ? { hasTouch: true, isMobile: true } : {};
  const context = { colorScheme, viewport: { width, height: 740 }, ...touch };
  test(`${colorScheme}, ${device}: each view is accessible and not wider than the window`, async (t) => {
    for (const [name, address, act] of views()) {
      await t.test(name, async (part) => {
        const refused = ['status of 404', 'status of 422']; // expected in two of the views
        const page = await openView(part, service, address, { context, refused });
        await act(page);
        assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), colorScheme);
        await assertAccessible(page);
        if (device === 'phone') await assertTouchable(page);
        if (process.env.SHOTS)
          await page.screenshot({
            path: `${process.env.SHOTS}/${name}, ${device}, ${colorScheme}.png`,
            fullPage: true,
          });
      });
    }
  });
}

/** Buttons, fields and links outside of text are at least 40 px high (WCAG 2.5.8 requires 24). */
async function assertTouchable(page) {
  const low = await page.locator('button, summary, select, input, .site a, .check, .box').evaluateAll((all) =>
    all.flatMap((element) => {
      const { width, height } = element.getBoundingClientRect();
      const within = element.closest('.check, .box, .choice') && element.matches('input');
      return width === 0 || height >= 40 || within
        ? []
        : [`${element.tagName} ${element.className} ${element.textContent}: ${height}`];
    }),
  );
  assert.deepEqual(low, []);
}

test('the page has no script and no style of its own, and the service allows none', async () => {
  const answer = await fetch(`${service.url}/`);
  const policy = answer.headers.get('Content-Security-Policy');
  for (const rule of [
    "default-src 'none'",
    "script-src 'self'",
    "style-src 'self'",
    "connect-src 'self'",
    "frame-ancestors 'none'",
  ])
    assert.ok(policy.includes(rule), policy);
  assert.doesNotMatch(policy, /unsafe/);
  const html = await answer.text();
  assert.doesNotMatch(html, /<style|style=|<script(?! type="application\/json"|[^>]* src="\/app\.js")/);
});

test('past fits are filtered, chosen and compared', async (t) => {
  const page = await openView(t, service, '/fits');
  const rows = page.locator('.runs tbody tr');
  await page.getByLabel('Name contains').fill('textbook');
  await page.getByText('One fit shown.').waitFor();
  assert.match(await rows.first().textContent(), /textbook_rig\.csv.*viscous.*converged/);
  const { fits } = await service.json('/v1/fits?name=textbook');
  const { inertia } = fits[0].models.find((model) => model.model === fits[0].recommended).parameters;
  const { estimate, total_std_error: std_error } = inertia;
  assertShown(await rows.first().locator('[data-label=Inertia] span').textContent(), { estimate, std_error });
  await page.getByRole('checkbox', { name: 'Select textbook_rig.csv' }).check();
  await page.getByLabel('Name contains').fill('');
  await page.getByRole('checkbox', { name: 'Select coulomb.csv' }).check();
  await page.getByRole('button', { name: 'Compare', exact: true }).click();
  await page.waitForURL('**/compare?ids=*');
  assert.deepEqual(new URL(page.url()).searchParams.get('ids').split(','), [other, one]);
  await page.waitForSelector('#parameters');
});

test('a comparison has differences in combined standard errors, error bars and curves', async (t) => {
  const page = await openView(t, service, `/compare?ids=${one},${other}`);
  await page.waitForSelector('#parameters');
  const [a, b] = await Promise.all(
    [
      [one, 'coulomb'],
      [other, 'viscous'],
    ].map(
      async ([id, model]) => (await service.json(`/v1/fits/${id}`)).fits.find((fit) => fit.model === model).parameters,
    ),
  );
  const cells = page.locator('#parameters tr', { hasText: 'viscous friction' }).locator('td');
  assertShown(await cells.nth(0).textContent(), a.viscous);
  assertShown(await cells.nth(1).textContent(), b.viscous);
  const sigmas = (b.viscous.estimate - a.viscous.estimate) / Math.hypot(a.viscous.std_error, b.viscous.std_error);
  const shown = /([+−][\d.]+) σ/.exec(await cells.nth(1).textContent())[1].replace('−', '-');
  assert.ok(Math.abs(Number(shown) - sigmas) < 0.06, `${shown} is not ${sigmas}`);
  assert.match(
    await page.locator('#bars [role=img]').first().getAttribute('aria-label'),
    /moment of inertia.*1 coulomb\.csv .* and 2 textbook_rig\.csv/,
  );
  assert.ok((await ink(page, '#overlay .plot >> nth=0')) > 3000);
  await page.locator('.choice label', { hasText: 'viscous' }).click();
  await page.locator('#fits tbody tr', { hasText: 'coulomb.csv' }).filter({ hasText: 'viscous' }).waitFor();
});

test('a calibration equals the published one, can be downloaded, and is used for the next fit', async (t) => {
  const page = await openView(t, service, '/calibration');
  await calibrate(page);
  const { coefficients } = JSON.parse(readDataset('potentiometer_calibration.json')); // the textbook's line
  const told = await page.locator('#outcome .equation').textContent();
  const [constant, slope] = /angle = (\S+) \+ (\S+) x, in degrees, x in counts/
    .exec(told)
    .slice(1)
    .map((word) => Number(word.replace('−', '-')));
  assert.ok(Math.abs(constant - coefficients[0]) < 5.1e-5 && Math.abs(slope - coefficients[1]) < 5.1e-5, told); // 4 decimals
  for (const plot of [0, 1]) assert.ok((await ink(page, `#outcome .plot >> nth=${plot}`)) > 1000);
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Download cal.json' }).click(),
  ]);
  assert.equal(download.suggestedFilename(), 'cal.json');
  const saved = JSON.parse(fs.readFileSync(await download.path(), 'utf8'));
  const csv = { method: 'POST', headers: { 'Content-Type': 'text/csv' }, body: kTable };
  assert.deepEqual(saved, (await service.json('/v1/calibrations?order=1', csv)).calibration);
  await page.getByRole('button', { name: 'Use it for the next fit' }).click();
  await page.getByText('In use: the calibration just made.').waitFor();
  const degrees = readDataset('coulomb.csv')
    .split('\n')
    .filter((line) => /^\d/.test(line));
  const counts = degrees
    .map((line) => line.split(',').map(Number))
    .map(([time, angle]) => `${time},${Math.round((angle + 49.6077) / 0.198544)}`);
  await drop(page, [{ name: 'counts.csv', content: ['time_s,counts', ...counts, ''].join('\n') }]);
  const { calibration } = await service.json(`/v1/fits/${await shownFit(page)}/request`);
  assert.deepEqual(calibration, saved);
});

test('rows of a calibration are added, removed and checked', async (t) => {
  const page = await openView(t, service, '/calibration');
  const rows = page.locator('.entry tbody tr');
  const first = await rows.count();
  await page.getByRole('button', { name: 'Add a row' }).click();
  assert.equal(await rows.count(), first + 1);
  assert.ok(await page.getByLabel(`Reading, row ${first + 1}`).evaluate((input) => input === document.activeElement));
  await page.getByRole('button', { name: 'Remove row 2' }).click();
  assert.equal(await rows.count(), first);
  await page.getByLabel('Reading, row 1', { exact: true }).fill('19');
  await page.getByRole('button', { name: 'Calibrate' }).click();
  await page.locator('.problem').waitFor();
  assert.match(await page.locator('.problem .detail').textContent(), /Angle, row 1, is missing/);
});

test('several recordings are fitted with visible progress, and each failed one gives its reason', async (t) => {
  const page = await openView(t, service, '/', { refused: ['status of 422'] });
  const files = Array.from({ length: 12 }, (_unused, i) => ({
    name: `run_${i}.csv`,
    content: readDataset(`runs_${(i % 4) + 1}.csv`),
  }));
  files.splice(5, 0, { name: 'letter.txt', content: 'no numbers at all\n' });
  await page.evaluate(() => {
    window.told = [];
    const look = () => {
      const words = document.querySelector('main > [role=status]')?.textContent ?? '';
      const done = /^(\d+) of 13/.exec(words)?.[1];
      const filled = [...document.querySelectorAll('.runs tbody [data-label=Inertia]')].filter((cell) =>
        /±/.test(cell.textContent),
      ).length;
      if (done !== undefined) window.told.push([Number(done), filled]);
    };
    new MutationObserver(look).observe(document.body, { childList: true, subtree: true, characterData: true });
  });
  await drop(page, files);
  await page.waitForURL('**/batches/*');
  await page.getByText('12 of 13 recordings fitted, 1 could not be fitted.').waitFor();
  await page.waitForFunction(
    () =>
      [...document.querySelectorAll('.runs tbody [data-label=Inertia]')].filter((cell) => /±/.test(cell.textContent))
        .length === 12,
  );
  const told = await page.evaluate(() => window.told);
  assert.ok(
    told.every(([done], i) => i === 0 || done >= told[i - 1][0]),
    JSON.stringify(told),
  );
  assert.ok(
    told.some(([done]) => done > 0 && done < 12),
    JSON.stringify(told),
  );
  const id = new URL(page.url()).pathname.split('/').pop();
  await page.locator('.batch-agreement').waitFor();
  // runs_4.csv, sent as run_3, run_7 and run_11, is of an inertia that is 3 % larger.
  assert.match(await page.locator('.batch-agreement .banner.caution').textContent(), /3 recordings disagree with the others .*run_3\.csv .*: 3 % more/);
  const odd = page.locator('.runs tbody tr', { hasText: 'disagrees with the others' });
  assert.deepEqual(await odd.locator('th bdi').allTextContents(), ['run_3.csv', 'run_7.csv', 'run_11.csv']);
  const [inertia] = (await service.json(`/v1/batches/${id}/agreement`)).means;
  assert.equal(inertia.recordings, 9);
  const mean = await page.locator('.batch-agreement tbody tr').first().textContent();
  assert.ok(mean.includes(inertia.text), mean);
  const { fits } = await service.json(`/v1/batches/${id}`);
  const rows = page.locator('.runs tbody tr');
  assert.deepEqual(
    await rows.locator('th bdi').allTextContents(),
    files.map((file) => file.name),
  );
  const letter = fits.find((fit) => fit.name === 'letter.txt');
  const reason = letter.reason
    .replaceAll('--time_column', '“Column of times”')
    .replaceAll('--value_column', '“Column of the angle”')
    .replaceAll('--unit', '“Unit of the values”')
    .replaceAll('--sample_rate_hz', '“Samples per second”');
  assert.doesNotMatch(reason, /--/);
  assert.ok((await rows.nth(5).textContent()).includes(reason));
  assert.deepEqual(await page.locator('.failed li').allTextContents(), [`letter.txt: ${reason}`]);
  assert.equal(await page.locator('.failed a').getAttribute('href'), `/fits/${letter.id}`);
  assert.match(await page.locator('main > .quiet').first().textContent(), /^Sent \d{4}-\d\d-\d\d \d\d:\d\d, your local time\.$/);
  const { fits: items } = await service.json(`/v1/fits?batch=${id}`);
  const { parameters } = items
    .find((item) => item.name === 'run_3.csv')
    .models.find((model) => model.model === 'coulomb');
  await rows.nth(4).getByRole('link', { name: 'run_4.csv' }).waitFor();
  assertShown(await rows.nth(3).locator('[data-label=Dry] span').textContent(), parameters.coulomb);
  await rows.nth(5).getByRole('link', { name: 'letter.txt' }).click();
  await page.locator('.problem').waitFor();
  assert.equal(await page.locator('.problem .detail').textContent(), reason);
});
