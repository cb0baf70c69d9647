// What is in the house: targets, fields of view, paths, objects and robots.
const MOST_NUMBERS = 4;

class MapMarks extends MapGround {
  drawTargets(context, placed) {
    const wanted = new Map();
    for (const target of this.episode.misplaced) {
      if (placed.has(target.index)) continue;
      for (const place of target.places) wanted.set(place, [...(wanted.get(place) || []), target.number]);
    }
    context.font = "700 9px system-ui, sans-serif";
    for (const [place, numbers] of wanted) {
      const thing = this.page.furniture.get(place);
      if (!thing) continue;
      this.trace(context, thing.polygon);
      context.setLineDash([4, 3]);
      context.strokeStyle = colours.placed;
      context.lineWidth = 1.2;
      context.stroke();
      context.setLineDash([]);
      const corners = thing.polygon.map((corner) => this.to(...corner));
      const corner = corners.reduce((best, it) => (it[1] - it[0] < best[1] - best[0] ? it : best));
      const told = numbers.length > MOST_NUMBERS ? [...numbers.slice(0, MOST_NUMBERS), "\u2026"] : numbers;
      outlined(context, told.join("\u2009"), corner[0] - 5, corner[1] + 7, colours.placed, "white", 3);
    }
  }

  faded(robot) {
    const focus = this.state.focusIn(this.episode);
    return focus >= 0 && focus !== robot.index;
  }

  drawView(context, robot, step) {
    const pose = robot.poseAt(step);
    if (!pose || pose.view < 0 || robot.overAt(step)) return;
    context.save();
    context.globalAlpha = this.faded(robot) ? 0.25 : 1;
    this.trace(context, [[pose.x, pose.y], ...this.episode.view(pose.view).map(([x, y]) => [pose.x + x, pose.y + y])]);
    context.fillStyle = robot.isNewcomer ? "rgba(255,255,255,0.45)" : `${robot.colour}38`;
    context.fill();
    context.strokeStyle = robot.isNewcomer ? "rgba(20,24,31,0.65)" : `${robot.colour}b0`;
    context.lineWidth = 1;
    context.stroke();
    context.restore();
  }

  drawPath(context, robot, step) {
    const count = Math.min(step - robot.first + 1, robot.x.length);
    if (count < 2) return;
    const shift = 0.03 * (robot.index - (this.episode.robots.length - 1) / 2);
    const points = [];
    for (let k = 0; k < count; k++) points.push([robot.x[k] / 100 + shift, robot.y[k] / 100 + shift]);
    const common = clamp(this.state.common - robot.first + 1, 0, count);
    context.save();
    context.lineJoin = context.lineCap = "round";
    for (const [part, alpha] of [[points.slice(0, common), 0.45], [points.slice(Math.max(0, common - 1)), 0.95]]) {
      if (part.length < 2) continue;
      context.globalAlpha = this.faded(robot) ? 0.15 : alpha;
      if (robot.isNewcomer) this.line(context, part, colours.ink, 4.4);
      this.line(context, part, robot.colour, robot.isNewcomer ? 2.4 : 2.2);
    }
    context.restore();
  }

  drawObjects(context, objects, placed) {
    objects.forEach((object, index) => {
      if (this.episode.numbers.has(index) || object.holder >= 0) return;
      const [x, y] = this.to(object.x, object.y);
      context.fillStyle = "rgba(70,66,58,0.4)";
      context.beginPath();
      context.arc(x, y, 1.6, 0, 7);
      context.fill();
    });
    for (const target of this.episode.misplaced) {
      const object = objects[target.index];
      if (!object || object.holder >= 0) continue;
      this.badge(context, ...this.to(object.x, object.y), target.number, placed.has(target.index));
    }
  }

  // Misplaced: a red square; in a right place: a green circle with a tick. Form tells them apart, too.
  badge(context, x, y, text, isPlaced) {
    context.beginPath();
    if (isPlaced) context.arc(x, y, 8.5, 0, 7);
    else context.rect(x - 7.5, y - 7.5, 15, 15);
    context.fillStyle = isPlaced ? colours.placed : colours.misplaced;
    context.fill();
    context.strokeStyle = "white";
    context.lineWidth = 1.6;
    context.stroke();
    context.font = "700 11px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = "white";
    context.fillText(String(text), x, y + 0.5);
    if (isPlaced) {
      context.font = "700 12px system-ui, sans-serif";
      outlined(context, "\u2713", x + 10, y - 7, colours.placed, "white", 3);
    }
  }

  drawRobot(context, robot, step) {
    const pose = robot.poseAt(step);
    if (!pose) return;
    const over = robot.overAt(step);
    const [x, y] = this.to(pose.x, pose.y);
    const radius = clamp(0.2 * this.scale, 8, 13);
    context.save();
    context.globalAlpha = this.faded(robot) ? 0.5 : 1;
    context.translate(x, y);
    context.rotate(-pose.yaw);
    context.beginPath();
    context.arc(0, 0, radius, 0.5, 2 * Math.PI - 0.5);
    context.lineTo(1.55 * radius, 0);
    context.closePath();
    context.fillStyle = over ? "#9aa1ab" : robot.colour;
    context.fill();
    context.lineWidth = robot.isNewcomer ? 2.6 : 1.5;
    context.strokeStyle = colours.ink;
    context.stroke();
    context.rotate(pose.yaw);
    context.font = `700 ${radius + (robot.isNewcomer ? 4 : 2)}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillStyle = colours.ink;
    if (!robot.isNewcomer && !over) outlined(context, robot.short, 0, 0.5, "white", "rgba(20,24,31,0.85)", 2.6);
    else context.fillText(robot.short, 0, 0.5);
    if (over) outlined(context, "\u2715", radius, -radius, colours.ink, "white", 3);
    if (this.speaks(robot, step)) this.bubble(context, -radius - 3, -radius - 4);
    context.restore();
    const held = this.episode.numbers.get(pose.held);
    if (held) this.badge(context, x + radius + 3, y + radius + 1, held.number, false);
  }

  speaks(robot, step) {
    return this.episode.messages.some(([sent, sender, , kind]) => sent === step && sender === robot.index && kind !== "team");
  }

  bubble(context, x, y) {
    context.beginPath();
    context.ellipse(x, y, 8, 6, 0, 0, 7);
    context.fillStyle = "white";
    context.fill();
    context.lineWidth = 1.3;
    context.strokeStyle = colours.ink;
    context.stroke();
    context.fillStyle = colours.ink;
    for (const dot of [-3.4, 0, 3.4]) context.fillRect(x + dot - 0.9, y - 0.9, 1.8, 1.8);
  }
}
