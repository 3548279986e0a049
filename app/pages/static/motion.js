// Moves the drawings of a motion over its period: play, pause, speed, and a slider for the moment.
"use strict";
(() => {
  function at(values, part) {
    const place = part * values.length;
    const first = Math.floor(place) % values.length;
    return values[first] + (place - Math.floor(place)) * (values[(first + 1) % values.length] - values[first]);
  }
  function line(x, y) {
    return "M" + x.map((value, i) => `${value} ${y[i].toFixed(2)}`).join("L");
  }
  class Motion {
    constructor(place) {
      this.place = place;
      this.data = JSON.parse(place.dataset.motion);
      this.play = place.querySelector(".play");
      this.moment = place.querySelector(".moment");
      this.speed = place.querySelector(".speed");
      this.bundle = place.querySelector(".moving");
      this.side = place.querySelector(".moving-side");
      this.plan = place.querySelector(".moving-plan");
      this.part = 0;
      this.running = false;
      this.play.addEventListener("click", () => this.set(!this.running));
      this.moment.addEventListener("input", () => {
        this.set(false);
        this.part = Number(this.moment.value) % 1;
        this.show();
      });
      this.show();
      this.set(!window.matchMedia("(prefers-reduced-motion: reduce)").matches);
    }
    set(running) {
      this.running = running;
      this.play.textContent = running ? this.place.dataset.pause : this.place.dataset.play;
      if (running) {
        this.last = null;
        requestAnimationFrame((now) => this.step(now));
      }
    }
    step(now) {
      if (!this.running || !this.place.isConnected) return;
      if (this.last !== null) {
        this.part = (this.part + ((now - this.last) / 1000) * Number(this.speed.value) / this.data.period) % 1;
        this.moment.value = this.part;
        this.show();
      }
      this.last = now;
      requestAnimationFrame((later) => this.step(later));
    }
    show() {
      const [v, w, theta] = ["v", "w", "theta"].map((name) => at(this.data[name], this.part));
      const { x, y } = this.bundle.dataset;
      const scale = this.data.cross;
      const turn = (theta * 180) / Math.PI;
      this.bundle.setAttribute("transform", `translate(${w * scale} ${-v * scale}) rotate(${turn} ${x} ${y})`);
      const span = this.data.span;
      if (!span) return;
      this.side.setAttribute("d", line(span.x, span.y.map((rest, i) => rest - v * span.f[i] * span.scale)));
      this.plan.setAttribute("d", line(span.x, span.g.map((shape) => span.plan + w * shape * span.scale)));
    }
  }
  function start(root) {
    for (const place of root.querySelectorAll(".motion")) place.motion = place.motion || new Motion(place);
  }
  document.addEventListener("htmx:afterSettle", (event) => start(event.target));
  start(document);
})();
