# SPDX-License-Identifier: Apache-2.0
"""Many clients in one thread with little CPU time: requests are prepared bytes, answers are compared as bytes."""

import selectors
import socket
import time


class Request:
    """A request and its expected answer; a body of None matches any body."""

    def __init__(self, method, target, body=b"", content_type=None, status=200, expected=None):
        head = f"{method} {target} HTTP/1.1\r\nHost: localhost\r\n"
        if content_type:
            head += f"Content-Type: {content_type}\r\nContent-Length: {len(body)}\r\n"
        self.content = f"{head}\r\n".encode() + body
        self.name, self.is_fit = f"{method} {target}", target.startswith("/v1/fits?") and method == "POST"
        self.status, self.expected = status, expected


class Outcome:
    """Statistics of the clients."""

    def __init__(self):
        self.times, self.fits, self.refused, self.errors = [], 0, 0, []

    def percentile(self, part):
        ordered = sorted(self.times)
        return ordered[min(len(ordered) - 1, int(part * len(ordered)))] if ordered else float("nan")


class Client:
    """One persistent connection with one request at a time."""

    def __init__(self, port, requests, first, outcome):
        self.port, self.requests, self.next, self.outcome = port, requests, first, outcome
        self.connection, self.unsent, self.received, self.need = None, b"", bytearray(), None
        self.answered = 0

    def begin(self, selector):
        """Sends its next request, on a new connection if the last one was closed."""
        if self.connection is None:
            self.connection = socket.create_connection(("127.0.0.1", self.port), 60)
            self.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.connection.setblocking(False)
            selector.register(self.connection, selectors.EVENT_READ, self)
        self.request = self.requests[self.next % len(self.requests)]
        self.next += 1
        self.unsent, self.received, self.need = memoryview(self.request.content), bytearray(), None
        self.begun = time.monotonic()
        self.send(selector)

    def send(self, selector):
        try:
            self.unsent = self.unsent[self.connection.send(self.unsent):]
        except BlockingIOError:
            pass
        except OSError:
            self.unsent = b""  # the server may have answered already
        selector.modify(self.connection, selectors.EVENT_READ | (selectors.EVENT_WRITE if self.unsent else 0), self)

    def receive(self, selector):
        """Reads available bytes; returns whether the answer is complete or will not come."""
        try:
            content = self.connection.recv(1 << 18)
        except BlockingIOError:
            return False
        except OSError as error:
            content = b""
            self.outcome.errors.append(f"{self.request.name}: {error}")
        if not content:
            self.fail(selector)
            return True
        self.received += content
        if self.need is None and (end := self.received.find(b"\r\n\r\n")) >= 0:
            head = self.received[:end].lower()
            length = head.partition(b"\r\ncontent-length:")[2].partition(b"\r\n")[0]
            self.head, self.body_begin = head, end + 4
            self.need = end + 4 + int(length or 0)
        if self.need is None or len(self.received) < self.need:
            return False
        self.check_answer(selector)
        return True

    def fail(self, selector):
        """The server closed the connection: allowed between two requests, an error within one."""
        if self.answered == 0 or self.received or time.monotonic() - self.begun > 1:
            self.outcome.errors.append(f"{self.request.name}: ended after {bytes(self.received[:200])!r}")
        else:
            self.next -= 1
        self.close(selector)

    def check_answer(self, selector):
        status, body = int(self.head[9:12]), self.received[self.body_begin:]
        self.answered += 1
        self.outcome.times.append(time.monotonic() - self.begun)
        if status == 429:
            self.outcome.refused += 1
        elif status != self.request.status or (self.request.expected is not None and body != self.request.expected):
            self.outcome.errors.append(f"{self.request.name}: {bytes(self.received[:600])!r}")
        else:
            self.outcome.fits += self.request.is_fit
        if b"connection: close" in self.head:
            self.close(selector)

    def close(self, selector):
        selector.unregister(self.connection)
        self.connection.close()
        self.connection, self.answered = None, 0


def drive(port, requests, clients, seconds, every_tenth_second=lambda: None):
    """Runs `clients` clients for `seconds`; each cycles through the requests from a different start. Running requests finish at
    the end."""
    outcome, selector = Outcome(), selectors.DefaultSelector()
    everyone = [Client(port, requests, i * 5, outcome) for i in range(clients)]
    end, next_tick, under_way = time.monotonic() + seconds, 0, len(everyone)
    for client in everyone:
        client.begin(selector)
    while under_way and time.monotonic() < end + 120 and len(outcome.errors) < 100:
        for key, what in selector.select(0.1):
            client = key.data
            if what & selectors.EVENT_WRITE:
                client.send(selector)
            if what & selectors.EVENT_READ and client.receive(selector):
                if time.monotonic() < end:
                    client.begin(selector)
                else:
                    under_way -= 1
                    if client.connection:
                        client.close(selector)
        if time.monotonic() >= next_tick:
            next_tick = time.monotonic() + 0.1
            every_tenth_second()
    if under_way and not outcome.errors:
        outcome.errors.append(f"{under_way} clients were never answered")
    for client in everyone:
        if client.connection:
            client.close(selector)
    return outcome
