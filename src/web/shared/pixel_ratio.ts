// SPDX-License-Identifier: Apache-2.0
/** Draws plots with at least two dots per pixel, so that they are sharp when printed. Must be imported before uPlot. */

if (typeof window !== 'undefined') {
  const own = window.devicePixelRatio;
  Object.defineProperty(window, 'devicePixelRatio', { configurable: true, value: Math.max(2, own) });
}

export {};
