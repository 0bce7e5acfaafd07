// SPDX-License-Identifier: Apache-2.0
/** A link, and its QR code, with which another device uses the service without the token being typed. */

import { encode } from 'uqr';

import { button, el, text } from '../shared/dom';
import { svg } from '../shared/marks';
import { addressWithToken, hasToken, onToken } from './server/token';

const kQuiet = 4; // modules around a QR code (ISO/IEC 18004, 9.1)

function qrCode(content: string): SVGElement {
  const { data, size } = encode(content, { border: kQuiet });
  const modules = data.flatMap((row, y) => row.map((dark, x) => (dark ? `M${x} ${y}h1v1h-1z` : '')));
  const drawn = svg('svg', { viewBox: `0 0 ${size} ${size}`, role: 'img', 'aria-label': 'QR code of the link', class: 'qr' });
  drawn.append(
    svg('rect', { width: String(size), height: String(size), fill: '#fff' }),
    svg('path', { d: modules.join(''), fill: '#000', 'shape-rendering': 'crispEdges' }),
  );
  return drawn;
}

const isOfThisMachine = (): boolean => ['localhost', '127.0.0.1', '[::1]'].includes(location.hostname);

function showLink(): void {
  const link = addressWithToken();
  const input = el('input', { type: 'text', readonly: '', 'aria-label': 'Link' });
  input.value = link;
  const box = el(
    'dialog',
    { 'aria-labelledby': 'invite-title' },
    el('h2', { id: 'invite-title' }, 'Use on another device'),
    text('This link carries the token: whoever has it can do what you can.'),
    isOfThisMachine() &&
      text('This address reaches this machine only. Open the page under its name in the network first.', 'absent'),
    qrCode(link),
    input,
    el(
      'div',
      { class: 'actions' },
      button('Select the link', () => input.select()),
      button('Close', () => box.close()),
    ),
  );
  box.addEventListener('close', () => box.remove());
  document.body.append(box);
  box.showModal();
}

/** Hidden as long as the service needs no token. */
export function inviteButton(): HTMLButtonElement {
  const control = button('Use on another device', showLink);
  const tell = (): void => void (control.hidden = !hasToken());
  tell();
  onToken(tell);
  return control;
}
