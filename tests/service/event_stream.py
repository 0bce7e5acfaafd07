# SPDX-License-Identifier: Apache-2.0
"""Parses server-sent events like a browser: the rules of the HTML standard, section 9.2.6, Interpreting an event stream."""

import codecs
import json


class Event:
    """An event for a page: its type, its data and the last seen identifier."""

    def __init__(self, kind, data, identifier):
        self.kind, self.data, self.id = kind, data, identifier

    def json(self):
        return json.loads(self.data)

    def __repr__(self):
        return f"{self.id} {self.kind}: {self.data[:200]}"


class EventParser:
    """Takes bytes as they arrive and returns complete events; comments are counted."""

    def __init__(self):
        self._decoder = codecs.getincrementaldecoder("utf-8")("strict")  # strict, because a server must send valid UTF-8
        self._text, self._is_first, self._data, self._kind, self._id = "", True, [], "", ""
        self.comments = 0

    def feed(self, content):
        self._text += self._decoder.decode(content)
        if self._is_first and self._text:
            self._text, self._is_first = self._text.removeprefix("\ufeff"), False
        while (line := self._next_line()) is not None:
            if line == "":
                event, self._kind = self._complete(), ""
                if event:
                    yield event
            else:
                self._take(line)

    def _next_line(self):
        """A line without its end (CRLF, LF or CR); a final CR waits for a possible LF."""
        ends = [place for place in (self._text.find("\n"), self._text.find("\r")) if place >= 0]
        if not ends or (self._text[min(ends)] == "\r" and min(ends) + 1 == len(self._text)):
            return None
        end = min(ends)
        line, width = self._text[:end], 2 if self._text[end:end + 2] == "\r\n" else 1
        self._text = self._text[end + width:]
        return line

    def _take(self, line):
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        if field == "":
            self.comments += 1
        elif field == "event":
            self._kind = value
        elif field == "data":
            self._data.append(value)
        elif field == "id" and "\0" not in value:
            self._id = value

    def _complete(self):
        data, self._data = "\n".join(self._data), []
        return Event(self._kind or "message", data, self._id) if data else None


def events(response, most=None):
    """The events of a stream until it ends, or until there are `most`."""
    parser, count = EventParser(), 0
    while content := response.read1(65536):
        for event in parser.feed(content):
            yield event
            count += 1
            if count == most:
                return
