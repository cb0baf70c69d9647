// What each robot can do, and what it is at.
function robotsPanel(state, episode) {
  const step = episode.at(state.step);
  const focus = state.focusIn(episode);
  return [
    make("ul", { class: "robots" }, episode.robots.map((robot) => robotItem(state, episode, robot, step, focus))),
    misplacedList(episode, step),
    make("h3", {}, "This episode"),
    recordTable(episode),
  ];
}

function robotItem(state, episode, robot, step, focus) {
  const pose = robot.poseAt(step);
  const over = robot.overAt(step);
  const [task, skill] = robot.doingAt(step);
  const able = robot.able;
  const held = pose && pose.held >= 0 ? episode.objects[pose.held].id : "";
  const now = !pose ? (step < robot.first ? `joins at step ${robot.first}` : "has left") : over;
  return make(
    "li",
    { class: focus === robot.index ? "now" : null },
    make("button", { onclick: () => state.focusOn(focus === robot.index ? null : robot.name, episode), title: "Show what this robot knows, sees and says" }, robotChip(episode, robot.index), now && make("span", { class: "over" }, now)),
    able && make("p", { class: "able" }, `${able.manipulates ? `manipulates, up to ${able.payload} kg` : "cannot manipulate"} \u00b7 camera ${able.height} m \u00b7 battery ${able.battery} steps`),
    pose && !over && make("dl", {}, task && [make("dt", {}, "sub-task"), make("dd", {}, task)], skill && [make("dt", {}, "sub-skill"), make("dd", {}, skill)], robot.actionAt(step) && [make("dt", {}, "action"), make("dd", {}, robot.actionAt(step))], held && [make("dt", {}, "holds"), make("dd", {}, held)])
  );
}

function misplacedList(episode, step) {
  const placed = episode.placedAt(step);
  const objects = episode.objectsAt(step);
  return [
    make("h3", {}, "Misplaced objects"),
    make(
      "ol",
      { class: "objects" },
      episode.misplaced.map((target) => {
        const object = objects[target.index] || { holder: -1, on: "" };
        const holder = episode.robots[object.holder];
        const where = holder ? `held by ${holder.label}` : object.on ? `on ${object.on}` : "where it was misplaced";
        return make("li", {}, make("span", { class: placed.has(target.index) ? "badge good" : "badge bad" }, target.number), make("b", {}, target.object), ` ${target.mass} kg, ${where}`, make("div", { class: "said" }, target.places.length ? `belongs on ${target.places.slice(0, 6).join(", ")}${target.places.length > 6 ? ` and ${target.places.length - 6} more` : ""}` : "no furniture of this house is known to fit"));
      })
    ),
  ];
}

function recordTable({ record, llm }) {
  const rows = [
    ["episode", record.episode_id],
    ["team", record.team_label],
    ["ad hoc robot", record.policy_label],
    ["model", record.model || "none"],
    ["team's model", record.team_model || "none"],
    ["outcome", `${record.ending}, ${record.replaced} of ${record.misplaced} re-placed in ${record.steps} of ${record.max_steps} steps`],
    ["action steps", number(record.action_steps)],
    ["messages", number(record.messages)],
    ["model calls", `${number(llm.calls)}; ${number(llm.prompt_tokens)} + ${number(llm.completion_tokens)} tokens; ${money(llm.cost_usd)}`],
    ["seed", record.seed],
    ["history", record.history_hash],
    ["configuration", record.config_hash],
    ["run", record.run || "unknown"],
    ["library", record.library_version],
  ];
  return make("table", { class: "record" }, make("tbody", {}, rows.map(([name, value]) => make("tr", {}, make("th", {}, name), make("td", {}, value)))));
}
