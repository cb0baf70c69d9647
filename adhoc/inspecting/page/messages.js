// What was said up to now, latest first.
const MOST_MESSAGES = 250;

function messagesPanel(state, episode) {
  const step = episode.at(state.step);
  const focus = state.focusIn(episode);
  const said = episode.messages.filter(
    ([sent, sender, recipient, kind]) =>
      sent <= step && (state.shows.team || kind !== "team") && (focus < 0 || sender === focus || recipient === focus)
  );
  const hidden = episode.messages.filter(([sent, , , kind]) => sent <= step && kind === "team").length;
  return [
    make(
      "div",
      { class: "bar" },
      make("span", {}, plural(said.length, "message")),
      make("label", {}, make("input", { type: "checkbox", checked: state.shows.team, onchange: () => state.toggle("team") }), ` the team's private talk (${number(hidden)})`)
    ),
    said.length > MOST_MESSAGES && make("p", { class: "note" }, `The latest ${MOST_MESSAGES} are listed.`),
    episode.leftOut.messages > 0 && make("p", { class: "note" }, `${plural(episode.leftOut.messages, "message")} did not fit into the trace.`),
    make("ol", { class: "messages" }, said.slice(-MOST_MESSAGES).reverse().map((message) => messageItem(state, episode, message, step))),
  ];
}

function messageItem(state, episode, [sent, sender, recipient, kind, text], step) {
  return make(
    "li",
    { class: sent === step ? "now" : null },
    make("button", { class: "step", title: "Go to this step", onclick: () => state.go(sent) }, sent),
    robotChip(episode, sender),
    make("span", { class: `kind ${kind}` }, kind.replaceAll("_", " ")),
    recipient >= 0 && [" to ", robotChip(episode, recipient)],
    make("div", { class: "said" }, episode.page.lines[text])
  );
}

function robotChip(episode, index) {
  const robot = episode.robots[index];
  if (!robot) return make("span", { class: "chip" }, "somebody");
  return make("span", { class: "chip" }, robotDot(robot), robot.label);
}

function robotDot(robot) {
  if (!robot) return null;
  return make("i", { class: robot.isNewcomer ? "dot newcomer" : "dot", title: robot.label, style: { background: robot.colour } }, robot.short);
}

function chipOf(episode, name) {
  const robot = episode.robots.find((one) => one.name === name);
  return robot ? robotChip(episode, robot.index) : make("span", { class: "chip" }, name);
}
