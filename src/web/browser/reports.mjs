// SPDX-License-Identifier: Apache-2.0
// What the pages that fit_pendulum writes contain: names, result, sections, series and command.

import { dataset, datasets, embedded, fit, once } from './tool.mjs';

const rig = ['--rig', dataset('textbook_rig.json')];
const reportOf = (name, ...flags) => once(() => embedded(fit(name, ...flags).url));

/** Three laws of one recording of 20 s at 100 Hz. */
export const makeReport = reportOf('one', '--data', dataset('coulomb.csv'), ...rig, '--model', 'viscous,coulomb,drag', '--interval', 'profile');

/** A rig whose standard deviations are larger than the noise, a calibration, and one fixed parameter. */
export const makeRecorded = reportOf('recorded', dataset('recorded.csv'), '--rig', dataset('recorded_rig.json'), '--fix', 'zero_angle=0');

/** A fit without a result. */
export const makeFailed = reportOf('failed', '--data', dataset('coulomb.csv'), ...rig, '--fix', 'inertia=10');

const runs = (...numbers) => numbers.map((k) => dataset(`runs_${k}.csv`)).join(',');
const joint = ['--interval', 'covariance', '--model', 'viscous,coulomb,drag'];

/** Three recordings of one rig. */
export const makeJoint = reportOf('joint', '--data', runs(1, 2, 3), ...joint);

/** The last recording is of another rig. */
export const makeOdd = reportOf('odd', '--data', runs(1, 2, 3, 4), ...joint);

/** A joint fit without a result. */
export const makeJointFailed = reportOf('joint_failed', '--data', runs(1, 2, 3), '--fix', 'inertia=10');

/** A report of files in a folder whose path is wider than a phone and has no place to break a line. */
export const withLongPaths = (content) =>
  JSON.parse(JSON.stringify(content).replaceAll(datasets, '/srv/modelling_laboratory/winter_term_2026/thursday_group_12/pendulum/'));
