"""Read pages as a browser does, and send their forms."""

import re
from html.parser import HTMLParser

import httpx

BROWSER = {"Accept": "text/html,application/xhtml+xml"}


class _Seen(HTMLParser):
    """Collects texts, addresses and fields, and what a strict policy forbids."""

    def __init__(self) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.addresses: list[str] = []
        self.fields: dict[str, str] = {}
        self.forbidden: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.addresses += [given[name] for name in ("href", "src", "action") if name in given]
        self.forbidden += [f"{tag} {name}" for name in given if name == "style" or name.startswith("on")]
        if tag == "style" or (tag == "script" and "src" not in given):
            self.forbidden.append(tag)
        if tag in {"input", "select"} and "name" in given:
            self.fields[given["name"]] = given.get("value", "")

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


class Page:
    """A page that was read: its text, its addresses, and the fields of its forms."""

    def __init__(self, answer: httpx.Response) -> None:
        seen = _Seen()
        seen.feed(answer.text)
        self.status = answer.status_code
        self.text = re.sub(r"\s+", " ", " ".join(seen.texts))
        self.addresses, self.fields, self.forbidden = seen.addresses, seen.fields, seen.forbidden


def read(client: httpx.Client, path: str) -> Page:
    """Return a page of the service, which must carry the policy of pages and nothing that it forbids."""
    answer = client.get(path, headers=BROWSER)
    assert answer.headers["content-type"].startswith("text/html"), answer.text
    assert "script-src 'self';" in answer.headers["content-security-policy"]
    page = Page(answer)
    assert page.forbidden == []
    return page


def send(client: httpx.Client, path: str, fields: dict[str, str], form: str = "/") -> httpx.Response:
    """Send a form with the mark of a page that was read before."""
    return client.post(path, data={"mark": read(client, form).fields["mark"], **fields}, headers=BROWSER)
