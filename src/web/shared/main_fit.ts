// SPDX-License-Identifier: Apache-2.0

/**
 * The fit that stands for all laws of a recording: the recommended one, else the one with the smallest residuals among
 * those that converged, else among all; null without a fit. A fit without residuals has failed.
 */
export function mainFit<F extends { model: string; status: string }>(
  fits: F[],
  recommended: string | null | undefined,
  rmsOf: (fit: F) => number | null | undefined,
): F | null {
  const found = fits.find((fit) => fit.model === recommended);
  if (found) return found;
  const converged = fits.filter((fit) => fit.status === 'converged');
  let best: F | null = null;
  for (const fit of converged.length > 0 ? converged : fits) {
    if (best === null || (rmsOf(fit) ?? Infinity) < (rmsOf(best) ?? Infinity)) best = fit;
  }
  return best;
}
