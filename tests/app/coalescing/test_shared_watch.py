import asyncio
import threading
from collections.abc import Mapping
from contextlib import aclosing, suppress
from unittest.mock import patch

from sqlalchemy.exc import OperationalError

from app.coalescing.shared_watch import SharedWatch

Seen = Mapping[int, str | None]


class Table:
    """The states that exist, and the queries that were made."""

    def __init__(self, **states: str) -> None:
        self.states: dict[int, str] = {int(name[1:]): state for name, state in states.items()}
        self.queries: list[set[int]] = []
        self.faults = 0

    def query(self, before: Seen) -> dict[int, str]:
        self.queries.append(set(before))
        if self.faults:
            self.faults -= 1
            raise OperationalError("SELECT", {}, Exception("gone"))
        return {number: state for number, state in self.states.items() if number in before}


async def first(watch: SharedWatch[int, str], subject: int) -> str | None:
    async with aclosing(watch.follow(subject, 60.0)) as states:
        async for state in states:
            return state
    return None


def test_every_change_arrives_until_the_subject_disappears() -> None:
    table = Table(n1="a")

    async def main() -> list[str]:
        watch = SharedWatch("test", table.query, 0.01)
        seen: list[str] = []
        async with aclosing(watch.follow(1, 60.0)) as states:
            async for state in states:
                seen.append(state)
                if state == "a":
                    table.states[1] = "b"
                else:
                    del table.states[1]
        await watch.close()
        return seen

    assert asyncio.run(main()) == ["a", "b"]


def test_it_ends_after_its_seconds_with_changes_and_without() -> None:
    class Restless(Table):
        def query(self, before: Seen) -> dict[int, str]:
            self.states[1] = str(len(self.queries))
            return super().query(before)

    async def main(table: Table) -> list[str]:
        watch = SharedWatch("test", table.query, 0.01)
        async with asyncio.timeout(10.0), aclosing(watch.follow(1, 0.2)) as states:
            seen = [state async for state in states]
        await watch.close()
        return seen

    assert asyncio.run(main(Table(n1="a"))) == ["a"]
    seen = asyncio.run(main(Restless(n1="")))
    assert len(seen) > 1 and seen == sorted(set(seen), key=int)


def test_a_subject_that_does_not_exist_ends_at_once() -> None:
    async def main() -> str | None:
        watch = SharedWatch("test", Table().query, 0.01)
        found = await first(watch, 5)
        await watch.close()
        return found

    assert asyncio.run(main()) is None


def test_followers_share_one_query_and_one_thread() -> None:
    table = Table(n1="a", n2="a")

    async def main() -> int:
        watch = SharedWatch("test", table.query, 0.01)

        async def wait_for_b(subject: int) -> None:
            async with aclosing(watch.follow(subject, 60.0)) as states:
                async for state in states:
                    if state == "b":
                        return

        waiting = [asyncio.create_task(wait_for_b(1 + number % 2)) for number in range(500)]
        while not table.queries:
            await asyncio.sleep(0.01)
        threads = threading.active_count()
        table.states = {1: "b", 2: "b"}
        await asyncio.gather(*waiting)
        await watch.close()
        return threads

    before = threading.active_count()
    assert asyncio.run(main()) <= before + 1
    assert {frozenset(query) for query in table.queries} == {frozenset({1, 2})}


def test_nothing_is_queried_when_nobody_follows() -> None:
    table = Table(n1="a")

    async def main() -> int:
        watch = SharedWatch("test", table.query, 0.001)
        await first(watch, 1)
        await asyncio.sleep(0.05)
        queries = len(table.queries)
        await asyncio.sleep(0.05)
        assert len(table.queries) == queries
        assert await first(watch, 1) == "a"
        await watch.close()
        return len(table.queries) - queries

    assert asyncio.run(main()) >= 1


def test_a_database_that_fails_is_queried_again() -> None:
    table = Table(n1="a")
    table.faults = 2

    async def main() -> str | None:
        watch = SharedWatch("test", table.query, 0.01)
        found = await first(watch, 1)
        await watch.close()
        return found

    assert asyncio.run(main()) == "a"


def test_release_ends_all_followers() -> None:
    async def main() -> list[list[str]]:
        watch = SharedWatch("test", Table(n1="a").query, 0.01)

        async def follow() -> list[str]:
            async with aclosing(watch.follow(1, 60.0)) as states:
                return [state async for state in states]

        following = [asyncio.create_task(follow()) for _ in range(3)]
        await first(watch, 1)
        watch.release()
        seen = [*await asyncio.gather(*following), await follow()]
        await watch.close()
        return seen

    assert asyncio.run(main())[3] == []


def test_a_request_that_comes_cuts_the_pause_of_those_that_have_waited_long() -> None:
    table = Table(n1="a", n2="b")

    async def main() -> str | None:
        watch = SharedWatch("test", table.query, 3600.0)
        with patch("app.coalescing.shared_watch._SHARE_OF_WAIT", 1e9):  # as after hours
            async with aclosing(watch.follow(1, 60.0)) as states:
                await anext(states)
                await asyncio.sleep(0.05)  # a pause of an hour has begun
                async with asyncio.timeout(30.0):
                    found = await first(watch, 2)
        await watch.close()
        return found

    assert asyncio.run(main()) == "b"


def test_pauses_grow_with_the_wait() -> None:
    table = Table(n1="a")

    async def main() -> None:
        watch = SharedWatch("test", table.query, 3600.0)
        with suppress(TimeoutError):
            async with asyncio.timeout(0.5), aclosing(watch.follow(1, 60.0)) as states:
                async for _ in states:
                    pass
        await watch.close()

    asyncio.run(main())
    assert 2 < len(table.queries) < 40  # 50 with the shortest pause throughout
