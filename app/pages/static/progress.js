// Follows a job until it ends, then shows its result. A lost connection is said, and tried again.
"use strict";
(() => {
  const place = document.getElementById("progress");
  const wait = 1500;
  function show(data) {
    document.getElementById("bar").value = data.progress;
    document.getElementById("step").textContent = data.step;
  }
  function follow() {
    const events = new EventSource(place.dataset.events);
    events.addEventListener("open", () => window.galloping.found());
    events.addEventListener("progress", (event) => show(JSON.parse(event.data)));
    for (const end of ["successful", "failed", "dismissed"]) {
      events.addEventListener(end, () => {
        events.close();
        window.location.reload();
      });
    }
    events.addEventListener("error", () => {
      window.galloping.lost();
      if (events.readyState === EventSource.CLOSED) window.setTimeout(check, wait);
    });
  }
  // The stream may have ended because the job has: the page knows.
  async function check() {
    try {
      const answer = await fetch(window.location.href, { headers: { Accept: "text/html" } });
      if (answer.status < 500) window.location.reload();
      else throw new Error(answer.statusText);
    } catch {
      window.setTimeout(check, wait);
    }
  }
  follow();
})();
