// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { SvgContext } from './svg_context';

const drawn = (draw: (context: SvgContext) => void): string => {
  const context = new SvgContext('plot');
  draw(context);
  return context.text(40, 30, 20, '#fff', 'Arial', 'a < b').replace(/^.*?fill="#fff"\/>|<\/svg>\n$/g, '');
};

test('a path has the style of its stroke', () => {
  const svg = drawn((context) => {
    context.strokeStyle = '#123456';
    context.lineWidth = 2;
    context.setLineDash([4, 2.5]);
    context.beginPath();
    context.moveTo(1, 2);
    context.lineTo(3.14159, 4);
    context.stroke();
    context.beginPath();
    context.stroke(); // nothing
  });
  const style = 'stroke="#123456" stroke-width="2" stroke-linejoin="round" stroke-dasharray="4 2.5"';
  expect(svg).toBe(`<path d="M1 2L3.14 4" fill="none" ${style}/>`);
});

test('a circle is two half circles, and a rectangle of negative height lies above its start', () => {
  const svg = drawn((context) => {
    context.fillStyle = 'red';
    context.beginPath();
    context.arc(10, 10, 2);
    context.fill();
    context.fillRect(5, 20, 3, -4);
  });
  const circle = '<path d="M8 10a2 2 0 1 0 4 0a2 2 0 1 0 -4 0Z" fill="red"/>';
  expect(svg).toBe(`${circle}<rect x="5" y="16" width="3" height="4" fill="red"/>`);
});

test('clipping ends with restore, and text is escaped', () => {
  const svg = drawn((context) => {
    context.save();
    context.beginPath();
    context.rect(0, 0, 9, 8);
    context.clip();
    context.restore();
    context.fillStyle = 'red';
    context.textAlign = 'right';
    context.fillText('a & b', 1, 2);
    context.upwards('up', 3, 4);
  });
  const clip = '<clipPath id="plot-clip-1"><path d="M0 0h9v8h-9Z"/></clipPath><g clip-path="url(#plot-clip-1)"></g>';
  const words = '<text x="1" y="2" text-anchor="end" fill="red">a &amp; b</text>';
  const upwards = '<text x="3" y="4" text-anchor="end" fill="red" transform="rotate(-90 3 4)">up</text>';
  expect(svg).toBe(clip + words + upwards);
});
