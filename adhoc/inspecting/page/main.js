// The state of the page, and what changes it.
const PANELS = { decisions: ["Decisions", decisionsPanel], messages: ["Messages", messagesPanel], robots: ["Robots", robotsPanel] };
const SPEEDS = [2, 5, 10, 25, 60];
const SWITCHES = { views: ["fields of view", "v"], explored: ["explored floor", "e"], paths: ["paths", "p"], targets: ["targets", "t"] };

class State {
  constructor(page) {
    this.page = page;
    this.step = 0;
    this.playing = false;
    this.speed = 10;
    this.focus = null;
    this.pinned = null;
    this.tab = "decisions";
    this.shows = { views: true, explored: true, paths: true, targets: true, team: false, skills: false };
    const shown = new Set([page.episodes[0], page.episodes[page.episodes.length - 1]]);
    this.maps = [...shown].map((episode) => {
      const map = new MapView(page, this);
      map.show(episode);
      return map;
    });
    this.panelMap = this.maps[this.maps.length - 1];
    this.timeline = new Timeline(this);
    this.carry = 0;
    this.before = null;
    this.panelKey = "";
  }

  shown() {
    return this.maps.map((map) => map.episode);
  }

  get last() {
    return Math.max(...this.shown().map((episode) => episode.steps));
  }

  // Steps that the episodes shown share.
  get common() {
    const [one, other] = this.shown();
    return other ? this.page.data.commonPast[one.place][other.place] : 0;
  }

  go(step, pinned = null) {
    this.step = clamp(Math.round(step) || 0, 0, this.last);
    this.pinned = pinned;
    this.refresh();
  }

  focusIn(episode) {
    return this.focus === null ? -1 : episode.robots.findIndex((robot) => robot.name === this.focus);
  }

  focusOn(name, episode) {
    this.focus = name;
    this.pinned = null;
    const map = this.maps.find((one) => one.episode === episode);
    if (map) this.panelMap = map;
    this.refresh();
  }

  choose(map, place) {
    map.show(this.page.episodes[place]);
    this.pinned = null;
    this.go(this.step);
  }

  toggle(name) {
    this.shows[name] = !this.shows[name];
    this.pinned = null;
    this.refresh();
  }

  decisionsOf(episode) {
    const focus = this.focusIn(episode);
    const mine = episode.decisionList.filter((one) => focus < 0 || one.robot === focus);
    const plans = mine.filter((one) => one.trace.decision);
    return this.shows.skills || !plans.length ? mine : plans;
  }

  decisionNow(episode) {
    const list = this.decisionsOf(episode);
    if (this.pinned && list.includes(this.pinned)) return this.pinned;
    let now = null;
    for (const one of list) if (one.step <= this.step) now = one;
    return now;
  }

  jump(direction) {
    const list = this.decisionsOf(this.panelMap.episode);
    const now = this.decisionNow(this.panelMap.episode);
    const next = list[list.indexOf(now) + direction];
    if (next) this.go(next.step, next);
  }

  play(playing = !this.playing) {
    this.playing = playing;
    if (playing && this.step >= this.last) this.step = 0;
    this.before = performance.now();
    this.carry = 0;
    clearTimeout(this.timer);
    this.refresh();
    if (playing) this.tick();
  }

  tick() {
    if (!this.playing) return;
    const now = performance.now();
    this.carry += (this.speed * Math.min(500, now - this.before)) / 1000;
    this.before = now;
    const whole = Math.floor(this.carry);
    this.carry -= whole;
    if (whole > 0) {
      if (this.step + whole >= this.last) this.playing = false;
      this.go(this.step + whole);
    }
    if (this.playing) this.timer = setTimeout(() => this.tick(), 1000 / 60);
  }

  refresh() {
    this.draw();
    this.drawPanel();
    const play = byId("play");
    play.textContent = this.playing ? "\u275a\u275a" : "\u25b6\ufe0e play";
    byId("clock").textContent = `step ${this.step} of ${this.last}`;
    document.documentElement.dataset.step = this.step;
  }

  draw() {
    this.layout();
    for (const map of this.maps) map.draw();
    this.timeline.draw();
  }

