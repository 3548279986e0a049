// Uploads a file of lines: first to have it checked, and then, if the reader wants, to have it computed.
"use strict";
(() => {
  const form = document.getElementById("upload");
  const words = JSON.parse(form.dataset.words);
  const place = document.getElementById("checked");
  const submit = document.getElementById("submit");
  const TYPES = {
    csv: "text/csv", xlsx: "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet", json: "application/json",
    ndjson: "application/x-ndjson", jsonl: "application/x-ndjson", geojson: "application/geo+json", xml: "application/rdf+xml",
  };
  function made(tag, text, kind = "") {
    return Object.assign(document.createElement(tag), { textContent: text, className: kind });
  }
  function show(kind, text, faults) {
    const list = document.createElement("ul");
    list.append(...faults.map((fault) => {
      const where = [fault.number && words.number.replace("{number}", fault.number), fault.row && words.row.replace("{row}", fault.row), fault.reference];
      return made("li", `${where.filter(Boolean).join(", ")} ${fault.pointer} ${fault.detail}`.trim());
    }));
    place.replaceChildren(made("p", text, `notice ${kind}`), list);
  }
  async function send(only) {
    const file = document.getElementById("file").files[0];
    const type = TYPES[file.name.split(".").pop().toLowerCase()];
    if (!type) return show("bad", words.kind, []);
    const query = new URLSearchParams();
    if (only) query.set("validate_only", "true");
    for (const name of ["analysis", "defaults"]) {
      const text = document.getElementById(name).value.trim();
      if (text) query.set(name, text);
    }
    submit.disabled = true;
    show("", words.checking, []);
    try {
      const answer = await fetch(`${form.dataset.to}?${query}`, {
        method: "POST", body: file, headers: { "Content-Type": type, "X-Form-Mark": form.dataset.mark, Accept: "application/json" },
      });
      const found = await answer.json();
      window.galloping.found();
      if (!answer.ok) return show("bad", found.detail, found.errors || []);
      if (!only) return window.location.assign(form.dataset.page + found.id);
      submit.disabled = found.rejected === found.total;
      const text = words.checked.replace("{good}", found.total - found.rejected).replace("{total}", found.total);
      return show(found.rejected ? "warn" : "good", [text, ...found.notes].join(" "), found.errors);
    } catch {
      window.galloping.lost();
      return show("bad", words.lost, []);
    }
  }
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    send(true);
  });
  submit.addEventListener("click", () => send(false));
  form.addEventListener("input", () => { submit.disabled = true; });
})();
