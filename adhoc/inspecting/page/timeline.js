// What happened when: a lane for each episode that is shown, under the slider.
const LANE = 26;
const GUTTER = 150;
const RIGHT = 16;

class Timeline {
  constructor(state) {
    this.state = state;
    this.canvas = byId("lanes");
    this.slider = byId("slider");
    this.slider.addEventListener("input", () => state.go(Number(this.slider.value)));
    this.canvas.addEventListener("pointerdown", (event) => this.drag(event));
    this.canvas.addEventListener("pointermove", (event) => event.buttons && this.drag(event));
  }

  place(step) {
    return GUTTER + (step / Math.max(1, this.state.last)) * (this.width - GUTTER - RIGHT);
  }

  drag(event) {
    const box = this.canvas.getBoundingClientRect();
    const share = (event.clientX - box.left - GUTTER) / (box.width - GUTTER - RIGHT);
    this.state.go(Math.round(share * this.state.last));
  }

  draw() {
    const episodes = this.state.shown();
    const ratio = window.devicePixelRatio || 1;
    const height = LANE * episodes.length + 16;
    this.canvas.style.height = `${height}px`;
    this.width = this.canvas.getBoundingClientRect().width;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const context = this.canvas.getContext("2d", { willReadFrequently: true });
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    episodes.forEach((episode, lane) => this.drawLane(context, episode, lane * LANE));
    if (episodes.length > 1) this.drawCommonPast(context, LANE * episodes.length);
    this.drawScale(context, LANE * episodes.length);
    const x = this.place(this.state.step);
    context.strokeStyle = "#0b5cad";
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, LANE * episodes.length);
    context.stroke();
    this.slider.max = this.state.last;
    this.slider.value = this.state.step;
  }

  drawLane(context, episode, top) {
    const middle = top + LANE / 2;
    context.font = "600 12px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    context.fillStyle = "#24292f";
    context.fillText(clip(context, episode.title, episode.shortTitle, GUTTER - 26), 12, middle);
    context.fillStyle = "#dfe5ec";
    context.fillRect(this.place(0), middle - 3, this.place(episode.steps) - this.place(0), 6);
    context.fillStyle = episode.record.success ? colours.placed : "#57606a";
    context.fillRect(this.place(episode.steps) - 1, middle - 8, 3, 16);
    for (const { step, trace } of episode.decisionList) {
      const decision = asObject(trace.decision);
      const isFallback = decision.fallback != null;
      context.fillStyle = isFallback ? colours.misplaced : trace.decision ? "#6b7785" : "#b9c2cc";
      const reach = trace.decision ? 8 : 5;
      context.fillRect(this.place(step) - 0.5, middle - reach, isFallback ? 2 : 1, 2 * reach);
    }
    for (const isJoining of [false, true]) {
      for (const [step, , kind, object] of episode.events) {
        if ((kind === "joined") === isJoining) this.drawEvent(context, episode, step, kind, object, middle);
      }
    }
  }

  drawEvent(context, episode, step, kind, object, middle) {
    const x = this.place(step);
    const target = episode.numbers.get(object);
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.font = "700 9px system-ui, sans-serif";
    if (kind === "joined") {
      context.font = "15px system-ui, sans-serif";
      outlined(context, "\u2605", x, middle, "white", colours.ink, 2.6);
    } else if (target && kind === "replaced") {
      context.beginPath();
      context.arc(x, middle, 7, 0, 7);
      context.fillStyle = colours.placed;
      context.fill();
      context.fillStyle = "white";
      context.fillText(String(target.number), x, middle + 0.5);
    } else if (target && kind === "picked up") {
      context.fillStyle = colours.misplaced;
      context.beginPath();
      context.moveTo(x, middle - 7);
      context.lineTo(x + 5.5, middle + 5);
      context.lineTo(x - 5.5, middle + 5);
      context.fill();
      context.fillStyle = "white";
      context.fillText(String(target.number), x, middle + 1);
    } else if (["stopped", "battery empty", "broke down", "left"].includes(kind)) {
      context.fillStyle = colours.ink;
      context.fillText("\u2715", x, middle);
    }
  }

  drawCommonPast(context, height) {
    const common = this.state.common;
    if (common <= 0) return;
    const [left, right] = [this.place(0), this.place(common)];
    context.fillStyle = "rgba(11,92,173,0.09)";
    context.fillRect(left, 0, right - left, height);
    context.fillStyle = "rgba(11,92,173,0.5)";
    context.fillRect(right - 0.5, 0, 1, height);
    if (right - left > 110) {
      context.font = "10px system-ui, sans-serif";
      context.textAlign = "center";
      context.textBaseline = "middle";
      outlined(context, "the same past", (left + right) / 2, height / 2, "#0b5cad", "#f2f6fa", 4);
    }
  }

  drawScale(context, top) {
    const last = this.state.last;
    const every = [1, 2, 5, 10, 20, 25, 50, 100, 200, 500, 1000].find((it) => last / it <= 14) || 5000;
    context.font = "10px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillStyle = "#57606a";
    for (let step = 0; step <= last; step += every) context.fillText(String(step), this.place(step), top + 3);
  }
}

// The text if there is room, else its shorter form, else what fits of that.
function clip(context, text, shorter, width) {
  if (context.measureText(text).width <= width) return text;
  let short = shorter;
  while (short.length > 3 && context.measureText(short).width > width) short = `${short.slice(0, -2)}\u2026`;
  return short;
}
