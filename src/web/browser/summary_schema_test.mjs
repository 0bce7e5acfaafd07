// SPDX-License-Identifier: Apache-2.0
// Summaries of refit_pendulums match summary.schema.json.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { makeSummary, summaries } from './batches.mjs';

const schema = fileURLToPath(new URL('../../../include/pendulum/report/summary.schema.json', import.meta.url));
const script = `
import json, sys, jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
for error in jsonschema.Draft202012Validator(schema).iter_errors(json.load(sys.stdin)):
    print(error.json_path, error.message[:200])
`;

/** Violations of the schema in a summary. */
function complaints(summary) {
  const { status, stdout, stderr } = spawnSync('python3', ['-c', script, schema], {
    input: JSON.stringify(summary),
    encoding: 'utf8',
  });
  assert.equal(status, 0, stderr);
  return stdout;
}

for (const [name, make] of Object.entries(summaries)) {
  test(`${name} is valid`, () => {
    const { summary } = make();
    // The parameters of the large summary are alike, and the validator is slow, so the first ones are enough.
    assert.equal(complaints({ ...summary, parameters: summary.parameters.slice(0, 7) }), '');
  });
}

test('a summary that the page could not show is invalid', () => {
  assert.match(complaints({ ...makeSummary().summary, schema_version: 1 }), /schema_version/);
  const unreasoned = makeSummary().summary;
  Object.assign(unreasoned.parameters[0], { repeatability: null, repeatability_reason: null });
  assert.match(complaints(unreasoned), /repeatability_reason/);
});
