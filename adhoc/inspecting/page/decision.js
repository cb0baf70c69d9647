// One decision: what was seen, asked, answered, ranked, replied, judged and chosen.
function decisionsPanel(state, episode) {
  const list = state.decisionsOf(episode);
  if (!list.length) return make("p", { class: "empty" }, "No robot reported a decision: only robots that plan with a language model do.");
  const chosen = state.decisionNow(episode);
  return [
    decisionList(state, episode, list, chosen),
    chosen ? decisionDetail(episode, chosen) : make("p", { class: "empty" }, "No decision yet at this step."),
    episode.leftOut.decisions > 0 && make("p", { class: "note" }, `${plural(episode.leftOut.decisions, "decision")} did not fit into the page.`),
  ];
}

function decisionList(state, episode, list, chosen) {
  const at = list.indexOf(chosen);
  const near = list.slice(Math.max(0, at - 2), Math.max(0, at - 2) + 6);
  return make(
    "div",
    { class: "decisions" },
    make("div", { class: "bar" }, make("span", {}, `decision ${at + 1} of ${list.length}`), make("label", {}, make("input", { type: "checkbox", checked: state.shows.skills, onchange: () => state.toggle("skills") }), " sub-skills too")),
    make(
      "ol",
      {},
      near.map((one) =>
        make(
          "li",
          { class: one === chosen ? "now" : null },
          make("button", { onclick: () => state.go(one.step, one) }, make("b", {}, one.step), robotDot(episode.robots[one.robot]), make("span", { class: "what" }, headline(one)))
        )
      )
    )
  );
}

function headline({ trace }) {
  const decision = asObject(trace.decision);
  if (decision.chosen) return String(decision.chosen);
  const skills = asList(trace.skills).map(asObject);
  if (skills.length) return skills.map((skill) => `\u203a ${skill.chosen || `refused: ${skill.refused}`}`).join(", ");
  return Object.keys(trace).join(", ");
}

function decisionDetail(episode, one) {
  const { trace } = one;
  const decision = asObject(trace.decision);
  const known = new Set(["decision", "skills", "superseded"]);
  const picture = one.picture >= 0 && make("img", { class: "eye", alt: "what the robot sees", src: `data:image/jpeg;base64,${episode.pictures[one.picture]}` });
  return make(
    "article",
    { class: "decision" },
    make(
      "header",
      {},
      picture,
      make(
        "div",
        {},
        make("p", { class: "when" }, `step ${one.step} \u00b7 `, robotChip(episode, one.robot)),
        make("h2", {}, headline(one)),
        decision.reason && make("p", { class: "reason" }, make("em", {}, "planned because: "), decision.reason)
      )
    ),
    decision.fallback != null && make("p", { class: "warning" }, make("b", {}, "Safe choice: "), decision.fallback),
    asList(decision.degraded).map((text) => make("p", { class: "warning" }, make("b", {}, "Degraded: "), text)),
    trace.decision && planSections(episode, decision),
    asList(trace.superseded).map((old) => make("details", {}, make("summary", {}, `Plan that was given up: ${asObject(old).chosen || ""}`), planSections(episode, asObject(old)))),
    asList(trace.skills).map((skill) => skillSection(episode, asObject(skill))),
    Object.keys(trace).filter((name) => !known.has(name)).map((name) => make("details", {}, make("summary", {}, name), make("pre", {}, JSON.stringify(trace[name], null, 1))))
  );
}

