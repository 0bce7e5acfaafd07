// SPDX-License-Identifier: Apache-2.0
/** Saves pictures of plots as files. */

import { button, el } from './dom';
import { svg } from './marks';
import { kPlotFont } from './painter';
import { colour, onWhite } from './theme';

/** Lets the browser save the content under this name. */
export function save(content: Blob, name: string): void {
  const href = URL.createObjectURL(content);
  const anchor = el('a', { href, download: name, hidden: '' });
  document.body.append(anchor);
  anchor.click();
  anchor.remove();
  setTimeout(() => URL.revokeObjectURL(href), 60_000);
}

const heading = (): string => document.querySelector('h1')?.textContent?.trim() ?? '';

/** The heading of the page with only characters that a file name may have, and the name of the plot. */
function fileName(plot: string, ending: string): string {
  const stem = heading().replace(/\.[A-Za-z0-9]{1,5}$/, '').replace(/[^\p{L}\p{N}]+/gu, '_').slice(0, 60);
  return `${stem.replace(/^_+|_+$/g, '') || 'pendulum'}_${plot}.${ending}`;
}

const asSvg = (text: string): Blob => new Blob([text], { type: 'image/svg+xml' });

const kDots = 2; // a px of a PNG

/** The drawing as PNG. */
async function rasterized(svgText: string): Promise<Blob> {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText)}`;
  await image.decode();
  const [width, height] = [kDots * image.naturalWidth, kDots * image.naturalHeight];
  const canvas = el('canvas', { width: String(width), height: String(height) });
  canvas.getContext('2d')?.drawImage(image, 0, 0, width, height);
  const content = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve));
  if (!content) throw new Error('the plot is too large');
  return content;
}

/** Small buttons that save a plot. `svgText` draws it under a title. */
export function saveButtons(plot: string, svgText: (title: string) => string): HTMLElement {
  const words = plot.replace(/_/g, ' ');
  const drawn = (): string => onWhite(() => svgText([heading(), words].filter((part) => part !== '').join(': ')));
  const failure = el('span', { role: 'alert' });
  const savePng = (): void => {
    failure.textContent = '';
    rasterized(drawn()).then(
      (content) => save(content, fileName(plot, 'png')),
      (error: unknown) => {
        failure.textContent = `The PNG picture could not be made (${String(error)}). Save the plot as SVG.`;
      },
    );
  };
  return el(
    'div',
    { class: 'save' },
    button('PNG', savePng, { 'aria-label': `Save the plot ${words} as PNG`, title: 'Save this plot as a PNG picture' }),
    button('SVG', () => save(asSvg(drawn()), fileName(plot, 'svg')), {
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
export function standalone(picture: SVGElement, title: string, sentence: string, labels: [string, number][]): string {
  const kCharacter = 7; // px
  const kTitle = 26;
  const box = picture.getBoundingClientRect();
  const left = 16 + kCharacter * Math.max(0, ...labels.map(([words]) => words.length));
  const size = { width: String(Math.ceil(left + box.width + 24)), height: String(Math.ceil(kTitle + box.height + 8)) };
  const style = { xmlns: 'http://www.w3.org/2000/svg', 'font-family': kPlotFont, 'font-size': '12' };
  const file = svg('svg', { ...style, ...size, viewBox: `0 0 ${size.width} ${size.height}` });
  const description = svg('title', {});
  description.textContent = sentence;
  file.append(description, svg('rect', { width: '100%', height: '100%', fill: colour('paper') }));
  const write = (words: string, y: number): void => {
    const text = svg('text', { x: '8', y: String(y), fill: colour('ink') });
    text.textContent = words;
    file.append(text);
  };
  write(title, 18);
  for (const [words, y] of labels) write(words, kTitle + y + 8);
  const inner = withColours(picture.cloneNode(true) as SVGElement);
  for (const [name, value] of [['x', left], ['y', kTitle + 4], ['width', box.width]] as const) inner.setAttribute(name, String(value));
  file.append(inner);
  return `${new XMLSerializer().serializeToString(file)}\n`;
}
