// SPDX-License-Identifier: Apache-2.0
/** Saves pictures of plots as files. */

import { button, el } from './dom';
import { svg } from './marks';
import { kPlotFont } from './painter';
import { colour } from './theme';

/** Lets the browser save the content under this name. */
export function save(content: Blob, name: string): void {
  const href = URL.createObjectURL(content);
  const anchor = el('a', { href, download: name, hidden: '' });
  document.body.append(anchor);
  anchor.click();
  anchor.remove();
  setTimeout(() => URL.revokeObjectURL(href), 60_000);
}

/** The heading of the page with only characters that a file name may have, and the name of the plot. */
function fileName(plot: string, ending: string): string {
  const heading = document.querySelector('h1')?.textContent ?? '';
  const stem = heading.replace(/\.[A-Za-z0-9]{1,5}$/, '').replace(/[^\p{L}\p{N}]+/gu, '_').slice(0, 60);
  return `${stem.replace(/^_+|_+$/g, '') || 'pendulum'}_${plot}.${ending}`;
}

/** Saves the canvas on a background. */
async function saveCanvas(canvas: HTMLCanvasElement, plot: string): Promise<void> {
  const copy = el('canvas', { width: String(canvas.width), height: String(canvas.height) });
  const ctx = copy.getContext('2d');
  if (!ctx) throw new Error('the browser gives no canvas');
  ctx.fillStyle = colour('paper');
  ctx.fillRect(0, 0, copy.width, copy.height);
  ctx.drawImage(canvas, 0, 0);
  const content = await new Promise<Blob | null>((resolve) => copy.toBlob(resolve));
  if (!content) throw new Error('the plot is too large');
  save(content, fileName(plot, 'png'));
}

const asSvg = (text: string): Blob => new Blob([text], { type: 'image/svg+xml' });

const kDots = 2; // a px of a PNG that is made from SVG

/** The drawing as a canvas. */
async function rasterized(svgText: string): Promise<HTMLCanvasElement> {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText)}`;
  await image.decode();
  const [width, height] = [kDots * image.naturalWidth, kDots * image.naturalHeight];
  const canvas = el('canvas', { width: String(width), height: String(height) });
  canvas.getContext('2d')?.drawImage(image, 0, 0, width, height);
  return canvas;
}

/** Small buttons that save a plot. `svgText` draws it; `canvas` has it already, if it was drawn on a canvas. */
export function saveButtons(plot: string, svgText: () => string, canvas?: () => HTMLCanvasElement | null): HTMLElement {
  const png = async (): Promise<void> => {
    const drawn = canvas ? canvas() : await rasterized(svgText());
    if (drawn) await saveCanvas(drawn, plot);
  };
  const failure = el('span', { role: 'alert' });
  const savePng = (): void => {
    failure.textContent = '';
    png().catch((error: unknown) => {
      failure.textContent = `The PNG picture could not be made (${String(error)}). Save the plot as SVG.`;
    });
  };
  const words = plot.replace(/_/g, ' ');
  return el(
    'div',
    { class: 'save' },
    button('PNG', savePng, { 'aria-label': `Save the plot ${words} as PNG`, title: 'Save this plot as a PNG picture' }),
    button('SVG', () => save(asSvg(svgText()), fileName(plot, 'svg')), {
      'aria-label': `Save the plot ${words} as SVG`,
      title: 'Save this plot as an SVG drawing',
    }),
    failure,
  );
}

/** Replaces the variables of the style sheet in the attributes of an SVG element by their colours. */
function withColours(picture: SVGElement): SVGElement {
  for (const element of [picture, ...picture.querySelectorAll('*')]) {
    for (const { name, value } of [...element.attributes]) {
      const variable = /^var\(--(.+)\)$/.exec(value);
      if (variable) element.setAttribute(name, colour(variable[1]));
    }
  }
  return picture;
}

/** A drawing of the page as a file, with labels to the left of it. labels: text and height of the middle, px. */
export function standalone(picture: SVGElement, sentence: string, labels: [string, number][]): string {
  const kCharacter = 7; // px
  const box = picture.getBoundingClientRect();
  const left = 16 + kCharacter * Math.max(0, ...labels.map(([words]) => words.length));
  const size = { width: String(Math.ceil(left + box.width + 24)), height: String(Math.ceil(box.height + 8)) };
  const style = { xmlns: 'http://www.w3.org/2000/svg', 'font-family': kPlotFont, 'font-size': '12' };
  const file = svg('svg', { ...style, ...size, viewBox: `0 0 ${size.width} ${size.height}` });
  const title = svg('title', {});
  title.textContent = sentence;
  file.append(title, svg('rect', { width: '100%', height: '100%', fill: colour('paper') }));
  for (const [words, y] of labels) {
    const text = svg('text', { x: '8', y: String(y + 8), fill: colour('ink') });
    text.textContent = words;
    file.append(text);
  }
  const inner = withColours(picture.cloneNode(true) as SVGElement);
  for (const [name, value] of [['x', left], ['y', 4], ['width', box.width]] as const) inner.setAttribute(name, String(value));
  file.append(inner);
  return `${new XMLSerializer().serializeToString(file)}\n`;
}
