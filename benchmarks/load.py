"""HTTP clients on bare sockets: many in a closed loop, or requests at a fixed rate (open loop).

A client library would take more processor time than the service on the same two cores.
"""

import asyncio
import time
from collections.abc import Callable

CLIENTS = 50

Request = Callable[[int], bytes]


def closed_loop(port: int, request: Request, each: int, status: bytes) -> list[float]:
    """Let every client send its next request once it has the last response; return the latency of each request [s]."""

    async def run() -> list[float]:
        clients = [_closed_client(port, request, number * each, each, status) for number in range(CLIENTS)]
        return [seconds for times in await asyncio.gather(*clients) for seconds in times]

    return asyncio.run(run())


def open_loop(port: int, request: Request, count: int, per_second: float, status: bytes) -> list[float]:
    """Send requests at a fixed rate over CLIENTS connections; return the latency of each from its planned time [s].

    If the connection is still busy at the planned time, the wait counts too.
    """

    async def run() -> list[float]:
        begin = time.perf_counter() + 0.5
        planned = [begin + number / per_second for number in range(count)]
        clients = [_open_client(port, request, planned[number::CLIENTS], status) for number in range(CLIENTS)]
        return [seconds for times in await asyncio.gather(*clients) for seconds in times]

    return asyncio.run(run())


async def _closed_client(port: int, request: Request, first: int, count: int, status: bytes) -> list[float]:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    times = []
    for number in range(first, first + count):
        begin = time.perf_counter()
        await _exchange(reader, writer, request(number), status)
        times.append(time.perf_counter() - begin)
    writer.close()
    return times


async def _open_client(port: int, request: Request, planned: list[float], status: bytes) -> list[float]:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    times = []
    for number, planned_time in enumerate(planned):
        await asyncio.sleep(max(0.0, planned_time - time.perf_counter()))
        await _exchange(reader, writer, request(number), status)
        times.append(time.perf_counter() - planned_time)
    writer.close()
    return times


async def _exchange(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, request: bytes, status: bytes) -> None:
    writer.write(request)
    head = await reader.readuntil(b"\r\n\r\n")
    fields = dict(line.lower().split(b": ", 1) for line in head.split(b"\r\n")[1:-2])
    await reader.readexactly(int(fields[b"content-length"]))
    assert head.split(b" ", 2)[1] == status, head