function planSections(episode, decision) {
  const ranking = asList(decision.ranking).map(asObject);
  const verdicts = asList(decision.verdicts).map(asObject);
  const objections = [...asList(decision.objections), ...asList(decision.objected)].map(asObject);
  return [
    section("Candidates", asList(decision.candidates).map((it) => candidateItem(asObject(it), ranking, verdicts, decision)), "table"),
    section("What teammates are expected to do", asList(decision.predictions).map((it) => make("li", {}, chipOf(episode, asObject(it).teammate || "somebody"), " ", code(asObject(it).sub_task || "unknown"), " ", asObject(it).sub_skill && code(asObject(it).sub_skill)))),
    section("Teammates replied", asList(decision.replies).map((it) => make("li", {}, chipOf(episode, asObject(it).sender || "somebody"), " ", make("span", { class: "said" }, asObject(it).text || "")))),
    section("Verdicts", verdicts.map((it) => make("li", { class: it.feasible ? "yes" : "no" }, make("b", {}, it.feasible ? "\u2713 feasible " : "\u2715 refused "), code(it.sub_task), it.reason && make("div", { class: "said" }, it.reason)))),
    section("Objections", objections.map((it) => make("li", {}, chipOf(episode, it.objector || "somebody"), " to ", chipOf(episode, it.planner || "somebody"), " ", it.sub_task && code(it.sub_task), make("div", { class: "said" }, it.reason || "")))),
    exchangesSection(episode, decision.exchanges),
  ];
}

function candidateItem(candidate, ranking, verdicts, decision) {
  const place = ranking.findIndex((it) => it.sub_task === candidate.sub_task);
  const verdict = verdicts.find((it) => it.sub_task === candidate.sub_task);
  const isChosen = candidate.sub_task === decision.chosen;
  return make(
    "li",
    { class: isChosen ? "chosen" : null },
    make("span", { class: "rank", title: place < 0 ? "not ranked" : "place in the ranking" }, place < 0 ? "\u2013" : place + 1),
    make("div", {}, code(candidate.sub_task), candidate.score != null && make("span", { class: "score" }, ` score ${candidate.score}`), isChosen && make("span", { class: "mark" }, "chosen"), verdict && make("span", { class: verdict.feasible ? "mark yes" : "mark no" }, verdict.feasible ? "\u2713 feasible" : "\u2715 refused"), candidate.rationale && make("div", { class: "said" }, candidate.rationale))
  );
}

function skillSection(episode, skill) {
  return make(
    "section",
    {},
    make("h3", {}, "Sub-skill"),
    make("p", { class: skill.refused ? "warning" : null }, skill.refused ? `refused: ${skill.refused}` : code(skill.chosen || "")),
    skill.fallback != null && make("p", { class: "warning" }, skill.fallback),
    exchangesSection(episode, skill.exchanges)
  );
}

function exchangesSection(episode, exchanges) {
  const list = asList(exchanges).map(asObject);
  if (!list.length) return null;
  const tokens = list.reduce((sum, it) => sum + Number(it.prompt_tokens || 0) + Number(it.completion_tokens || 0), 0);
  const cost = list.reduce((sum, it) => sum + Number(it.cost_usd || 0), 0);
  return make("section", {}, make("h3", {}, "Asked of the model ", make("small", {}, `${plural(list.length, "call")}, ${number(tokens)} tokens, ${money(cost)}`)), list.map((it) => exchangeItem(episode, it)));
}

function exchangeItem(episode, exchange) {
  const body = make("div", {});
  const item = make(
    "details",
    { class: "exchange" },
    make("summary", {}, make("b", {}, exchange.stage || "call"), make("small", {}, ` ${exchange.model || ""} \u00b7 ${number(exchange.prompt_tokens)} + ${number(exchange.completion_tokens)} tokens \u00b7 ${money(Number(exchange.cost_usd || 0))}`)),
    body
  );
  item.addEventListener("toggle", () => {
    if (!item.open || body.childNodes.length) return;
    put(body, [
      make("h4", {}, "Reply"),
      make("pre", { class: "reply" }, episode.page.block(exchange.reply)),
      asList(exchange.prompt).map(([role, block]) => [make("h4", {}, `Prompt (${role})`), make("pre", {}, episode.page.block(block))]),
    ]);
  });
  return item;
}

function section(title, items, kind) {
  if (!items.length) return null;
  return make("section", {}, make("h3", {}, title), make("ul", { class: kind || null }, items));
}

function code(text) {
  return make("code", {}, text);
}
