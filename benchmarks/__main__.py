"""Measure speed and cost; write the figures to the terminal, docs/performance.md and benchmarks/latest.json."""

import argparse
import importlib.util
import json
import platform
from collections.abc import Iterator
from pathlib import Path

from benchmarks import cores, engine_speed, first_answer, known_fleet, samples, scaling, service_speed, table_fleet

ROOT = Path(__file__).parents[1]
LATEST = ROOT / "benchmarks" / "latest.json"
SECTIONS = ("cycle", "branch", "fleet", "tables", "known", "samples", "machine", "answer", "service")

MEANING = {
    "cycle_ratio": "one limit cycle of the source's lines: time of direct integration over the engine's, in one stack",
    "cycle_ratio_alone": "the same, each line and wind speed in a separate call",
    "cycle_ratio_bare": "the same for explicit start, balance and multipliers only, without following the branch",
    "cycle_error": "largest relative change of the dominant amplitude over 100 periods of direct integration",
    "cycle_direct_error": "largest relative difference from direct integration when it stops, still decaying slowly",
    "cycle_direct_seconds": "direct integration of one cycle [s]: DOP853, rtol 1e-8, until within 0.1 % over 50 cycles",
    "cycle_direct_cycles": "mean number of periods until then",
    "cycle_stack_seconds": "the engine, per stable cycle [s]: the complete search, with branches and multipliers",
    "cycle_alone_seconds": "the same, each line and wind speed in a separate call [s]",
    "cycle_bare_seconds": "explicit start, balance and multipliers only, each in a separate call [s]",
    "branch_ratio": "a branch: time of AUTO (mesh of 30 intervals) over the engine's (41 winds), four in one stack",
    "branch_ratio_alone": "the same, each branch in a separate call",
    "branch_auto_seconds": "AUTO's periodic branch from the Hopf point to 6 m/s [s]",
    "branch_auto_points": "number of orbits that AUTO computes on it",
    "branch_difference": "largest relative difference of the dominant amplitude at AUTO's wind speeds",
    "fleet_lines_per_s_core": "standard line jobs per second and core",
    "fleet_floor_ratio": "their time over the time of only the LAPACK calls of their numpy form",
    "fleet_compiled_gain": "time of the fleet's job with the numpy forms over its time with the compiled kernels",
    "branch_compiled_gain": "the same for a branch in a separate call",
    "fleet_full_lines_per_s_core": "the same job under full physics: lines per second and core",
    "fleet_full_ratio": "that rate over the source's, both taken in turn",
    "fleet_table_lines_per_s_core": "lines with a table, hybrid model: per second of processor time, a third gallop",
    "fleet_table_galloping_lines_per_s_core": "the same where all gallop",
    "fleet_exponent": "exponent of the time as a power of the number of lines",
    "known_fleet_ratio": "lines in engineers' forms, taken in and analysed, over the same lines spelled out, in turn",
    "known_fleet_lines_per_s_core": "the former per second and core",
    "resolve_ms": "a line in an engineer's form resolved, with its assumptions [ms of processor]",
    "resolve_route_p99_ms": "`POST /v1/lines/resolve` one after another, within the process, 99th percentile [ms]",
    "samples_64_seconds": "64 samples of a twin line's assumed values, 11 winds, with indices [s of processor]",
    "samples_1024_seconds": "the same with 1,024 samples [s of processor]",
    "finite_element_over_hybrid": "time of the finite element model over that of the hybrid model",
    "service_overhead_ratio": "median time of a batch through HTTP, queue, worker, database over the engine's",
    "two_worker_speedup": "rate of two workers over one on two cores, from start of the first chunk to end of the last",
    "two_worker_batch_speedup": "the same from the first byte of the batch to the last byte of its results",
    "machine_loop_seconds": "`sum(range(10_000_000))` in Python [s]: the speed of the machine during this run",
    "machine_two_core_speedup": "rate of two processes of the engine alone over one: the upper limit on this machine",
    "analyse_start_seconds": "time from the start of `galloping analyse` until it has read and checked a line [s]",
    "analyse_seconds": "`galloping analyse` of a line with both models at one wind speed, whole process [s]",
    "first_answer_seconds": "POST of a hybrid line until its result is read, embedded service just started [s]",
    "answer_median_seconds": "the same for later lines, one now and then: median [s]",
    "answer_95_seconds": "the same, 95th percentile [s]",
    "answer_post_seconds": "part of that median: POST until it is accepted [s]",
    "answer_queue_seconds": "accepted until a worker begins [s]",
    "answer_compute_seconds": "computing and storing [s]",
    "answer_notice_seconds": "stored until the waiting client knows [s]",
    "answer_read_seconds": "reading the result [s]",
    "first_preview_seconds": "preview of a twin line as known, two numbers of loops, 11 winds: the first [s]",
    "preview_median_seconds": "the same for later ones, one after another: median [s]",
    "preview_95_seconds": "the same, 95th percentile [s]",
    "claim_database_ms": "processor time of PostgreSQL to claim and finish a chunk, without its lines [ms]",
    "heartbeat_database_ms": "the same for a heartbeat [ms]",
    "sweep_database_ms": "the same for a sweep that finds nothing [ms]",
    "post_p99_ms": "POST /v1/jobs, 50 clients that post again after each response (closed loop), 99th percentile [ms]",
    "posts_per_s": "posts per second in that closed loop, two API processes, load generator on the same cores",
    "post_open_p99_ms": "POST /v1/jobs at 100 posts per second over 50 connections (open loop), 99th percentile [ms]",
    "post_api_ms": "processor time of the API per post [ms]",
    "post_database_ms": "processor time of PostgreSQL per post [ms]",
    "post_broker_ms": "processor time of Redis per post [ms]",
    "status_reads_per_s": "status reads per second, 50 clients, load generator on the same cores",
    "read_api_ms": "processor time of the API per status read [ms]",
    "read_database_ms": "processor time of PostgreSQL per status read [ms]",
    "line_worker_ms": "processor time of the worker per line of a batch, with the engine [ms]",
    "line_api_ms": "processor time of the API per line: intake, status reads, results as NDJSON [ms]",
    "line_database_ms": "processor time of PostgreSQL per line [ms]",
    "line_broker_ms": "processor time of Redis per line [ms]",
    "line_messages": "broker messages per line",
    "line_rows": "database rows per line, in all tables",
    "line_bytes": "bytes per line in the database, with indexes",
    "line_log_bytes": "bytes per line in PostgreSQL's write-ahead log",
}


