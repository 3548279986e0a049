// Follows the sliders of a line: asks for its curves as they move, one request at a time, and keeps the last curve.
// A form without an address for curves has sliders alone: its line takes too long to follow.
"use strict";
(() => {
  const form = document.getElementById("what-if");
  const place = document.querySelector(".chart");
  const words = JSON.parse(form.dataset.words);
  const message = document.getElementById("message");
  const verdict = document.getElementById("verdict");
  const answer = verdict?.querySelector(".answer");
  const sentence = verdict?.querySelector(".lead");
  const figures = document.getElementById("figures");
  const LONGEST_WAIT = 60;
  let before = null;
  let asking = false;
  let moved = false;
  let begun = false;

  class Refused extends Error {
    constructor(text, after) {
      super(text);
      this.after = after;
    }
  }

  async function ask(values) {
    const answer = await fetch(form.dataset.curves, {
      method: "POST", body: new URLSearchParams(values), headers: { Accept: "application/json" },
    });
    if (answer.ok) {
      begun = true;
      return answer.json();
    }
    const problem = await answer.json().catch(() => ({}));
    const kind = (problem.type || "").split("/").pop();
    const after = Math.min(Number(answer.headers.get("Retry-After")) || 1, LONGEST_WAIT);
    if (kind === "busy") throw new Refused(words.busy, after);
    if (kind === "takes-too-long") {
      const first = !begun;
      begun = true;
      throw new Refused(words.too_long, first ? after : 0); // the first one of a process loads what the next ones have
    }
    if (answer.status === 429) throw new Refused(words.too_often, after);
    if (answer.status === 401) throw new Refused(words.signed_out);
    if (answer.status >= 500) throw new TypeError(problem.detail || answer.statusText);
    const faults = (problem.errors || []).map((fault) => `${fault.pointer} ${fault.detail}`);
    throw new Refused([words.refused, ...(faults.length ? faults : [problem.detail || answer.statusText])].join(" "));
  }
  function show(found) {
    // Hopf points far beyond the curves would only press these together.
    const last = Math.max(found.at, ...[...found.pieces, ...before.pieces].flatMap((piece) => piece.wind));
    const data = { ...found, marks: found.marks.filter((mark) => mark.wind <= last), before: before.pieces };
    if (place.chart) {
      place.chart.show(data);
    } else {
      place.querySelector(".canvas").replaceChildren();
      place.chart = new window.galloping.Chart(place, data);
    }
    verdict.className = `verdict ${found.gallops}`;
    answer.textContent = found.answer;
    sentence.textContent = found.sentence;
    figures.replaceChildren(...found.facts.map(([name, value]) => {
      const entry = document.createElement("div");
      for (const [tag, text] of [["dt", name], ["dd", value]]) {
        entry.append(Object.assign(document.createElement(tag), { textContent: text }));
      }
      return entry;
    }));
    verdict.hidden = false;
  }
  function say(text) {
    message.textContent = text ? `${text} ${before ? words.kept : ""}` : "";
    message.hidden = !text;
    place.classList.toggle("stale", Boolean(text));
  }
  function wait(seconds) {
    return new Promise((resolve) => { window.setTimeout(resolve, 1000 * seconds); });
  }
  // One request after the other: whatever moves meanwhile is asked for when the answer is there.
  async function follow() {
    if (!form.dataset.curves) return;
    moved = true;
    if (asking) return;
    asking = true;
    place.setAttribute("aria-busy", "true");
    while (moved) {
      moved = false;
      try {
        before = before || (await ask({ mark: form.elements.mark.value }));
        show(await ask(new FormData(form)));
        say("");
        window.galloping.found();
      } catch (error) {
        if (error instanceof Refused) {
          window.galloping.found();
          say(error.message);
          if (error.after) {
            await wait(error.after);
            moved = true;
          }
        } else {
          window.galloping.lost();
          say(words.kept);
          await wait(1.5);
          moved = true;
        }
      }
    }
    asking = false;
    place.removeAttribute("aria-busy");
    place.dataset.asked = Number(place.dataset.asked || 0) + 1;
  }
  // Three digits, with narrow spaces between groups as everywhere on the pages.
  function number(value) {
    const parts = new Intl.NumberFormat(document.documentElement.lang, { maximumSignificantDigits: 3 }).formatToParts(value);
    return parts.map((part) => (part.type === "group" ? "\u202f" : part.value)).join("");
  }
  function name(slider) {
    const unit = slider.dataset.unit;
    const text = `${number(Number(slider.value))} ${unit}`.trim();
    document.getElementById(`${slider.id}-shown`).textContent = text;
    slider.setAttribute("aria-valuetext", text);
  }
  const sliders = [...form.querySelectorAll("input[type=range]")];
  form.addEventListener("input", (event) => {
    name(event.target);
    follow();
  });
  form.addEventListener("reset", () => window.setTimeout(() => {
    sliders.forEach(name);
    follow();
  }));
  sliders.forEach(name);
  follow();
})();
