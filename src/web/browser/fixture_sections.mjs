// SPDX-License-Identifier: Apache-2.0
// A few sections for the made-up results of the tests: one of each kind of block. Those of the program are in
// sections_test.mjs.

const words = (text, emphasis = 'none') => ({ kind: 'words', text, emphasis });
const facts = (rows) => ({ kind: 'facts', rows: Object.entries(rows).map(([name, text]) => ({ name, text, emphasis: 'none' })) });

/** Columns as "name", "+value" for numbers and "&± error" for a column that joins the one before. */
const table = (columns, rows, more = {}) => ({
  kind: 'table',
  columns: columns.map((head) => ({ header: head.replace(/^[+&]/, ''), is_number: head.startsWith('+'), joins: head.startsWith('&') })),
  rows,
  caution: null,
  rows_before: 0,
  left_out: null,
  ...more,
});

const kValue = ['+value', '&± std error', 'unit'];

const parametersOf = (several) => [
  table(['name', ...kValue, '95 % interval'], [
    ['inertia', '0.07900', '± 0.00004', 'kg m^2', '[0.0789942, 0.0790051]'],
    ...(several ? [] : [['release_angle', '0.40000', '± 0.00020', 'rad', '[0.39961, 0.40039]'], ['', '22.918', '± 0.011', 'deg', '']]),
  ]),
  table(['name', 'symbol', '± systematic'], [['inertia', 'I_O', '± 4.1e-05']]),
  words("standard errors: covariance sigma^2 (J'J)^-1; viscous: held by --fix."),
];

const ofOne = (number) => [
  ['noise-and-statistics', 'Noise and statistics', [facts({ 'rms residual': `0.00${2 + number} rad`, 'lag-1 correlation': '-0.03' })]],
  ['constancy', 'Constancy', [words('inertia and friction are constants of the recording.')]],
  ['closed-forms-against-the-fit', 'Closed forms against the fit', [
    table(['quantity', '+formula', '&± error', '+z', 'agrees'], [['inertia_small_angle', '0.0798', '± 0.00004', '19.1', 'NO'], ['inertia_geometry', '0.0761', '', '-', '-']], { caution: 'NO' }),
    words('inertia_small_angle: differs by +0.00084 kg m^2.'),
  ]],
];

const aboutLaw = (several) => [
  ['parameters', 'Parameters', parametersOf(several)],
  ['correlations', 'Correlations', [table(['', '+'], [['viscous, coulomb', '-0.995']])], 'those below 0.1 in size are not listed'],
  ['equation-of-motion', 'Equation of motion', [{ kind: 'formula', text: "0.07900 th'' + 0.00300 th' - 1.803 sin th = 0" }]],
  ['fit', 'Fit', [facts({ status: 'converged: the estimates are within 0.1 standard errors of the minimum' })]],
];

const joint = (homogeneity) => [
  ['do-the-recordings-agree', 'Do the recordings agree?', [
    words(`Verdict: ${homogeneity.verdict}.`, homogeneity.agrees === false ? 'alarm' : 'none'),
    ...Object.entries(homogeneity.parameters).map(([name, { unit, recordings: runs }]) =>
      table([`${name} [${unit}]`, '+', '&', '+z', ''], runs.map(({ z }, k) => [`${k + 1} separate`, '0.079', '± 0.001', z === null ? '' : z.toFixed(1), ' --*--'])),
    ),
  ]],
];

/** Sections of a result of the fixtures. */
export function sectionsOf({ recordings, fits, comparison }) {
  const several = recordings.length > 1;
  const made = ([id, title, blocks, remark = null], law = null, recording = null) => ({ id, title, law, recording, remark, blocks });
  const each = recordings.map(({ path }, k) => ({ path, number: k + 1, of: several ? k + 1 : null }));
  const rows = each.map(({ path, number }) => [String(number), path.split('/').pop(), '2000 of 2000']);
  return [
    ...(several ? [made(['recordings', 'Recordings', [table(['', 'file', '+samples'], rows)]])] : []),
    ...each.map(({ path, of }) => made(['data', 'Data', [facts({ file: path, window: '0 s to 19.99 s' })]], null, of)),
    ...(comparison ? [made(['comparison', 'Comparison', [table(['model', '+ΔBIC', ''], fits.map(({ model }) => [model, '1.9', model === 'viscous' ? 'lack of fit' : '']), { caution: 'lack of fit' })]])] : []),
    ...fits.flatMap(({ model, status, homogeneity }) => [
      ...(homogeneity ? joint(homogeneity).map((one) => made(one, model)) : []),
      ...(status === 'failed' ? [] : aboutLaw(several).map((one) => made(one, model))),
      ...(status === 'failed' ? [] : each.flatMap(({ number, of }) => ofOne(number).map((one) => made(one, model, of)))),
    ]),
    ...each.map(({ of }) =>
      made(['turning-points', 'Turning points', [table(['+number', '+t [s]'], [['1', '1.8'], ['20', '19.7']], { rows_before: 1, left_out: '... 18 more turning points' })]], null, of),
    ),
    made(['warnings', 'Warnings', [{ kind: 'items', texts: ['viscous: 1e-05 of it'], emphasis: 'caution' }]]),
    made(['of-a-new-kind', 'Of a new kind', [words('still shown.')]]),
  ];
}
