// SPDX-License-Identifier: Apache-2.0
/** A context like that of a canvas which writes SVG, so that the same Painter draws both. */

import type { Context } from './painter';

const kAnchors: Partial<Record<CanvasTextAlign, string>> = { center: 'middle', right: 'end' };
const kEntities: Record<string, string> = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' };

const escaped = (words: string): string => words.replace(/[&<>"]/g, (c) => kEntities[c]);
const short = (x: number): string => String(Number(x.toFixed(2)));

export class SvgContext implements Context {
  fillStyle: Context['fillStyle'] = '';
  strokeStyle: Context['strokeStyle'] = '';
  lineWidth = 1;
  lineJoin: CanvasLineJoin = 'round';
  font = '';
  textAlign: CanvasTextAlign = 'left';
  textBaseline: CanvasTextBaseline = 'alphabetic';
  private dash: number[] = [];
  private path = '';
  private clips = 0;
  private open = 0; // groups of the current save()
  private readonly saved: number[] = [];
  private readonly parts: string[] = [];

  /** `name` begins the ids, so that several drawings can be part of one document. */
  constructor(private readonly name: string) {}

  save(): void {
    this.saved.push(this.open);
    this.open = 0;
  }

  restore(): void {
    this.parts.push('</g>'.repeat(this.open));
    this.open = this.saved.pop() ?? 0;
  }

  /** Restricts what follows to the current path, until restore(). */
  clip(): void {
    const id = `${this.name}-clip-${++this.clips}`;
    this.parts.push(`<clipPath id="${id}"><path d="${this.path}"/></clipPath><g clip-path="url(#${id})">`);
    ++this.open;
  }

  beginPath(): void {
    this.path = '';
  }

  moveTo(x: number, y: number): void {
    this.path += `M${short(x)} ${short(y)}`;
  }

  lineTo(x: number, y: number): void {
    this.path += `L${short(x)} ${short(y)}`;
  }

  closePath(): void {
    this.path += 'Z';
  }

  rect(x: number, y: number, width: number, height: number): void {
    this.path += `M${short(x)} ${short(y)}h${short(width)}v${short(height)}h${short(-width)}Z`;
  }

  /** A full circle: the angles are ignored. */
  arc(x: number, y: number, radius: number): void {
    const r = short(radius);
    const across = short(2 * radius);
    this.path += `M${short(x - radius)} ${short(y)}a${r} ${r} 0 1 0 ${across} 0a${r} ${r} 0 1 0 -${across} 0Z`;
  }

  setLineDash(dash: number[]): void {
    this.dash = dash;
  }

  stroke(): void {
    if (this.path === '') return;
    const dash = this.dash.length > 0 ? ` stroke-dasharray="${this.dash.map(short).join(' ')}"` : '';
    const line = `stroke="${String(this.strokeStyle)}" stroke-width="${short(this.lineWidth)}" stroke-linejoin="${this.lineJoin}"`;
    this.parts.push(`<path d="${this.path}" fill="none" ${line}${dash}/>`);
  }

  fill(): void {
    if (this.path !== '') this.parts.push(`<path d="${this.path}" fill="${String(this.fillStyle)}"/>`);
  }

  fillRect(x: number, y: number, width: number, height: number): void {
    const [left, top] = [Math.min(x, x + width), Math.min(y, y + height)];
    const size = `width="${short(Math.abs(width))}" height="${short(Math.abs(height))}"`;
    this.parts.push(`<rect x="${short(left)}" y="${short(top)}" ${size} fill="${String(this.fillStyle)}"/>`);
  }

  fillText(words: string, x: number, y: number): void {
    this.words(words, x, y, '');
  }

  /** Text that reads upwards. */
  upwards(words: string, x: number, y: number): void {
    this.words(words, x, y, ` transform="rotate(-90 ${short(x)} ${short(y)})"`);
  }

  private words(words: string, x: number, y: number, more: string): void {
    const anchor = kAnchors[this.textAlign] ?? 'start';
    const style = `text-anchor="${anchor}" fill="${String(this.fillStyle)}"${more}`;
    this.parts.push(`<text x="${short(x)}" y="${short(y)}" ${style}>${escaped(words)}</text>`);
  }

  /** The picture as a file: width, height and font size in px, on a background, with a description. */
  text(width: number, height: number, size: number, background: string, font: string, sentence: string): string {
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" ` +
      `font-family="${escaped(font)}" font-size="${size}"><title>${escaped(sentence)}</title>` +
      `<rect width="${width}" height="${height}" fill="${background}"/>${this.parts.join('')}</svg>\n`
    );
  }
}
