// One episode from above, with its title, and what a pointer finds on it.
class MapView extends MapMarks {
  constructor(page, state) {
    super(page, state);
    this.head = make("figcaption");
    this.element = make("figure", { class: "map" }, this.head, this.canvas);
    this.canvas.addEventListener("click", (event) => this.pick(event));
    this.canvas.addEventListener("mousemove", (event) => this.point(event));
    this.canvas.addEventListener("mouseleave", () => hideTip());
  }

  show(episode) {
    this.episode = episode;
  }

  draw() {
    const context = this.resize();
    const step = this.episode.at(this.state.step);
    const objects = this.episode.objectsAt(step);
    const placed = this.episode.placedAt(step);
    this.drawRooms(context);
    if (this.state.shows.explored) this.drawFog(context, step);
    this.drawFurniture(context);
    this.drawWalls(context);
    this.drawNames(context);
    if (this.state.shows.targets) this.drawTargets(context, placed);
    if (this.state.shows.views) for (const robot of this.episode.robots) this.drawView(context, robot, step);
    if (this.state.shows.paths) for (const robot of this.episode.robots) this.drawPath(context, robot, step);
    this.drawObjects(context, objects, placed);
    for (const robot of this.episode.robots) this.drawRobot(context, robot, step);
    this.drawHead(step, placed);
  }

  drawHead(step, placed) {
    const { record } = this.episode;
    const ended = this.state.step >= this.episode.steps;
    const [done, all] = [placed.size, this.episode.misplaced.length];
    fill(
      this.head,
      this.chooser(),
      make("span", { class: "count", title: "misplaced objects in a right place" }, make("b", {}, `${done}/${all}`), " re-placed"),
      ended
        ? make("span", { class: record.success ? "outcome good" : "outcome bad", title: record.ending }, record.success ? `\u2713 done, ${record.steps} steps` : `\u2715 ended, ${record.steps} steps`)
        : make("span", { class: "outcome" }, `step ${step}/${record.steps}`)
    );
  }

  chooser() {
    const { record } = this.episode;
    const label = make("strong", { title: record.episode_id }, this.episode.title);
    const joins = record.join_step === null ? null : make("span", { class: "joins" }, record.joined ? `from step ${record.join_step}` : "never joined");
    if (this.page.episodes.length < 3) return [label, joins];
    const options = this.page.episodes.map((one) => make("option", { value: one.place, selected: one === this.episode }, one.title));
    return [make("select", { onchange: (event) => this.state.choose(this, Number(event.target.value)) }, options), joins];
  }

  pick(event) {
    const [x, y] = this.from(event);
    const step = this.episode.at(this.state.step);
    const near = this.episode.robots.filter((robot) => {
      const pose = robot.poseAt(step);
      return pose && Math.hypot(pose.x - x, pose.y - y) < 0.45;
    });
    this.state.focusOn(near.length ? near[0].name : null, this.episode);
  }

  point(event) {
    const [x, y] = this.from(event);
    const step = this.episode.at(this.state.step);
    const told = [];
    for (const robot of this.episode.robots) {
      const pose = robot.poseAt(step);
      if (pose && Math.hypot(pose.x - x, pose.y - y) < 0.35) told.push(`${robot.label}: ${robot.overAt(step) || robot.doingAt(step).filter(Boolean).join(" \u203a ") || robot.actionAt(step)}`);
    }
    this.episode.objectsAt(step).forEach((object, index) => {
      if (object.holder < 0 && Math.hypot(object.x - x, object.y - y) < 0.2) told.push(`${this.episode.objects[index].id}${object.on ? ` on ${object.on}` : ""}`);
    });
    if (!told.length) {
      const thing = this.page.house.furniture.find((it) => isInside(it.polygon, x, y));
      const room = this.page.house.rooms.find((it) => isInside(it.polygon, x, y));
      if (thing) told.push(thing.id);
      else if (room) told.push(`${room.name} (${room.id})`);
    }
    showTip(event, told);
  }
}

function isInside(polygon, x, y) {
  let inside = false;
  polygon.forEach(([ax, ay], place) => {
    const [bx, by] = polygon[(place + 1) % polygon.length];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  });
  return inside;
}

function showTip(event, told) {
  const tip = byId("tip");
  if (!told.length) return hideTip();
  fill(tip, told.slice(0, 6).map((line) => make("div", {}, line)));
  tip.hidden = false;
  tip.style.left = `${Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 8)}px`;
  tip.style.top = `${Math.min(event.clientY + 14, window.innerHeight - tip.offsetHeight - 8)}px`;
}

function hideTip() {
  byId("tip").hidden = true;
}
