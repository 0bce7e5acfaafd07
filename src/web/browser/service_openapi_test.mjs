// SPDX-License-Identifier: Apache-2.0
// The OpenAPI document that the service returns.

import assert from 'node:assert/strict';
import { before, test } from 'node:test';

import SwaggerParser from '@apidevtools/swagger-parser';

import { startService } from './service_server.mjs';

let service;
before(async () => (service = await startService()));

/** The document with all references resolved. Throws if it is invalid or a reference is broken. */
async function validated(change = () => {}) {
  const document = await service.json('/openapi.json');
  change(document);
  return SwaggerParser.validate(document);
}

test('the document is valid OpenAPI 3.1, and the schema of results is in it', async () => {
  const { openapi, paths } = await validated();
  assert.match(openapi, /^3\.1\./);
  const { schema } = paths['/v1/fits'].post.responses[200].content['application/json'];
  assert.equal(schema.properties.rig.oneOf[1].properties.bob_mass.oneOf[0].type, 'number');
});

test('an invalid OpenAPI document is refused', async () => {
  await assert.rejects(
    validated(({ info }) => delete info.title),
    /title/,
  );
  await assert.rejects(
    validated(({ components }) => (components.schemas.Result = { $ref: '#/$defs/result' })),
    /\$defs/,
  );
  await assert.rejects(
    validated(({ paths }) => (paths['/v1/fits'].post.responses[200].description = 3)),
    /description/,
  );
});