  // Side by side or one above the other, whichever leaves the maps larger.
  layout() {
    const area = byId("maps").getBoundingClientRect();
    const { x, y, right, top } = this.page.box;
    const [across, along] = [right - x + 0.6, top - y + 0.6];
    const count = this.maps.length;
    const beside = Math.min(area.width / count / across, (area.height - 34) / along);
    const above = Math.min(area.width / across, (area.height / count - 34) / along);
    byId("maps").classList.toggle("above", above > beside);
  }

  drawPanel() {
    const { episode } = this.panelMap;
    fill(byId("tabs"), Object.entries(PANELS).map(([name, [label]]) => make("button", { role: "tab", "aria-selected": this.tab === name, onclick: () => this.open(name) }, label)));
    fill(byId("which"), this.maps.length < 2 ? [] : this.maps.map((map) => make("button", { "aria-pressed": map === this.panelMap, onclick: () => this.look(map) }, map.episode.title)), this.focus && make("button", { class: "focus", title: "Show all robots (Esc)", onclick: () => this.focusOn(null, episode) }, `only ${this.focus.replaceAll("_", " ")} \u2715`));
    const decision = this.tab === "decisions" ? this.decisionNow(episode) : null;
    const key = this.tab === "decisions" ? [decision && decision.index, this.shows.skills] : [this.step, this.shows.team];
    const whole = JSON.stringify([this.tab, episode.place, this.focus, key]);
    if (whole === this.panelKey) return;
    this.panelKey = whole;
    const panel = byId("panel");
    fill(panel, PANELS[this.tab][1](this, episode));
    panel.scrollTop = 0;
  }

  open(tab) {
    this.tab = tab;
    this.refresh();
  }

  look(map) {
    this.panelMap = map;
    this.pinned = null;
    this.refresh();
  }

  key(event) {
    const target = event.target instanceof Element ? event.target : document.body;
    if (event.ctrlKey || event.metaKey || event.altKey || target.matches("select, dialog *")) return;
    const far = event.shiftKey ? 10 : 1;
    const keys = {
      " ": () => this.play(),
      ArrowLeft: () => this.go(this.step - far),
      ArrowRight: () => this.go(this.step + far),
      Home: () => this.go(0),
      End: () => this.go(this.last),
      "[": () => this.jump(-1),
      "]": () => this.jump(1),
      Escape: () => this.focusOn(null, this.panelMap.episode),
      "?": () => byId("help").showModal(),
    };
    for (const [name, [, letter]] of Object.entries(SWITCHES)) keys[letter] = () => this.flip(name);
    this.panelMap.episode.robots.forEach((robot, index) => (keys[String(index + 1)] = () => this.focusOn(robot.name, this.panelMap.episode)));
    const action = keys[event.key];
    if (!action) return;
    event.preventDefault();
    if (target.matches("button, input")) target.blur();
    action();
  }

  flip(name) {
    this.toggle(name);
    byId(`switch-${name}`).checked = this.shows[name];
  }
}

// `file.html#step=120&robot=newcomer&tab=messages` opens the page there.
function openAt(state) {
  const wanted = new URLSearchParams(window.location.hash.slice(1));
  if (PANELS[wanted.get("tab")]) state.tab = wanted.get("tab");
  const { episode } = state.panelMap;
  const robot = wanted.get("robot");
  if (episode.robots.some((one) => one.name === robot)) state.focus = robot;
  const joined = episode.record.joined ? episode.record.join_step : 0;
  state.go(Number(wanted.get("step") ?? joined));
  return wanted.has("selftest");
}

async function main() {
  const data = await readData();
  takeColours(data.colours);
  const page = new Page(data);
  const state = new State(page);
  put(byId("maps"), state.maps.map((map) => map.element));
  buildHead(page);
  buildControls(state);
  buildHelp();
  const isTest = openAt(state);
  document.documentElement.dataset.ready = "yes";
  if (isTest) await selfTest(state);
}

main().catch((error) => {
  console.error(error);
  document.body.prepend(make("p", { class: "broken" }, `The page could not be shown: ${error.message}`));
});
