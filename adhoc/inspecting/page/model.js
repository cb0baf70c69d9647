// The data of the page, and what was the case at a step.
async function readData() {
  const bytes = Uint8Array.from(atob(byId("data").textContent), (letter) => letter.charCodeAt(0));
  if (!("DecompressionStream" in window)) throw new Error("this browser is too old for the page (2023 or newer)");
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return JSON.parse(await new Response(stream).text());
}

class Page {
  constructor(data) {
    this.data = data;
    this.lines = data.lines;
    this.house = data.house;
    this.targets = data.targets;
    this.episodes = data.episodes.map((episode, place) => new Episode(episode, this, place));
    this.furniture = new Map(data.house.furniture.map((thing) => [thing.id, thing]));
    const corners = data.house.rooms.flatMap((room) => room.polygon);
    const [xs, ys] = [corners.map((it) => it[0]), corners.map((it) => it[1])];
    this.box = { x: Math.min(...xs), y: Math.min(...ys), right: Math.max(...xs), top: Math.max(...ys) };
  }

  block(place) {
    const stretches = this.data.blocks[place] || [];
    const lines = [];
    for (let k = 0; k < stretches.length; k += 2) lines.push(...this.lines.slice(stretches[k], stretches[k] + stretches[k + 1]));
    return lines.join("\n");
  }
}

class Episode {
  constructor(data, page, place) {
    Object.assign(this, data);
    this.page = page;
    this.place = place;
    this.steps = data.record.steps;
    this.title = page.data.titles[place];
    this.robots = data.robots.map((robot, index) => new Robot(robot, this, index));
    this.points = Uint8Array.from(atob(data.views.points), (letter) => letter.charCodeAt(0));
    this.decisionList = data.decisions.map(([step, robot, picture, trace], index) => ({ step, robot, picture, trace: asObject(trace), index }));
    const numbered = new Map(data.objects.map((object, index) => [object.id, index]));
    this.misplaced = page.targets.map((target, index) => ({ ...target, number: index + 1, index: numbered.get(target.object) }));
    this.numbers = new Map(this.misplaced.map((target) => [target.index, target]));
    this.any = this.floorOfAny();
  }

  get shortTitle() {
    return this.title.replace(/^With /, "");
  }

  at(step) {
    return clamp(step, 0, this.steps);
  }

  // Where everything that can be carried is: {x, y, holder, on}, by number.
  objectsAt(step) {
    const places = this.objects.map((object) => ({ x: object.x / 100, y: object.y / 100, holder: -1, on: "" }));
    for (const [moved, index, x, y, holder, on] of this.moves) {
      if (moved > step) break;
      places[index] = { x: x / 100, y: y / 100, holder, on: this.page.lines[on] };
    }
    return places;
  }

  // The numbers of the misplaced objects that are in a right place.
  placedAt(step) {
    const last = new Map();
    for (const [when, , kind, object] of this.events) {
      if (when > step) break;
      if (kind === "replaced") last.set(object, true);
      if (kind === "picked up") last.delete(object);
    }
    return last;
  }

  floorOfAny() {
    const floors = this.robots.map((robot) => robot.floor).filter(Boolean);
    if (!floors.length) return null;
    const first = floors[0].slice();
    for (const floor of floors.slice(1)) for (let k = 0; k < first.length; k++) if (floor[k] < first[k]) first[k] = floor[k];
    return first;
  }

  view(place) {
    const { rays, unit } = this.views;
    const points = [];
    for (let k = 0; k < rays; k++) {
      const at = 2 * (place * rays + k);
      points.push([((this.points[at] << 24) >> 24) * unit, ((this.points[at + 1] << 24) >> 24) * unit]);
    }
    return points;
  }
}

const NEVER = 32767;

class Robot {
  constructor(data, episode, index) {
    Object.assign(this, data);
    this.index = index;
    this.episode = episode;
    this.isNewcomer = index === episode.newcomer;
    for (const track of ["x", "y", "yaw", "pitch", "view", "held"]) {
      let sum = 0;
      this[track] = Int32Array.from(data[track], (change) => (sum += change));
    }
    const digits = this.name.match(/\d+$/);
    this.short = this.isNewcomer ? "\u2605" : digits ? digits[0] : String(index + 1);
    this.label = this.name.replaceAll("_", " ");
    this.colour = this.isNewcomer ? colours.newcomer : colours.robots[index % colours.robots.length];
    this.floor = data.floor && this.firstKnown(data.floor);
  }

  firstKnown(entries) {
    const [, , , columns, rows] = this.episode.grid;
    const first = new Int16Array(columns * rows).fill(NEVER);
    for (const [step, runs] of entries) {
      let at = 0;
      runs.forEach((length, turn) => {
        if (turn % 2) first.fill(step, at, at + length);
        at += length;
      });
    }
    return first;
  }

  // Its place in metres, heading in radians, and what it holds; null before it came and after it left.
  poseAt(step) {
    const at = step - this.first;
    if (at < 0 || at >= this.x.length) return null;
    return { x: this.x[at] / 100, y: this.y[at] / 100, yaw: (this.yaw[at] * Math.PI) / 180, view: this.view[at], held: this.held[at] };
  }

  doingAt(step) {
    let now = ["", ""];
    for (const [since, task, skill] of this.doing) {
      if (since > step) break;
      now = [this.episode.page.lines[task], this.episode.page.lines[skill]];
    }
    return now;
  }

  actionAt(step) {
    const action = this.actions[step - this.first];
    return action === undefined ? "" : this.episode.page.lines[action];
  }

  // Why it does nothing any more: stopped, battery empty, broke down, left; empty while it works.
  overAt(step) {
    const ends = this.episode.events.filter(
      ([when, robot, kind]) => robot === this.index && when <= step && ["stopped", "battery empty", "broke down", "left"].includes(kind)
    );
    return ends.length ? ends[ends.length - 1][2] : "";
  }
}
