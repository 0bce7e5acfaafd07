// SPDX-License-Identifier: Apache-2.0
// Searches the paragraphs in search_index.js, a script too, because a page that is opened as a file cannot fetch one.
'use strict';

const kShown = 20;
const kAround = 60; // characters before the first word that is found

const box = document.querySelector('.search');
const input = box.querySelector('input');
const list = box.querySelector('ul');
const count = box.querySelector('[role=status]');

/** Titles count more than text, words side by side more than apart. null: a word is missing. */
function score({ page, heading, text }, words) {
  const [title, body] = [`${page} ${heading}`.toLowerCase(), text.toLowerCase()];
  const phrase = words.join(' ');
  let sum = (title.includes(phrase) ? 2 : 0) + (body.includes(phrase) ? 2 * words.length : 0);
  for (const word of words) {
    const [inTitle, inBody] = [title.includes(word), body.includes(word)];
    if (!inTitle && !inBody) return null;
    sum += (inTitle ? 2 : 0) + (inBody ? 1 : 0);
  }
  return sum;
}

function find(words) {
  const found = kParagraphs.map((one) => ({ one, value: score(one, words) })).filter(({ value }) => value !== null);
  return found.sort((a, b) => b.value - a.value).map(({ one }) => one);
}

/** The text about the first word, with all words marked. */
function excerpt(text, words) {
  const places = words.map((word) => text.toLowerCase().indexOf(word)).filter((place) => place >= 0);
  const start = Math.max(0, Math.min(...places, text.length) - kAround);
  const part = (start > 0 ? '… ' : '') + text.slice(start, start + 4 * kAround);
  const pattern = new RegExp(`(${words.map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')).join('|')})`, 'i');
  return part.split(pattern).map((piece, i) => {
    if (i % 2 === 0) return piece;
    const mark = document.createElement('mark');
    mark.append(piece);
    return mark;
  });
}

function item({ url, page, heading, text }, words) {
  const link = document.createElement('a');
  link.href = url;
  const title = document.createElement('strong');
  title.append(heading === '' || heading === page ? page : `${page} › ${heading}`);
  const small = document.createElement('span');
  small.append(...excerpt(text, words));
  link.append(title, small);
  const element = document.createElement('li');
  element.append(link);
  return element;
}

function search() {
  const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
  const found = words.length > 0 ? find(words) : [];
  list.replaceChildren(...found.slice(0, kShown).map((one) => item(one, words)));
  const rest = found.length > kShown ? `; the first ${kShown} are shown` : '';
  count.textContent = words.length === 0 ? '' : found.length === 0 ? 'Nothing found' : `${found.length} found${rest}`;
}

function close() {
  input.value = '';
  search();
  input.focus();
}

/** Arrows go from the field through the results and back; Enter on the field opens the first. */
function pressed(event) {
  if (event.key === 'Escape') return close();
  const places = [input, ...list.querySelectorAll('a')];
  const now = places.indexOf(document.activeElement);
  if (event.key === 'Enter' && now === 0) return places[1]?.click();
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  const next = step && places[now + step];
  if (!next) return;
  event.preventDefault();
  next.focus();
}

input.addEventListener('input', search);
box.addEventListener('keydown', pressed);
list.addEventListener('click', (event) => {
  if (event.target.closest('a')) setTimeout(close); // a result on this page: show its paragraph
});
box.hidden = false;
