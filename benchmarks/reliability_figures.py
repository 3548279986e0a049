"""Figures of benchmarks on docs/reliability.md, beside those of the tests of faults."""

import argparse
import os

from tests.faults.report import PAGE, table, with_section


def report(name: str, found: dict[str, str]) -> None:
    """Print figures with the load of the machine; with `--write`, put them between the markers of the page."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="write docs/reliability.md anew")
    text = table({**found, "load of the machine, two cores": f"{os.getloadavg()[1]:.0f}"})
    print(text)
    if parser.parse_args().write:
        PAGE.write_text(with_section(PAGE.read_text(), name, text))
