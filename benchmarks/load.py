"""Clients on bare sockets: many at once in a closed loop, or posts at a fixed rate whatever the answers take.

A client library would cost more than the service on the same two cores.
"""

import asyncio
import time
from collections.abc import Callable

CLIENTS = 50

Request = Callable[[int], bytes]


def closed_loop(port: int, request: Request, each: int, status: bytes) -> list[float]:
    """Let every client send its next request as soon as it has the last answer; return the time of each [s]."""

    async def run() -> list[float]:
        clients = [_in_turn(port, request, number * each, each, status) for number in range(CLIENTS)]
        return [seconds for times in await asyncio.gather(*clients) for seconds in times]

    return asyncio.run(run())


def open_loop(port: int, request: Request, count: int, per_second: float, status: bytes) -> list[float]:
    """Send requests at a fixed rate over as many connections; return how late each answer is after its moment [s].

    A request whose connection is still busy waits for it, and that wait counts.
    """

    async def run() -> list[float]:
        begin = time.perf_counter() + 0.5
        moments = [begin + number / per_second for number in range(count)]
        clients = [_at_moments(port, request, moments[number::CLIENTS], status) for number in range(CLIENTS)]
        return [seconds for times in await asyncio.gather(*clients) for seconds in times]

    return asyncio.run(run())


async def _in_turn(port: int, request: Request, first: int, count: int, status: bytes) -> list[float]:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    times = []
    for number in range(first, first + count):
        begin = time.perf_counter()
        await _exchange(reader, writer, request(number), status)
        times.append(time.perf_counter() - begin)
    writer.close()
    return times


async def _at_moments(port: int, request: Request, moments: list[float], status: bytes) -> list[float]:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    times = []
    for number, moment in enumerate(moments):
        await asyncio.sleep(max(0.0, moment - time.perf_counter()))
        await _exchange(reader, writer, request(number), status)
        times.append(time.perf_counter() - moment)
    writer.close()
    return times


async def _exchange(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: bytes, status: bytes) -> None:
    writer.write(request)
    head = await reader.readuntil(b"\r\n\r\n")
    fields = dict(line.lower().split(b": ", 1) for line in head.split(b"\r\n")[1:-2])
    await reader.readexactly(int(fields[b"content-length"]))
    assert head.split(b" ", 2)[1] == status, head
