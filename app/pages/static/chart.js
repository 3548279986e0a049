// Draws the curves of a result with uPlot: amplitudes over wind speed, with hover, zoom and a choice of direction.
"use strict";
(() => {
  const DASH = { stable: [], unstable: [7, 5], unknown: [2, 4] };
  const COLOURS = ["--one", "--two", "--three", "--soft"];

  function colour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  }
  // `light-dark()` is resolved by the browser only where it is used as a colour.
  function resolved(name) {
    const probe = document.createElement("span");
    probe.style.color = `var(${name})`;
    document.body.append(probe);
    const found = getComputedStyle(probe).color;
    probe.remove();
    return found || colour(name);
  }
  function faint(text, part = 0.18) {
    return text.replace(/^rgb\((.*)\)$/, `rgba($1, ${part})`);
  }

  class Chart {
    constructor(place, data) {
      this.place = place;
      this.data = data;
      this.words = JSON.parse(place.dataset.words);
      this.quantity = data.quantities[0];
      this.canvas = place.querySelector(".canvas");
      this.reading = place.querySelector(".reading");
      this.families = this.familyNames();
      this.controls();
      this.say(data.note);
      this.draw();
      new ResizeObserver(() => this.resize()).observe(this.canvas);
      window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    }
    // Shows other curves in the place of these; the choice of direction stays.
    show(data) {
      const name = this.quantity.name;
      this.data = data;
      this.quantity = data.quantities.find((quantity) => quantity.name === name);
      this.families = this.familyNames();
      this.draw();
    }
    familyNames() {
      const all = [...this.data.pieces, ...this.data.motions, ...this.data.tori];
      return [...new Set(all.map((piece) => `${piece.model} ${piece.loops}`))].sort();
    }
    look(piece) {
      const loops = [...new Set(this.families.map((name) => name.split(" ")[1]))];
      const hue = COLOURS[loops.indexOf(String(piece.loops)) % COLOURS.length];
      return { stroke: resolved(hue), width: (piece.model === "hybrid" ? 1.5 : 3) * (this.letter() / 16) };
    }
    // What the curves lack, where they lack something.
    say(note) {
      if (!note) return;
      const said = document.createElement("p");
      said.className = "note";
      said.textContent = note;
      this.reading.after(said);
    }
    button(text, action) {
      const made = document.createElement("button");
      made.type = "button";
      made.className = "quiet";
      made.textContent = text;
      made.addEventListener("click", action);
      return made;
    }
    controls() {
      const bar = this.place.querySelector(".controls");
      const choice = document.createElement("select");
      choice.setAttribute("aria-label", this.words.quantity);
      for (const quantity of this.data.quantities) choice.add(new Option(quantity.label, quantity.name));
      choice.addEventListener("change", () => {
        this.quantity = this.data.quantities[choice.selectedIndex];
        this.draw();
      });
      bar.replaceChildren(
        choice,
        this.button(this.words.zoom_in, () => this.zoom(0.5)),
        this.button(this.words.zoom_out, () => this.zoom(2)),
        this.button(this.words.whole, () => this.whole()),
      );
      const hint = document.createElement("small");
      hint.textContent = this.words.hint;
      bar.append(hint);
    }
    zoom(factor) {
      const { min, max } = this.plot.scales.x;
      const middle = (min + max) / 2;
      const half = ((max - min) / 2) * factor;
      this.plot.setScale("x", { min: Math.max(this.range[0], middle - half), max: Math.min(this.range[1], middle + half) });
    }
    whole() {
      this.plot.setScale("x", { min: this.range[0], max: this.range[1] });
    }
    // The tables that uPlot joins, and the series and bands that belong to them.
    parts() {
      const name = this.quantity.name;
      const tables = [];
      const series = [{ label: this.words.wind }];
      const bands = [];
      const add = (winds, values, options) => {
        const order = winds.map((_, i) => i).sort((a, b) => winds[a] - winds[b]);
        tables.push([order.map((i) => winds[i]), order.map((i) => values[i])]);
        series.push({ spanGaps: true, points: { show: false }, ...options });
        return series.length - 1;
      };
      const spread = this.data.spread;
      if (spread) {
        const grey = resolved("--soft");
        const [low, middle, high] = spread[name];
        const top = add(spread.wind, high, { stroke: "transparent", width: 0 });
        const bottom = add(spread.wind, low, { stroke: "transparent", width: 0 });
        bands.push({ series: [top, bottom], fill: faint(grey) });
        add(spread.wind, middle, { stroke: grey, width: 1, dash: [1, 3] });
      }
      for (const piece of this.data.before || []) {
        add(piece.wind, piece[name], { stroke: faint(resolved("--ink"), 0.45), width: 1.5, dash: DASH[piece.stability] });
      }
      for (const piece of this.data.pieces) {
        add(piece.wind, piece[name], { ...this.look(piece), dash: DASH[piece.stability], label: piece.name });
      }
      const shape = { show: true, size: 7 };
      for (const motion of this.data.motions) {
        const look = this.look(motion);
        const fill = motion.stability === "stable" ? look.stroke : resolved("--ground");
        add(motion.wind, motion[name], { ...look, width: 0, points: { ...shape, stroke: look.stroke, fill }, label: motion.name });
      }
      const families = new Map();
      for (const torus of this.data.tori) {
        if (torus[name][1] === null) continue;
        const key = [torus.model, torus.loops, torus.branch, torus.stability].join(" ");
        families.set(key, [...(families.get(key) || []), torus]);
      }
      for (const tori of families.values()) {
        const look = this.look(tori[0]);
        const winds = tori.map((torus) => torus.wind);
        const ends = [1, 0].map((end) =>
          add(winds, tori.map((torus) => torus[name][end]), { ...look, width: 1, points: { show: true, size: 5 } }));
        bands.push({ series: ends, fill: faint(look.stroke) });
      }
      for (const mark of this.data.marks) {
        add([mark.wind], [mark[name]], {
          stroke: resolved("--ink"), width: 0, points: { show: true, size: 9, stroke: resolved("--ink"), fill: "transparent" },
        });
      }
      return { tables, series, bands };
    }
    draw() {
      const { tables, series, bands } = this.parts();
      if (this.plot) this.plot.destroy();
      if (!tables.length) {
        this.canvas.textContent = this.words.nothing;
        return;
      }
      const joined = uPlot.join(tables);
      this.range = [Math.min(joined[0][0], this.data.onset ?? Infinity), joined[0].at(-1)];
      const room = 0.03 * (this.range[1] - this.range[0]);
      this.range = [Math.max(0, this.range[0] - room), this.range[1] + room];
      const ink = resolved("--soft");
      const axis = { stroke: ink, grid: { stroke: resolved("--rule"), width: 1 }, ticks: { stroke: ink, width: 1 }, font: this.font(), labelFont: this.font() };
      const unit = this.quantity.unit;
      const narrow = this.canvas.clientWidth < 560;
      this.plot = new uPlot({
        ...this.size(),
        scales: { x: { time: false, range: (_, low, high) => (low === null ? this.range : [low, high]) }, y: { range: (_, low, high) => [Math.min(0, low), high * 1.06 || 1] } },
        series,
        bands,
        legend: { show: false },
        cursor: { drag: { x: true, y: false }, points: { show: false }, bind: { dblclick: () => () => this.whole() } },
        axes: [
          { ...axis, label: `${this.words.wind} [${this.data.wind_unit}]` },
          { ...axis, label: `${narrow ? this.words.amplitude : this.quantity.label} [${unit}]`, size: narrow ? 48 : 4.4 * this.letter() },
        ],
        hooks: { setCursor: [() => this.read()], draw: [() => this.markWinds()] },
      }, joined, this.canvas);
      this.whole();
      this.legend();
    }
    letter() {
      return parseFloat(getComputedStyle(document.documentElement).fontSize);
    }
    font() {
      return `${Math.round(this.letter() * 0.85)}px system-ui, sans-serif`;
    }
    size() {
      const width = Math.max(280, this.canvas.clientWidth);
      return { width, height: Math.round(Math.min(Math.max(0.55 * width, 320), 0.75 * window.innerHeight + 40, 1300)) };
    }
    resize() {
      if (this.plot && Math.abs(this.plot.width - this.size().width) > 1) this.plot.setSize(this.size());
    }
    markWinds() {
      this.markWind(this.data.onset, "--bad", [6, 6]);
      this.markWind(this.data.at ?? null, "--ink", [2, 4]);
    }
    markWind(wind, colour, dash) {
      if (wind === null) return;
      const x = Math.round(this.plot.valToPos(wind, "x", true));
      const { left, top, width, height } = this.plot.bbox;
      if (x < left || x > left + width) return;
      const pen = this.plot.ctx;
      pen.save();
      pen.strokeStyle = resolved(colour);
      pen.setLineDash(dash);
      pen.lineWidth = devicePixelRatio;
      pen.beginPath();
      pen.moveTo(x, top);
      pen.lineTo(x, top + height);
      pen.stroke();
      pen.restore();
    }
    // Says what lies nearest to the pointer, in both directions: a branch may pass a wind speed more than once.
    read() {
      const { left, top } = this.plot.cursor;
      const name = this.quantity.name;
      let best = { distance: 30 };
      const near = (label, wind, value) => {
        if (value === null) return;
        const distance = Math.hypot(this.plot.valToPos(wind, "x") - left, this.plot.valToPos(value, "y") - top);
        if (distance < best.distance) best = { distance, label, wind, value };
      };
      if (left >= 0) {
        for (const mark of this.data.marks) near(mark.name, mark.wind, mark[name]);
        for (const piece of [...this.data.motions, ...this.data.pieces]) piece.wind.forEach((wind, i) => near(piece.name, wind, piece[name][i]));
        for (const torus of this.data.tori) for (const value of torus[name]) near(torus.name, torus.wind, value);
      }
      const digits = (value) => value.toLocaleString(document.documentElement.lang, { maximumSignificantDigits: 3 });
      this.reading.textContent = best.label
        ? `${best.label}: ${digits(best.wind)} ${this.data.wind_unit}, ${digits(best.value)} ${this.quantity.unit}`
        : "";
    }
    legend() {
      const list = this.place.querySelector(".legend");
      const entries = new Map();
      for (const piece of this.data.pieces) entries.set(piece.name, { ...this.look(piece), dash: DASH[piece.stability] });
      for (const motion of this.data.motions) if (!entries.has(motion.name)) entries.set(motion.name, { ...this.look(motion), dash: DASH[motion.stability] });
      const ink = resolved("--soft");
      if (this.data.tori.length) entries.set(this.words.torus, { stroke: faint(ink), width: 9, dash: [] });
      if (this.data.spread) entries.set(this.words.spread, { stroke: faint(ink), width: 9, dash: [] });
      if (this.data.onset !== null) entries.set(this.words.onset, { stroke: resolved("--bad"), width: 1.5, dash: [6, 6] });
      if (this.data.at !== undefined) entries.set(this.words.at, { stroke: ink, width: 1.5, dash: [2, 4] });
      if (this.data.before) entries.set(this.words.before, { stroke: faint(ink, 0.45), width: 1.5, dash: [] });
      list.replaceChildren(...[...entries].map(([text, look]) => {
        const item = document.createElement("li");
        const key = document.createElementNS("http://www.w3.org/2000/svg", "svg");
        key.setAttribute("viewBox", "0 0 34 12");
        key.setAttribute("aria-hidden", "true");
        const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
        line.setAttribute("d", "M1 6H33");
        line.setAttribute("stroke", look.stroke);
        line.setAttribute("stroke-width", look.width);
        line.setAttribute("stroke-dasharray", look.dash.join(" "));
        key.append(line);
        item.append(key, text);
        return item;
      }));
    }
  }

  async function start(place) {
    try {
      const answer = await fetch(place.dataset.curves, { headers: { Accept: "application/json" } });
      if (!answer.ok) throw new Error(answer.statusText);
      place.chart = new Chart(place, await answer.json());
    } catch (error) {
      place.querySelector(".canvas").textContent = JSON.parse(place.dataset.words).failed;
      throw error;
    }
  }
  window.galloping.Chart = Chart;
  for (const place of document.querySelectorAll(".chart[data-curves]")) start(place);
})();
