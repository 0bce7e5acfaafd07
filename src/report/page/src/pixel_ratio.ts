// SPDX-License-Identifier: Apache-2.0
/** Plots are drawn at no less than two dots a pixel, so that they are sharp on paper too. Imported before uPlot. */

if (typeof window !== 'undefined') {
  const own = window.devicePixelRatio;
  Object.defineProperty(window, 'devicePixelRatio', { configurable: true, value: Math.max(2, own) });
}

export {};