def main() -> None:
    """Run the chosen sections and write their figures; those of the other sections stay as they were."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sections", nargs="+", choices=SECTIONS, default=SECTIONS, help="sections to measure")
    parser.add_argument("--fleet", type=int, default=1000, help="largest number of lines in the fleet")
    parser.add_argument(
        "--batch", type=int, default=10_000, help="number of lines in the batch sent through the service"
    )
    parser.add_argument("--long", type=int, nargs="?", const=10_000, help="run only the fleet, up to this many lines")
    arguments = parser.parse_args()
    if arguments.long:
        _write_long(arguments.long)
        return
    figures: dict[str, float] = json.loads(LATEST.read_text()) if LATEST.exists() else {}
    for name in arguments.sections:
        for figure, value in _section(name, arguments.fleet, arguments.batch):
            figures[figure] = value
            print(f"{figure:28} {value:12.5g}  {MEANING.get(figure, '')}", flush=True)
    figures = {figure: figures[figure] for figure in MEANING if figure in figures}
    LATEST.write_text(json.dumps(figures, indent=1) + "\n")
    _write_page(figures)


def _section(name: str, fleet: int, lines: int) -> Iterator[tuple[str, float]]:
    match name:
        case "cycle":
            yield from engine_speed.one_cycle()
        case "branch" if importlib.util.find_spec("xpplab"):
            yield from engine_speed.branch()
        case "branch":
            print("branch: skipped, because the development extra `bench` is not installed")
        case "fleet":
            yield from engine_speed.fleet(fleet)
            yield from engine_speed.full_fleet()
            yield from engine_speed.hybrid_against_finite_element()
        case "tables":
            yield from table_fleet.table_fleet()
        case "known":
            yield from known_fleet.known_fleet()
        case "samples":
            yield from samples.samples()
        case "machine":
            yield from cores.plain_python()
            yield from cores.command_line()
            yield from cores.two_processes()
        case "answer":
            yield from first_answer.first_answer()
        case _:
            yield from service_speed.service(lines)


def _write_page(figures: dict[str, float]) -> None:
    """Replace the tables between the marks of docs/performance.md."""
    where = f"Python {platform.python_version()}, {platform.machine()}, one BLAS thread."
    rows = [f"| `{name}` | {value:.4g} | {MEANING.get(name, '')} |" for name, value in figures.items()]
    _replace("table", [where, "", "| figure | value | meaning |", "|---|---|---|", *rows])
    shares = engine_speed.profile()
    rows = [f"| `{place}` | {share:.1%} |" for place, share in shares if share >= 0.01]
    _replace("profile", ["| where | share of the time |", "|---|---|", *rows])


def _write_long(largest: int) -> None:
    """Run the fleet at every size and replace its table on the page."""
    runs: list[scaling.Run] = []
    for run in scaling.long_runs(largest):
        runs.append(run)
        print(
            f"{run.lines:8} lines {run.seconds:10.1f} s {run.lines / run.seconds:8.1f} lines/s {run.peak:8.0f} MB",
            flush=True,
        )
    rows = [f"| {run.lines} | {run.seconds:.1f} | {run.lines / run.seconds:.1f} | {run.peak:.0f} |" for run in runs]
    head = ["| lines | processor time [s] | lines a second | peak memory of the process [MB] |", "|---|---|---|---|"]
    _replace(
        "long", [*head, *rows, "", f"Exponent of the time over the number of lines: {scaling.exponent(runs):.3f}."]
    )


def _replace(mark: str, lines: list[str]) -> None:
    page = ROOT / "docs" / "performance.md"
    before, rest = page.read_text().split(f"<!-- {mark} -->", 1)
    _, after = rest.split("<!-- end -->", 1)
    page.write_text(before + "\n".join([f"<!-- {mark} -->", *lines, "<!-- end -->"]) + after)


if __name__ == "__main__":
    main()
