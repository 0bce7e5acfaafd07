// SPDX-License-Identifier: Apache-2.0
/** Addresses of the views. */

export type Route =
  | { page: 'start' }
  | { page: 'fits' }
  | { page: 'fit'; id: string }
  | { page: 'compare'; ids: string[] }
  | { page: 'calibration' }
  | { page: 'live' }
  | { page: 'batch'; id: string }
  | { page: 'missing' };

export const kMostCompared = 12;

function decoded(part: string): string | null {
  try {
    return decodeURIComponent(part);
  } catch {
    return null;
  }
}

const kPlain = ['fits', 'calibration', 'live'] as const;

/** The view of an address. A slash at its end is ignored. */
export function parseRoute(path: string, query = ''): Route {
  const parts = path.replace(/\/+$/, '').split('/').slice(1);
  if (parts.length === 0) return { page: 'start' };
  const [first, second] = parts;
  if (parts.length === 1) {
    const plain = kPlain.find((name) => name === first);
    if (plain) return { page: plain };
    if (first === 'compare') return { page: 'compare', ids: comparedIds(new URLSearchParams(query).get('ids')) };
  }
  const id = parts.length === 2 ? decoded(second) : null;
  if (id && first === 'fits') return { page: 'fit', id };
  if (id && first === 'batches') return { page: 'batch', id };
  return { page: 'missing' };
}

/** ["a", "b"] for "a,b,a". */
export function comparedIds(list: string | null): string[] {
  const ids = (list ?? '').split(',').map((id) => id.trim());
  return [...new Set(ids.filter((id) => id !== ''))].slice(0, kMostCompared);
}

export const fitPath = (id: string): string => `/fits/${encodeURIComponent(id)}`;
export const batchPath = (id: string): string => `/batches/${encodeURIComponent(id)}`;
export const comparePath = (ids: readonly string[]): string => `/compare?ids=${ids.map(encodeURIComponent).join(',')}`;

/** Address of a part of a fit in the service, "/v1/fits/…/series". */
export const fitApi = (id: string, part = ''): string => `/v1/fits/${encodeURIComponent(id)}${part && `/${part}`}`;

/** The id at the end of a Location header; null if there is none. */
export function idOfLocation(location: string | null): string | null {
  const last = location?.split(/[?#]/)[0].split('/').pop();
  return last ? decoded(last) : null;
}
