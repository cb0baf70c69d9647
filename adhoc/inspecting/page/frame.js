// What is around the maps and the panel: title, controls, help.
function buildHead(page) {
  const { record } = page.episodes[page.episodes.length - 1];
  byId("task").textContent = record.task_id;
  byId("subtitle").textContent = `${record.difficulty} \u00b7 ${plural(page.house.rooms.length, "room")} \u00b7 ${plural(page.targets.length, "misplaced object")} \u00b7 ${record.team_label} team`;
  const names = [...new Set(page.episodes.flatMap((episode) => [episode.record.model, episode.record.team_model]).filter(Boolean))];
  fill(byId("model"), "Language model: ", make("b", {}, names.join(", ") || "none was asked"));
}

function buildControls(state) {
  const speed = byId("speed");
  fill(speed, SPEEDS.map((it) => make("option", { value: it, selected: it === state.speed }, `${it}/s`)));
  speed.addEventListener("change", () => (state.speed = Number(speed.value)));
  byId("play").addEventListener("click", () => state.play());
  byId("back").addEventListener("click", () => state.go(state.step - 1));
  byId("forward").addEventListener("click", () => state.go(state.step + 1));
  byId("previousDecision").addEventListener("click", () => state.jump(-1));
  byId("nextDecision").addEventListener("click", () => state.jump(1));
  fill(byId("switches"), Object.entries(SWITCHES).map(([name, [label, letter]]) => make("label", { title: `Key ${letter}` }, make("input", { id: `switch-${name}`, type: "checkbox", checked: state.shows[name], onchange: () => state.toggle(name) }), ` ${label}`)));
  document.addEventListener("keydown", (event) => state.key(event));
  window.addEventListener("resize", () => state.draw());
}

function buildHelp() {
  const keys = [["Space", "play or pause"], ["\u2190 \u2192", "one step; with Shift ten"], ["Home End", "first and last step"], ["[ ]", "decision before, next decision"], ["1 2 \u2026", "one robot: what it knows, decides and says"], ["Esc", "all robots again"], ["v e p t", "fields of view, explored floor, paths, targets"]];
  const marks = [["\u2605", "the newcomer, white with a dark rim"], ["red square", "a misplaced object, by its number"], ["green circle \u2713", "the same object in a right place"], ["dashed green", "furniture where the numbered objects may belong"], ["dark floor", "floor that no robot, or not this robot, has on its map"], ["fan", "what a camera covers: through doors and windows, over tables, not through walls"], ["\u2026", "this robot says something in this step"], ["\u2715", "this robot has stopped, or is out of order"], ["blue band", "steps that both episodes share: the same actions, messages and states, by their hashes"], ["on the time line", "ticks: decisions (red: safe choice); triangle: taken; circle: re-placed"]];
  const rows = (list) => make("table", {}, make("tbody", {}, list.map(([mark, meaning]) => make("tr", {}, make("th", {}, mark), make("td", {}, meaning)))));
  fill(byId("help"), make("h2", {}, "Keys"), rows(keys), make("h2", {}, "Marks"), rows(marks), make("form", { method: "dialog" }, make("button", {}, "Close")));
  byId("helpButton").addEventListener("click", () => byId("help").showModal());
}
